//! Formats of model files: how they are read, and what the program makes of them.

mod apart;
mod convert;
mod kept;
mod kinds;
mod mutations;
mod several;

//! All tests in one binary, which links once.

mod command;
mod exact;
mod export;
mod mistakes;
mod model;
mod site;
mod sites;
mod sun;

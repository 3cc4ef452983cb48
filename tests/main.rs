//! All tests in one binary, which links once.

mod exact;
mod command;
mod export;
mod mistakes;
mod model;
mod site;
mod sites;
mod sun;

//! All tests in one binary: it links once.

mod mistakes;
mod site;
mod sun;

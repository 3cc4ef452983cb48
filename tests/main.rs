//! All tests in one binary, which links once.

mod sites;

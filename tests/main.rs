//! All tests in one binary, so that it links once.

mod export;

//! All integration tests, linked once.

mod model;

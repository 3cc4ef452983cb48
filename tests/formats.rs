//! Readers of model files: what stands in them, and what they leave out.

mod city;
mod terrain;

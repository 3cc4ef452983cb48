//! Formats of model files: what is read of each, what is told, and one building that each writes in its own way.

pub(crate) mod building;
mod compressed;
mod dae;
mod dxf;
mod foreign;
mod obj;
mod ply;
mod stl;
mod city;
mod terrain;

//! Stencil.
use super::*;
use crate::view::View;
use std::sync::Arc;
/// Stencil.
pub struct Stencil {}
impl Stencil {
    /// New.
    pub fn new(_gpu: Arc<Gpu>, _scene: Scene, _view: View) -> Result<Stencil, ShadowError> {
        todo!()
    }
}
impl Technique for Stencil {
    fn draw(&mut self, _to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        todo!()
    }
    fn surface(&self) -> Result<Surface, ShadowError> {
        todo!()
    }
}

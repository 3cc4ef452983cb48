//! What the window shows, for whoever looks at it from outside.

use super::app::App;
use crate::gpu::readback;
use crate::profile::Provenance;
use crate::site::file::SiteFile;
use crate::view::View;
use glam::DVec3;

impl App {
    /// What the picture shows: the view, and the unit vector to the sun.
    pub fn shown(&self) -> Option<(View, DVec3)> {
        let wish = &self.open.as_ref()?.viewer.shown()?.wish;
        Some((wish.view, wish.to_sun))
    }

    /// What was asked for at the last frame: the view at its full size, and the unit vector to the sun.
    pub fn asked(&self) -> Option<(View, DVec3)> {
        let wish = self.open.as_ref()?.viewer.asked()?;
        Some((wish.view, wish.to_sun))
    }

    /// What drew the picture.
    pub fn drawn(&self) -> Option<&Provenance> {
        Some(&self.open.as_ref()?.viewer.shown()?.drawn)
    }

    /// The site as it is set, as a site file would say it.
    pub fn site_file(&self) -> &SiteFile {
        &self.settings.site
    }

    /// The picture that is shown, read back: columns, rows and pixels.
    ///
    /// # Errors
    /// Where there is none, or the adapter fails.
    pub fn picture(&self) -> anyhow::Result<(u32, u32, Vec<[u8; 4]>)> {
        let shown = self.open.as_ref().and_then(|open| open.viewer.shown());
        let Some(shown) = shown else { anyhow::bail!("there is no picture yet") };
        let pixels = readback::texels(&self.gpu, &shown.texture, wgpu::TextureAspect::All)?;
        Ok((shown.texture.width(), shown.texture.height(), pixels))
    }
}

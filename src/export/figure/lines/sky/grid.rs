//! What lies around and below the lines: the sky with what stands in front of it, the grid, and the rim with its
//! letters.

use super::chart::{SkyChart, direction};
use super::regions::regions;
use super::tones::SKY;
use crate::export::figure::scale::{Rgb, mix};
use crate::export::figure::svg::{Block, GRAY, INK, LetterStyle, TextAnchor, hex};
use crate::view::SkyProjection;
use glam::DVec3;

impl SkyChart<'_> {
    /// What lies below the lines: the sky, what stands in front of it, and the grid.
    pub(super) fn ground(&self, block: &mut Block, colours: &[Rgb]) {
        let name = self.name();
        let shape = self.shape();
        block.push(format_args!("<clipPath id=\"{name}-sky\">{shape}/></clipPath>"));
        block.push(format_args!("{shape} fill=\"{}\"/>", hex(SKY)));
        block.push(format_args!("<g id=\"{name}-obstacles\" clip-path=\"url(#{name}-sky)\">"));
        for region in regions(self, colours) {
            region.draw(block);
        }
        block.push(format_args!("</g>"));
        self.grid(block);
    }

    /// Circles of altitude every 10°, and lines of azimuth every 30°.
    fn grid(&self, block: &mut Block) {
        const HEAVY: f64 = 0.5;
        const LIGHT: f64 = 0.26;
        let is_disc = self.raster.picture.projection == SkyProjection::Stereographic;
        for altitude_deg in (10..90).step_by(10) {
            // the circles of a disc are closed
            let around = (0..=360).step_by(2).map(|azimuth| direction(f64::from(azimuth), f64::from(altitude_deg)));
            let around: Vec<DVec3> = around.collect();
            let strength = if altitude_deg % 30 == 0 { HEAVY } else { LIGHT };
            if is_disc {
                let points: Vec<_> = around.iter().map(|to| self.place(*to)).collect();
                self.stroke(block, &[points], 1.5, mix(SKY, GRAY, strength), None);
            } else {
                let [width, y] = [self.size()[0], self.place(around[0])[1]];
                let points = vec![[self.corner[0], y], [self.corner[0] + width, y]];
                self.stroke(block, &[points], 1.5, mix(SKY, GRAY, strength), None);
            }
        }
        for azimuth_deg in (0..360).step_by(30) {
            let strength = if azimuth_deg % 90 == 0 { HEAVY } else { LIGHT };
            // twelve lines would meet in a blot
            let top = if !is_disc || azimuth_deg % 90 == 0 { 89.999 } else { 80.0 };
            let ends = [0.0, top].map(|altitude| self.place(direction(f64::from(azimuth_deg), altitude)));
            self.stroke(block, &[ends.to_vec()], 1.5, mix(SKY, GRAY, strength), None);
        }
    }

    /// The horizon, with the azimuths around it, and the altitudes at the sides of the strip.
    pub(super) fn rim(&self, block: &mut Block) {
        block.push(format_args!(
            "{} fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>",
            self.shape(),
            hex(INK),
            4.0 * self.pen
        ));
        match self.raster.picture.projection {
            SkyProjection::Stereographic => self.disc_rim(block),
            SkyProjection::Cylindrical { middle_rad } => self.strip_rim(block, middle_rad.to_degrees()),
        }
    }

    fn disc_rim(&self, block: &mut Block) {
        let radius = self.size()[0] / 2.0;
        let middle = [self.corner[0] + radius, self.corner[1] + radius];
        let at = |azimuth_deg: f64, away: f64| {
            let (sin, cos) = azimuth_deg.to_radians().sin_cos();
            [middle[0] + sin * away, middle[1] - cos * away]
        };
        for azimuth in (0..360).step_by(10) {
            let length = if azimuth % 30 == 0 { 16.0 } else { 9.0 };
            let ends = [0.0, length * self.pen].map(|out| at(f64::from(azimuth), radius + out));
            block.polyline(&ends, 2.0 * self.pen, INK);
        }
        for label in self.rim_labels() {
            label.draw(block);
        }
    }

    fn strip_rim(&self, block: &mut Block, middle_deg: f64) {
        let ([x, y], [width, height]) = (self.corner, self.size());
        for step in 0..=36 {
            let azimuth = (middle_deg as i32 + 180 + 10 * step).rem_euclid(360);
            let at = x + width * f64::from(step) / 36.0;
            let length = if azimuth % 30 == 0 { 16.0 } else { 9.0 };
            block.polyline(&[[at, y + height], [at, y + height + length]], 2.0, INK);
        }
        self.rim_labels().iter().for_each(|label| label.draw(block));
        for altitude in (0..=90).step_by(10) {
            let at = y + height * (1.0 - f64::from(altitude) / 90.0);
            block.polyline(&[[x - 9.0, at], [x, at]], 2.0, INK);
            let said = format!("{altitude}°");
            block.text(x - 16.0, at + 10.0, TextAnchor::End, LetterStyle::FINE, &said);
        }
    }

    /// The azimuths at the rim.
    pub(super) fn rim_labels(&self) -> Vec<RimLabel> {
        let ([x, y], [width, height]) = (self.corner, self.size());
        let size = if self.is_small() { 28.0 } else { 40.0 };
        let every = if self.is_small() { 90 } else { 30 };
        match self.raster.picture.projection {
            SkyProjection::Stereographic => {
                let away = width / 2.0 + 46.0 * self.pen;
                let at = |azimuth: i32| {
                    let (sin, cos) = f64::from(azimuth).to_radians().sin_cos();
                    [x + width / 2.0 + sin * away, y + width / 2.0 - cos * away]
                };
                (0..360).step_by(every).map(|azimuth| RimLabel { at: at(azimuth), azimuth, size }).collect()
            }
            SkyProjection::Cylindrical { middle_rad } => {
                let first = middle_rad.to_degrees() as i32 + 180;
                let steps = (0..=36).map(|step| ((first + 10 * step).rem_euclid(360), step));
                let labelled = steps.filter(|(azimuth, _)| azimuth % every as i32 == 0);
                let at = |step: i32| [x + width * f64::from(step) / 36.0, y + height + 40.0];
                labelled.map(|(azimuth, step)| RimLabel { at: at(step), azimuth, size }).collect()
            }
        }
    }

    /// The labels of altitudes on the disc, with their positions: along the side that the sun never crosses.
    pub(super) fn altitudes(&self, is_southern: bool) -> Vec<(String, [f64; 2])> {
        if self.raster.picture.projection != SkyProjection::Stereographic {
            return Vec::new();
        }
        let azimuth = if is_southern { 180.0 } else { 0.0 };
        let said = |altitude: i32| (format!("{altitude}°"), self.place(direction(azimuth, f64::from(altitude))));
        (10..80).step_by(10).map(said).collect()
    }
}

/// An azimuth at a chart's rim: the cardinal direction in bold, or degrees.
pub(super) struct RimLabel {
    /// Its middle.
    pub(super) at: [f64; 2],
    azimuth: i32,
    /// The height of cardinal directions.
    pub(super) size: f64,
}

impl RimLabel {
    fn draw(&self, block: &mut Block) {
        let [x, y] = self.at;
        let cardinal = [(0, "N"), (90, "E"), (180, "S"), (270, "W")].into_iter().find(|(at, _)| *at == self.azimuth);
        let (style, said) = match cardinal {
            Some((_, letter)) => (LetterStyle { size: self.size, ..LetterStyle::HEAD }, letter.to_owned()),
            None => (LetterStyle::FINE, format!("{}°", self.azimuth)),
        };
        block.text(x, y + style.size * 0.36, TextAnchor::Middle, style, &said);
    }
}

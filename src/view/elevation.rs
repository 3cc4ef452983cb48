//! The view along parallel rays: of a side, level, or as the sun sees a site.

use glam::{DVec2, DVec3};

/// One of the four sides from which a site is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From the north.
    North,
    /// From the east.
    East,
    /// From the south.
    South,
    /// From the west.
    West,
}

/// The margin on all sides of what a side shows, as a share of the picture.
const BESIDE: f64 = 0.04;
const BELOW: f64 = 0.16;
const ABOVE: f64 = 0.10;
/// The least height of a side's picture, metres.
const LEAST: f64 = 0.1;

impl Side {
    /// The horizontal unit vector towards the viewer.
    pub fn to_viewer(self) -> DVec3 {
        match self {
            Side::North => DVec3::Y,
            Side::East => DVec3::X,
            Side::South => DVec3::NEG_Y,
            Side::West => DVec3::NEG_X,
        }
    }

    /// The middle and the height in metres of a picture with that aspect ratio that contains the whole box. The box is
    /// low in it: below the ground's line there is only cut earth.
    pub fn around(self, (low, high): (DVec3, DVec3), width_by_height: f64) -> (DVec3, f64) {
        let size = high - low;
        let width = size.dot(self.right().abs()) / (1.0 - 2.0 * BESIDE);
        let height = (width / width_by_height).max(size.z / (1.0 - BELOW - ABOVE)).max(LEAST);
        (((low + high) / 2.0).with_z(low.z + height * (0.5 - BELOW)), height)
    }

    /// The least height, metres, of a picture with that aspect ratio about a point that contains the whole box.
    pub(crate) fn height_about(self, middle: DVec3, (low, high): (DVec3, DVec3), width_by_height: f64) -> f64 {
        let [low, high] = [low - middle, high - middle];
        let aside = low.dot(self.right()).abs().max(high.dot(self.right()).abs());
        let across = aside / (0.5 - BESIDE) / width_by_height;
        across.max(-low.z / (0.5 - BELOW)).max(high.z / (0.5 - ABOVE)).max(LEAST)
    }

    fn right(self) -> DVec3 {
        DVec3::Z.cross(self.to_viewer())
    }
}

/// A picture along parallel rays. Of a side it is level and true to scale, and what lies below the ground is behind the
/// earth. Along the sun's rays it shows what the sun sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elevation {
    /// The point in the middle of the picture, metres.
    pub target: DVec3,
    /// The unit vector towards the viewer; level for a side, otherwise upwards.
    pub to_viewer: DVec3,
    /// Side of a pixel, metres.
    pub cell: f64,
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
}

impl Elevation {
    /// As a viewer at the sun sees a box: whole in a picture of that many pixels, with as large a cell as several suns
    /// need. Suns in the horizon or below see nothing, and none of these may be the viewer.
    pub fn from_sun(
        to_sun: DVec3,
        (low, high): (DVec3, DVec3),
        [width, height]: [u32; 2],
        suns: impl Iterator<Item = DVec3>,
    ) -> Elevation {
        let target = (low + high) / 2.0;
        let seen = Elevation { target, to_viewer: to_sun, cell: 1.0, width, height };
        let pixels = DVec2::new(f64::from(width.max(1)), f64::from(height.max(1))) * (1.0 - 2.0 * BESIDE);
        let needed = |to_viewer: DVec3| {
            let [right, up, _] = Elevation { to_viewer, ..seen }.axes();
            // the box reaches as far to one side of its middle as to the other
            let size = DVec2::new((high - low).dot(right.abs()), (high - low).dot(up.abs()));
            (size / pixels).max_element()
        };
        let cell = suns.chain([to_sun]).map(needed).fold(LEAST / pixels.y, f64::max);
        Elevation { cell, ..seen }
    }

    /// Whether it is of a side, with the earth cut at the ground.
    pub fn is_level(&self) -> bool {
        self.to_viewer.z == 0.0
    }

    /// Rightwards, upwards and forwards in the picture: unit vectors in the world frame.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = -self.to_viewer;
        if self.is_level() {
            return [forward.cross(DVec3::Z), DVec3::Z, forward];
        }
        // from the zenith it is a plan, north up
        let right = forward.cross(DVec3::Z).try_normalize().unwrap_or(DVec3::X);
        [right, right.cross(forward), forward]
    }

    /// Half the picture's width and height, metres.
    pub fn half_size(&self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height)) * self.cell / 2.0
    }

    /// The position of a pixel's centre in the plane of the picture, which contains the target.
    pub fn centre(&self, column: u32, row: u32) -> DVec3 {
        let [right, up, _] = self.axes();
        let half = self.half_size();
        let x = (f64::from(column) + 0.5) * self.cell - half.x;
        let y = half.y - (f64::from(row) + 0.5) * self.cell;
        self.target + right * x + up * y
    }
}

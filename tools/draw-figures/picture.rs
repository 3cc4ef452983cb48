//! Rasters of colours, and how they are processed for a sheet.

/// An sRGB colour.
pub(crate) type Rgb = [u8; 3];

/// The frame around what is magnified.
pub(crate) const RED: Rgb = [206, 40, 32];

/// Colours, row 0 first.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) pixels: Vec<Rgb>,
}

/// Part of a picture: left, top, width, height in its pixels.
pub(crate) type Part = [u32; 4];

impl Picture {
    pub(crate) fn filled(width: u32, height: u32, colour: Rgb) -> Picture {
        Picture { width, height, pixels: vec![colour; (width * height) as usize] }
    }

    /// One colour a cell.
    pub(crate) fn of<T>((width, height): (u32, u32), cells: &[T], colour: impl Fn(&T) -> Rgb) -> Picture {
        Picture { width, height, pixels: cells.iter().map(colour).collect() }
    }

    pub(crate) fn place(&mut self, x: u32, y: u32, picture: &Picture) {
        let rows = picture.pixels.chunks_exact(picture.width as usize);
        for (row, pixels) in (y..self.height).zip(rows) {
            let first = (row * self.width + x) as usize;
            self.pixels[first..first + pixels.len()].copy_from_slice(pixels);
        }
    }

    pub(crate) fn cropped(&self, [x, y, width, height]: Part) -> Picture {
        let row = |row: u32| {
            let first = (row * self.width + x) as usize;
            &self.pixels[first..first + width as usize]
        };
        Picture { width, height, pixels: (y..y + height).flat_map(row).copied().collect() }
    }

    /// Each pixel as a square.
    pub(crate) fn magnified(&self, times: u32) -> Picture {
        let (width, height) = (self.width * times, self.height * times);
        let pixel = |at: u32| self.pixels[(at / width / times * self.width + at % width / times) as usize];
        Picture { width, height, pixels: (0..width * height).map(pixel).collect() }
    }

    /// Squares of pixels as one, the mean of them.
    pub(crate) fn shrunk(&self, times: u32) -> Picture {
        let (width, height) = (self.width / times, self.height / times);
        let pixel = |at: u32| {
            let (column, row) = (at % width * times, at / width * times);
            let square = (0..times * times).map(|k| ((row + k / times) * self.width + column + k % times) as usize);
            let sum = square.fold([0u32; 3], |sum, at| {
                std::array::from_fn(|channel| sum[channel] + u32::from(self.pixels[at][channel]))
            });
            sum.map(|channel| ((channel + times * times / 2) / (times * times)) as u8)
        };
        Picture { width, height, pixels: (0..width * height).map(pixel).collect() }
    }

    /// With a frame around a part.
    pub(crate) fn framed(mut self, [x, y, width, height]: Part, line: u32, colour: Rgb) -> Picture {
        for row in y..(y + height).min(self.height) {
            for column in x..(x + width).min(self.width) {
                let inside =
                    (column >= x + line && column + line < x + width) && (row >= y + line && row + line < y + height);
                if !inside {
                    self.pixels[(row * self.width + column) as usize] = colour;
                }
            }
        }
        self
    }
}

/// From `a` (share 0) to `b` (share 1).
pub(crate) fn mix(a: Rgb, b: Rgb, share: f64) -> Rgb {
    std::array::from_fn(|i| (f64::from(a[i]) + (f64::from(b[i]) - f64::from(a[i])) * share).round() as u8)
}

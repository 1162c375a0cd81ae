//! A picture on a surface, as a reflectance for each pixel.

use crate::spectra::Sigmoid;

/// A reflectance for each pixel, row by row from v = 0.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    /// Width and height.
    pub(crate) size_px: [u32; 2],
    pub(crate) pixels: Vec<Sigmoid>,
}

impl Texture {
    /// The reflectance at a place: the nearest pixel of a picture that covers the square from 0 to 1 and
    /// is repeated beyond it.
    pub(crate) fn at(&self, place: [f64; 2]) -> Sigmoid {
        let [column, row] = [0, 1].map(|axis| {
            let place = place[axis] - libm::floor(place[axis]);
            pixel(place * f64::from(self.size_px[axis])).min(self.size_px[axis] - 1)
        });
        self.pixels[row as usize * self.size_px[0] as usize + column as usize]
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place within a picture, from 0 to its size"
)]
fn pixel(place: f64) -> u32 {
    place as u32
}

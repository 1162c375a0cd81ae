//! A picture on a surface: the reflectance of its colour at each place.

use std::sync::Arc;

use crate::import::{Filter, Picture, Wrap};
use crate::spectra::Sigmoid;
use crate::spectra::uplift_table::UpliftTable;

/// A picture that covers the square from 0 to 1, u to the right and v down from its upper edge.
#[derive(Clone, Debug)]
pub(crate) struct Texture {
    pub(crate) picture: Arc<Picture>,
    /// What its colours are multiplied with.
    pub(crate) factor: [f64; 3],
    pub(crate) wrap: [Wrap; 2],
    pub(crate) filter: Filter,
}

impl Texture {
    /// The reflectance at a place.
    pub(crate) fn at(&self, place: [f64; 2]) -> Sigmoid {
        let colour = self.colour_at(place);
        let rgb = [0, 1, 2].map(|primary| colour[primary] * self.factor[primary]);
        UpliftTable::shared().at(rgb)
    }

    /// The linear colour of the picture at a place.
    fn colour_at(&self, place: [f64; 2]) -> [f64; 3] {
        // Pixels have their middles at half of a whole number.
        let [x, y] = [0, 1].map(|axis| place[axis] * f64::from(self.picture.size_px[axis]) - 0.5);
        match self.filter {
            Filter::Nearest => self.pixel(libm::floor(x + 0.5), libm::floor(y + 0.5)),
            Filter::Bilinear => {
                let (left, top) = (libm::floor(x), libm::floor(y));
                let (part_x, part_y) = (x - left, y - top);
                let row = |y: f64| {
                    let (one, other) = (self.pixel(left, y), self.pixel(left + 1.0, y));
                    between(one, other, part_x)
                };
                between(row(top), row(top + 1.0), part_y)
            }
        }
    }

    fn pixel(&self, x: f64, y: f64) -> [f64; 3] {
        let [width, height] = self.picture.size_px;
        let column = wrapped(x, width, self.wrap[0]);
        let row = wrapped(y, height, self.wrap[1]);
        self.picture.pixels[row * width as usize + column].map(f64::from)
    }
}

fn between(one: [f64; 3], other: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|primary| one[primary] + part * (other[primary] - one[primary]))
}

/// The pixel of a row or column of `size` that stands at a whole number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "held to the picture; not-a-number becomes 0"
)]
fn wrapped(place: f64, size: u32, wrap: Wrap) -> usize {
    let size = f64::from(size);
    let within = match wrap {
        Wrap::Clamp => place,
        Wrap::Repeat => place - size * libm::floor(place / size),
        Wrap::Mirror => {
            let turn = place - 2.0 * size * libm::floor(place / (2.0 * size));
            if turn < size {
                turn
            } else {
                2.0 * size - 1.0 - turn
            }
        }
    };
    within.max(0.0).min(size - 1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pixels side by side: black and white.
    fn two(filter: Filter, wrap: Wrap) -> Texture {
        Texture {
            picture: Arc::new(Picture {
                size_px: [2, 1],
                pixels: vec![[0.0; 3], [1.0; 3]],
                ..Picture::black()
            }),
            factor: [1.0; 3],
            wrap: [wrap; 2],
            filter,
        }
    }

    #[test]
    fn bilinear_is_a_straight_line_between_the_middles_of_pixels() {
        let texture = two(Filter::Bilinear, Wrap::Clamp);
        for (u, value) in [
            (-1.0, 0.0),
            (0.25, 0.0),
            (0.5, 0.5),
            (0.625, 0.75),
            (0.75, 1.0),
            (9.0, 1.0),
        ] {
            assert_eq!(texture.colour_at([u, 0.5]), [value; 3], "at {u}");
        }
        // Beyond the edge the first pixel follows the last.
        let again = two(Filter::Bilinear, Wrap::Repeat);
        assert_eq!(again.colour_at([1.0, 0.5]), [0.5; 3]);
        assert_eq!(again.colour_at([-0.25, 0.5]), [1.0; 3]);
    }

    #[test]
    fn wraps_are_as_gltf_draws_them() {
        let at = |wrap, u: f64| two(Filter::Nearest, wrap).colour_at([u, 0.5])[0];
        let places = [-0.75, -0.25, 0.25, 0.75, 1.25, 1.75];
        for (wrap, values) in [
            (Wrap::Repeat, [0.0, 1.0, 0.0, 1.0, 0.0, 1.0]),
            (Wrap::Mirror, [1.0, 0.0, 0.0, 1.0, 1.0, 0.0]),
            (Wrap::Clamp, [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
        ] {
            assert_eq!(places.map(|u| at(wrap, u)), values, "{wrap:?}");
        }
        assert_eq!(at(Wrap::Repeat, f64::NAN), 0.0);
    }

    #[test]
    fn a_colour_is_multiplied_by_the_factor() {
        let mut texture = two(Filter::Nearest, Wrap::Repeat);
        texture.factor = [0.5; 3];
        // A grey is level at its value.
        assert!((texture.at([0.75, 0.5]).at(550.0) - 0.5).abs() < 1e-3);
    }
}

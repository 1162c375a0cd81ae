//! The reflectances of all RGB colours, for textures: a table that is looked up where a ray hits.
//!
//! The table is made once, when the first texture is read, and is the same on any number of threads. A
//! colour is parted as Jakob & Hanika (2019) do: which primary is the largest, its value z, and the other
//! two over it. Between entries the coefficients are interpolated linearly in all three.
//!
//! Promises a colour within ΔE00 0.5 of that asked for (tested).

use std::sync::LazyLock;

use rayon::prelude::*;

use super::sigmoid::Sigmoid;
use super::uplift;

/// Entries along each of the three axes.
const SIZE: usize = 36;

static TABLE: LazyLock<UpliftTable> = LazyLock::new(UpliftTable::new);

/// Coefficients for each largest primary, then by z, then by the two ratios.
pub(crate) struct UpliftTable {
    entries: Vec<[f64; 3]>,
    z: Axis,
    ratio: Axis,
}

/// The values of the entries along an axis, in rising order from 0 to 1.
struct Axis([f64; SIZE]);

impl Axis {
    fn new(value: fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|entry| {
            value(entry as f64 / (SIZE - 1) as f64)
        }))
    }

    /// The entry at or before a value, not the last, and what part of the way to the next the value is.
    fn place(&self, value: f64) -> (usize, f64) {
        let above = self.0.partition_point(|&entry| entry <= value);
        let before = above.saturating_sub(1).min(SIZE - 2);
        let (from, to) = (self.0[before], self.0[before + 1]);
        (before, (value - from) / (to - from))
    }
}

impl UpliftTable {
    /// The table, made when first asked for.
    pub(crate) fn shared() -> &'static Self {
        &TABLE
    }

    fn new() -> Self {
        // Denser towards 0 and 1, where the coefficients change fastest.
        let z = Axis::new(|part| {
            let polynomial = 35.0 - part * (84.0 - part * (70.0 - 20.0 * part));
            (part * part) * (part * part) * polynomial
        });
        let ratio = Axis::new(|part| 1.0 - (1.0 - part * part) * (1.0 - part * part).sqrt());
        let columns: Vec<[usize; 3]> = (0..3 * SIZE * SIZE)
            .map(|column| [column / (SIZE * SIZE), column / SIZE % SIZE, column % SIZE])
            .collect();
        let fitted: Vec<Vec<Sigmoid>> = columns
            .par_iter()
            .map(|&[largest, y, x]| {
                let colours = z.0.iter().map(|&z| {
                    let mut rgb = [z; 3];
                    rgb[(largest + 1) % 3] = z * ratio.0[x];
                    rgb[(largest + 2) % 3] = z * ratio.0[y];
                    rgb
                });
                uplift::sigmoids_along(&colours.collect::<Vec<_>>())
            })
            .collect();
        let mut entries = vec![[0.0; 3]; 3 * SIZE * SIZE * SIZE];
        for (&[largest, y, x], column) in columns.iter().zip(&fitted) {
            for (k, curve) in column.iter().enumerate() {
                let size = size_at(z.0[k]);
                entries[entry_of(largest, [k, y, x])] =
                    curve.coefficients.map(|value| f64::from(value) / size);
            }
        }
        Self { entries, z, ratio }
    }

    /// The reflectance of a linear sRGB colour; values beyond 0 and 1 are held to that.
    pub(crate) fn at(&self, rgb: [f64; 3]) -> Sigmoid {
        let rgb = rgb.map(uplift::held_to_unit);
        let mut largest = 0;
        for primary in 1..3 {
            if rgb[primary] > rgb[largest] {
                largest = primary;
            }
        }
        let brightest = rgb[largest].max(f64::MIN_POSITIVE);
        let (k, part_k) = self.z.place(rgb[largest]);
        let (x, part_x) = self.ratio.place(rgb[(largest + 1) % 3] / brightest);
        let (y, part_y) = self.ratio.place(rgb[(largest + 2) % 3] / brightest);
        let mut coefficients = [0.0; 3];
        for corner in 0..8 {
            let [dx, dy, dk] = [corner & 1, corner >> 1 & 1, corner >> 2];
            let share = part_of(dx, part_x) * part_of(dy, part_y) * part_of(dk, part_k);
            let entry = self.entries[entry_of(largest, [k + dk, y + dy, x + dx])];
            for (sum, value) in coefficients.iter_mut().zip(entry) {
                *sum += share * value;
            }
        }
        let size = size_at(rgb[largest]);
        Sigmoid::rounded(coefficients.map(|value| value * size))
    }
}

/// How large coefficients are at a z: as those of a grey near 0 and near 1, where they have no end.
///
/// Entries are stored over this, so that what is interpolated is level.
fn size_at(z: f64) -> f64 {
    let [least, most] = uplift::WITHIN;
    ((z + least) * (2.0 - most - z)).sqrt().recip()
}

/// How much the entry before (0) or after (1) counts at a part of the way between them.
fn part_of(side: usize, part: f64) -> f64 {
    if side == 0 { 1.0 - part } else { part }
}

fn entry_of(largest: usize, [k, y, x]: [usize; 3]) -> usize {
    ((largest * SIZE + k) * SIZE + y) * SIZE + x
}

#[cfg(test)]
mod tests {
    use super::super::uplift::tests::{colour_error, largest_error, linear};
    use super::*;

    #[test]
    fn every_colour_of_a_dense_grid_comes_back_within_half_a_unit() {
        let table = UpliftTable::shared();
        // 38 steps fall between the entries; 0 and 1 are among them.
        let (most, mean) = largest_error(38, |rgb| table.at(rgb));
        assert!(most < 0.5 && mean < 0.1, "largest {most}, mean {mean}");
    }

    #[test]
    fn a_table_colour_is_near_the_fitted_one() {
        for code in [
            [0.8, 0.3, 0.1],
            [0.1, 0.5, 0.9],
            [0.5, 0.5, 0.5],
            [0.0; 3],
            [1.0; 3],
        ] {
            let rgb = code.map(linear);
            assert!(
                colour_error(rgb, UpliftTable::shared().at(rgb)) < 0.2,
                "{code:?}"
            );
            let curves = [
                UpliftTable::shared().at(rgb),
                uplift::sigmoid_of_linear_srgb(rgb),
            ];
            for nm in (400..=700).step_by(10) {
                let [table, fitted] = curves.map(|curve| curve.at(f64::from(nm)));
                assert!(
                    (table - fitted).abs() < 0.02,
                    "{code:?} at {nm} nm: {table} {fitted}"
                );
            }
        }
    }

    #[test]
    fn colours_beyond_the_cube_and_not_numbers_give_a_reflectance() {
        for rgb in [
            [-1.0, 2.0, 0.5],
            [f64::NAN; 3],
            [f64::INFINITY, 0.0, f64::NAN],
        ] {
            let curve = UpliftTable::shared().at(rgb);
            assert!((0.0..=1.0).contains(&curve.at(550.0)), "{rgb:?}");
        }
    }
}

//! From an RGB colour to a reflectance that has it under D65.
//!
//! The reflectance is a [`Sigmoid`]; its three coefficients are found by damped Gauss–Newton steps on the
//! colour error in CIELAB, along a path from a grey, so that every step starts near its end. A grey is
//! exactly level, so neutral surfaces stay neutral under any light and any quadrature.
//!
//! Promises a colour within ΔE00 0.5 for every colour of the sRGB cube (tested).
//!
//! Source: Jakob & Hanika (2019), *Comput. Graph. Forum* 38(2), 147–155, section 4.

use std::sync::LazyLock;

use super::sigmoid::{Sigmoid, sigmoid};
use super::{Emission, cie};
use crate::matrix3::{self, Matrix3};
use crate::opponent::LINEAR_SRGB_FROM_XYZ;

/// Steps along the path from the grey to the colour.
const PATH_STEPS: u32 = 6;
/// Damped steps at most, on each step of the path and at its end.
const MOST_ITERATIONS: [u32; 2] = [8, 60];
/// A colour error in CIELAB units that nobody sees.
const GOOD_ENOUGH: f64 = 1e-3;
/// Linear RGB is held to this, off the faces of the cube, where the coefficients would have no end.
pub(super) const WITHIN: [f64; 2] = [3e-6, 1.0 - 2e-3];

static FITTER: LazyLock<Fitter> = LazyLock::new(Fitter::new);

/// The reflectance of a linear sRGB colour; values beyond 0 and 1 are held to that.
pub(crate) fn sigmoid_of_linear_srgb(rgb: [f64; 3]) -> Sigmoid {
    let rgb = rgb.map(held_to_unit);
    let [r, g, b] = rgb;
    if r == g && g == b {
        return Sigmoid::constant(r);
    }
    Sigmoid::rounded(FITTER.coefficients(rgb))
}

/// The reflectances of colours that follow each other closely, each fitted from the one before.
///
/// The middle one is fitted first, then those towards both ends.
pub(super) fn sigmoids_along(colours: &[[f64; 3]]) -> Vec<Sigmoid> {
    let mut fitted = vec![Sigmoid::default(); colours.len()];
    let middle = colours.len() / 2;
    let start = FITTER.coefficients(colours[middle]);
    let mut walk = |places: &mut dyn Iterator<Item = usize>| {
        let mut coefficients = start;
        for place in places {
            let rgb = within_margin(colours[place]);
            let [r, g, b] = rgb;
            coefficients = if r == g && g == b {
                [0.0, 0.0, grey_x(r)]
            } else {
                FITTER.refined(coefficients, rgb, MOST_ITERATIONS[1])
            };
            fitted[place] = Sigmoid::rounded(coefficients);
        }
    };
    walk(&mut (middle..colours.len()));
    walk(&mut (0..middle).rev());
    fitted
}

/// A value from 0 to 1; what is not a number is 0.
pub(super) fn held_to_unit(primary: f64) -> f64 {
    if primary.is_nan() {
        0.0
    } else {
        primary.clamp(0.0, 1.0)
    }
}

fn within_margin(rgb: [f64; 3]) -> [f64; 3] {
    rgb.map(|primary| primary.clamp(WITHIN[0], WITHIN[1]))
}

/// The sums over wavelengths that give the colour of a reflectance under D65.
struct Fitter {
    rows: Vec<Row>,
    xyz_from_rgb: Matrix3,
    white: [f64; 3],
}

struct Row {
    t: f64,
    /// D65 times the colour-matching functions, over the sum of ȳ.
    weights: [f64; 3],
}

/// A colour and how it changes with the coefficients.
struct Colour {
    lab: [f64; 3],
    /// For each of L*, a*, b* the derivatives by c0, c1, c2.
    slopes: Matrix3,
}

impl Fitter {
    /// Every 5 nm, a weight holding what linear interpolation would take from the 1 nm around it.
    const STEP_NM: u16 = 5;

    fn new() -> Self {
        let step = f64::from(Self::STEP_NM);
        let light = Emission::named("D65");
        let power = |nm: f64| light.as_ref().map_or(0.0, |light| light.at(nm));
        let row = |nm: u16| {
            let nm = f64::from(nm);
            let mut weights = [0.0; 3];
            for near in cie::colour_matching() {
                let share = (1.0 - (near.wavelength_nm - nm).abs() / step).max(0.0);
                let scale = share * power(near.wavelength_nm) / cie::sum_of_y();
                for (weight, value) in weights.iter_mut().zip(near.xyz) {
                    *weight += scale * value;
                }
            }
            Row {
                t: Sigmoid::t(nm),
                weights,
            }
        };
        let rows: Vec<Row> = (360..=830)
            .step_by(usize::from(Self::STEP_NM))
            .map(row)
            .collect();
        let xyz_from_rgb = matrix3::inverse(&LINEAR_SRGB_FROM_XYZ);
        Self {
            rows,
            white: matrix3::times(&xyz_from_rgb, [1.0; 3]),
            xyz_from_rgb,
        }
    }

    /// The coefficients of a linear colour within the cube.
    fn coefficients(&self, rgb: [f64; 3]) -> [f64; 3] {
        let rgb = within_margin(rgb);
        let mean = rgb.iter().sum::<f64>() / 3.0;
        let mut coefficients = [0.0, 0.0, grey_x(mean)];
        for step in 1..=PATH_STEPS {
            let part = f64::from(step) / f64::from(PATH_STEPS);
            let on_path = rgb.map(|primary| mean + part * (primary - mean));
            let most = MOST_ITERATIONS[usize::from(step == PATH_STEPS)];
            coefficients = self.refined(coefficients, on_path, most);
        }
        coefficients
    }

    /// Better coefficients for a colour, from coefficients that are near.
    ///
    /// Levenberg's damping: a step that makes the error larger is taken back and made shorter.
    fn refined(&self, start: [f64; 3], rgb: [f64; 3], most_iterations: u32) -> [f64; 3] {
        let target = self.lab(matrix3::times(&self.xyz_from_rgb, rgb));
        let mut coefficients = start;
        let mut colour = self.colour(coefficients);
        let mut error = squared_distance(colour.lab, target);
        let mut damping = 1e-6;
        for _ in 0..most_iterations {
            if error < GOOD_ENOUGH * GOOD_ENOUGH {
                break;
            }
            let step = damped_step(&colour, target, damping);
            let tried = [0, 1, 2].map(|i| coefficients[i] + step[i]);
            let tried_colour = self.colour(tried);
            let tried_error = squared_distance(tried_colour.lab, target);
            if tried_error < error {
                (coefficients, colour, error) = (tried, tried_colour, tried_error);
                damping = f64::max(damping * 0.1, 1e-12);
            } else {
                damping *= 10.0;
            }
        }
        coefficients
    }

    fn colour(&self, [c0, c1, c2]: [f64; 3]) -> Colour {
        let mut xyz = [0.0; 3];
        let mut slopes = [[0.0; 3]; 3];
        for row in &self.rows {
            let x = (c0 * row.t + c1) * row.t + c2;
            let squared = 1.0 + x * x;
            let root = squared.sqrt();
            let slope = 0.5 / (squared * root);
            let by_coefficient = [slope * row.t * row.t, slope * row.t, slope];
            for (place, weight) in row.weights.into_iter().enumerate() {
                xyz[place] += weight * sigmoid(x);
                for (sum, by) in slopes[place].iter_mut().zip(by_coefficient) {
                    *sum += weight * by;
                }
            }
        }
        Colour {
            lab: self.lab(xyz),
            slopes: self.lab_slopes(xyz, &slopes),
        }
    }

    fn lab(&self, xyz: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| lab_curve(xyz[i] / self.white[i]));
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// The chain rule from XYZ to CIELAB.
    fn lab_slopes(&self, xyz: [f64; 3], slopes: &Matrix3) -> Matrix3 {
        let [x, y, z] = [0, 1, 2].map(|i| {
            let by_t = lab_curve_slope(xyz[i] / self.white[i]) / self.white[i];
            slopes[i].map(|slope| slope * by_t)
        });
        [
            y.map(|y| 116.0 * y),
            [0, 1, 2].map(|i| 500.0 * (x[i] - y[i])),
            [0, 1, 2].map(|i| 200.0 * (y[i] - z[i])),
        ]
    }
}

/// The quadratic's value that gives a level reflectance.
fn grey_x(reflectance: f64) -> f64 {
    (reflectance - 0.5) / (reflectance * (1.0 - reflectance)).sqrt()
}

/// The step that solves `(JᵀJ + damping · diagonal) step = Jᵀ(target − colour)`.
fn damped_step(colour: &Colour, target: [f64; 3], damping: f64) -> [f64; 3] {
    let transposed = matrix3::transpose(&colour.slopes);
    let mut normal = matrix3::product(&transposed, &colour.slopes);
    for (place, row) in normal.iter_mut().enumerate() {
        row[place] = row[place] * (1.0 + damping) + 1e-12;
    }
    let missing = [0, 1, 2].map(|i| target[i] - colour.lab[i]);
    let step = matrix3::times(
        &matrix3::inverse(&normal),
        matrix3::times(&transposed, missing),
    );
    step.map(|change| if change.is_finite() { change } else { 0.0 })
}

fn squared_distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter()
        .zip(other)
        .map(|(one, other)| (one - other) * (one - other))
        .sum()
}

/// The curve of CIE 1976 L*a*b*.
fn lab_curve(t: f64) -> f64 {
    if t > LAB_KNEE {
        libm::cbrt(t)
    } else {
        t * (29.0 * 29.0) / (3.0 * 36.0) + 4.0 / 29.0
    }
}

fn lab_curve_slope(t: f64) -> f64 {
    if t > LAB_KNEE {
        let root = libm::cbrt(t);
        1.0 / (3.0 * root * root)
    } else {
        (29.0 * 29.0) / (3.0 * 36.0)
    }
}

/// (6/29)³.
const LAB_KNEE: f64 = 216.0 / 24_389.0;

#[cfg(test)]
pub(super) mod tests {
    use protocols::{PerChannel, Quadrature};

    use super::super::WavelengthRule;
    use super::super::colour_difference::{ciede2000, lab_from_xyz};
    use super::*;
    use crate::opponent::xyz_from_ac1c2;

    /// The colour of a reflectance under D65, summed at 1 nm.
    fn xyz_at_1_nm(curve: Sigmoid) -> [f64; 3] {
        static WEIGHTS: LazyLock<Vec<(f64, [f64; 3])>> = LazyLock::new(|| {
            let light = Emission::named("D65").unwrap();
            let rows = cie::colour_matching().iter();
            let weights = rows.map(|row| {
                let power = light.at(row.wavelength_nm) / cie::sum_of_y();
                (row.wavelength_nm, row.xyz.map(|value| power * value))
            });
            weights.collect()
        });
        let mut xyz = [0.0; 3];
        for &(nm, weights) in WEIGHTS.iter() {
            for (sum, weight) in xyz.iter_mut().zip(weights) {
                *sum += curve.at(nm) * weight;
            }
        }
        xyz
    }

    /// CIEDE2000 between a linear colour and a reflectance under D65.
    pub(in crate::spectra) fn colour_error(rgb: [f64; 3], curve: Sigmoid) -> f64 {
        let xyz_from_rgb = matrix3::inverse(&LINEAR_SRGB_FROM_XYZ);
        let white = matrix3::times(&xyz_from_rgb, [1.0; 3]);
        let lab = |xyz| lab_from_xyz(xyz, white);
        let target = lab(matrix3::times(&xyz_from_rgb, rgb));
        ciede2000(target, lab(xyz_at_1_nm(curve)))
    }

    /// The inverse of the transfer curve, as IEC 61966-2-1 prints it.
    pub(in crate::spectra) fn linear(encoded: f64) -> f64 {
        if encoded <= 0.040_45 {
            encoded / 12.92
        } else {
            ((encoded + 0.055) / 1.055).powf(2.4)
        }
    }

    /// The largest and the mean error over a grid of the encoded cube.
    pub(in crate::spectra) fn largest_error(
        steps: u32,
        curve: impl Fn([f64; 3]) -> Sigmoid,
    ) -> (f64, f64) {
        let side = steps + 1;
        let (mut most, mut sum) = (0.0, 0.0);
        for place in 0..side * side * side {
            let code = [place % side, place / side % side, place / side / side];
            let rgb = code.map(|code| linear(f64::from(code) / f64::from(steps)));
            let error = colour_error(rgb, curve(rgb));
            sum += error;
            most = f64::max(most, error);
            if error > 0.4 {
                println!("{code:?} {error}");
            }
        }
        (most, sum / f64::from(side * side * side))
    }

    #[test]
    fn every_colour_of_a_dense_grid_comes_back_within_half_a_unit() {
        let (most, mean) = largest_error(16, sigmoid_of_linear_srgb);
        assert!(most < 0.5 && mean < 0.05, "largest {most}, mean {mean}");
    }

    #[test]
    fn random_8_bit_colours_come_back_within_half_a_unit() {
        let mut state = 1_u32;
        for _ in 0..1_000 {
            let code = [0; 3].map(|_: u8| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                f64::from(state >> 24) / 255.0
            });
            let rgb = code.map(linear);
            let error = colour_error(rgb, sigmoid_of_linear_srgb(rgb));
            assert!(error < 0.5, "{error} at {code:?}");
        }
    }

    #[test]
    fn sixteen_bands_add_little_to_the_error() {
        // Two errors add: that of the fit, and that of the rule over smooth reflectances, which measured
        // reflectances put at .21 in the mean (`quadrature`).
        let light = Emission::named("D65").unwrap();
        let rule = WavelengthRule::new(Quadrature::Bands(16));
        let powers = rule.power_at_nodes(&light);
        let xyz_from_rgb = matrix3::inverse(&LINEAR_SRGB_FROM_XYZ);
        let white = matrix3::times(&xyz_from_rgb, [1.0; 3]);
        let (mut most, mut sum) = (0.0, 0.0);
        for place in 0..9 * 9 * 9 {
            let rgb =
                [place % 9, place / 9 % 9, place / 81].map(|code| linear(f64::from(code) / 8.0));
            let curve = sigmoid_of_linear_srgb(rgb);
            let channels = PerChannel::from_fn(|channel| {
                let nodes = rule
                    .nodes_nm
                    .iter()
                    .zip(&rule.weights[channel])
                    .zip(&powers);
                nodes
                    .map(|((&nm, weight), power)| weight * power * curve.at(nm))
                    .sum()
            });
            let target = lab_from_xyz(matrix3::times(&xyz_from_rgb, rgb), white);
            let error = ciede2000(target, lab_from_xyz(xyz_from_ac1c2(channels), white));
            sum += error;
            most = f64::max(most, error);
        }
        let mean = sum / 729.0;
        assert!(most < 2.0 && mean < 0.3, "largest {most}, mean {mean}");
    }
}

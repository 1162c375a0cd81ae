//! A display by a meter's readings of patches: its primaries, white and transfer curves, and how well they fit.
//!
//! The model is additive light with a curve for each primary:
//!
//! ```text
//! XYZ(codes) = black + M · v,    v_p = (s_p(d_p) − s_p(0)) / (1 − s_p(0)),    d = code / 255
//! s_p(d) = max(0, g_p d + 1 − g_p)^γ_p
//! ```
//!
//! *black* is the reading of black. The columns of *M* have the chromaticities of the primaries and the lengths that
//! add up to the white, black taken off both. *v* at each grey is `M⁻¹ (XYZ − black)`, and gain and gamma of a primary
//! are the least squares over the greys in `v^(1/3)`, as lightness goes, so that dark steps count as they are seen.
//!
//! Source: the gain-offset-gamma model of Berns (1996), *Displays* 16(4), 173–182, with black taken off.

use protocols::matrix3::{self, Matrix3};
use serde::{Deserialize, Serialize};

use crate::display::Characterised;
use crate::{Patch, Reading};

/// Bounds of the exponent of a transfer curve.
const GAMMAS: [f64; 2] = [1.0, 4.0];
/// Bounds of its gain.
const GAINS: [f64; 2] = [0.5, 1.5];

/// The readings of all patches of one display.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// One for each patch, in any order.
    pub readings: Vec<Reading>,
}

/// The transfer curve of one primary above black: 0 at no drive and 1 at full drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// How much of the drive is signal; the rest is offset.
    pub gain: f64,
    /// The exponent.
    pub gamma: f64,
}

impl Curve {
    /// The light of a drive from 0 to 1, as a part of the most.
    ///
    /// ```
    /// // Half a drive at gamma 2 is a quarter of the light.
    /// let curve = experiment::Curve { gain: 1.0, gamma: 2.0 };
    /// assert!((curve.light(0.5) - 0.25).abs() < 1e-12);
    /// ```
    pub fn light(self, drive: f64) -> f64 {
        let signal = |drive: f64| {
            let signal = self.gain * drive + 1.0 - self.gain;
            libm::pow(signal.max(0.0), self.gamma)
        };
        let idle = signal(0.0);
        (signal(drive) - idle) / (1.0 - idle)
    }

    /// The curve with the least squares in the cube root of the light, over pairs of drive and light.
    fn fitted(points: &[(f64, f64)]) -> Self {
        let cost = |curve: Self| -> f64 {
            let error = |(drive, light): &(f64, f64)| {
                libm::cbrt(curve.light(*drive)) - libm::cbrt(light.max(0.0))
            };
            points.iter().map(|point| error(point).powi(2)).sum()
        };
        let gamma_for = |gain: f64| least(GAMMAS, |gamma| cost(Self { gain, gamma }));
        let gain = least(GAINS, |gain| {
            let gamma = gamma_for(gain);
            cost(Self { gain, gamma })
        });
        Self {
            gain,
            gamma: gamma_for(gain),
        }
    }
}

/// Where a function with one valley is least, by golden sections, to a part in 10⁹ of the bounds.
fn least([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    const SECTION: f64 = 0.618_033_988_749_894_9;
    let places = |low: f64, high: f64| {
        let step = SECTION * (high - low);
        [high - step, low + step]
    };
    let [mut left, mut right] = places(low, high);
    let (mut of_left, mut of_right) = (value(left), value(right));
    for _ in 0..44 {
        if of_left <= of_right {
            high = right;
            (right, of_right) = (left, of_left);
            left = places(low, high)[0];
            of_left = value(left);
        } else {
            low = left;
            (left, of_left) = (right, of_right);
            right = places(low, high)[1];
            of_right = value(right);
        }
    }
    f64::midpoint(low, high)
}

/// How far the model is from one reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Which patch.
    pub patch: Patch,
    /// The luminance of the model less that of the reading, as a part of white's.
    pub luminance_part: f64,
    /// Their distance in u′, v′, where both have light.
    pub delta_uv: Option<f64>,
}

/// What was fitted to the readings.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    black_xyz: [f64; 3],
    xyz_from_rgb: Matrix3,
    /// The curves of red, green and blue.
    pub curves: [Curve; 3],
    /// The reading of white.
    pub white: Reading,
    /// The luminance of black.
    pub black_cd_m2: f64,
    /// The luminances of red, green and blue together, as a part of white's, less one; black taken off all.
    pub additivity: f64,
    /// The distance in u′, v′ between that sum and white.
    pub additivity_uv: f64,
    /// The model against each reading.
    pub residuals: Vec<Residual>,
}

impl Calibration {
    /// The reading of a patch, if there is one.
    pub fn reading(&self, patch: Patch) -> Option<Reading> {
        let mut readings = self.readings.iter().copied();
        readings.find(|reading| reading.patch == patch)
    }

    /// The display that the readings speak of.
    ///
    /// # Errors
    ///
    /// In words: a patch was not read or twice, a reading cannot be, or the primaries and white are no display's.
    pub fn fit(&self) -> Result<Fit, String> {
        self.check()?;
        let read = |patch: Patch| {
            self.reading(patch)
                .ok_or_else(|| format!("{} was not read", patch.name()))
        };
        let (black, white) = (read(Patch::BLACK)?, read(Patch::WHITE)?);
        let black_xyz = black.xyz();
        let above_black = |reading: Reading| minus(reading.xyz(), black_xyz);
        let [red, green, blue] = Patch::PRIMARIES;
        let primaries = [read(red)?, read(green)?, read(blue)?].map(above_black);
        let white_xyz = above_black(white);
        let as_read = matrix3::transpose(&primaries);
        let parts = matrix3::times(&matrix3::inverse(&as_read), white_xyz);
        if !parts.iter().all(|part| (0.5..2.0).contains(part)) {
            return Err(format!(
                "white is {parts:.2?} of red, green and blue, expected about 1 of each; were the patches mixed up?"
            ));
        }
        let xyz_from_rgb =
            as_read.map(|row| [0, 1, 2].map(|primary| row[primary] * parts[primary]));
        let rgb_from_xyz = matrix3::inverse(&xyz_from_rgb);
        let greys = self
            .readings
            .iter()
            .filter(|reading| is_grey(reading.patch));
        let lights: Vec<(f64, [f64; 3])> = greys
            .map(|grey| {
                let drive = f64::from(grey.patch.codes[0]) / 255.0;
                (drive, matrix3::times(&rgb_from_xyz, above_black(*grey)))
            })
            .collect();
        let curves = [0, 1, 2].map(|primary| {
            let points: Vec<(f64, f64)> = (lights.iter())
                .map(|(drive, lights)| (*drive, lights[primary]))
                .collect();
            Curve::fitted(&points)
        });
        let sum = [0, 1, 2].map(|row| as_read[row].iter().sum::<f64>());
        let mut fit = Fit {
            black_xyz,
            xyz_from_rgb,
            curves,
            white,
            black_cd_m2: black.luminance_cd_m2,
            additivity: sum[1] / white_xyz[1] - 1.0,
            additivity_uv: distance(
                Reading::of(Patch::WHITE, sum),
                Reading::of(Patch::WHITE, white_xyz),
            )
            .unwrap_or(0.0),
            residuals: Vec::new(),
        };
        fit.residuals = self
            .readings
            .iter()
            .map(|read| fit.residual(*read))
            .collect();
        Ok(fit)
    }

    /// Every patch read once, each reading possible, and none darker than black.
    fn check(&self) -> Result<(), String> {
        for patch in Patch::all() {
            let count = self
                .readings
                .iter()
                .filter(|read| read.patch == patch)
                .count();
            if count != 1 {
                let times = ["was not read", "was read more than once"];
                return Err(format!("{} {}", patch.name(), times[count.min(1)]));
            }
        }
        if let Some(fault) = self.readings.iter().find_map(|reading| reading.fault()) {
            return Err(fault);
        }
        let black = self
            .reading(Patch::BLACK)
            .map_or(0.0, |black| black.luminance_cd_m2);
        let mut others = self
            .readings
            .iter()
            .filter(|read| read.patch != Patch::BLACK);
        match others.find(|read| read.luminance_cd_m2 <= black) {
            Some(reading) => Err(format!(
                "{}: found {} cd/m2, expected more than black's {black}",
                reading.patch.name(),
                reading.luminance_cd_m2
            )),
            None => Ok(()),
        }
    }
}

impl Fit {
    /// The tristimulus values of a patch by the model, in cd/m².
    pub fn xyz(&self, patch: Patch) -> [f64; 3] {
        let drive = |primary: usize| f64::from(patch.codes[primary]) / 255.0;
        let lights = [0, 1, 2].map(|primary| self.curves[primary].light(drive(primary)));
        let light = matrix3::times(&self.xyz_from_rgb, lights);
        [0, 1, 2].map(|index| self.black_xyz[index] + light[index])
    }

    /// What was found, in a line.
    pub fn in_words(&self) -> String {
        let Reading {
            x,
            y,
            luminance_cd_m2,
            ..
        } = self.white;
        let gammas = self
            .curves
            .map(|curve| format!("{:.2}", curve.gamma))
            .join(", ");
        format!(
            "read patch by patch, white ({x}, {y}) of {luminance_cd_m2} cd/m2, black {} cd/m2, gamma {gammas}, red + green + blue {:+.1} % of white, the model within {:.1} % of white",
            self.black_cd_m2,
            self.additivity * 100.0,
            self.worst_luminance() * 100.0
        )
    }

    /// The largest distance of a luminance from its reading, as a part of white's.
    pub fn worst_luminance(&self) -> f64 {
        let parts = self
            .residuals
            .iter()
            .map(|residual| residual.luminance_part.abs());
        parts.fold(0.0, f64::max)
    }

    /// How colours get to this display: its light above black.
    pub(crate) fn display(&self) -> Characterised {
        let [red, green, blue] = self.curves;
        Characterised::new(
            &self.xyz_from_rgb,
            [
                &|drive| red.light(drive),
                &|drive| green.light(drive),
                &|drive| blue.light(drive),
            ],
        )
    }

    fn residual(&self, read: Reading) -> Residual {
        let model = Reading::of(read.patch, self.xyz(read.patch));
        Residual {
            patch: read.patch,
            luminance_part: (model.luminance_cd_m2 - read.luminance_cd_m2)
                / self.white.luminance_cd_m2,
            delta_uv: distance(model, read),
        }
    }
}

fn is_grey(patch: Patch) -> bool {
    let [red, green, blue] = patch.codes;
    red == green && green == blue && red > 0
}

fn minus(one: [f64; 3], other: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|index| one[index] - other[index])
}

/// The distance of two colours in u′, v′.
fn distance(one: Reading, other: Reading) -> Option<f64> {
    let ([u, v], [other_u, other_v]) = (one.uv()?, other.uv()?);
    Some(libm::hypot(u - other_u, v - other_v))
}

#[cfg(test)]
mod tests;

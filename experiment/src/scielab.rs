//! S-CIELAB: CIELAB differences of images after each opponent channel was blurred as the eye blurs it.
//!
//! XYZ → opponent channels → one filter for each, a sum of Gaussians in degrees → XYZ → CIELAB (D65) → ΔE*ab, averaged
//! over the pixels. The filters are one degree wide; images are mirrored at their edges.
//!
//! Source: Zhang & Wandell (1997), "A spatial extension of CIELAB for digital color-image reproduction", *J. Soc. Inf.
//! Display* 5(1), 61–63; widths, weights and the sampling of the filters are those of their own program (1996).
//!
//! Not here: how a difference becomes a rating (`prediction`).

use crate::ScreenImage;

/// Opponent channels (luminance, red–green, blue–yellow) from XYZ of the 2° observer, times 1000.
const OPPONENT_FROM_XYZ: [[f64; 3]; 3] = [
    [278.7336, 721.8031, -106.5520],
    [-448.7736, 289.8056, 77.1569],
    [85.9513, -589.9859, 501.1089],
];
/// For each channel its Gaussians: the full width at half height in degrees, and the weight.
const FILTERS: [&[[f64; 2]]; 3] = [
    &[[0.05, 1.003_27], [0.225, 0.114_416], [7.0, -0.117_686]],
    &[[0.0685, 0.616_725], [0.826, 0.383_275]],
    &[[0.092, 0.567_885], [0.6451, 0.432_115]],
];
/// Below so many samples a degree the filters are made finer and then read at the pixels.
const FINEST_SAMPLES_PER_DEGREE: f64 = 224.0;
/// XYZ from linear sRGB: IEC 61966-2-1.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [0.4124, 0.3576, 0.1805],
    [0.2126, 0.7152, 0.0722],
    [0.0193, 0.1192, 0.9505],
];

/// One number for each pixel, of each of three channels.
type Planes = [Vec<f64>; 3];

/// The filters of one viewing geometry.
#[derive(Clone, Debug)]
pub(crate) struct Scielab {
    /// For each channel its Gaussians, from the middle outward, and their weights.
    filters: [Vec<(Vec<f64>, f64)>; 3],
    xyz_from_opponent: [[f64; 3]; 3],
}

impl Scielab {
    pub(crate) fn new(pixels_per_degree: f64) -> Self {
        let of_channel = |gaussians: &[[f64; 2]]| -> Vec<(Vec<f64>, f64)> {
            (gaussians.iter())
                .map(|&[width_degrees, weight]| (kernel(width_degrees, pixels_per_degree), weight))
                .collect()
        };
        Self {
            filters: FILTERS.map(of_channel),
            xyz_from_opponent: inverse(&OPPONENT_FROM_XYZ),
        }
    }

    /// The mean ΔE*ab of two images of one size.
    pub(crate) fn difference(&self, test: &ScreenImage, reference: &ScreenImage) -> f64 {
        let (test, reference) = (self.lab(test), self.lab(reference));
        let n = test[0].len();
        let sum: f64 = (0..n)
            .map(|pixel| {
                let squares = (0..3)
                    .map(|channel| (test[channel][pixel] - reference[channel][pixel]).powi(2));
                squares.sum::<f64>().sqrt()
            })
            .sum();
        sum / n as f64
    }

    /// CIELAB of the filtered image.
    fn lab(&self, image: &ScreenImage) -> Planes {
        let [width, height] = image.size_px.map(|side| side as usize);
        let xyz = xyz_of(image);
        let mut opponent = converted(&OPPONENT_FROM_XYZ, &xyz);
        for (plane, filter) in opponent.iter_mut().zip(&self.filters) {
            *plane = filtered(plane, [width, height], filter);
        }
        lab_of(&converted(&self.xyz_from_opponent, &opponent))
    }
}

/// A Gaussian with this full width at half height, from the middle outward, so that the whole sums to 1.
///
/// Sampled finely, widened by the triangle that stands for drawing a line between two pixels, and read at the pixels;
/// cut at half a degree.
fn kernel(width_degrees: f64, pixels_per_degree: f64) -> Vec<f64> {
    let finer = (FINEST_SAMPLES_PER_DEGREE / pixels_per_degree)
        .ceil()
        .max(1.0);
    let samples_per_degree = pixels_per_degree * finer;
    let half = (samples_per_degree / 2.0).ceil() - 1.0;
    let alpha =
        2.0 * libm::sqrt(std::f64::consts::LN_2) / (width_degrees * samples_per_degree - 1.0);
    let gaussian = |x: f64| {
        if x.abs() > half {
            0.0
        } else {
            libm::exp(-alpha * alpha * x * x)
        }
    };
    let mut taps = Vec::new();
    let mut middle = 0.0;
    while middle <= half {
        let mut sum = gaussian(middle);
        let mut away = 1.0;
        while away < finer {
            let share = (finer - away) / finer;
            sum += share * (gaussian(middle - away) + gaussian(middle + away));
            away += 1.0;
        }
        taps.push(sum);
        middle += finer;
    }
    let total = 2.0 * taps.iter().sum::<f64>() - taps[0];
    taps.iter().map(|tap| tap / total).collect()
}

/// The weighted sum of what each Gaussian makes of a plane.
fn filtered(plane: &[f64], [width, height]: [usize; 2], filter: &[(Vec<f64>, f64)]) -> Vec<f64> {
    let mut sum = vec![0.0; plane.len()];
    for (kernel, weight) in filter {
        // Rows, turned; then what were columns, turned back.
        let rows = blurred_rows(plane, width, kernel);
        let turned = transposed(&rows, [width, height]);
        let columns = blurred_rows(&turned, height, kernel);
        for (total, value) in sum.iter_mut().zip(transposed(&columns, [height, width])) {
            *total += weight * value;
        }
    }
    sum
}

fn blurred_rows(plane: &[f64], width: usize, kernel: &[f64]) -> Vec<f64> {
    let radius = kernel.len() - 1;
    let mut blurred = Vec::with_capacity(plane.len());
    let mut padded = Vec::with_capacity(width + 2 * radius);
    for row in plane.chunks_exact(width) {
        padded.clear();
        padded.extend((0..width + 2 * radius).map(|place| row[mirrored(place, radius, width)]));
        blurred.extend((radius..radius + width).map(|place| {
            let sides = kernel.iter().enumerate().skip(1);
            sides.fold(kernel[0] * padded[place], |sum, (away, tap)| {
                tap.mul_add(padded[place - away] + padded[place + away], sum)
            })
        }));
    }
    blurred
}

/// The place in a row of `place - margin`, mirrored at the edges as often as it takes.
fn mirrored(place: usize, margin: usize, width: usize) -> usize {
    let period = 2 * width;
    let place = (place + period * (margin / period + 1) - margin) % period;
    if place < width {
        place
    } else {
        period - 1 - place
    }
}

fn transposed(plane: &[f64], [width, height]: [usize; 2]) -> Vec<f64> {
    let places = (0..width).flat_map(|x| (0..height).map(move |y| (x, y)));
    places.map(|(x, y)| plane[y * width + x]).collect()
}

fn xyz_of(image: &ScreenImage) -> Planes {
    let linear = |channel: usize| -> Vec<f64> {
        let bytes = image.rgb.iter().skip(channel).step_by(3);
        bytes
            .map(|&byte| linear_of(f64::from(byte) / 255.0))
            .collect()
    };
    converted(
        &XYZ_FROM_RGB.map(|row| row.map(|entry| 1000.0 * entry)),
        &[linear(0), linear(1), linear(2)],
    )
}

/// The transfer function of sRGB: IEC 61966-2-1.
fn linear_of(coded: f64) -> f64 {
    if coded <= 0.040_45 {
        coded / 12.92
    } else {
        libm::pow((coded + 0.055) / 1.055, 2.4)
    }
}

/// Channels through a matrix times 1000.
fn converted(matrix: &[[f64; 3]; 3], planes: &Planes) -> Planes {
    let [a, b, c] = planes;
    [0, 1, 2].map(|row| {
        let [x, y, z] = matrix[row].map(|entry| entry / 1000.0);
        let pixels = a.iter().zip(b).zip(c);
        pixels.map(|((a, b), c)| x * a + y * b + z * c).collect()
    })
}

/// CIELAB under the white of sRGB (D65), CIE 15.
fn lab_of(xyz: &Planes) -> Planes {
    let white = XYZ_FROM_RGB.map(|row| row.iter().sum::<f64>());
    let f = |value: f64| {
        if value > 216.0 / 24389.0 {
            libm::cbrt(value)
        } else {
            (24389.0 / 27.0 * value + 16.0) / 116.0
        }
    };
    let of = |channel: usize| -> Vec<f64> {
        let values = xyz[channel].iter();
        values.map(|value| f(value / white[channel])).collect()
    };
    let [x, y, z] = [of(0), of(1), of(2)];
    let difference = |times: f64, plus: &[f64], minus: &[f64]| -> Vec<f64> {
        let pairs = plus.iter().zip(minus);
        pairs.map(|(plus, minus)| times * (plus - minus)).collect()
    };
    [
        y.iter().map(|y| 116.0 * y - 16.0).collect(),
        difference(500.0, &x, &y),
        difference(200.0, &y, &z),
    ]
}

/// The inverse of a matrix times 1000, again times 1000, by its cofactors.
fn inverse(matrix: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let m = matrix.map(|row| row.map(|entry| entry / 1000.0));
    let minor = |row: usize, column: usize| {
        let [a, b] = [(row + 1) % 3, (row + 2) % 3];
        let [c, d] = [(column + 1) % 3, (column + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|column| m[0][column] * minor(0, column)).sum();
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| 1000.0 * minor(column, row) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(size_px: [u32; 2], pixel: impl Fn(u32, u32) -> [u8; 3]) -> ScreenImage {
        let [width, height] = size_px;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        ScreenImage {
            size_px,
            rgb: places.flat_map(|(x, y)| pixel(x, y)).collect(),
        }
    }

    #[test]
    fn patches_without_detail_have_the_difference_of_cielab() {
        // sRGB red and green under D65, by the matrix of IEC 61966-2-1: L*a*b* 53.24, 80.09, 67.20 and
        // 87.73, -86.18, 83.18 (Lindbloom's calculator), so that the difference is 170.57.
        let scielab = Scielab::new(52.6);
        let red = image([70, 60], |_, _| [255, 0, 0]);
        let green = image([70, 60], |_, _| [0, 255, 0]);
        assert!((scielab.difference(&red, &green) - 170.57).abs() < 0.02);
        assert!(scielab.difference(&red, &red) < 1e-9);
    }

    #[test]
    fn a_kernel_attenuates_a_grating_as_a_gaussian_does() {
        // A Gaussian of standard deviation s has the transform exp(-2 (pi f s)^2); the triangle of the pixels
        // adds a variance of 1/6 pixel, and the width of the program is short by one of its samples.
        for (width_degrees, ppd, f) in
            [(0.092, 52.6, 4.0), (0.0685, 100.0, 6.0), (0.225, 52.6, 2.0)]
        {
            let kernel = kernel(width_degrees, ppd);
            let phase = std::f64::consts::TAU * f / ppd;
            let found: f64 = kernel[0]
                + (1..kernel.len())
                    .map(|n| 2.0 * kernel[n] * (phase * n as f64).cos())
                    .sum::<f64>();
            let finer = (224.0 / ppd).ceil();
            let fwhm = width_degrees - 1.0 / (ppd * finer);
            let variance =
                (fwhm / 2.354_820_045).powi(2) + (1.0 - 1.0 / (finer * finer)) / 6.0 / (ppd * ppd);
            let expected = (-2.0 * (std::f64::consts::PI * f).powi(2) * variance).exp();
            assert!(
                (found - expected).abs() < 2e-3,
                "{width_degrees} {ppd}: {found} and {expected}"
            );
        }
    }

    #[test]
    fn images_agree_with_the_authors_program_as_numpy_runs_it() {
        // tests/scielab/scielab.py, a transcription of the MATLAB of Zhang and Wandell, prints these.
        let reference = image([96, 80], |x, y| {
            let byte = |value: u32| u8::try_from(value % 256).unwrap();
            [byte(7 * x + 3 * y), byte(5 * x * y), byte(200 + 11 * y)]
        });
        let test = image([96, 80], |x, y| {
            let byte = |value: u32| u8::try_from(value % 256).unwrap();
            let checks = if (x / 4 + y / 4) % 2 == 0 { 12 } else { 0 };
            [
                byte(7 * x + 3 * y + checks),
                byte(5 * x * y),
                byte(200 + 11 * y + checks),
            ]
        });
        for (ppd, expected) in [
            (52.6, 3.526_239_952_696_305_7),
            (70.0, 3.118_588_024_631_191),
        ] {
            let found = Scielab::new(ppd).difference(&test, &reference);
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{ppd}: {found} and {expected}"
            );
        }
    }
}

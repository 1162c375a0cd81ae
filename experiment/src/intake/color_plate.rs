//! Plates of dots with a digit that differs from its ground only along one confusion axis.
//!
//! Each dot is white or the plate's colour, times a random luminance factor: brightness tells nothing of the
//! digit, and what a dichromat keeps of the colour is the same in both. The excursion is graded in parts of the
//! largest that an sRGB display shows at every luminance of the plate.
//!
//! Not a diagnosis: a plate on a display finds strong deficiencies and misses mild ones.
//!
//! Sources: the confusion axes are those of `confusion`; luminance noise in dots after Stilling and Ishihara,
//! as Regan, Reffin & Mollon (1994) describe it.

use protocols::PerChannel;
use protocols::opponent::linear_srgb_from_ac1c2;

use super::confusion::Axis;
use super::digit_mask;
use crate::display::{Display, ac1c2_of_srgb};
use crate::random::Random;

/// The width and height of a plate, in pixels of the screen.
pub(crate) const PLATE_PX: u32 = 480;
/// The luminance factors of the dots.
const FACTORS: [f64; 6] = [0.24, 0.28, 0.32, 0.36, 0.40, 0.44];
/// How much brighter the digit of a control plate is.
const CONTROL_EXCURSION: f64 = 1.0;
/// The radii of the dots, in pixels, the largest first, and how often each is tried.
const DARTS: [(f64, usize); 5] = [
    (12.0, 900),
    (9.5, 2500),
    (7.5, 5000),
    (6.0, 9000),
    (4.5, 14000),
];
/// How much of the plate's height the digit takes.
const DIGIT_HEIGHT: f64 = 0.74;

/// One plate, before it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorPlate {
    /// The confusion axis.
    pub axis: Axis,
    /// Which part of the largest excursion.
    pub grade: f64,
    /// The digit.
    pub digit: u8,
    key: String,
}

/// A plate, row by row, without the ground that shows between its dots.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateImage {
    /// Width and height.
    pub size_px: u32,
    /// A, C1 and C2 of each pixel, and how much of the pixel the dots cover.
    pixels: Vec<([f64; 3], f64)>,
}

/// A dot of a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Dot {
    centre: [f64; 2],
    radius: f64,
    pub(crate) is_digit: bool,
    pub(crate) ac1c2: PerChannel<f64>,
}

impl ColorPlate {
    /// A control plate, then every axis at every grade, the easy grades first, the axes of a grade by lot.
    pub(super) fn all_of(grades: &[f64], key: &str) -> Vec<Self> {
        if grades.is_empty() {
            return Vec::new();
        }
        let mut random = Random::keyed_by(&format!("{key}: plates"));
        let mut sorted = grades.to_vec();
        sorted.sort_by(|one, other| other.total_cmp(one));
        let mut kinds = vec![(Axis::Control, 1.0)];
        for grade in sorted {
            let mut axes = Axis::CONFUSED;
            random.shuffle(&mut axes);
            kinds.extend(axes.map(|axis| (axis, grade)));
        }
        let plate = |(index, (axis, grade)): (usize, (Axis, f64))| Self {
            axis,
            grade,
            digit: u8::try_from(random.index(10)).unwrap_or_default(),
            key: format!("{key}: plate {index}"),
        };
        kinds.into_iter().enumerate().map(plate).collect()
    }

    /// How far along its axis the digit lies from white; the sign is that with the larger room.
    pub fn excursion(&self) -> f64 {
        if self.axis == Axis::Control {
            return CONTROL_EXCURSION;
        }
        let (up, down) = (reach(self.axis, 1.0), reach(self.axis, -1.0));
        self.grade * if up >= down { up } else { -down }
    }

    /// The dots.
    pub(crate) fn dots(&self) -> Vec<Dot> {
        let mut random = Random::keyed_by(&self.key);
        let excursion = self.excursion();
        let (ground, figure) = (self.axis.color(0.0), self.axis.color(excursion));
        let mut dots = Vec::new();
        let size = f64::from(PLATE_PX);
        for (radius, darts) in DARTS {
            for _ in 0..darts {
                let centre = [(); 2].map(|()| size * random.uniform());
                if !has_room(&dots, centre, radius) {
                    continue;
                }
                let [x, y] = centre.map(|place| (place / size - 0.5) / DIGIT_HEIGHT);
                let is_digit = digit_mask::contains(self.digit, x, y);
                let factor = FACTORS[random.index(FACTORS.len())];
                let color = if is_digit { figure } else { ground };
                dots.push(Dot {
                    centre,
                    radius,
                    is_digit,
                    ac1c2: PerChannel::from_fn(|channel| factor * color[channel]),
                });
            }
        }
        dots
    }

    /// The plate as it is shown.
    pub fn image(&self) -> PlateImage {
        let width = PLATE_PX as usize;
        let mut pixels = vec![([0.0; 3], 0.0); width * width];
        for dot in self.dots() {
            let color = [dot.ac1c2.a, dot.ac1c2.c1, dot.ac1c2.c2];
            for (place, cover) in covered(&dot, width) {
                let (sum, whole) = &mut pixels[place];
                for (sum, value) in sum.iter_mut().zip(color) {
                    *sum += cover * value;
                }
                *whole += cover;
            }
        }
        PlateImage {
            size_px: PLATE_PX,
            pixels,
        }
    }
}

impl PlateImage {
    /// The codes for a display, on a ground of this grey (sRGB).
    pub fn on_grey(&self, ground_srgb: u8, display: &Display) -> Vec<u8> {
        let ground = ac1c2_of_srgb([ground_srgb; 3]);
        let ground = [ground.a, ground.c1, ground.c2];
        let bytes = |(sum, cover): &([f64; 3], f64)| {
            let [a, c1, c2] = [0, 1, 2].map(|i| sum[i] + (1.0 - cover) * ground[i]);
            display.shown(PerChannel { a, c1, c2 }).0
        };
        self.pixels.iter().flat_map(bytes).collect()
    }
}

/// How far white can go along an axis so that every luminance of the plate is in the gamut of sRGB.
fn reach(axis: Axis, sign: f64) -> f64 {
    let brightest = FACTORS.iter().copied().fold(0.0, f64::max);
    let is_shown = |excursion: f64| {
        let rgb = linear_srgb_from_ac1c2(axis.color(sign * excursion));
        rgb.iter()
            .all(|&value| (0.0..=1.0).contains(&(value * brightest)))
    };
    let (mut shown, mut not_shown) = (0.0, 10.0);
    for _ in 0..50 {
        let middle = f64::midpoint(shown, not_shown);
        if is_shown(middle) {
            shown = middle;
        } else {
            not_shown = middle;
        }
    }
    shown
}

/// Whether a dot lies in the round plate and a pixel away from every other dot.
fn has_room(dots: &[Dot], centre: [f64; 2], radius: f64) -> bool {
    let distance = |[x, y]: [f64; 2]| {
        libm::sqrt((centre[0] - x) * (centre[0] - x) + (centre[1] - y) * (centre[1] - y))
    };
    let half = f64::from(PLATE_PX) / 2.0;
    distance([half; 2]) + radius <= half
        && dots
            .iter()
            .all(|dot| distance(dot.centre) >= dot.radius + radius + 1.0)
}

/// The pixels of a dot, and which part of each it covers, by 4 × 4 points.
fn covered(dot: &Dot, width: usize) -> Vec<(usize, f64)> {
    let [left, top] = dot
        .centre
        .map(|place| (place - dot.radius).floor().max(0.0));
    let side = 2.0 * dot.radius + 2.0;
    let is_in = |x: f64, y: f64| {
        let (dx, dy) = (x - dot.centre[0], y - dot.centre[1]);
        dx * dx + dy * dy <= dot.radius * dot.radius
    };
    let points = || (0..4_u8).map(|point| (f64::from(point) + 0.5) / 4.0);
    let mut found = Vec::new();
    let places =
        |from: f64| (0..width).filter(move |&at| (from..from + side).contains(&(at as f64)));
    for y in places(top) {
        for x in places(left) {
            let inside = |dy: &f64| {
                let hit = |dx: &f64| is_in(x as f64 + dx, y as f64 + dy);
                points().filter(hit).count()
            };
            let count: usize = points().map(|dy| inside(&dy)).sum();
            found.push((y * width + x, count as f64 / 16.0));
        }
    }
    found
}

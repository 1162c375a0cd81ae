//! Where the subject sits and how large a pixel then looks.

use serde::{Deserialize, Serialize};

/// The viewing geometry of the study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Viewing {
    /// From the eye to the screen.
    pub distance_cm: f64,
    /// The angle that one pixel subtends at the eye.
    pub degrees_per_pixel: f64,
}

impl Viewing {
    /// 40 inches and 0.019° a pixel: section 3.4 of Meyer & Liu (1992).
    pub const MEYER_LIU_1992: Self = Self {
        distance_cm: 101.6,
        degrees_per_pixel: 0.019,
    };

    /// The width of a pixel on the screen, `distance · tan(angle)`.
    ///
    /// ```
    /// // 40 inches and 0.019° (Meyer & Liu 1992, section 3.4): 0.3369 mm, by geometry.py of the reference.
    /// let viewing = protocols::Viewing { distance_cm: 101.6, degrees_per_pixel: 0.019 };
    /// assert!((viewing.pixel_pitch_mm() - 0.336_918_371_154_940_44).abs() < 1e-12);
    /// ```
    pub fn pixel_pitch_mm(self) -> f64 {
        10.0 * self.distance_cm * libm::tan(self.degrees_per_pixel.to_radians())
    }

    /// How many pixels subtend one degree.
    pub fn pixels_per_degree(self) -> f64 {
        self.degrees_per_pixel.recip()
    }

    pub(crate) fn fault(self) -> Option<(&'static str, String, &'static str)> {
        let distance_cm = self.distance_cm;
        if !(distance_cm.is_finite() && (1.0..=10_000.0).contains(&distance_cm)) {
            return Some((
                "viewing.distance_cm",
                distance_cm.to_string(),
                "a distance from 1 to 10000 cm",
            ));
        }
        let angle = self.degrees_per_pixel;
        if !(angle.is_finite() && angle > 0.0 && angle <= 1.0) {
            return Some((
                "viewing.degrees_per_pixel",
                angle.to_string(),
                "an angle above 0 and up to 1 degree",
            ));
        }
        None
    }
}

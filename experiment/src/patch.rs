//! The patches that a meter reads off the screen, and what it read.
//!
//! White, the three primaries and a grey ramp of nine steps from white to black, in the order in which they are shown.
//!
//! Not here: what follows from the readings (`calibration`).

use serde::{Deserialize, Serialize};

/// The codes of the grey ramp, from white to black.
const GREYS: [u8; 9] = [255, 224, 192, 160, 128, 96, 64, 32, 0];

/// One colour that fills the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Patch {
    /// The codes of red, green and blue.
    pub codes: [u8; 3],
}

impl Patch {
    /// All three primaries at full drive.
    pub const WHITE: Self = Self { codes: [255; 3] };
    /// No primary.
    pub const BLACK: Self = Self { codes: [0; 3] };
    /// Red, green and blue alone at full drive.
    pub const PRIMARIES: [Self; 3] = [
        Self { codes: [255, 0, 0] },
        Self { codes: [0, 255, 0] },
        Self { codes: [0, 0, 255] },
    ];

    /// Every patch, in the order in which they are shown.
    pub fn all() -> Vec<Self> {
        let grey = |code: &u8| Self { codes: [*code; 3] };
        let mut patches = vec![Self::WHITE];
        patches.extend(Self::PRIMARIES);
        patches.extend(GREYS[1..].iter().map(grey));
        patches
    }

    /// What it is called: `white`, `red`, `grey 128`.
    pub fn name(self) -> String {
        match self.codes {
            [255, 255, 255] => "white".to_owned(),
            [0, 0, 0] => "black".to_owned(),
            [255, 0, 0] => "red".to_owned(),
            [0, 255, 0] => "green".to_owned(),
            [0, 0, 255] => "blue".to_owned(),
            [red, green, blue] if red == green && green == blue => format!("grey {red}"),
            [red, green, blue] => format!("{red}, {green}, {blue}"),
        }
    }
}

/// What a meter read off a patch, or should read: the CIE 1931 colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reading {
    /// The codes of the patch.
    pub patch: Patch,
    /// The luminance Y.
    pub luminance_cd_m2: f64,
    /// The chromaticity x.
    pub x: f64,
    /// The chromaticity y.
    pub y: f64,
}

impl Reading {
    /// The reading of a patch with these tristimulus values, in cd/m²; x and y are 0 where there is no light.
    pub fn of(patch: Patch, [x, y, z]: [f64; 3]) -> Self {
        let sum = x + y + z;
        let part = |value: f64| if sum > 0.0 { value / sum } else { 0.0 };
        Self {
            patch,
            luminance_cd_m2: y,
            x: part(x),
            y: part(y),
        }
    }

    /// The tristimulus values, in cd/m².
    pub fn xyz(self) -> [f64; 3] {
        let Self {
            luminance_cd_m2: luminance,
            x,
            y,
            ..
        } = self;
        if luminance <= 0.0 || y <= 0.0 {
            return [0.0; 3];
        }
        [x / y * luminance, luminance, (1.0 - x - y) / y * luminance]
    }

    /// The chromaticity u′, v′ (CIE 1976), if there is light.
    pub fn uv(self) -> Option<[f64; 2]> {
        let weight = 3.0 + 12.0 * self.y - 2.0 * self.x;
        let has_light = self.luminance_cd_m2 > 0.0 && self.y > 0.0;
        has_light.then(|| [4.0 * self.x / weight, 9.0 * self.y / weight])
    }

    /// What cannot be: in words, or `None` for a possible reading.
    pub fn fault(self) -> Option<String> {
        let name = self.patch.name();
        let Self {
            luminance_cd_m2: luminance,
            x,
            y,
            ..
        } = self;
        if !(0.0..=10_000.0).contains(&luminance) {
            return Some(format!(
                "{name}: found {luminance} cd/m2, expected 0 to 10000"
            ));
        }
        let is_dark = luminance == 0.0;
        let is_color = x >= 0.0 && y > 0.0 && x + y <= 1.0;
        (!is_dark && !is_color).then(|| {
            format!(
                "{name}: found x {x}, y {y}, expected chromaticities above 0 with a sum up to 1"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_patches_are_white_three_primaries_and_nine_greys_each_once() {
        let patches = Patch::all();
        assert_eq!(patches.len(), 12);
        let mut different = patches.clone();
        different.sort_unstable();
        different.dedup();
        assert_eq!(different.len(), 12);
        let greys = patches
            .iter()
            .filter(|patch| patch.codes[0] == patch.codes[1]);
        assert!(
            greys
                .filter(|patch| patch.codes[1] == patch.codes[2])
                .count()
                >= 9
        );
    }

    /// D65 has u′ = .1978, v′ = .4683 (CIE 15:2018, table 9.1 for x = .3127, y = .3290).
    #[test]
    fn a_reading_is_taken_to_xyz_and_back_and_to_u_v() {
        let white = Reading {
            patch: Patch::WHITE,
            luminance_cd_m2: 120.0,
            x: 0.3127,
            y: 0.3290,
        };
        let back = Reading::of(Patch::WHITE, white.xyz());
        assert!((back.x - white.x).abs() < 1e-12 && (back.y - white.y).abs() < 1e-12);
        let [u, v] = white.uv().unwrap();
        assert!(
            (u - 0.1978).abs() < 1e-4 && (v - 0.4683).abs() < 1e-4,
            "{u} {v}"
        );
        assert_eq!(Reading::of(Patch::BLACK, [0.0; 3]).uv(), None);
    }

    #[test]
    fn what_no_meter_reads_is_named() {
        let reading = |luminance_cd_m2, x, y| Reading {
            patch: Patch::PRIMARIES[0],
            luminance_cd_m2,
            x,
            y,
        };
        assert_eq!(reading(20.0, 0.64, 0.33).fault(), None);
        assert_eq!(reading(0.0, 0.0, 0.0).fault(), None);
        for bad in [
            reading(-1.0, 0.64, 0.33),
            reading(f64::NAN, 0.64, 0.33),
            reading(20.0, 0.8, 0.3),
            reading(20.0, 0.3, 0.0),
        ] {
            assert!(bad.fault().unwrap().starts_with("red:"));
        }
    }
}

//! The letter E that is open to one of four sides: an optotype that is exact in whole pixels.
//!
//! Five strokes high and wide, three bars and two gaps of one stroke each (the tumbling E of Taylor 1978, as in
//! ISO 8596's annex). The stroke's angle in minutes of arc is the minimum angle of resolution that it asks for.

use protocols::ScreeningPlan;
use serde::{Deserialize, Serialize};

use crate::random::Random;

/// To which side an E is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// To the right, as it is printed.
    Right,
    /// Down.
    Down,
    /// To the left.
    Left,
    /// Up.
    Up,
}

impl Side {
    /// All four, clockwise.
    pub const ALL: [Self; 4] = [Self::Right, Self::Down, Self::Left, Self::Up];

    /// The word in the data.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Down => "down",
            Self::Left => "left",
            Self::Up => "up",
        }
    }
}

/// One letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Letter {
    /// The width of a stroke, in pixels.
    pub stroke_px: u32,
    /// The open side.
    pub side: Side,
}

impl Letter {
    /// Every size as often as the plan says, in its order, each open to a side by lot.
    pub(super) fn all_of(plan: &ScreeningPlan, key: &str) -> Vec<Self> {
        let mut random = Random::keyed_by(&format!("{key}: letters"));
        let sizes = plan.strokes_px.iter();
        let sizes =
            sizes.flat_map(|&stroke| std::iter::repeat_n(stroke, plan.letters_each as usize));
        let letter = |stroke_px| Self {
            stroke_px,
            side: Side::ALL[random.index(4)],
        };
        sizes.map(letter).collect()
    }

    /// The black rectangles in strokes, from the upper left corner: left, top, width, height.
    pub fn bars(self) -> [[u32; 4]; 4] {
        let spine_and_bars = match self.side {
            Side::Right | Side::Left => [[0, 0, 5, 1], [0, 2, 5, 1], [0, 4, 5, 1]],
            Side::Down | Side::Up => [[0, 0, 1, 5], [2, 0, 1, 5], [4, 0, 1, 5]],
        };
        let spine = match self.side {
            Side::Right => [0, 0, 1, 5],
            Side::Left => [4, 0, 1, 5],
            Side::Down => [0, 0, 5, 1],
            Side::Up => [0, 4, 5, 1],
        };
        let [one, two, three] = spine_and_bars;
        [spine, one, two, three]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The letter as rows of marks.
    fn drawn(side: Side) -> String {
        let letter = Letter { stroke_px: 1, side };
        let is_black = |x: u32, y: u32| {
            letter.bars().iter().any(|&[left, top, width, height]| {
                (left..left + width).contains(&x) && (top..top + height).contains(&y)
            })
        };
        let row = |y| {
            (0..5)
                .map(|x| if is_black(x, y) { '#' } else { '.' })
                .collect::<String>()
        };
        (0..5).map(row).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn an_e_is_open_to_its_side() {
        assert_eq!(drawn(Side::Right), "##### #.... ##### #.... #####");
        assert_eq!(drawn(Side::Left), "##### ....# ##### ....# #####");
        assert_eq!(drawn(Side::Down), "##### #.#.# #.#.# #.#.# #.#.#");
        assert_eq!(drawn(Side::Up), "#.#.# #.#.# #.#.# #.#.# #####");
    }
}

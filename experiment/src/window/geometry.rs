//! Where things stand on the screen, in whole pixels of the screen, y down.
//!
//! Sizes of text and buttons follow the height of the screen, so that they look alike on every monitor;
//! images never do.

use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};
use protocols::{Scale, SessionPlan};

use crate::{Button, Picture, Screen};

/// The screen, and how many of its pixels make one point of egui.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Geometry {
    pub(crate) size_px: Vec2,
    pub(crate) pixels_per_point: f32,
}

/// The slot of the zero anchor, the test image and the ten anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slot {
    ZeroAnchor,
    Test,
    TenAnchor,
}

/// How many pixels the images of one screen need.
pub(crate) fn needed_px(plan: &SessionPlan, image_px: [u32; 2]) -> [u32; 2] {
    let [width, height] = image_px;
    match plan.layout {
        protocols::Layout::Flanking => [
            width
                .saturating_mul(3)
                .saturating_add(plan.gap_px.saturating_mul(2)),
            height,
        ],
        protocols::Layout::Sequence => image_px,
    }
}

/// A rectangle around a centre, with its corners on whole pixels.
fn centred(centre: Pos2, size_px: Vec2) -> Rect {
    let size_px = size_px.round();
    Rect::from_min_size((centre - size_px / 2.0).floor(), size_px)
}

impl Geometry {
    /// A length of the design, which is drawn for a screen of 1080 lines.
    pub(crate) fn unit(self) -> f32 {
        (self.size_px.y / 1080.0)
            .clamp(0.6, 3.0)
            .min(self.size_px.x / 1240.0)
    }

    /// The same place in points of egui.
    pub(crate) fn points(self, pixels: Rect) -> Rect {
        Rect::from_min_max(
            (pixels.min.to_vec2() / self.pixels_per_point).to_pos2(),
            (pixels.max.to_vec2() / self.pixels_per_point).to_pos2(),
        )
    }

    pub(crate) fn screen_px(self) -> Rect {
        Rect::from_min_size(Pos2::ZERO, self.size_px)
    }

    /// Where the images of a picture stand: the test image, or the one that is alone, at the centre.
    pub(crate) fn images(self, picture: Picture, image_px: Vec2, gap_px: f32) -> Vec<(Slot, Rect)> {
        let centre = centred((self.size_px / 2.0).to_pos2(), image_px);
        let step = vec2(image_px.x + gap_px, 0.0);
        match picture {
            Picture::Flanked => vec![
                (Slot::ZeroAnchor, centre.translate(-step)),
                (Slot::Test, centre),
                (Slot::TenAnchor, centre.translate(step)),
            ],
            Picture::ZeroAnchor => vec![(Slot::ZeroAnchor, centre)],
            Picture::Test => vec![(Slot::Test, centre)],
            Picture::TenAnchor => vec![(Slot::TenAnchor, centre)],
        }
    }

    /// The buttons of a screen.
    pub(crate) fn buttons(self, screen: Screen, scale: Scale) -> Vec<(Button, Rect)> {
        match screen {
            Screen::Instructions | Screen::PracticeOver => {
                vec![(Button::Continue, self.wide_button(0.5, 0.86))]
            }
            Screen::ConfirmStop => vec![
                (Button::Continue, self.wide_button(0.39, 0.56)),
                (Button::Stop, self.wide_button(0.61, 0.56)),
            ],
            Screen::Rating => self.ratings(scale),
            Screen::Blank | Screen::Exposure(..) | Screen::Thanks => Vec::new(),
        }
    }

    fn wide_button(self, x: f32, y: f32) -> Rect {
        let centre = pos2(self.size_px.x * x, self.size_px.y * y);
        centred(centre, vec2(280.0, 76.0) * self.unit())
    }

    fn ratings(self, scale: Scale) -> Vec<(Button, Rect)> {
        let count = scale.ratings().count() as f32;
        let step = (104.0 * self.unit())
            .min(0.94 * self.size_px.x / count)
            .round();
        let side = (step * 0.82).round();
        let middle = self.size_px.y * 0.5;
        let first = self.size_px.x / 2.0 - step * (count - 1.0) / 2.0;
        let place = |(index, rating): (usize, i32)| {
            let centre = pos2(first + step * index as f32, middle);
            (Button::Rating(rating), centred(centre, Vec2::splat(side)))
        };
        scale.ratings().enumerate().map(place).collect()
    }

    /// The button of the screen at a place in points of egui.
    pub(crate) fn button_at(self, screen: Screen, scale: Scale, place: Pos2) -> Option<Button> {
        let buttons = self.buttons(screen, scale).into_iter();
        let mut hit = buttons.filter(|(_, rect)| self.points(*rect).contains(place));
        hit.next().map(|(button, _)| button)
    }

    /// Where the mouse waits for each rating, in points: below the middle of the scale, so that the last
    /// answer is not nearer than any other.
    pub(crate) fn pointer_rest(self) -> Pos2 {
        ((self.size_px * vec2(0.5, 0.62)).round() / self.pixels_per_point).to_pos2()
    }

    /// The bands that say PILOT.
    pub(crate) fn pilot_bands(self) -> [Rect; 2] {
        let height = (56.0 * self.unit()).round();
        let band = |top: f32| Rect::from_min_size(pos2(0.0, top), vec2(self.size_px.x, height));
        [band(0.0), band(self.size_px.y - height)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MONITOR: Geometry = Geometry {
        size_px: vec2(1281.0, 1023.0),
        pixels_per_point: 1.25,
    };

    #[test]
    fn images_stand_side_by_side_on_whole_pixels_with_the_gap_between() {
        let images = MONITOR.images(Picture::Flanked, vec2(321.0, 320.0), 24.0);
        let [left, middle, right] = [images[0].1, images[1].1, images[2].1];
        for rect in [left, middle, right] {
            assert_eq!(rect.size(), vec2(321.0, 320.0));
            assert_eq!(rect.min, rect.min.round());
        }
        assert_eq!(
            (middle.left() - left.right(), right.left() - middle.right()),
            (24.0, 24.0)
        );
        assert_eq!(middle.min, pos2(480.0, 351.0));
    }

    #[test]
    fn every_rating_has_a_button_of_its_own_on_the_screen() {
        let wide = Scale {
            lowest: -10,
            highest: 10,
        };
        for (width, height) in [
            (1920.0, 1080.0),
            (1280.0, 1024.0),
            (3840.0, 2160.0),
            (1024.0, 768.0),
        ] {
            let geometry = Geometry {
                size_px: vec2(width, height),
                pixels_per_point: 1.0,
            };
            let buttons = geometry.buttons(Screen::Rating, wide);
            assert_eq!(buttons.len(), 21);
            assert!(
                buttons
                    .iter()
                    .all(|(_, rect)| geometry.screen_px().contains_rect(*rect))
            );
            assert!(buttons.is_sorted_by(|left, right| left.1.right() < right.1.left()));
            for (button, rect) in buttons {
                assert_eq!(
                    geometry.button_at(Screen::Rating, wide, rect.center()),
                    Some(button)
                );
                assert_eq!(geometry.button_at(Screen::Blank, wide, rect.center()), None);
            }
        }
    }
}

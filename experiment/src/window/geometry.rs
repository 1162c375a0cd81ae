//! Where things stand on the screen, in whole pixels of the screen, y down.
//!
//! Sizes of text and buttons follow the height of the screen, so that they look alike on every monitor;
//! images never do.

use eframe::egui::{Pos2, Rect, Vec2, pos2, vec2};
use protocols::{Layout, RatingTime, ResponseStyle, SessionPlan};

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
    let width = match plan.layout {
        Layout::Flanking => width
            .saturating_mul(3)
            .saturating_add(plan.gap_px.saturating_mul(2)),
        Layout::Sequence | Layout::Single | Layout::Dsis | Layout::Dscqs => width,
    };
    let height = match plan.rating {
        RatingTime::AfterExposure => height,
        // The question stands at 0.785 of the height, with the scale below; the images are in the middle.
        RatingTime::DuringExposure => height.saturating_mul(2),
    };
    let of_pages = plan.pages.iter().map(|page| {
        let count = u32::try_from(page.pictures.len()).unwrap_or(u32::MAX);
        let gaps = plan.gap_px.saturating_mul(count.saturating_sub(1));
        image_px[0].saturating_mul(count).saturating_add(gaps)
    });
    [of_pages.max().unwrap_or(0).max(width), height]
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

    /// Where so many pictures of a page stand: in a row, at their own size.
    pub(crate) fn page_pictures(self, count: usize, image_px: Vec2, gap_px: f32) -> Vec<Rect> {
        let middle = (self.size_px * vec2(0.5, 0.55)).to_pos2();
        let step = image_px.x + gap_px;
        let first = middle.x - step * (count as f32 - 1.0) / 2.0;
        let place = |index: usize| pos2(first + step * index as f32, middle.y);
        (0..count)
            .map(|index| centred(place(index), image_px))
            .collect()
    }

    /// The bar that says how much is done: in the upper right corner, where no scale or button ever stands.
    pub(crate) fn progress(self) -> Rect {
        let middle = (self.size_px * vec2(0.9, 0.085)).to_pos2();
        centred(middle, vec2(200.0, 10.0) * self.unit())
    }

    /// The buttons of a screen.
    pub(crate) fn buttons(self, screen: Screen, plan: &SessionPlan) -> Vec<(Button, Rect)> {
        match screen {
            Screen::Instructions
            | Screen::Page(_)
            | Screen::Break {
                can_go_on: true, ..
            }
            | Screen::Resumed
            | Screen::PracticeOver
            | Screen::TooSlow
            | Screen::Paused => vec![(Button::Continue, self.wide_button(0.5, 0.86))],
            Screen::ConfirmStop => vec![
                (Button::Continue, self.wide_button(0.39, 0.56)),
                (Button::Stop, self.wide_button(0.61, 0.56)),
            ],
            Screen::Rating | Screen::RatedExposure(..) => match plan.response {
                ResponseStyle::Buttons | ResponseStyle::Labelled => self.ratings(plan),
                ResponseStyle::Continuous => {
                    vec![(Button::Continue, self.wide_button(0.5, 0.89))]
                }
            },
            Screen::Blank | Screen::Exposure(..) | Screen::Break { .. } | Screen::Thanks => {
                Vec::new()
            }
        }
    }

    /// How high the question and the row of ratings stand, as parts of the screen's height.
    pub(crate) fn scale_heights(plan: &SessionPlan) -> [f32; 2] {
        match (plan.response, plan.rating) {
            (ResponseStyle::Continuous, _) => [0.1, 0.5],
            (_, RatingTime::AfterExposure) => [0.38, 0.5],
            (_, RatingTime::DuringExposure) => [0.785, 0.86],
        }
    }

    /// The bars of a continuous scale; the best rating is at the top.
    pub(crate) fn bars(self, plan: &SessionPlan) -> Vec<Rect> {
        let size_px = vec2(64.0 * self.unit(), 0.56 * self.size_px.y);
        let places: &[f32] = match plan.layout {
            Layout::Dscqs => &[-150.0, 150.0],
            _ => &[0.0],
        };
        let middle = self.size_px * vec2(0.5, 0.53);
        let bar = |&x: &f32| {
            let centre = middle + vec2(x * self.unit(), 0.0);
            centred(centre.to_pos2(), size_px)
        };
        places.iter().map(bar).collect()
    }

    /// How high a rating stands on a bar.
    pub(crate) fn mark_y(bar: Rect, plan: &SessionPlan, rating: i32) -> f32 {
        let scale = plan.scale;
        let part = (rating - scale.lowest) as f32 / (scale.highest - scale.lowest) as f32;
        bar.bottom() - part * bar.height()
    }

    /// The bar at a place in pixels, and the nearest rating; beside a bar there is some room.
    fn mark_at(self, plan: &SessionPlan, place: Pos2) -> Option<Button> {
        let room = vec2(40.0, 24.0) * self.unit();
        let mut bars = self.bars(plan).into_iter().enumerate();
        let (index, bar) = bars.find(|(_, bar)| bar.expand2(room).contains(place))?;
        let part = ((bar.bottom() - place.y) / bar.height()).clamp(0.0, 1.0);
        let span = f64::from(plan.scale.highest - plan.scale.lowest);
        let rating = f64::from(plan.scale.lowest) + f64::from(part) * span;
        Some(Button::Bar(index, plan.scale.nearest(rating)))
    }

    fn wide_button(self, x: f32, y: f32) -> Rect {
        let centre = pos2(self.size_px.x * x, self.size_px.y * y);
        centred(centre, vec2(280.0, 76.0) * self.unit())
    }

    fn ratings(self, plan: &SessionPlan) -> Vec<(Button, Rect)> {
        let scale = plan.scale;
        let count = scale.ratings().count() as f32;
        let (step, height) = match plan.response {
            ResponseStyle::Labelled => (232.0, Some(84.0)),
            _ => (104.0, None),
        };
        let step = (step * self.unit())
            .min(0.94 * self.size_px.x / count)
            .round();
        let side = match height {
            None => Vec2::splat((step * 0.82).round()),
            Some(height) => vec2(step * 0.92, height * self.unit()).round(),
        };
        let middle = self.size_px.y * Self::scale_heights(plan)[1];
        let first = self.size_px.x / 2.0 - step * (count - 1.0) / 2.0;
        let place = |(index, rating): (usize, i32)| {
            let centre = pos2(first + step * index as f32, middle);
            (Button::Rating(rating), centred(centre, side))
        };
        scale.ratings().enumerate().map(place).collect()
    }

    /// The button of the screen at a place in points of egui.
    pub(crate) fn button_at(
        self,
        screen: Screen,
        plan: &SessionPlan,
        place: Pos2,
    ) -> Option<Button> {
        let buttons = self.buttons(screen, plan).into_iter();
        let mut hit = buttons.filter(|(_, rect)| self.points(*rect).contains(place));
        let hit = hit.next().map(|(button, _)| button);
        let has_bars = screen.has_scale() && plan.response == ResponseStyle::Continuous;
        let place_px = (place.to_vec2() * self.pixels_per_point).to_pos2();
        hit.or_else(|| has_bars.then(|| self.mark_at(plan, place_px))?)
    }

    /// Where the mouse waits for each rating, in points: below the middle of the scale, so that the last
    /// answer is not nearer than any other.
    pub(crate) fn pointer_rest(self, plan: &SessionPlan) -> Pos2 {
        let y = match (plan.response, plan.rating) {
            (ResponseStyle::Continuous, _) => 0.96,
            (_, RatingTime::AfterExposure) => 0.62,
            (_, RatingTime::DuringExposure) => 0.97,
        };
        ((self.size_px * vec2(0.5, y)).round() / self.pixels_per_point).to_pos2()
    }

    /// The corner that a photodiode looks at.
    pub(crate) fn photodiode(self) -> Rect {
        let side = (80.0 * self.unit()).round();
        Rect::from_min_size(pos2(0.0, self.size_px.y - side), Vec2::splat(side))
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

    fn plan() -> SessionPlan {
        let folder = tempfile::tempdir().unwrap();
        crate::common::small_study(folder.path()).protocol.session
    }

    #[test]
    fn every_mark_of_a_bar_can_be_clicked_where_it_is_drawn() {
        let mut plan = plan();
        plan.layout = Layout::Dscqs;
        plan.response = ResponseStyle::Continuous;
        plan.scale.highest = 100;
        for (width, height) in [(1024.0, 768.0), (1920.0, 1080.0), (3840.0, 2160.0)] {
            let geometry = Geometry {
                size_px: vec2(width, height),
                pixels_per_point: 1.5,
            };
            for (index, bar) in geometry.bars(&plan).into_iter().enumerate() {
                for rating in plan.scale.ratings() {
                    let y = Geometry::mark_y(bar, &plan, rating);
                    let place = pos2(bar.center().x, y).to_vec2() / 1.5;
                    let button = geometry.button_at(Screen::Rating, &plan, place.to_pos2());
                    assert_eq!(button, Some(Button::Bar(index, rating)));
                }
            }
            let rest = geometry.pointer_rest(&plan);
            assert_eq!(geometry.button_at(Screen::Rating, &plan, rest), None);
        }
    }

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
        let mut wide = plan();
        wide.scale.lowest = -10;
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
            let buttons = geometry.buttons(Screen::Rating, &wide);
            assert_eq!(buttons.len(), 21);
            assert!(
                buttons
                    .iter()
                    .all(|(_, rect)| geometry.screen_px().contains_rect(*rect))
            );
            assert!(buttons.is_sorted_by(|left, right| left.1.right() < right.1.left()));
            for (button, rect) in buttons {
                assert_eq!(
                    geometry.button_at(Screen::Rating, &wide, rect.center()),
                    Some(button)
                );
                assert_eq!(
                    geometry.button_at(Screen::Blank, &wide, rect.center()),
                    None
                );
            }
        }
    }
}

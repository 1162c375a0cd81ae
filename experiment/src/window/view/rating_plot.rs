//! The ratings so far as dots: the trial to the right, the rating upward.

use eframe::egui::{self, Align2, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

use super::super::desk;
use crate::Glance;

/// Where the dot of a rating stands in a rectangle.
fn place(space: Rect, glance: &Glance, index: usize, rating: i32) -> egui::Pos2 {
    let [lowest, highest] = glance.scale;
    let [_, whole] = glance.trial;
    let x = (index as f32 + 0.5) / whole.max(1) as f32;
    let y = (rating - lowest) as f32 / (highest - lowest).max(1) as f32;
    pos2(
        space.left() + x * space.width(),
        space.bottom() - y * space.height(),
    )
}

pub(super) fn show(ui: &mut Ui, glance: &Glance) {
    let size = vec2(
        ui.available_width(),
        ui.available_height().clamp(90.0, 260.0),
    );
    let (outer, response) = ui.allocate_exact_size(size, Sense::hover());
    let words = format!("ratings so far: {:?}", glance.ratings);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &words));
    let painter = ui.painter_at(outer);
    painter.rect_filled(outer, 6, ui.visuals().extreme_bg_color);
    let mut space = outer.shrink(14.0);
    space.set_left(outer.left() + 52.0);
    let tints = desk::Tints::of(ui);
    let quiet = ui.visuals().text_color().gamma_multiply(0.6);
    for end in glance.scale {
        let y = place(space, glance, 0, end).y;
        painter.hline(
            space.x_range(),
            y,
            Stroke::new(1.0, quiet.gamma_multiply(0.4)),
        );
        let font = FontId::proportional(14.0);
        painter.text(
            pos2(space.left() - 8.0, y),
            Align2::RIGHT_CENTER,
            end.to_string(),
            font,
            quiet,
        );
    }
    for (index, &rating) in glance.ratings.iter().enumerate() {
        let radius = if index + 1 == glance.ratings.len() {
            5.5
        } else {
            4.0
        };
        painter.circle_filled(place(space, glance, index, rating), radius, tints.accent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_rating_of_the_last_trial_is_at_the_upper_right() {
        let space = Rect::from_min_max(pos2(0.0, 0.0), pos2(100.0, 50.0));
        let glance = Glance {
            scale: [0, 10],
            trial: [10, 10],
            ..Glance::default()
        };
        assert_eq!(place(space, &glance, 9, 10), pos2(95.0, 0.0));
        assert_eq!(place(space, &glance, 0, 0), pos2(5.0, 50.0));
        assert_eq!(place(space, &glance, 4, 5).y, 25.0);
    }
}

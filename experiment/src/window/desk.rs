//! The looks of the experimenter's pages: type sizes, spacing and one accent, in dark and in light.
//!
//! The pages are laid out for a window 960 points high; on higher screens points grow, so that they look alike
//! everywhere. The subject's pages have looks of their own (`intake_page`, `paint`).

use eframe::egui::{
    self, Color32, Context, CornerRadius, FontId, RichText, Stroke, TextStyle, Theme, Ui, Vec2,
    vec2,
};

use super::gate::Sizes;

/// Design height in points.
const HEIGHT: f32 = 960.0;

/// Colours that the pages use by name.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tints {
    pub(crate) accent: Color32,
    pub(crate) good: Color32,
    pub(crate) bad: Color32,
}

impl Tints {
    pub(crate) fn of(ui: &Ui) -> Self {
        if ui.visuals().dark_mode {
            Self {
                accent: Color32::from_rgb(120, 170, 230),
                good: Color32::from_rgb(130, 200, 140),
                bad: Color32::from_rgb(240, 160, 110),
            }
        } else {
            Self {
                accent: Color32::from_rgb(30, 90, 160),
                good: Color32::from_rgb(30, 110, 50),
                bad: Color32::from_rgb(165, 70, 10),
            }
        }
    }
}

/// Sets the looks of both themes.
pub(crate) fn dress(context: &Context) {
    for theme in [Theme::Dark, Theme::Light] {
        context.style_mut_of(theme, |style| {
            let sizes = [
                (TextStyle::Heading, 28.0),
                (TextStyle::Body, 17.0),
                (TextStyle::Button, 17.0),
                (TextStyle::Small, 14.0),
            ];
            for (name, size) in sizes {
                style.text_styles.insert(name, FontId::proportional(size));
            }
            style
                .text_styles
                .insert(TextStyle::Monospace, FontId::monospace(16.0));
            style.spacing.item_spacing = vec2(12.0, 10.0);
            style.spacing.button_padding = vec2(14.0, 8.0);
            style.spacing.interact_size = vec2(44.0, 34.0);
            style.spacing.text_edit_width = 120.0;
            let visuals = &mut style.visuals;
            let dark = theme == Theme::Dark;
            let (panel, field, ink) = if dark { (30, 20, 222) } else { (246, 255, 24) };
            visuals.panel_fill = Color32::from_gray(panel);
            visuals.extreme_bg_color = Color32::from_gray(field);
            visuals.override_text_color = Some(Color32::from_gray(ink));
            let accent = if dark {
                Color32::from_rgb(120, 170, 230)
            } else {
                Color32::from_rgb(30, 90, 160)
            };
            visuals.selection.stroke = Stroke::new(2.0, accent);
            visuals.selection.bg_fill = if dark {
                Color32::from_rgb(44, 74, 112)
            } else {
                Color32::from_rgb(200, 220, 244)
            };
            for state in [
                &mut visuals.widgets.inactive,
                &mut visuals.widgets.hovered,
                &mut visuals.widgets.active,
                &mut visuals.widgets.open,
            ] {
                state.corner_radius = CornerRadius::same(6);
            }
            visuals.widgets.inactive.bg_stroke =
                Stroke::new(1.0, Color32::from_gray(if dark { 80 } else { 170 }));
            visuals.widgets.active.bg_stroke = Stroke::new(2.0, accent);
        });
    }
}

/// Lets points grow with the window.
pub(crate) fn scale(context: &Context, sizes: Sizes) {
    let native = context.native_pixels_per_point().unwrap_or(1.0);
    let wanted = (sizes.window_px[1] as f32 / HEIGHT).clamp(0.85, 4.0) / native;
    if sizes.window_px[1] > 100 && (context.zoom_factor() - wanted).abs() > 0.01 {
        context.set_zoom_factor(wanted);
    }
}

/// A heading with a line of explanation below.
pub(crate) fn heading(ui: &mut Ui, title: &str, words: &str) {
    ui.heading(RichText::new(title).strong());
    ui.label(words);
    ui.add_space(6.0);
}

/// A quiet remark.
pub(crate) fn remark(ui: &mut Ui, words: impl Into<String>) {
    let weak = ui.visuals().text_color().gamma_multiply(0.72);
    ui.label(RichText::new(words).color(weak).size(15.0));
}

/// A fact: its name, and its value beside.
pub(crate) fn fact(ui: &mut Ui, name: &str, value: impl Into<String>) {
    let weak = ui.visuals().text_color().gamma_multiply(0.72);
    ui.label(RichText::new(name).color(weak));
    ui.label(RichText::new(value).strong());
    ui.end_row();
}

/// A field for a short text with its name and unit; says whether it was changed.
pub(crate) fn field(
    ui: &mut Ui,
    name: &str,
    text: &mut String,
    (width, unit): (f32, &str),
) -> bool {
    let label = ui.label(name);
    let mut is_changed = false;
    ui.horizontal(|ui| {
        let edit = egui::TextEdit::singleline(text).desired_width(width);
        is_changed = ui.add(edit).labelled_by(label.id).changed();
        ui.label(unit);
    });
    ui.end_row();
    is_changed
}

/// A grid of names and values.
pub(crate) fn facts<R>(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui) -> R) -> R {
    let grid = egui::Grid::new(name)
        .num_columns(2)
        .spacing(Vec2::new(24.0, 10.0));
    grid.show(ui, add).inner
}

/// What is as it should be.
pub(crate) fn good(ui: &mut Ui, words: impl Into<String>) {
    let color = Tints::of(ui).good;
    ui.label(RichText::new(words).color(color).strong());
}

/// What is not.
pub(crate) fn bad(ui: &mut Ui, words: impl Into<String>) {
    let color = Tints::of(ui).bad;
    ui.label(RichText::new(words).color(color).strong());
}

/// A length to draw with.
#[expect(clippy::cast_possible_truncation, reason = "a length on the screen")]
pub(crate) fn length(value: f64) -> f32 {
    value as f32
}

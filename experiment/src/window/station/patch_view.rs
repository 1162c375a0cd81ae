//! One patch after another on the whole screen, with what a meter should read and fields for what it reads.

use eframe::egui::{self, Color32, CornerRadius, Key, Rect, Stroke, Ui, UiBuilder, vec2};

use super::color_page::{peak_cd_m2, values};
use super::desk;
use crate::color_draft::ColorSource;
use crate::station_draft::StationDraft;

/// The height of the strip with words, as a part of the screen's.
const STRIP: f32 = 0.11;

/// Which patch is shown, and whether words stand below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PatchView {
    index: usize,
    is_bare: bool,
}

impl PatchView {
    /// Draws the patch; false once the experimenter is through.
    pub(super) fn show(&mut self, ui: &mut Ui, draft: &mut StationDraft) -> bool {
        let screen = ui.ctx().content_rect();
        let count = draft.color.readings.len();
        let Some((patch, _)) = draft.color.readings.get(self.index) else {
            return false;
        };
        let [red, green, blue] = patch.codes;
        let color = Color32::from_rgb(red, green, blue);
        ui.painter().rect_filled(screen, CornerRadius::ZERO, color);
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            return false;
        }
        let pages = ui.input(|input| {
            [
                input.key_pressed(Key::PageUp),
                input.key_pressed(Key::PageDown),
            ]
        });
        match pages {
            [true, _] => self.index = self.index.saturating_sub(1),
            [_, true] => self.index += 1,
            _ => {}
        }
        if self.index >= count {
            return false;
        }
        if self.is_bare {
            ui.ctx().set_cursor_icon(egui::CursorIcon::None);
            let is_over =
                ui.input(|input| input.pointer.any_pressed() || input.key_pressed(Key::Space));
            self.is_bare = !is_over;
            return true;
        }
        let mut strip = screen;
        strip.set_top(screen.bottom() - STRIP * screen.height());
        self.strip(ui, draft, strip)
    }

    /// The words and fields below the patch; false to leave.
    fn strip(&mut self, ui: &mut Ui, draft: &mut StationDraft, strip: Rect) -> bool {
        ui.painter()
            .rect_filled(strip, CornerRadius::ZERO, Color32::BLACK);
        self.mark(ui, draft);
        let inner = strip.shrink2(vec2(24.0, 12.0));
        let scope = ui.scope_builder(UiBuilder::new().max_rect(inner), |ui| {
            *ui.visuals_mut() = egui::Visuals::dark();
            ui.horizontal_centered(|ui| self.row(ui, draft)).inner
        });
        scope.inner && self.index < draft.color.readings.len()
    }

    /// Where the meter looks: four ticks around the middle of what the strip leaves, far enough to shed no light on it.
    fn mark(self, ui: &Ui, draft: &StationDraft) {
        let peak = peak_cd_m2(draft);
        let (patch, _) = draft.color.readings[self.index];
        let expected = draft.color.expected(patch, peak);
        let screen = ui.ctx().content_rect();
        let middle = screen.center_top() + vec2(0.0, 0.5 * (1.0 - STRIP) * screen.height());
        let ink = if expected.luminance_cd_m2 > 0.18 * peak {
            Color32::BLACK
        } else {
            Color32::WHITE
        };
        let line = Stroke::new(1.0, ink.gamma_multiply(0.4));
        let [near, far] = [0.2, 0.22].map(|part| part * screen.height());
        for side in [
            vec2(1.0, 0.0),
            vec2(-1.0, 0.0),
            vec2(0.0, 1.0),
            vec2(0.0, -1.0),
        ] {
            ui.painter()
                .line_segment([middle + near * side, middle + far * side], line);
        }
    }

    fn row(&mut self, ui: &mut Ui, draft: &mut StationDraft) -> bool {
        let count = draft.color.readings.len();
        let takes_readings = draft.color.source == ColorSource::Patches;
        ui.vertical(|ui| self.name(ui, draft));
        ui.add_space(24.0);
        if takes_readings {
            self.fields(ui, draft);
        }
        if ui.button("Back").clicked() {
            self.index = self.index.saturating_sub(1);
        }
        let next = if self.index + 1 == count {
            "Done"
        } else {
            "Next"
        };
        if ui.button(next).clicked() {
            self.index += 1;
        }
        self.is_bare = ui.button("Hide this strip").clicked();
        !ui.button("Close").clicked()
    }

    /// Which patch it is, and what a meter should read.
    fn name(self, ui: &mut Ui, draft: &StationDraft) {
        let (patch, _) = draft.color.readings[self.index];
        let (number, count) = (self.index + 1, draft.color.readings.len());
        let name = format!("{} ({number} of {count})", patch.name());
        ui.label(egui::RichText::new(name).strong());
        let should = match draft.color.source {
            ColorSource::Patches => "an sRGB display would give",
            _ => "a meter should read",
        };
        let expected = draft.color.expected(patch, peak_cd_m2(draft));
        desk::remark(ui, format!("{should} Y, x, y: {}", values(expected).trim()));
    }

    fn fields(self, ui: &mut Ui, draft: &mut StationDraft) {
        let (_, fields) = &mut draft.color.readings[self.index];
        for (place, (field, name)) in fields.iter_mut().zip(["Y (cd/m2)", "x", "y"]).enumerate() {
            let label = ui.label(name);
            let id = egui::Id::unique(("reading", self.index, place));
            let edit = egui::TextEdit::singleline(field).id(id).desired_width(80.0);
            ui.add(edit).labelled_by(label.id);
        }
    }
}

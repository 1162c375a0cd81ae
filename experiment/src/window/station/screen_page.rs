//! Page 1: which monitor, and how large its pixels are, by a bank card held against it.

use eframe::egui::{self, CornerRadius, Key, Rect, RichText, Sense, Stroke, StrokeKind, Ui, vec2};

use super::{Wish, desk};
use crate::station_draft::{CARD_MM, StationDraft};

/// What the outline is called for screen readers and tests.
const OUTLINE: &str = "outline of a bank card";

pub(super) fn show(ui: &mut Ui, draft: &mut StationDraft, monitors: &[String]) -> Option<Wish> {
    desk::heading(
        ui,
        "How large is a pixel?",
        "Hold a bank card (85.60 mm wide and 53.98 mm high, as every bank card) against the screen and make the outline just as large: drag it, or select it and press the arrow keys (with Shift ten pixels). Or type the width of the picture.",
    );
    let wish = choose_monitor(ui, draft, monitors);
    ui.add_space(8.0);
    ui.horizontal_top(|ui| {
        let room = (ui.available_width() - 430.0).max(200.0);
        let pixels_per_point = ui.ctx().pixels_per_point();
        let most = 1.3 * desk::length(draft.card_px()) / pixels_per_point;
        let size = vec2(
            room.min(most.max(520.0)),
            (ui.available_height() - 12.0).max(200.0),
        );
        outline(ui, draft, size);
        ui.vertical(|ui| numbers(ui, draft));
    });
    wish
}

fn choose_monitor(ui: &mut Ui, draft: &StationDraft, monitors: &[String]) -> Option<Wish> {
    let mut wish = None;
    let here = draft.screen().name.as_deref();
    ui.horizontal_wrapped(|ui| {
        ui.label("The subject's monitor:");
        for (index, name) in monitors.iter().enumerate() {
            let is_here = here == Some(name);
            let words = if name.is_empty() {
                "without a name"
            } else {
                name
            };
            if ui.radio(is_here, words).clicked() && !is_here {
                wish = Some(Wish::Monitor(index));
            }
        }
        if let (true, Some(name)) = (monitors.is_empty(), here) {
            ui.label(RichText::new(name).strong());
        }
    });
    wish
}

/// The outline, which follows the mouse by its right edge and takes the arrow keys.
fn outline(ui: &mut Ui, draft: &mut StationDraft, size: egui::Vec2) {
    let (space, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let name = || egui::WidgetInfo::labeled(egui::Role::Slider, true, OUTLINE);
    response.widget_info(name);
    let pixels_per_point = ui.ctx().pixels_per_point();
    // On whole pixels of the screen, so that the outline is as wide as it says.
    let corner =
        ((space.min.to_vec2() * pixels_per_point).round() + vec2(2.0, 2.0)) / pixels_per_point;
    let corner = corner.to_pos2();
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if let (true, Some(pointer)) = (response.dragged(), response.interact_pointer_pos()) {
        draft.set_card_px(f64::from((pointer.x - corner.x) * pixels_per_point).round());
    }
    if response.has_focus() {
        // The arrows size the outline and do not leave it.
        let filter = egui::EventFilter {
            horizontal_arrows: true,
            vertical_arrows: true,
            ..egui::EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    }
    // A press that comes with the click that selects the outline counts too; only a field keeps its arrows.
    if !ui.ctx().text_edit_focused() {
        let steps = ui.input(arrow_steps);
        if steps != 0 {
            draft.set_card_px(draft.card_px().round() + f64::from(steps));
        }
    }
    let width = desk::length(draft.card_px()) / pixels_per_point;
    let card = Rect::from_min_size(
        corner,
        vec2(width, width * desk::length(CARD_MM[1] / CARD_MM[0])),
    );
    let tints = desk::Tints::of(ui);
    let line = if response.has_focus() { 3.0 } else { 2.0 };
    let painter = ui.painter_at(space);
    // The line is inside, so that the card covers just what it shows.
    let radius = desk::length(3.18 / CARD_MM[0]) * width;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a radius of at most some hundred points"
    )]
    let radius = CornerRadius::same(radius.clamp(0.0, 200.0) as u8);
    painter.rect(
        card,
        radius,
        tints.accent.gamma_multiply(0.16),
        Stroke::new(line, tints.accent),
        StrokeKind::Inside,
    );
    let words = "85.60 \u{d7} 53.98 mm";
    let font = egui::FontId::proportional((width / 10.0).min(16.0));
    painter.text(
        card.center(),
        egui::Align2::CENTER_CENTER,
        words,
        font,
        tints.accent,
    );
}

/// By how many pixels the arrow keys of this frame change the width.
fn arrow_steps(input: &egui::InputState) -> i32 {
    let step = if input.modifiers.shift { 10 } else { 1 };
    let presses = |key: Key| i32::try_from(input.num_presses(key)).unwrap_or(0);
    let more = presses(Key::ArrowRight) + presses(Key::ArrowUp);
    let less = presses(Key::ArrowLeft) + presses(Key::ArrowDown);
    step * (more - less)
}

fn numbers(ui: &mut Ui, draft: &mut StationDraft) {
    let [width_px, height_px] = draft.screen().size_px;
    desk::facts(ui, "size", |ui| {
        desk::fact(
            ui,
            "resolution",
            format!("{width_px} \u{d7} {height_px} pixels"),
        );
        if desk::field(
            ui,
            "width of the picture",
            &mut draft.width_typed,
            (90.0, "mm"),
        ) {
            draft.take_width_typed();
        }
        if draft.is_sized() {
            let (width, height) = (draft.width_mm(), draft.height_mm());
            desk::fact(ui, "picture", format!("{width:.1} \u{d7} {height:.1} mm"));
            let inches = libm::hypot(width, height) / 25.4;
            desk::fact(ui, "diagonal", format!("{inches:.1} inches"));
            desk::fact(ui, "outline", format!("{:.1} pixels", draft.card_px()));
            desk::fact(
                ui,
                "pixel pitch",
                format!("{:.4} mm", draft.pixel_pitch_mm()),
            );
        }
    });
    ui.add_space(8.0);
    if draft.is_sized() {
        let part = 100.0 / draft.card_px();
        desk::remark(
            ui,
            format!("One pixel more or less of the outline is {part:.1} % of the pitch."),
        );
    } else {
        desk::bad(ui, "Not measured yet");
    }
    one_to_one(ui, draft);
}

/// Whether one pixel of an image is one pixel of the monitor.
fn one_to_one(ui: &mut Ui, draft: &mut StationDraft) {
    let shown = ui.ctx().native_pixels_per_point().unwrap_or(1.0);
    let words = format!(
        "The desktop scales words by {shown}; sessions show one image pixel on one pixel of the screen all the same."
    );
    desk::remark(ui, words);
    match draft.screen().one_to_one.clone() {
        Some(Ok(())) => desk::good(ui, "The monitor runs at its own resolution."),
        Some(Err(fault)) => {
            desk::bad(ui, format!("No session starts like this: {}", fault.words));
            if fault.may_be_right {
                let because = &mut draft.not_native_because;
                desk::facts(ui, "mode", |ui| {
                    desk::field(ui, "why it is right", because, (220.0, ""))
                });
            }
        }
        None => desk::remark(
            ui,
            "The X server does not say whether this is the monitor's own resolution: look into the monitor's menu.",
        ),
    }
}

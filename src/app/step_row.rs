//! The four steps in a row, each with its state; the one chosen has the accent.

use std::sync::Arc;

use eframe::egui::{
    FontId, Galley, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

use super::look::{self, Palette};
use super::study_state::{Step, StudyState};

/// Between two steps; an arrow stands in it.
const GAP: f32 = 28.0;
const HEIGHT: f32 = 78.0;
/// From the edge of a step to its words, at the sides and above.
const SIDE: f32 = 18.0;
const ABOVE: f32 = 46.0;

/// The row; says which step is chosen.
pub(crate) fn show(ui: &mut Ui, state: &StudyState, chosen: Step) -> Step {
    let mut next = chosen;
    let count = Step::ALL.len() as f32;
    let width = (ui.available_width() - GAP * (count - 1.0)) / count;
    let lines = Step::ALL.map(|step| {
        let (mark, words) = state.of(step);
        let color = Palette::of(ui).of_mark(mark);
        let font = FontId::proportional(14.0);
        ui.painter().layout(words, font, color, width - 2.0 * SIDE)
    });
    let tallest = lines.iter().map(|line| line.size().y).fold(0.0, f32::max);
    let height = HEIGHT.max(ABOVE + tallest + 14.0);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        for (step, line) in Step::ALL.into_iter().zip(lines) {
            let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::click());
            tile(ui, &response, line, (state, step, step == chosen));
            if step != Step::Report {
                look::arrow(ui, pos2(rect.right() + GAP / 2.0, rect.center().y));
            }
            if response.clicked() {
                next = step;
            }
        }
    });
    next
}

fn tile(
    ui: &Ui,
    response: &Response,
    line: Arc<Galley>,
    (state, step, is_chosen): (&StudyState, Step, bool),
) {
    let (palette, rect) = (Palette::of(ui), response.rect);
    let (mark, words) = state.of(step);
    let fill = if is_chosen || response.hovered() {
        palette.accent_wash
    } else {
        palette.card
    };
    let edge = if is_chosen {
        Stroke::new(2.0, palette.accent)
    } else {
        Stroke::new(1.0, palette.line)
    };
    let painter = ui.painter();
    painter.rect(rect, 10, fill, edge, StrokeKind::Inside);
    let left = rect.left() + SIDE;
    look::mark(ui, pos2(left + 8.0, rect.top() + 27.0), mark);
    let name = painter.layout_no_wrap(
        step.name().to_owned(),
        FontId::proportional(18.0),
        palette.text,
    );
    painter.galley(pos2(left + 26.0, rect.top() + 15.0), name, palette.text);
    painter.galley(pos2(left, rect.top() + ABOVE), line, palette.of_mark(mark));
    look::focus_ring(ui, response);
    response.widget_info(|| {
        let name = format!("{}: {words}", step.name());
        WidgetInfo::selected(Role::Tab, true, is_chosen, name)
    });
}

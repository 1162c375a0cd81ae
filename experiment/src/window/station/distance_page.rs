//! Page 2: where the subject sits, so that a pixel subtends the protocol's angle.

use eframe::egui::Ui;

use super::desk;
use crate::station_draft::StationDraft;

pub(super) fn show(ui: &mut Ui, draft: &mut StationDraft) {
    desk::heading(
        ui,
        "Where does the subject sit?",
        "From the eye to the screen, so that a pixel of this screen subtends the angle that the protocol asks for.",
    );
    if !draft.is_sized() {
        desk::bad(
            ui,
            "First measure the screen (page 1): the distance follows from the size of a pixel.",
        );
        return;
    }
    wanted(ui, draft);
    chair(ui, draft);
    tolerance(ui, draft);
    ui.add_space(10.0);
    desk::remark(
        ui,
        "A chin rest keeps the distance; a tape on the floor marks the chair. Measure to the eye, not to the forehead.",
    );
}

/// Where to sit.
fn wanted(ui: &mut Ui, draft: &StationDraft) {
    let viewing = draft.viewing();
    desk::facts(ui, "distance", |ui| {
        desk::fact(
            ui,
            "the protocol's angle a",
            format!("{}\u{b0} a pixel", viewing.degrees_per_pixel),
        );
        desk::fact(
            ui,
            "pixel pitch p",
            format!("{:.4} mm", draft.pixel_pitch_mm()),
        );
        desk::fact(
            ui,
            "distance d = p / tan a",
            format!("{:.1} cm", draft.wanted_distance_cm()),
        );
    });
    ui.add_space(14.0);
}

/// The angle from where the chair stands.
fn chair(ui: &mut Ui, draft: &mut StationDraft) {
    ui.label(
        "If the chair stands elsewhere, type its distance; an empty field takes the one above.",
    );
    desk::facts(ui, "chair", |ui| {
        desk::field(
            ui,
            "distance of the chair",
            &mut draft.distance_typed,
            (90.0, "cm"),
        );
        match draft.verdict() {
            Err(fault) => desk::fact(ui, "angle a = atan(p / d)", fault),
            Ok(verdict) => {
                let words = format!("{:.5}\u{b0} a pixel", verdict.degrees);
                desk::fact(ui, "angle a = atan(p / d)", words);
                let words = format!("{:+.2} %", verdict.deviation * 100.0);
                desk::fact(ui, "from the protocol's", words);
            }
        }
    });
    ui.add_space(10.0);
}

/// Whether that will do.
fn tolerance(ui: &mut Ui, draft: &StationDraft) {
    let Ok(verdict) = draft.verdict() else { return };
    let tolerance = draft.tolerance().unwrap_or(0.0) * 100.0;
    match verdict.is_within {
        Some(true) => desk::good(
            ui,
            format!("Within the protocol's tolerance of {tolerance} %."),
        ),
        Some(false) => desk::bad(
            ui,
            format!(
                "Outside the protocol's tolerance of {tolerance} %: no session starts at this distance."
            ),
        ),
        None => desk::remark(
            ui,
            "The protocol has no tolerance (session.viewing_tolerance): every distance is recorded, none is refused.",
        ),
    }
}

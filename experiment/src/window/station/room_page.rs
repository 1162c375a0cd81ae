//! Page 5: peak luminance, lights and surround, with the advice of the ITU beside.

use eframe::egui::{self, RichText, Ui, Vec2};

use super::desk;
use crate::station_draft::StationDraft;

/// Advice for one quantity: its name, ITU-R BT.500 in a laboratory, ITU-T P.910.
const ADVICE: [[&str; 3]; 4] = [
    ["peak luminance", "70 to 250 cd/m2", "100 to 200 cd/m2"],
    [
        "luminance behind the screen",
        "about 15 % of the peak, D65",
        "at most 20 % of the peak, D65",
    ],
    ["light of the room", "low", "at most 20 lx"],
    [
        "screen that is switched off",
        "at most 2 % of the peak",
        "at most 5 % of the peak",
    ],
];

pub(super) fn show(ui: &mut Ui, draft: &mut StationDraft) {
    desk::heading(
        ui,
        "The room",
        "Noted in the data of every session; what was not measured stays empty.",
    );
    let from_meter = draft
        .peak_cd_m2()
        .ok()
        .flatten()
        .filter(|_| draft.peak_typed.trim().is_empty());
    desk::facts(ui, "room", |ui| {
        desk::field(ui, "peak luminance", &mut draft.peak_typed, (90.0, "cd/m2"));
        if let Some(peak) = from_meter {
            desk::fact(ui, "", format!("{peak} cd/m2, from the patch of white"));
        }
        desk::field(
            ui,
            "luminance behind the screen",
            &mut draft.background_typed,
            (90.0, "cd/m2"),
        );
        desk::field(
            ui,
            "light of the room on the screen",
            &mut draft.room_typed,
            (90.0, "lx"),
        );
        desk::field(ui, "lights and surround", &mut draft.surround, (520.0, ""));
        let mut view = draft.experimenter_monitor.clone().unwrap_or_default();
        if desk::field(
            ui,
            "monitor of the experimenter's view",
            &mut view,
            (160.0, "by its name; empty for none"),
        ) {
            let name = view.trim();
            draft.experimenter_monitor = (!name.is_empty()).then(|| name.to_owned());
        }
    });
    ui.add_space(8.0);
    for (is_good, words) in remarks(draft) {
        if is_good {
            desk::good(ui, words);
        } else {
            desk::bad(ui, words);
        }
    }
    ui.add_space(14.0);
    advice(ui);
}

/// The advice as a table.
fn advice(ui: &mut Ui) {
    egui::Grid::new("advice")
        .striped(true)
        .spacing(Vec2::new(28.0, 8.0))
        .show(ui, |ui| {
            for header in ["", "ITU-R BT.500, laboratory", "ITU-T P.910"] {
                ui.label(RichText::new(header).strong());
            }
            ui.end_row();
            for [name, bt500, p910] in ADVICE {
                ui.label(name);
                ui.label(bt500);
                ui.label(p910);
                ui.end_row();
            }
        });
}

/// Whether the numbers follow the advice, a line for each that is known.
pub(super) fn remarks(draft: &StationDraft) -> Vec<(bool, String)> {
    let mut lines = Vec::new();
    let numbers = [
        draft.peak_cd_m2(),
        draft.background_cd_m2(),
        draft.room_lux(),
    ];
    for fault in numbers.iter().filter_map(|number| number.as_ref().err()) {
        lines.push((false, fault.clone()));
    }
    let [peak, background, room] = numbers.map(|number| number.ok().flatten());
    if let Some(peak) = peak {
        let is_good = (70.0..=250.0).contains(&peak);
        let words = if is_good { "within" } else { "outside" };
        lines.push((
            is_good,
            format!("A peak of {peak} cd/m2 is {words} the advice of BT.500."),
        ));
    }
    if let (Some(peak), Some(background)) = (peak, background) {
        let part = background / peak * 100.0;
        let is_good = part <= 20.0;
        let words = if is_good { "within" } else { "above" };
        lines.push((
            is_good,
            format!(
                "Behind the screen there is {part:.0} % of the peak, {words} the advice of P.910."
            ),
        ));
    }
    if let Some(lux) = room {
        let is_good = lux <= 20.0;
        let words = if is_good { "within" } else { "above" };
        lines.push((
            is_good,
            format!("A room of {lux} lx is {words} the advice of P.910."),
        ));
    }
    lines
}

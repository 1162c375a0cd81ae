//! Page 4: the colours of the display: declared, typed, by a profile, or read patch by patch.

use eframe::egui::{self, RichText, ScrollArea, Ui, Vec2, vec2};

use super::desk;
use super::patch_view::PatchView;
use crate::color_draft::{ColorDraft, ColorSource};
use crate::station_draft::StationDraft;
use crate::{Fit, Reading};

/// The luminance that the expected values stand for where none is known.
const ASSUMED_PEAK_CD_M2: f64 = 100.0;

pub(super) fn in_short(draft: &StationDraft) -> String {
    match draft.color.source {
        ColorSource::Declared => "sRGB by declaration".to_owned(),
        ColorSource::Typed => "typed".to_owned(),
        ColorSource::Profile => "ICC profile".to_owned(),
        ColorSource::Patches => {
            let (read, whole) = (draft.color.count_read(), draft.color.readings.len());
            format!("{read} of {whole} patches read")
        }
    }
}

/// The luminance of white that the expected values stand for.
pub(super) fn peak_cd_m2(draft: &StationDraft) -> f64 {
    draft
        .peak_cd_m2()
        .ok()
        .flatten()
        .unwrap_or(ASSUMED_PEAK_CD_M2)
}

/// Draws the page; a view of the patches if one was asked for.
pub(super) fn show(ui: &mut Ui, draft: &mut StationDraft) -> Option<PatchView> {
    desk::heading(
        ui,
        "What colours does the display give?",
        "Sessions convert the stimuli from AC1C2 to this display, as the paper did to its monitor. Without a measurement they show the sRGB bytes.",
    );
    ui.horizontal_wrapped(|ui| {
        for (source, words) in [
            (ColorSource::Declared, "sRGB by declaration"),
            (ColorSource::Typed, "typed numbers"),
            (ColorSource::Profile, "ICC profile"),
            (ColorSource::Patches, "read patch by patch"),
        ] {
            ui.radio_value(&mut draft.color.source, source, words);
        }
    });
    ui.add_space(8.0);
    let mut view = None;
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        match draft.color.source {
            ColorSource::Declared => desk::remark(ui, "Nothing is measured; the data say so."),
            ColorSource::Typed => typed(ui, &mut draft.color),
            ColorSource::Profile => {
                desk::facts(ui, "profile", |ui| {
                    desk::field(ui, "file", &mut draft.color.profile, (560.0, ""));
                });
                desk::remark(ui, "The primaries and curves of a matrix profile are used; profiles by tables are refused.");
            }
            ColorSource::Patches => {}
        }
        if let Err(fault) = draft.color.color() {
            desk::bad(ui, fault);
        }
        ui.add_space(8.0);
        if ui.button("Show the patches on the whole screen").clicked() {
            view = Some(PatchView::default());
        }
        if draft.peak_cd_m2().ok().flatten().is_none() {
            let words = "Luminances stand for a white of 100 cd/m2 until the peak luminance is typed (page 5) or read.";
            desk::remark(ui, words);
        }
        let fit = draft.color.fit().ok();
        ui.horizontal_top(|ui| {
            table(ui, draft, fit.as_ref());
            if let (ColorSource::Patches, Some(fit)) = (draft.color.source, &fit) {
                ui.vertical(|ui| found(ui, fit));
            }
        });
    });
    view
}

fn typed(ui: &mut Ui, color: &mut ColorDraft) {
    egui::Grid::new("chromaticities")
        .spacing(Vec2::new(16.0, 8.0))
        .show(ui, |ui| {
            for header in ["", "x", "y"] {
                ui.label(header);
            }
            ui.end_row();
            for (name, fields) in ["red", "green", "blue", "white"]
                .into_iter()
                .zip(&mut color.chromaticities)
            {
                ui.label(name);
                for (field, axis) in fields.iter_mut().zip(["x", "y"]) {
                    cell(ui, field, format!("{name}, {axis}"));
                }
                ui.end_row();
            }
        });
    desk::facts(ui, "gamma", |ui| {
        desk::field(
            ui,
            "gamma (empty: the curve of sRGB)",
            &mut color.gamma,
            (80.0, ""),
        );
    });
}

/// Every patch: what a meter should read, what it read, and how far the model is from that.
fn table(ui: &mut Ui, draft: &mut StationDraft, fit: Option<&Fit>) {
    let peak = peak_cd_m2(draft);
    let takes_readings = draft.color.source == ColorSource::Patches;
    let expected: Vec<Reading> = (draft.color.readings.iter())
        .map(|(patch, _)| draft.color.expected(*patch, peak))
        .collect();
    egui::Grid::new("patches")
        .striped(true)
        .spacing(Vec2::new(14.0, 4.0))
        .show(ui, |ui| {
            let should = if takes_readings {
                "sRGB: Y (cd/m2), x, y"
            } else {
                "a meter should read Y (cd/m2), x, y"
            };
            let headers = [
                "patch",
                should,
                "read: Y (cd/m2)",
                "x",
                "y",
                "model: Y",
                "u'v'",
            ];
            let count = if takes_readings { 7 } else { 2 };
            for header in &headers[..count] {
                ui.label(RichText::new(*header).strong());
            }
            ui.end_row();
            for ((patch, fields), expected) in draft.color.readings.iter_mut().zip(expected) {
                ui.label(patch.name());
                ui.monospace(values(expected));
                if takes_readings {
                    for (field, axis) in fields.iter_mut().zip(["Y", "x", "y"]) {
                        cell(ui, field, format!("{}, {axis}", patch.name()));
                    }
                    let mut residuals = fit.iter().flat_map(|fit| &fit.residuals);
                    if let Some(residual) = residuals.find(|residual| residual.patch == *patch) {
                        ui.monospace(format!("{:+.2} %", residual.luminance_part * 100.0));
                        ui.monospace(
                            residual
                                .delta_uv
                                .map_or_else(String::new, |uv| format!("{uv:.4}")),
                        );
                    }
                }
                ui.end_row();
            }
        });
}

/// A field of a table, which a screen reader knows by this name.
fn cell(ui: &mut Ui, text: &mut String, name: String) {
    let edit = egui::TextEdit::singleline(text).min_size(vec2(86.0, 0.0));
    _ = ui.add(edit).accessible_name(name);
}

/// A reading in words: `100.00  .3127  .3290`.
pub(super) fn values(reading: Reading) -> String {
    let Reading {
        luminance_cd_m2,
        x,
        y,
        ..
    } = reading;
    if luminance_cd_m2 <= 0.0 {
        return format!("{luminance_cd_m2:7.2}");
    }
    format!("{luminance_cd_m2:7.2}  {x:.4}  {y:.4}")
}

/// What was fitted.
fn found(ui: &mut Ui, fit: &Fit) {
    ui.label(RichText::new("What the readings say").strong());
    desk::facts(ui, "fit", |ui| {
        let white = fit.white;
        desk::fact(
            ui,
            "white",
            format!("{} cd/m2 ({}, {})", white.luminance_cd_m2, white.x, white.y),
        );
        let contrast = if fit.black_cd_m2 > 0.0 {
            format!(
                "{} cd/m2, contrast {:.0}",
                fit.black_cd_m2,
                white.luminance_cd_m2 / fit.black_cd_m2
            )
        } else {
            "no light".to_owned()
        };
        desk::fact(ui, "black", contrast);
        for (name, curve) in ["red", "green", "blue"].into_iter().zip(fit.curves) {
            desk::fact(
                ui,
                name,
                format!("gain {:.3}, gamma {:.3}", curve.gain, curve.gamma),
            );
        }
        let sum = format!(
            "{:+.1} % of white, u'v' {:.4} off",
            fit.additivity * 100.0,
            fit.additivity_uv
        );
        desk::fact(ui, "red + green + blue", sum);
        desk::fact(
            ui,
            "model",
            format!("within {:.2} % of white", fit.worst_luminance() * 100.0),
        );
    });
    if fit.additivity.abs() > 0.05 {
        desk::bad(
            ui,
            "Red, green and blue do not add up to white: the display changes its light with the picture (a white subpixel, dynamic contrast). Switch such modes off and read again.",
        );
    }
    if fit.worst_luminance() > 0.03 {
        desk::bad(
            ui,
            "The model misses a reading by more than 3 % of white: read the patch with the largest figure again.",
        );
    }
}

//! The station: how large the screen's pixels are, where the subject sits, and what the colours are taken for.

use std::collections::BTreeMap;

use eframe::egui::Ui;
use experiment::{DisplayColor, ScreenSize, StationFile};
use protocols::Viewing;

use super::fault::Fault;
use super::job::Job;
use super::launcher::Ended;
use super::look::{self, Enabled};
use super::page::{Around, Asked, launch};
use super::study_state::{StationState, Step};

/// The sizes as they are typed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Form {
    width_mm: String,
    width_px: String,
    distance_cm: String,
    monitor: String,
}

/// The page.
#[derive(Default)]
pub(crate) struct StationPage {
    form: Option<Form>,
    measuring: Option<Job<std::io::Result<Ended>>>,
    fault: Option<Fault>,
}

impl StationPage {
    /// Takes what the measuring window has come to.
    pub(crate) fn poll(&mut self) -> Asked {
        let answer = self.measuring.as_ref().and_then(Job::poll);
        let Some(answer) = answer else {
            return Asked::Nothing;
        };
        self.measuring = None;
        self.fault = match answer {
            Ok(Ok(ended)) if ended.code == Some(0) => None,
            Ok(Ok(ended)) => Some(Fault::of_words(&ended.said)),
            Ok(Err(error)) => Some(Fault::of_words(&error.to_string())),
            Err(fault) => Some(fault),
        };
        Asked::ReadAgain
    }

    pub(crate) fn show(&mut self, ui: &mut Ui, around: Around<'_>) -> Asked {
        let viewing = around.state.study.protocol.viewing;
        let words = format!(
            "This computer's screen and chair. The protocol wants a pixel to subtend {}\u{b0}.",
            viewing.degrees_per_pixel
        );
        look::page_head(ui, "Station", &words);
        if let Some(fault) = &self.fault {
            look::fault(ui, fault);
        }
        if let StationState::Unfit(fault) = &around.state.station {
            look::fault(ui, fault);
        }
        if self.form.is_some() {
            return look::card(ui, |ui| self.form(ui, around));
        }
        look::card(ui, |ui| {
            let (mark, words) = around.state.of(Step::Station);
            look::state(ui, mark, &words);
            if !matches!(around.state.station, StationState::Measured(_)) {
                look::weak(
                    ui,
                    "A bank card and a few minutes do: its window fills the screen that is measured, page by page.",
                );
            }
            if let StationState::Measured(station) = &around.state.station {
                ui.add_space(4.0);
                look::facts(ui, &facts(station, around));
            }
            ui.add_space(6.0);
            ui.horizontal(|ui| self.buttons(ui, around));
        });
        Asked::Nothing
    }

    fn buttons(&mut self, ui: &mut Ui, around: Around<'_>) {
        let is_free = Enabled::from(self.measuring.is_none());
        let is_measured = matches!(around.state.station, StationState::Measured(_));
        let (window, form) = ("Measure in a window", "Type the width");
        let pressed = if is_measured {
            look::secondary(ui, is_free, window)
        } else {
            look::primary(ui, is_free, window)
        };
        if pressed.clicked() {
            self.fault = None;
            let mut words = vec!["station".into()];
            words.push(around.state.study.path.clone().into_os_string());
            words.push("--window".into());
            let theme = if ui.visuals().dark_mode {
                "dark"
            } else {
                "light"
            };
            words.extend(["--theme".into(), theme.into()]);
            self.measuring = Some(launch(ui.ctx(), around.tools, words));
        }
        if look::secondary(ui, Enabled::Yes, form).clicked() {
            self.form = Some(Form::of(&around.state.station));
        }
    }

    /// The form; saved only if every number is in its range.
    fn form(&mut self, ui: &mut Ui, around: Around<'_>) -> Asked {
        let Some(form) = &mut self.form else {
            return Asked::Nothing;
        };
        look::title(ui, "By a ruler");
        look::weak(
            ui,
            "The width of the picture on the screen, without the frame, and the pixels of that width.",
        );
        for (label, text, remark) in [
            ("Width in mm", &mut form.width_mm, ""),
            ("Width in pixels", &mut form.width_px, ""),
            (
                "Distance of the eye in cm",
                &mut form.distance_cm,
                "empty: where a pixel subtends the protocol's angle",
            ),
            (
                "Name of the monitor",
                &mut form.monitor,
                "empty: the one that the desktop chooses",
            ),
        ] {
            ui.horizontal(|ui| {
                look::field_in_column(ui, label, text, [190.0, 130.0]);
                look::weak(ui, remark);
            });
        }
        let before = match &around.state.station {
            StationState::Measured(station) => Some(&**station),
            _ => None,
        };
        let viewing = around.state.study.protocol.viewing;
        let station = form.station(before, viewing);
        if let Ok(station) = &station {
            ui.label(station.advice(viewing));
        }
        let (mut is_saved, mut is_left) = (false, false);
        ui.horizontal(|ui| {
            is_saved = look::primary(ui, station.is_ok().into(), "Save the station").clicked();
            is_left = look::secondary(ui, Enabled::Yes, "Cancel").clicked();
        });
        if is_left {
            self.form = None;
            return Asked::Nothing;
        }
        match (station, &around.tools.place.station) {
            (Ok(station), Some(path)) if is_saved => {
                self.fault = station.write(path).err().map(Fault::of);
                self.form = self.form.take().filter(|_| self.fault.is_some());
                Asked::ReadAgain
            }
            (Ok(_), None) if is_saved => {
                let words = "found no home folder for the station; set HOME and start again";
                self.fault = Some(Fault::of_words(words));
                Asked::Nothing
            }
            _ => Asked::Nothing,
        }
    }
}

impl Form {
    /// What was measured before, to be corrected.
    fn of(state: &StationState) -> Self {
        let StationState::Measured(station) = state else {
            return Self::default();
        };
        Self {
            width_mm: station.width_mm.to_string(),
            width_px: station.width_px.to_string(),
            distance_cm: station.distance_cm.to_string(),
            monitor: station.monitor.clone().unwrap_or_default(),
        }
    }

    /// The station that is typed, with colours and lights as they were before.
    fn station(&self, before: Option<&StationFile>, viewing: Viewing) -> Result<StationFile, ()> {
        let number = |text: &str| {
            text.trim()
                .replace(',', ".")
                .parse::<f64>()
                .map_err(|_error| ())
        };
        let monitor = Some(self.monitor.trim()).filter(|name| !name.is_empty());
        let size = ScreenSize {
            width_mm: number(&self.width_mm)?,
            width_px: self.width_px.trim().parse().map_err(|_error| ())?,
        };
        let mut station = before.cloned().unwrap_or_else(|| StationFile {
            monitor: None,
            width_mm: size.width_mm,
            width_px: size.width_px,
            distance_cm: viewing.distance_cm,
            peak_luminance_cd_m2: None,
            surround: None,
            background_cd_m2: None,
            room_lux: None,
            experimenter_monitor: None,
            not_native_because: None,
            refresh: None,
            color: DisplayColor::Srgb,
            screens: BTreeMap::new(),
        });
        if station.monitor.as_deref() != monitor {
            station.refresh = None;
        }
        station.monitor = monitor.map(str::to_owned);
        (station.width_mm, station.width_px) = (size.width_mm, size.width_px);
        let named = monitor.map(|name| (name.to_owned(), size));
        station.screens.extend(named);
        station.distance_cm = if self.distance_cm.trim().is_empty() {
            (station.distance_cm_for(viewing) * 10.0).round() / 10.0
        } else {
            number(&self.distance_cm)?
        };
        Ok(station)
    }
}

/// What is known of the screen and the room, as `acuity check` says it.
fn facts(station: &StationFile, around: Around<'_>) -> Vec<(&'static str, String)> {
    let viewing = around.state.study.protocol.viewing;
    let number = |value: Option<f64>, unit: &str| {
        value.map_or_else(
            || "not measured".to_owned(),
            |value| format!("{value} {unit}"),
        )
    };
    let luminance = |value| number(value, "cd/m\u{b2}");
    let peak = luminance(station.peak_luminance_cd_m2);
    let (room, behind) = (
        number(station.room_lux, "lx"),
        luminance(station.background_cd_m2),
    );
    let surround = station.surround.as_deref().unwrap_or("not noted");
    let refresh = around.state.sessions.last_refresh().or(station.refresh);
    let refresh = refresh.map(experiment::Refresh::in_words);
    let monitor = station.monitor.as_deref();
    let size = format!(
        "{} mm wide, {} pixels: {:.4} mm per pixel",
        station.width_mm,
        station.width_px,
        station.pixel_pitch_mm()
    );
    let distance = format!(
        "{} cm: a pixel subtends {:.5}\u{b0} (the protocol's {}\u{b0} from {:.1} cm)",
        station.distance_cm,
        station.degrees_per_pixel(),
        viewing.degrees_per_pixel,
        station.distance_cm_for(viewing)
    );
    vec![
        (
            "Monitor",
            monitor
                .unwrap_or("the one that the desktop chooses")
                .to_owned(),
        ),
        ("Size", size),
        ("Distance", distance),
        ("Colour", station.color.in_words()),
        (
            "Refresh",
            refresh.unwrap_or_else(|| "measured when a session begins".to_owned()),
        ),
        (
            "Peak luminance",
            format!("{peak} (ITU-R BT.500 advises 70 to 250 in a laboratory)"),
        ),
        (
            "Lights, surround",
            format!("{surround} (BT.500: dim, a background of 15 % of the peak)"),
        ),
        ("Room", format!("{room} (ITU-T P.910 advises at most 20)")),
        (
            "Behind the screen",
            format!("{behind} (P.910: at most 20 % of the peak)"),
        ),
    ]
}

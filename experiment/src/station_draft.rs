//! A station while it is being measured: what stands in the fields, and what follows from it.
//!
//! The size of a pixel follows from how many pixels are as wide as a bank card (85.60 mm, ISO/IEC 7810 ID-1); a width
//! of the picture that is typed sets that number, and the other way round. Nothing counts as measured before one of
//! them was set by hand.
//!
//! Not here: the pages (`window/station`), and the colours (`color_draft`).

use std::collections::BTreeMap;

use protocols::{Study, Viewing};

use crate::color_draft::{ColorDraft, ColorSource};
use crate::{Patch, Refresh, ScreenSize, StationFile};

/// A bank card: ISO/IEC 7810, format ID-1.
pub(crate) const CARD_MM: [f64; 2] = [85.60, 53.98];
/// How wide the outline is before it was set: a card on a screen of 96 pixels an inch.
const FIRST_CARD_PX: f64 = 324.0;

/// The screen that is measured, as the window system says it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ScreenFacts {
    pub(crate) name: Option<String>,
    pub(crate) size_px: [u32; 2],
    pub(crate) nominal_hz: Option<f64>,
    /// Whether one pixel of an image is one pixel of the monitor, or why not; `None` where nobody knows.
    pub(crate) one_to_one: Option<Result<(), ModeFault>>,
}

/// Why a session would refuse a screen as it is now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ModeFault {
    /// Found, expected, and what to do.
    pub(crate) words: String,
    /// Whether the station may say why it is right all the same.
    pub(crate) may_be_right: bool,
}

/// Whether the angle of a pixel is what the protocol asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AngleVerdict {
    /// The angle at the distance typed.
    pub(crate) degrees: f64,
    /// How far it is from the protocol's, as a part of it.
    pub(crate) deviation: f64,
    /// Whether that keeps to the tolerance, if the protocol has one.
    pub(crate) is_within: Option<bool>,
}

/// The fields of a station.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StationDraft {
    viewing: Viewing,
    tolerance: Option<f64>,
    screen: ScreenFacts,
    card_px: f64,
    is_sized: bool,
    pub(crate) width_typed: String,
    pub(crate) distance_typed: String,
    pub(crate) color: ColorDraft,
    pub(crate) peak_typed: String,
    pub(crate) background_typed: String,
    pub(crate) room_typed: String,
    pub(crate) surround: String,
    pub(crate) experimenter_monitor: Option<String>,
    pub(crate) not_native_because: String,
    /// The refresh, and the monitor that it was measured on.
    refresh: Option<(Option<String>, Refresh)>,
    screens: BTreeMap<String, ScreenSize>,
}

impl StationDraft {
    /// The fields for a study, filled with what the station had before.
    pub(crate) fn new(study: &Study, before: Option<StationFile>) -> Self {
        let mut draft = Self {
            viewing: study.protocol.viewing,
            tolerance: study.protocol.session.viewing_tolerance,
            screen: ScreenFacts::default(),
            card_px: FIRST_CARD_PX,
            is_sized: false,
            width_typed: String::new(),
            distance_typed: String::new(),
            color: ColorDraft::default(),
            peak_typed: String::new(),
            background_typed: String::new(),
            room_typed: String::new(),
            surround: String::new(),
            experimenter_monitor: None,
            not_native_because: String::new(),
            refresh: None,
            screens: BTreeMap::new(),
        };
        if let Some(before) = before {
            let text = |number: Option<f64>| number.map_or_else(String::new, |n| n.to_string());
            draft.screens = before.screens;
            draft.refresh = before
                .refresh
                .map(|refresh| (before.monitor.clone(), refresh));
            if let Some(monitor) = before.monitor {
                draft.screens.entry(monitor).or_insert(ScreenSize {
                    width_mm: before.width_mm,
                    width_px: before.width_px,
                });
            }
            draft.distance_typed = before.distance_cm.to_string();
            draft.color = ColorDraft::of(&before.color);
            draft.peak_typed = text(before.peak_luminance_cd_m2);
            draft.background_typed = text(before.background_cd_m2);
            draft.room_typed = text(before.room_lux);
            draft.surround = before.surround.unwrap_or_default();
            draft.experimenter_monitor = before.experimenter_monitor;
            draft.not_native_because = before.not_native_because.unwrap_or_default();
        }
        draft
    }

    pub(crate) fn viewing(&self) -> Viewing {
        self.viewing
    }

    pub(crate) fn tolerance(&self) -> Option<f64> {
        self.tolerance
    }

    pub(crate) fn screen(&self) -> &ScreenFacts {
        &self.screen
    }

    /// The window is on this screen now; what was measured of it before is taken up.
    pub(crate) fn stand_on(&mut self, screen: ScreenFacts) {
        if screen == self.screen {
            return;
        }
        let known = screen
            .name
            .as_ref()
            .and_then(|name| self.screens.get(name).copied());
        let known = known.filter(|known| known.width_px == screen.size_px[0]);
        self.screen = screen;
        self.is_sized = false;
        self.card_px = FIRST_CARD_PX;
        self.width_typed.clear();
        if let Some(known) = known {
            self.set_width_mm(known.width_mm);
            self.width_typed = format!("{:.1}", known.width_mm);
        }
    }

    /// The refresh of the present screen has been measured.
    pub(crate) fn set_refresh(&mut self, refresh: Refresh) {
        self.refresh = Some((self.screen.name.clone(), refresh));
    }

    /// How many pixels are as wide as the card.
    pub(crate) fn card_px(&self) -> f64 {
        self.card_px
    }

    /// The outline was made so wide by hand.
    pub(crate) fn set_card_px(&mut self, card_px: f64) {
        let most = f64::from(self.screen.size_px[0].max(200));
        self.card_px = card_px.clamp(60.0, most);
        self.is_sized = true;
        self.width_typed = format!("{:.1}", self.width_mm());
    }

    /// The typed width has changed; sets the outline, if it is a width.
    pub(crate) fn take_width_typed(&mut self) {
        if let Ok(Some(width_mm)) = number(&self.width_typed, "width", [50.0, 5000.0]) {
            self.set_width_mm(width_mm);
        }
    }

    fn set_width_mm(&mut self, width_mm: f64) {
        self.card_px = CARD_MM[0] * f64::from(self.screen.size_px[0]) / width_mm;
        self.is_sized = true;
    }

    pub(crate) fn is_sized(&self) -> bool {
        self.is_sized
    }

    pub(crate) fn pixel_pitch_mm(&self) -> f64 {
        CARD_MM[0] / self.card_px
    }

    pub(crate) fn width_mm(&self) -> f64 {
        self.pixel_pitch_mm() * f64::from(self.screen.size_px[0])
    }

    pub(crate) fn height_mm(&self) -> f64 {
        self.pixel_pitch_mm() * f64::from(self.screen.size_px[1])
    }

    /// Where a pixel subtends the protocol's angle: `d = p / tan a`.
    pub(crate) fn wanted_distance_cm(&self) -> f64 {
        self.pixel_pitch_mm() / 10.0 / libm::tan(self.viewing.degrees_per_pixel.to_radians())
    }

    /// The distance typed, or, where nothing is typed, the one wanted, to a millimetre.
    pub(crate) fn distance_cm(&self) -> Result<f64, String> {
        let typed = number(&self.distance_typed, "distance", [10.0, 1000.0])?;
        Ok(typed.unwrap_or_else(|| (self.wanted_distance_cm() * 10.0).round() / 10.0))
    }

    /// The angle of a pixel at that distance: `a = atan(p / d)`.
    pub(crate) fn verdict(&self) -> Result<AngleVerdict, String> {
        let distance_cm = self.distance_cm()?;
        let degrees = libm::atan(self.pixel_pitch_mm() / (10.0 * distance_cm)).to_degrees();
        let deviation = degrees / self.viewing.degrees_per_pixel - 1.0;
        Ok(AngleVerdict {
            degrees,
            deviation,
            is_within: self.tolerance.map(|tolerance| deviation.abs() <= tolerance),
        })
    }

    /// The peak luminance: typed, or of the white that was read.
    pub(crate) fn peak_cd_m2(&self) -> Result<Option<f64>, String> {
        let typed = number(&self.peak_typed, "peak luminance", [1.0, 10_000.0])?;
        let white = self
            .color
            .readings
            .iter()
            .find(|(patch, _)| *patch == Patch::WHITE);
        let is_read = self.color.source == ColorSource::Patches;
        let read = white.filter(|_| is_read).map(|(_, fields)| &fields[0]);
        let read = read.and_then(|field| number(field, "white", [1.0, 10_000.0]).ok()?);
        Ok(typed.or(read))
    }

    pub(crate) fn background_cd_m2(&self) -> Result<Option<f64>, String> {
        number(
            &self.background_typed,
            "luminance behind the screen",
            [0.0, 10_000.0],
        )
    }

    pub(crate) fn room_lux(&self) -> Result<Option<f64>, String> {
        number(&self.room_typed, "light of the room", [0.0, 100_000.0])
    }

    /// The station, if everything is there.
    ///
    /// # Errors
    ///
    /// What is missing or cannot be, in words, in the order of the pages.
    pub(crate) fn station(&self) -> Result<StationFile, String> {
        number(&self.width_typed, "width", [50.0, 5000.0])?;
        if !self.is_sized {
            return Err("Screen: the size is not measured; fit the outline to a bank card or type the width".to_owned());
        }
        let width_px = self.screen.size_px[0];
        let width_mm = (self.width_mm() * 100.0).round() / 100.0;
        let mut screens = self.screens.clone();
        if let Some(name) = &self.screen.name {
            screens.insert(name.clone(), ScreenSize { width_mm, width_px });
        }
        let words = |typed: &str| Some(typed.trim().to_owned()).filter(|words| !words.is_empty());
        Ok(StationFile {
            monitor: self.screen.name.clone(),
            width_mm,
            width_px,
            distance_cm: self.distance_cm().map_err(on("Distance"))?,
            peak_luminance_cd_m2: self.peak_cd_m2().map_err(on("Room"))?,
            surround: words(&self.surround),
            background_cd_m2: self.background_cd_m2().map_err(on("Room"))?,
            room_lux: self.room_lux().map_err(on("Room"))?,
            refresh: self
                .refresh
                .as_ref()
                .and_then(|(monitor, refresh)| (*monitor == self.screen.name).then_some(*refresh)),
            experimenter_monitor: self.experimenter_monitor.clone(),
            not_native_because: words(&self.not_native_because),
            color: self.color.color().map_err(on("Colour"))?,
            screens,
        })
    }
}

/// Says which page a fault is on.
fn on(page: &'static str) -> impl Fn(String) -> String {
    move |fault| format!("{page}: {fault}")
}

/// A number that was typed, with a point or a comma; `None` for an empty field.
///
/// # Errors
///
/// It is no number, or out of range.
pub(crate) fn number(
    typed: &str,
    what: &str,
    [low, high]: [f64; 2],
) -> Result<Option<f64>, String> {
    let typed = typed.trim();
    if typed.is_empty() {
        return Ok(None);
    }
    match typed.replace(',', ".").parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(Some(value)),
        _ => Err(format!(
            "{what}: found \"{typed}\", expected a number from {low} to {high}"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::small_study;

    fn screen(name: &str, size_px: [u32; 2]) -> ScreenFacts {
        ScreenFacts {
            name: Some(name.to_owned()),
            size_px,
            nominal_hz: Some(60.0),
            one_to_one: None,
        }
    }

    fn draft() -> StationDraft {
        let folder = tempfile::tempdir().unwrap();
        let mut study = small_study(folder.path());
        study.protocol.session.viewing_tolerance = Some(0.02);
        StationDraft::new(&study, None)
    }

    /// 311.8 pixels a card on a 24-inch screen (527.04 mm of 1920 pixels): pitch 0.2745 mm, 82.78 cm (bc -l).
    #[test]
    fn a_card_gives_the_size_of_the_screen_and_the_place_of_the_chair() {
        let mut draft = draft();
        draft.stand_on(screen("DP-1", [1920, 1080]));
        assert!(draft.station().unwrap_err().starts_with("Screen:"));
        draft.set_card_px(85.60 / 0.2745);
        assert!((draft.width_mm() - 527.04).abs() < 1e-9);
        assert!((draft.height_mm() - 296.46).abs() < 1e-9);
        assert!((draft.wanted_distance_cm() - 82.78).abs() < 0.005);
        assert!(draft.verdict().unwrap().is_within.unwrap());
        // From 60 cm: atan(.02745 / 60) = 0.026213 degrees, 38 % more.
        draft.distance_typed = "60".to_owned();
        let verdict = draft.verdict().unwrap();
        assert!((verdict.degrees - 0.026_213).abs() < 1e-6, "{verdict:?}");
        assert!((verdict.deviation - 0.3796).abs() < 1e-4 && verdict.is_within == Some(false));
        let station = draft.station().unwrap();
        assert_eq!((station.width_mm, station.distance_cm), (527.04, 60.0));
        assert_eq!(station.screens["DP-1"].width_px, 1920);
    }

    #[test]
    fn a_typed_width_moves_the_outline_and_the_outline_the_width() {
        let mut draft = draft();
        draft.stand_on(screen("DP-1", [1920, 1080]));
        draft.width_typed = "527,04".to_owned();
        draft.take_width_typed();
        assert!(
            (draft.card_px() - 311.839_7).abs() < 1e-3,
            "{}",
            draft.card_px()
        );
        draft.set_card_px(400.0);
        assert_eq!(draft.width_typed, "410.9");
        draft.width_typed = "wide".to_owned();
        draft.take_width_typed();
        assert_eq!(draft.card_px(), 400.0);
        assert!(draft.station().unwrap_err().contains("\"wide\""));
    }

    #[test]
    fn every_monitor_keeps_its_own_size() {
        let mut draft = draft();
        draft.stand_on(screen("DP-1", [1920, 1080]));
        draft.set_card_px(311.84);
        let saved = draft.station().unwrap();
        draft = StationDraft {
            screens: saved.screens.clone(),
            ..draft
        };
        draft.stand_on(screen("DP-2", [3840, 2160]));
        assert!(!draft.is_sized());
        draft.set_card_px(480.0);
        let saved = draft.station().unwrap();
        assert_eq!(
            (saved.monitor.as_deref(), saved.screens.len()),
            (Some("DP-2"), 2)
        );
        draft = StationDraft {
            screens: saved.screens,
            ..draft
        };
        draft.stand_on(screen("DP-1", [1920, 1080]));
        assert!(draft.is_sized() && (draft.card_px() - 311.84).abs() < 0.01);
        // At another resolution it is another size of pixel.
        draft.stand_on(screen("DP-1", [1280, 720]));
        assert!(!draft.is_sized());
    }

    #[test]
    fn a_station_opens_with_what_it_had() {
        let folder = tempfile::tempdir().unwrap();
        let study = small_study(folder.path());
        let mut draft = draft();
        draft.stand_on(screen("DP-1", [1920, 1080]));
        draft.set_card_px(311.84);
        draft.room_typed = "18".to_owned();
        draft.background_typed = "16,5".to_owned();
        draft.peak_typed = "120".to_owned();
        draft.surround = " dim ".to_owned();
        draft.distance_typed = "82.8".to_owned();
        draft.not_native_because = "a tube".to_owned();
        let station = draft.station().unwrap();
        assert_eq!(station.surround.as_deref(), Some("dim"));
        assert_eq!(station.background_cd_m2, Some(16.5));
        let mut again = StationDraft::new(&study, Some(station.clone()));
        again.stand_on(screen("DP-1", [1920, 1080]));
        assert_eq!(again.station().unwrap(), station);
    }
}

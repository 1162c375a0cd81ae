//! Whether a pixel of the desktop is a pixel of the monitor: what the X server says of the mode that the monitor runs.
//!
//! A desktop may draw a picture of another size and let the graphics card scale it (`xrandr --scale`, fractional
//! scaling of desktops on X11), and a monitor may run a mode with fewer pixels than it has. Neither can be seen in the
//! window's own pixels, so the X server is asked. Where it does not answer nothing is known, and nothing is claimed.
//!
//! Not here: scaling of widgets (`pixels_per_point`), which touches no image.

use std::error::Error;

use x11rb::connection::Connection as _;
use x11rb::protocol::randr::{ConnectionExt as _, GetCrtcInfoReply, ModeInfo, Rotation};
use x11rb::protocol::xproto::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

use crate::{ExperimentError, StationFile};

/// A monitor's picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ScreenMode {
    /// The part of the desktop that it shows.
    pub(crate) area: [u32; 2],
    /// What the graphics card sends it.
    pub(crate) mode: [u32; 2],
    /// What it prefers by its own description (EDID): its own pixels.
    pub(crate) native: Option<[u32; 2]>,
}

impl ScreenMode {
    /// The mode of the monitor with this name; `None` if the X server does not say.
    pub(crate) fn of(monitor: &str) -> Option<Self> {
        let outputs = outputs().ok().flatten()?;
        let mut outputs = outputs.into_iter();
        let output = outputs.find(|output| output.name == monitor);
        output.map(|output| output.mode)
    }

    /// Whether enough is known to say that it is one to one, or that it is not.
    pub(crate) fn is_known(self) -> bool {
        self.native.is_some() || self.area != self.mode
    }

    /// Whether one pixel of an image is one pixel of the monitor.
    ///
    /// # Errors
    ///
    /// The picture is scaled on its way, or the monitor does not run at its own resolution and the station does not
    /// say why.
    pub(crate) fn check(self, station: Option<&StationFile>) -> Result<(), ExperimentError> {
        if self.area != self.mode {
            return Err(ExperimentError::Scaled {
                area_px: self.area,
                mode_px: self.mode,
            });
        }
        let is_explained = station.is_some_and(|station| station.not_native_because.is_some());
        match self.native {
            Some(native_px) if native_px != self.mode && !is_explained => {
                Err(ExperimentError::NotNative {
                    mode_px: self.mode,
                    native_px,
                })
            }
            _ => Ok(()),
        }
    }
}

/// A monitor that shows something.
struct Output {
    name: String,
    mode: ScreenMode,
    nominal_hz: Option<f64>,
}

/// Every monitor that shows something; `None` on Wayland, where the X server does not know the screen.
fn outputs() -> Result<Option<Vec<Output>>, Box<dyn Error>> {
    let (connection, screen) = RustConnection::connect(None)?;
    let wayland = connection.query_extension(b"XWAYLAND")?.reply()?;
    if wayland.present {
        return Ok(None);
    }
    let root = connection.setup().roots[screen].root;
    let resources = connection
        .randr_get_screen_resources_current(root)?
        .reply()?;
    let mut outputs = Vec::new();
    for output in resources.outputs {
        let at = resources.config_timestamp;
        let output = connection.randr_get_output_info(output, at)?.reply()?;
        if output.crtc == 0 {
            continue;
        }
        let crtc = connection.randr_get_crtc_info(output.crtc, at)?.reply()?;
        let mode = |id: u32| resources.modes.iter().find(|mode| mode.id == id);
        let preferred = (output.num_preferred > 0).then(|| output.modes.first());
        let native = preferred.flatten().and_then(|&id| mode(id));
        outputs.extend(mode(crtc.mode).map(|mode| Output {
            name: String::from_utf8_lossy(&output.name).into_owned(),
            mode: screen_mode(&crtc, mode, native),
            nominal_hz: nominal_hz(mode),
        }));
    }
    Ok(Some(outputs))
}

/// Pixels a second by pixels a frame, blanking included.
fn nominal_hz(mode: &ModeInfo) -> Option<f64> {
    let pixels = f64::from(mode.htotal) * f64::from(mode.vtotal);
    (mode.dot_clock > 0 && pixels > 0.0).then(|| f64::from(mode.dot_clock) / pixels)
}

/// What the X server says of the subject's monitor, in words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ScreenReport {
    /// What is known.
    pub lines: Vec<String>,
    /// What would end a session before its first screen.
    pub faults: Vec<String>,
}

/// Asks the X server for the station's monitor, or for the first; where no display is named nothing is asked.
pub fn check_screen(station: Option<&StationFile>) -> ScreenReport {
    let display = std::env::var("DISPLAY").unwrap_or_default();
    if display.is_empty() {
        return ScreenReport::default();
    }
    let wanted = station.and_then(|station| station.monitor.as_deref());
    match outputs() {
        Ok(Some(outputs)) => report(&outputs, station, wanted),
        Ok(None) => ScreenReport {
            lines: vec!["screen: Wayland, which says nothing of its monitors; look into the desktop's settings for 100 % and the own resolution".to_owned()],
            faults: Vec::new(),
        },
        Err(error) => ScreenReport {
            lines: Vec::new(),
            faults: vec![format!("display: found {display:?}, which does not answer ({error}), expected an X11 display for the session's window; log in to the desktop")],
        },
    }
}

fn report(outputs: &[Output], station: Option<&StationFile>, wanted: Option<&str>) -> ScreenReport {
    let mut report = ScreenReport::default();
    let is_wanted = |output: &&Output| wanted.is_none_or(|wanted| wanted == output.name);
    let Some(Output {
        name,
        mode,
        nominal_hz,
    }) = outputs.iter().find(is_wanted)
    else {
        let names: Vec<&str> = outputs.iter().map(|output| &*output.name).collect();
        let error = ExperimentError::NoMonitor {
            wanted: wanted.unwrap_or_default().to_owned(),
            all: names.join(", "),
        };
        report.faults.push(error.to_string());
        return report;
    };
    let [width, height] = mode.area;
    let own = match mode.native {
        Some(native) if native == mode.area => "its own resolution".to_owned(),
        Some([width, height]) => format!("its own are {width} x {height}"),
        None => "its own resolution is not known".to_owned(),
    };
    let hertz = nominal_hz.map_or_else(
        || "no nominal refresh rate".to_owned(),
        |hertz| format!("nominal refresh {hertz:.2} Hz"),
    );
    let line = format!("screen: monitor {name}, {width} x {height} pixels ({own}), {hertz}");
    report.lines.push(line);
    let faults = [
        mode.check(station).err(),
        station
            .filter(|station| station.width_px != width)
            .map(|station| ExperimentError::OtherScreen {
                found_px: width,
                measured_px: station.width_px,
            }),
    ];
    let faults = faults.into_iter().flatten();
    report.faults.extend(faults.map(|error| error.to_string()));
    report
}

/// The sizes, as they lie on the desktop.
fn screen_mode(crtc: &GetCrtcInfoReply, mode: &ModeInfo, native: Option<&ModeInfo>) -> ScreenMode {
    let is_on_its_side = u16::from(crtc.rotation)
        & (u16::from(Rotation::ROTATE90) | u16::from(Rotation::ROTATE270))
        != 0;
    let size = |mode: &ModeInfo| {
        let [width, height] = [mode.width, mode.height].map(u32::from);
        if is_on_its_side {
            [height, width]
        } else {
            [width, height]
        }
    };
    ScreenMode {
        area: [crtc.width, crtc.height].map(u32::from),
        mode: size(mode),
        native: native.map(size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(width: u16, height: u16) -> ModeInfo {
        ModeInfo {
            width,
            height,
            ..ModeInfo::default()
        }
    }

    fn crtc(width: u16, height: u16, rotation: Rotation) -> GetCrtcInfoReply {
        GetCrtcInfoReply {
            width,
            height,
            rotation,
            ..GetCrtcInfoReply::default()
        }
    }

    #[test]
    fn a_monitor_on_its_side_is_at_its_own_resolution() {
        let own = mode(1920, 1200);
        let found = screen_mode(&crtc(1200, 1920, Rotation::ROTATE270), &own, Some(&own));
        assert_eq!(found.native, Some([1200, 1920]));
        assert!(found.check(None).is_ok());
    }

    #[test]
    fn a_picture_that_is_scaled_on_its_way_is_refused_and_says_so() {
        // As GNOME's 150 % on a monitor of 2560 x 1440: twice the size, scaled down by 4/3.
        let own = mode(2560, 1440);
        let found = screen_mode(&crtc(3414, 1920, Rotation::ROTATE0), &own, Some(&own));
        let error = found.check(None).unwrap_err().to_string();
        for words in ["3414 x 1920", "2560 x 1440", "scal"] {
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn another_resolution_than_the_monitor_s_own_is_refused_unless_the_station_says_why() {
        let (low, own) = (mode(1920, 1080), mode(3840, 2160));
        let found = screen_mode(&crtc(1920, 1080, Rotation::ROTATE0), &low, Some(&own));
        let error = found.check(None).unwrap_err().to_string();
        assert!(
            error.contains("1920 x 1080") && error.contains("3840 x 2160"),
            "{error}"
        );
        let station = "width_mm = 520.0\nwidth_px = 1920\ndistance_cm = 80.0\n";
        let silent: StationFile = toml::from_str(station).unwrap();
        assert!(found.check(Some(&silent)).is_err());
        let because = format!("{station}not_native_because = \"a cathode-ray tube\"\n");
        let explained: StationFile = toml::from_str(&because).unwrap();
        assert!(found.check(Some(&explained)).is_ok());
        assert!(found.is_known());
        // Where the monitor does not describe itself nothing is known.
        let unknown = screen_mode(&crtc(1920, 1080, Rotation::ROTATE0), &low, None);
        assert!(unknown.check(None).is_ok() && !unknown.is_known());
    }

    fn at(name: &str, own: &ModeInfo, shown: &ModeInfo) -> Output {
        let crtc = crtc(shown.width, shown.height, Rotation::ROTATE0);
        Output {
            name: name.to_owned(),
            mode: screen_mode(&crtc, shown, Some(own)),
            nominal_hz: nominal_hz(shown),
        }
    }

    /// 1920 x 1080 at 60 Hz by CEA-861: 148.5 MHz, 2200 x 1125 with blanking.
    #[test]
    fn the_report_names_the_monitor_and_what_would_end_a_session() {
        let full = ModeInfo {
            dot_clock: 148_500_000,
            htotal: 2200,
            vtotal: 1125,
            ..mode(1920, 1080)
        };
        let outputs = [
            at("eDP-1", &full, &mode(1280, 720)),
            at("DP-1", &full, &full),
        ];
        let station = "monitor = \"DP-1\"\nwidth_mm = 527.0\nwidth_px = 1920\ndistance_cm = 82.0\n";
        let good: StationFile = toml::from_str(station).unwrap();
        let found = report(&outputs, Some(&good), good.monitor.as_deref());
        let line = "screen: monitor DP-1, 1920 x 1080 pixels (its own resolution), nominal refresh 60.00 Hz";
        assert_eq!(found.lines, [line]);
        assert!(found.faults.is_empty(), "{:?}", found.faults);
        for (old, new, named) in [
            ("DP-1", "DP-9", "eDP-1, DP-1"),
            ("DP-1", "eDP-1", "its own 1920 x 1080"),
            ("width_px = 1920", "width_px = 2560", "2560"),
        ] {
            let wrong: StationFile = toml::from_str(&station.replace(old, new)).unwrap();
            let faults = report(&outputs, Some(&wrong), wrong.monitor.as_deref()).faults;
            assert!(
                faults.iter().any(|fault| fault.contains(named)),
                "{faults:?}"
            );
        }
    }
}

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
        ask(monitor).ok().flatten()
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

fn ask(monitor: &str) -> Result<Option<ScreenMode>, Box<dyn Error>> {
    let (connection, screen) = RustConnection::connect(None)?;
    let root = connection.setup().roots[screen].root;
    let resources = connection
        .randr_get_screen_resources_current(root)?
        .reply()?;
    for output in resources.outputs {
        let at = resources.config_timestamp;
        let output = connection.randr_get_output_info(output, at)?.reply()?;
        if output.name != monitor.as_bytes() || output.crtc == 0 {
            continue;
        }
        let crtc = connection.randr_get_crtc_info(output.crtc, at)?.reply()?;
        let mode = |id: u32| resources.modes.iter().find(|mode| mode.id == id);
        let preferred = (output.num_preferred > 0).then(|| output.modes.first());
        let native = preferred.flatten().and_then(|&id| mode(id));
        return Ok(mode(crtc.mode).map(|mode| screen_mode(&crtc, mode, native)));
    }
    Ok(None)
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
        // Where the monitor does not describe itself nothing is known.
        let unknown = screen_mode(&crtc(1920, 1080, Rotation::ROTATE0), &low, None);
        assert!(unknown.check(None).is_ok());
    }
}

//! What comes before the first screen: the window fills the monitor, its frames are timed, its pixels compared.

use super::app::Show;
use super::gate::{Gate, Sizes};
use super::geometry::needed_px;
use super::monitor::Monitor;
use super::paint::Brush;
use super::proof::Proof;
use crate::sidecar::Station;
use crate::sitting::Sitting;
use crate::{ExperimentError, Noted, Refresh, StationFile};

/// How many intervals between frames are measured before the first screen, and in a trial run.
pub(super) const MEASURED_FRAMES: usize = 300;
const MEASURED_FRAMES_OF_PILOT: usize = 20;

/// What comes before the first screen, one after the other.
pub(crate) enum Before {
    /// The window must fill the monitor.
    Sizing(Gate),
    /// The frames are timed.
    Timing { began: Vec<f64> },
    /// The window is compared with the images.
    Proving { proof: Proof, refresh: Refresh },
    /// The session runs.
    Nothing,
}

fn check_fit(needed_px: [u32; 2], sizes: Sizes) -> Result<(), ExperimentError> {
    let found_px = sizes.window_px;
    if found_px[0] >= needed_px[0] && found_px[1] >= needed_px[1] {
        return Ok(());
    }
    Err(ExperimentError::TooSmall {
        found_px,
        needed_px,
    })
}

impl Before {
    /// One frame before the session; true when it may begin.
    pub(crate) fn frame(
        &mut self,
        sitting: &mut Sitting,
        show: &Show,
        brush: &Brush<'_>,
        (monitor, sizes, (now_s, tells_swaps)): (&Monitor, Sizes, (f64, bool)),
    ) -> Result<bool, ExperimentError> {
        let context = brush.painter.ctx();
        match self {
            Self::Sizing(gate) => {
                let is_there = monitor.is_wanted(show.monitor.as_deref(), context)?;
                if is_there && gate.is_open(context, sizes, now_s)? {
                    check_fit(needed_px(&show.plan, show.pictures.image_px), sizes)?;
                    check_station(show.station.as_ref(), monitor, sizes)?;
                    *self = Self::Timing { began: vec![now_s] };
                }
            }
            Self::Timing { began } => {
                began.push(now_s);
                if let Some(refresh) = measured(began, show, monitor)? {
                    *self = Self::Proving {
                        proof: Proof::of(&sitting.session),
                        refresh,
                    };
                }
            }
            Self::Proving { proof, refresh } => {
                let (geometry, gap_px) = (brush.geometry, show.plan.gap_px);
                if proof.advance(context, geometry, &show.pictures, gap_px)? {
                    let station = Station {
                        compared_px: proof.compared_px(),
                        refresh: Some(*refresh),
                        tells_swaps,
                        measured: show.station.clone(),
                        out_of_gamut_px: show.out_of_gamut_px.clone(),
                        white_luminance: show.display.white_luminance(),
                        ..station(monitor, sizes)
                    };
                    let session = &mut sitting.session;
                    session.note(Noted::RefreshMeasured, now_s, refresh.in_words());
                    session.note(Noted::PixelsCompared, now_s, proof.in_words());
                    session.note(Noted::SwapWatch, now_s, swaps_in_words(&station));
                    sitting.begin(station, now_s)?;
                    *self = Self::Nothing;
                    return Ok(true);
                }
                if let Some((picture, test_image)) = proof.picture() {
                    brush.picture(picture, test_image, &show.pictures);
                }
            }
            Self::Nothing => return Ok(true),
        }
        Ok(false)
    }
}

/// The refresh by the frames that were begun at these times, once there are enough.
fn measured(
    began: &[f64],
    show: &Show,
    monitor: &Monitor,
) -> Result<Option<Refresh>, ExperimentError> {
    let wanted = match show.pilot {
        Some(_) => MEASURED_FRAMES_OF_PILOT,
        None => MEASURED_FRAMES,
    };
    if began.len() <= wanted {
        return Ok(None);
    }
    let intervals: Vec<f64> = began.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let refresh = Refresh::of(&intervals, monitor.nominal_hz);
    match show.plan.lowest_refresh_hz {
        Some(lowest_hz) if !refresh.reaches(lowest_hz) => Err(ExperimentError::TooFewFrames {
            found_hz: refresh.rate_hz(),
            lowest_hz,
        }),
        _ => Ok(Some(refresh)),
    }
}

fn swaps_in_words(station: &Station) -> &'static str {
    if station.tells_swaps {
        "the driver tells when it swapped each frame"
    } else {
        "the driver does not tell when it swapped a frame: software times"
    }
}

/// Whether this is the screen that was measured, one of its pixels for each of an image.
fn check_station(
    station: Option<&StationFile>,
    monitor: &Monitor,
    sizes: Sizes,
) -> Result<(), ExperimentError> {
    let measured = station.and_then(|station| station.monitor.as_ref());
    if let (Some(measured), Some(found)) = (measured, &monitor.name)
        && measured != found
    {
        return Err(ExperimentError::OtherMonitor {
            found: found.clone(),
            measured: measured.clone(),
        });
    }
    let other = station.filter(|station| station.width_px != sizes.monitor_px[0]);
    if let Some(station) = other {
        return Err(ExperimentError::OtherScreen {
            found_px: sizes.monitor_px[0],
            measured_px: station.width_px,
        });
    }
    monitor.mode().map_or(Ok(()), |mode| mode.check(station))
}

fn station(monitor: &Monitor, sizes: Sizes) -> Station {
    Station {
        monitor: monitor.name.clone(),
        native_px: monitor.mode().and_then(|mode| mode.native),
        refresh: None,
        tells_swaps: false,
        compared_px: 0,
        measured: None,
        out_of_gamut_px: std::collections::BTreeMap::new(),
        white_luminance: None,
        operating_system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        window_px: sizes.window_px,
        monitor_px: sizes.monitor_px,
        pixels_per_point: sizes.pixels_per_point,
    }
}

//! `acuity image`: one image of a scene, with its channels as deep as asked for or as can be seen.

use std::path::Path;

use experiment::{ScreenImage, visible_difference_jod};
use protocols::{Acuity, InputError, PerChannel, Study, TreePlan, Viewing};
use renderer::{AcuityLimits, Confidence, ImageRequest, ImageSummary, Watch};

use crate::acuity_comparison::{AcuityComparison, Timed};
use crate::command_line::{Eye, ImageArguments};
use crate::console::{self, Progress};
use crate::interrupt::Interrupt;
use crate::memory;
use crate::stopwatch::Stopwatch;

/// The brightest white of the display if no protocol says it: within the 70–250 cd/m² of ITU-R BT.500.
const PEAK_LUMINANCE_CD_M2: f64 = 100.0;

/// Whose eye it is, and where.
struct Observer {
    acuity: Acuity,
    viewing: Viewing,
    peak_luminance_cd_m2: f64,
}

pub(crate) fn image(arguments: &ImageArguments, progress: Progress) -> anyhow::Result<()> {
    let request = request(arguments);
    let Some(eye) = &arguments.acuity else {
        let made = make(arguments, &request, &arguments.out, progress)?;
        console::print(made.outcome)?;
        return Ok(());
    };
    let observer = observer(eye)?;
    let limits = AcuityLimits::new(observer.acuity, observer.viewing, request.size_px);
    let limited = limited(&request, &limits);
    console::print(limits)?;
    let made = make(arguments, &limited, &arguments.out, progress)?;
    console::print(&made.outcome)?;
    if let Some(whole) = &arguments.compare {
        let unlimited = ImageRequest {
            samples_maps: Vec::new(),
            exports: Vec::new(),
            ..request
        };
        let whole = make(arguments, &unlimited, whole, progress)?;
        console::print(&whole.outcome)?;
        let jod = visible_difference_jod(
            &on_screen(&made.outcome),
            &on_screen(&whole.outcome),
            observer.viewing,
            observer.peak_luminance_cd_m2,
        )?;
        console::print(AcuityComparison {
            limited: made.map(|summary| summary.account),
            whole: whole.map(|summary| summary.account),
            jod,
            pixels_per_degree: observer.viewing.pixels_per_degree(),
        })?;
    }
    Ok(())
}

fn request(arguments: &ImageArguments) -> ImageRequest {
    ImageRequest {
        rays_a: arguments.rays_a,
        rays_c1c2: arguments.rays_c1c2.unwrap_or(arguments.rays_a),
        stop_depths: PerChannel {
            a: arguments.depth_a,
            c1: arguments.depth_c1,
            c2: arguments.depth_c2,
        },
        size_px: arguments.size,
        seed: arguments.seed,
        quadrature: arguments.quadrature,
        tree: TreePlan {
            min_depth: arguments.min_depth,
            driver: arguments.driver,
        },
        threads: arguments.threads,
        until: arguments.until_within.map(|steps| Confidence {
            steps,
            channel: arguments.confidence_channel,
        }),
        samples_maps: arguments.samples_map.clone(),
        exports: arguments.export.clone(),
    }
}

/// Makes an image; Ctrl-C leaves a checkpoint.
fn make(
    arguments: &ImageArguments,
    request: &ImageRequest,
    out: &Path,
    progress: Progress,
) -> anyhow::Result<Timed<ImageSummary>> {
    request.check(&arguments.scene)?;
    memory::check(&arguments.scene, request)?;
    let interrupt = Interrupt::listen()?;
    let stopwatch = Stopwatch::start();
    let outcome = progress.of_rendering(|told| {
        let watch = Watch::new(told, interrupt.flag());
        renderer::render_image(&arguments.scene, request, out, &watch)
    })?;
    console::print_warnings(&outcome.warnings);
    Ok(Timed {
        outcome,
        cpu_s: stopwatch.cpu_s(),
    })
}

/// The cutoffs, the viewing geometry and the display that limit an image.
fn observer(eye: &Eye) -> anyhow::Result<Observer> {
    let Eye::OfProtocol(path) = eye else {
        return Ok(Observer {
            acuity: Acuity::MULLEN_1985,
            viewing: Viewing::MEYER_LIU_1992,
            peak_luminance_cd_m2: PEAK_LUMINANCE_CD_M2,
        });
    };
    let protocol = Study::read(path)?.protocol;
    let acuity = protocol.acuity.ok_or_else(|| {
        InputError::new(path, "no table [acuity]", "the cutoffs of the eye")
            .remedy("add [acuity] (luminance_cutoff_cpd, chromatic_cutoff_cpd), or say --acuity without a file")
    })?;
    Ok(Observer {
        acuity,
        viewing: protocol.viewing,
        peak_luminance_cd_m2: protocol.simulation.peak_luminance_cd_m2,
    })
}

/// The same image, no channel deeper than can be seen.
fn limited(request: &ImageRequest, limits: &AcuityLimits) -> ImageRequest {
    let (asked, seen) = (request.stop_depths, limits.stop_depths());
    let least = |channel| match (asked[channel], seen[channel]) {
        (Some(asked), Some(seen)) => Some(asked.min(seen)),
        (asked, seen) => asked.or(seen),
    };
    ImageRequest {
        stop_depths: PerChannel::from_fn(least),
        ..request.clone()
    }
}

fn on_screen(summary: &ImageSummary) -> ScreenImage {
    ScreenImage {
        size_px: summary.picture.size_px,
        rgb: summary.picture.bytes.clone(),
    }
}

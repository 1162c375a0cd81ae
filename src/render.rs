//! `acuity render`, `image` and `figures`: from a protocol or a scene to pictures.

use protocols::{Study, TreePlan};
use renderer::ImageRequest;

use crate::command_line::{FiguresArguments, ImageArguments, RenderArguments};
use crate::console::{self, Progress};

pub(crate) fn set(arguments: &RenderArguments, progress: Progress) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| study.default_stimuli_dir());
    let summary = progress.of("render", |told| {
        renderer::render_set(&study, &out, arguments.threads, told)
    })?;
    console::print(summary)?;
    Ok(())
}

pub(crate) fn image(arguments: &ImageArguments) -> anyhow::Result<()> {
    let request = ImageRequest {
        rays_a: arguments.rays_a,
        rays_c1c2: arguments.rays_c1c2,
        stop_depths: protocols::PerChannel {
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
    };
    let summary = renderer::render_image(&arguments.scene, &request, &arguments.out)?;
    console::print(summary)?;
    Ok(())
}

pub(crate) fn figures(arguments: &FiguresArguments) -> anyhow::Result<()> {
    let study = Study::read(&arguments.protocol)?;
    let stimuli = arguments.stimuli.of(&study);
    for path in renderer::draw_figures(&study, &stimuli, &arguments.out)? {
        console::print(path.display())?;
    }
    Ok(())
}

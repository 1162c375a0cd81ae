//! A study like the paper's but small, made from its protocol file.

use std::path::{Path, PathBuf};

use protocols::{Protocol, RayCount, Sha256Digest, Study};
use renderer::{ImageRequest, SetSummary, Watch, render_image_of, render_set_of};

use crate::analytic::disc_and_checks;

/// The paper's protocol with 40×30 pixels and 1 K to 4 K rays.
pub(crate) fn small_study() -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let mut protocol = Protocol::from_toml(&path, &text).unwrap();
    let plan = protocol.stimuli.rendered_mut().unwrap();
    plan.size_px = [40, 30];
    let counts = [1000, 2000, 3210, 4000].map(|rays| RayCount::new(rays).unwrap());
    plan.anchors.zero_rays = counts[0];
    plan.anchors.ten_rays = counts[3];
    for sequence in &mut plan.sequences {
        sequence.rays = counts.to_vec();
        sequence.held_rays = counts[3];
    }
    Study {
        sha256: Sha256Digest::of(text.as_bytes()),
        protocol,
        path,
    }
}

/// Stands for the digest of a scene file.
pub(crate) fn no_scene() -> Sha256Digest {
    Sha256Digest::of(b"disc and checks")
}

pub(crate) fn render(study: &Study, out: &Path, threads: usize) -> SetSummary {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    let render = || {
        render_set_of(
            &disc_and_checks(),
            &no_scene(),
            study,
            out,
            &Watch::UNWATCHED,
        )
    };
    pool.install(render).unwrap()
}

/// The request for one image of a study.
pub(crate) fn request(study: &Study, rays_a: u32, rays_c1c2: u32) -> ImageRequest {
    let [rays_a, rays_c1c2] = [rays_a, rays_c1c2].map(|rays| RayCount::new(rays).unwrap());
    ImageRequest::of_study(study.rendering().unwrap(), rays_a, rays_c1c2)
}

/// The bytes of one image, traced alone.
pub(crate) fn image_alone(request: &ImageRequest, name: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path: PathBuf = folder.path().join(name);
    render_image_of(
        &disc_and_checks(),
        no_scene(),
        request,
        &path,
        &Watch::UNWATCHED,
    )
    .unwrap();
    std::fs::read(path).unwrap()
}

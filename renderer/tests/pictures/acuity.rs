//! A set with `[acuity]`: no channel is refined beyond what can be seen, and the images say so.

use protocols::{Acuity, Channel, Manifest, PerChannel, Viewing};
use renderer::{AcuityLimits, Reach, TracePlan, trace};

use crate::analytic::{disc_and_checks, plan};
use crate::small_study::{image_alone, render, request, small_study};

/// 40×30 pixels of 0.019°. A: sides of at most a pixel take 6 and 5 halvings, 2¹¹ cells. C1 and C2: at most
/// 52.63/22 = 2.39 pixels, 5 and 4 halvings, 2⁹ cells.
#[test]
fn a_set_with_acuity_stops_each_channel_at_its_depth_and_the_trace_where_a_is_full() {
    let mut study = small_study();
    study.protocol.acuity = Some(Acuity::MULLEN_1985);
    let folder = tempfile::tempdir().unwrap();
    let summary = render(&study, folder.path(), 2);
    assert_eq!(summary.account.intersections, 2048);
    assert_eq!(
        summary.account.shadings,
        PerChannel {
            a: 2048,
            c1: 512,
            c2: 512
        }
    );
    let mut images = summary.stimuli.iter();
    let full = images.find(|image| image.id.as_str() == "a004k_c004k");
    assert_eq!(full.unwrap().rectangles.c2, 512);
    let printed = summary.to_string();
    assert!(
        printed.contains("capped by the display at 1.2K"),
        "{printed}"
    );
    let manifest = Manifest::read(folder.path()).unwrap();
    assert_eq!(manifest.acuity, Some(Acuity::MULLEN_1985));
    for stimulus in &manifest.stimuli {
        let alone = request(&study, stimulus.rays_a.get(), stimulus.rays_c1c2.get());
        let of_set = std::fs::read(folder.path().join(&stimulus.exr.name)).unwrap();
        assert!(image_alone(&alone, "x.exr") == of_set, "{}", stimulus.id);
    }
}

#[test]
fn a_set_made_with_other_cutoffs_is_not_the_set_of_the_study() {
    let mut study = small_study();
    study.protocol.acuity = Some(Acuity::MULLEN_1985);
    let folder = tempfile::tempdir().unwrap();
    render(&study, folder.path(), 2);
    let manifest = Manifest::read(folder.path()).unwrap();
    assert!(manifest.check_made_for(&study, folder.path()).is_ok());
    let mut nearer = study.clone();
    nearer.protocol.viewing.degrees_per_pixel *= 1.01;
    let mut unlimited = study;
    unlimited.protocol.acuity = None;
    for other in [nearer, unlimited] {
        let refused = manifest.check_made_for(&other, folder.path());
        assert!(refused.unwrap_err().to_string().contains("acuity"));
    }
}

/// The plain way: the whole tree, read no deeper than the limit.
#[test]
fn chroma_limited_by_acuity_is_the_full_tree_read_down_to_the_limit() {
    for size_px in [[64, 64], [200, 40], [33, 150]] {
        let whole = TracePlan {
            size_px,
            ..plan(6000)
        };
        let limits = AcuityLimits::new(Acuity::MULLEN_1985, Viewing::MEYER_LIU_1992, size_px);
        let reach = Reach {
            rays: 6000,
            depth: limits.chromatic.depth,
        };
        let stops = PerChannel {
            a: Reach::rays(6000),
            c1: reach,
            c2: reach,
        };
        let limited = TracePlan {
            stops,
            ..whole.clone()
        };
        let whole = trace(&disc_and_checks(), &whole, &|_, _| ());
        let limited = trace(&disc_and_checks(), &limited, &|_, _| ());
        assert!(limited.stored_samples(Channel::C1) < 5000);
        for channel in [Channel::C1, Channel::C2] {
            let leaves = limited.leaves(channel, reach).unwrap();
            assert_eq!(leaves, whole.leaves(channel, reach).unwrap());
            for leaf in leaves {
                let cell = leaf.cell.rectangle();
                // Half of a side is still longer than half of the spacing: none was split too often.
                let [width, height] = size_px.map(f64::from);
                let longer_px = (cell.width * width).max(cell.height * height);
                assert!(2.0 * longer_px > limits.chromatic.spacing_px);
            }
        }
    }
}

//! Ending where every region is known: section 3.1's test, against pictures whose means are known.

use protocols::{Channel, RefinementDriver};
use renderer::{Confidence, Reach, Rectangle, ScreenPoint, ScreenTree, TracePlan, trace};

use crate::analytic::{Analytic, plan};

const SIDE_PX: u32 = 16;

fn until(steps: u8, rays: usize) -> TracePlan {
    TracePlan {
        size_px: [SIDE_PX; 2],
        until: Some(Confidence {
            steps,
            channel: Channel::A,
        }),
        ..plan(rays)
    }
}

/// A disc of .8 on a slope from .1 to .3: an edge of every direction, and places without one.
fn value(at: ScreenPoint) -> f64 {
    let is_inside = (at.x - 0.45).hypot(at.y - 0.55) < 0.31;
    if is_inside { 0.8 } else { 0.1 + 0.2 * at.x }
}

fn disc() -> Analytic<impl Fn(ScreenPoint, Channel) -> f64 + Sync> {
    Analytic::new(|at, channel| match channel {
        Channel::A => value(at),
        Channel::C1 => 0.25,
        Channel::C2 => 0.1 * at.y,
    })
}

/// The mean of the picture over a rectangle, by 64 × 64 points: a straight edge then errs by less than
/// 0.7/64² · 64 / 2 of the rectangle, which is small beside the tolerance of 4/255.
fn brute_force_mean(cell: Rectangle) -> f64 {
    let n = 64;
    let sum: f64 = (0..n * n)
        .map(|place| {
            let part = |step: u32| (f64::from(step) + 0.5) / f64::from(n);
            value(ScreenPoint {
                x: cell.left + cell.width * part(place % n),
                y: cell.top + cell.height * part(place / n),
            })
        })
        .sum();
    sum / f64::from(n * n)
}

/// The leaves of A in each cell of this depth, by plain search.
fn tree_mean(tree: &ScreenTree, region: Rectangle) -> f64 {
    let leaves = tree.leaves(Channel::A, Reach::rays(tree.len())).unwrap();
    let part = |leaf: &renderer::Leaf| {
        let cell = leaf.cell.rectangle();
        let overlap = |start: f64, length: f64, from: f64, size: f64| {
            ((start + length).min(from + size) - start.max(from)).max(0.0)
        };
        let across = overlap(cell.left, cell.width, region.left, region.width);
        let down = overlap(cell.top, cell.height, region.top, region.height);
        across * down * f64::from(leaf.value)
    };
    leaves.iter().map(part).sum::<f64>() / region.area()
}

#[test]
fn a_flat_picture_is_known_as_soon_as_the_minimum_depth_is_full() {
    let flat = Analytic::new(|_, _| 0.4);
    let tree = trace(&flat, &until(1, 100_000), &|_, _| ());
    assert_eq!(tree.len(), 64);
}

#[test]
fn a_run_that_ends_by_confidence_knows_the_mean_of_every_pixel() {
    let steps = 4;
    let tree = trace(&disc(), &until(steps, 1_000_000), &|_, _| ());
    assert!(tree.len() < 1_000_000, "the rays ended the run");
    let side = 1.0 / f64::from(SIDE_PX);
    let regions = (0..SIDE_PX * SIDE_PX).map(|place| Rectangle {
        left: f64::from(place % SIDE_PX) * side,
        top: f64::from(place / SIDE_PX) * side,
        width: side,
        height: side,
    });
    let known = regions
        .filter(|&region| {
            let error = tree_mean(&tree, region) - brute_force_mean(region);
            error.abs() <= f64::from(steps) / 255.0
        })
        .count();
    // At 95% confidence 13 of 256 may be beyond the tolerance.
    assert!(known >= 243, "{known} of 256");
}

#[test]
fn a_smaller_tolerance_takes_more_rays_and_none_where_nothing_is_in_doubt() {
    let rays = |steps| trace(&disc(), &until(steps, 1_000_000), &|_, _| ()).len();
    assert!(rays(16) < rays(8) && rays(8) < rays(4));
    let tree = trace(&disc(), &until(8, 1_000_000), &|_, _| ());
    // Far from the disc's edge the slope of .2 changes by .2/16 < 8/255 over a pixel: no leaf is below one.
    let points = tree.points().into_iter();
    let in_corner = points.filter(|at| at.x < 0.25 && at.y < 0.25);
    assert!(in_corner.count() <= 16);
}

/// C1 is flat, so nothing is in doubt, whatever A shows.
#[test]
fn the_channel_that_is_to_be_known_can_be_chosen() {
    let of_channel = |channel, driver| {
        let request = TracePlan {
            driver,
            until: Some(Confidence { steps: 1, channel }),
            ..until(1, 20_000)
        };
        trace(&disc(), &request, &|_, _| ()).len()
    };
    for driver in [RefinementDriver::A, RefinementDriver::All] {
        assert_eq!(of_channel(Channel::C1, driver), 64);
        assert!(of_channel(Channel::A, driver) > 2000);
        let c2 = of_channel(Channel::C2, driver);
        assert!(64 < c2 && c2 < 2000, "{c2}");
    }
}

#[test]
fn a_run_that_its_rays_end_is_the_beginning_of_the_one_that_goes_on() {
    let long = trace(&disc(), &until(4, 1_000_000), &|_, _| ());
    for rays in [63, 65, 700, 2000] {
        let short = trace(&disc(), &until(4, rays), &|_, _| ());
        assert_eq!(short.points(), long.points()[..rays]);
    }
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1);
    let alone = alone.build().unwrap();
    let serial = alone.install(|| trace(&disc(), &until(4, 1_000_000), &|_, _| ()));
    assert_eq!(serial.points(), long.points());
}

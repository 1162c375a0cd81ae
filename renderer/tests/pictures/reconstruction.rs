//! From leaves to pixels, judged by closed forms and by brute force.

use crate::analytic::{Analytic, disc_and_checks, plan};
use protocols::{Channel, PerChannel};
use renderer::{Cell, ChannelImage, Leaf, Reach, Wanted, reconstruct, snapshots, trace};

fn picture(
    sampler: &impl renderer::Sampler,
    rays: usize,
    size_px: [u32; 2],
) -> (Vec<Leaf>, ChannelImage) {
    let tree = trace(sampler, &plan(rays), &|_, _| ());
    let leaves = tree.leaves(Channel::A, Reach::rays(rays)).unwrap();
    let image = reconstruct(&leaves, size_px);
    (leaves, image)
}

fn tent(t: f64) -> f64 {
    (1.0 - t.abs()).max(0.0)
}

/// The plain way: points on a fine grid, each weighted by the filter, each looked up among all leaves.
fn pixel_by_points(leaves: &[Leaf], size_px: [u32; 2], pixel: [u32; 2]) -> f64 {
    let steps = 160;
    let (mut sum, mut weights) = (0.0, 0.0);
    for step in 0..steps * steps {
        let offset = [step % steps, step / steps]
            .map(|i| (f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0);
        let [x, y] =
            [0, 1].map(|i| (f64::from(pixel[i]) + 0.5 + offset[i]) / f64::from(size_px[i]));
        let home = leaves.iter().find(|leaf| {
            let cell = leaf.cell.rectangle();
            (cell.left..cell.left + cell.width).contains(&x)
                && (cell.top..cell.top + cell.height).contains(&y)
        });
        if let Some(leaf) = home {
            let weight = tent(offset[0]) * tent(offset[1]);
            sum += weight * f64::from(leaf.value);
            weights += weight;
        }
    }
    sum / weights
}

/// The grid's error: along each axis an edge is misplaced by up to half a step, 1/160 of a pixel.
#[test]
fn pixels_are_the_filtered_picture_within_and_at_the_borders() {
    let size_px = [11, 7];
    let (leaves, image) = picture(&disc_and_checks(), 300, size_px);
    for (place, &value) in image.values().iter().enumerate() {
        let pixel = [place as u32 % 11, place as u32 / 11];
        let expected = pixel_by_points(&leaves, size_px, pixel);
        assert!(
            (f64::from(value) - expected).abs() < 0.01,
            "pixel {pixel:?}: {value}, not {expected}"
        );
    }
}

/// The screen's left half white: with 5 pixels the edge runs through the middle of pixel 2, so by symmetry
/// it is 1/2. Pixels 1 and 3 have centres one pixel away from the edge, where the tent ends: 1 and 0.
#[test]
fn a_pixel_that_an_edge_halves_is_half() {
    let [left, right] = Cell::ROOT.halves(renderer::Axis::X);
    let leaves = [
        Leaf {
            cell: left,
            value: 1.0,
        },
        Leaf {
            cell: right,
            value: 0.0,
        },
    ];
    let image = reconstruct(&leaves, [5, 1]);
    assert_eq!(image.values(), [1.0, 1.0, 0.5, 0.0, 0.0]);
    // With 4 pixels the edge is half a pixel from the centres of 1 and 2: 1 - (1 - 1/2)²/2 = 7/8.
    let image = reconstruct(&leaves, [4, 1]);
    assert_eq!(image.values(), [1.0, 0.875, 0.125, 0.0]);
}

#[test]
fn a_constant_picture_stays_what_it_is() {
    for value in [0.1, -0.3, 1.0] {
        let (_, image) = picture(&Analytic::new(|_, _| value), 777, [37, 23]);
        // Rounding of sums of a few dozen terms in f64, then to f32.
        assert!(
            image
                .values()
                .iter()
                .all(|&pixel| (f64::from(pixel) - value).abs() < 1e-7)
        );
    }
}

/// Tents one pixel apart sum to 1, so what lies 1.5 pixels from the border keeps its integral.
#[test]
fn the_mean_is_kept() {
    let disc = Analytic::new(|at, _| f64::from((at.x - 0.5).hypot(at.y - 0.5) < 0.3));
    let (leaves, image) = picture(&disc, 3000, [24, 24]);
    let integral: f64 = leaves
        .iter()
        .map(|leaf| leaf.cell.area() * f64::from(leaf.value))
        .sum();
    let mean = image
        .values()
        .iter()
        .map(|&pixel| f64::from(pixel))
        .sum::<f64>()
        / (24.0 * 24.0);
    assert!((mean - integral).abs() < 1e-7, "{mean}, not {integral}");
}

#[test]
fn no_pixel_leaves_the_range_of_the_samples() {
    let (leaves, image) = picture(&disc_and_checks(), 1000, [50, 50]);
    let lowest = leaves
        .iter()
        .map(|leaf| leaf.value)
        .fold(f32::INFINITY, f32::min);
    let highest = leaves
        .iter()
        .map(|leaf| leaf.value)
        .fold(f32::NEG_INFINITY, f32::max);
    let rounding = 1e-6;
    assert!(
        image
            .values()
            .iter()
            .all(|&v| v >= lowest - rounding && v <= highest + rounding)
    );
}

/// A smooth ramp is known everywhere: more rays come nearer to it.
#[test]
fn more_rays_make_a_better_picture() {
    let size_px = [32, 32];
    let ramp = || Analytic::new(|at, _| (3.0 * at.x).sin() * at.y);
    let truth = picture(&ramp(), 200_000, size_px).1;
    let errors = [100, 1000, 10_000].map(|rays| {
        picture(&ramp(), rays, size_px)
            .1
            .rms_difference(&truth)
            .unwrap()
    });
    assert!(
        errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1],
        "{errors:?}"
    );
}

fn wanted(rays: &[usize], depth: u32) -> PerChannel<Wanted> {
    PerChannel::from_fn(|_| Wanted {
        rays: rays.iter().copied().collect(),
        depth,
    })
}

/// Within the last place of single precision.
fn is_same_but_for_rounding(image: &ChannelImage, plain: &ChannelImage) -> bool {
    image.values().iter().zip(plain.values()).all(|pair| {
        let [one, other] = [pair.0, pair.1].map(|&value| f64::from(value));
        (one - other).abs() <= f64::from(f32::EPSILON) * other.abs() + 1e-13
    })
}

/// The plain way sums over all leaves of one channel at one count. Both sums are in double precision, a few
/// hundred terms of at most 1, and so differ by less than 1e-13; then each is rounded to single precision.
#[test]
fn images_made_in_one_walk_are_the_sums_over_the_leaves() {
    let tree = trace(&disc_and_checks(), &plan(5000), &|_, _| ());
    let counts = [1, 2, 3, 64, 500, 777, 3000, 4999, 5000, 6000];
    for size_px in [[64, 64], [97, 41], [5, 130], [1, 1]] {
        for depth in [Cell::DEEPEST, 9, 0] {
            let images = snapshots(&tree, &wanted(&counts, depth), size_px).unwrap();
            for channel in Channel::ALL {
                assert!(images[channel].keys().eq(&counts));
                for (&rays, image) in &images[channel] {
                    let leaves = tree.leaves(channel, Reach { rays, depth }).unwrap();
                    let plain = reconstruct(&leaves, size_px);
                    let place = (channel, rays, depth, size_px);
                    assert!(is_same_but_for_rounding(image, &plain), "{place:?}");
                }
            }
        }
    }
}

/// An image does not depend on what else is wanted, bit for bit.
#[test]
fn an_image_made_alone_is_the_one_made_on_the_way_to_others() {
    let size_px = [70, 90];
    let tree = trace(&disc_and_checks(), &plan(5000), &|_, _| ());
    let counts = [10, 700, 1500, 1501, 5000];
    let many = snapshots(&tree, &wanted(&counts, Cell::DEEPEST), size_px).unwrap();
    for channel in Channel::ALL {
        for rays in counts {
            let mut only = PerChannel::<Wanted>::default();
            only[channel] = wanted(&[rays], Cell::DEEPEST)[channel].clone();
            let alone = snapshots(&tree, &only, size_px).unwrap();
            assert_eq!(alone[channel][&rays], many[channel][&rays]);
        }
    }
}

#[test]
fn an_image_beyond_the_stop_of_its_channel_is_none() {
    let mut plan = plan(3000);
    plan.stops.c2 = Reach::rays(1000);
    let tree = trace(&disc_and_checks(), &plan, &|_, _| ());
    let c2_at = |rays: usize| {
        let mut wanted = wanted(&[3000], Cell::DEEPEST);
        wanted.c1.rays = [rays].into();
        wanted.c2.rays = [rays].into();
        snapshots(&tree, &wanted, [30, 30])
    };
    assert!(c2_at(1000).is_some());
    assert!(c2_at(1001).is_none());
}

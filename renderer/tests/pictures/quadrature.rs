//! The filter integrals of the reconstruction against quadrature over every leaf, with no short cut.

use protocols::Channel;
use renderer::{Leaf, Reach, reconstruct, trace};

use crate::analytic::{disc_and_checks, plan};

/// The integral of the tent from `from` to `to` pixels from its middle: the midpoint rule on the two straight
/// pieces, where it is exact.
fn tent_between(from: f64, to: f64) -> f64 {
    let pieces = [(-1.0_f64, 0.0_f64), (0.0, 1.0)];
    let parts = pieces.map(|(start, end)| {
        let (start, end) = (start.max(from), end.min(to));
        if end > start {
            (end - start) * (1.0 - (0.5 * (start + end)).abs())
        } else {
            0.0
        }
    });
    parts[0] + parts[1]
}

/// The weighted mean of all leaves for one pixel.
fn pixel(leaves: &[Leaf], [width, height]: [u32; 2], place: u32) -> f64 {
    let middle = [place % width, place / width].map(|place| f64::from(place) + 0.5);
    let (mut sum, mut weights) = (0.0, 0.0);
    for leaf in leaves {
        let cell = leaf.cell.rectangle();
        let along = |start: f64, length: f64, size: u32, middle: f64| {
            let size = f64::from(size);
            tent_between(start * size - middle, (start + length) * size - middle)
        };
        let weight = along(cell.left, cell.width, width, middle[0])
            * along(cell.top, cell.height, height, middle[1]);
        sum += weight * f64::from(leaf.value);
        weights += weight;
    }
    sum / weights
}

#[test]
fn every_pixel_is_the_exact_integral_over_all_leaves() {
    for (rays, size_px) in [
        (900, [31, 17]),
        (5000, [12, 29]),
        (70, [40, 40]),
        (400, [1, 1]),
    ] {
        let tree = trace(&disc_and_checks(), &plan(rays), &|_, _| ());
        for channel in [Channel::A, Channel::C2] {
            let leaves = tree.leaves(channel, Reach::rays(rays)).unwrap();
            let image = reconstruct(&leaves, size_px);
            for (place, &ours) in (0..).zip(image.values()) {
                let expected = pixel(&leaves, size_px, place);
                // Single precision of values up to 1, and sums in another order.
                assert!(
                    (f64::from(ours) - expected).abs() < 1e-7,
                    "{rays} rays, pixel {place}: {ours}, not {expected}"
                );
            }
        }
    }
}

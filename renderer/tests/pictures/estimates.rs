//! The means of the nodes and the variances of those means.

use crate::analytic::{Analytic, disc_and_checks, plan};
use protocols::Channel;
use renderer::{Reach, TracePlan, trace};

/// With equal halves the mean of a node is the mean of its leaves weighted by their areas.
#[test]
fn the_mean_of_the_root_is_the_integral_of_the_leaves() {
    let tree = trace(&disc_and_checks(), &plan(4000), &|_, _| ());
    for channel in Channel::ALL {
        for rays in [1, 2, 333, 4000] {
            let root = tree.estimates(channel, rays).unwrap()[0];
            let leaves = tree.leaves(channel, Reach::rays(rays)).unwrap();
            let integral: f64 = leaves
                .iter()
                .map(|leaf| leaf.cell.area() * f64::from(leaf.value))
                .sum();
            assert!((root.mean - integral).abs() < 1e-12);
        }
    }
}

#[test]
fn two_samples_have_the_textbook_variance_and_one_has_none() {
    let tree = trace(&disc_and_checks(), &plan(2), &|_, _| ());
    assert_eq!(tree.estimates(Channel::A, 1).unwrap()[0].variance, None);
    let values: Vec<f64> = tree
        .leaves(Channel::A, Reach::rays(2))
        .unwrap()
        .iter()
        .map(|leaf| f64::from(leaf.value))
        .collect();
    let mean = f64::midpoint(values[0], values[1]);
    let sample_variance: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let root = tree.estimates(Channel::A, 2).unwrap()[0];
    assert!((root.variance.unwrap() - sample_variance / 2.0).abs() < 1e-15);
}

/// A ramp over equal cells: over many seeds the mean of the root strays from 1/2 with a variance of w²/12 per
/// cell of width w, divided by the number of cells, if each sample is uniform in its cell; and of .49 of that
/// if it is uniform in the middle 0.7 of it. A sample that was taken for a larger cell lies between the two.
/// The estimate also holds the steps between neighbours, so it is larger, but no more than some times.
#[test]
fn the_variance_of_a_ramp_is_of_the_size_that_seeds_show() {
    let seeds = 400;
    let roots: Vec<_> = (0..seeds)
        .map(|seed| {
            let request = TracePlan { seed, ..plan(64) };
            let ramp = Analytic::new(|at, _| at.x);
            trace(&ramp, &request, &|_, _| ())
                .estimates(Channel::A, 64)
                .unwrap()[0]
        })
        .collect();
    let seen: f64 = roots
        .iter()
        .map(|root| (root.mean - 0.5).powi(2))
        .sum::<f64>()
        / 400.0;
    let most = (1.0 / 8.0_f64).powi(2) / 12.0 / 64.0;
    // A variance from 400 seeds has a standard error of √(2/400) = 7%; five of it.
    assert!(
        seen > 0.49 * 0.64 * most && seen < 1.36 * most,
        "{seen}, and {most} at the most"
    );
    let said: f64 = roots.iter().map(|root| root.variance.unwrap()).sum::<f64>() / 400.0;
    assert!(
        said > 0.9 * seen && said < 10.0 * seen,
        "said {said}, seen {seen}"
    );
}

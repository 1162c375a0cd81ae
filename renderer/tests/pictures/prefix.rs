//! One trace gives every picture: the tree of N samples is the beginning of every larger one.

use crate::analytic::{Analytic, disc_and_checks, plan};
use protocols::{Channel, PerChannel, RefinementDriver};
use renderer::{Reach, ScreenTree, trace};

fn picture_of(tree: &ScreenTree, rays: usize) -> PerChannel<Vec<renderer::Leaf>> {
    PerChannel::from_fn(|channel| tree.leaves(channel, Reach::rays(rays)).unwrap())
}

#[test]
fn an_independent_trace_to_any_count_equals_the_snapshot_of_a_longer_one() {
    let long = trace(&disc_and_checks(), &plan(12_000), &|_, _| ());
    for rays in [
        1, 2, 3, 63, 64, 65, 100, 499, 500, 501, 777, 1000, 3333, 10_000, 11_999, 12_000,
    ] {
        let short = trace(&disc_and_checks(), &plan(rays), &|_, _| ());
        assert_eq!(short.len(), rays);
        assert_eq!(short.points(), long.points()[..rays], "{rays} rays");
        assert_eq!(
            picture_of(&short, rays),
            picture_of(&long, rays),
            "{rays} rays"
        );
    }
}

#[test]
fn the_leaves_tile_the_screen_at_every_count() {
    let tree = trace(&disc_and_checks(), &plan(3000), &|_, _| ());
    for rays in (1..3000).step_by(37) {
        let leaves = tree.leaves(Channel::A, Reach::rays(rays)).unwrap();
        assert_eq!(leaves.len(), rays);
        // Areas are powers of 1/2, so that their sum is exact.
        let area: f64 = leaves.iter().map(|leaf| leaf.cell.area()).sum();
        assert_eq!(area, 1.0);
        // With that sum, every sample in exactly one leaf means that none overlap.
        for point in &tree.points()[..rays] {
            let is_home = |leaf: &&renderer::Leaf| {
                let cell = leaf.cell.rectangle();
                (cell.left..cell.left + cell.width).contains(&point.x)
                    && (cell.top..cell.top + cell.height).contains(&point.y)
            };
            assert_eq!(leaves.iter().filter(is_home).count(), 1);
        }
    }
}

#[test]
fn a_leaf_has_the_value_of_the_sample_inside_it() {
    // C2 = x and C1 = y say where the sample was taken.
    let sampler = Analytic::new(|at, channel| match channel {
        Channel::A => (at.x * 7.0).sin() * (at.y * 5.0).cos(),
        Channel::C1 => at.y,
        Channel::C2 => at.x,
    });
    let tree = trace(&sampler, &plan(2500), &|_, _| ());
    let x = tree.leaves(Channel::C2, Reach::rays(2500)).unwrap();
    let y = tree.leaves(Channel::C1, Reach::rays(2500)).unwrap();
    for (x, y) in x.iter().zip(&y) {
        let cell = x.cell.rectangle();
        // The values are rounded to f32: half a unit in the 24th place.
        let slack = 1e-7;
        let is_inside = |value: f32, start: f64, length: f64| {
            (start - slack..=start + length + slack).contains(&f64::from(value))
        };
        assert!(is_inside(x.value, cell.left, cell.width));
        assert!(is_inside(y.value, cell.top, cell.height));
    }
}

#[test]
fn down_to_the_minimum_depth_every_cell_is_split() {
    for min_depth in [1, 5, 10] {
        let cells = 1 << min_depth;
        let request = renderer::TracePlan {
            min_depth,
            ..plan(cells + 700)
        };
        let tree = trace(&disc_and_checks(), &request, &|_, _| ());
        let leaves = tree.leaves(Channel::A, Reach::rays(cells)).unwrap();
        assert!(leaves.iter().all(|leaf| leaf.cell.depth() == min_depth));
    }
}

#[test]
fn the_tree_is_the_same_on_any_number_of_threads() {
    for driver in [RefinementDriver::A, RefinementDriver::All] {
        let request = renderer::TracePlan {
            driver,
            ..plan(5000)
        };
        let on_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let tree = pool.install(|| trace(&disc_and_checks(), &request, &|_, _| ()));
            picture_of(&tree, 5000)
        };
        let alone = on_threads(1);
        for threads in [2, 3, 8] {
            assert_eq!(on_threads(threads), alone, "{threads} threads, {driver:?}");
        }
    }
}

#[test]
fn another_seed_takes_other_samples() {
    let other = renderer::TracePlan {
        seed: 1993,
        ..plan(500)
    };
    let one = trace(&disc_and_checks(), &plan(500), &|_, _| ());
    let two = trace(&disc_and_checks(), &other, &|_, _| ());
    assert!(
        one.points()
            .iter()
            .zip(two.points())
            .all(|(one, two)| *one != two)
    );
}

#[test]
fn more_samples_go_where_the_picture_changes() {
    let edge = Analytic::new(|at, _| f64::from(at.x > 0.37));
    let tree = trace(&edge, &plan(2000), &|_, _| ());
    let near = tree
        .points()
        .iter()
        .filter(|at| (at.x - 0.37).abs() < 0.03)
        .count();
    // 6% of the screen: 120 of 2000 uniform samples.
    assert!(near > 360, "{near} of 2000 samples near the edge");
}

#[test]
fn progress_ends_with_all_samples() {
    let told = std::sync::Mutex::new(Vec::new());
    let _tree = trace(&disc_and_checks(), &plan(1234), &|done, all| {
        told.lock().unwrap().push((done, all));
    });
    let told = told.into_inner().unwrap();
    assert!(told.is_sorted());
    assert_eq!(told.last(), Some(&(1234, 1234)));
}

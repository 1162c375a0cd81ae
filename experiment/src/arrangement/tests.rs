//! Orders judged by listing every one of them.

use std::collections::BTreeMap;

use super::*;

fn limits(levels: &[&str], most: usize, gap: usize) -> Limits {
    Limits {
        runs: vec![RunOfLevels {
            factor: "channel".to_owned(),
            levels: levels.iter().map(|&level| level.to_owned()).collect(),
            most,
        }],
        gaps: vec![gap; levels.len()],
    }
}

fn permutations(rest: &[usize]) -> Vec<Vec<usize>> {
    if rest.is_empty() {
        return vec![Vec::new()];
    }
    let mut all = Vec::new();
    for (place, &first) in rest.iter().enumerate() {
        let mut others = rest.to_vec();
        others.remove(place);
        for mut tail in permutations(&others) {
            tail.insert(0, first);
            all.push(tail);
        }
    }
    all
}

/// The longest run of one level, counted plainly.
fn longest_run(order: &[usize], levels: &[&str]) -> usize {
    let (mut longest, mut run) = (0, 0);
    for (place, &image) in order.iter().enumerate() {
        let goes_on = place > 0 && levels[order[place - 1]] == levels[image];
        run = if goes_on { run + 1 } else { 1 };
        longest = longest.max(run);
    }
    longest
}

/// Every allowed order of six images comes as often, whichever way draws it: chi-square against the
/// list of all 720.
fn check_uniform(
    most: usize,
    draws: u32,
    purpose: &str,
    draw: impl Fn(&mut Arrangement<'_>, &mut Random),
) {
    let levels = ["a", "a", "a", "b", "b", "c"];
    let limits = limits(&levels, most, 0);
    let allowed: Vec<_> = permutations(&[0, 1, 2, 3, 4, 5])
        .into_iter()
        .filter(|order| longest_run(order, &levels) <= most)
        .collect();
    let mut counts: BTreeMap<Vec<usize>, f64> =
        allowed.into_iter().map(|order| (order, 0.0)).collect();
    let mut random = Random::keyed_by(purpose);
    for _ in 0..draws {
        let mut arrangement = Arrangement {
            images: (0..6).collect(),
            segments: std::iter::once(0..6).collect(),
            limits: &limits,
        };
        draw(&mut arrangement, &mut random);
        *counts.get_mut(&arrangement.images).unwrap() += 1.0;
    }
    let expected = f64::from(draws) / counts.len() as f64;
    let chi_square: f64 = counts
        .values()
        .map(|count| (count - expected).powi(2) / expected)
        .sum();
    // Mean and SD of chi-square with k degrees of freedom are k and sqrt(2k); five SDs.
    let k = counts.len() as f64 - 1.0;
    assert!(
        (chi_square - k).abs() < 5.0 * (2.0 * k).sqrt(),
        "{chi_square} with {k} df"
    );
}

#[test]
fn every_allowed_order_is_as_likely_over_100_000_orders() {
    check_uniform(2, 100_000, "shuffles", |arrangement, random| {
        arrangement.draw(random).unwrap();
    });
}

#[test]
fn the_walk_makes_every_allowed_order_as_likely() {
    check_uniform(1, 20_000, "walk", |arrangement, random| {
        arrangement.shuffle(random);
        arrangement.walk(random).unwrap();
    });
}

#[test]
fn levels_that_must_alternate_throughout_are_found_by_the_walk() {
    let levels = [["a"; 14], ["b"; 14]].concat();
    let limits = limits(&levels, 1, 0);
    let mut arrangement = Arrangement {
        images: (0..28).collect(),
        segments: std::iter::once(0..28).collect(),
        limits: &limits,
    };
    arrangement
        .draw(&mut Random::keyed_by("alternate"))
        .unwrap();
    assert_eq!(longest_run(&arrangement.images, &levels), 1);
    let mut images = arrangement.images;
    images.sort_unstable();
    assert!(images.into_iter().eq(0..28));
}

#[test]
fn the_faults_that_a_swap_changes_are_those_at_its_two_places() {
    let levels = ["a", "a", "b", "b", "c", "a"];
    let limits = limits(&levels, 2, 2);
    let mut random = Random::keyed_by("faults");
    for _ in 0..500 {
        let mut arrangement = Arrangement {
            images: (0..12).map(|_| random.index(6)).collect(),
            segments: std::iter::once(0..12).collect(),
            limits: &limits,
        };
        let (i, j) = (random.index(12), random.index(12));
        if i == j {
            continue;
        }
        let (whole, near) = (arrangement.faults(), arrangement.faults_at(i, j));
        arrangement.images.swap(i, j);
        let (whole_after, near_after) = (arrangement.faults(), arrangement.faults_at(i, j));
        assert_eq!(whole + near_after, whole_after + near);
    }
}

#[test]
fn limits_that_no_order_can_keep_are_refused_with_the_count() {
    let levels = ["a", "a", "a", "a", "a", "b"];
    let limits = limits(&levels, 2, 0);
    let mut arrangement = Arrangement {
        images: (0..6).collect(),
        segments: std::iter::once(0..6).collect(),
        limits: &limits,
    };
    let reason = arrangement.draw(&mut Random::keyed_by("none")).unwrap_err();
    assert!(
        reason.contains("5 trials with channel a and 1 others") && reason.contains("room for 4"),
        "{reason}"
    );
    let limits = spaced();
    let mut arrangement = Arrangement {
        images: vec![0, 0, 1],
        segments: std::iter::once(0..3).collect(),
        limits: &limits,
    };
    let reason = arrangement.draw(&mut Random::keyed_by("none")).unwrap_err();
    assert!(reason.contains("needs a block of 4 trials"), "{reason}");
}

fn spaced() -> Limits {
    limits(&["a", "b"], 9, 2)
}

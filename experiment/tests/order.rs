//! The order of the trials.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use experiment::{First, trials};
use protocols::rating::Phase;
use protocols::{Layout, LevelBlocks, OrderScheme, ResponseStyle, RunLimit, Study};

fn paper() -> Study {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
    Study::read(&path).unwrap()
}

fn test_images(study: &Study, subject: &str, session: u32) -> Vec<String> {
    let trials = trials(study, &subject.parse().unwrap(), session).unwrap();
    let test = trials.iter().filter(|trial| trial.phase == Phase::Test);
    test.map(|trial| trial.stimulus_id.to_string()).collect()
}

/// `openssl enc -chacha20 -K $(printf 'acuity trial order 1, seed 1992, subject 01, session 1' | sha256sum)
/// -iv 0` on zeros gave the words, little-endian; a shuffle in Python from the last place to the second gave
/// this order.
#[test]
fn the_order_of_subject_01_is_the_one_that_openssl_and_python_give() {
    let expected = [
        "a140k_c140k",
        "a140k_c120k",
        "a060k_c140k",
        "a140k_c110k",
        "a010k_c140k",
        "a140k_c010k",
        "a140k_c100k",
        "a070k_c140k",
        "a140k_c070k",
        "a130k_c140k",
        "a040k_c140k",
        "a020k_c140k",
        "a140k_c060k",
        "a080k_c140k",
        "a140k_c040k",
        "a140k_c020k",
        "a050k_c140k",
        "a140k_c130k",
        "a100k_c140k",
        "a140k_c080k",
        "a110k_c140k",
        "a140k_c030k",
        "a120k_c140k",
        "a140k_c090k",
        "a140k_c050k",
        "a030k_c140k",
        "a090k_c140k",
    ];
    assert_eq!(test_images(&paper(), "01", 1), expected);
}

#[test]
fn practice_comes_first_and_every_block_has_each_image_once() {
    let mut study = paper();
    study.protocol.session.blocks = 3;
    let protocol = &study.protocol;
    let trials = trials(&study, &"07".parse().unwrap(), 1).unwrap();
    assert_eq!(trials.len(), 3 + 3 * 27);
    assert!(
        (1..)
            .zip(&trials)
            .all(|(number, trial)| trial.trial_id == number)
    );
    let (practice, test) = trials.split_at(3);
    let shown = practice.iter().map(|trial| &trial.stimulus_id);
    assert!(shown.eq(&protocol.session.practice));
    assert!(practice.iter().all(|trial| trial.phase == Phase::Practice));
    for (repetition, block) in (1..).zip(test.chunks(27)) {
        let images: BTreeSet<_> = block.iter().map(|trial| &trial.stimulus_id).collect();
        assert_eq!(images.len(), 27);
        assert!(!images.contains(&protocol.stimuli.zero_anchor().unwrap()));
        assert!(block.iter().all(|trial| trial.repetition == repetition));
    }
    let orders: BTreeSet<Vec<_>> = test
        .chunks(27)
        .map(|block| {
            block
                .iter()
                .map(|trial| trial.stimulus_id.clone())
                .collect()
        })
        .collect();
    assert_eq!(orders.len(), 3, "each block in an order of its own");
}

#[test]
fn each_subject_and_session_has_an_order_of_its_own() {
    let protocol = paper();
    let subjects = ["01", "02", "03", "10", "1"];
    let mut orders: BTreeSet<_> = subjects
        .iter()
        .map(|id| test_images(&protocol, id, 1))
        .collect();
    orders.insert(test_images(&protocol, "01", 2));
    assert_eq!(orders.len(), 6);
}

#[test]
fn a_trial_carries_the_levels_of_its_image() {
    let trials = trials(&paper(), &"01".parse().unwrap(), 1).unwrap();
    let levels = |id: &str| {
        let trial = trials.iter().find(|trial| trial.stimulus_id.as_str() == id);
        trial.unwrap().levels.join(" ")
    };
    assert_eq!(levels("a030k_c140k"), "achromatic 30K");
    assert_eq!(levels("a140k_c050k"), "chromatic 50K");
    assert_eq!(levels("a140k_c140k"), "both 140K");
}

/// How often images come twice running between blocks, by a plain look at neighbours.
#[test]
fn no_image_comes_twice_running_and_no_level_more_often_than_the_protocol_says() {
    let mut study = paper();
    study.protocol.session.blocks = 4;
    study.protocol.session.order.most_in_a_row = vec![RunLimit {
        factor: "channel".to_owned(),
        most: 2,
    }];
    for subject in 1..=40 {
        let id = format!("S{subject}").parse().unwrap();
        let trials = trials(&study, &id, 1).unwrap();
        let test: Vec<_> = trials
            .iter()
            .filter(|trial| trial.phase == Phase::Test)
            .collect();
        assert_eq!(test.len(), 4 * 27);
        assert!(
            test.windows(2)
                .all(|pair| pair[0].stimulus_id != pair[1].stimulus_id)
        );
        assert!(test.windows(3).all(|three| {
            three[0].levels[0] != three[1].levels[0] || three[1].levels[0] != three[2].levels[0]
        }));
    }
}

/// Where each image of the limited order falls, over 100,000 subjects: images of one level are alike to the
/// limit, so each of the 13 must fall on each place equally often.
#[test]
fn over_100_000_orders_no_image_of_a_level_prefers_a_place() {
    let mut study = paper();
    study.protocol.session.order.most_in_a_row = vec![RunLimit {
        factor: "channel".to_owned(),
        most: 3,
    }];
    let mut counts: BTreeMap<(String, usize), f64> = BTreeMap::new();
    let mut of_level = [0.0; 27];
    for subject in 0..100_000 {
        let id = format!("S{subject}").parse().unwrap();
        let trials = trials(&study, &id, 1).unwrap();
        for (place, trial) in trials[3..].iter().enumerate() {
            if trial.levels[0] == "achromatic" {
                let image = trial.stimulus_id.to_string();
                *counts.entry((image, place)).or_insert(0.0) += 1.0;
                of_level[place] += 1.0;
            }
        }
    }
    assert_eq!(counts.len(), 13 * 27);
    let chi_square: f64 = counts
        .iter()
        .map(|((_, place), count)| {
            let expected: f64 = of_level[*place] / 13.0;
            (count - expected).powi(2) / expected
        })
        .sum();
    // 12 x 26 = 312 degrees of freedom, mean 312, SD 25; five SDs.
    assert!((chi_square - 312.0).abs() < 125.0, "{chi_square}");
}

/// By lot means by a fair one: over 100,008 pairs, whichever image is rated, and whichever came first before.
#[test]
fn over_100_000_pairs_test_and_reference_come_first_equally_often() {
    let mut study = paper();
    let plan = &mut study.protocol.session;
    plan.layout = Layout::Dscqs;
    plan.response = ResponseStyle::Continuous;
    let mut of_image: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    let mut after = [[0.0; 2]; 2];
    for subject in 0..3704 {
        let id = format!("S{subject}").parse().unwrap();
        let trials = trials(&study, &id, 1).unwrap();
        let firsts: Vec<usize> = trials[3..]
            .iter()
            .map(|trial| usize::from(trial.first == First::Reference))
            .collect();
        for (trial, &first) in trials[3..].iter().zip(&firsts) {
            let image = trial.stimulus_id.to_string();
            of_image.entry(image).or_insert([0.0; 2])[first] += 1.0;
        }
        for pair in firsts.windows(2) {
            after[pair[0]][pair[1]] += 1.0;
        }
    }
    assert_eq!(of_image.len(), 27);
    let against_half = |[one, other]: &[f64; 2]| (one - other).powi(2) / (one + other);
    let chi_square: f64 = of_image.values().map(against_half).sum();
    // 27 degrees of freedom, mean 27, SD 7.3; five SDs.
    assert!((chi_square - 27.0).abs() < 37.0, "{chi_square}");
    let chi_square: f64 = after.iter().map(against_half).sum();
    // Two degrees of freedom: beyond 20.7 with a chance of e^(-20.7 / 2) = 3e-5.
    assert!(chi_square < 20.7, "{chi_square}");
}

#[test]
fn a_latin_square_is_complete_after_as_many_subjects_as_it_has_rows() {
    let mut study = paper();
    study.protocol.session.order.scheme = OrderScheme::LatinSquare;
    let mut counts: BTreeMap<(String, usize), u32> = BTreeMap::new();
    for subject in 1..=54 {
        let images = test_images(&study, &format!("S{subject:02}"), 1);
        for (place, image) in images.into_iter().enumerate() {
            *counts.entry((image, place)).or_insert(0) += 1;
        }
    }
    assert_eq!(counts.len(), 27 * 27);
    assert!(counts.values().all(|&count| count == 2));
    let error = trials(&study, &"anna".parse().unwrap(), 1).unwrap_err();
    assert!(error.to_string().contains("ends in a number"), "{error}");
}

#[test]
fn blocks_of_one_level_come_in_every_order_equally_often() {
    let mut study = paper();
    study.protocol.session.order.blocked_by = Some(LevelBlocks {
        factor: "channel".to_owned(),
        levels: vec!["achromatic".to_owned(), "chromatic".to_owned()],
    });
    let mut first = BTreeMap::new();
    for subject in 1..=12 {
        let id = format!("{subject:02}").parse().unwrap();
        let trials = trials(&study, &id, 1).unwrap();
        let mut levels: Vec<_> = trials[3..]
            .iter()
            .map(|trial| trial.levels[0].clone())
            .collect();
        levels.retain(|level| level != "both");
        assert!(levels[..13].iter().all(|level| *level == levels[0]));
        assert!(levels[13..].iter().all(|level| *level == levels[25]));
        *first.entry(levels[0].clone()).or_insert(0) += 1;
    }
    assert!(first.len() == 2 && first.values().all(|&count| count == 6));
}

#[test]
fn repeated_anchors_are_rated_and_stand_apart() {
    let mut study = paper();
    study.protocol.session.order.anchor_repeats = 2;
    for subject in ["01", "02", "03", "04"] {
        let images = test_images(&study, subject, 1);
        assert_eq!(images.len(), 27 + 4);
        for (anchor, count, distance) in [("a010k_c010k", 2, 8), ("a140k_c140k", 3, 6)] {
            let places: Vec<_> = (0..31).filter(|&place| images[place] == anchor).collect();
            assert_eq!(places.len(), count);
            assert!(places.windows(2).all(|pair| pair[1] - pair[0] >= distance));
        }
    }
}

#[test]
fn limits_that_no_order_can_keep_are_refused_with_the_reason() {
    let mut study = paper();
    let limit = |factor: &str| RunLimit {
        factor: factor.to_owned(),
        most: 1,
    };
    study.protocol.session.order.most_in_a_row = vec![limit("channel")];
    study.protocol.session.order.blocked_by = Some(LevelBlocks {
        factor: "channel".to_owned(),
        levels: vec!["achromatic".to_owned(), "chromatic".to_owned()],
    });
    let error = trials(&study, &"01".parse().unwrap(), 1).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("session.order") && text.contains("13 trials with channel"),
        "{text}"
    );
    study.protocol.session.order.most_in_a_row = vec![limit("colour")];
    let error = trials(&study, &"01".parse().unwrap(), 1).unwrap_err();
    assert!(error.to_string().contains("channel, rays"), "{error}");
}

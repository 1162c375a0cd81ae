//! The order of the trials.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::collections::BTreeSet;
use std::path::Path;

use experiment::trials;
use protocols::rating::Phase;
use protocols::{Protocol, Study};

fn paper() -> Protocol {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../protocols/meyer-liu-1992.toml");
    Study::read(&path).unwrap().protocol
}

fn test_images(protocol: &Protocol, subject: &str, session: u32) -> Vec<String> {
    let trials = trials(protocol, &subject.parse().unwrap(), session);
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
    let mut protocol = paper();
    protocol.session.blocks = 3;
    let trials = trials(&protocol, &"07".parse().unwrap(), 1);
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
        assert!(!images.contains(&protocol.stimuli.zero_anchor()));
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
    let trials = trials(&paper(), &"01".parse().unwrap(), 1);
    let levels = |id: &str| {
        let trial = trials.iter().find(|trial| trial.stimulus_id.as_str() == id);
        trial.unwrap().levels.join(" ")
    };
    assert_eq!(levels("a030k_c140k"), "achromatic 30K");
    assert_eq!(levels("a140k_c050k"), "chromatic 50K");
    assert_eq!(levels("a140k_c140k"), "both 140K");
}

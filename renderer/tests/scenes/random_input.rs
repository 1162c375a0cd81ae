//! Scene files that nobody wrote: the reader never panics, and what it takes can be rendered.

use proptest::prelude::*;

use super::*;

const STUDY: &str = include_str!("../../../stimuli/scenes/opponent-solids.toml");

fn take(text: &str) -> Result<(), TestCaseError> {
    match Scene::from_toml(Path::new("random.toml"), text) {
        Err(error) => prop_assert!(error.is_input() && error.to_string().contains("random.toml")),
        Ok(scene) => {
            let sampler = sampler(&scene);
            for (x, y) in [(0.5, 0.5), (0.1, 0.8), (0.9, 0.7)] {
                prop_assert!(value(&sampler, x, y, Channel::A).is_finite());
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn garbage_is_refused(text in any::<String>()) {
        take(&text)?;
    }

    #[test]
    fn a_scene_with_one_number_changed_is_refused_or_rendered(
        place in 0_usize..2_000,
        number in prop_oneof![
            Just("0".to_owned()), Just("-1".to_owned()), Just("nan".to_owned()), Just("inf".to_owned()),
            Just("1e300".to_owned()), Just("1e-300".to_owned()), Just("\"\"".to_owned()), Just("[]".to_owned()),
            (-10.0..10.0).prop_map(|number: f64| format!("{number:?}")),
        ],
    ) {
        let digits: Vec<(usize, &str)> = STUDY.match_indices(|c: char| c.is_ascii_digit()).collect();
        let start = digits[place % digits.len()].0;
        let rest = &STUDY[start..];
        let is_number = |c: char| c.is_ascii_digit() || c == '.';
        let length = rest.find(|c| !is_number(c)).unwrap_or(rest.len());
        take(&format!("{}{number}{}", &STUDY[..start], &rest[length..]))?;
    }

    #[test]
    fn a_scene_with_a_piece_cut_out_is_refused_or_rendered(start in 0_usize..10_000, length in 1_usize..300) {
        let start = start % STUDY.len();
        let end = (start + length).min(STUDY.len());
        if let (Some(head), Some(tail)) = (STUDY.get(..start), STUDY.get(end..)) {
            take(&format!("{head}{tail}"))?;
        }
    }
}

//! What must change nothing: the order of rows and of subjects, the names of subjects and of levels, and the unit and
//! the zero of the rating.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use analysis::{CellMatrix, EffectRow, Observations, anova};
use protocols::SumsOfSquares;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// A subject, the levels of the group and of two within factors, and the rating.
type Row = (String, [String; 3], f64);

/// Three groups of four to six subjects who rated 3 × 4 cells.
fn random_rows(random: &mut ChaCha8Rng) -> Vec<Row> {
    let mut rows = Vec::new();
    for group in 0..3 {
        for subject in 0..4 + random.next_u32() % 3 {
            for cell in 0..12 {
                let levels = [group, cell / 4, cell % 4].map(|level| format!("level {level}"));
                let rating = f64::from(random.next_u32() % 1001) / 100.0;
                rows.push((format!("subject {group}{subject}"), levels, rating));
            }
        }
    }
    rows
}

fn effects(rows: &[Row], kind: SumsOfSquares) -> Vec<EffectRow> {
    let names = |names: &[&str]| -> Vec<String> { names.iter().map(ToString::to_string).collect() };
    let mut observations =
        Observations::new("a test".as_ref(), &names(&["g"]), &names(&["v", "w"]));
    for (subject, levels, rating) in rows {
        observations.push(subject, levels.iter().map(String::as_str), Some(*rating));
    }
    anova(&CellMatrix::new(&observations).unwrap(), &[], kind).effects
}

fn shuffle<T>(items: &mut [T], random: &mut ChaCha8Rng) {
    for last in (1..items.len()).rev() {
        items.swap(last, random.next_u32() as usize % (last + 1));
    }
}

/// Other names in another order.
fn renamed(names: &[String], random: &mut ChaCha8Rng) -> impl Fn(&str) -> String + use<> {
    let mut known = names.to_vec();
    known.sort();
    known.dedup();
    let mut new: Vec<String> = (0..known.len()).map(|name| format!("Ω{name}")).collect();
    shuffle(&mut new, random);
    move |name| new[known.iter().position(|known| known == name).unwrap()].clone()
}

fn assert_same(what: &str, found: &[EffectRow], expected: &[EffectRow]) {
    assert_eq!(found.len(), 7);
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.effect, expected.effect, "{what}");
        let numbers = |effect: &EffectRow| {
            [
                effect.f,
                effect.p,
                effect.p_gg,
                effect.gg_epsilon,
                effect.hf_epsilon,
                effect.mauchly_w,
                effect.pes,
            ]
        };
        for (found_number, number) in numbers(found).into_iter().zip(numbers(expected)) {
            let is_same = match (found_number, number) {
                (Some(found), Some(number)) => (found - number).abs() <= 1e-9 * number.abs(),
                (found, number) => found == number,
            };
            assert!(is_same, "{what}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn names_order_unit_and_zero_change_nothing() {
    for (seed, kind) in (0..40).flat_map(|seed| {
        [SumsOfSquares::TypeThree, SumsOfSquares::TypeTwo].map(|kind| (seed, kind))
    }) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let plain = random_rows(&mut random);
        let expected = effects(&plain, kind);
        let mut rows = plain.clone();
        shuffle(&mut rows, &mut random);
        assert_same("rows in another order", &effects(&rows, kind), &expected);
        let subjects: Vec<String> = plain.iter().map(|(subject, ..)| subject.clone()).collect();
        let subject = renamed(&subjects, &mut random);
        for (name, ..) in &mut rows {
            *name = subject(name);
        }
        assert_same("other subjects' names", &effects(&rows, kind), &expected);
        for factor in 0..3 {
            let levels: Vec<String> = plain.iter().map(|row| row.1[factor].clone()).collect();
            let level = renamed(&levels, &mut random);
            for (_, levels, _) in &mut rows {
                levels[factor] = level(&levels[factor]);
            }
            assert_same("other levels' names", &effects(&rows, kind), &expected);
        }
        for (_, _, rating) in &mut rows {
            *rating = 250.0 - 12.5 * *rating;
        }
        assert_same("another unit and zero", &effects(&rows, kind), &expected);
        // And the numbers can change at all.
        rows[0].2 += 1.0;
        assert_ne!(effects(&rows, kind)[0].f, expected[0].f);
    }
}

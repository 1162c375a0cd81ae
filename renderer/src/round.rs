//! The leaves of one round in its order, from the class of each.

use crate::priority::{DUE, NEVER};

/// Leaves that are looked at together.
const TOGETHER: usize = 32;

/// The leaves of the highest classes, `wanted` of them or as many as may be split; the highest class first,
/// and within a class the older leaf.
///
/// `classes` has the class of each leaf, and `counts` how many leaves each class has.
pub(crate) fn round(classes: &[u16], counts: &[usize], wanted: usize) -> Vec<u32> {
    // Where each class begins in the round; the lowest may be cut short.
    let mut begins = vec![0; counts.len()];
    let (mut end, mut lowest) = (0, DUE);
    for highest in (NEVER + 1..=DUE).rev() {
        let place = usize::from(highest);
        if end >= wanted {
            break;
        }
        begins[place] = end;
        end += counts[place];
        lowest = highest;
    }
    let mut round = vec![0; end];
    let mut first = 0;
    for some in classes.chunks(TOGETHER) {
        let mut chosen = chosen(some, lowest);
        while chosen != 0 {
            let place = chosen.trailing_zeros();
            chosen &= chosen - 1;
            let begin = &mut begins[usize::from(some[place as usize])];
            round[*begin] = first + place;
            *begin += 1;
        }
        first += 32;
    }
    round.truncate(wanted);
    round
}

/// One bit for each leaf, at most 32, whose class is at least this.
fn chosen(classes: &[u16], lowest: u16) -> u32 {
    let bit = |class: u16, place: usize| u32::from(class >= lowest) << place;
    match classes.first_chunk::<TOGETHER>() {
        Some(all) => (0..TOGETHER).fold(0, |bits, place| bits | bit(all[place], place)),
        None => (0..)
            .zip(classes)
            .fold(0, |bits, (place, &class)| bits | bit(class, place)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By sorting all leaves.
    #[test]
    fn a_round_is_the_beginning_of_all_leaves_in_order() {
        for seed in 0..20_u32 {
            let random =
                |leaf: u32| (leaf + 1000 * seed).wrapping_mul(0x9e37_79b9).to_be_bytes()[1];
            let classes: Vec<u16> = (0..500_u32)
                .map(|leaf| match random(leaf) % 9 {
                    0 => NEVER,
                    1 if seed % 2 == 0 => DUE,
                    class => 900 + u16::from(class),
                })
                .collect();
            let mut counts = vec![0; usize::from(DUE) + 1];
            for &class in &classes {
                counts[usize::from(class)] += 1;
            }
            let mut sorted: Vec<u32> = (0..500).collect();
            sorted.retain(|&leaf| classes[leaf as usize] != NEVER);
            sorted.sort_by_key(|&leaf| std::cmp::Reverse(classes[leaf as usize]));
            for wanted in [1, 31, 200, sorted.len(), 500] {
                let found = round(&classes, &counts, wanted);
                assert_eq!(found, sorted[..wanted.min(sorted.len())]);
            }
        }
    }
}

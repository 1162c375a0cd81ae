//! The leaves that wait to be split, the most urgent first.
//!
//! Leaves above the minimum depth come first, in the order of their making (breadth first). All others stand
//! in classes of priority, eight to an octave: a leaf of a higher class comes first, the older one within a
//! class. So two leaves whose priorities differ by less than an eighth may change places, which no picture
//! shows, and in return a leaf is put in and taken out in constant time and in the order of memory: a heap
//! of 24 million leaves waits for memory ten times as long as for a ray.
//!
//! The order follows from the leaves alone, in the order in which they are put in.

use std::collections::VecDeque;

use crate::priority::ExpectedVariance;
use crate::screen_tree::PlacedNode;

/// A leaf that waits to be split.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    pub(crate) node: PlacedNode,
    pub(crate) expected: ExpectedVariance,
}

/// Leaves are held in pieces of this many, so that memory is given back as they are taken out.
const PIECE: usize = 256;

/// Sign, exponent and three bits of the fraction are what is left of a 32-bit float.
const DROPPED_BITS: u32 = 23 - 3;

/// The class of an infinite priority.
const DUE: usize = (f32::INFINITY.to_bits() >> DROPPED_BITS) as usize;

/// The leaves that wait to be split.
#[derive(Debug)]
pub(crate) struct Waiting {
    classes: Vec<Class>,
    /// No class above this one holds a leaf.
    highest: usize,
    spare: Vec<Vec<Candidate>>,
}

/// Leaves of one class of priority, the oldest first.
#[derive(Debug, Default)]
struct Class {
    /// Only the last may be short of [`PIECE`] leaves; none is empty.
    pieces: VecDeque<Vec<Candidate>>,
    /// How many of the first piece are gone.
    taken: usize,
}

impl Waiting {
    pub(crate) fn new() -> Self {
        Self {
            classes: (0..=DUE).map(|_| Class::default()).collect(),
            highest: 0,
            spare: Vec::new(),
        }
    }

    /// Puts in a leaf; an infinite priority is one that is due whatever was found in it.
    pub(crate) fn push(&mut self, candidate: Candidate, priority: f64) {
        let class = class_of(priority);
        self.highest = self.highest.max(class);
        let pieces = &mut self.classes[class].pieces;
        match pieces.back_mut() {
            Some(piece) if piece.len() < PIECE => piece.push(candidate),
            _ => {
                let piece = self.spare.pop();
                let mut piece = piece.unwrap_or_else(|| Vec::with_capacity(PIECE));
                piece.push(candidate);
                pieces.push_back(piece);
            }
        }
    }

    /// Whether the first leaf is one that is due whatever was found in it.
    pub(crate) fn is_due(&self) -> bool {
        !self.classes[DUE].pieces.is_empty()
    }

    /// Takes the first leaf out.
    pub(crate) fn pop(&mut self) -> Option<Candidate> {
        while self.classes[self.highest].pieces.is_empty() {
            self.highest = self.highest.checked_sub(1)?;
        }
        let class = &mut self.classes[self.highest];
        let piece = class.pieces.front()?;
        let candidate = *piece.get(class.taken)?;
        class.taken += 1;
        if class.taken == piece.len() {
            class.taken = 0;
            if let Some(mut piece) = class.pieces.pop_front() {
                piece.clear();
                self.spare.push(piece);
            }
        }
        Some(candidate)
    }
}

fn class_of(priority: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounded to a 32-bit float on purpose"
    )]
    let rounded = priority as f32;
    (rounded.to_bits() >> DROPPED_BITS) as usize
}

#[cfg(test)]
mod tests {
    use rand::Rng as _;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng as _;

    use super::*;
    use crate::cell::Cell;

    fn leaf(index: u32) -> Candidate {
        Candidate {
            node: PlacedNode {
                index,
                sample: 0,
                cell: Cell::ROOT,
            },
            expected: ExpectedVariance::default(),
        }
    }

    /// The plain way: among all leaves the one of the highest class, the oldest of those.
    #[test]
    fn the_first_out_is_the_oldest_of_the_highest_class() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let (mut waiting, mut plain) = (Waiting::new(), Vec::<(i64, u32)>::new());
        for index in 0..20_000 {
            // From 2⁻⁹⁰ to 2³⁷, and infinity now and then; classes by arithmetic instead of bits.
            let exponent = i64::from(random.next_u32() % 128) - 90;
            let eighths = i64::from(random.next_u32() % 8);
            let within = f64::from(random.next_u32() % 1000) / 1000.0;
            let is_due = index % 1000 == 17;
            let priority = if is_due {
                f64::INFINITY
            } else {
                (exponent as f64).exp2() * (1.0 + (eighths as f64 + 0.99 * within) / 8.0)
            };
            waiting.push(leaf(index), priority);
            plain.push((
                if is_due {
                    i64::MAX
                } else {
                    8 * exponent + eighths
                },
                index,
            ));
            // More go in than come out, until the end.
            if index % 3 == 0 || index > 19_000 {
                assert_eq!(
                    waiting.is_due(),
                    plain.iter().any(|&(class, _)| class == i64::MAX)
                );
                let class = plain.iter().map(|&(class, _)| class).max().unwrap();
                let place = plain.iter().position(|&(c, _)| c == class).unwrap();
                let (_, expected) = plain.remove(place);
                assert_eq!(waiting.pop().unwrap().node.index, expected);
            }
        }
        let left = std::iter::from_fn(|| waiting.pop()).count();
        assert_eq!(left, plain.len());
        assert!(waiting.pop().is_none());
    }

    #[test]
    fn an_empty_queue_can_be_filled_again() {
        let mut waiting = Waiting::new();
        assert!(waiting.pop().is_none() && !waiting.is_due());
        waiting.push(leaf(3), 1e-9);
        assert_eq!(waiting.pop().unwrap().node.index, 3);
        waiting.push(leaf(4), f64::INFINITY);
        assert!(waiting.is_due());
        assert_eq!(waiting.pop().unwrap().node.index, 4);
    }
}

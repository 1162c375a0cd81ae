//! The first numbers of sixteen streams of `ChaCha8` at once.
//!
//! The same bits as those of `rand_chacha`, which makes four blocks of one stream at a time; a cell of the
//! screen needs a quarter of one.
//!
//! Source: Bernstein (2008), "`ChaCha`, a variant of Salsa20", with a counter and a nonce of 64 bits.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use crate::halving::{LANES, Lanes};

/// "expand 32-byte k".
const CONSTANTS: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];

/// Two rounds each.
const DOUBLE_ROUNDS: usize = 4;

/// The first four words of each of sixteen streams. The key is a seed, its other 24 bytes are zero.
///
/// A stream is given by the lower and the upper half of its number.
#[inline(always)]
pub(crate) fn first_words(seed: u64, [low, high]: [Lanes; 2]) -> [Lanes; 4] {
    let mut start = [[0; LANES]; 16];
    for (word, constant) in start.iter_mut().zip(CONSTANTS) {
        *word = [constant; LANES];
    }
    let [seed_low, seed_high] = words(seed);
    (start[4], start[5]) = ([seed_low; LANES], [seed_high; LANES]);
    (start[14], start[15]) = (low, high);
    let mut state = start;
    for _ in 0..DOUBLE_ROUNDS {
        quarter_round(&mut state, [0, 4, 8, 12]);
        quarter_round(&mut state, [1, 5, 9, 13]);
        quarter_round(&mut state, [2, 6, 10, 14]);
        quarter_round(&mut state, [3, 7, 11, 15]);
        quarter_round(&mut state, [0, 5, 10, 15]);
        quarter_round(&mut state, [1, 6, 11, 12]);
        quarter_round(&mut state, [2, 7, 8, 13]);
        quarter_round(&mut state, [3, 4, 9, 14]);
    }
    [0, 1, 2, 3].map(|word| sum(state[word], start[word]))
}

#[inline(always)]
fn quarter_round(state: &mut [Lanes; 16], [a, b, c, d]: [usize; 4]) {
    state[a] = sum(state[a], state[b]);
    state[d] = turned::<16>(state[d], state[a]);
    state[c] = sum(state[c], state[d]);
    state[b] = turned::<12>(state[b], state[c]);
    state[a] = sum(state[a], state[b]);
    state[d] = turned::<8>(state[d], state[a]);
    state[c] = sum(state[c], state[d]);
    state[b] = turned::<7>(state[b], state[c]);
}

#[inline(always)]
fn sum(one: Lanes, other: Lanes) -> Lanes {
    std::array::from_fn(|lane| one[lane].wrapping_add(other[lane]))
}

/// The bits in which two words differ, turned to the left.
#[inline(always)]
fn turned<const BY: u32>(one: Lanes, other: Lanes) -> Lanes {
    std::array::from_fn(|lane| (one[lane] ^ other[lane]).rotate_left(BY))
}

/// The lower half and the upper half.
#[expect(clippy::cast_possible_truncation, reason = "each half on purpose")]
const fn words(number: u64) -> [u32; 2] {
    [number as u32, (number >> 32) as u32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng as _;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng as _;

    #[test]
    fn the_numbers_are_those_of_rand_chacha() {
        for seed in [0, 1, 1992, u64::MAX] {
            for first in 0..200_u64 {
                let streams: [u64; LANES] = std::array::from_fn(|lane| {
                    (16 * first + lane as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
                });
                let halves = [0, 1].map(|half| streams.map(|stream| words(stream)[half]));
                let found = first_words(seed, halves);
                for (lane, stream) in streams.into_iter().enumerate() {
                    let mut key = [0; 32];
                    key[..8].copy_from_slice(&seed.to_le_bytes());
                    let mut random = ChaCha8Rng::from_seed(key);
                    random.set_stream(stream);
                    let expected = [0; 4].map(|_| random.next_u32());
                    assert_eq!(found.map(|word| word[lane]), expected);
                }
            }
        }
    }
}

//! The first numbers of four streams of `ChaCha8` at once.
//!
//! The same bits as those of `rand_chacha`, which makes four blocks of one stream at a time; a cell of the
//! screen needs a quarter of one.
//!
//! Source: Bernstein (2008), "`ChaCha`, a variant of Salsa20", with a counter and a nonce of 64 bits.

use wide::u32x4;

/// "expand 32-byte k".
const CONSTANTS: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];

/// Two rounds each.
const DOUBLE_ROUNDS: usize = 4;

/// The first two 64-bit numbers of each of four streams. The key is a seed, its other 24 bytes are zero.
pub(crate) fn first_numbers(seed: u64, streams: [u64; 4]) -> [[u64; 2]; 4] {
    let mut start = [u32x4::ZERO; 16];
    for (word, constant) in start.iter_mut().zip(CONSTANTS) {
        *word = u32x4::splat(constant);
    }
    let [low, high] = words(seed);
    (start[4], start[5]) = (u32x4::splat(low), u32x4::splat(high));
    let streams = streams.map(words);
    start[14] = u32x4::new(streams.map(|[low, _]| low));
    start[15] = u32x4::new(streams.map(|[_, high]| high));
    let mut state = start;
    for _ in 0..DOUBLE_ROUNDS {
        for column in 0..4 {
            quarter_round(&mut state, [0, 4, 8, 12].map(|row| row + column));
        }
        for diagonal in 0..4 {
            let places = [0, 1, 2, 3].map(|row| 4 * row + (diagonal + row) % 4);
            quarter_round(&mut state, places);
        }
    }
    let block: [[u32; 4]; 4] = std::array::from_fn(|word| (state[word] + start[word]).to_array());
    std::array::from_fn(|stream| {
        [[0, 1], [2, 3]].map(|[low, high]| {
            u64::from(block[low][stream]) | (u64::from(block[high][stream]) << 32)
        })
    })
}

#[inline]
fn quarter_round(state: &mut [u32x4; 16], [a, b, c, d]: [usize; 4]) {
    for [left, right] in [[16, 12], [8, 7]] {
        state[a] += state[b];
        state[d] = rotated(state[d] ^ state[a], left);
        state[c] += state[d];
        state[b] = rotated(state[b] ^ state[c], right);
    }
}

#[inline]
fn rotated(word: u32x4, left: u32) -> u32x4 {
    (word << left) | (word >> (32 - left))
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
            for first in 0..500_u64 {
                let streams = [0, 1, 2, 3_u64]
                    .map(|lane| (4 * first + lane).wrapping_mul(0x9e37_79b9_7f4a_7c15));
                let expected = streams.map(|stream| {
                    let mut key = [0; 32];
                    key[..8].copy_from_slice(&seed.to_le_bytes());
                    let mut random = ChaCha8Rng::from_seed(key);
                    random.set_stream(stream);
                    [random.next_u64(), random.next_u64()]
                });
                assert_eq!(first_numbers(seed, streams), expected);
            }
        }
    }
}

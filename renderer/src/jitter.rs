//! Where on an area light its samples lie: one at random in each cell of an n × n grid.
//!
//! The positions depend on the point of the screen, on which hit of its ray tree they are for and on which
//! light, and on nothing else, so that the same point gives the same bits on any thread.

use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::sampler::ScreenPoint;

/// The positions on one light for one hit.
#[derive(Debug)]
pub(crate) struct Jitter {
    random: ChaCha8Rng,
}

impl Jitter {
    /// The stream of a light for a hit of the ray tree of a point.
    pub(crate) fn new(at: ScreenPoint, hit: u32, light: u16) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&at.x.to_bits().to_le_bytes());
        key[8..16].copy_from_slice(&at.y.to_bits().to_le_bytes());
        key[16..20].copy_from_slice(&hit.to_le_bytes());
        key[20..22].copy_from_slice(&light.to_le_bytes());
        Self {
            random: ChaCha8Rng::from_seed(key),
        }
    }

    /// The next position: from 0 to 1 along both sides, in this cell of a grid of `side` × `side`.
    pub(crate) fn within(&mut self, cell: [u32; 2], side: u32) -> [f64; 2] {
        cell.map(|place| {
            let fraction = f64::from(self.random.next_u32() >> 8) / f64::from(1 << 24);
            (f64::from(place) + fraction) / f64::from(side)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_gets_one_position_and_streams_differ() {
        let at = ScreenPoint { x: 0.25, y: 0.75 };
        let mut first = Vec::new();
        for (hit, light) in [(1, 0), (2, 0), (1, 1), (1, 0)] {
            let mut jitter = Jitter::new(at, hit, light);
            let position = jitter.within([2, 1], 4);
            assert!((0.5..0.75).contains(&position[0]) && (0.25..0.5).contains(&position[1]));
            first.push(position);
        }
        assert_eq!(first[0], first[3]);
        assert!(first[0] != first[1] && first[0] != first[2] && first[1] != first[2]);
    }
}

//! Rays from one place: for each of many narrow pyramids the shapes that a ray in it may meet, and for each of
//! these which of the others may stand before it.
//!
//! The lists are too long rather than too short, so that what a ray finds is what trying every shape finds.
//! Where there is more to tell apart, the pyramids are narrower. Most of the time goes into fetching a list
//! from memory, so equal lists are kept once.
//!
//! Not here: how the lists are made (`fan_filling`), and what is asked of them (`view_fan`, `round_fan`).
//!
//! Sources: Weghorst, Hooper & Greenberg (1984), the item buffer; Haines & Greenberg (1986), the light buffer.

use wide::u16x8;

/// A pyramid cut into narrow ones, and the shapes in each.
#[derive(Clone, Debug)]
pub(super) struct Fan {
    /// A tree of squares: each node has 4 × 4 parts, row by row.
    pub(super) nodes: Vec<[Part; 16]>,
    /// The lists; the first is empty.
    pub(super) leaves: Vec<Leaf>,
}

/// What a part of a square is: the place of a leaf, with [`LEAF`] set, or of a node.
pub(super) type Part = u16;
pub(super) const LEAF: Part = 1 << 15;
/// The parts of a square along each side, as a power of 2.
const PARTS_BITS: u32 = 2;
/// No more squares within squares.
pub(super) const MAX_LEVELS: u32 = 4;

/// How many shapes a leaf holds.
pub(super) const WIDTH: usize = 8;
/// No shape.
pub(super) const NONE: u16 = u16::MAX;

/// The shapes of a narrow pyramid, nearer first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(align(32))]
pub(super) struct Leaf {
    pub(super) shapes: [u16; WIDTH],
    /// For each of the shapes as one that is lit from the apex, which of them may stand in its light: a bit
    /// each.
    pub(super) hiding: [u8; WIDTH],
    /// The leaf in which the list goes on, or 0.
    pub(super) more: u32,
}

impl Leaf {
    /// No shapes at all.
    pub(super) const EMPTY: Self = Self {
        shapes: [NONE; WIDTH],
        hiding: [0; WIDTH],
        more: 0,
    };

    /// The shapes that may stand in the light of one: all, if it is not here.
    #[inline]
    pub(super) fn hiding(&self, lit: u16) -> u8 {
        let found = u16x8::new(self.shapes).simd_eq(u16x8::splat(lit));
        let place = found.to_bitmask().trailing_zeros() as usize;
        self.hiding.get(place).copied().unwrap_or(u8::MAX)
    }
}

impl Fan {
    /// The list of the cell at s and t from 0 to 1 across and down the pyramid's base.
    #[inline]
    pub(super) fn leaf(&self, s: f64, t: f64) -> &Leaf {
        const CELLS: u32 = 1 << (PARTS_BITS * MAX_LEVELS);
        let place = |at: f64| cell(at * f64::from(CELLS)).min(CELLS - 1);
        let (column, row) = (place(s), place(t));
        let mut part = 0;
        let mut shift = PARTS_BITS * MAX_LEVELS;
        while part & LEAF == 0 {
            shift -= PARTS_BITS;
            let (across, down) = ((column >> shift) & 3, (row >> shift) & 3);
            part = self.nodes[usize::from(part)][(down << PARTS_BITS | across) as usize];
        }
        &self.leaves[usize::from(part & !LEAF)]
    }

    /// The leaf in which a list goes on.
    #[inline]
    pub(super) fn after(&self, leaf: &Leaf) -> Option<&Leaf> {
        (leaf.more != 0).then(|| &self.leaves[leaf.more as usize])
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place on a grid; what rounding puts before the first cell saturates at it"
)]
fn cell(place: f64) -> u32 {
    place as u32
}

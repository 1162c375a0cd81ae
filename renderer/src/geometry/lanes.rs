//! Numbers side by side, as many as the processor computes at once.
//!
//! Each operation is that of a single number for each of the lanes, rounded as IEEE 754 says, so that a formula
//! has the same bits as for numbers one by one, if it is the same formula.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;

use super::Vector;

/// How many numbers stand in a block; every processor's lanes fill it evenly.
pub(crate) const BLOCK: usize = 8;

/// A block of numbers.
pub(crate) type Block = [f64; BLOCK];

/// Numbers side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    of: S::f64s,
}

/// Vectors side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VectorLanes<S: Simd> {
    pub(crate) x: Lanes<S>,
    pub(crate) y: Lanes<S>,
    pub(crate) z: Lanes<S>,
}

impl<S: Simd> Lanes<S> {
    /// The same number in each lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, number: f64) -> Self {
        let of = simd.splat_f64s(number);
        Self { simd, of }
    }

    /// Part of a block: the lanes fill it `BLOCK / lanes` times.
    #[inline(always)]
    pub(crate) fn load(simd: S, block: &Block, part: usize) -> Self {
        let of = S::as_simd_f64s(block).0[part];
        Self { simd, of }
    }

    /// Puts the lanes into a part of a block.
    #[inline(always)]
    pub(crate) fn store(self, block: &mut Block, part: usize) {
        S::as_mut_simd_f64s(block).0[part] = self.of;
    }

    /// The square root.
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        let of = self.simd.sqrt_f64s(self.of);
        Self { of, ..self }
    }

    /// The number without its sign.
    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        let of = self.simd.abs_f64s(self.of);
        Self { of, ..self }
    }

    /// Where this is no less than the other.
    #[inline(always)]
    pub(crate) fn is_at_least(self, other: Self) -> S::m64s {
        self.simd.greater_than_or_equal_f64s(self.of, other.of)
    }

    /// Where this is less than the other.
    #[inline(always)]
    pub(crate) fn is_below(self, other: Self) -> S::m64s {
        self.simd.less_than_f64s(self.of, other.of)
    }

    /// This where the mask says so, else the other.
    #[inline(always)]
    pub(crate) fn or_else(self, mask: S::m64s, other: Self) -> Self {
        let of = self.simd.select_f64s(mask, self.of, other.of);
        Self { of, ..self }
    }
}

impl<S: Simd> VectorLanes<S> {
    /// The same vector in each lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, vector: Vector) -> Self {
        Self {
            x: Lanes::splat(simd, vector.x),
            y: Lanes::splat(simd, vector.y),
            z: Lanes::splat(simd, vector.z),
        }
    }

    /// Part of three blocks.
    #[inline(always)]
    pub(crate) fn load(simd: S, [x, y, z]: &[Block; 3], part: usize) -> Self {
        Self {
            x: Lanes::load(simd, x, part),
            y: Lanes::load(simd, y, part),
            z: Lanes::load(simd, z, part),
        }
    }

    /// Puts the lanes into a part of three blocks.
    #[inline(always)]
    pub(crate) fn store(self, [x, y, z]: &mut [Block; 3], part: usize) {
        self.x.store(x, part);
        self.y.store(y, part);
        self.z.store(z, part);
    }

    /// [`Vector::dot`].
    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> Lanes<S> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
}

macro_rules! lanewise {
    ($($operation:ident, $name:ident, $of:ident;)*) => {$(
        impl<S: Simd> $operation for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                let of = self.simd.$of(self.of, other.of);
                Self { of, ..self }
            }
        }
    )*};
}

lanewise! {
    Add, add, add_f64s;
    Sub, sub, sub_f64s;
    Mul, mul, mul_f64s;
    Div, div, div_f64s;
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let of = self.simd.neg_f64s(self.of);
        Self { of, ..self }
    }
}

impl<S: Simd> Sub for VectorLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl<S: Simd> Mul<Lanes<S>> for VectorLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Lanes<S>) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
        }
    }
}

impl<S: Simd> Neg for VectorLanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
        }
    }
}

//! What arrives from a point light at many surfaces, a block of surfaces at a time.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use pulp::{Arch, Simd, WithSimd};

use crate::geometry::lanes::{BLOCK, Block, Lanes, VectorLanes};
use crate::geometry::{RoundFan, Vector};
use crate::lighting::Surface;
use crate::scene::light::Arrival;

/// Surfaces side by side.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct SurfaceBlock {
    place: [Block; 3],
    facing: [Block; 3],
    normal: [Block; 3],
    mirrored: [Block; 3],
}

/// What arrives at them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct ArrivalBlock {
    towards: [Block; 3],
    distance_m: Block,
    illuminance: Block,
    cos_facing: Block,
    cos_incidence: Block,
    cos_mirrored: Block,
    /// Where in the fan of the light the surface is.
    face: Block,
    s: Block,
    t: Block,
}

/// Surfaces, and what arrives at them from the light that was last asked for; the memory is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Arrivals {
    surfaces: Vec<SurfaceBlock>,
    found: Vec<ArrivalBlock>,
    count: usize,
}

/// What arrives at one surface.
pub(crate) struct Arriving {
    pub(crate) arrival: Arrival,
    pub(crate) cos_facing: f64,
    pub(crate) cos_incidence: f64,
    pub(crate) cos_mirrored: f64,
    /// The face of the light's [`RoundFan`], and where in it.
    pub(crate) in_fan: (usize, (f64, f64)),
}

impl Arrivals {
    /// Forgets all surfaces.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    /// How many surfaces there are.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Adds a surface.
    #[inline]
    pub(crate) fn push(&mut self, surface: &Surface) {
        let (block, lane) = (self.count / BLOCK, self.count % BLOCK);
        if block == self.surfaces.len() {
            self.surfaces.push(SurfaceBlock::default());
            self.found.push(ArrivalBlock::default());
        }
        let block = &mut self.surfaces[block];
        let put = |blocks: &mut [Block; 3], Vector { x, y, z }: Vector| {
            for (block, coordinate) in blocks.iter_mut().zip([x, y, z]) {
                block[lane] = coordinate;
            }
        };
        put(&mut block.place, surface.place);
        put(&mut block.facing, surface.facing);
        put(&mut block.normal, surface.normal);
        put(&mut block.mirrored, surface.mirrored);
        self.count += 1;
    }

    /// Finds what arrives from a point light.
    pub(crate) fn find(&mut self, position: Vector, intensity: f64) {
        let blocks = self.count.div_ceil(BLOCK);
        Arch::new().dispatch(FromPoint {
            position,
            intensity,
            surfaces: &self.surfaces[..blocks],
            arrivals: &mut self.found[..blocks],
        });
    }

    /// What was found for a surface.
    #[inline]
    pub(crate) fn at(&self, place: usize) -> Arriving {
        let (block, lane) = (&self.found[place / BLOCK], place % BLOCK);
        let [x, y, z] = block.towards.map(|block| block[lane]);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number from 0 to 5"
        )]
        let face = block.face[lane] as usize;
        Arriving {
            arrival: Arrival {
                towards: Vector { x, y, z },
                distance_m: block.distance_m[lane],
                illuminance: block.illuminance[lane],
            },
            cos_facing: block.cos_facing[lane],
            cos_incidence: block.cos_incidence[lane],
            cos_mirrored: block.cos_mirrored[lane],
            in_fan: (face, (block.s[lane], block.t[lane])),
        }
    }
}

/// The formulas of [`Source::arrival`](crate::scene::light::Source::arrival) and of the cosines.
struct FromPoint<'a> {
    position: Vector,
    intensity: f64,
    surfaces: &'a [SurfaceBlock],
    arrivals: &'a mut [ArrivalBlock],
}

impl WithSimd for FromPoint<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let position = VectorLanes::splat(simd, self.position);
        let intensity = Lanes::splat(simd, self.intensity);
        let one = Lanes::splat(simd, 1.0);
        for (surface, arriving) in self.surfaces.iter().zip(self.arrivals) {
            for part in 0..BLOCK / S::F64_LANES {
                let load = |of: &[Block; 3]| VectorLanes::load(simd, of, part);
                let path = position - load(&surface.place);
                let distance_m = path.dot(path).sqrt();
                let towards = path * (one / distance_m);
                let (face, s, t) = RoundFan::place_of(simd, -towards);
                towards.store(&mut arriving.towards, part);
                distance_m.store(&mut arriving.distance_m, part);
                let illuminance = intensity / (distance_m * distance_m);
                illuminance.store(&mut arriving.illuminance, part);
                let cos = |of: &[Block; 3]| towards.dot(load(of));
                cos(&surface.facing).store(&mut arriving.cos_facing, part);
                cos(&surface.normal).store(&mut arriving.cos_incidence, part);
                cos(&surface.mirrored).store(&mut arriving.cos_mirrored, part);
                face.store(&mut arriving.face, part);
                s.store(&mut arriving.s, part);
                t.store(&mut arriving.t, part);
            }
        }
    }
}

//! What one ray found, geometry only: section 3.3 of Meyer & Liu (1992), step 1.
//!
//! Every surface here sends on at most one ray, the mirrored one, so that the tree is a chain: the camera's
//! ray, then each mirrored ray in turn. Nothing is allocated.
//!
//! Not here: how rays are followed (`scene_sampler`) and what colour they bring (`shader`).

use crate::scene::material::ReflectanceIndex;

/// The most lights that a scene may have.
pub(crate) const MAX_LIGHTS: usize = 4;
/// The most hits of one tree: the camera's ray and four mirrored ones.
pub(crate) const MAX_NODES: usize = 5;

/// The hits of one ray and of the rays that it spawned.
#[derive(Clone, Debug, Default)]
pub struct RayTree {
    nodes: [RayNode; MAX_NODES],
    count: u8,
}

/// A hit: how strongly each light and the mirrored ray count there, whatever their colour.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RayNode {
    /// For each light, what the body scatters of it: illuminance, shadow, and what the coat leaves.
    pub(crate) scattered: [f32; MAX_LIGHTS],
    /// The same for ambient light.
    pub(crate) scattered_ambient: f32,
    /// For each light, how bright its highlight is.
    pub(crate) highlights: [f32; MAX_LIGHTS],
    /// What part of the mirrored ray counts; 0 if there is none.
    pub(crate) mirrored: f32,
    pub(crate) body: ReflectanceIndex,
    pub(crate) mirror: ReflectanceIndex,
}

impl RayTree {
    /// The hits, from the camera on.
    #[inline]
    pub(crate) fn nodes(&self) -> &[RayNode] {
        &self.nodes[..usize::from(self.count)]
    }

    /// Forgets all hits.
    #[inline]
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a hit; the caller counts them.
    #[inline]
    pub(crate) fn push(&mut self, node: RayNode) {
        self.nodes[usize::from(self.count)] = node;
        self.count += 1;
    }

    /// Whether another hit has room.
    #[inline]
    pub(crate) fn has_room(&self) -> bool {
        usize::from(self.count) < MAX_NODES
    }
}

//! Where a ray meets a shape: geometry only, no colour.
//!
//! World axes are right-handed with z up, lengths in metres. Directions are unit vectors. Every shape is
//! closed or flat and is seen from both sides; surface coordinates are in metres along the surface.

pub(crate) mod bounds;
pub(crate) mod box_node;
#[cfg(target_arch = "x86_64")]
pub(crate) mod box_test_v3;
pub(crate) mod box_tree;
pub(crate) mod cone;
pub(crate) mod cuboid;
pub(crate) mod cylinder;
pub(crate) mod descent;
pub(crate) mod disc;
mod fan;
mod fan_filling;
mod flock;
pub(crate) mod frame;
pub(crate) mod ground;
pub(crate) mod hierarchy;
pub(crate) mod lanes;
pub(crate) mod mesh;
mod outline;
pub(crate) mod packet;
pub(crate) mod pyramid;
#[cfg(test)]
mod random_shapes;
pub(crate) mod ray;
pub(crate) mod rectangle;
pub(crate) mod round_fan;
pub(crate) mod shape;
mod shape_queues;
pub(crate) mod single_ray;
pub(crate) mod sphere;
pub(crate) mod split_tree;
pub(crate) mod triangle;
pub(crate) mod vector;
pub(crate) mod view_fan;
pub(crate) mod wide_tree;

pub(crate) use bounds::Bounds;
pub(crate) use box_tree::BoxTree;
pub(crate) use cone::Cone;
pub(crate) use cuboid::Cuboid;
pub(crate) use cylinder::Cylinder;
pub(crate) use disc::Disc;

pub(crate) use flock::Flock;
pub(crate) use frame::Frame;
pub(crate) use ground::Ground;
pub(crate) use hierarchy::Hierarchy;
pub(crate) use mesh::{Mesh, MeshParts};
pub(crate) use pyramid::Pyramid;
pub(crate) use ray::{Hit, Part, Ray, Span, SurfacePoint};
pub(crate) use rectangle::Rectangle;
pub(crate) use round_fan::RoundFan;
pub(crate) use shape::Shape;
pub(crate) use shape_queues::{Departure, Found, ShapeQueues};
pub(crate) use single_ray::SingleRay;
pub(crate) use sphere::Sphere;
pub(crate) use vector::Vector;
pub(crate) use view_fan::ViewFan;

//! Any of the shapes of a scene.

use super::{
    Bounds, Cone, Cuboid, Cylinder, Disc, Ground, Hit, Part, Ray, Rectangle, Span, Sphere,
    SurfacePoint, Vector,
};

/// One shape.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Sphere(Sphere),
    Cuboid(Cuboid),
    Cylinder(Cylinder),
    Cone(Cone),
    Disc(Disc),
    Rectangle(Rectangle),
    Ground(Ground),
}

impl Shape {
    /// The box that holds the shape; `None` if it has no end.
    pub(crate) fn bounds(&self) -> Option<Bounds> {
        match self {
            Self::Sphere(sphere) => Some(sphere.bounds()),
            Self::Cuboid(cuboid) => Some(cuboid.bounds()),
            Self::Cylinder(cylinder) => Some(cylinder.bounds()),
            Self::Cone(cone) => Some(cone.bounds()),
            Self::Disc(disc) => Some(disc.bounds()),
            Self::Rectangle(rectangle) => Some(rectangle.bounds()),
            Self::Ground(_) => None,
        }
    }

    /// The first hit within the span.
    #[inline]
    pub(crate) fn hit(&self, ray: &Ray, span: Span) -> Option<Hit> {
        match self {
            Self::Sphere(sphere) => sphere.hit(ray, span),
            Self::Cuboid(cuboid) => cuboid.hit(ray, span),
            Self::Cylinder(cylinder) => cylinder.hit(ray, span),
            Self::Cone(cone) => cone.hit(ray, span),
            Self::Disc(disc) => disc.hit(ray, span),
            Self::Rectangle(rectangle) => rectangle.hit(ray, span),
            Self::Ground(ground) => ground.hit(ray, span),
        }
    }

    /// The unit normal at a place that was hit; outwards for what is closed.
    pub(crate) fn normal(&self, place: Vector, part: Part) -> Vector {
        match self {
            Self::Sphere(sphere) => sphere.normal(place),
            Self::Cuboid(cuboid) => cuboid.normal(place),
            Self::Cylinder(cylinder) => cylinder.normal(place, part),
            Self::Cone(cone) => cone.normal(place, part),
            Self::Disc(disc) => disc.normal(),
            Self::Rectangle(rectangle) => rectangle.normal(),
            Self::Ground(_) => Vector::UP,
        }
    }

    /// The surface coordinates of a place that was hit.
    pub(crate) fn surface_point(&self, place: Vector, part: Part) -> SurfacePoint {
        match self {
            Self::Sphere(sphere) => sphere.surface_point(place),
            Self::Cuboid(cuboid) => cuboid.surface_point(place),
            Self::Cylinder(cylinder) => cylinder.surface_point(place, part),
            Self::Cone(cone) => cone.surface_point(place, part),
            Self::Disc(disc) => disc.surface_point(place),
            Self::Rectangle(rectangle) => rectangle.surface_point(place),
            Self::Ground(_) => Ground::surface_point(place),
        }
    }
}

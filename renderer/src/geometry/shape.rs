//! Any of the shapes of a scene.

use std::sync::Arc;

use arrayvec::ArrayVec;

use super::{
    Bounds, Cone, Cuboid, Cylinder, Disc, Ground, Hit, Mesh, Part, Ray, Rectangle, Span, Sphere,
    SurfacePoint, Vector,
};

/// The balls whose convex hull holds a shape.
pub(crate) type Hull = ArrayVec<(Vector, f64), 8>;

/// One shape.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Sphere(Sphere),
    Cuboid(Cuboid),
    Cylinder(Cylinder),
    Cone(Cone),
    Disc(Disc),
    Rectangle(Rectangle),
    Ground(Ground),
    Mesh(Arc<Mesh>),
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
            Self::Mesh(mesh) => mesh.bounds(),
        }
    }

    /// Balls whose convex hull holds the shape; none for one without end.
    pub(crate) fn hull(&self) -> Hull {
        let corners = |corners: &[Vector]| corners.iter().map(|&c| (c, 0.0)).collect();
        match self {
            Self::Sphere(sphere) => [(sphere.center, sphere.radius_m)].into_iter().collect(),
            Self::Cylinder(cylinder) => cylinder.ends().into_iter().collect(),
            Self::Cone(cone) => cone.ends().into_iter().collect(),
            Self::Disc(disc) => [disc.ball()].into_iter().collect(),
            Self::Rectangle(rectangle) => corners(&rectangle.corners()),
            Self::Cuboid(cuboid) => corners(&cuboid.corners()),
            Self::Ground(_) => Hull::new(),
            Self::Mesh(mesh) => mesh
                .bounds()
                .map_or(Hull::new(), |bounds| corners(&bounds.corners())),
        }
    }

    /// A place on a flat shape and its normal.
    pub(crate) fn plane(&self) -> Option<(Vector, Vector)> {
        match self {
            Self::Disc(disc) => Some((disc.ball().0, disc.normal())),
            Self::Rectangle(rectangle) => Some((rectangle.corners()[0], rectangle.normal())),
            Self::Ground(ground) => Some((Vector::new(0.0, 0.0, ground.height_m), Vector::UP)),
            _ => None,
        }
    }

    /// Whether the shape has no end, so that no box holds it.
    pub(crate) const fn is_endless(&self) -> bool {
        matches!(self, Self::Ground(_))
    }

    /// Whether the shape encloses a space, as far as can be known: a mesh is believed to.
    pub(crate) const fn is_closed(&self) -> bool {
        !matches!(self, Self::Disc(_) | Self::Rectangle(_))
    }

    /// Whether no straight line meets it in more than one piece, as far as can be known.
    pub(crate) const fn is_convex(&self) -> bool {
        !matches!(self, Self::Mesh(_))
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
            Self::Mesh(mesh) => mesh.hit(ray, span),
        }
    }

    /// Whether anything is hit within the span.
    #[inline]
    pub(crate) fn is_hit(&self, ray: &Ray, span: Span) -> bool {
        match self {
            Self::Mesh(mesh) => mesh.is_hit(ray, span),
            other => other.hit(ray, span).is_some(),
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
            Self::Mesh(mesh) => match part {
                Part::Face(face) => mesh.flat_normal(face),
                Part::Side | Part::Cap => Vector::UP,
            },
        }
    }

    /// The unit normal by which light is reckoned, if it is another than that of the surface.
    pub(crate) fn smooth_normal(&self, place: Vector, part: Part) -> Option<Vector> {
        match (self, part) {
            (Self::Mesh(mesh), Part::Face(face)) => mesh.smooth_normal(face, place),
            _ => None,
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
            Self::Mesh(_) => {
                let [u_m, v_m] = self.texture_point(place, part);
                SurfacePoint { u_m, v_m }
            }
        }
    }

    /// The place in a texture, which covers the square from 0 to 1: that of a mesh's own, the edges of a
    /// rectangle, or the surface coordinates in metres.
    pub(crate) fn texture_point(&self, place: Vector, part: Part) -> [f64; 2] {
        match (self, part) {
            (Self::Mesh(mesh), Part::Face(face)) => {
                mesh.texture_point(face, place).unwrap_or_default()
            }
            (Self::Mesh(_), Part::Side | Part::Cap) => [0.0; 2],
            (Self::Rectangle(rectangle), _) => rectangle.texture_point(place),
            (other, _) => {
                let SurfacePoint { u_m, v_m } = other.surface_point(place, part);
                [u_m, v_m]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random_shapes::{Stream, first_hit};
    use super::*;

    /// Where a ray first changes between inside and outside, found by small steps and halving.
    fn by_marching(ray: &Ray, is_inside: &dyn Fn(Vector) -> bool) -> Option<f64> {
        let (step_m, starts_inside) = (0.002, is_inside(ray.origin));
        let steps = 1..4_000;
        let crossed = steps.map(|step| f64::from(step) * step_m);
        let mut far = crossed
            .into_iter()
            .find(|&distance| is_inside(ray.at(distance)) != starts_inside)?;
        let mut near = far - step_m;
        for _ in 0..50 {
            let middle = 0.5 * (near + far);
            if is_inside(ray.at(middle)) == starts_inside {
                near = middle;
            } else {
                far = middle;
            }
        }
        Some(far)
    }

    type Definition = Box<dyn Fn(Vector) -> bool>;

    /// Solids with their definitions as sets of places.
    fn solids() -> Vec<(Shape, Definition)> {
        let base = Vector::new(-0.3, 0.2, -0.5);
        let axis = Vector::new(1.0, 2.0, 2.0) * (1.0 / 3.0);
        let (height_m, radius_m) = (1.2, 0.6);
        let along = move |place: Vector| (place - base).dot(axis);
        let aside = move |place: Vector| (place - base - axis * along(place)).length();
        let turned = move |place: Vector| {
            // By 30° from x towards y: cos² = 3/4, sin = 1/2.
            let (cos, sin) = (0.75_f64.sqrt(), 0.5);
            let x = cos * place.x + sin * place.y;
            let y = cos * place.y - sin * place.x;
            x.abs() <= 0.5 && y.abs() <= 0.7 && place.z.abs() <= 0.3
        };
        let size = Vector::new(1.0, 1.4, 0.6);
        vec![
            (
                Shape::Sphere(Sphere {
                    center: base,
                    radius_m,
                }),
                Box::new(move |place| (place - base).length() <= radius_m),
            ),
            (
                Shape::Cuboid(Cuboid::new(Vector::default(), size, 30.0)),
                Box::new(turned),
            ),
            (
                Shape::Cylinder(Cylinder::between(base, base + axis * height_m, radius_m)),
                Box::new(move |place| {
                    (0.0..=height_m).contains(&along(place)) && aside(place) <= radius_m
                }),
            ),
            (
                Shape::Cone(Cone::between(base, base + axis * height_m, radius_m)),
                Box::new(move |place| {
                    let part = along(place) / height_m;
                    (0.0..=1.0).contains(&part) && aside(place) <= radius_m * (1.0 - part)
                }),
            ),
        ]
    }

    #[test]
    fn a_hit_is_where_small_steps_find_it() {
        let mut stream = Stream(1);
        for (shape, is_inside) in solids() {
            let mut hits = 0;
            for _ in 0..400 {
                let ray = stream.ray();
                let marched = by_marching(&ray, &*is_inside);
                let hit = first_hit(&shape, &ray).filter(|hit| hit.distance_m < 7.9);
                match (hit, marched) {
                    (Some(hit), Some(marched)) => {
                        hits += 1;
                        assert!((hit.distance_m - marched).abs() < 1e-9, "{shape:?} {ray:?}");
                    }
                    (None, None) => {}
                    // A corner that is thinner than a step along the ray.
                    (Some(hit), None) => assert!(
                        !is_inside(ray.at(hit.distance_m + 0.004)),
                        "{shape:?} {ray:?}"
                    ),
                    (None, Some(_)) => panic!("missed {shape:?} by {ray:?}"),
                }
            }
            assert!(hits > 50, "only {hits} hits of {shape:?}");
        }
    }

    #[test]
    fn a_normal_points_out_of_the_solid() {
        let mut stream = Stream(2);
        for (shape, is_inside) in solids() {
            for _ in 0..400 {
                let ray = stream.ray();
                let Some(hit) = first_hit(&shape, &ray) else {
                    continue;
                };
                let place = ray.at(hit.distance_m);
                let normal = shape.normal(place, hit.part);
                assert!((normal.length() - 1.0).abs() < 1e-12);
                assert!(!is_inside(place + normal * 1e-6), "{shape:?} {ray:?}");
                assert!(is_inside(place - normal * 1e-6), "{shape:?} {ray:?}");
            }
        }
    }

    #[test]
    fn a_ray_along_the_axis_of_a_cylinder_meets_its_end() {
        let cylinder = Cylinder::between(Vector::default(), Vector::new(0.0, 0.0, 2.0), 0.5);
        let ray = Ray {
            origin: Vector::new(0.1, 0.2, 5.0),
            direction: Vector::new(0.0, 0.0, -1.0),
        };
        let hit = first_hit(&Shape::Cylinder(cylinder), &ray);
        let expected = Hit {
            distance_m: 3.0,
            part: Part::Cap,
        };
        assert_eq!(hit, Some(expected));
    }

    #[test]
    fn flat_shapes_end_at_their_edges() {
        let down = |x: f64, y: f64| Ray {
            origin: Vector::new(x, y, 2.0),
            direction: Vector::new(0.0, 0.0, -1.0),
        };
        let disc = Shape::Disc(Disc::new(Vector::default(), Vector::UP, 0.5));
        let edges = (Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 0.5, 0.0));
        let rectangle = Shape::Rectangle(Rectangle::new(Vector::default(), edges.0, edges.1));
        assert!(first_hit(&disc, &down(0.3, 0.399)).is_some());
        assert!(first_hit(&disc, &down(0.3, 0.401)).is_none());
        assert!(first_hit(&rectangle, &down(0.999, 0.499)).is_some());
        assert!(first_hit(&rectangle, &down(0.5, 0.501)).is_none());
        assert!(first_hit(&rectangle, &down(-0.001, 0.2)).is_none());
    }
}

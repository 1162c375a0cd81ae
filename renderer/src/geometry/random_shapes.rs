//! Shapes and rays at random, and the plain way to find what a ray meets: for tests only.

use super::{
    Cone, Cuboid, Cylinder, Disc, Ground, Hit, Ray, Rectangle, Shape, Span, Sphere, Vector,
};

/// A stream of numbers from 0 to 1 that is the same everywhere: Knuth's MMIX generator.
pub(super) struct Stream(pub(super) u64);

impl Stream {
    pub(super) fn unit(&mut self) -> f64 {
        let Self(state) = self;
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn place(&mut self, size_m: f64) -> Vector {
        let mut coordinate = || size_m * (2.0 * self.unit() - 1.0);
        Vector::new(coordinate(), coordinate(), coordinate())
    }

    pub(super) fn ray(&mut self) -> Ray {
        let origin = self.place(4.0);
        let direction = (self.place(1.0) - origin).normalized();
        Ray { origin, direction }
    }
}

/// The first hit anywhere along a ray.
pub(super) fn first_hit(shape: &Shape, ray: &Ray) -> Option<Hit> {
    shape.hit(ray, Span::up_to(f64::INFINITY))
}

/// Six hundred shapes of all kinds over a ground, one of them twice.
pub(super) fn many(stream: &mut Stream) -> Vec<Shape> {
    let mut shapes = vec![Shape::Ground(Ground { height_m: -1.0 })];
    for _ in 0..100 {
        let (one, radius_m) = (stream.place(2.0), 0.02 + 0.2 * stream.unit());
        let other = one + stream.place(0.5);
        let turn_deg = 90.0 * stream.unit();
        let normal = (other - one).normalized();
        let size = Vector::new(radius_m, 0.1, 0.3);
        let edges = (Vector::new(radius_m, 0.0, 0.0), Vector::new(0.0, 0.0, 0.2));
        shapes.extend([
            Shape::Sphere(Sphere {
                center: one,
                radius_m,
            }),
            Shape::Cuboid(Cuboid::new(one, size, turn_deg)),
            Shape::Cylinder(Cylinder::between(one, other, 0.1 * radius_m)),
            Shape::Cone(Cone::between(other, one, radius_m)),
            Shape::Disc(Disc::new(other, normal, radius_m)),
            Shape::Rectangle(Rectangle::new(other, edges.0, edges.1)),
        ]);
    }
    // The same rectangle twice: of equal hits the first shape's counts.
    shapes.push(shapes[6].clone());
    shapes
}

/// The plain way: every shape in its order.
pub(super) fn by_trying_all(shapes: &[Shape], ray: &Ray) -> Option<(u32, Hit)> {
    let tried = (0..)
        .zip(shapes)
        .filter_map(|(index, shape)| first_hit(shape, ray).map(|hit| (index, hit)));
    tried.reduce(|best: (u32, Hit), next| {
        if next.1.distance_m < best.1.distance_m {
            next
        } else {
            best
        }
    })
}

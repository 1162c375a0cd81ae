//! The six fans round a place: what stands between it and any other place.
#![expect(
    clippy::inline_always,
    reason = "code for a processor's own instructions is compiled for them only where it is inlined"
)]

use std::ops::ControlFlow;

use pulp::Simd;
use rayon::prelude::*;

use super::fan::{Fan, NONE};
use super::fan_filling::Looks;
use super::lanes::{Lanes, VectorLanes};
use super::outline::Outline;
use super::{Pyramid, Ray, Shape, Span, Vector};

/// Six pyramids with one apex that fill all directions.
#[derive(Clone, Debug)]
pub(crate) struct RoundFan {
    faces: Vec<Fan>,
}

impl RoundFan {
    /// The lists round a place; `None` if they would be too long to be worth it.
    pub(crate) fn new(apex: Vector, shapes: &[Shape]) -> Option<Self> {
        let [x, y, z] = [
            Vector::new(1.0, 0.0, 0.0),
            Vector::new(0.0, 1.0, 0.0),
            Vector::UP,
        ];
        let axes = [
            (x, y, z),
            (-x, y, z),
            (y, x, z),
            (-y, x, z),
            (z, x, y),
            (-z, x, y),
        ];
        let outlines = Outline::from_apex(apex, shapes);
        let faces = axes.into_par_iter().map(|(forward, right, up)| {
            let pyramid = Pyramid {
                apex,
                forward,
                right,
                up,
            };
            Fan::new(&pyramid, (shapes, &outlines), Looks::Shadows)
        });
        let faces: Option<Vec<Fan>> = faces.collect();
        faces.map(|faces| Self { faces })
    }

    /// Whether a ray towards the place, which it reaches at the end of the span, hits anything before; it
    /// comes from the outside of the shape `lit`, or from anywhere.
    #[inline]
    pub(crate) fn is_blocked(
        &self,
        (ray, span): (&Ray, Span),
        lit: Option<u32>,
        shapes: &[Shape],
    ) -> bool {
        let is_hit = |shape: u32| {
            if shapes[shape as usize].is_hit(ray, span) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        self.try_candidates(ray.direction, lit, is_hit).is_break()
    }

    /// Names the shapes that a ray in this direction, as in [`Self::is_blocked`], may hit, until one of them
    /// breaks.
    #[inline]
    pub(crate) fn try_candidates(
        &self,
        direction: Vector,
        lit: Option<u32>,
        name: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (face, at) = Self::face_from(direction);
        self.try_candidates_at((face, at), lit, name)
    }

    /// The same for the directions of a [place](Self::place_of).
    #[inline]
    pub(crate) fn try_candidates_at(
        &self,
        (face, (s, t)): (usize, (f64, f64)),
        lit: Option<u32>,
        mut name: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let fan = &self.faces[face];
        let mut list = fan.leaf(s, t);
        let lit = lit.and_then(|lit| u16::try_from(lit).ok());
        loop {
            let mut hiding = lit.map_or(u8::MAX, |lit| list.hiding(lit));
            while hiding != 0 {
                let shape = list.shapes[hiding.trailing_zeros() as usize];
                if shape == NONE {
                    return ControlFlow::Continue(());
                }
                name(u32::from(shape))?;
                hiding &= hiding - 1;
            }
            match fan.after(list) {
                Some(next) => list = next,
                None => return ControlFlow::Continue(()),
            }
        }
    }

    /// The face that rays of this direction arrive through, and where.
    #[inline]
    fn face_from(direction: Vector) -> (usize, (f64, f64)) {
        let Vector { x, y, z } = -direction;
        let face = |place: usize, forward: f64| place + usize::from(forward < 0.0);
        let (face, forward, right, up) = if x.abs() >= y.abs() && x.abs() >= z.abs() {
            (face(0, x), x, y, z)
        } else if y.abs() >= z.abs() {
            (face(2, y), y, x, z)
        } else {
            (face(4, z), z, x, y)
        };
        let half = 0.5 / forward.abs();
        (face, (0.5 + right * half, 0.5 - up * half))
    }

    /// The same for many directions from the apex: the number of the face, and the place across and down it.
    #[inline(always)]
    pub(crate) fn place_of<S: Simd>(
        simd: S,
        VectorLanes { x, y, z }: VectorLanes<S>,
    ) -> (Lanes<S>, Lanes<S>, Lanes<S>) {
        let number = |number: f64| Lanes::splat(simd, number);
        let (x_size, y_size, z_size) = (x.abs(), y.abs(), z.abs());
        let is_x = simd.and_m64s(x_size.is_at_least(y_size), x_size.is_at_least(z_size));
        let is_y = y_size.is_at_least(z_size);
        let forward = x.or_else(is_x, y.or_else(is_y, z));
        let right = y.or_else(is_x, x);
        let up = z.or_else(is_x, z.or_else(is_y, y));
        let face = number(0.0).or_else(is_x, number(2.0).or_else(is_y, number(4.0)));
        let behind = number(1.0).or_else(forward.is_below(number(0.0)), number(0.0));
        let half = number(0.5) / forward.abs();
        (
            face + behind,
            number(0.5) + right * half,
            number(0.5) - up * half,
        )
    }
}

#[cfg(test)]
mod tests {
    use pulp::WithSimd;

    use super::super::lanes::{BLOCK, Block};
    use super::super::random_shapes::{Stream, by_trying_all, many};
    use super::super::{Ground, Rectangle, Sphere};
    use super::*;

    #[test]
    fn any_place_is_dark_if_trying_every_shape_says_so() {
        let mut stream = Stream(4);
        let shapes: Vec<Shape> = many(&mut stream).into_iter().step_by(3).collect();
        let apex = Vector::new(2.9, -3.1, 2.7);
        let round = RoundFan::new(apex, &shapes).unwrap();
        let mut shadows = 0;
        for _ in 0..20_000 {
            let place = stream.place(3.0);
            let path = apex - place;
            let ray = Ray {
                origin: place + stream.place(5e-7),
                direction: path.normalized(),
            };
            let span = Span::up_to(path.length());
            let expected = shapes.iter().any(|shape| shape.is_hit(&ray, span));
            assert_eq!(round.is_blocked((&ray, span), None, &shapes), expected);
            shadows += u32::from(expected);
        }
        assert!((2_000..18_000).contains(&shadows), "{shadows} shadows");
    }

    #[test]
    fn lanes_find_the_faces_that_one_direction_finds() {
        struct Places<'a>([Block; 3], &'a mut [Block; 3]);
        impl WithSimd for Places<'_> {
            type Output = ();

            fn with_simd<S: Simd>(self, simd: S) {
                for part in 0..BLOCK / S::F64_LANES {
                    let direction = VectorLanes::load(simd, &self.0, part);
                    let (x, y, z) = RoundFan::place_of(simd, direction);
                    VectorLanes { x, y, z }.store(self.1, part);
                }
            }
        }
        let mut stream = Stream(9);
        for _ in 0..2_000 {
            let directions: [Vector; BLOCK] = std::array::from_fn(|_| stream.place(1.0));
            let (mut of, mut found) = ([[0.0; BLOCK]; 3], [[0.0; BLOCK]; 3]);
            for (lane, direction) in directions.iter().enumerate() {
                (of[0][lane], of[1][lane], of[2][lane]) = (direction.x, direction.y, direction.z);
            }
            pulp::Arch::new().dispatch(Places(of, &mut found));
            for (lane, &direction) in directions.iter().enumerate() {
                let (face, at) = RoundFan::face_from(-direction);
                let found = (found[0][lane], (found[1][lane], found[2][lane]));
                assert_eq!(found, (face as f64, at));
            }
        }
    }

    /// A closed room with stripes before a wall, balls that rest on the ground, and many other shapes.
    fn room(stream: &mut Stream) -> Vec<Shape> {
        let mut shapes = many(stream);
        shapes.truncate(300);
        shapes[0] = Shape::Ground(Ground { height_m: -2.5 });
        let rectangle = |corner: [f64; 3], u: [f64; 3], v: [f64; 3]| {
            let rectangle = Rectangle::new(corner.into(), u.into(), v.into());
            Shape::Rectangle(rectangle)
        };
        let (x, y, z) = ([7.0, 0.0, 0.0], [0.0, 7.0, 0.0], [0.0, 0.0, 6.0]);
        shapes.extend([
            rectangle([-3.5, -3.5, -2.5], x, z),
            rectangle([-3.5, 3.5, -2.5], x, z),
            rectangle([-3.5, -3.5, -2.5], y, z),
            rectangle([3.5, -3.5, -2.5], y, z),
            rectangle([-3.5, -3.5, 3.5], x, y),
        ]);
        for stripe in 0..40 {
            let left = f64::from(stripe) * 0.15 - 3.0;
            let (u, v) = ([0.15, 0.0, 0.0], [0.0, 0.0, 0.8]);
            shapes.push(rectangle([left, 3.47, -1.0], u, v));
            let (center, radius_m) = (Vector::new(left, 0.5 * left, -2.4), 0.1);
            shapes.push(Shape::Sphere(Sphere { center, radius_m }));
        }
        shapes
    }

    #[test]
    fn a_surface_is_dark_if_trying_every_shape_says_so() {
        let mut stream = Stream(5);
        let shapes = room(&mut stream);
        let apex = Vector::new(-2.9, -3.1, 2.7);
        let round = RoundFan::new(apex, &shapes).unwrap();
        let (mut lit, mut dark) = (0, 0);
        for _ in 0..40_000 {
            let ray = stream.ray();
            let Some((index, hit)) = by_trying_all(&shapes, &ray) else {
                continue;
            };
            let shape = &shapes[index as usize];
            let place = ray.at(hit.distance_m);
            let outwards = shape.normal(place, hit.part);
            let is_outside = outwards.dot(ray.direction) <= 0.0;
            let facing = if is_outside { outwards } else { -outwards };
            let path = apex - place;
            if path.dot(facing) <= 0.0 {
                continue;
            }
            let shadow_ray = Ray {
                origin: place + facing * 1e-6,
                direction: path.normalized(),
            };
            let span = Span::up_to(path.length());
            let expected = shapes.iter().any(|shape| shape.is_hit(&shadow_ray, span));
            let outside_of = (is_outside || !shape.is_closed()).then_some(index);
            let found = round.is_blocked((&shadow_ray, span), outside_of, &shapes);
            assert_eq!(found, expected, "{shape:?} at {place:?}");
            *(if found { &mut dark } else { &mut lit }) += 1;
        }
        assert!(lit > 2_000 && dark > 2_000, "{lit} lit, {dark} dark");
    }
}

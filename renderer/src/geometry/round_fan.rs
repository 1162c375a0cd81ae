//! The six fans round a place: what stands between it and any other place.

use rayon::prelude::*;

use super::fan::{Fan, NONE};
use super::fan_filling::Looks;
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
        let Vector { x, y, z } = -ray.direction;
        let face = |place: usize, forward: f64| place + usize::from(forward < 0.0);
        let (face, forward, right, up) = if x.abs() >= y.abs() && x.abs() >= z.abs() {
            (face(0, x), x, y, z)
        } else if y.abs() >= z.abs() {
            (face(2, y), y, x, z)
        } else {
            (face(4, z), z, x, y)
        };
        let half = 0.5 / forward.abs();
        let at = (0.5 + right * half, 0.5 - up * half);
        let lit = lit.and_then(|lit| u16::try_from(lit).ok());
        let fan = &self.faces[face];
        let mut leaf = Some(fan.leaf(at.0, at.1));
        while let Some(list) = leaf {
            let mut hiding = lit.map_or(u8::MAX, |lit| list.hiding(lit));
            while hiding != 0 {
                let shape = list.shapes[hiding.trailing_zeros() as usize];
                if shape == NONE {
                    return false;
                }
                if shapes[usize::from(shape)].is_hit(ray, span) {
                    return true;
                }
                hiding &= hiding - 1;
            }
            leaf = fan.after(list);
        }
        false
    }
}

#[cfg(test)]
mod tests {
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

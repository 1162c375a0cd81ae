//! What an eye sees in each direction, so that its rays are tried against few shapes.

use super::fan::{Fan, NONE};
use super::fan_filling::Looks;
use super::outline::Outline;
use super::{Hit, Pyramid, Ray, Shape, Span};

/// A pyramid of view, and the shapes in each part of it.
#[derive(Clone, Debug)]
pub(crate) struct ViewFan {
    fan: Fan,
    /// For each shape a distance nearer than which it is not met.
    near_m: Vec<f32>,
}

impl ViewFan {
    /// The lists for an eye at the apex; `None` if they would be too long to be worth it.
    pub(crate) fn new(pyramid: &Pyramid, shapes: &[Shape]) -> Option<Self> {
        let outlines = Outline::from_apex(pyramid.apex, shapes);
        Some(Self {
            fan: Fan::new(pyramid, (shapes, &outlines), Looks::Out)?,
            near_m: outlines.iter().map(Outline::near_m).collect(),
        })
    }

    /// Names each shape that a ray from the apex through s and t may meet, as in [`Self::nearest`].
    #[inline]
    pub(crate) fn for_each_candidate(&self, (s, t): (f64, f64), mut name: impl FnMut(u32)) {
        let mut leaf = Some(self.fan.leaf(s, t));
        while let Some(list) = leaf {
            for index in list.shapes {
                if index == NONE {
                    return;
                }
                name(u32::from(index));
            }
            leaf = self.fan.after(list);
        }
    }

    /// The nearest hit of a ray from the apex through s and t, from 0 to 1 across and down the pyramid's
    /// base, and the index of the shape.
    #[inline]
    pub(crate) fn nearest(
        &self,
        (s, t): (f64, f64),
        ray: &Ray,
        shapes: &[Shape],
    ) -> Option<(u32, Hit)> {
        let mut nearest: Option<(u32, Hit)> = None;
        let mut span = Span::up_to(f64::INFINITY);
        let mut leaf = Some(self.fan.leaf(s, t));
        while let Some(list) = leaf {
            for index in list.shapes {
                if index == NONE {
                    return nearest;
                }
                if f64::from(self.near_m[usize::from(index)]) > span.to_m {
                    continue;
                }
                let Some(hit) = shapes[usize::from(index)].hit(ray, span) else {
                    continue;
                };
                let index = u32::from(index);
                let is_first = nearest.is_none_or(|(known, best)| {
                    hit.distance_m < best.distance_m
                        || (hit.distance_m == best.distance_m && index < known)
                });
                if is_first {
                    nearest = Some((index, hit));
                    // The next float, so that an equal hit of an earlier shape still counts.
                    span.to_m = hit.distance_m.next_up();
                }
            }
            leaf = self.fan.after(list);
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::super::Vector;
    use super::super::random_shapes::{Stream, by_trying_all, many};
    use super::*;

    #[test]
    fn an_eye_sees_what_trying_every_shape_finds() {
        let mut stream = Stream(4);
        let shapes: Vec<Shape> = many(&mut stream).into_iter().step_by(3).collect();
        let apex = Vector::new(2.9, -3.1, 2.7);
        let forward = (Vector::default() - apex).normalized();
        let right = forward.cross(Vector::UP).normalized();
        let (right, up) = (right * 0.4, right.cross(forward) * 0.3);
        let pyramid = Pyramid {
            apex,
            forward,
            right,
            up,
        };
        let view = ViewFan::new(&pyramid, &shapes).unwrap();
        let mut hits = 0;
        for _ in 0..20_000 {
            let (s, t) = (stream.unit(), stream.unit());
            let direction = forward + right * (2.0 * s - 1.0) + up * (1.0 - 2.0 * t);
            let ray = Ray {
                origin: apex,
                direction: direction.normalized(),
            };
            let nearest = by_trying_all(&shapes, &ray);
            assert_eq!(view.nearest((s, t), &ray, &shapes), nearest);
            hits += u32::from(nearest.is_some());
        }
        assert!(hits > 2_000, "only {hits} hits");
    }
}

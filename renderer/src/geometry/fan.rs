//! Rays from one place: for each of many narrow pyramids the shapes that a ray in it may meet, nearer first.
//!
//! The lists are too long rather than too short, so that what a ray finds is what trying every shape finds.
//!
//! Sources: Weghorst, Hooper & Greenberg (1984), the item buffer; Haines & Greenberg (1986), the light buffer.

use arrayvec::ArrayVec;

use super::{Hit, Ray, Shape, Span, Vector};

/// By how much shapes are thickened: a shadow ray starts 1e-6 m off the line from its surface to the light.
const MARGIN_M: f64 = 1e-5;
/// With longer lists on average a hierarchy of boxes is quicker.
const LONGEST_MEAN: usize = 24;

/// The balls whose convex hull holds a shape.
pub(crate) type Hull = ArrayVec<(Vector, f64), 8>;

/// A pyramid whose apex is the place of the rays: the directions `forward + s right + t up`, s and t from −1
/// to 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pyramid {
    pub(crate) apex: Vector,
    pub(crate) forward: Vector,
    pub(crate) right: Vector,
    pub(crate) up: Vector,
}

/// A pyramid cut into columns × rows of narrower ones, and the shapes in each.
#[derive(Clone, Debug)]
pub(crate) struct Fan {
    columns: u32,
    rows: u32,
    /// Row by row.
    cells: Vec<Cell>,
    /// The lists that are too long for a cell, each ended by [`NONE`].
    more: Vec<u16>,
    /// For each shape a distance nearer than which it is not met.
    near_m: Vec<f32>,
}

/// The shapes of a cell, nearer first. A quarter of a cache line, as most of the time goes into fetching it.
type Cell = [u16; 8];

/// No shape.
const NONE: u16 = u16::MAX;
/// In the last place of a cell: the first two places hold where its list starts among those too long.
const TOO_LONG: u16 = u16::MAX - 1;

/// A shape that may be met, and no nearer than this.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    near_m: f64,
    shape: u16,
}

/// A rectangle of cells: columns and rows from and up to but not including.
#[derive(Clone, Copy)]
struct Cells {
    columns: [u32; 2],
    rows: [u32; 2],
}

/// What is known of a shape from outside.
struct Outline {
    shape: u16,
    hull: Hull,
    /// A place and the normal of a flat shape; of an endless one there is nothing else.
    plane: Option<(Vector, Vector)>,
}

/// A fan while it is filled.
struct Filling<'a> {
    pyramid: &'a Pyramid,
    size: [u32; 2],
    /// Cell and candidate.
    found: Vec<(u32, Candidate)>,
    most: usize,
}

impl Fan {
    /// The lists for these shapes; `None` if they would be too long to be worth it.
    pub(crate) fn new(pyramid: &Pyramid, size: [u32; 2], shapes: &[Shape]) -> Option<Self> {
        let [columns, rows] = size;
        let count = columns as usize * rows as usize;
        let mut filling = Filling {
            pyramid,
            size,
            found: Vec::new(),
            most: LONGEST_MEAN * count,
        };
        if shapes.len() >= usize::from(TOO_LONG) {
            return None;
        }
        let whole = Cells {
            columns: [0, columns],
            rows: [0, rows],
        };
        let mut near_m = Vec::with_capacity(shapes.len());
        for (shape, one) in (0..).zip(shapes) {
            let outline = Outline {
                shape,
                hull: one.hull(),
                plane: one.plane(),
            };
            near_m.push(one.bounds().map_or(0.0, |bounds| {
                let distance_m = bounds.distance_m(pyramid.apex) - MARGIN_M;
                single(distance_m * (1.0 - 1e-6))
            }));
            filling.fill(&outline, whole);
            if filling.found.len() > filling.most {
                return None;
            }
        }
        let mut fan = Self {
            columns,
            rows,
            cells: vec![[NONE; 8]; count],
            more: Vec::new(),
            near_m,
        };
        fan.store(filling.found)?;
        Some(fan)
    }

    /// Puts candidates into their cells; `None` if there are too many.
    fn store(&mut self, mut found: Vec<(u32, Candidate)>) -> Option<()> {
        found.sort_unstable_by(|(cell, one), (other_cell, other)| {
            let by_distance = one.near_m.total_cmp(&other.near_m);
            let by_cell = cell.cmp(other_cell);
            by_cell.then(by_distance).then(one.shape.cmp(&other.shape))
        });
        for list in found.chunk_by(|one, other| one.0 == other.0) {
            let cell = &mut self.cells[list[0].0 as usize];
            let shapes = list.iter().map(|(_, candidate)| candidate.shape);
            if list.len() <= cell.len() {
                for (place, shape) in cell.iter_mut().zip(shapes) {
                    *place = shape;
                }
            } else {
                let start = u32::try_from(self.more.len()).ok()?;
                cell[0] = u16::try_from(start >> 16).ok()?;
                cell[1] = u16::try_from(start & 0xffff).ok()?;
                cell[7] = TOO_LONG;
                self.more.extend(shapes.chain([NONE]));
            }
        }
        Some(())
    }

    /// The list of the cell at s and t from 0 to 1 across and down the pyramid's base, ended by its end or by
    /// [`NONE`].
    #[inline]
    fn candidates(&self, s: f64, t: f64) -> &[u16] {
        let column = cell(s * f64::from(self.columns)).min(self.columns - 1);
        let row = cell(t * f64::from(self.rows)).min(self.rows - 1);
        let cell = &self.cells[(row * self.columns + column) as usize];
        if cell[7] == TOO_LONG {
            &self.more[(usize::from(cell[0]) << 16) | usize::from(cell[1])..]
        } else {
            cell
        }
    }

    /// The nearest hit of a ray from the apex through (s, t), and the index of the shape.
    #[inline]
    pub(crate) fn nearest(
        &self,
        (s, t): (f64, f64),
        ray: &Ray,
        shapes: &[Shape],
    ) -> Option<(u32, Hit)> {
        let mut nearest: Option<(u32, Hit)> = None;
        let mut span = Span::up_to(f64::INFINITY);
        for &index in self.candidates(s, t) {
            if index == NONE {
                break;
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
        nearest
    }

    /// Whether a ray that ends at the apex after `span` and comes through (s, t) hits anything.
    #[inline]
    pub(crate) fn is_blocked(
        &self,
        (s, t): (f64, f64),
        ray: &Ray,
        span: Span,
        shapes: &[Shape],
    ) -> bool {
        let candidates = self.candidates(s, t).iter();
        candidates
            .take_while(|&&index| index != NONE)
            .map(|&index| usize::from(index))
            .filter(|&index| f64::from(self.near_m[index]) <= span.to_m)
            .any(|index| shapes[index].is_hit(ray, span))
    }
}

impl Filling<'_> {
    /// Adds a shape to the cells of a rectangle that it may be seen in.
    fn fill(&mut self, outline: &Outline, cells: Cells) {
        let corners = self.corners(cells);
        if outline.is_outside(self.pyramid.apex, &corners) || self.found.len() > self.most {
            return;
        }
        let [columns, rows] = [cells.columns, cells.rows];
        let halves = |[from, to]: [u32; 2]| {
            let middle = from.midpoint(to);
            [[from, middle], [middle, to]]
        };
        if columns[1] - columns[0] == 1 && rows[1] - rows[0] == 1 {
            let near_m = outline.near_m(self.pyramid.apex, &corners);
            let candidate = Candidate {
                near_m,
                shape: outline.shape,
            };
            self.found
                .push((rows[0] * self.size[0] + columns[0], candidate));
        } else if columns[1] - columns[0] >= rows[1] - rows[0] {
            for columns in halves(columns) {
                self.fill(outline, Cells { columns, rows });
            }
        } else {
            for rows in halves(rows) {
                self.fill(outline, Cells { columns, rows });
            }
        }
    }

    /// The directions through the corners of a rectangle of cells, one after another round it.
    fn corners(&self, cells: Cells) -> [Vector; 4] {
        let Pyramid {
            forward, right, up, ..
        } = *self.pyramid;
        let [columns, rows] = self.size.map(f64::from);
        let [left, other] = cells.columns.map(|c| 2.0 * f64::from(c) / columns - 1.0);
        let [top, bottom] = cells.rows.map(|r| 1.0 - 2.0 * f64::from(r) / rows);
        let direction = |s: f64, t: f64| forward + right * s + up * t;
        [
            direction(left, top),
            direction(other, top),
            direction(other, bottom),
            direction(left, bottom),
        ]
    }
}

impl Outline {
    /// Whether the shape is wholly beyond one of the pyramid's sides.
    fn is_outside(&self, apex: Vector, corners: &[Vector; 4]) -> bool {
        let middle = corners.iter().fold(Vector::default(), |sum, &c| sum + c);
        if self.hull.is_empty() {
            let is_away = |(place, normal): (Vector, Vector)| {
                let rise = (place - apex).dot(normal);
                corners.iter().all(|c| c.dot(normal) * rise < 0.0)
            };
            return self.plane.is_some_and(is_away);
        }
        (0..4).any(|side| {
            let across = corners[side].cross(corners[(side + 1) % 4]);
            let inwards = across * across.dot(middle).signum();
            let margin = inwards.length();
            let mut balls = self.hull.iter();
            balls.all(|&(center, radius_m)| {
                (center - apex).dot(inwards) < -(radius_m + MARGIN_M) * margin
            })
        })
    }

    /// No ray of the pyramid meets the shape nearer than this.
    ///
    /// A place at the distance d in a direction of the pyramid is at most d along its axis.
    fn near_m(&self, apex: Vector, corners: &[Vector; 4]) -> f64 {
        let middle = corners.iter().fold(Vector::default(), |sum, &c| sum + c);
        let axis = middle.normalized();
        let along = |&(center, radius_m): &(Vector, f64)| (center - apex).dot(axis) - radius_m;
        let of_hull = self.hull.iter().map(along).fold(f64::INFINITY, f64::min);
        let of_hull = if self.hull.is_empty() { 0.0 } else { of_hull };
        let of_plane = self.plane.map_or(0.0, |(place, normal)| {
            let rise = (place - apex).dot(normal);
            let depths = corners.map(|corner| rise / corner.dot(normal) * corner.dot(axis));
            if depths.iter().all(|&depth| depth > 0.0) {
                depths.into_iter().fold(f64::INFINITY, f64::min)
            } else {
                0.0
            }
        });
        let near_m = of_hull.max(of_plane) - MARGIN_M;
        near_m * (1.0 - 1e-9)
    }
}

/// The six pyramids round a place: what stands between it and any other place.
#[derive(Clone, Debug)]
pub(crate) struct RoundFan {
    faces: Vec<Fan>,
}

impl RoundFan {
    /// The lists round a place, with `side` × `side` cells in each of six pyramids; `None` as for a fan.
    pub(crate) fn new(apex: Vector, side: u32, shapes: &[Shape]) -> Option<Self> {
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
        let faces = axes.map(|(forward, right, up)| {
            let pyramid = Pyramid {
                apex,
                forward,
                right,
                up,
            };
            Fan::new(&pyramid, [side; 2], shapes)
        });
        let faces: Option<Vec<Fan>> = faces.into_iter().collect();
        faces.map(|faces| Self { faces })
    }

    /// Whether a ray towards the place, which it reaches at the end of the span, hits anything before.
    #[inline]
    pub(crate) fn is_blocked(&self, ray: &Ray, span: Span, shapes: &[Shape]) -> bool {
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
        self.faces[face].is_blocked(at, ray, span, shapes)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place on a grid; what rounding puts before the first cell saturates at it"
)]
fn cell(place: f64) -> u32 {
    place as u32
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded after being made too small"
)]
fn single(value: f64) -> f32 {
    value as f32
}

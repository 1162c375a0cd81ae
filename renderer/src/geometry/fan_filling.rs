//! How the lists of a fan are made: from wide pyramids to narrow ones, each trying only the shapes of the one
//! that holds it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::fan::{Fan, LEAF, Leaf, MAX_LEVELS, NONE, Part, WIDTH};
use super::outline::{Outline, Reach};
use super::pyramid::{Grid, Pyramid, Square};
use super::{Ray, Shape, Span, Vector};

/// With longer lists on average a hierarchy of boxes is quicker.
const LONGEST_MEAN: f64 = 24.0;
/// After this many trials of shapes no more pyramids are parted.
const MOST_TRIALS: usize = 1 << 18;
/// Nor after so many lists; this leaves room for those that are not parted then.
const MOST_LEAVES: usize = 1 << 14;
/// A pyramid in which an eye or a shadow ray tries so many shapes is not parted: narrower ones gain less than
/// they cost.
const FEW_SEEN: usize = 2;
const FEW_HIDING: usize = 1;
/// Among more shapes than this hardly one covers the others.
const MOST_COVERING: usize = 16;
/// No more squares within squares for an eye, whose rays mostly meet what their pyramid holds.
const VIEW_LEVELS: u32 = 3;

/// What is asked of a fan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Looks {
    /// What an eye at the apex sees.
    Out,
    /// What stands in the light of a lamp at the apex.
    Shadows,
}

impl Looks {
    /// So many squares within squares.
    const fn levels(self) -> u32 {
        match self {
            Self::Out => VIEW_LEVELS,
            Self::Shadows => MAX_LEVELS,
        }
    }
}

/// A shape that may be met in a pyramid.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    shape: u16,
    reach: Reach,
    /// Whether every ray of the pyramid meets it.
    covers: bool,
}

/// A fan while it is filled.
struct Filling<'a> {
    grid: Grid,
    shapes: &'a [Shape],
    outlines: &'a [Outline],
    looks: Looks,
    fan: Fan,
    /// The leaves by what is in them.
    known: BTreeMap<Leaf, Part>,
    /// The candidates of the pyramids that are being parted, those of the narrowest last.
    stack: Vec<Candidate>,
    trials: usize,
    /// The length of the lists, each by the part of the whole that it is for.
    mean: f64,
}

impl Fan {
    /// The lists for shapes with these outlines from the apex of the pyramid; `None` if they would be too
    /// long to be worth it.
    pub(super) fn new(
        pyramid: &Pyramid,
        (shapes, outlines): (&[Shape], &[Outline]),
        looks: Looks,
    ) -> Option<Self> {
        if shapes.len() >= usize::from(NONE) {
            return None;
        }
        let everywhere = Reach {
            near_m: 0.0,
            far_m: f64::INFINITY,
        };
        let all = (0..).zip(shapes).map(|(shape, _)| Candidate {
            shape,
            reach: everywhere,
            covers: false,
        });
        let mut filling = Filling {
            grid: Grid::new(pyramid, 1 << (2 * looks.levels())),
            shapes,
            outlines,
            looks,
            fan: Self {
                nodes: Vec::new(),
                leaves: vec![Leaf::EMPTY],
            },
            known: BTreeMap::new(),
            stack: all.collect(),
            trials: 0,
            mean: 0.0,
        };
        let root = filling.part(Square::WHOLE, 0, 0)?;
        if root & LEAF != 0 {
            filling.fan.nodes.push([root; 16]);
        }
        (filling.mean <= LONGEST_MEAN).then_some(filling.fan)
    }
}

impl Filling<'_> {
    /// Parts a square whose candidates begin at this place of the stack; `None` if there are too many lists.
    fn part(&mut self, square: Square, level: u32, start: usize) -> Option<Part> {
        let end = self.stack.len();
        let node = self.fan.nodes.len();
        self.fan.nodes.push([LEAF; 16]);
        for (part, square) in square.parts(4).enumerate() {
            self.find(square, start..end);
            let is_last = level + 1 == self.looks.levels()
                || self.trials > MOST_TRIALS
                || self.fan.leaves.len() > MOST_LEAVES;
            self.fan.nodes[node][part] = if is_last || self.is_told_apart(end) {
                self.leaf(square, end)?
            } else {
                self.part(square, level + 1, end)?
            };
            self.stack.truncate(end);
        }
        let parts = self.fan.nodes[node];
        if parts[0] & LEAF != 0 && parts == [parts[0]; 16] {
            self.fan.nodes.pop();
            return Some(parts[0]);
        }
        named(node)
    }

    /// Puts those of the candidates on the stack that a ray of a square may meet before one that it must.
    fn find(&mut self, square: Square, candidates: Range<usize>) {
        let pyramid = self.grid.within(square);
        let start = self.stack.len();
        self.trials += candidates.len();
        for place in candidates {
            let candidate = self.stack[place];
            if let Some(reach) = self.outlines[usize::from(candidate.shape)].within(&pyramid) {
                self.stack.push(Candidate { reach, ..candidate });
            }
        }
        if !(2..=MOST_COVERING).contains(&(self.stack.len() - start)) {
            return;
        }
        let beyond = self.grid.beyond(square);
        let mut covered_m = f64::INFINITY;
        for place in start..self.stack.len() {
            let Candidate {
                shape,
                reach,
                covers,
            } = self.stack[place];
            if covers || self.covers(shape, &beyond) {
                self.stack[place].covers = true;
                covered_m = covered_m.min(reach.far_m);
            }
        }
        let mut kept = start;
        for place in start..self.stack.len() {
            if self.stack[place].reach.near_m <= covered_m {
                self.stack.swap(kept, place);
                kept += 1;
            }
        }
        self.stack.truncate(kept);
    }

    /// Whether every ray of a square meets a shape, given directions a little outside its corners.
    fn covers(&self, shape: u16, beyond: &[Vector; 4]) -> bool {
        let shape = &self.shapes[usize::from(shape)];
        let origin = self.grid.apex();
        shape.is_convex()
            && beyond
                .iter()
                .all(|&direction| shape.is_hit(&Ray { origin, direction }, COVERING))
    }

    /// Whether narrower pyramids would hardly have less to try.
    fn is_told_apart(&self, start: usize) -> bool {
        let candidates = &self.stack[start..];
        match self.looks {
            Looks::Out => candidates.len() <= FEW_SEEN,
            Looks::Shadows => self.most_hiding(candidates, FEW_HIDING + 1) <= FEW_HIDING,
        }
    }

    /// How many of the candidates may stand in the light of one of them, at most; no more than `enough`.
    fn most_hiding(&self, candidates: &[Candidate], enough: usize) -> usize {
        let mut most = 0;
        for lit in candidates {
            let hiding = candidates.iter().filter(|other| self.may_hide(other, lit));
            most = most.max(hiding.take(enough).count());
            if most == enough {
                break;
            }
        }
        most
    }

    fn may_hide(&self, candidate: &Candidate, lit: &Candidate) -> bool {
        let [outline, lit_outline] =
            [candidate, lit].map(|one| &self.outlines[usize::from(one.shape)]);
        outline.may_hide(candidate.reach, lit_outline, lit.reach)
    }

    /// The leaf of the candidates from this place of the stack on.
    fn leaf(&mut self, square: Square, start: usize) -> Option<Part> {
        let side = f64::from(square.side);
        let mut candidates = self.stack.split_off(start);
        self.mean += candidates.len() as f64 / (side * side);
        candidates.sort_unstable_by(|one, other| {
            let by_distance = one.reach.near_m.total_cmp(&other.reach.near_m);
            by_distance.then(one.shape.cmp(&other.shape))
        });
        // The last part of the list first, so that each knows where it goes on.
        let mut more = 0;
        for list in candidates.chunks(WIDTH).rev() {
            let mut leaf = Leaf::EMPTY;
            leaf.more = u32::from(more);
            for (slot, candidate) in leaf.shapes.iter_mut().zip(list) {
                *slot = candidate.shape;
            }
            if self.looks == Looks::Shadows {
                leaf.hiding = self.hiding(&candidates, list);
            }
            more = self.place(leaf)?;
        }
        Some(LEAF | more)
    }

    /// For each shape of a part of a list which others may stand in its light: any, if they are not all here.
    fn hiding(&self, candidates: &[Candidate], list: &[Candidate]) -> [u8; WIDTH] {
        let mut hiding = [0; WIDTH];
        for (lit, hiding) in list.iter().zip(&mut hiding) {
            for (slot, other) in list.iter().enumerate() {
                let may_hide = list.len() < candidates.len() || self.may_hide(other, lit);
                *hiding |= u8::from(may_hide) << slot;
            }
        }
        hiding
    }

    /// The place of a leaf, which is put there if none is like it; `None` if there are too many.
    fn place(&mut self, leaf: Leaf) -> Option<Part> {
        if let Some(&place) = self.known.get(&leaf) {
            return Some(place);
        }
        let place = named(self.fan.leaves.len())?;
        self.known.insert(leaf, place);
        self.fan.leaves.push(leaf);
        Some(place)
    }
}

/// Where a shape that covers a pyramid is met: not so near that a shadow ray, which starts 1e-6 m off its line,
/// might pass it by.
const COVERING: Span = Span {
    from_m: 0.1,
    to_m: f64::INFINITY,
};

fn named(place: usize) -> Option<Part> {
    Part::try_from(place).ok().filter(|place| place & LEAF == 0)
}

//! A binary tree of boxes, split from the top.
//!
//! A set of things is split across the axis and the place at which a ray is expected to do the least: each
//! half is met in proportion to its area, and then costs as many visits as leaves of it can be filled. This
//! fills leaves better than joining neighbours from below.
//!
//! Source: Wald (2007), "On fast construction of SAH-based bounding volume hierarchies".

/// How many places for a split are tried across each axis, and one more.
const BINS: usize = 24;

/// A box in single precision: its lower and its upper corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SingleBox {
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

/// A node with two more, or a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SplitNode {
    pub(crate) bounds: SingleBox,
    /// The first of two nodes, or of the places of a leaf.
    pub(crate) first: usize,
    /// How many places a leaf has; 0 for a node.
    pub(crate) count: usize,
}

/// The nodes, the root first.
#[derive(Clone, Debug, Default)]
pub(crate) struct SplitTree {
    pub(crate) nodes: Vec<SplitNode>,
    /// The numbers of the things, leaf by leaf.
    pub(crate) order: Vec<u32>,
    /// How many things a leaf holds at most.
    pub(crate) most_in_leaf: usize,
}

/// A thing to be put into a leaf.
#[derive(Clone, Copy)]
struct Item {
    bounds: SingleBox,
    /// Twice the middle of the box.
    center: [f32; 3],
    thing: u32,
}

/// The things whose middles are between two neighbouring places for a split.
#[derive(Clone, Copy)]
struct Bin {
    bounds: SingleBox,
    count: usize,
}

/// Where to split: across an axis, after a bin.
#[derive(Clone, Copy)]
struct Place {
    axis: usize,
    after: usize,
    cost: f32,
}

impl SingleBox {
    /// The box of nothing.
    pub(crate) const NOTHING: Self = Self {
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
    };

    /// The box that holds both.
    #[inline]
    pub(crate) fn joined(&self, other: &Self) -> Self {
        let smaller = |a: f32, b: f32| if a < b { a } else { b };
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let ([a, b, c], [d, e, f]) = (self.low, other.low);
        let ([g, h, i], [j, k, l]) = (self.high, other.high);
        Self {
            low: [smaller(a, d), smaller(b, e), smaller(c, f)],
            high: [larger(g, j), larger(h, k), larger(i, l)],
        }
    }

    /// Half of the area of its sides.
    #[inline]
    pub(crate) fn half_area(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.high[axis] - self.low[axis]);
        x * y + y * z + z * x
    }
}

impl SplitTree {
    /// The tree over things with these boxes, at least one, and with at most so many in a leaf.
    pub(crate) fn over(boxes: &[SingleBox], most_in_leaf: usize) -> Self {
        let item = |(thing, bounds): (u32, &SingleBox)| Item {
            bounds: *bounds,
            center: [0, 1, 2].map(|axis| bounds.low[axis] + bounds.high[axis]),
            thing,
        };
        let mut items: Vec<Item> = (0..).zip(boxes).map(item).collect();
        let mut tree = Self {
            most_in_leaf,
            ..Self::default()
        };
        tree.nodes.push(SplitNode {
            bounds: SingleBox::NOTHING,
            first: 0,
            count: 0,
        });
        tree.split(&mut items, 0, 0);
        tree.order = items.iter().map(|item| item.thing).collect();
        tree
    }

    /// Makes the node of these items, which begin at a place, and all below it.
    fn split(&mut self, items: &mut [Item], place: usize, at: usize) {
        let all = items.iter().map(|item| item.bounds);
        let bounds = all.fold(SingleBox::NOTHING, |one, other| one.joined(&other));
        if items.len() <= self.most_in_leaf {
            self.nodes[at] = SplitNode {
                bounds,
                first: place,
                count: items.len(),
            };
            return;
        }
        let first = self.nodes.len();
        let node = SplitNode {
            bounds,
            first,
            count: 0,
        };
        self.nodes[at] = node;
        self.nodes.extend([node, node]);
        let middle = parted(items, self.most_in_leaf);
        let (left, right) = items.split_at_mut(middle);
        self.split(left, place, first);
        self.split(right, place + middle, first + 1);
    }
}

/// Sorts the items into two parts, neither empty, and says where the second begins.
fn parted(items: &mut [Item], most_in_leaf: usize) -> usize {
    let points = items.iter().map(|item| SingleBox {
        low: item.center,
        high: item.center,
    });
    let centers = points.fold(SingleBox::NOTHING, |one, other| one.joined(&other));
    let bin = |item: &Item, axis: usize| {
        let width = centers.high[axis] - centers.low[axis];
        bin_at((item.center[axis] - centers.low[axis]) / width)
    };
    let mut bins = [[Bin {
        bounds: SingleBox::NOTHING,
        count: 0,
    }; BINS]; 3];
    for item in &*items {
        for (axis, bins) in bins.iter_mut().enumerate() {
            let bin = &mut bins[bin(item, axis)];
            bin.bounds = bin.bounds.joined(&item.bounds);
            bin.count += 1;
        }
    }
    let places = (0..3).filter_map(|axis| best_place(&bins[axis], axis, most_in_leaf));
    let best = places.min_by(|one, other| one.cost.total_cmp(&other.cost));
    let Some(best) = best else {
        return items.len() / 2;
    };
    let mut middle = 0;
    for place in 0..items.len() {
        if bin(&items[place], best.axis) <= best.after {
            items.swap(place, middle);
            middle += 1;
        }
    }
    middle
}

/// The bin at a share of the width of all bins; the first one if that is not a number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounding down is meant, and what is below 0 or no number at all becomes 0"
)]
fn bin_at(share: f32) -> usize {
    ((share * BINS as f32) as usize).min(BINS - 1)
}

/// The best place between the bins of an axis, if there is one with things on both sides.
fn best_place(bins: &[Bin; BINS], axis: usize, most_in_leaf: usize) -> Option<Place> {
    let nothing = Bin {
        bounds: SingleBox::NOTHING,
        count: 0,
    };
    let joined = |one: &mut Bin, other: &Bin| {
        one.bounds = one.bounds.joined(&other.bounds);
        one.count += other.count;
    };
    let cost = |bin: &Bin| bin.bounds.half_area() * bin.count.div_ceil(most_in_leaf) as f32;
    let mut above = [nothing; BINS];
    for after in (0..BINS - 1).rev() {
        above[after] = above[after + 1];
        joined(&mut above[after], &bins[after + 1]);
    }
    let mut below = nothing;
    let places = (0..BINS - 1).filter_map(|after| {
        joined(&mut below, &bins[after]);
        let is_split = below.count > 0 && above[after].count > 0;
        is_split.then(|| Place {
            axis,
            after,
            cost: cost(&below) + cost(&above[after]),
        })
    });
    places.min_by(|one, other| one.cost.total_cmp(&other.cost))
}

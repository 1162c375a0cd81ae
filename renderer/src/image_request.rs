//! What one image is made from, and whether it can be made.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use protocols::{
    Channel, ChannelGroup, Export, InputError, PerChannel, Quadrature, RayCount, RefinementDriver,
    Rendering, TreePlan,
};

use crate::account::RayAccount;
use crate::acuity_limits::AcuityLimits;
use crate::cell::Cell;
use crate::confidence::Confidence;
use crate::refine::TracePlan;
use crate::screen_tree::{Reach, ScreenTree};

/// One image: its size, its ray counts and how its tree is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageRequest {
    /// How many rays make A.
    pub rays_a: RayCount,
    /// How many rays make C1 and C2.
    pub rays_c1c2: RayCount,
    /// Below these depths of the tree a channel is neither shaded nor stored: p, q and r of section 3.3.
    pub stop_depths: PerChannel<Option<u32>>,
    /// Width and height.
    pub size_px: [u32; 2],
    /// The seed of the sample positions.
    pub seed: u64,
    /// At which wavelengths light is carried.
    pub quadrature: Quadrature,
    /// How the tree is refined.
    pub tree: TreePlan,
    /// Which further files are made.
    pub exports: Vec<Export>,
    /// How many threads; one for each core if not said. The image is the same with any number.
    pub threads: Option<NonZeroUsize>,
    /// How well every region is to be known; the ray counts are then the most that may be taken.
    pub until: Option<Confidence>,
    /// Where to write the map of its samples, as a picture (`.png`) or as numbers (`.exr`).
    pub samples_maps: Vec<PathBuf>,
}

impl ImageRequest {
    /// The request for an image of a study, whose `[acuity]` says how deep each channel goes.
    pub fn of_study(study: Rendering<'_>, rays_a: RayCount, rays_c1c2: RayCount) -> Self {
        let Rendering {
            plan,
            viewing,
            acuity,
        } = study;
        let limits = acuity.map(|acuity| AcuityLimits::new(acuity, viewing, plan.size_px));
        Self {
            rays_a,
            rays_c1c2,
            stop_depths: limits.map_or_else(PerChannel::default, |limits| limits.stop_depths()),
            size_px: plan.size_px,
            seed: plan.seed,
            quadrature: plan.quadrature,
            tree: plan.tree.clone(),
            exports: plan.export.clone(),
            threads: None,
            until: None,
            samples_maps: Vec::new(),
        }
    }

    /// How many rays make a channel.
    pub const fn rays(&self, channel: Channel) -> RayCount {
        match channel.group() {
            ChannelGroup::Achromatic => self.rays_a,
            ChannelGroup::Chromatic => self.rays_c1c2,
        }
    }

    /// How far into the tree a channel's image goes.
    pub fn reach(&self, channel: Channel) -> Reach {
        Reach {
            rays: self.rays(channel).as_usize(),
            depth: self.stop_depths[channel].unwrap_or(Cell::DEEPEST),
        }
    }

    /// How the tree of this image is made.
    pub fn trace_plan(&self) -> TracePlan {
        TracePlan {
            seed: self.seed,
            size_px: self.size_px,
            min_depth: self.tree.min_depth,
            driver: self.tree.driver,
            stops: PerChannel::from_fn(|channel| self.reach(channel)),
            until: self.until,
        }
    }

    /// What the image costs on its own, counted in a tree of which its own is the beginning.
    ///
    /// A channel that drives alone is shaded wherever a ray goes, even beyond its own image.
    pub fn account_in(&self, tree: &ScreenTree) -> RayAccount {
        let rays = self.rays_a.max(self.rays_c1c2).as_usize().min(tree.len());
        let shadings = PerChannel::from_fn(|channel| {
            let drives_alone = self.tree.driver == RefinementDriver::A && channel == Channel::A;
            if drives_alone {
                rays as u64
            } else {
                tree.leaf_count(self.reach(channel)) as u64
            }
        });
        RayAccount {
            intersections: rays as u64,
            shadings,
        }
    }

    /// How many rectangles each channel's image is filtered from, counted in the same way.
    pub fn rectangles_in(&self, tree: &ScreenTree) -> PerChannel<u64> {
        PerChannel::from_fn(|channel| tree.leaf_count(self.reach(channel)) as u64)
    }

    /// About how much memory it takes to make the image: 64 bytes a ray at most, and at most 48 a pixel for
    /// the three channels, the sums of their filters, the picture and the file.
    pub fn memory_bytes(&self) -> u64 {
        let rays = u64::from(self.rays_a.max(self.rays_c1c2).get());
        let [width, height] = self.size_px.map(u64::from);
        64 * rays + 48 * width * height
    }

    /// Refuses a request that contradicts itself; `scene` is only named in errors.
    ///
    /// # Errors
    ///
    /// The image has no pixels or too many, a ray count does not fill the minimum depth, a depth cannot be
    /// or a channel would go deeper than those that drive the refinement.
    pub fn check(&self, scene: &Path) -> Result<(), InputError> {
        let wrong = |place: &str, found: String, expected: &str| {
            Err(InputError::new(scene, found, expected).at(place.to_owned()))
        };
        let [width, height] = self.size_px;
        if !self.size_px.iter().all(|size| (1..=16_384).contains(size)) {
            let expected = "a width and a height from 1 to 16384 pixels";
            return wrong("size", format!("{width}x{height}"), expected);
        }
        let min_depth = self.tree.min_depth;
        if !(1..=12).contains(&min_depth) {
            return wrong(
                "minimum depth",
                min_depth.to_string(),
                "a depth from 1 to 12",
            );
        }
        let most = self.rays_a.max(self.rays_c1c2);
        if most.get() > ScreenTree::MOST_SAMPLES {
            let expected = format!("at most {} rays", ScreenTree::MOST_SAMPLES);
            return wrong("ray count", format!("{most} rays"), &expected);
        }
        let cells = 1_u32 << min_depth;
        let fewest = self.rays_a.min(self.rays_c1c2);
        if fewest.get() < cells {
            let found = format!("{fewest} rays and a minimum depth of {min_depth} ({cells} cells)");
            let expected = "at least one ray for each cell of the minimum depth";
            return wrong("ray count", found, expected);
        }
        if let Some(Confidence { channel, .. }) = self.until
            && channel != Channel::A
            && (self.rays(channel) < most || self.stop_depths[channel].is_some())
        {
            let found = format!("the means of {channel} to be known, which stops before A");
            let expected = "a channel that is shaded wherever a ray goes";
            return wrong("confidence", found, expected);
        }
        self.check_depths()
            .or_else(|(found, expected)| wrong("stop depth", found, expected))
    }

    fn check_depths(&self) -> Result<(), (String, &'static str)> {
        let depth = |channel| self.reach(channel).depth;
        for channel in Channel::ALL {
            let depth = depth(channel);
            if !(1..=Cell::DEEPEST).contains(&depth) {
                return Err((format!("{depth} for {channel}"), "a depth from 1 to 48"));
            }
        }
        let of_a = depth(Channel::A);
        let asked = [self.stop_depths.c1, self.stop_depths.c2]
            .into_iter()
            .flatten()
            .max();
        if let Some(chromatic) = asked
            && self.tree.driver == RefinementDriver::A
            && chromatic > of_a
        {
            return Err((
                format!("{chromatic} for a chromatic channel and {of_a} for A"),
                "chromatic channels no deeper than A, which says where to go",
            ));
        }
        if of_a < self.tree.min_depth {
            return Err((
                format!(
                    "{of_a} for A and a minimum depth of {}",
                    self.tree.min_depth
                ),
                "A at least as deep as the minimum depth",
            ));
        }
        Ok(())
    }
}

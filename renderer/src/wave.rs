//! Many samples side by side: all rays of the camera, then all that these sent on, and so forth.
//!
//! Promises what following each sample alone gives, bit for bit. A ray waits for nothing but its own past, so
//! that a processor has something to do while another ray waits for memory or for a division; and rays that
//! met the same shape stand together.
//!
//! Samples that meet glass, where a ray goes on as two, are followed alone.

use crate::beam::{Beam, Beams};
use crate::geometry::{Departure, Flock, Found, ShapeQueues};
use crate::lighting::Lit;
use crate::ray_tree::RayTree;
use crate::sampler::{Sampler as _, ScreenPoint};
use crate::scene::material::Mirror;
use crate::scene_sampler::{Encounter, SceneSampler};
use crate::shadows::Shadows;

/// Among more shapes rays are followed alone, the nearest shapes first.
const MOST_SHAPES: usize = 4096;

/// The rays on their way, each with the sample that it belongs to; the memory is used again.
#[derive(Clone, Debug, Default)]
pub(crate) struct Wave {
    beams: Vec<(u32, Beam)>,
    found: Vec<Found>,
    encounters: Vec<(u32, Encounter)>,
    /// The rays that go on from the encounters.
    next: Vec<(u32, Beam)>,
    /// What each light brings to all of the encounters, light after light.
    lits: Vec<Lit>,
    /// The samples that are to be followed alone.
    alone: Vec<u32>,
    queues: ShapeQueues,
    flock: Flock,
    shadows: Shadows,
}

impl Wave {
    /// [`crate::Sampler::intersect_all`].
    pub(crate) fn intersect(
        &mut self,
        sampler: &SceneSampler<'_>,
        points: &[ScreenPoint],
        trees: &mut [RayTree],
    ) {
        let samples = (0_u32..).zip(points);
        if sampler.shapes().shapes().len() > MOST_SHAPES {
            self.alone.extend(samples.map(|(sample, _)| sample));
        } else {
            trees.iter_mut().for_each(RayTree::clear);
            let beams = samples.map(|(sample, &at)| (sample, sampler.camera_beam(at)));
            self.beams.extend(beams);
        }
        while !self.beams.is_empty() {
            self.find(sampler, points);
            self.meet(sampler, points, trees);
            self.light(sampler, trees);
            self.beams.clear();
            std::mem::swap(&mut self.beams, &mut self.next);
        }
        for sample in self.alone.drain(..) {
            let sample = sample as usize;
            sampler.intersect(points[sample], &mut trees[sample]);
        }
    }

    /// Finds what each ray meets.
    fn find(&mut self, sampler: &SceneSampler<'_>, points: &[ScreenPoint]) {
        let Self {
            beams,
            found,
            queues,
            flock,
            ..
        } = self;
        let shapes = sampler.shapes();
        queues.make_room(shapes.shapes().len());
        found.clear();
        found.resize(beams.len(), None);
        let rays = (0_u32..).zip(&*beams);
        match sampler.view() {
            Some(view) if beams.first().is_some_and(|(_, beam)| beam.depth == 1) => {
                for (place, (sample, _)) in rays {
                    let at = points[*sample as usize];
                    view.for_each_candidate((at.x, at.y), |shape| queues.add(shape, place));
                }
            }
            _ => {
                let rays = rays.map(|(place, (_, beam))| (place, &beam.departure.ray));
                shapes.queue(rays, (flock, queues));
            }
        }
        let departure = |place: u32| -> &Departure { &beams[place as usize].1.departure };
        queues.find_nearest(shapes.shapes(), departure, found);
    }

    /// Looks at what the rays met, shape after shape.
    fn meet(&mut self, sampler: &SceneSampler<'_>, points: &[ScreenPoint], trees: &mut [RayTree]) {
        let Self {
            beams,
            found,
            encounters,
            next,
            alone,
            queues,
            shadows,
            ..
        } = self;
        for (place, found) in (0_u32..).zip(&*found) {
            if let Some((shape, _)) = found {
                queues.add(*shape, place);
            }
        }
        encounters.clear();
        let surfaces = &mut shadows.surfaces;
        surfaces.clear();
        let mut sent = Beams::new();
        queues.empty(|shape, queue| {
            if matches!(sampler.material(shape).mirror, Some(Mirror::Glass { .. })) {
                alone.extend(queue.iter().map(|&place| beams[place as usize].0));
                return;
            }
            for &place in queue {
                let place = place as usize;
                let (sample, beam) = &beams[place];
                let (at, tree) = (points[*sample as usize], &mut trees[*sample as usize]);
                let Some(hit) = found[place] else {
                    continue;
                };
                let encounter = sampler.meet(beam, hit, at, (tree, &mut sent));
                if let Some(encounter) = encounter {
                    surfaces.push(&encounter.lighted.surface);
                    encounters.push((*sample, encounter));
                }
                for &beam in &sent {
                    next.push((*sample, beam));
                }
                sent.clear();
            }
        });
    }

    /// Gathers the light that falls on what was met.
    fn light(&mut self, sampler: &SceneSampler<'_>, trees: &mut [RayTree]) {
        let Self {
            encounters,
            lits,
            shadows,
            ..
        } = self;
        lits.clear();
        for light in 0..sampler.lighting().lights() {
            let lighted = encounters.iter().map(|(_, encounter)| &encounter.lighted);
            sampler.lighting().lit_all(light, lighted, shadows, lits);
        }
        for (place, (sample, encounter)) in encounters.iter().enumerate() {
            let lit = |light: u16| lits[usize::from(light) * encounters.len() + place];
            sampler.scatter(encounter, &mut trees[*sample as usize], lit);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use protocols::Quadrature;

    use super::*;
    use crate::scene::Scene;

    /// The scene of a file beside the study's.
    fn scene(name: &str) -> Scene {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../stimuli/scenes");
        Scene::read(&folder.join(name)).unwrap()
    }

    /// Places all over the screen, in no order.
    fn points(count: u32) -> Vec<ScreenPoint> {
        let part = |number: u32| f64::from(number) / 4_294_967_296.0;
        let numbers = 0..count;
        let point = |n: u32| ScreenPoint {
            x: part(n.wrapping_mul(0x9e37_79b9)),
            y: part(n.wrapping_mul(0x85eb_ca6b).rotate_left(13)),
        };
        numbers.map(point).collect()
    }

    #[test]
    fn samples_side_by_side_are_those_one_by_one() {
        let files = [
            "opponent-solids.toml",
            "soft-spheres.toml",
            "toy-village.toml",
            "still-life.toml",
        ];
        for file in files {
            let scene = scene(file);
            let sampler = scene.sampler(Quadrature::Bands(16), [64, 64]);
            let points = points(1500);
            let mut together = vec![RayTree::default(); 400];
            let mut alone = RayTree::default();
            let mut hits = 0;
            for points in points.chunks(400) {
                // A piece that is shorter than the last one, with trees that were used before.
                let trees = &mut together[..points.len()];
                sampler.intersect_all(points, trees);
                for (&at, tree) in points.iter().zip(trees) {
                    sampler.intersect(at, &mut alone);
                    assert_eq!(
                        format!("{tree:?}"),
                        format!("{alone:?}"),
                        "{file} at {at:?}"
                    );
                    hits += alone.hits();
                }
            }
            assert!(hits >= 1_500, "{file}: only {hits} hits");
        }
    }
}

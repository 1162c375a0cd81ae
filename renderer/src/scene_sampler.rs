//! A scene as the screen tree samples it: rays in, opponent channels out.
//!
//! The same point gives the same bits whatever was sampled before, on any thread: what is random depends on
//! the point alone, and nothing is remembered.

use std::ops::Range;

use arrayvec::ArrayVec;
use protocols::{Channel, PerChannel, Quadrature};

use crate::band_shader::BandShader;
use crate::geometry::{Hit, Ray, Span, Vector, ViewFan};
use crate::lighting::{HitKey, LIFT_M, Lighting, Receiver, Surface};
use crate::ray_tree::RayTree;
use crate::sampler::{Sampler, ScreenPoint};
use crate::scene::Scene;
use crate::scene::material::{
    Body, Material, Mirror, Reflectance, fresnel_reflectance, refraction,
};
use crate::shader::{Shader, single};
use crate::spectra::WavelengthRule;
use crate::tints::TintIndex;

/// A ray that counts less than this is not followed: a quarter of an 8-bit step of white.
const LEAST_SHARE: f64 = 1.0 / 1024.0;
/// A mirrored ray leaves a surface at an angle of at least this sine.
const LEAST_HEIGHT: f64 = 1e-3;
/// No path is longer: the camera's ray and seven more.
const MAX_DEPTH: u32 = 8;
/// No ray tree has more hits; the weaker rays of a hit are the ones left out.
const MAX_HITS: usize = 32;

/// A scene, the wavelengths at which it carries light, and the shape of its picture.
#[derive(Clone, Debug)]
pub struct SceneSampler<'scene> {
    scene: &'scene Scene,
    shader: Shader,
    bands: BandShader,
    lighting: Lighting<'scene>,
    /// What the camera may see where, if that is worth it.
    view: Option<ViewFan>,
    aspect: f64,
}

/// A ray that waits to be followed.
#[derive(Clone, Copy, Debug)]
struct Beam {
    ray: Ray,
    /// The shape whose outside it leaves.
    outside_of: Option<u32>,
    /// What part of what it finds reaches the eye, whatever its colour.
    share: f64,
    /// The same at the wavelength at which most does.
    peak: f64,
    tint: TintIndex,
    depth: u32,
}

type Beams = ArrayVec<Beam, MAX_HITS>;

impl<'scene> SceneSampler<'scene> {
    pub(crate) fn new(scene: &'scene Scene, quadrature: Quadrature, size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(f64::from);
        let aspect = width / height;
        let pyramid = scene.camera.pyramid(aspect);
        let rule = WavelengthRule::new(quadrature);
        let (lighting, (view, (shader, bands))) = rayon::join(
            || Lighting::new(scene),
            || {
                let shaders = || {
                    let shader = Shader::new(scene, &rule);
                    let bands = BandShader::new(scene, &rule, &shader);
                    (shader, bands)
                };
                rayon::join(|| ViewFan::new(&pyramid, scene.shapes.shapes()), shaders)
            },
        );
        Self {
            scene,
            shader,
            bands,
            lighting,
            view,
            aspect,
        }
    }

    /// How many wavelengths are computed when a channel is shaded.
    pub fn wavelengths(&self, channel: Channel) -> usize {
        self.shader.wavelengths(channel)
    }

    /// What [`Sampler::shade`] gives but for rounding, with no sum over wavelengths made in advance: the plain
    /// way, by which the quick one is judged and the paper's cost of shading is measured.
    pub fn shade_by_wavelength(&self, tree: &RayTree, channel: Channel) -> f32 {
        self.shader.shade_by_wavelength(tree, channel)
    }

    #[inline]
    fn nearest(&self, beam: &Beam, at: ScreenPoint) -> Option<(u32, Hit)> {
        let shapes = &self.scene.shapes;
        match &self.view {
            Some(view) if beam.depth == 1 => view.nearest((at.x, at.y), &beam.ray, shapes.shapes()),
            _ => shapes.nearest(&beam.ray, Span::up_to(f64::INFINITY), beam.outside_of),
        }
    }

    /// Adds what a ray finds to the tree, and the rays that go on from there to `beams`.
    fn follow(&self, beam: &Beam, at: ScreenPoint, tree: &mut RayTree, beams: &mut Beams) {
        let scene = self.scene;
        let Some((index, hit)) = self.nearest(beam, at) else {
            return;
        };
        tree.count_hit();
        let material = usize::from(scene.material_of_shape[index as usize]);
        let material = &scene.materials[material];
        let shape = scene.shapes.shape(index);
        let place = beam.ray.at(hit.distance_m);
        let outwards = shape.normal(place, hit.part);
        let is_entering = outwards.dot(beam.ray.direction) <= 0.0;
        let smooth = shape.smooth_normal(place, hit.part);
        let outside_of = (is_entering || !shape.is_closed()).then_some(index);
        let surface = Surface::new(&beam.ray, place, (outwards, smooth), outside_of);
        if let (Some(light), true) = (material.emission, is_entering) {
            self.see(beam, light, tree);
        }
        let body_share = match material.mirror {
            None => 1.0,
            Some(Mirror::Glass { refractive_index }) => {
                let relative_index = if is_entering {
                    refractive_index
                } else {
                    refractive_index.recip()
                };
                beam.pass_on(&surface, relative_index, beams);
                if !is_entering {
                    return;
                }
                0.0
            }
            Some(Mirror::Coat { refractive_index }) => {
                let cos_incidence = surface.mirrored.dot(surface.normal).clamp(0.0, 1.0);
                let share = fresnel_reflectance(cos_incidence, refractive_index);
                beam.send(surface.sent_back(), (share, 1.0), beam.tint, beams);
                1.0 - share
            }
            Some(Mirror::Metal { reflectance, peak }) => {
                if let Some(tint) = self.shader.tints().after(beam.tint, reflectance) {
                    beam.send(surface.sent_back(), (1.0, peak), tint, beams);
                }
                0.0
            }
        };
        let reflectance = material
            .body
            .map(|body| self.reflectance(body, index, place, hit));
        let hit_key = HitKey {
            at,
            hit: tree.hits(),
        };
        let ways = Ways {
            tree,
            share: beam.share,
            body_share,
            tint: beam.tint,
        };
        self.scatter(&surface, (material, reflectance), hit_key, ways);
    }

    fn reflectance(&self, body: Body, index: u32, place: Vector, hit: Hit) -> Reflectance {
        let shape = self.scene.shapes.shape(index);
        match body {
            Body::Plain(reflectance) => Reflectance::Table(reflectance),
            Body::Patterned(pattern) => {
                let at = shape.surface_point(place, hit.part);
                Reflectance::Table(pattern.reflectance_at(at))
            }
            Body::Textured(texture) => {
                let texture = &self.scene.textures[usize::from(texture)];
                Reflectance::Sigmoid(texture.at(shape.texture_point(place, hit.part)))
            }
        }
    }

    /// Adds the light that a surface itself is.
    fn see(&self, beam: &Beam, light: u16, tree: &mut RayTree) {
        let luminance = self.scene.lights[usize::from(light)].source.luminance();
        let share = single(beam.share * luminance);
        if share > 0.0 {
            self.add_white(tree, beam.tint, light, share);
        }
    }

    /// Adds light that no body has coloured.
    #[inline]
    fn add_white(&self, tree: &mut RayTree, tint: TintIndex, light: u16, share: f32) {
        let white = self.shader.white();
        if let Some(first) = self.shader.products(tint, white) {
            tree.add_path(first + u32::from(light), share);
        } else {
            tree.add_share(light, share);
            tree.add_surface(Reflectance::Table(white), tint);
        }
    }

    /// Adds what a surface scatters of each light, and its highlights.
    fn scatter(
        &self,
        surface: &Surface,
        (material, reflectance): (&Material, Option<Reflectance>),
        key: HitKey,
        ways: Ways<'_>,
    ) {
        let Ways {
            tree,
            share,
            body_share,
            tint,
        } = ways;
        let receiver = Receiver {
            has_body: reflectance.is_some(),
            highlight: material.highlight,
            mirrors: material.mirror.is_some(),
        };
        if !receiver.has_body && receiver.highlight.is_none() {
            return;
        }
        let products = match reflectance {
            Some(Reflectance::Table(body)) => self.shader.products(tint, body),
            Some(Reflectance::Sigmoid(_)) | None => None,
        };
        let mut highlights: ArrayVec<(u16, f32), MAX_HITS> = ArrayVec::new();
        let add = |tree: &mut RayTree, light: u16, illuminance: f64| {
            let share = single(share * body_share * illuminance);
            if share > 0.0 {
                match products {
                    Some(first) => tree.add_path(first + u32::from(light), share),
                    None => tree.add_share(light, share),
                }
            }
        };
        let ambient = self.shader.ambient();
        for light in 0..ambient {
            let lit = self.lighting.lit(light, surface, receiver, key);
            if receiver.has_body {
                add(tree, light, lit.illuminance);
            }
            if lit.highlight > 0.0 {
                highlights.push((light, single(share * lit.highlight)));
            }
        }
        if let (Some(light), true) = (&self.scene.ambient, receiver.has_body) {
            add(tree, ambient, light.arrival(surface.normal));
        }
        if let Some(reflectance) = reflectance {
            tree.add_surface(reflectance, tint);
        }
        for (light, share) in highlights {
            self.add_white(tree, tint, light, share);
        }
    }
}

/// Where the light of a surface goes.
struct Ways<'tree> {
    tree: &'tree mut RayTree,
    /// Of what the surface sends out, the part that reaches the eye.
    share: f64,
    /// Of what falls on the surface, the part that its body has.
    body_share: f64,
    tint: TintIndex,
}

impl Surface {
    /// The surface that a ray met, whose own normal points `outwards`.
    ///
    /// A smooth normal that cannot be seen from the ray gives way to the surface's own. A ray that a smooth normal
    /// would mirror into the surface grazes it instead, so that the edges of a mesh's faces do not show.
    fn new(
        ray: &Ray,
        place: Vector,
        (outwards, smooth): (Vector, Option<Vector>),
        outside_of: Option<u32>,
    ) -> Self {
        let towards_viewer = |normal: Vector| {
            if outwards.dot(ray.direction) > 0.0 {
                -normal
            } else {
                normal
            }
        };
        let facing = towards_viewer(outwards);
        let smooth = smooth
            .map(towards_viewer)
            .filter(|&normal| normal.dot(ray.direction) < 0.0);
        let normal = smooth.unwrap_or(facing);
        let mirrored = ray.direction.reflected(normal);
        let height = mirrored.dot(facing);
        let mirrored = if smooth.is_some() && height < LEAST_HEIGHT {
            (mirrored + facing * (LEAST_HEIGHT - height)).normalized()
        } else {
            mirrored
        };
        Self {
            place,
            facing,
            normal,
            mirrored,
            outside_of,
        }
    }

    /// The mirrored ray, and the shape whose outside it leaves.
    fn sent_back(&self) -> (Ray, Option<u32>) {
        let ray = Ray {
            origin: self.lifted(),
            direction: self.mirrored,
        };
        (ray, self.outside_of)
    }
}

impl Beam {
    /// Sends a ray on that counts for these shares of this one: whatever its colour, and at most.
    #[inline]
    fn send(
        &self,
        (ray, outside_of): (Ray, Option<u32>),
        (share, peak): (f64, f64),
        tint: TintIndex,
        beams: &mut Beams,
    ) {
        let next = Self {
            ray,
            outside_of,
            share: self.share * share,
            peak: self.peak * share * peak,
            tint,
            depth: self.depth + 1,
        };
        if next.peak >= LEAST_SHARE && next.depth <= MAX_DEPTH && !beams.is_full() {
            beams.push(next);
        }
    }

    /// Sends on what glass mirrors and what it lets through, the stronger one to be followed first.
    fn pass_on(&self, surface: &Surface, relative_index: f64, beams: &mut Beams) {
        let refraction = refraction(self.ray.direction, surface.normal, relative_index);
        let mirrored = (surface.sent_back(), refraction.reflectance);
        let through = refraction.direction.map(|direction| {
            let ray = Ray {
                origin: surface.place - surface.facing * LIFT_M,
                direction,
            };
            ((ray, None), 1.0 - refraction.reflectance)
        });
        let rays = match through {
            Some(through) if through.1 < mirrored.1 => [Some(through), Some(mirrored)],
            through => [Some(mirrored), through],
        };
        for (sent, share) in rays.into_iter().flatten() {
            self.send(sent, (share, 1.0), self.tint, beams);
        }
    }
}

impl Sampler for SceneSampler<'_> {
    type RayTree = RayTree;

    fn intersect(&self, at: ScreenPoint, tree: &mut RayTree) {
        tree.clear();
        let mut beams = Beams::new();
        beams.push(Beam {
            ray: self.scene.camera.ray(at, self.aspect),
            outside_of: None,
            share: 1.0,
            peak: 1.0,
            tint: 0,
            depth: 1,
        });
        for _ in 0..MAX_HITS {
            let Some(beam) = beams.pop() else {
                return;
            };
            self.follow(&beam, at, tree, &mut beams);
        }
    }

    fn shade(&self, tree: &RayTree, channel: Channel) -> f32 {
        self.shader.shade(tree, channel)
    }

    fn shade_all(&self, tree: &RayTree) -> PerChannel<f32> {
        self.shader.shade_all(tree)
    }

    fn wavelengths_nm(&self) -> &[f64] {
        self.bands.nodes_nm()
    }

    fn radiance(&self, tree: &RayTree, wavelengths: Range<usize>, out: &mut [f32]) {
        self.bands.radiance(&self.shader, tree, wavelengths, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_mirror_sends_no_ray_into_the_surface_and_has_no_step() {
        // A ray that falls on the plane z = 0, whose smooth normal turns from upright away from the viewer.
        let ray = Ray {
            origin: Vector::new(-1.0, 0.0, 0.2),
            direction: Vector::new(1.0, 0.0, -0.2).normalized(),
        };
        let place = Vector::new(0.0, 0.0, 0.0);
        let mirrored = |tilt_rad: f64| {
            let smooth = Vector::new(libm::sin(tilt_rad), 0.0, libm::cos(tilt_rad));
            let surface = Surface::new(&ray, place, (Vector::UP, Some(smooth)), None);
            surface.mirrored
        };
        let mut before = mirrored(0.0);
        assert!((before.z - 0.2 / 1.04_f64.sqrt()).abs() < 1e-12);
        for step in 1..=190 {
            let now = mirrored(f64::from(step) * 1e-3);
            assert!(now.z >= 0.999e-3 && (now.length() - 1.0).abs() < 1e-12);
            // Turning a mirror by an angle turns what it mirrors by twice as much, at most.
            assert!((now - before).length() < 2.001e-3, "at {step}");
            before = now;
        }
    }
}

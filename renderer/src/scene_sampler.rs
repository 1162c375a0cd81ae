//! A scene as the screen tree samples it: rays in, opponent channels out.
//!
//! The same point gives the same bits whatever was sampled before, on any thread: what is random depends on
//! the point alone, and nothing is remembered.

use std::cell::RefCell;
use std::ops::Range;

use arrayvec::ArrayVec;
use protocols::{Channel, PerChannel, Quadrature};

use crate::band_shader::BandShader;
use crate::beam::{Beam, Beams, MAX_HITS};
use crate::geometry::{Departure, Found, Hierarchy, Hit, Ray, Span, Vector, ViewFan};
use crate::lighting::{HitKey, Lighted, Lighting, Lit, Receiver, Surface};
use crate::ray_tree::RayTree;
use crate::sampler::{Sampler, ScreenPoint};
use crate::scene::Scene;
use crate::scene::material::{Body, Material, Mirror, Reflectance, fresnel_reflectance};
use crate::shader::{Shader, single};
use crate::spectra::WavelengthRule;
use crate::tints::TintIndex;
use crate::wave::Wave;

/// A mirrored ray leaves a surface at an angle of at least this sine.
const LEAST_HEIGHT: f64 = 1e-3;

thread_local! {
    /// The memory of rays that are followed together on a thread; nothing of it outlasts a call.
    static WAVE: RefCell<Wave> = RefCell::default();
}

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

    /// The ray of the camera through a point.
    #[inline]
    pub(crate) fn camera_beam(&self, at: ScreenPoint) -> Beam {
        Beam::of_camera(self.scene.camera.ray(at, self.aspect))
    }

    /// The shapes of the scene.
    pub(crate) fn shapes(&self) -> &Hierarchy {
        &self.scene.shapes
    }

    /// What the camera may see where, if that is known.
    pub(crate) fn view(&self) -> Option<&ViewFan> {
        self.view.as_ref()
    }

    /// The lights of the scene.
    pub(crate) fn lighting(&self) -> &Lighting<'scene> {
        &self.lighting
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
    fn nearest(&self, beam: &Beam, at: ScreenPoint) -> Found {
        let shapes = &self.scene.shapes;
        let Departure { ray, outside_of } = &beam.departure;
        match &self.view {
            Some(view) if beam.depth == 1 => view.nearest((at.x, at.y), ray, shapes.shapes()),
            _ => shapes.nearest(ray, Span::up_to(f64::INFINITY), *outside_of),
        }
    }

    /// Adds what a ray finds to the tree, and the rays that go on from there to `beams`.
    fn follow(&self, beam: &Beam, at: ScreenPoint, tree: &mut RayTree, beams: &mut Beams) {
        let Some(hit) = self.nearest(beam, at) else {
            return;
        };
        if let Some(encounter) = self.meet(beam, hit, at, (tree, beams)) {
            let Lighted {
                surface,
                receiver,
                key,
            } = &encounter.lighted;
            let lit = |light| self.lighting.lit(light, surface, *receiver, *key);
            self.scatter(&encounter, tree, lit);
        }
    }

    /// The material of a shape.
    #[inline]
    pub(crate) fn material(&self, shape: u32) -> &Material {
        let material = usize::from(self.scene.material_of_shape[shape as usize]);
        &self.scene.materials[material]
    }

    /// Counts a hit in the tree, adds the rays that go on from there to `beams`, and says what light is to be
    /// gathered there, if any.
    #[inline]
    pub(crate) fn meet(
        &self,
        beam: &Beam,
        (index, hit): (u32, Hit),
        at: ScreenPoint,
        (tree, beams): (&mut RayTree, &mut Beams),
    ) -> Option<Encounter> {
        tree.count_hit();
        let material = self.material(index);
        let shape = self.scene.shapes.shape(index);
        let ray = &beam.departure.ray;
        let place = ray.at(hit.distance_m);
        let outwards = shape.normal(place, hit.part);
        let is_entering = outwards.dot(ray.direction) <= 0.0;
        let smooth = shape.smooth_normal(place, hit.part);
        let outside_of = (is_entering || !shape.is_closed()).then_some(index);
        let surface = Surface::new(ray, place, (outwards, smooth), outside_of);
        if let (Some(light), true) = (material.emission, is_entering) {
            self.see(beam, light, tree);
        }
        let body_share = self.send_on(beam, &surface, (material, is_entering), beams)?;
        let receiver = Receiver {
            has_body: material.body.is_some(),
            highlight: material.highlight,
            mirrors: material.mirror.is_some(),
        };
        if !receiver.has_body && receiver.highlight.is_none() {
            return None;
        }
        Some(Encounter {
            lighted: Lighted {
                surface,
                receiver,
                key: HitKey {
                    at,
                    hit: tree.hits(),
                },
            },
            reflectance: material
                .body
                .map(|body| self.reflectance(body, index, place, hit)),
            share: beam.share,
            body_share,
            tint: beam.tint,
        })
    }

    /// Sends on the rays that a surface mirrors or lets through, and says what share its body has; `None` for
    /// glass seen from within.
    #[inline]
    fn send_on(
        &self,
        beam: &Beam,
        surface: &Surface,
        (material, is_entering): (&Material, bool),
        beams: &mut Beams,
    ) -> Option<f64> {
        match material.mirror {
            None => Some(1.0),
            Some(Mirror::Glass { refractive_index }) => {
                let relative_index = if is_entering {
                    refractive_index
                } else {
                    refractive_index.recip()
                };
                beam.pass_on(surface, relative_index, beams);
                is_entering.then_some(0.0)
            }
            Some(Mirror::Coat { refractive_index }) => {
                let cos_incidence = surface.mirrored.dot(surface.normal).clamp(0.0, 1.0);
                let share = fresnel_reflectance(cos_incidence, refractive_index);
                beam.send(surface.sent_back(), (share, 1.0), beam.tint, beams);
                Some(1.0 - share)
            }
            Some(Mirror::Metal { reflectance, peak }) => {
                if let Some(tint) = self.shader.tints().after(beam.tint, reflectance) {
                    beam.send(surface.sent_back(), (1.0, peak), tint, beams);
                }
                Some(0.0)
            }
        }
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
    #[inline]
    pub(crate) fn scatter(
        &self,
        encounter: &Encounter,
        tree: &mut RayTree,
        lit: impl Fn(u16) -> Lit,
    ) {
        let &Encounter {
            lighted: Lighted { surface, .. },
            reflectance,
            share,
            body_share,
            tint,
        } = encounter;
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
            let lit = lit(light);
            if reflectance.is_some() {
                add(tree, light, lit.illuminance);
            }
            if lit.highlight > 0.0 {
                highlights.push((light, single(share * lit.highlight)));
            }
        }
        if let (Some(light), Some(_)) = (&self.scene.ambient, reflectance) {
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

/// A hit of which light is to be gathered.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Encounter {
    pub(crate) lighted: Lighted,
    reflectance: Option<Reflectance>,
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
    pub(crate) fn sent_back(&self) -> Departure {
        Departure {
            ray: Ray {
                origin: self.lifted(),
                direction: self.mirrored,
            },
            outside_of: self.outside_of,
        }
    }
}

impl Sampler for SceneSampler<'_> {
    type RayTree = RayTree;

    fn intersect(&self, at: ScreenPoint, tree: &mut RayTree) {
        tree.clear();
        let mut beams = Beams::new();
        beams.push(self.camera_beam(at));
        for _ in 0..MAX_HITS {
            let Some(beam) = beams.pop() else {
                return;
            };
            self.follow(&beam, at, tree, &mut beams);
        }
    }

    fn intersect_all(&self, points: &[ScreenPoint], trees: &mut [RayTree]) {
        WAVE.with_borrow_mut(|wave| wave.intersect(self, points, trees));
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

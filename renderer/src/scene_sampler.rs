//! A scene as the screen tree samples it: rays in, opponent channels out.
//!
//! The same point gives the same bits whatever was sampled before, on any thread: nothing is random and
//! nothing is remembered.

use protocols::{Channel, Quadrature};

use crate::geometry::{Hit, Ray, Span, Vector};
use crate::ray_tree::{RayNode, RayTree};
use crate::sampler::{Sampler, ScreenPoint};
use crate::scene::Scene;
use crate::scene::light::Light;
use crate::scene::material::{Highlight, Material, Mirror, fresnel_reflectance};
use crate::shader::{Shader, single};
use crate::spectra::WavelengthRule;

/// How far off a surface a new ray starts, so that it does not meet the same place again.
const LIFT_M: f64 = 1e-6;
/// A mirrored ray that counts less than this is not followed: a quarter of an 8-bit step of white.
const LEAST_SHARE: f64 = 1.0 / 1024.0;

/// A scene, the wavelengths at which it carries light, and the shape of its picture.
#[derive(Clone, Debug)]
pub struct SceneSampler<'scene> {
    scene: &'scene Scene,
    shader: Shader,
    white: u16,
    aspect: f64,
}

/// A hit with what is needed to send rays on from it.
struct Surface {
    place: Vector,
    /// Towards the viewer's side.
    normal: Vector,
    /// Of the mirrored ray.
    mirrored: Vector,
}

impl<'scene> SceneSampler<'scene> {
    pub(crate) fn new(scene: &'scene Scene, quadrature: Quadrature, size_px: [u32; 2]) -> Self {
        let [width, height] = size_px.map(f64::from);
        Self {
            scene,
            shader: Shader::new(scene, &WavelengthRule::new(quadrature)),
            white: Shader::white(scene),
            aspect: width / height,
        }
    }

    /// How many wavelengths are computed when a channel is shaded.
    pub fn wavelengths(&self, channel: Channel) -> usize {
        self.shader.wavelengths(channel)
    }

    /// Whether and how strongly lights and mirrored rays count at a hit; and the share of the mirrored ray
    /// at its strongest wavelength.
    fn node(&self, material: &Material, surface: &Surface, reflectance: u16) -> (RayNode, f64) {
        let mut node = RayNode {
            body: reflectance,
            mirror: self.white,
            ..RayNode::default()
        };
        let mut share = 0.0;
        let mut body_share = 1.0;
        match material.mirror {
            None => {}
            Some(Mirror::Metal { reflectance, peak }) => {
                node.mirror = reflectance;
                node.mirrored = 1.0;
                share = peak;
            }
            Some(Mirror::Coat { refractive_index }) => {
                let cos_incidence = surface.mirrored.dot(surface.normal).clamp(0.0, 1.0);
                share = fresnel_reflectance(cos_incidence, refractive_index);
                node.mirrored = single(share);
                body_share = 1.0 - share;
            }
        }
        if material.body.is_none() {
            body_share = 0.0;
        } else if let Some(ambient) = &self.scene.ambient {
            node.scattered_ambient = single(body_share * ambient.arrival(surface.normal));
        }
        for (index, light) in self.scene.lights.iter().enumerate() {
            let (scattered, highlight) = self.lit(light, surface, material.highlight, body_share);
            node.scattered[index] = single(scattered);
            node.highlights[index] = single(highlight);
        }
        (node, share)
    }

    /// What the body scatters of a light, and how bright its highlight is.
    #[inline]
    fn lit(
        &self,
        light: &Light,
        surface: &Surface,
        highlight: Option<Highlight>,
        body_share: f64,
    ) -> (f64, f64) {
        let arrival = light.source.arrival(surface.place);
        let cos_incidence = arrival.towards.dot(surface.normal);
        if cos_incidence <= 0.0 {
            return (0.0, 0.0);
        }
        let glint = highlight.map_or(0.0, |highlight| {
            highlight.at(arrival.towards.dot(surface.mirrored))
        });
        if body_share == 0.0 && glint == 0.0 {
            return (0.0, 0.0);
        }
        let shadow_ray = Ray {
            origin: surface.place + surface.normal * LIFT_M,
            direction: arrival.towards,
        };
        if self
            .scene
            .shapes
            .is_blocked(&shadow_ray, Span::up_to(arrival.distance_m))
        {
            return (0.0, 0.0);
        }
        let illuminance = arrival.illuminance;
        (
            body_share * illuminance * cos_incidence,
            glint * illuminance,
        )
    }

    /// The surface that a ray hit, and which reflectance its body has there.
    fn surface(&self, ray: &Ray, index: u32, hit: Hit, material: &Material) -> (Surface, u16) {
        let shape = self.scene.shapes.shape(index);
        let place = ray.at(hit.distance_m);
        let outwards = shape.normal(place, hit.part);
        let normal = if outwards.dot(ray.direction) > 0.0 {
            -outwards
        } else {
            outwards
        };
        let reflectance = material.body.map_or(self.white, |body| {
            body.reflectance_at(|| shape.surface_point(place, hit.part))
        });
        let surface = Surface {
            place,
            normal,
            mirrored: ray.direction.reflected(normal),
        };
        (surface, reflectance)
    }
}

impl Sampler for SceneSampler<'_> {
    type RayTree = RayTree;

    fn intersect(&self, at: ScreenPoint, tree: &mut RayTree) {
        tree.clear();
        let scene = self.scene;
        let mut ray = scene.camera.ray(at, self.aspect);
        let mut share = 1.0;
        while let Some((index, hit)) = scene.shapes.nearest(&ray, Span::up_to(f64::INFINITY)) {
            let material = usize::from(scene.material_of_shape[index as usize]);
            let material = &scene.materials[material];
            let (surface, reflectance) = self.surface(&ray, index, hit, material);
            let (node, mirrored) = self.node(material, &surface, reflectance);
            tree.push(node);
            share *= mirrored;
            if share < LEAST_SHARE || !tree.has_room() {
                return;
            }
            ray = Ray {
                origin: surface.place + surface.normal * LIFT_M,
                direction: surface.mirrored,
            };
        }
    }

    fn shade(&self, tree: &RayTree, channel: Channel) -> f32 {
        self.shader.shade(tree, channel)
    }
}

//! A scene: what is in front of the camera, read from a TOML file.
//!
//! # Units and axes
//!
//! Lengths are in metres, angles in degrees, wavelengths in nm. World axes are right-handed, z up.
//!
//! # How bright things are
//!
//! The unit of light is *the illuminance that makes a perfect white diffuser as bright as the display's
//! white* (Y = 1). A distant light states its illuminance on a surface that faces it; a point light states
//! its intensity, the illuminance at 1 m: a surface at a distance of d metres, turned away by θ, receives
//! `intensity · cos θ / d²`. Emittances are scaled to Y = 1 first, so that a light's colour does not change
//! how bright it is. There is no other exposure.
//!
//! A `rectangle_light` or `sphere_light` is a surface of a `luminance`, 1 being the display's white; it is
//! seen, is mirrored, and casts soft shadows by `samples` × `samples` shadow rays. A rectangle shines to
//! the side from which its edge u turns to its edge v counter-clockwise. What a mirror, a coat or glass
//! shows of it needs no highlight, so there is none.
//!
//! Ambient light is that of an evenly bright upper half of the sphere that nothing blocks: a surface whose
//! normal rises by the sine s receives `illuminance · (1 + s) / 2`.
//!
//! # Materials
//!
//! | table | what it does |
//! |---|---|
//! | `[diffuse.NAME]` | Lambert's law with a spectral `reflectance` |
//! | `[glossy.NAME]` | the same, and `highlight · (cos α)^exponent` of each light, α from the mirrored direction (Phong 1975); with `refractive_index` also a clear coat that mirrors by Fresnel's formula, the body taking the rest |
//! | `[mirror.NAME]` | a mirror of a spectral `reflectance` |
//! | `[glass.NAME]` | a clear solid of a `refractive_index`: mirrors by Fresnel's formula, passes the rest on by Snell's law; for closed shapes |
//!
//! `diffuse` and `glossy` may have a `texture` in place of the reflectance: `{ file = "wood.jpg", wrap = "repeat"
//! (clamp, mirror), filter = "bilinear" (nearest) }`, PNG and JPEG as encoded sRGB, EXR as linear sRGB. It covers a
//! rectangle, or the texture points of a mesh, or each metre of another surface. They may also have `checker` or `stripes`: a second reflectance in every other square or
//! stripe along the surface. A reflectance is the name of an entry of `[reflectances]`, the name of a
//! measured one (`colorchecker red`), control points `[[nm, value], …]` with straight lines between them
//! and level ends, or `{ srgb = [r, g, b] }`, from 0 to 1: the smooth reflectance that has this colour under
//! D65. An `emittance` of `{ srgb = … }` is D65 through a filter of this colour.
//!
//! Surface coordinates are in metres: on a sphere along the equator and the meridian; on a cylinder or cone
//! round the axis and up the side; on a box or rectangle along its edges; on the ground x and y.
//!
//! # Meshes
//!
//! `mesh = [{ file = "x.glb", material = "…", position_m = […], scale = 1, rotation_deg = 0, up = "y" }]` reads
//! glTF 2.0, OBJ with MTL, or PLY from the folder of the scene; only `file` must be given. Without `material` the
//! file's own are taken. The file's y is up unless `up = "z"`; the rotation is about the world's z. A mesh file
//! is also a scene of its own. What it asks for in vain is among the warnings.
//!
//! # Simplifications
//!
//! Mirrors and glass do not pass light on to diffuse surfaces: glass casts a full shadow. Glass is the same
//! at every wavelength, takes nothing away, and has air on its other side. A ray that leaves the scene finds
//! black. No path has more than 8 hits or 4 metal mirrors, no ray tree more than 32 hits, and a ray that
//! counts for less than 1/1024 is not followed.

pub(crate) mod camera;
mod enclosure;
mod file;
mod imported;
pub(crate) mod light;
mod lights;
pub(crate) mod material;
mod mesh_scene;
mod meshes;
mod palette;
mod reader;
mod seen_rectangle;
mod shapes;
mod table;
pub(crate) mod texture;

use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::Path;

use protocols::{InputError, Quadrature, ReadError, Sha256Digest};

use crate::RendererError;
use crate::geometry::Hierarchy;
use crate::import::Format;
use crate::scene_sampler::SceneSampler;
use crate::spectra::Spectrum;
use camera::Camera;
use light::{Ambient, Light};
use material::Material;
use texture::Texture;

/// No scene file larger than this is read; meshes stand in files of their own.
const LARGEST_SCENE_BYTES: u64 = 1 << 26;

/// A scene that can be rendered: read whole, checked whole.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) camera: Camera,
    pub(crate) shapes: Hierarchy,
    /// For each shape the place of its material in `materials`.
    pub(crate) material_of_shape: Vec<u16>,
    pub(crate) materials: Vec<Material>,
    /// The reflectances that materials refer to.
    pub(crate) reflectances: Vec<Spectrum>,
    /// The pictures that materials refer to.
    pub(crate) textures: Vec<Texture>,
    pub(crate) lights: Vec<Light>,
    pub(crate) ambient: Option<Ambient>,
    warnings: Vec<String>,
    /// The digests of the files that the scene file names.
    imported: Vec<Sha256Digest>,
}

impl Scene {
    /// Reads a scene file: TOML, or a mesh file (`.gltf`, `.glb`, `.obj`, `.ply`) as a scene of its own.
    ///
    /// # Errors
    ///
    /// [`RendererError::Input`] if the file is missing, is not TOML, has an unknown or missing key, or says
    /// what cannot be; [`RendererError::Io`] if the system would not give it.
    pub fn read(path: &Path) -> Result<Self, RendererError> {
        Self::read_with_digest(path).map(|(scene, _)| scene)
    }

    /// The scene of a file, and the digest of the file together with those that it names.
    pub(crate) fn read_with_digest(path: &Path) -> Result<(Self, Sha256Digest), RendererError> {
        if Format::known(path).is_some() {
            let scene = mesh_scene::scene_from_mesh(path)?;
            let digest = scene.digest_with(&[]);
            return Ok((scene, digest));
        }
        let text = scene_text(path)?;
        let scene = Self::from_toml(path, &text)?;
        let digest = scene.digest_with(text.as_bytes());
        Ok((scene, digest))
    }

    fn digest_with(&self, text: &[u8]) -> Sha256Digest {
        let mut bytes = text.to_vec();
        for digest in &self.imported {
            bytes.extend(digest.as_str().bytes());
        }
        Sha256Digest::of(&bytes)
    }

    /// What the scene says that is not done, and what was assumed in its place: a line each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Reads the text of a scene; `file` is only named in errors.
    ///
    /// # Errors
    ///
    /// [`RendererError::Input`], as for [`Scene::read`].
    pub fn from_toml(file: &Path, text: &str) -> Result<Self, RendererError> {
        Ok(reader::scene_from_toml(file, text)?)
    }

    /// The scene ready to be sampled, carrying light at the wavelengths of `quadrature`.
    ///
    /// `size_px` is the width and height of the picture; its pixels are square and the camera's field of
    /// view is its height.
    pub fn sampler(&self, quadrature: Quadrature, size_px: [u32; 2]) -> SceneSampler<'_> {
        SceneSampler::new(self, quadrature, size_px)
    }
}

/// Whether a file is a scene rather than a protocol: a mesh by its ending, or TOML with a camera.
pub fn is_scene(path: &Path) -> bool {
    if Format::known(path).is_some() {
        return true;
    }
    let table = scene_text(path)
        .ok()
        .and_then(|text| text.parse::<toml::Table>().ok());
    table.is_some_and(|table| table.contains_key("camera"))
}

/// The text of a scene file, if it is not absurdly large.
fn scene_text(path: &Path) -> Result<String, ReadError> {
    let failed = |error| ReadError::from_io(path, "a scene (TOML)", error);
    let file = File::open(path).map_err(failed)?;
    let mut text = String::new();
    let bounded = file.take(LARGEST_SCENE_BYTES + 1);
    BufReader::new(bounded)
        .read_to_string(&mut text)
        .map_err(failed)?;
    if text.len() as u64 <= LARGEST_SCENE_BYTES {
        return Ok(text);
    }
    let expected = format!("a scene (TOML) of at most {LARGEST_SCENE_BYTES} bytes");
    Err(InputError::new(path, "a larger file", expected).into())
}

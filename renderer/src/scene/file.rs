//! The scene file as it is written, before anything in it is believed. Unknown keys are refused.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserializer, MapAccess, SeqAccess, Visitor};

use crate::import::{Filter, Wrap};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub(super) camera: CameraTable,
    pub(super) ambient: Option<AmbientTable>,
    #[serde(default)]
    pub(super) distant_light: Vec<DistantLightTable>,
    #[serde(default)]
    pub(super) point_light: Vec<PointLightTable>,
    #[serde(default)]
    pub(super) rectangle_light: Vec<RectangleLightTable>,
    #[serde(default)]
    pub(super) sphere_light: Vec<SphereLightTable>,
    #[serde(default)]
    pub(super) reflectances: BTreeMap<String, SpectrumValue>,
    #[serde(default)]
    pub(super) diffuse: BTreeMap<String, DiffuseTable>,
    #[serde(default)]
    pub(super) glossy: BTreeMap<String, GlossyTable>,
    #[serde(default)]
    pub(super) mirror: BTreeMap<String, MirrorTable>,
    #[serde(default)]
    pub(super) glass: BTreeMap<String, GlassTable>,
    #[serde(default)]
    pub(super) sphere: Vec<SphereTable>,
    #[serde(default, rename = "box")]
    pub(super) cuboid: Vec<BoxTable>,
    #[serde(default)]
    pub(super) cylinder: Vec<CylinderTable>,
    #[serde(default)]
    pub(super) cone: Vec<ConeTable>,
    #[serde(default)]
    pub(super) disc: Vec<DiscTable>,
    #[serde(default)]
    pub(super) rectangle: Vec<RectangleTable>,
    #[serde(default)]
    pub(super) ground: Vec<GroundTable>,
    #[serde(default)]
    pub(super) mesh: Vec<MeshTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    pub(super) position_m: [f64; 3],
    pub(super) look_at_m: [f64; 3],
    pub(super) up: [f64; 3],
    pub(super) vertical_field_of_view_deg: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AmbientTable {
    pub(super) emittance: SpectrumValue,
    pub(super) illuminance: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DistantLightTable {
    pub(super) name: Option<String>,
    pub(super) from: [f64; 3],
    pub(super) emittance: SpectrumValue,
    pub(super) illuminance: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointLightTable {
    pub(super) name: Option<String>,
    pub(super) position_m: [f64; 3],
    pub(super) emittance: SpectrumValue,
    pub(super) intensity: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RectangleLightTable {
    pub(super) name: Option<String>,
    pub(super) corner_m: [f64; 3],
    pub(super) edge_u_m: [f64; 3],
    pub(super) edge_v_m: [f64; 3],
    pub(super) emittance: SpectrumValue,
    pub(super) luminance: f64,
    pub(super) samples: u32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereLightTable {
    pub(super) name: Option<String>,
    pub(super) center_m: [f64; 3],
    pub(super) radius_m: f64,
    pub(super) emittance: SpectrumValue,
    pub(super) luminance: f64,
    pub(super) samples: u32,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DiffuseTable {
    pub(super) reflectance: Option<SpectrumValue>,
    pub(super) texture: Option<TextureTable>,
    pub(super) checker: Option<CheckerTable>,
    pub(super) stripes: Option<StripesTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GlossyTable {
    pub(super) reflectance: Option<SpectrumValue>,
    pub(super) texture: Option<TextureTable>,
    pub(super) checker: Option<CheckerTable>,
    pub(super) stripes: Option<StripesTable>,
    pub(super) highlight: f64,
    pub(super) exponent: f64,
    pub(super) refractive_index: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MirrorTable {
    pub(super) reflectance: SpectrumValue,
    pub(super) highlight: Option<f64>,
    pub(super) exponent: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GlassTable {
    pub(super) refractive_index: f64,
    pub(super) highlight: Option<f64>,
    pub(super) exponent: Option<f64>,
}

/// A picture on a surface; the file is named from the folder of the scene.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureTable {
    pub(super) file: PathBuf,
    #[serde(default)]
    pub(super) wrap: Wrap,
    #[serde(default)]
    pub(super) filter: Filter,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CheckerTable {
    pub(super) reflectance: SpectrumValue,
    pub(super) size_m: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StripesTable {
    pub(super) reflectance: SpectrumValue,
    pub(super) size_m: f64,
    pub(super) across: StripeDirection,
}

/// The surface coordinate that stripes part.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum StripeDirection {
    U,
    V,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SphereTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) center_m: [f64; 3],
    pub(super) radius_m: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BoxTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) center_m: [f64; 3],
    pub(super) size_m: [f64; 3],
    #[serde(default)]
    pub(super) rotation_deg: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) base_m: [f64; 3],
    pub(super) top_m: [f64; 3],
    pub(super) radius_m: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConeTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) base_m: [f64; 3],
    pub(super) apex_m: [f64; 3],
    pub(super) radius_m: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DiscTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) center_m: [f64; 3],
    pub(super) normal: [f64; 3],
    pub(super) radius_m: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RectangleTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) corner_m: [f64; 3],
    pub(super) edge_u_m: [f64; 3],
    pub(super) edge_v_m: [f64; 3],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GroundTable {
    pub(super) name: Option<String>,
    pub(super) material: String,
    pub(super) height_m: f64,
}

/// A mesh of another program; the file is named from the folder of the scene.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshTable {
    pub(super) name: Option<String>,
    pub(super) file: PathBuf,
    /// In place of the file's own materials.
    pub(super) material: Option<String>,
    #[serde(default)]
    pub(super) position_m: [f64; 3],
    pub(super) scale: Option<f64>,
    #[serde(default)]
    pub(super) rotation_deg: f64,
    #[serde(default)]
    pub(super) up: UpAxis,
}

/// The axis of a mesh file that points up.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum UpAxis {
    #[default]
    Y,
    Z,
}

/// A spectrum by name, by control points, or by the colour that it is to have.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SpectrumValue {
    Named(String),
    Points(Vec<[f64; 2]>),
    Srgb([f64; 3]),
}

/// `{ srgb = [r, g, b] }`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SrgbTable {
    srgb: [f64; 3],
}

impl<'de> Deserialize<'de> for SpectrumValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(SpectrumVisitor)
    }
}

struct SpectrumVisitor;

impl<'de> Visitor<'de> for SpectrumVisitor {
    type Value = SpectrumValue;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(
            "the name of a spectrum, control points [[nm, value], ...] or { srgb = [r, g, b] }",
        )
    }

    fn visit_str<E: de::Error>(self, name: &str) -> Result<SpectrumValue, E> {
        Ok(SpectrumValue::Named(name.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<SpectrumValue, A::Error> {
        let mut points = Vec::new();
        while let Some(point) = list.next_element()? {
            points.push(point);
        }
        Ok(SpectrumValue::Points(points))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<SpectrumValue, A::Error> {
        let table = SrgbTable::deserialize(MapAccessDeserializer::new(map))?;
        Ok(SpectrumValue::Srgb(table.srgb))
    }
}

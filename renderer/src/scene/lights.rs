//! The lights of a scene: each table checked and made a light.

use std::path::Path;

use protocols::InputError;

use super::file::{
    DistantLightTable, PointLightTable, RectangleLightTable, SceneFile, SpectrumValue,
    SphereLightTable,
};
use super::light::{AreaLight, AreaSurface, Light, Source};
use super::palette::{linear_of_srgb, spectrum_of_points};
use super::table::Table;
use crate::spectra::Emission;

/// The most lights that a scene may have.
pub(super) const MAX_LIGHTS: usize = 32;
/// The most samples along each side of an area light.
const MAX_SAMPLES: u32 = 64;

/// All lights: distant ones, points, rectangles, spheres; and for each how to speak of it.
pub(super) fn lights(
    file: &Path,
    scene: &SceneFile,
) -> Result<(Vec<Light>, Vec<String>), InputError> {
    let mut lights = Lights::default();
    add(file, "distant_light", &scene.distant_light, &mut lights)?;
    add(file, "point_light", &scene.point_light, &mut lights)?;
    add(file, "rectangle_light", &scene.rectangle_light, &mut lights)?;
    add(file, "sphere_light", &scene.sphere_light, &mut lights)?;
    let (lights, names) = lights;
    if (1..=MAX_LIGHTS).contains(&lights.len()) {
        Ok((lights, names))
    } else {
        let found = format!("{} lights", lights.len());
        let expected = format!(
            "from 1 to {MAX_LIGHTS} of distant_light, point_light, rectangle_light and sphere_light"
        );
        Err(InputError::new(file, found, expected))
    }
}

/// Lights with their labels.
type Lights = (Vec<Light>, Vec<String>);

fn add<T: LightTable>(
    file: &Path,
    kind: &str,
    tables: &[T],
    (lights, names): &mut Lights,
) -> Result<(), InputError> {
    for (number, light) in (1..).zip(tables) {
        let table = Table {
            file,
            kind,
            number: Some(number),
            name: light.name(),
        };
        names.push(table.label());
        lights.push(Light {
            emission: emission(table, light.emittance())?,
            source: light.source(table)?,
        });
    }
    Ok(())
}

/// A table of the file that is a light.
trait LightTable {
    fn name(&self) -> Option<&str>;
    fn emittance(&self) -> &SpectrumValue;
    /// Where the light comes from, once the numbers have been checked; errors name `table`.
    fn source(&self, table: Table<'_>) -> Result<Source, InputError>;
}

impl LightTable for DistantLightTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn emittance(&self) -> &SpectrumValue {
        &self.emittance
    }

    fn source(&self, table: Table<'_>) -> Result<Source, InputError> {
        Ok(Source::Distant {
            towards: table.direction("from", self.from)?,
            illuminance: table.brightness("illuminance", self.illuminance)?,
        })
    }
}

impl LightTable for PointLightTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn emittance(&self) -> &SpectrumValue {
        &self.emittance
    }

    fn source(&self, table: Table<'_>) -> Result<Source, InputError> {
        Ok(Source::Point {
            position: table.place("position_m", self.position_m)?,
            intensity: table.brightness("intensity", self.intensity)?,
        })
    }
}

impl LightTable for RectangleLightTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn emittance(&self) -> &SpectrumValue {
        &self.emittance
    }

    fn source(&self, table: Table<'_>) -> Result<Source, InputError> {
        let corner = table.place("corner_m", self.corner_m)?;
        let [edge_u, edge_v] = table.edges(self.edge_u_m, self.edge_v_m)?;
        let surface = AreaSurface::Rectangle {
            corner,
            edge_u,
            edge_v,
        };
        area(table, self.luminance, self.samples, surface)
    }
}

impl LightTable for SphereLightTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn emittance(&self) -> &SpectrumValue {
        &self.emittance
    }

    fn source(&self, table: Table<'_>) -> Result<Source, InputError> {
        let surface = AreaSurface::Sphere {
            center: table.place("center_m", self.center_m)?,
            radius_m: table.length_m("radius_m", self.radius_m)?,
        };
        area(table, self.luminance, self.samples, surface)
    }
}

fn area(
    table: Table<'_>,
    luminance: f64,
    samples: u32,
    surface: AreaSurface,
) -> Result<Source, InputError> {
    if !(1..=MAX_SAMPLES).contains(&samples) {
        let expected = format!("from 1 to {MAX_SAMPLES} samples along each side of the light");
        return Err(table.error("samples", samples.to_string(), expected));
    }
    Ok(Source::Area(AreaLight {
        luminance: table.brightness("luminance", luminance)?,
        side: samples,
        surface,
    }))
}

/// What a light emits, by name or by control points.
pub(super) fn emission(
    table: Table<'_>,
    emittance: &SpectrumValue,
) -> Result<Emission, InputError> {
    let (emission, found) = match emittance {
        SpectrumValue::Named(name) => (Emission::named(name), format!("\"{name}\"")),
        SpectrumValue::Points(points) => {
            let spectrum = spectrum_of_points(table, "emittance", points, 1e6)?;
            let found = "control points without visible light".to_owned();
            (Emission::of(spectrum), found)
        }
        SpectrumValue::Srgb(srgb) => {
            let linear = linear_of_srgb(table, "emittance", *srgb)?;
            (Emission::of_linear_srgb(linear), "black".to_owned())
        }
    };
    emission.ok_or_else(|| {
        let expected = "\"D65\", \"A\", \"E\", \"blackbody 3200 K\" (500 to 100000 K), or control \
                        points [[nm, power], ...] with visible light, or { srgb = [r, g, b] }";
        table.error("emittance", found, expected)
    })
}

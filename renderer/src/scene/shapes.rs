//! The objects of a scene: each table checked and made a shape.

use std::path::Path;

use protocols::InputError;

use super::file::{
    BoxTable, ConeTable, CylinderTable, DiscTable, GroundTable, RectangleTable, SceneFile,
    SphereTable,
};
use super::material::Mirror;
use super::palette::Palette;
use super::table::Table;
use crate::geometry::{Cone, Cuboid, Cylinder, Disc, Ground, Rectangle, Shape, Sphere, Vector};

/// The shapes of a scene.
#[derive(Debug, Default)]
pub(super) struct Objects {
    pub(super) shapes: Vec<Shape>,
    /// For each shape the place of its material.
    pub(super) materials: Vec<u16>,
    /// For each shape how to speak of it.
    pub(super) labels: Vec<String>,
}

impl Objects {
    /// All shapes but meshes.
    pub(super) fn new(
        file: &Path,
        scene: &SceneFile,
        palette: &Palette,
    ) -> Result<Self, InputError> {
        let mut objects = Self::default();
        objects.add_tables((file, palette), "sphere", &scene.sphere)?;
        objects.add_tables((file, palette), "box", &scene.cuboid)?;
        objects.add_tables((file, palette), "cylinder", &scene.cylinder)?;
        objects.add_tables((file, palette), "cone", &scene.cone)?;
        objects.add_tables((file, palette), "disc", &scene.disc)?;
        objects.add_tables((file, palette), "rectangle", &scene.rectangle)?;
        objects.add_tables((file, palette), "ground", &scene.ground)?;
        let lights_seen = scene.rectangle_light.len() + scene.sphere_light.len();
        if objects.shapes.is_empty() && scene.mesh.is_empty() && lights_seen == 0 {
            return Err(InputError::new(
                file,
                "no object",
                "at least one sphere, box, cylinder, cone, disc, rectangle, ground, mesh, rectangle_light or \
                 sphere_light",
            ));
        }
        Ok(objects)
    }

    /// Adds a shape.
    pub(super) fn add(&mut self, shape: Shape, material: u16, label: String) {
        self.shapes.push(shape);
        self.materials.push(material);
        self.labels.push(label);
    }

    fn add_tables<T: ObjectTable>(
        &mut self,
        (file, palette): (&Path, &Palette),
        kind: &str,
        tables: &[T],
    ) -> Result<(), InputError> {
        for (number, object) in (1..).zip(tables) {
            let table = Table {
                file,
                kind,
                number: Some(number),
                name: object.name(),
            };
            let material = palette.material(table, object.material())?;
            let shape = object.shape(table)?;
            let mirror = palette.materials[usize::from(material)].mirror;
            if matches!(mirror, Some(Mirror::Glass { .. })) && !shape.is_closed() {
                let found = format!("\"{}\", which is glass", object.material());
                let expected = "another material: only a closed shape can be of glass";
                return Err(table.error("material", found, expected));
            }
            self.add(shape, material, table.label());
        }
        Ok(())
    }
}

/// A table of the file that is an object.
trait ObjectTable {
    fn name(&self) -> Option<&str>;
    fn material(&self) -> &str;
    /// The shape, once its numbers have been checked; errors name `table`.
    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError>;
}

impl ObjectTable for SphereTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        Ok(Shape::Sphere(Sphere {
            center: table.place("center_m", self.center_m)?,
            radius_m: table.length_m("radius_m", self.radius_m)?,
        }))
    }
}

impl ObjectTable for BoxTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        let center = table.place("center_m", self.center_m)?;
        let [x, y, z] = self.size_m;
        let size = Vector::new(
            table.length_m("size_m", x)?,
            table.length_m("size_m", y)?,
            table.length_m("size_m", z)?,
        );
        let rotation_deg =
            table.number_within("rotation_deg", self.rotation_deg, (-360.0, 360.0))?;
        Ok(Shape::Cuboid(Cuboid::new(center, size, rotation_deg)))
    }
}

impl ObjectTable for CylinderTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        let [base, top] = table.two_places(("base_m", self.base_m), ("top_m", self.top_m))?;
        let radius_m = table.length_m("radius_m", self.radius_m)?;
        Ok(Shape::Cylinder(Cylinder::between(base, top, radius_m)))
    }
}

impl ObjectTable for ConeTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        let [base, apex] = table.two_places(("base_m", self.base_m), ("apex_m", self.apex_m))?;
        let radius_m = table.length_m("radius_m", self.radius_m)?;
        Ok(Shape::Cone(Cone::between(base, apex, radius_m)))
    }
}

impl ObjectTable for DiscTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        Ok(Shape::Disc(Disc::new(
            table.place("center_m", self.center_m)?,
            table.direction("normal", self.normal)?,
            table.length_m("radius_m", self.radius_m)?,
        )))
    }
}

impl ObjectTable for RectangleTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        let corner = table.place("corner_m", self.corner_m)?;
        let [edge_u, edge_v] = table.edges(self.edge_u_m, self.edge_v_m)?;
        Ok(Shape::Rectangle(Rectangle::new(corner, edge_u, edge_v)))
    }
}

impl ObjectTable for GroundTable {
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn material(&self) -> &str {
        &self.material
    }

    fn shape(&self, table: Table<'_>) -> Result<Shape, InputError> {
        let height_m = table.number_within("height_m", self.height_m, (-1e6, 1e6))?;
        Ok(Shape::Ground(Ground { height_m }))
    }
}

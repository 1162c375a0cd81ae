//! The meshes that a scene file names.

use std::path::Path;
use std::sync::Arc;

use protocols::ReadError;

use super::file::{MeshTable, SceneFile, UpAxis};
use super::imported::add_materials;
use super::palette::Palette;
use super::shapes::Objects;
use super::table::Table;
use crate::geometry::{Mesh, Shape};
use crate::import::{self, Import, Placement};

/// Reads the meshes of a scene and adds them to its objects; their warnings and digests are handed back.
pub(super) fn add_meshes(
    file: &Path,
    scene: &SceneFile,
    palette: &mut Palette,
    objects: &mut Objects,
) -> Result<Vec<Import>, ReadError> {
    let mut imports = Vec::new();
    for (number, mesh) in (1..).zip(&scene.mesh) {
        let table = Table {
            file,
            kind: "mesh",
            number: Some(number),
            name: mesh.name.as_deref(),
        };
        let path = file.parent().unwrap_or(Path::new("")).join(&mesh.file);
        let mut import = import::read(&path, &placement(table, mesh)?)?;
        let unused = match (import.camera, import.lights.len()) {
            (None, 0) => None,
            (None, lights) => Some(format!("{lights} lights")),
            (Some(_), 0) => Some("a camera".to_owned()),
            (Some(_), lights) => Some(format!("a camera and {lights} lights")),
        };
        if let Some(unused) = unused {
            let warning = format!(
                "\"{}\": {unused}, left out: {} has its own",
                path.display(),
                file.display()
            );
            import.warnings.push(warning);
        }
        let own = mesh.material.as_deref();
        let own = own.map(|name| palette.material(table, name)).transpose()?;
        add_import(table, palette, objects, &mut import, own)?;
        imports.push(import);
    }
    Ok(imports)
}

/// Adds the meshes of an import, of one material if that is given.
pub(super) fn add_import(
    table: Table<'_>,
    palette: &mut Palette,
    objects: &mut Objects,
    import: &mut Import,
    own: Option<u16>,
) -> Result<(), ReadError> {
    import
        .digests
        .extend(import.pictures.iter().map(|picture| picture.sha256.clone()));
    let places = match own {
        Some(_) => Vec::new(),
        None => add_materials(table, palette, import)?,
    };
    for mesh in import.meshes.drain(..) {
        let imported = mesh.material.or(places.len().checked_sub(1));
        let imported = imported.and_then(|material| places.get(material).copied());
        let Some(material) = own.or(imported) else {
            let found = format!("mesh \"{}\" without a material", mesh.name);
            return Err(table.error("material", found, "a material").into());
        };
        let label = format!("{}, mesh \"{}\"", table.label(), mesh.name);
        let shape = Shape::Mesh(Arc::new(Mesh::new(mesh.parts)));
        objects.add(shape, material, label);
    }
    Ok(())
}

fn placement(table: Table<'_>, mesh: &MeshTable) -> Result<Placement, ReadError> {
    table.place("position_m", mesh.position_m)?;
    let scale = table.length_m("scale", mesh.scale.unwrap_or(1.0))?;
    let rotation_deg = table.number_within("rotation_deg", mesh.rotation_deg, (-360.0, 360.0))?;
    let placed = Placement::new(scale, rotation_deg, mesh.position_m);
    Ok(match mesh.up {
        UpAxis::Y => placed.after(&Placement::Y_UP),
        UpAxis::Z => placed,
    })
}

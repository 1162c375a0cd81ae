//! Wavefront OBJ with MTL.
//!
//! As the file has its axes. Faces of more than three corners are cut into triangles; faces without normals
//! are flat. Of a material, `Kd` (linear) and `map_Kd` are the colour; `d` or `Tr` below 1/2 makes glass of
//! the index `Ni`; `Ks` above 0 a clear surface whose roughness is √√(2 / (Ns + 2)).
//!
//! Sources: Wavefront, *Object Files (.obj)*; the roughness is that of Walter et al. (2007), eq. 27, with
//! roughness² as glTF's α.

use std::cell::RefCell;
use std::path::Path;

use protocols::{InputError, ReadError, Sha256Digest};
use tobj::{LoadError, LoadOptions, MTLLoadResult};

use super::source::bounded_bytes;
use super::{
    Filter, Import, ImportedMaterial, ImportedMesh, ImportedSurface, ImportedTexture, Picture,
    Placement, Source, Wrap,
};
use crate::geometry::MeshParts;
use crate::matrix3;
use crate::shader::single;

/// The material libraries that were asked for, and what came of each.
type Libraries = RefCell<Vec<Library>>;

/// What came of a material library.
enum Library {
    Read(Sha256Digest),
    /// It cannot be had: all is grey.
    Missing(ReadError),
    /// It cannot be read.
    Wrong(InputError),
}

/// Reads an OBJ and places it in the world.
pub(super) fn read(source: &Source, placement: &Placement) -> Result<Import, ReadError> {
    let options = LoadOptions {
        triangulate: true,
        single_index: true,
        ..LoadOptions::default()
    };
    source.text()?;
    let libraries = Libraries::default();
    let mut rest = source.bytes.as_slice();
    let loaded = tobj::load_obj_buf(&mut rest, &options, |name| {
        library(source, name, &libraries)
    });
    let (models, materials) = loaded.map_err(|error| {
        let read = &source.bytes[..source.bytes.len() - rest.len()];
        let error = source.error(error.to_string(), "an OBJ file");
        let line = read.split(|&byte| byte == b'\n').count() - 1;
        if rest.is_empty() {
            error
        } else {
            error.at(format!("line {line}"))
        }
    })?;
    let mut import = Import::default();
    add_materials(source, &materials.unwrap_or_default(), &mut import)?;
    warn_of_libraries(source, libraries, &mut import)?;
    for model in models {
        import.meshes.push(mesh(model, placement));
    }
    Ok(import)
}

fn library(source: &Source, name: &Path, libraries: &Libraries) -> MTLLoadResult {
    let path = source.beside(&name.to_string_lossy());
    let (library, result) = match bounded_bytes(&path) {
        Err(error) => (Library::Missing(error), Err(LoadError::OpenFileFailed)),
        Ok(bytes) => {
            let result = match colour_fault(&bytes) {
                Some(_) => Err(LoadError::MaterialParseError),
                None => tobj::load_mtl_buf(&mut bytes.as_slice()),
            };
            let library = match &result {
                Ok(_) => Library::Read(Sha256Digest::of(&bytes)),
                Err(error) => Library::Wrong(wrong_library(&path, *error, &bytes)),
            };
            (library, result)
        }
    };
    libraries.borrow_mut().push(library);
    result
}

fn wrong_library(path: &Path, error: LoadError, bytes: &[u8]) -> InputError {
    let expected = "a material library (MTL)";
    match colour_fault(bytes) {
        None => InputError::new(path, error.to_string(), expected),
        Some((line, found)) => {
            let expected = format!("{expected} with colours of three numbers");
            InputError::new(path, format!("\"{found}\""), expected).at(format!("line {line}"))
        }
    }
}

/// The first colour of a library that is not three numbers: its line.
fn colour_fault(bytes: &[u8]) -> Option<(usize, String)> {
    let text = String::from_utf8_lossy(bytes);
    let is_wrong = |line: &str| {
        let mut words = line.split_whitespace();
        let is_colour = matches!(words.next(), Some("Ka" | "Kd" | "Ks" | "Ke"));
        let numbers = words.take(3).filter(|word| word.parse::<f32>().is_ok());
        is_colour && numbers.count() < 3
    };
    let mut lines = text.lines().enumerate();
    let found = lines.find(|(_, line)| is_wrong(line));
    found.map(|(line, text)| (line + 1, text.trim().to_owned()))
}

/// A library that is not there is told and leaves grey; one that cannot be read is an error.
fn warn_of_libraries(
    source: &Source,
    libraries: Libraries,
    import: &mut Import,
) -> Result<(), InputError> {
    for library in libraries.into_inner() {
        match library {
            Library::Read(digest) => import.digests.push(digest),
            Library::Wrong(error) => return Err(error),
            Library::Missing(error) => {
                let what = format!("its material library cannot be had ({error}): all is grey");
                import.warnings.push(source.warning("mtllib", &what));
            }
        }
    }
    Ok(())
}

fn mesh(model: tobj::Model, placement: &Placement) -> ImportedMesh {
    let tobj::Model { mesh, name } = model;
    let (corners, _) = mesh.positions.as_chunks::<3>();
    let vertices = corners
        .iter()
        .map(|corner| placement.place(corner.map(f64::from)).map(single));
    let turn = placement.for_normals();
    let (normals, _) = mesh.normals.as_chunks::<3>();
    let normals = normals
        .iter()
        .map(|normal| matrix3::times(&turn, normal.map(f64::from)).map(single));
    // OBJ counts v from the lower edge of the picture.
    let (points, _) = mesh.texcoords.as_chunks::<2>();
    let texture_points = points.iter().map(|[u, v]| [*u, 1.0 - v]);
    let (faces, _) = mesh.indices.as_chunks::<3>();
    let mut faces = faces.to_vec();
    if placement.mirrors() {
        for [_, b, c] in &mut faces {
            std::mem::swap(b, c);
        }
    }
    ImportedMesh {
        name,
        parts: MeshParts {
            vertices: vertices.collect(),
            faces,
            normals: normals.collect(),
            texture_points: texture_points.collect(),
        },
        material: mesh.material_id,
    }
}

fn add_materials(
    source: &Source,
    materials: &[tobj::Material],
    import: &mut Import,
) -> Result<(), ReadError> {
    for material in materials {
        let thing = format!("material \"{}\"", material.name);
        for (is_there, what) in [
            (
                material.normal_texture.is_some(),
                "bump and normal textures are not supported: ignored",
            ),
            (
                material.specular_texture.is_some(),
                "map_Ks is not supported: Ks alone counts",
            ),
            (
                material.shininess_texture.is_some(),
                "map_Ns is not supported: Ns alone counts",
            ),
            (
                material.dissolve_texture.is_some(),
                "map_d is not supported: d alone counts",
            ),
            (
                material.emissive.is_some_and(|colour| colour != [0.0; 3]),
                "emission (Ke) is not supported: ignored",
            ),
        ] {
            if is_there {
                import.warnings.push(source.warning(&thing, what));
            }
        }
        let texture = match &material.diffuse_texture {
            None => None,
            Some(file) => {
                // Options such as -s 2 2 2 stand before the name.
                let options = file
                    .starts_with('-')
                    .then(|| file.rsplit(' ').next())
                    .flatten();
                if options.is_some() {
                    let what =
                        format!("the options of map_Kd \"{file}\" are not supported: ignored");
                    import.warnings.push(source.warning(&thing, &what));
                }
                let file = options.unwrap_or(file);
                let picture = Picture::read(&source.beside(&file.replace('\\', "/")), &thing)?;
                import.pictures.push(picture);
                Some(ImportedTexture {
                    picture: import.pictures.len() - 1,
                    wrap: [Wrap::Repeat; 2],
                    filter: Filter::Bilinear,
                })
            }
        };
        let surface = surface(source, &thing, material, import);
        let colour = material.diffuse.unwrap_or([0.8; 3]).map(f64::from);
        import.materials.push(ImportedMaterial {
            name: material.name.clone(),
            colour,
            texture,
            surface,
        });
    }
    Ok(())
}

fn surface(
    source: &Source,
    thing: &str,
    material: &tobj::Material,
    import: &mut Import,
) -> ImportedSurface {
    let index = material.optical_density.map_or(1.5, f64::from);
    let refractive_index = if (1.0..=4.0).contains(&index) {
        index
    } else {
        1.5
    };
    let dissolve = material.dissolve.unwrap_or(1.0);
    if dissolve < 1.0 {
        let taken = if dissolve < 0.5 {
            "clear glass"
        } else {
            "opaque"
        };
        let what = format!("a dissolve (d) of {dissolve} is not supported: taken as {taken}");
        import.warnings.push(source.warning(thing, &what));
    }
    if dissolve < 0.5 {
        return ImportedSurface::Glass { refractive_index };
    }
    if material.specular.is_none_or(|colour| colour == [0.0; 3]) {
        return ImportedSurface::Matte;
    }
    let exponent = f64::from(material.shininess.unwrap_or(0.0)).max(0.0);
    ImportedSurface::Glossy {
        refractive_index,
        roughness: (2.0 / (exponent + 2.0)).sqrt().sqrt(),
    }
}

//! Stanford PLY, as text or binary.
//!
//! As the file has its axes. Read: `vertex` with x, y, z, and if they are there nx, ny, nz and a texture
//! point (u, v or s, t or their long names); `face` with a list of vertices, cut into triangles from its
//! first corner. A PLY has no material.
//!
//! Source: Turk (1994), *The PLY Polygon File Format*.

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Header, Property, PropertyAccess, PropertyAccessResult};
use protocols::{InputError, ReadError};

use super::{Import, ImportedMesh, Placement, Source};
use crate::geometry::MeshParts;
use crate::matrix3;
use crate::shader::single;

/// The properties of a vertex that are read, in order: place, normal, texture point.
const NAMES: [&[&str]; 8] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texture_s"],
    &["v", "t", "texture_v", "texture_t"],
];

/// A vertex: a number for each of [`NAMES`].
#[derive(Clone, Copy, Default)]
struct Vertex([f64; 8]);

/// The vertices of a face; one that cannot be a vertex is the largest number.
#[derive(Clone, Default)]
struct Face(Vec<u32>);

/// An element that is passed over.
struct Other;

/// Reads a PLY and places it in the world.
pub(super) fn read(source: &Source, placement: &Placement) -> Result<Import, ReadError> {
    let mut reader = Reader::new(source.bytes.as_slice());
    let wrong = |error: ply_rs_bw::parser::ParseError| {
        let found = error.to_string().replace(['\n', '\t'], " ");
        source.error(found, "a PLY file")
    };
    let header = Parser::<Other>::new()
        .read_header(&mut reader)
        .map_err(wrong)?;
    check_header(source, &header)?;
    let mut import = Import::default();
    let (mut vertices, mut faces) = (Vec::<Vertex>::new(), Vec::<Face>::new());
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => {
                let parser = Parser::<Vertex>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                vertices = read.map_err(wrong)?;
            }
            "face" => {
                let parser = Parser::<Face>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                faces = read.map_err(wrong)?;
            }
            other => {
                let parser = Parser::<Other>::new();
                let read = parser.read_payload_for_element(&mut reader, element, &header);
                read.map_err(wrong)?;
                let what = "is not supported: left out";
                import
                    .warnings
                    .push(source.warning(&format!("element \"{other}\""), what));
            }
        }
    }
    warn_of_colours(source, &header, &mut import);
    let name = source
        .path
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into());
    import.meshes.push(ImportedMesh {
        name,
        parts: parts(&header, &vertices, &faces, placement),
        material: None,
    });
    Ok(import)
}

fn has(header: &Header, name: &str) -> bool {
    let vertex = header.elements.get("vertex");
    vertex.is_some_and(|vertex| vertex.properties.contains_key(name))
}

fn has_any(header: &Header, names: &[&str]) -> bool {
    names.iter().any(|name| has(header, name))
}

fn check_header(source: &Source, header: &Header) -> Result<(), InputError> {
    let face = header.elements.get("face");
    let lists = ["vertex_indices", "vertex_index"];
    let has_list =
        face.is_some_and(|face| lists.iter().any(|name| face.properties.contains_key(*name)));
    if ["x", "y", "z"].iter().all(|name| has(header, name)) && has_list {
        return Ok(());
    }
    let expected = "an element vertex with x, y and z and an element face with vertex_indices";
    Err(source.error("no such elements", expected).at("the header"))
}

fn warn_of_colours(source: &Source, header: &Header, import: &mut Import) {
    if has_any(header, &["red", "diffuse_red", "r"]) {
        let what = "vertex colours are not supported: ignored";
        import
            .warnings
            .push(source.warning("element \"vertex\"", what));
    }
}

fn parts(header: &Header, vertices: &[Vertex], faces: &[Face], placement: &Placement) -> MeshParts {
    let turn = placement.for_normals();
    let places = vertices
        .iter()
        .map(|Vertex(v)| placement.place([v[0], v[1], v[2]]).map(single));
    let normals = vertices
        .iter()
        .map(|Vertex(v)| matrix3::times(&turn, [v[3], v[4], v[5]]).map(single));
    // PLY counts v from the lower edge of the picture.
    let points = vertices
        .iter()
        .map(|Vertex(v)| [single(v[6]), single(1.0 - v[7])]);
    let triangles = faces.iter().flat_map(|Face(corners)| {
        let rest = corners.get(1..).unwrap_or_default();
        rest.windows(2).map(|pair| {
            if placement.mirrors() {
                [corners[0], pair[1], pair[0]]
            } else {
                [corners[0], pair[0], pair[1]]
            }
        })
    });
    let are_there =
        |range: std::ops::Range<usize>| NAMES[range].iter().all(|names| has_any(header, names));
    MeshParts {
        vertices: places.collect(),
        faces: triangles.collect(),
        normals: if are_there(3..6) {
            normals.collect()
        } else {
            Vec::new()
        },
        texture_points: if are_there(6..8) {
            points.collect()
        } else {
            Vec::new()
        },
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(place) = NAMES.iter().position(|names| names.contains(&name)) else {
            return PropertyAccessResult::Ignored;
        };
        self.0[place] = match property {
            Property::Float(value) => f64::from(value),
            Property::Double(value) => value,
            Property::Char(value) => f64::from(value),
            Property::UChar(value) => f64::from(value),
            Property::Short(value) => f64::from(value),
            Property::UShort(value) => f64::from(value),
            Property::Int(value) => f64::from(value),
            Property::UInt(value) => f64::from(value),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !matches!(name, "vertex_indices" | "vertex_index") {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match property {
            Property::ListChar(list) => list.into_iter().map(index).collect(),
            Property::ListUChar(list) => list.into_iter().map(index).collect(),
            Property::ListShort(list) => list.into_iter().map(index).collect(),
            Property::ListUShort(list) => list.into_iter().map(index).collect(),
            Property::ListInt(list) => list.into_iter().map(index).collect(),
            Property::ListUInt(list) => list,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}

fn index<T: TryInto<u32>>(value: T) -> u32 {
    value.try_into().unwrap_or(u32::MAX)
}

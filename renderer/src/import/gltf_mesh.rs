//! The meshes of a glTF: each primitive of triangles becomes a mesh of one material.

use gltf::mesh::Mode;
use gltf::texture::TextureTransform;
use gltf::{Mesh, Primitive, Semantic};
use protocols::InputError;

use super::gltf_file::{GltfFile, named};
use super::{Import, ImportedMesh, Placement};
use crate::geometry::MeshParts;
use crate::matrix3;
use crate::shader::single;

/// Adds the primitives of a mesh, placed in the world.
pub(super) fn add(
    file: &GltfFile<'_>,
    mesh: &Mesh<'_>,
    placement: &Placement,
    import: &mut Import,
) -> Result<(), InputError> {
    let name = named("mesh", mesh.name(), mesh.index());
    for primitive in mesh.primitives() {
        if primitive.morph_targets().len() > 0 {
            let what = "morph targets are not supported: ignored";
            file.warn(import, &name, what);
        }
        if matches!(
            primitive.mode(),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
        ) {
            let what = format!(
                "primitive {}: {:?} are not supported: left out",
                primitive.index(),
                primitive.mode()
            );
            file.warn(import, &name, &what);
            continue;
        }
        if primitive.get(&Semantic::Colors(0)).is_some() {
            file.warn(import, &name, "vertex colours are not supported: ignored");
        }
        let Some(parts) = parts(file, &primitive, placement)? else {
            let what = format!("primitive {} has no positions: left out", primitive.index());
            file.warn(import, &name, &what);
            continue;
        };
        let own_name = mesh
            .name()
            .map_or_else(|| mesh.index().to_string(), ToOwned::to_owned);
        import.meshes.push(ImportedMesh {
            name: own_name,
            parts,
            material: primitive.material().index(),
        });
    }
    Ok(())
}

fn parts(
    file: &GltfFile<'_>,
    primitive: &Primitive<'_>,
    placement: &Placement,
) -> Result<Option<MeshParts>, InputError> {
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        return Ok(None);
    };
    let positions: Vec<[f32; 3]> = file.floats(&positions)?;
    let vertices: Vec<[f32; 3]> = positions
        .iter()
        .map(|position| placement.place(position.map(f64::from)).map(single))
        .collect();
    let mut normals: Vec<[f32; 3]> = match primitive.get(&Semantic::Normals) {
        Some(accessor) => file.floats(&accessor)?,
        None => Vec::new(),
    };
    let turn = placement.for_normals();
    for normal in &mut normals {
        *normal = matrix3::times(&turn, normal.map(f64::from)).map(single);
    }
    let indices = match primitive.indices() {
        Some(accessor) => file.indices(&accessor)?,
        None => (0..u32::try_from(vertices.len()).unwrap_or(u32::MAX)).collect(),
    };
    let mut faces = triangles(primitive.mode(), &indices);
    if placement.mirrors() {
        for [_, b, c] in &mut faces {
            std::mem::swap(b, c);
        }
    }
    Ok(Some(MeshParts {
        vertices,
        faces,
        normals,
        texture_points: texture_points(file, primitive)?,
    }))
}

/// The triangles of a list, a strip or a fan; a strip turns every other one, so that all face the same way.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let odd = (0..).map(|place| place % 2 == 1);
            let corners = indices.windows(3).zip(odd);
            corners
                .map(|(at, is_odd)| {
                    if is_odd {
                        [at[1], at[0], at[2]]
                    } else {
                        [at[0], at[1], at[2]]
                    }
                })
                .collect()
        }
        Mode::TriangleFan => {
            let rest = indices.get(1..).unwrap_or_default();
            rest.windows(2)
                .map(|pair| [indices[0], pair[0], pair[1]])
                .collect()
        }
        _ => indices
            .chunks_exact(3)
            .map(|at| [at[0], at[1], at[2]])
            .collect(),
    }
}

/// The texture points that the base colour uses, moved as its `KHR_texture_transform` says.
fn texture_points(
    file: &GltfFile<'_>,
    primitive: &Primitive<'_>,
) -> Result<Vec<[f32; 2]>, InputError> {
    let material = primitive.material();
    let Some(texture) = material.pbr_metallic_roughness().base_color_texture() else {
        return Ok(Vec::new());
    };
    let transform = texture.texture_transform();
    let set = transform.as_ref().and_then(TextureTransform::tex_coord);
    let set = set.unwrap_or(texture.tex_coord());
    let Some(accessor) = primitive.get(&Semantic::TexCoords(set)) else {
        let found = format!("no TEXCOORD_{set}, which its base colour texture uses");
        let place = named("material", material.name(), material.index().unwrap_or(0));
        return Err(file.source.error(found, "texture points").at(place));
    };
    let mut points: Vec<[f32; 2]> = file.floats(&accessor)?;
    if let Some(transform) = transform {
        let (offset, scale) = (transform.offset(), transform.scale());
        let angle_rad = f64::from(transform.rotation());
        let (sin, cos) = (single(libm::sin(angle_rad)), single(libm::cos(angle_rad)));
        for point in &mut points {
            let [u, v] = [point[0] * scale[0], point[1] * scale[1]];
            *point = [cos * u + sin * v + offset[0], cos * v - sin * u + offset[1]];
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_are_as_the_standard_draws_them() {
        // glTF 2.0, section 3.7.2.1: strip p_i = {v_i, v_(i+(1+i%2)), v_(i+(2-i%2))}, fan {v_(i+1), v_(i+2), v_0}.
        let strip = triangles(Mode::TriangleStrip, &[0, 1, 2, 3, 4]);
        for (face, same) in strip.iter().zip([[0, 1, 2], [1, 3, 2], [2, 3, 4]]) {
            assert!(
                (0..3).any(|turn| [0, 1, 2].map(|i| same[(i + turn) % 3]) == *face),
                "{face:?}"
            );
        }
        let fan = triangles(Mode::TriangleFan, &[5, 6, 7, 8]);
        assert_eq!(fan, [[5, 6, 7], [5, 7, 8]]);
        assert!(triangles(Mode::TriangleFan, &[]).is_empty());
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3]).len(), 1);
    }
}

//! A mesh of a file, and what every mesh is checked for.

use protocols::InputError;

use super::Source;
use crate::geometry::MeshParts;

/// Nothing in a scene is farther than this from its origin.
const FARTHEST_M: f32 = 1e6;

/// Triangles of one material, in the world.
#[derive(Clone, Debug)]
pub(crate) struct ImportedMesh {
    pub(crate) name: String,
    pub(crate) parts: MeshParts,
    /// A place in the import's materials.
    pub(crate) material: Option<usize>,
}

impl ImportedMesh {
    /// Leaves out triangles that have no area or are nowhere, and says how many.
    ///
    /// # Errors
    ///
    /// If a triangle names a vertex that is not there, or a vertex is absurdly far away.
    pub(super) fn check(
        &mut self,
        source: &Source,
        warnings: &mut Vec<String>,
    ) -> Result<(), InputError> {
        let thing = format!("mesh \"{}\"", self.name);
        let MeshParts {
            vertices,
            faces,
            normals,
            texture_points,
        } = &mut self.parts;
        let count = vertices.len();
        let missing = faces.iter().flatten().find(|&&at| at as usize >= count);
        if let Some(missing) = missing {
            let found = format!("a triangle with the vertex {missing} of {count}");
            let expected = "triangles of vertices that are there (from 0)";
            return Err(source.error(found, expected).at(thing));
        }
        let far = vertices.iter().flatten();
        let is_far = |value: &&f32| value.is_finite() && value.abs() > FARTHEST_M;
        if let Some(far) = far.copied().find(|value| is_far(&value)) {
            let expected = format!("coordinates within {FARTHEST_M} m of the origin");
            let error = source.error(format!("the coordinate {far}"), expected);
            return Err(error.at(thing).remedy("scale it with `scale`"));
        }
        let before = faces.len();
        faces.retain(|face| has_area(face.map(|corner| vertices[corner as usize])));
        let left_out = before - faces.len();
        if left_out > 0 {
            let what = format!(
                "{left_out} of {before} triangles have no area or a corner that is not a number: left out"
            );
            warnings.push(source.warning(&thing, &what));
        }
        for (list, what) in [
            (normals.len(), "normals"),
            (texture_points.len(), "texture points"),
        ] {
            if list != 0 && list != count {
                let what = format!("{list} {what} for {count} vertices: ignored");
                warnings.push(source.warning(&thing, &what));
            }
        }
        let odd = texture_points
            .iter()
            .flatten()
            .any(|value| !value.is_finite());
        if odd {
            let what = "texture points that are not numbers: taken as 0";
            warnings.push(source.warning(&thing, what));
            for value in texture_points.iter_mut().flatten() {
                *value = if value.is_finite() { *value } else { 0.0 };
            }
        }
        Ok(())
    }
}

fn has_area(corners: [[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let edge = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let (u, v) = (edge(b), edge(c));
    let square: f64 = [(1, 2), (2, 0), (0, 1)]
        .map(|(i, j)| u[i] * v[j] - u[j] * v[i])
        .iter()
        .map(|part| part * part)
        .sum();
    square > 0.0 && square.is_finite()
}

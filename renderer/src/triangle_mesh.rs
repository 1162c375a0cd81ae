//! A mesh on its own: where rays meet triangles, without a scene.

use crate::geometry::{Mesh, MeshParts, Part, Ray, Span, Vector};

/// Triangles that rays can be tried against.
///
/// Vertices are in single precision. A triangle without area, or with a vertex that is not there or not
/// finite, is never hit.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    mesh: Mesh,
}

impl TriangleMesh {
    /// Builds the mesh of these vertices and of faces that name three of them each.
    pub fn new(vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Self {
        let parts = MeshParts {
            vertices,
            faces,
            ..MeshParts::default()
        };
        Self {
            mesh: Mesh::new(parts),
        }
    }

    /// How many triangles can be hit.
    pub fn triangles(&self) -> usize {
        self.mesh.triangles()
    }

    /// The distance along a unit direction, and the face, of the first hit; of equal ones the first face's.
    ///
    /// ```
    /// let corners = vec![[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
    /// let mesh = renderer::TriangleMesh::new(corners, vec![[0, 1, 2]]);
    /// assert_eq!(mesh.nearest([0.25, 0.25, 0.0], [0.0, 0.0, 1.0]), Some((2.0, 0)));
    /// assert_eq!(mesh.nearest([0.75, 0.75, 0.0], [0.0, 0.0, 1.0]), None);
    /// ```
    #[inline]
    pub fn nearest(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<(f64, u32)> {
        let hit = self
            .mesh
            .hit(&ray(origin, direction), Span::up_to(f64::INFINITY))?;
        match hit.part {
            Part::Face(face) => Some((hit.distance_m, face)),
            Part::Side | Part::Cap => None,
        }
    }

    /// Whether anything is hit before this distance along a unit direction.
    #[inline]
    pub fn is_blocked(&self, origin: [f64; 3], direction: [f64; 3], up_to: f64) -> bool {
        self.mesh
            .is_hit(&ray(origin, direction), Span::up_to(up_to))
    }
}

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray {
        origin: Vector::from(origin),
        direction: Vector::from(direction),
    }
}

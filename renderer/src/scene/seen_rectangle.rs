//! A rectangle of light as it is seen from a place: directions that are uniform in its solid angle.
//!
//! However near the place is, no direction counts for more than another, so that a light which touches a
//! surface leaves no bright specks on it.
//!
//! Source: Ureña, Fajardo & King (2013), "An Area-Preserving Parametrization for Spherical Rectangles",
//! Computer Graphics Forum 32(4).

use std::f64::consts::TAU;

use crate::geometry::Vector;

/// Below this solid angle in steradians, where the sum of angles has lost half of its digits, all places of
/// the rectangle count the same to one part in a million.
const SMALL_SR: f64 = 1e-7;

/// A rectangle seen from a place in front of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenRectangle {
    /// Unit vectors along both edges and towards the place.
    axes: [Vector; 3],
    /// The sides, along both edges from the place.
    x_m: [f64; 2],
    y_m: [f64; 2],
    /// The plane, from the place: negative.
    z_m: f64,
    directions: Directions,
}

/// How directions are spread.
#[derive(Clone, Copy, Debug)]
enum Directions {
    /// Uniform in the solid angle, by the paper's b0, b1 and k.
    Uniform { b: [f64; 2], k_rad: f64 },
    /// Uniform in the area, which is small or far away.
    ByArea,
}

impl SeenRectangle {
    /// The rectangle as it is seen from a place, and its solid angle in steradians; `None` from behind or from
    /// its own plane.
    pub(crate) fn new(place: Vector, corner: Vector, edges: [Vector; 2]) -> Option<(Self, f64)> {
        let lengths_m = edges.map(Vector::length);
        let [x, y] = [0, 1].map(|axis| edges[axis] * lengths_m[axis].recip());
        let z = x.cross(y);
        let to_corner = corner - place;
        let z_m = to_corner.dot(z);
        if z_m >= 0.0 {
            return None;
        }
        let from_m = [to_corner.dot(x), to_corner.dot(y)];
        let mut seen = Self {
            axes: [x, y, z],
            x_m: [from_m[0], from_m[0] + lengths_m[0]],
            y_m: [from_m[1], from_m[1] + lengths_m[1]],
            z_m,
            directions: Directions::ByArea,
        };
        let (directions, solid_angle_sr) = seen.spread();
        if solid_angle_sr > SMALL_SR {
            seen.directions = directions;
            return Some((seen, solid_angle_sr));
        }
        // That of a small rectangle: A cos θ / d².
        let [x_m, y_m] = [seen.x_m, seen.y_m].map(|[from, to]| 0.5 * (from + to));
        let squared = x_m * x_m + y_m * y_m + z_m * z_m;
        let area = lengths_m[0] * lengths_m[1];
        Some((seen, area * -z_m / (squared * squared.sqrt())))
    }

    /// The uniform directions and the solid angle, from the angles between the planes through the edges.
    fn spread(&self) -> (Directions, f64) {
        let z = self.z_m;
        let [x0, x1] = self.x_m;
        let [y0, y1] = self.y_m;
        // The third coordinates of the planes' unit normals; of the others only one is not 0, and no two planes
        // that meet share it.
        let normal_z = |side_m: f64| side_m / libm::hypot(side_m, z);
        let [n0, n1, n2, n3] = [-normal_z(y0), normal_z(x1), normal_z(y1), -normal_z(x0)];
        let angle = |one: f64, other: f64| libm::acos(-(one * other));
        let k_rad = TAU - angle(n2, n3) - angle(n3, n0);
        let solid_angle_sr = angle(n0, n1) + angle(n1, n2) - k_rad;
        let b = [n0, n2];
        (Directions::Uniform { b, k_rad }, solid_angle_sr)
    }

    /// The way to the place of the rectangle with these coordinates from 0 to 1.
    pub(crate) fn path(&self, solid_angle_sr: f64, at: [f64; 2]) -> Vector {
        let [x_m, y_m] = match self.directions {
            Directions::ByArea => {
                let within = |[from, to]: [f64; 2], at: f64| from + (to - from) * at;
                [within(self.x_m, at[0]), within(self.y_m, at[1])]
            }
            Directions::Uniform { b, k_rad } => {
                self.uniform(b, at[0] * solid_angle_sr + k_rad, at[1])
            }
        };
        let [x, y, z] = self.axes;
        x * x_m + y * y_m + z * self.z_m
    }

    fn uniform(&self, b: [f64; 2], angle_rad: f64, at: f64) -> [f64; 2] {
        let z = self.z_m;
        let f = (libm::cos(angle_rad) * b[0] - b[1]) / libm::sin(angle_rad);
        let c = libm::hypot(f, b[0]).recip().copysign(f);
        let c = c.clamp(-1.0, 1.0);
        let x_m = -c * z / (1.0 - c * c).sqrt();
        // Not a number where the place is in line with an edge: then any place between is right.
        let x_m = x_m.max(self.x_m[0]).min(self.x_m[1]);
        let squared = x_m * x_m + z * z;
        let [h0, h1] = self.y_m.map(|y| y / (squared + y * y).sqrt());
        let h = h0 + at * (h1 - h0);
        let y_m = h * squared.sqrt() / (1.0 - h * h).sqrt();
        [x_m, y_m.max(self.y_m[0]).min(self.y_m[1])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of 2 × 1 m in the plane z = 0, which shines down.
    fn seen(place: [f64; 3]) -> Option<(SeenRectangle, f64)> {
        let [x, y, z] = place;
        let edges = [Vector::new(0.0, 1.0, 0.0), Vector::new(2.0, 0.0, 0.0)];
        SeenRectangle::new(Vector::new(x, y, z), Vector::new(0.0, 0.0, 0.0), edges)
    }

    /// The solid angle of the triangles to its corners: Van Oosterom & Strackee (1983).
    fn by_triangles(place: [f64; 3]) -> f64 {
        let [x, y, z] = place;
        let to = |corner: [f64; 2]| Vector::new(corner[0] - x, corner[1] - y, -z);
        let triangle = |corners: [[f64; 2]; 3]| {
            let [a, b, c] = corners.map(|corner| to(corner).normalized());
            let volume = a.dot(b.cross(c));
            2.0 * libm::atan2(volume.abs(), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
        };
        triangle([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0]])
            + triangle([[0.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    }

    const PLACES: [[f64; 3]; 7] = [
        [0.3, 0.4, -1.0],
        [0.3, 0.4, -1e-3],
        [-1.0, 2.0, -0.5],
        [2.0, 1.0, -0.1],
        [0.0, 0.5, -1e-6],
        [30.0, -20.0, -50.0],
        [2000.0, -3000.0, -5000.0],
    ];

    #[test]
    fn the_solid_angle_is_that_of_two_triangles() {
        for place in PLACES {
            let (_, ours) = seen(place).unwrap();
            let expected = by_triangles(place);
            assert!((ours / expected - 1.0).abs() < 1e-6, "{ours} {expected}");
        }
    }

    #[test]
    fn equal_shares_of_the_square_are_equal_solid_angles() {
        // The places of a fine grid that fall on the half x < 1 of the rectangle are its share.
        for place in PLACES {
            let (rectangle, solid_angle_sr) = seen(place).unwrap();
            let side = 200_u32;
            let at = |number: u32| (f64::from(number) + 0.5) / f64::from(side);
            let grid = (0..side).flat_map(|row| (0..side).map(move |column| [at(row), at(column)]));
            let mut near = 0;
            for at in grid {
                let path = rectangle.path(solid_angle_sr, at);
                let [x, y, z] = [path.x + place[0], path.y + place[1], path.z + place[2]];
                let slack = 1e-9 * (1.0 + place[0].abs() + place[1].abs());
                assert!((-slack..=2.0 + slack).contains(&x) && (-slack..=1.0 + slack).contains(&y));
                assert!(z.abs() <= slack);
                near += u32::from(x < 1.0);
            }
            let half = [Vector::new(0.0, 1.0, 0.0), Vector::new(1.0, 0.0, 0.0)];
            let from = Vector::new(place[0], place[1], place[2]);
            let corner = Vector::new(0.0, 0.0, 0.0);
            let (_, half_sr) = SeenRectangle::new(from, corner, half).unwrap();
            let share = f64::from(near) / f64::from(side * side);
            assert!((share - half_sr / solid_angle_sr).abs() < 0.006, "{share}");
        }
    }

    #[test]
    fn from_behind_and_from_its_plane_there_is_nothing() {
        assert!(seen([0.3, 0.4, 1.0]).is_none());
        assert!(seen([3.0, 0.4, 0.0]).is_none());
    }
}

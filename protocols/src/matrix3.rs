//! 3 × 3 matrices, small enough to be worked out by the compiler.
//!
//! Not here: what a matrix means; see [`crate::opponent`].

/// A 3 × 3 matrix, row by row.
pub type Matrix3 = [[f64; 3]; 3];

/// `matrix · vector`.
pub const fn times(matrix: &Matrix3, vector: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = vector;
    let [a, b, c] = matrix;
    [
        a[0] * x + a[1] * y + a[2] * z,
        b[0] * x + b[1] * y + b[2] * z,
        c[0] * x + c[1] * y + c[2] * z,
    ]
}

/// The product `left · right`.
pub const fn product(left: &Matrix3, right: &Matrix3) -> Matrix3 {
    let columns = transpose(right);
    transpose(&[
        times(left, columns[0]),
        times(left, columns[1]),
        times(left, columns[2]),
    ])
}

/// The matrix with its rows as columns.
pub const fn transpose(matrix: &Matrix3) -> Matrix3 {
    let [a, b, c] = matrix;
    [[a[0], b[0], c[0]], [a[1], b[1], c[1]], [a[2], b[2], c[2]]]
}

/// The determinant.
pub const fn determinant(matrix: &Matrix3) -> f64 {
    let [a, b, c] = matrix;
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The inverse, by cofactors; not finite if the determinant is zero.
pub const fn inverse(matrix: &Matrix3) -> Matrix3 {
    let [a, b, c] = matrix;
    let scale = 1.0 / determinant(matrix);
    [
        [
            scale * (b[1] * c[2] - b[2] * c[1]),
            scale * (a[2] * c[1] - a[1] * c[2]),
            scale * (a[1] * b[2] - a[2] * b[1]),
        ],
        [
            scale * (b[2] * c[0] - b[0] * c[2]),
            scale * (a[0] * c[2] - a[2] * c[0]),
            scale * (a[2] * b[0] - a[0] * b[2]),
        ],
        [
            scale * (b[0] * c[1] - b[1] * c[0]),
            scale * (a[1] * c[0] - a[0] * c[1]),
            scale * (a[0] * b[1] - a[1] * b[0]),
        ],
    ]
}

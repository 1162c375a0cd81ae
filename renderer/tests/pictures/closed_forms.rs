//! Whole pictures that a formula gives: from the scene's text by the tree to the filtered pixel.

use std::path::Path;

use protocols::{Channel, PerChannel, Quadrature};
use renderer::{ChannelImage, Reach, Scene, TracePlan, reconstruct, trace};

use crate::analytic::plan;

/// The channels of D65 itself for Y = 1: `color_reference.py` (numpy), `D65_spectral_ACC`.
const D65: [f64; 3] = [
    1.000_125_114_944_255_4,
    -0.029_368_524_960_972_5,
    0.553_620_892_428_914_4,
];

const SIZE_PX: [u32; 2] = [16, 12];

/// A camera 2 m over the plane z = 0 that sees 4 m from top to bottom: x to the right, y up.
const FROM_ABOVE: &str = r"
camera = { position_m = [0, 0, 2], look_at_m = [0, 0, 0], up = [0, 1, 0], vertical_field_of_view_deg = 90 }
[diffuse.grey]
reflectance = [[400, 0.5]]
";
const PX_PER_M: f64 = 3.0;

fn picture(objects: &str, rays: usize) -> PerChannel<ChannelImage> {
    let text = format!("{objects}{FROM_ABOVE}");
    let scene = Scene::from_toml(Path::new("test.toml"), &text).unwrap();
    let sampler = scene.sampler(Quadrature::Bands(16), SIZE_PX);
    let request = TracePlan {
        size_px: SIZE_PX,
        ..plan(rays)
    };
    let tree = trace(&sampler, &request, &|_, _| ());
    PerChannel::from_fn(|channel| {
        let leaves = tree.leaves(channel, Reach::rays(rays)).unwrap();
        reconstruct(&leaves, SIZE_PX)
    })
}

/// The pixels that the filter does not carry over the border, with the middle of each in pixels.
fn inner_pixels() -> impl Iterator<Item = (usize, [f64; 2])> {
    let [width, height] = SIZE_PX;
    let rows = 1..height - 1;
    rows.flat_map(move |row| (1..width - 1).map(move |column| (row, column)))
        .map(move |(row, column)| {
            let middle = [column, row].map(|place| f64::from(place) + 0.5);
            ((row * width + column) as usize, middle)
        })
}

/// The tent's integral up to `t` as a sum of small steps: the midpoint rule on the straight pieces.
fn ramp(t: f64) -> f64 {
    let piece = |from: f64, to: f64| {
        let to = to.min(t);
        if to > from {
            (to - from) * (1.0 - (0.5 * (from + to)).abs())
        } else {
            0.0
        }
    };
    piece(-1.0, 0.0) + piece(0.0, 1.0)
}

/// The part of a pixel's tent on the side `cos x + sin y < offset` of a line, in pixels from its middle.
///
/// Exact along x; along y the midpoint rule with 2000 steps of 1/1000 pixel. The integrand is smooth between
/// five places, so the error is below the square of a step.
fn covered(cos: f64, sin: f64, offset: f64) -> f64 {
    let steps = 2000;
    let parts = (0..steps).map(|step| {
        let y = (f64::from(step) + 0.5) / f64::from(steps) * 2.0 - 1.0;
        let x = (offset - sin * y) / cos;
        (1.0 - y.abs()) * ramp(x)
    });
    parts.sum::<f64>() * 2.0 / f64::from(steps)
}

/// Light from straight above on a sheet that ends at a line, black beyond it: every pixel is the tent's
/// integral on one side of the line. At 25 degrees, upright through the middle of pixels (which are half
/// covered), and upright through a third of a pixel.
#[test]
fn an_edge_is_the_integral_of_the_tent() {
    for (degrees, edge_m) in [(25.0_f64, 0.1), (0.0, 0.5 / PX_PER_M), (0.0, 1.0 / 9.0)] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let along = |n: f64, d: f64| [n * cos - d * sin, n * sin + d * cos, 0.0];
        let objects = format!(
            "rectangle = [{{ material = \"grey\", corner_m = {:?}, edge_u_m = {:?}, edge_v_m = {:?} }}]\n\
             distant_light = [{{ from = [0, 0, 1], emittance = \"D65\", illuminance = 1 }}]\n",
            along(edge_m - 18.0, -9.0),
            along(18.0, 0.0),
            along(0.0, 18.0),
        );
        let images = picture(&objects, 40_000);
        let mut grey = 0;
        for (place, [x, y]) in inner_pixels() {
            // Upwards is against the rows.
            let middle_m = [(x - 8.0) / PX_PER_M, (6.0 - y) / PX_PER_M];
            let offset_px = PX_PER_M * (edge_m - cos * middle_m[0] - sin * middle_m[1]);
            let covered = covered(cos, sin, offset_px);
            grey += u32::from(covered > 0.01 && covered < 0.99);
            for (channel, of_light) in Channel::ALL.into_iter().zip(D65) {
                let ours = f64::from(images[channel].values()[place]);
                let expected = 0.5 * covered * of_light;
                // Cells across the edge are a few thousandths of a pixel wide.
                assert!(
                    (ours - expected).abs() < 2e-3,
                    "{degrees} degrees, {channel}, pixel {place}: {ours}, not {expected}"
                );
            }
            if degrees == 0.0 && offset_px.abs() < 1e-9 {
                assert!((covered - 0.5).abs() < 1e-9);
            }
        }
        assert!(grey >= 10, "the edge meets {grey} pixels");
    }
}

/// I cos θ / d² in every pixel. The tent has the variance 1/6 along each axis, so a pixel is the value in its
/// middle and a twelfth of the Laplacian, here found by differences; what is left is of fourth order.
#[test]
fn a_plane_under_a_point_light_is_i_cos_theta_over_d_squared_in_every_pixel() {
    let objects = "ground = [{ material = \"grey\", height_m = 0 }]\n\
                   point_light = [{ position_m = [0.7, -0.4, 1.5], emittance = \"D65\", intensity = 2 }]\n";
    let images = picture(objects, 100_000);
    let reflected = |x: f64, y: f64| {
        let place_m = [(x - 8.0) / PX_PER_M, (6.0 - y) / PX_PER_M];
        let d_squared = (place_m[0] - 0.7).powi(2) + (place_m[1] + 0.4).powi(2) + 1.5 * 1.5;
        0.5 * 2.0 * 1.5 / d_squared.powf(1.5)
    };
    for (place, [x, y]) in inner_pixels() {
        let step = 0.01;
        let around = [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)];
        let around = around.map(|(dx, dy)| reflected(x + dx, y + dy));
        let laplacian = (around.iter().sum::<f64>() - 4.0 * reflected(x, y)) / (step * step);
        let expected = reflected(x, y) + laplacian / 12.0;
        for (channel, of_light) in Channel::ALL.into_iter().zip(D65) {
            let ours = f64::from(images[channel].values()[place]);
            assert!(
                (ours - expected * of_light).abs() < 1e-3,
                "{channel}, pixel {place}: {ours}, not {}",
                expected * of_light
            );
        }
    }
}

/// Every surface upright, white and in ambient light: the wall, a coated rod that mirrors it and a perfect
/// mirror all are of the same brightness, so that nothing is seen. Glass neither: what it mirrors and what it lets
/// through sum to all, but for the rays too weak or too late to be followed.
#[test]
fn in_a_white_furnace_nothing_is_seen() {
    let rod = |material: &str, x: f64| {
        format!(
            "{{ material = \"{material}\", base_m = [{x}, 3, -500], top_m = [{x}, 3, 500], radius_m = 0.6 }}"
        )
    };
    let exact = 1e-6;
    // At most three rays of a path end unfollowed, each worth less than 1/1024.
    let with_weak_rays_left_out = 3.0 / 1024.0;
    for (material, tolerance) in [
        ("coated", exact),
        ("silver", exact),
        ("white", exact),
        ("crystal", with_weak_rays_left_out),
    ] {
        let text = format!(
            r#"
camera = {{ position_m = [0, -1, 0], look_at_m = [0, 1, 0.3], up = [0, 0, 1], vertical_field_of_view_deg = 60 }}
cylinder = [
    {{ material = "white", base_m = [0, 0, -500], top_m = [0, 0, 500], radius_m = 10 }},
    {},
]
ambient = {{ emittance = "D65", illuminance = 0.8 }}
point_light = [{{ position_m = [0, 0, 900], emittance = "D65", intensity = 1e-9 }}]
[diffuse.white]
reflectance = [[400, 1]]
[mirror.silver]
reflectance = [[400, 1]]
[glossy.coated]
reflectance = [[400, 1]]
highlight = 0
exponent = 1
refractive_index = 1.5
[glass.crystal]
refractive_index = 1.5
"#,
            rod(material, 0.4)
        );
        let scene = Scene::from_toml(Path::new("test.toml"), &text).unwrap();
        let sampler = scene.sampler(Quadrature::Bands(16), SIZE_PX);
        let request = TracePlan {
            size_px: SIZE_PX,
            ..plan(3000)
        };
        let tree = trace(&sampler, &request, &|_, _| ());
        for (channel, of_light) in Channel::ALL.into_iter().zip(D65) {
            let leaves = tree.leaves(channel, Reach::rays(3000)).unwrap();
            for value in reconstruct(&leaves, SIZE_PX).values() {
                let expected = 0.8 * 0.5 * of_light;
                assert!(
                    (f64::from(*value) - expected).abs() < tolerance,
                    "{material}, {channel}: {value}, not {expected}"
                );
            }
        }
    }
}

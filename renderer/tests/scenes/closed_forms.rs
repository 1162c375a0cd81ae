//! What a scene must give by a formula.

use super::*;

/// A camera 2 m over the ground that sees x and y from −2 to 2 m: x to the right, y up.
const FROM_ABOVE: &str = r"
camera = { position_m = [0, 0, 2], look_at_m = [0, 0, 0], up = [0, 1, 0], vertical_field_of_view_deg = 90 }
";

/// Single precision, summed over 16 bands.
const ROUNDING: f64 = 1e-6;

fn ground(head: &str, light: &str) -> Scene {
    scene(&format!(
        "{head}{FROM_ABOVE}ground = [{{ material = \"grey\", height_m = 0 }}]\n{light}\n\
         [diffuse.grey]\nreflectance = [[400, 0.5]]\n"
    ))
}

fn assert_near(ours: f64, expected: f64) {
    assert!(
        (ours - expected).abs() < ROUNDING,
        "{ours} is not {expected}"
    );
}

#[test]
fn a_lambertian_plane_under_a_point_light_is_i_cos_theta_over_d_squared() {
    let light = r#"point_light = [{ position_m = [1, 0, 3], emittance = "D65", intensity = 6 }]"#;
    let scene = ground("", light);
    for quadrature in [
        Quadrature::Bands(16),
        Quadrature::Bands(5),
        Quadrature::Meyer1988,
    ] {
        let sampler = scene.sampler(quadrature, [100, 100]);
        for (x, y) in [(0.5, 0.5), (0.75, 0.5), (0.1, 0.9)] {
            let (ground_x, ground_y) = (4.0 * x - 2.0, 2.0 - 4.0 * y);
            let d_squared = (ground_x - 1.0_f64).powi(2) + ground_y * ground_y + 9.0;
            let illuminance = 6.0 * 3.0 / d_squared.powf(1.5);
            for (channel, of_light) in Channel::ALL.into_iter().zip(D65) {
                assert_near(value(&sampler, x, y, channel), 0.5 * illuminance * of_light);
            }
        }
    }
}

#[test]
fn a_distant_light_goes_with_the_cosine() {
    let light = r#"distant_light = [{ from = [3, 0, 4], emittance = "D65", illuminance = 0.7 }]"#;
    let scene = ground("", light);
    assert_near(
        value(&sampler(&scene), 0.2, 0.3, Channel::A),
        0.5 * 0.7 * 0.8 * D65[0],
    );
}

#[test]
fn a_wall_gets_half_of_the_ambient_light_of_the_ground() {
    // The wall stands at x = 1 and is seen beside the ground; the one light is behind it.
    let rest = r#"
rectangle = [{ material = "grey", corner_m = [1, -9, 0], edge_u_m = [0, 18, 0], edge_v_m = [0, 0, 1] }]
distant_light = [{ from = [1, 0, 0.0001], emittance = "E", illuminance = 1e-9 }]
ambient = { emittance = "D65", illuminance = 0.4 }"#;
    let scene = ground("", rest);
    let sampler = sampler(&scene);
    assert_near(value(&sampler, 0.5, 0.5, Channel::A), 0.5 * 0.4 * D65[0]);
    assert_near(value(&sampler, 0.9, 0.5, Channel::A), 0.25 * 0.4 * D65[0]);
}

#[test]
fn a_shadow_ends_where_similar_triangles_say() {
    // A point light at 4 m over x = 0, an edge at (0.5, 1 m): the shadow starts at x = 0.5 · 4/3.
    let rest = r#"
rectangle = [{ material = "grey", corner_m = [0.5, -9, 1], edge_u_m = [0.1, 0, 0], edge_v_m = [0, 18, 0] }]
point_light = [{ position_m = [0, 0, 4], emittance = "D65", intensity = 1 }]"#;
    let scene = ground("", rest);
    let sampler = sampler(&scene);
    let at_ground = |x_m: f64| value(&sampler, (x_m + 2.0) / 4.0, 0.5, Channel::A);
    let start_m = 0.5 * 4.0 / 3.0;
    assert!(at_ground(start_m - 1e-5) > 0.01);
    assert_eq!(at_ground(start_m + 1e-5), 0.0);
}

#[test]
fn a_light_behind_a_surface_and_a_shadow_give_black() {
    let light = r#"point_light = [{ position_m = [0, 0, -1], emittance = "D65", intensity = 9 }]"#;
    let scene = ground("", light);
    assert_eq!(value(&sampler(&scene), 0.5, 0.5, Channel::A), 0.0);
}

#[test]
fn a_mirror_shows_what_stands_opposite_times_its_reflectance() {
    // A mirror at 45° under the camera sends its ray against x to a wall; light falls on that over the mirror,
    // at an angle whose cosine is 0.8.
    let text = format!(
        r#"{FROM_ABOVE}
rectangle = [
    {{ material = "silver", corner_m = [-1, -1, -1], edge_u_m = [2, 0, 2], edge_v_m = [0, 2, 0] }},
    {{ material = "wall", corner_m = [-5, -9, -9], edge_u_m = [0, 18, 0], edge_v_m = [0, 0, 18] }},
]
distant_light = [{{ from = [4, 0, 3], emittance = "D65", illuminance = 0.9 }}]
[mirror.silver]
reflectance = [[400, 0.6]]
[diffuse.wall]
reflectance = [[400, 0.5]]
"#
    );
    let scene = scene(&text);
    assert_near(
        value(&sampler(&scene), 0.5, 0.5, Channel::A),
        0.6 * 0.5 * 0.9 * 0.8 * D65[0],
    );
}

#[test]
fn a_clear_coat_takes_its_share_from_the_body() {
    // Straight down a coat of index 1.5 mirrors ((1.5 − 1)/(1.5 + 1))² = 0.04 of what is above, which is
    // black: a rectangle that faces down gets no ambient light. The body keeps 0.96.
    let text = format!(
        r#"{FROM_ABOVE}
disc = [{{ material = "coated", center_m = [0, 0, 0], normal = [0, 0, 1], radius_m = 9 }}]
rectangle = [{{ material = "grey", corner_m = [-9, -9, 8], edge_u_m = [18, 0, 0], edge_v_m = [0, 18, 0] }}]
ambient = {{ emittance = "D65", illuminance = 0.4 }}
point_light = [{{ position_m = [0, 0, -1], emittance = "D65", intensity = 1e-9 }}]
[glossy.coated]
reflectance = [[400, 0.5]]
highlight = 0
exponent = 1
refractive_index = 1.5
[diffuse.grey]
reflectance = [[400, 0.5]]
"#
    );
    let scene = scene(&text);
    assert_near(
        value(&sampler(&scene), 0.5, 0.5, Channel::A),
        0.96 * 0.5 * 0.4 * D65[0],
    );
}

#[test]
fn a_highlight_is_phongs_power_of_the_cosine() {
    // Straight down onto a black gloss; the light from 60° aside: cos α = 1/2, its cube 1/8.
    let text = format!(
        r#"{FROM_ABOVE}
disc = [{{ material = "gloss", center_m = [0, 0, 0], normal = [0, 0, 1], radius_m = 9 }}]
distant_light = [{{ from = [1.7320508075688772, 0, 1], emittance = "D65", illuminance = 0.8 }}]
[glossy.gloss]
reflectance = [[400, 0.0]]
highlight = 0.5
exponent = 3
"#
    );
    let scene = scene(&text);
    assert_near(
        value(&sampler(&scene), 0.5, 0.5, Channel::A),
        0.5 * 0.8 * 0.125 * D65[0],
    );
}

#[test]
fn a_sphere_covers_the_part_of_the_screen_that_it_should() {
    // A sphere of radius 1 at 2 m looks asin(1/2) = 30° wide to each side: tan 30° of the half screen.
    let text = format!(
        r#"{FROM_ABOVE}
sphere = [{{ material = "grey", center_m = [0, 0, 0], radius_m = 1 }}]
ambient = {{ emittance = "D65", illuminance = 1 }}
point_light = [{{ position_m = [0, 0, 9], emittance = "D65", intensity = 1 }}]
[diffuse.grey]
reflectance = [[400, 0.5]]
"#
    );
    let scene = scene(&text);
    let sampler = sampler(&scene);
    let edge = 0.5 + 0.5 * 30.0_f64.to_radians().tan();
    assert!(value(&sampler, edge - 1e-6, 0.5, Channel::A) > 0.1);
    assert_eq!(value(&sampler, edge + 1e-6, 0.5, Channel::A), 0.0);
    assert!(value(&sampler, 0.5, 1.0 - edge + 1e-6, Channel::A) > 0.1);
    assert_eq!(value(&sampler, 0.5, 1.0 - edge - 1e-6, Channel::A), 0.0);
}

#[test]
fn a_checker_changes_where_its_squares_meet() {
    let text = format!(
        r#"{FROM_ABOVE}
ground = [{{ material = "tiles", height_m = 0 }}]
distant_light = [{{ from = [0, 0, 1], emittance = "D65", illuminance = 1 }}]
[diffuse.tiles]
reflectance = [[400, 0.8]]
checker = {{ reflectance = [[400, 0.1]], size_m = 0.5 }}
"#
    );
    let scene = scene(&text);
    let sampler = sampler(&scene);
    for (x_m, y_m, reflectance) in [
        (0.1, 0.1, 0.8),
        (0.499, 0.499, 0.8),
        (0.501, 0.499, 0.1),
        (0.501, 0.501, 0.8),
        (-0.001, 0.1, 0.1),
        (-0.001, -0.001, 0.8),
    ] {
        let (x, y) = ((x_m + 2.0) / 4.0, (2.0 - y_m) / 4.0);
        assert_near(value(&sampler, x, y, Channel::A), reflectance * D65[0]);
    }
}

#[test]
fn the_wavelengths_that_are_shaded_are_those_that_count() {
    let light = r#"point_light = [{ position_m = [1, 0, 3], emittance = "D65", intensity = 6 }]"#;
    let scene = ground("", light);
    let meyer = scene.sampler(Quadrature::Meyer1988, [100, 100]);
    assert_eq!(
        Channel::ALL.map(|channel| meyer.wavelengths(channel)),
        [3, 2, 1]
    );
    let bands = scene.sampler(Quadrature::Bands(16), [100, 100]);
    assert_eq!(
        Channel::ALL.map(|channel| bands.wavelengths(channel)),
        [16; 3]
    );
}

/// A scene of a rectangle light that faces down onto black ground but for what is asked.
fn under_rectangle(samples: u32, rest: &str) -> Scene {
    scene(&format!(
        r#"{FROM_ABOVE}
rectangle_light = [{{ corner_m = [0.5, -0.25, 0.8], edge_u_m = [0, 0.5, 0], edge_v_m = [1, 0, 0], emittance = "D65", luminance = 3, samples = {samples} }}]
ground = [{{ material = "grey", height_m = 0 }}]
{rest}
[diffuse.grey]
reflectance = [[400, 0.5]]
"#
    ))
}

/// The form factor from a small surface to a rectangle parallel to it, one corner of which is straight above
/// it at the height `h`: Howell, *A Catalog of Radiation Heat Transfer Configuration Factors*, B-4.
fn corner_factor(a: f64, b: f64, h: f64) -> f64 {
    let (x, y) = (a / h, b / h);
    let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / std::f64::consts::TAU
}

/// The same to the part of the light between two x, as a sum of four rectangles with a corner overhead.
fn rectangle_factor(between_x: [f64; 2], [x_m, y_m]: [f64; 2]) -> f64 {
    let f = |x: f64, y: f64| {
        let (x, y) = (x - x_m, y - y_m);
        corner_factor(x.abs(), y.abs(), 0.8).copysign(x * y)
    };
    let [from, to] = between_x;
    f(to, 0.25) - f(from, 0.25) - f(to, -0.25) + f(from, -0.25)
}

#[test]
fn a_rectangle_light_gives_the_form_factor_to_a_parallel_surface() {
    let scene = under_rectangle(32, "");
    let sampler = sampler(&scene);
    for (x_m, y_m) in [(0.0, 0.0), (-1.2, 0.9), (1.6, -1.1), (0.2, 0.25)] {
        let factor = rectangle_factor([0.5, 1.5], [x_m, y_m]);
        let expected = 0.5 * 3.0 * factor * D65[0];
        let ours = value(&sampler, (x_m + 2.0) / 4.0, (2.0 - y_m) / 4.0, Channel::A);
        // One random place in each of 1024 cells: a stratified mean errs by about 1/1024 of the range.
        assert!(
            (ours / expected - 1.0).abs() < 2e-3,
            "{ours} is not {expected}"
        );
    }
}

#[test]
fn a_rectangle_light_that_stands_on_the_ground_leaves_no_specks_before_it() {
    // A wall of light, 0.5 m high and 2 m wide, that shines towards +x from x = 0.
    let scene = scene(&format!(
        r#"{FROM_ABOVE}
rectangle_light = [{{ corner_m = [0, -1, 0], edge_u_m = [0, 2, 0], edge_v_m = [0, 0, 0.5], emittance = "D65", luminance = 3, samples = 8 }}]
ground = [{{ material = "grey", height_m = 0 }}]
[diffuse.grey]
reflectance = [[400, 0.5]]
"#
    ));
    let sampler = sampler(&scene);
    // From a small surface to a rectangle that stands upright at the distance c, one corner at the foot of the
    // perpendicular, a high and b wide: Howell, B-5; its integrand spreads over half the hemisphere at most.
    let corner = |a: f64, b: f64, c: f64| {
        let (x, y) = (a / b, c / b);
        let r = x.hypot(y);
        ((1.0 / y).atan() - y / r * (1.0 / r).atan()) / std::f64::consts::TAU
    };
    for x_m in [1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.2_f64] {
        for y_m in [-0.9, -0.333, 0.0, 0.5, 0.97_f64] {
            let factor = corner(0.5, 1.0 - y_m, x_m) + corner(0.5, 1.0 + y_m, x_m);
            let expected = 0.5 * 3.0 * factor * D65[0];
            let (x, y) = ((x_m + 2.0) / 4.0, (2.0 - y_m) / 4.0);
            let ours = value(&sampler, x, y, Channel::A);
            assert!(
                (ours / expected - 1.0).abs() < 0.05,
                "{ours} is not {expected} at {x_m}, {y_m}"
            );
        }
    }
}

#[test]
fn a_light_that_is_seen_is_a_scene_of_its_own() {
    let scene = scene(&format!(
        r#"{FROM_ABOVE}
sphere_light = [{{ center_m = [0, 0, 0], radius_m = 0.5, emittance = "D65", luminance = 0.5, samples = 1 }}]"#
    ));
    let sampler = sampler(&scene);
    assert_near(value(&sampler, 0.5, 0.5, Channel::A), 0.5 * D65[0]);
    assert_eq!(value(&sampler, 0.1, 0.1, Channel::A), 0.0);
}

#[test]
fn a_rectangle_light_is_seen_from_its_front_and_in_a_mirror_and_shines_to_its_front_alone() {
    // From above its back is seen: black. A mirror on the ground under it shows its front.
    let mirror = r#"
disc = [{ material = "silver", center_m = [-0.2, 0, 0.001], normal = [0, 0, 1], radius_m = 0.1 }]
[mirror.silver]
reflectance = [[400, 0.6]]"#;
    let scene = scene(&format!(
        r#"
camera = {{ position_m = [-1.4, 0, 0.8], look_at_m = [-0.2, 0, 0.001], up = [0, 0, 1], vertical_field_of_view_deg = 1 }}
rectangle_light = [{{ corner_m = [0.5, -0.25, 0.8], edge_u_m = [0, 0.5, 0], edge_v_m = [1, 0, 0], emittance = "D65", luminance = 3, samples = 2 }}]
{mirror}
"#
    ));
    assert_near(
        value(&sampler(&scene), 0.5, 0.5, Channel::A),
        0.6 * 3.0 * D65[0],
    );
    let above = under_rectangle(2, "");
    // The light stands between the camera at 2 m and the ground, at half of the screen's scale of 1.2 m.
    let at = 0.5 + 1.0 / 2.4;
    assert_eq!(value(&sampler(&above), at, 0.5, Channel::A), 0.0);
}

#[test]
fn a_sphere_light_far_from_its_surface_is_a_point_and_overhead_is_known_exactly() {
    // Straight under a sphere the form factor is (r/d)^2, however near.
    let scene = scene(&format!(
        r#"{FROM_ABOVE}
sphere_light = [{{ center_m = [1, 0, 1], radius_m = 0.5, emittance = "D65", luminance = 2, samples = 64 }}]
ground = [{{ material = "grey", height_m = 0 }}]
[diffuse.grey]
reflectance = [[400, 0.5]]
"#
    ));
    let sampler = sampler(&scene);
    // The camera does not see the ground under the sphere: the plane through the light's centre is tilted by
    // the cosine only, E = L (r/d)^2 cos, as long as the whole sphere is above the horizon.
    for x_m in [-1.5_f64, -0.5, 0.0] {
        let d_squared = (x_m - 1.0).powi(2) + 1.0;
        let expected = 0.5 * 2.0 * 0.25 / d_squared / d_squared.sqrt() * D65[0];
        let ours = value(&sampler, (x_m + 2.0) / 4.0, 0.5, Channel::A);
        assert!(
            (ours / expected - 1.0).abs() < 1e-3,
            "{ours} is not {expected}"
        );
    }
}

#[test]
fn the_shadow_of_a_rectangle_light_is_soft_and_the_same_every_time() {
    let blocker = r#"rectangle = [{ material = "grey", corner_m = [-0.3, -9, 0.4], edge_u_m = [0.6, 0, 0], edge_v_m = [0, 18, 0] }]"#;
    let scene = under_rectangle(64, blocker);
    let sampler = sampler(&scene);
    // Edges at x = -0.3 and 0.3, half as high as the light: they hide its places from -0.6 - x to 0.6 - x.
    let at_ground = |x_m: f64| value(&sampler, (x_m + 2.0) / 4.0, 0.1, Channel::A);
    let expected = |seen: [f64; 2], x_m| 0.5 * 3.0 * rectangle_factor(seen, [x_m, 1.6]) * D65[0];
    for (x_m, seen) in [
        (0.4, [0.5, 1.5]),
        (-0.6, [1.2, 1.5]),
        (-0.8, [1.4, 1.5]),
        (-1.6, [0.5, 1.0]),
    ] {
        let (ours, expected) = (at_ground(x_m), expected(seen, x_m));
        assert!(
            (ours / expected - 1.0).abs() < 0.02,
            "{ours} is not {expected}"
        );
    }
    assert_eq!(at_ground(-1.0), 0.0);
    assert_eq!(at_ground(-0.6), at_ground(-0.6));
}

#[test]
fn a_slab_of_glass_passes_twice_one_minus_r_and_the_rays_between_its_faces() {
    // Straight through: t = (1 - r)^2 (1 + r^2 + r^4 ...) = (1 - r)/(1 + r) of the bright wall behind it.
    let text = format!(
        r#"{FROM_ABOVE}
box = [{{ material = "crown", center_m = [0, 0, 0.5], size_m = [9, 9, 0.2] }}]
ground = [{{ material = "grey", height_m = 0 }}]
ambient = {{ emittance = "D65", illuminance = 0.8 }}
distant_light = [{{ from = [0, 0, -1], emittance = "E", illuminance = 1e-9 }}]
[glass.crown]
refractive_index = 1.5
[diffuse.grey]
reflectance = [[400, 0.5]]
"#
    );
    let scene = scene(&text);
    let r = 0.04;
    let expected = 0.5 * 0.8 * (1.0 - r) / (1.0 + r) * D65[0];
    let ours = value(&sampler(&scene), 0.5, 0.5, Channel::A);
    // What bounces twice, r^2 = 0.0016, is followed; r^4 counts for less than 1/1024 and is not.
    assert!((ours - expected).abs() < 1e-5, "{ours} is not {expected}");
}

#[test]
fn a_slab_of_glass_shifts_what_is_behind_it() {
    // At 45 degrees a slab of thickness t and index n shifts the ray by t (1 - tan r / tan i), sin r = sin i / n.
    let text = r#"
camera = { position_m = [-2, 0, 2], look_at_m = [0, 0, 0], up = [0, 0, 1], vertical_field_of_view_deg = 1 }
box = [{ material = "crown", center_m = [0, 0, 1], size_m = [9, 9, 0.5] }]
ground = [{ material = "tiles", height_m = 0 }]
ambient = { emittance = "D65", illuminance = 1 }
distant_light = [{ from = [0, 0, -1], emittance = "E", illuminance = 1e-9 }]
[glass.crown]
refractive_index = 1.5
[diffuse.tiles]
reflectance = [[400, 0.9]]
checker = { reflectance = [[400, 0.0]], size_m = EDGE }
"#;
    let refracted = (45.0_f64.to_radians().sin() / 1.5).asin();
    let shift_m = 0.5 * (1.0 - refracted.tan());
    // Straight on the ray would meet x = 0; the slab lets it fall short by the shift.
    for (edge_m, is_bright) in [(shift_m - 1e-4, true), (shift_m + 1e-4, false)] {
        let text = text.replace("EDGE", &format!("{edge_m}"));
        let scene = scene(&text);
        let value = value(&sampler(&scene), 0.5, 0.5, Channel::A);
        // Beyond one square to the left the colours have changed twice.
        assert_eq!(value > 0.5, is_bright, "{value} with squares of {edge_m} m");
    }
}

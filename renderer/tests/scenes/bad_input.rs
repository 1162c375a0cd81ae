//! Scene files that cannot be used: each error names the file, the place, what was found, what was expected.

use super::*;

const GOOD: &str = r#"
sphere = [{ name = "ball", material = "paint", center_m = [0, 0, 0], radius_m = 1 }]
box = [{ material = "paint", center_m = [3, 0, 0], size_m = [1, 1, 1], rotation_deg = 10 }]
cylinder = [{ material = "chrome", base_m = [0, 3, 0], top_m = [0, 3, 1], radius_m = 0.5 }]
rectangle = [{ material = "lacquer", corner_m = [0, 0, 0], edge_u_m = [1, 0, 0], edge_v_m = [0, 1, 0] }]
[camera]
position_m = [0, -5, 1]
look_at_m = [0, 0, 0]
up = [0, 0, 1]
vertical_field_of_view_deg = 30
[[point_light]]
name = "lamp"
position_m = [2, -4, 5]
emittance = "D65"
intensity = 20
[[rectangle_light]]
name = "panel"
corner_m = [0, 0, 4]
edge_u_m = [0, 1, 0]
edge_v_m = [1, 0, 0]
emittance = "E"
luminance = 5
samples = 4
[[sphere_light]]
center_m = [-3, 0, 4]
radius_m = 0.25
emittance = "A"
luminance = 6
samples = 3
[glass.crown]
refractive_index = 1.33
[reflectances]
rust = [[400, 0.1], [700, 0.6]]
[diffuse.paint]
reflectance = "rust"
checker = { reflectance = "colorchecker red", size_m = 0.1 }
[glossy.lacquer]
reflectance = "rust"
highlight = 0.1
exponent = 10
refractive_index = 1.5
[mirror.chrome]
reflectance = [[550, 0.9]]
"#;

/// A change of the good file, and what its error must say.
const CASES: &[(&str, &str, &[&str])] = &[
    (
        "samples = 4",
        "samples = 0",
        &[
            "rectangle_light 1 \"panel\"",
            "field samples",
            "found 0",
            "from 1 to 64",
        ],
    ),
    (
        "samples = 3",
        "samples = 65",
        &["sphere_light 1", "field samples", "found 65"],
    ),
    ("samples = 3", "samples = 2.5", &["invalid type"]),
    (
        "luminance = 5",
        "luminance = -5",
        &["rectangle_light 1 \"panel\"", "field luminance", "found -5"],
    ),
    (
        "radius_m = 0.25",
        "radius_m = nan",
        &["sphere_light 1", "field radius_m", "found NaN"],
    ),
    (
        "edge_u_m = [0, 1, 0]\nedge_v_m",
        "edge_u_m = [1, 1, 0]\nedge_v_m",
        &["rectangle_light 1", "field edge_v_m", "right angles"],
    ),
    (
        "refractive_index = 1.33",
        "refractive_index = 0.5",
        &["glass \"crown\"", "field refractive_index", "found 0.5"],
    ),
    (
        "refractive_index = 1.33",
        "refractive_index = 1.33\nhighlight = 0.1",
        &["glass \"crown\"", "field exponent", "highlight is given"],
    ),
    (
        "material = \"lacquer\", corner_m",
        "material = \"crown\", corner_m",
        &["rectangle 1", "field material", "only a closed shape"],
    ),
    (
        "radius_m = 1 }",
        "radius_m = 0 }",
        &["sphere 1 \"ball\"", "field radius_m", "found 0", "above 0"],
    ),
    (
        "radius_m = 1 }",
        "radius_m = nan }",
        &["sphere 1 \"ball\"", "field radius_m", "found NaN"],
    ),
    (
        "radius_m = 1 }",
        "radius_m = inf }",
        &["sphere 1 \"ball\"", "field radius_m", "found inf"],
    ),
    (
        "radius_m = 1 }",
        "radius = 1 }",
        &["unknown field `radius`", "line 2"],
    ),
    (
        "material = \"paint\", center_m = [0",
        "material = \"pant\", center_m = [0",
        &["\"pant\"", "chrome, crown, lacquer, paint"],
    ),
    (
        "center_m = [0, 0, 0]",
        "center_m = [0, nan, 0]",
        &["sphere 1 \"ball\"", "field center_m"],
    ),
    ("center_m = [0, 0, 0]", "center_m = [0, 0]", &["line 2"]),
    (
        "size_m = [1, 1, 1]",
        "size_m = [1, -1, 1]",
        &["box 1", "field size_m", "found -1"],
    ),
    (
        "rotation_deg = 10",
        "rotation_deg = 1000",
        &["box 1", "field rotation_deg", "found 1000"],
    ),
    (
        "top_m = [0, 3, 1]",
        "top_m = [0, 3, 0]",
        &["cylinder 1", "field top_m", "differs from base_m"],
    ),
    (
        "edge_v_m = [0, 1, 0]",
        "edge_v_m = [1, 1, 0]",
        &["rectangle 1", "field edge_v_m", "right angles"],
    ),
    (
        "edge_v_m = [0, 1, 0]",
        "edge_v_m = [0, 0, 0]",
        &["rectangle 1", "field edge_v_m", "direction"],
    ),
    (
        "look_at_m = [0, 0, 0]",
        "look_at_m = [0, -5, 1]",
        &["camera", "field look_at_m", "differs from position_m"],
    ),
    ("up = [0, 0, 1]", "up = [0, 5, -1]", &["camera", "field up"]),
    (
        "up = [0, 0, 1]",
        "up = [0, 0, 0]",
        &["camera", "field up", "direction"],
    ),
    (
        "view_deg = 30",
        "view_deg = 180",
        &["camera", "field vertical_field_of_view_deg", "found 180"],
    ),
    (
        "emittance = \"D65\"",
        "emittance = \"D50\"",
        &["point_light 1 \"lamp\"", "\"D50\"", "blackbody 3200 K"],
    ),
    (
        "emittance = \"D65\"",
        "emittance = [[2000, 1]]",
        &["lamp", "field emittance", "360 to 830 nm"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "[[900, 0.1], [1000, 0.6]]",
        &["reflectances \"rust\"", "360 to 830 nm"],
    ),
    (
        "emittance = \"D65\"",
        "emittance = [[500, 0]]",
        &["lamp", "without visible light"],
    ),
    (
        "emittance = \"D65\"",
        "emittance = 5",
        &["control points", "line"],
    ),
    (
        "intensity = 20",
        "intensity = -1",
        &["point_light 1 \"lamp\"", "field intensity", "found -1"],
    ),
    (
        "[700, 0.6]",
        "[700, 1.1]",
        &["reflectances \"rust\"", "1.1 at 700 nm", "from 0 to 1"],
    ),
    (
        "[700, 0.6]",
        "[700, nan]",
        &["reflectances \"rust\"", "NaN"],
    ),
    (
        "[700, 0.6]",
        "[400, 0.6]",
        &["reflectances \"rust\"", "400 nm before 400 nm", "rise"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "[]",
        &["reflectances \"rust\"", "no control points"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "\"colorchecker pink\"",
        &["\"colorchecker pink\"", "colorchecker magenta"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "{ srgb = [0.5, 0.5, 1.5] }",
        &["reflectances \"rust\"", "1.5", "from 0 to 1"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "{ srgb = [0.5, nan, 0.5] }",
        &["reflectances \"rust\"", "NaN"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "{ srgb = [0.5, 0.5] }",
        &["array of length 3"],
    ),
    (
        "[[400, 0.1], [700, 0.6]]",
        "{ rgb = [0.5, 0.5, 0.5] }",
        &["unknown field `rgb`", "srgb"],
    ),
    (
        "emittance = \"D65\"",
        "emittance = { srgb = [0, 0, 0] }",
        &["lamp", "found black"],
    ),
    (
        "rust = [[",
        "\"colorchecker red\" = [[",
        &["a name of its own"],
    ),
    (
        "reflectance = \"rust\"\nchecker",
        "reflectance = \"rest\"\nchecker",
        &["diffuse \"paint\"", "\"rest\"", "rust"],
    ),
    (
        "size_m = 0.1",
        "size_m = 0.0",
        &["diffuse \"paint\"", "checker.size_m"],
    ),
    (
        "[glossy.lacquer]",
        "stripes = { reflectance = \"rust\", size_m = 1, across = \"u\" }\n[glossy.lacquer]",
        &["stripes", "one of the two"],
    ),
    (
        "highlight = 0.1",
        "highlight = -0.1",
        &["glossy \"lacquer\"", "field highlight"],
    ),
    (
        "exponent = 10",
        "exponent = 0",
        &["glossy \"lacquer\"", "field exponent"],
    ),
    (
        "refractive_index = 1.5",
        "refractive_index = 0.5",
        &["glossy \"lacquer\"", "field refractive_index"],
    ),
    (
        "[mirror.chrome]",
        "[mirror.chrome]\nhighlight = 1",
        &["mirror \"chrome\"", "field exponent", "found nothing"],
    ),
    (
        "[mirror.chrome]",
        "[mirror.paint]",
        &["a second material \"paint\""],
    ),
    (
        "[camera]",
        "[camera]\nroll_deg = 3",
        &["unknown field `roll_deg`"],
    ),
    ("[camera]", "[camera]\nposition_m = 3", &["duplicate key"]),
    (
        "vertical_field_of_view_deg = 30",
        "",
        &["missing field `vertical_field_of_view_deg`"],
    ),
];

fn error_of(text: &str) -> Option<String> {
    let error = Scene::from_toml(Path::new("bad.toml"), text).err()?;
    assert!(error.is_input());
    Some(error.to_string())
}

#[test]
fn the_good_file_is_taken() {
    assert_eq!(error_of(GOOD), None);
}

#[test]
fn each_fault_is_named_with_its_place() {
    for (good, bad, words) in CASES {
        let text = GOOD.replacen(good, bad, 1);
        assert_ne!(text, GOOD, "{good:?} is not in the good file");
        match error_of(&text) {
            None => assert!(words.is_empty(), "{bad:?} was taken"),
            Some(message) => {
                assert!(message.contains("\"bad.toml\""), "{message}");
                assert!(message.contains("expected"), "{message}");
                assert!(!words.is_empty(), "{bad:?} was refused: {message}");
                for word in *words {
                    assert!(message.contains(word), "{word:?} is not in: {message}");
                }
            }
        }
    }
}

#[test]
fn a_scene_needs_a_light_and_not_too_many() {
    let lights = GOOD.find("[[point_light]]").unwrap()..GOOD.find("[glass.crown]").unwrap();
    let none = GOOD.replace(&GOOD[lights.clone()], "");
    assert!(error_of(&none).unwrap().contains("found 0 lights"));
    // Three in each copy.
    let many = GOOD.replace(&GOOD[lights.clone()], &GOOD[lights].repeat(11));
    let error = error_of(&many).unwrap();
    assert!(error.contains("found 33 lights") && error.contains("from 1 to 32"));
}

#[test]
fn a_scene_needs_something_to_be_seen() {
    let empty = r#"
camera = { position_m = [0, -5, 1], look_at_m = [0, 0, 0], up = [0, 0, 1], vertical_field_of_view_deg = 30 }
point_light = [{ position_m = [0, -5, 5], emittance = "D65", intensity = 9 }]
"#;
    assert!(error_of(empty).unwrap().contains("found no object"));
}

#[test]
fn every_truncation_is_refused_or_is_a_whole_scene() {
    for length in 0..GOOD.len() {
        if let Some(message) = error_of(&GOOD[..length]) {
            assert!(
                message.contains("bad.toml") && message.contains("expected"),
                "{message}"
            );
        }
    }
}

#[test]
fn a_missing_file_a_folder_and_bytes_that_are_not_text_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.toml");
    let error = Scene::read(&missing).unwrap_err();
    assert!(error.is_input() && error.to_string().contains("missing.toml"));
    assert!(Scene::read(folder.path()).unwrap_err().is_input());
    let bytes = folder.path().join("bytes.toml");
    std::fs::write(&bytes, [0xff, 0xfe, 0x00]).unwrap();
    let error = Scene::read(&bytes).unwrap_err();
    assert!(error.is_input() && error.to_string().contains("UTF-8"));
}

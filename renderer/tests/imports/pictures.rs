//! What mesh files show: colours that are known in closed form, and the same picture from every format.

use std::fs;

use super::quad::{self, CODES, PlyForm, scene_toml};
use super::*;

/// The inverse of the transfer curve, as IEC 61966-2-1 prints it.
fn linear(code: u8) -> f64 {
    let encoded = f64::from(code) / 255.0;
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// A white light of illuminance 1 at right angles shows the texture's own colours.
fn shows_the_print(scene: &Scene) {
    let quarters = [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)];
    for ((x, y), code) in quarters.into_iter().zip(CODES) {
        let shown = colour(scene, x, y);
        for (shown, code) in shown.into_iter().zip(code) {
            // The table's ΔE00 of up to 0.5, about 0.006 in a primary near 1/2.
            assert!(
                (shown - linear(code)).abs() < 0.008,
                "{shown} for {} at {x}, {y}",
                linear(code)
            );
        }
    }
}

#[test]
fn a_gltf_shows_the_colours_of_its_texture_the_right_way_up() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::read(&quad::write(folder.path(), |_| ())).unwrap();
    shows_the_print(&scene);
    let said = scene.warnings().join("\n");
    assert_eq!(scene.warnings().len(), 1, "{said}");
    assert!(
        said.contains("multiplied by 1.429e-1"),
        "one of 7 lux becomes one of 1: {said}"
    );
}

#[test]
fn external_embedded_and_binary_files_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let outside = grid(&Scene::read(&quad::write(folder.path(), |_| ())).unwrap());
    let binary = folder.path().join("square.glb");
    fs::write(&binary, quad::whole_glb()).unwrap();
    assert_eq!(grid(&Scene::read(&binary).unwrap()), outside);
    let base64 = |bytes: &[u8]| {
        use base64::Engine as _;
        base64::engine::general_purpose::STANDARD.encode(bytes)
    };
    let inside = quad::write(folder.path(), |root| {
        let uri = format!(
            "data:application/octet-stream;base64,{}",
            base64(&quad::buffer())
        );
        root["buffers"][0]["uri"] = uri.into();
        root["images"][0]["uri"] = format!("data:image/png;base64,{}", base64(&quad::png())).into();
    });
    fs::remove_file(folder.path().join("square.bin")).unwrap();
    fs::remove_file(folder.path().join("print.png")).unwrap();
    assert_eq!(grid(&Scene::read(&inside).unwrap()), outside);
}

#[test]
fn obj_and_ply_show_the_same_in_a_scene_file() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let read = |mesh: &str| {
        fs::write(&scene, scene_toml(mesh)).unwrap();
        Scene::read(&scene).unwrap()
    };
    quad::write_obj(folder.path());
    quad::write(folder.path(), |_| ());
    let gltf = read("file = \"square.gltf\"");
    shows_the_print(&gltf);
    let said = gltf.warnings().join("\n");
    assert!(said.contains("a camera and 1 lights, left out"), "{said}");
    // An OBJ's texture is always bilinear: between the middles of its pixels it blends.
    let by_name = read("file = \"square.obj\", material = \"print\"");
    assert_eq!(grid(&by_name), grid(&gltf));
    let own = read("file = \"square.obj\"");
    for (x, y) in [(0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)] {
        let (own, nearest) = (colour(&own, x, y), colour(&gltf, x, y));
        assert!((0..3).all(|primary| (own[primary] - nearest[primary]).abs() < 1e-4));
    }
    for form in [PlyForm::Ascii, PlyForm::Little, PlyForm::Big] {
        fs::write(folder.path().join("square.ply"), quad::ply(form)).unwrap();
        let ply = read("file = \"square.ply\", material = \"print\"");
        assert_eq!(grid(&ply), grid(&gltf), "{form:?}");
        assert!(ply.warnings().is_empty());
    }
}

#[test]
fn strips_fans_and_plain_vertices_are_the_same_square() {
    let folder = tempfile::tempdir().unwrap();
    let list = grid(&Scene::read(&quad::write(folder.path(), |_| ())).unwrap());
    for (mode, order) in [(5, [0_u16, 1, 3, 2]), (6, [0, 1, 2, 3])] {
        let path = quad::write(folder.path(), |root| {
            root["meshes"][0]["primitives"][0]["mode"] = mode.into();
            root["accessors"][2]["count"] = 4.into();
        });
        let mut bytes = quad::buffer();
        for (place, index) in order.into_iter().enumerate() {
            bytes[80 + 2 * place..][..2].copy_from_slice(&index.to_le_bytes());
        }
        fs::write(folder.path().join("square.bin"), bytes).unwrap();
        assert_eq!(grid(&Scene::read(&path).unwrap()), list, "mode {mode}");
    }
    let path = quad::write(folder.path(), |root| {
        let primitive = root["meshes"][0]["primitives"][0].as_object_mut().unwrap();
        primitive.remove("indices");
        primitive.insert("mode".to_owned(), 6.into());
    });
    assert_eq!(grid(&Scene::read(&path).unwrap()), list);
}

#[test]
fn transforms_of_nodes_multiply_from_the_root_on() {
    let folder = tempfile::tempdir().unwrap();
    let plain = grid(&Scene::read(&quad::write(folder.path(), |_| ())).unwrap());
    // Scaled by 2 and moved by (2, 0, 0), below a quarter turn about z that moves by (0, -4, 0), below a
    // scale of 1/2: a quarter turn of the square at its place, undone by the turn of the texture.
    let path = quad::write(folder.path(), |root| {
        let half = 0.5_f64.sqrt();
        root["nodes"][0] = serde_json::json!({ "scale": [0.5, 0.5, 0.5], "children": [3] });
        let nodes = root["nodes"].as_array_mut().unwrap();
        nodes.push(serde_json::json!({
            "rotation": [0, 0, half, half], "translation": [0, -4, 0], "children": [4],
        }));
        nodes.push(serde_json::json!({
            "translation": [4, 0, 0], "scale": [2, 2, 2], "mesh": 0,
        }));
    });
    // Corner (-1, -1) → (2, -2) → (2, 2) turned → (2, -2) moved → (1, -1): each corner is the next one.
    let mut bytes = quad::buffer();
    bytes[48..80].rotate_left(8);
    fs::write(folder.path().join("square.bin"), bytes).unwrap();
    let turned = grid(&Scene::read(&path).unwrap());
    let differ = turned
        .iter()
        .zip(&plain)
        .filter(|(one, other)| one != other)
        .count();
    assert!(differ < 8, "{differ} of 256 places differ");
}

#[test]
fn smooth_normals_shade_and_flat_ones_do_not() {
    let folder = tempfile::tempdir().unwrap();
    // Normals that lean outwards at the left and right, by 1 in 2: n · l falls as cos of the lean.
    let path = quad::write(folder.path(), |root| {
        root["materials"][0]["pbrMetallicRoughness"] = serde_json::json!({
            "baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0,
        });
        root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 3.into();
        root["accessors"]
            .as_array_mut()
            .unwrap()
            .push(serde_json::json!(
                { "bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC3" }
            ));
        root["bufferViews"]
            .as_array_mut()
            .unwrap()
            .push(serde_json::json!(
                { "buffer": 0, "byteOffset": 92, "byteLength": 48 }
            ));
        root["buffers"][0]["byteLength"] = 140.into();
    });
    let mut bytes = quad::buffer();
    let normals = [
        [-0.5_f32, 0.0, 1.0],
        [0.5, 0.0, 1.0],
        [0.5, 0.0, 1.0],
        [-0.5, 0.0, 1.0],
    ];
    bytes.extend(
        normals
            .iter()
            .flatten()
            .flat_map(|value| value.to_le_bytes()),
    );
    fs::write(folder.path().join("square.bin"), bytes).unwrap();
    let scene = Scene::read(&path).unwrap();
    for x in [0.05, 0.3, 0.5, 0.8] {
        let lean: f64 = x - 0.5;
        let expected = 0.5 / (1.0 + lean * lean).sqrt();
        let [_, green, _] = colour(&scene, x, 0.4);
        assert!(
            (green - expected).abs() < 1e-3,
            "{green} for {expected} at {x}"
        );
    }
}

#[test]
fn a_point_light_and_its_colour_are_those_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write(folder.path(), |root| {
        root["materials"][0]["pbrMetallicRoughness"] = serde_json::json!({
            "baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0,
        });
        root["extensions"]["KHR_lights_punctual"]["lights"][0] = serde_json::json!(
            { "type": "point", "intensity": 50.0, "color": [1.0, 0.5, 0.25] }
        );
        root["nodes"][2]["translation"] = serde_json::json!([0, 0, 2]);
    });
    let scene = Scene::read(&path).unwrap();
    let (middle, edge) = (colour(&scene, 0.5, 0.5), colour(&scene, 1.0 - 1e-9, 0.5));
    // cos θ / d² is 1/4 in the middle and 2 / 5^1.5 at 1 m from it.
    let expected = (2.0 / 5.0_f64.powf(1.5)) / 0.25;
    assert!((edge[1] / middle[1] - expected).abs() < 1e-3);
    assert!(
        (middle[1] / middle[0] - 0.5).abs() < 0.01 && (middle[2] / middle[0] - 0.25).abs() < 0.01
    );
    // Illuminance 1 on a grey of 1/2: Y is 1/2.
    let y = 0.2126 * middle[0] + 0.7152 * middle[1] + 0.0722 * middle[2];
    assert!((y - 0.5).abs() < 1e-3, "{y}");
}

#[test]
fn glass_of_a_gltf_shows_what_is_behind_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write(folder.path(), |root| {
        root["materials"].as_array_mut().unwrap().push(serde_json::json!({
            "name": "pane", "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
            "extensions": {
                "KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_ior": { "ior": 1.0 },
            },
        }));
        let mut pane = root["meshes"][0].clone();
        pane["primitives"][0]["material"] = 1.into();
        root["meshes"].as_array_mut().unwrap().push(pane);
        root["nodes"][0]["children"] = serde_json::json!([3]);
        root["nodes"]
            .as_array_mut()
            .unwrap()
            .push(serde_json::json!(
                { "mesh": 1, "translation": [0, 0, 1], "scale": [0.1, 0.1, 1] }
            ));
    });
    let scene = Scene::read(&path).unwrap();
    // Through a pane of the index of air the print is seen, in the shadow of the pane: glass blocks light.
    let beside = colour(&scene, 0.3, 0.3);
    assert!(beside[0] > 0.3);
    let behind = colour(&scene, 0.49, 0.49);
    assert!(
        behind.iter().all(|primary| primary.abs() < 1e-6),
        "{behind:?}"
    );
}

#[test]
fn a_mesh_alone_is_seen_by_a_usual_camera_and_light() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write_obj(folder.path());
    let scene = Scene::read(&path).unwrap();
    let said = scene.warnings().join("\n");
    assert!(
        said.contains("no camera: one that sees all is taken"),
        "{said}"
    );
    assert!(said.contains("no light: daylight"), "{said}");
    let lit = grid(&scene)
        .iter()
        .filter(|colour| f64::from_bits(colour[1]) > 0.01)
        .count();
    assert!(lit > 60, "only {lit} of 256 places are lit");
}

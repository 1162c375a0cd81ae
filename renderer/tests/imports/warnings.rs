//! Import of nothing is silent: what a file says in vain is named.

use std::fs;

use serde_json::json;

use super::quad;
use super::*;

fn said(change: impl FnOnce(&mut serde_json::Value)) -> String {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::read(&quad::write(folder.path(), change)).unwrap();
    scene.warnings().join("\n")
}

#[test]
fn each_thing_that_is_not_supported_is_told_with_its_name() {
    let said = said(|root| {
        root["animations"] = json!([]);
        let material = &mut root["materials"][0];
        material["extensions"] = json!({ "KHR_materials_volume": { "thicknessFactor": 1 } });
        material["emissiveFactor"] = json!([1, 0, 0]);
        material["normalTexture"] = json!({ "index": 0 });
        material["alphaMode"] = "BLEND".into();
        material["pbrMetallicRoughness"]["metallicFactor"] = 0.25.into();
        let primitives = root["meshes"][0]["primitives"].as_array_mut().unwrap();
        let mut lines = primitives[0].clone();
        lines["mode"] = 1.into();
        primitives[0]["targets"] = json!([{ "POSITION": 0 }]);
        primitives[0]["attributes"]["COLOR_0"] = 0.into();
        primitives.push(lines);
        let lights = root["extensions"]["KHR_lights_punctual"]["lights"]
            .as_array_mut()
            .unwrap();
        lights.push(json!({ "type": "spot", "name": "torch", "spot": {} }));
        lights[0]["range"] = 5.into();
        let cameras = root["cameras"].as_array_mut().unwrap();
        cameras.push(json!({ "type": "orthographic", "name": "plan",
            "orthographic": { "xmag": 1, "ymag": 1, "zfar": 9, "znear": 0 } }));
        root["scenes"][0]["nodes"] = json!([0, 1, 2, 3, 4]);
        let nodes = root["nodes"].as_array_mut().unwrap();
        nodes.push(json!({ "camera": 1, "skin": 0, "extensions": { "MSFT_lod": {} } }));
        nodes.push(json!({ "extensions": { "KHR_lights_punctual": { "light": 1 } } }));
        root["skins"] = json!([{ "joints": [0] }]);
    });
    for line in [
        "material \"print\": KHR_materials_volume is not supported: ignored",
        "material \"print\": emission is not supported",
        "material \"print\": normal textures are not supported",
        "material \"print\": alpha is not supported",
        "material \"print\": a metallic part of 0.25 is not supported: taken as 0",
        "mesh \"square\": primitive 1: Lines are not supported: left out",
        "mesh \"square\": morph targets are not supported",
        "mesh \"square\": vertex colours are not supported",
        "light \"torch\": spot lights are not supported: left out",
        "light \"sun\": the range of a light is not supported",
        "camera \"plan\": orthographic cameras are not supported",
        "node 3: skins are not supported",
        "node 3: MSFT_lod is not supported: ignored",
    ] {
        assert!(said.contains(line), "{line:?} is not in:\n{said}");
    }
    assert!(!said.contains("animations"), "{said}");
}

#[test]
fn animations_and_further_scenes_are_told() {
    let said = said(|root| {
        root["scenes"]
            .as_array_mut()
            .unwrap()
            .push(json!({ "nodes": [0] }));
        root["animations"] = json!([{ "channels": [], "samplers": [] }]);
    });
    assert!(said.contains("animations (1) are not supported"), "{said}");
    assert!(
        said.contains("one of 2 scenes: the others are left out"),
        "{said}"
    );
}

#[test]
fn triangles_without_area_and_not_numbers_are_counted_and_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write(folder.path(), |_| ());
    let mut bytes = quad::buffer();
    // The fourth corner, which one of the two triangles uses, is nowhere.
    bytes[36..40].copy_from_slice(&f32::NAN.to_le_bytes());
    fs::write(folder.path().join("square.bin"), bytes).unwrap();
    let scene = Scene::read(&path).unwrap();
    let said = scene.warnings().join("\n");
    assert!(
        said.contains("mesh \"square\": 1 of 2 triangles have no area"),
        "{said}"
    );
    assert!(colour(&scene, 0.7, 0.7)[1] > 0.01);
}

#[test]
fn an_obj_tells_of_its_materials() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write_obj(folder.path());
    let library = folder.path().join("square.mtl");
    fs::write(
        &library,
        "newmtl print\nKd 1 1 1\nd 0.7\nKe 1 1 1\nmap_Kd -s 2 2 2 print.png\nmap_Bump b.png\n",
    )
    .unwrap();
    let said = Scene::read(&path).unwrap().warnings().join("\n");
    for line in ["dissolve (d) of 0.7", "emission (Ke)", "options of map_Kd"] {
        assert!(said.contains(line), "{line:?} is not in:\n{said}");
    }
    fs::remove_file(library).unwrap();
    let said = Scene::read(&path).unwrap().warnings().join("\n");
    assert!(said.contains("material library cannot be had"), "{said}");
}

#[test]
fn a_light_or_a_camera_shut_up_in_an_object_is_told() {
    let scene = |light: &str, eye: &str, glass: &str| {
        let text = format!(
            r#"
sphere = [{{ name = "ball", material = "{glass}", center_m = [0, 0, 0], radius_m = 1 }}]
ground = [{{ material = "white", height_m = -3 }}]
point_light = [{{ name = "lamp", position_m = {light}, emittance = "D65", intensity = 10 }}]
camera = {{ position_m = {eye}, look_at_m = [0, 0, 0], up = [0, 0, 1], vertical_field_of_view_deg = 40 }}
[diffuse.white]
reflectance = [[550, 0.9]]
[glass.clear]
refractive_index = 1.5
"#
        );
        let scene = Scene::from_toml(Path::new("shut.toml"), &text).unwrap();
        scene.warnings().join("\n")
    };
    let (inside, outside) = ("[0.2, 0.1, 0.3]", "[3, -4, 2]");
    assert!(
        scene(inside, outside, "white")
            .contains("point_light 1 \"lamp\" is inside sphere 1 \"ball\"")
    );
    assert!(scene(outside, inside, "white").contains("the camera is inside sphere 1 \"ball\""));
    assert_eq!(scene(inside, inside, "white"), "");
    assert_eq!(scene(outside, outside, "white"), "");
    assert_eq!(scene(outside, inside, "clear"), "");
}

//! glTF files that cannot be used: each error names the file, the place, what was found, what was expected.

use std::fs;

use serde_json::{Value, json};

use super::quad;
use super::*;

type Change = fn(&mut Value);

/// A change of the good file, and what its error must say.
const CASES: &[(Change, &[&str])] = &[
    (
        |root| root["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]),
        &[
            "extensionsRequired",
            "KHR_draco_mesh_compression",
            "export the file without it",
        ],
    ),
    (
        |root| root["accessors"][0]["count"] = 5.into(),
        &["accessor 0", "5 items of 12 bytes", "buffer view 0"],
    ),
    (
        |root| root["accessors"][0]["count"] = 4_000_000_000_u32.into(),
        &["accessor 0", "beyond the end"],
    ),
    (
        |root| {
            root["bufferViews"][2]["byteLength"] = 4096.into();
            root["accessors"][2]["count"] = 600.into();
        },
        &["accessor 2", "beyond the end"],
    ),
    (
        |root| root["bufferViews"][0]["byteOffset"] = 60.into(),
        &["accessor 0", "beyond the end"],
    ),
    (
        |root| root["accessors"][2]["componentType"] = 5126.into(),
        &["accessor 2", "unsigned whole numbers"],
    ),
    (
        |root| root["accessors"][1]["type"] = "VEC3".into(),
        &["accessor 1", "items of 2 numbers"],
    ),
    (
        |root| {
            root["accessors"][0]
                .as_object_mut()
                .unwrap()
                .remove("bufferView");
        },
        &["accessors[0].bufferView"],
    ),
    (
        |root| root["buffers"][0]["uri"] = "gone.bin".into(),
        &["gone.bin", "no such file", "square.gltf"],
    ),
    (
        |root| root["buffers"][0]["byteLength"] = 1_000.into(),
        &["buffer 0", "found 92 bytes", "1000"],
    ),
    (
        |root| root["buffers"][0]["uri"] = "data:text/plain,hello".into(),
        &["buffer 0", "base64"],
    ),
    (
        |root| root["buffers"][0]["uri"] = "https://example.org/a.bin".into(),
        &["buffer 0", "a file beside this one"],
    ),
    (
        |root| {
            root["buffers"][0].as_object_mut().unwrap().remove("uri");
        },
        &["buffer 0", "no bytes for it"],
    ),
    (
        |root| root["images"][0]["uri"] = "gone.png".into(),
        &["gone.png", "no such file", "image 0"],
    ),
    (
        |root| root["images"][0]["uri"] = "square.bin".into(),
        &["image 0", "a picture (PNG, JPEG or EXR)"],
    ),
    (
        |root| root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9.into(),
        &["mesh \"square\"", "the accessor 9 of 3"],
    ),
    (
        |root| root["images"][0] = json!({ "bufferView": 0 }),
        &["image 0: found no mimeType"],
    ),
    (
        |root| root["images"][0] = json!({}),
        &["image 0: found no uri"],
    ),
    (
        |root| root["cameras"][0]["type"] = "orthographic".into(),
        &["camera 0: found no orthographic"],
    ),
    (
        |root| root["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "spot".into(),
        &["light \"sun\": found no spot"],
    ),
    (
        |root| root["buffers"][0]["uri"] = "a%00b".into(),
        &["a name that no file has"],
    ),
    (
        |root| root["buffers"][0]["uri"] = "square.bin/deeper".into(),
        &["a name that no file has"],
    ),
    (
        |root| {
            let primitive = root["meshes"][0]["primitives"][0].as_object_mut().unwrap();
            primitive["attributes"]
                .as_object_mut()
                .unwrap()
                .remove("TEXCOORD_0");
        },
        &["material \"print\"", "no TEXCOORD_0"],
    ),
    (
        |root| root["nodes"][0]["children"] = json!([0]),
        &["node 0 twice"],
    ),
    (
        |root| root["nodes"][1]["children"] = json!([0]),
        &["node 0 twice"],
    ),
    (|root| root["nodes"] = json!([{}, {}, {}]), &["no triangle"]),
    (|root| root["scenes"] = json!([]), &["square.gltf"]),
    (
        |root| {
            root.as_object_mut().unwrap().remove("scenes");
            root.as_object_mut().unwrap().remove("scene");
        },
        &["no scene"],
    ),
    (
        |root| root["nodes"][0]["scale"] = json!([0, 1, 1]),
        &["no triangle"],
    ),
    (
        |root| root["nodes"][0]["scale"] = json!([1e9, 1e9, 1e9]),
        &["mesh \"square\"", "within 1000000 m", "scale"],
    ),
    (
        |root| root["asset"] = json!({ "version": "1.0" }),
        &["asset: found version \"1.0\""],
    ),
    (|root| *root = json!([]), &["asset: found version null"]),
];

#[test]
fn each_fault_is_named_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    for (change, words) in CASES {
        let path = quad::write(folder.path(), change);
        let message = error_of(&path);
        for word in *words {
            assert!(message.contains(word), "{word:?} is not in: {message}");
        }
    }
}

#[test]
fn an_index_beyond_the_vertices_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write(folder.path(), |_| ());
    let mut bytes = quad::buffer();
    bytes[80..82].copy_from_slice(&4_u16.to_le_bytes());
    fs::write(folder.path().join("square.bin"), bytes).unwrap();
    let message = error_of(&path);
    assert!(
        message.contains("mesh \"square\"") && message.contains("the vertex 4 of 4"),
        "{message}"
    );
}

#[test]
fn every_truncation_of_a_binary_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.glb");
    let whole = quad::whole_glb();
    for length in (0..whole.len()).step_by(3) {
        fs::write(&path, &whole[..length]).unwrap();
        assert!(error_of(&path).contains("square.glb"));
    }
}

#[test]
fn files_that_are_no_gltf_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.gltf");
    assert!(error_of(&path).contains("no such file"));
    for bytes in [&b""[..], b"{", b"{}", b"glTF", &[0xff; 40], b"[[[["] {
        fs::write(&path, bytes).unwrap();
        assert!(error_of(&path).contains("square.gltf"));
    }
    let deep = "[".repeat(100_000);
    fs::write(&path, deep).unwrap();
    assert!(error_of(&path).contains("square.gltf"));
    let folder_path = folder.path().join("folder.glb");
    fs::create_dir(&folder_path).unwrap();
    assert!(error_of(&folder_path).contains("a folder"));
}

//! A square that fills the picture, in every format: two triangles, four texture points, one texture.
//!
//! The square is 2 m wide in the plane z = 0 of the file, seen from z = +3 with y up; a directional light
//! shines along −z. The texture has four pixels: red, green, blue, white from the upper left on.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

/// Codes of the texture's pixels.
pub(crate) const CODES: [[u8; 3]; 4] =
    [[200, 40, 40], [60, 160, 50], [50, 70, 180], [230, 230, 230]];

/// Corners from the lower left on, counter-clockwise.
pub(crate) const CORNERS: [[f32; 3]; 4] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

/// glTF counts v downwards.
const POINTS: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

pub(crate) const INDICES: [u16; 6] = [0, 1, 2, 0, 2, 3];

/// The bytes of the buffer: positions at 0, texture points at 48, indices at 80; 92 in all.
pub(crate) fn buffer() -> Vec<u8> {
    let floats = CORNERS.iter().flatten().chain(POINTS.iter().flatten());
    let mut bytes: Vec<u8> = floats.flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend(INDICES.iter().flat_map(|index| index.to_le_bytes()));
    bytes
}

/// The glTF with a buffer and an image of these sources.
pub(crate) fn gltf(buffer: &Value, image: &Value) -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1, 2] }],
        "nodes": [
            { "name": "square", "mesh": 0 },
            { "camera": 0, "translation": [0, 0, 3] },
            { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        ],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "directional", "name": "sun", "intensity": 7.0 },
        ] } },
        // tan(yfov / 2) = 1/3: the square just fills the picture.
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.643_501_108_793_284_4, "znear": 0.1 } }],
        "meshes": [{ "name": "square", "primitives": [{
            "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0,
        }] }],
        "materials": [{ "name": "print", "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0 }, "metallicFactor": 0, "roughnessFactor": 1,
        } }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "samplers": [{ "magFilter": 9728 }],
        "images": [image],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
              "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 12 },
        ],
        "buffers": [buffer],
    })
}

/// The texture as a PNG.
pub(crate) fn png() -> Vec<u8> {
    let pixels: Vec<u8> = CODES.into_iter().flatten().collect();
    let image = image::RgbImage::from_raw(2, 2, pixels).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Writes the glTF with its buffer and texture beside it; `change` may spoil it first.
pub(crate) fn write(folder: &Path, change: impl FnOnce(&mut Value)) -> PathBuf {
    fs::write(folder.join("square.bin"), buffer()).unwrap();
    fs::write(folder.join("print.png"), png()).unwrap();
    let mut root = gltf(
        &json!({ "uri": "square.bin", "byteLength": 92 }),
        &json!({ "uri": "print.png" }),
    );
    change(&mut root);
    let path = folder.join("square.gltf");
    fs::write(&path, serde_json::to_vec(&root).unwrap()).unwrap();
    path
}

/// A binary glTF of JSON and one chunk of bytes.
pub(crate) fn glb(root: &Value, chunk: &[u8]) -> Vec<u8> {
    let mut json = serde_json::to_vec(root).unwrap();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bin = chunk.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let total = 12 + 8 + json.len() + 8 + bin.len();
    let number = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
    let mut bytes = b"glTF".to_vec();
    bytes.extend(number(2));
    bytes.extend(number(total));
    bytes.extend(number(json.len()));
    bytes.extend(b"JSON");
    bytes.extend(json);
    bytes.extend(number(bin.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(bin);
    bytes
}

/// The whole square in one binary file: buffer and texture in its chunk.
pub(crate) fn whole_glb() -> Vec<u8> {
    let (buffer, png) = (buffer(), png());
    let length = buffer.len() + png.len();
    let mut root = gltf(
        &json!({ "byteLength": length }),
        &json!({ "bufferView": 3, "mimeType": "image/png" }),
    );
    let view = json!({ "buffer": 0, "byteOffset": buffer.len(), "byteLength": png.len() });
    root["bufferViews"].as_array_mut().unwrap().push(view);
    glb(&root, &[buffer, png].concat())
}

/// A scene file that looks at a square of another format as the glTF's camera does.
pub(crate) fn scene_toml(mesh: &str) -> String {
    format!(
        r#"
mesh = [{{ name = "square", {mesh} }}]
distant_light = [{{ from = [0, -1, 0], emittance = {{ srgb = [1, 1, 1] }}, illuminance = 1 }}]
[camera]
position_m = [0, -3, 0]
look_at_m = [0, 0, 0]
up = [0, 0, 1]
vertical_field_of_view_deg = 36.869897645844021
[diffuse.print]
texture = {{ file = "print.png", filter = "nearest" }}
"#
    )
}

/// The square as an OBJ with its material library.
pub(crate) fn write_obj(folder: &Path) -> PathBuf {
    fs::write(folder.join("print.png"), png()).unwrap();
    fs::write(
        folder.join("square.mtl"),
        "newmtl print\nKd 1 1 1\nmap_Kd print.png\n",
    )
    .unwrap();
    let text = "mtllib square.mtl\no square\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n\
                vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl print\nf 1/1 2/2 3/3 4/4\n";
    let path = folder.join("square.obj");
    fs::write(&path, text).unwrap();
    path
}

/// How the numbers of a PLY are written.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PlyForm {
    Ascii,
    Little,
    Big,
}

/// The square as a PLY.
pub(crate) fn ply(form: PlyForm) -> Vec<u8> {
    let name = match form {
        PlyForm::Ascii => "ascii",
        PlyForm::Little => "binary_little_endian",
        PlyForm::Big => "binary_big_endian",
    };
    let mut bytes = format!(
        "ply\nformat {name} 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    // PLY counts t upwards.
    let places = CORNERS.iter().zip(POINTS);
    for ([x, y, z], [u, v]) in places {
        let numbers = [*x, *y, *z, u, 1.0 - v];
        match form {
            PlyForm::Ascii => {
                bytes.extend(numbers.map(|n| format!("{n} ")).concat().trim_end().bytes());
            }
            PlyForm::Little => bytes.extend(numbers.iter().flat_map(|n| n.to_le_bytes())),
            PlyForm::Big => bytes.extend(numbers.iter().flat_map(|n| n.to_be_bytes())),
        }
        if matches!(form, PlyForm::Ascii) {
            bytes.push(b'\n');
        }
    }
    match form {
        PlyForm::Ascii => bytes.extend(b"4 0 1 2 3\n"),
        PlyForm::Little => {
            bytes.push(4);
            bytes.extend((0..4).flat_map(i32::to_le_bytes));
        }
        PlyForm::Big => {
            bytes.push(4);
            bytes.extend((0..4).flat_map(i32::to_be_bytes));
        }
    }
    bytes
}

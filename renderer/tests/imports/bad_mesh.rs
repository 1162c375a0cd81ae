//! OBJ, PLY, textures, and the tables of a scene file that name them, when something is wrong.

use std::fs;

use super::quad::{self, PlyForm, scene_toml};
use super::*;

fn told(path: &Path, words: &[&str]) {
    let message = error_of(path);
    for word in words {
        assert!(message.contains(word), "{word:?} is not in: {message}");
    }
}

#[test]
fn faults_of_an_obj_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.obj");
    for (text, words) in [
        ("", &["no triangle"][..]),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", &["no triangle"]),
        ("v 0 0 0\nv 1 0 x\nv 0 1 0\n", &["line 2", "an OBJ file"]),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", &["bad.obj"]),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", &["bad.obj"]),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", &["bad.obj"]),
        ("v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", &["no triangle"]),
        ("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &["no triangle"]),
        (
            "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            &["within 1000000 m"],
        ),
    ] {
        fs::write(&path, text).unwrap();
        told(&path, words);
    }
    fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    told(&path, &["UTF-8"]);
}

#[test]
fn faults_of_an_mtl_and_of_its_textures_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = quad::write_obj(folder.path());
    fs::remove_file(folder.path().join("print.png")).unwrap();
    told(
        &path,
        &[
            "print.png",
            "the texture of material \"print\"",
            "no such file",
        ],
    );
    fs::write(folder.path().join("print.png"), []).unwrap();
    told(&path, &["print.png", "a picture"]);
    fs::write(folder.path().join("square.mtl"), "newmtl print\nKd red\n").unwrap();
    told(&path, &["square.mtl", "line 2", "three numbers"]);
}

#[test]
fn faults_of_a_ply_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.ply");
    let good = String::from_utf8(quad::ply(PlyForm::Ascii)).unwrap();
    for (from, to, words) in [
        ("ply\n", "plx\n", &["a PLY file"][..]),
        ("property float z\n", "", &["x, y and z"]),
        ("vertex_indices", "corners", &["vertex_indices"]),
        ("4 0 1 2 3", "4 0 1 2 4", &["the vertex 4 of 4"]),
        ("4 0 1 2 3", "4 0 1 2 -3", &["the vertex 4294967295 of 4"]),
        ("4 0 1 2 3", "2 0 1", &["no triangle"]),
        ("element face 1", "element face 2", &["bad.ply"]),
        (
            "element face 1",
            "element face 18446744073709551615",
            &["bad.ply"],
        ),
        ("1 -1 0", "1 x 0", &["bad.ply"]),
    ] {
        assert!(good.contains(from), "{from:?}");
        fs::write(&path, good.replacen(from, to, 1)).unwrap();
        told(&path, words);
    }
    for form in [PlyForm::Little, PlyForm::Big] {
        let whole = quad::ply(form);
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            told(&path, &["bad.ply"]);
        }
    }
}

#[test]
fn faults_of_the_tables_are_named() {
    let folder = tempfile::tempdir().unwrap();
    quad::write(folder.path(), |_| ());
    let path = folder.path().join("scene.toml");
    for (mesh, words) in [
        ("file = \"gone.glb\"", &["gone.glb", "no such file"][..]),
        (
            "file = \"print.png\"",
            &["print.png", ".gltf, .glb, .obj or .ply"],
        ),
        (
            "file = \"square.gltf\", material = \"red\"",
            &["mesh 1 \"square\"", "\"red\"", "print"],
        ),
        (
            "file = \"square.gltf\", scale = 0",
            &["mesh 1 \"square\"", "field scale"],
        ),
        (
            "file = \"square.gltf\", scale = nan",
            &["mesh 1 \"square\"", "field scale"],
        ),
        (
            "file = \"square.gltf\", position_m = [0, inf, 0]",
            &["field position_m"],
        ),
        (
            "file = \"square.gltf\", rotation_deg = 1e9",
            &["field rotation_deg"],
        ),
        (
            "file = \"square.gltf\", up = \"x\"",
            &["unknown variant `x`"],
        ),
        (
            "file = \"square.gltf\", colour = 1",
            &["unknown field `colour`"],
        ),
        ("material = \"print\"", &["missing field `file`"]),
    ] {
        fs::write(&path, scene_toml(mesh)).unwrap();
        told(&path, words);
    }
}

#[test]
fn faults_of_a_texture_table_are_named() {
    let folder = tempfile::tempdir().unwrap();
    quad::write(folder.path(), |_| ());
    let path = folder.path().join("scene.toml");
    let good = scene_toml("file = \"square.gltf\"");
    for (from, to, words) in [
        (
            "print.png",
            "gone.png",
            &["gone.png", "diffuse \"print\""][..],
        ),
        (
            "texture = ",
            "# ",
            &["diffuse \"print\"", "a reflectance or a texture"],
        ),
        (
            "texture = ",
            "reflectance = [[500, 1]]\ntexture = ",
            &["one of the two"],
        ),
        ("\"nearest\"", "\"cubic\"", &["unknown variant `cubic`"]),
        (
            "[diffuse.print]",
            "[diffuse.print]\nchecker = { reflectance = [[500, 1]], size_m = 1 }",
            &["one of them"],
        ),
    ] {
        assert!(good.contains(from), "{from:?}");
        fs::write(&path, good.replacen(from, to, 1)).unwrap();
        told(&path, words);
    }
}

#[test]
fn pictures_of_other_formats_and_broken_ones_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    quad::write(folder.path(), |_| ());
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene_toml("file = \"square.gltf\"")).unwrap();
    let png = quad::png();
    // The last chunk, of 12 bytes, and the check sum before it are not needed.
    for length in (0..png.len() - 20).step_by(2) {
        fs::write(folder.path().join("print.png"), &png[..length]).unwrap();
        told(&path, &["print.png"]);
    }
    fs::write(folder.path().join("print.png"), b"GIF89a......").unwrap();
    told(&path, &["print.png", "Gif"]);
    // An EXR by its magic number, and nothing more.
    fs::write(
        folder.path().join("print.png"),
        [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0],
    )
    .unwrap();
    told(&path, &["print.png"]);
}

#[test]
fn an_exr_is_linear_and_a_jpeg_is_encoded() {
    let folder = tempfile::tempdir().unwrap();
    quad::write(folder.path(), |_| ());
    let path = folder.path().join("scene.toml");
    let level = 0.25_f32;
    let exr = folder.path().join("level.exr");
    exr::prelude::write_rgb_file(&exr, 4, 4, |_, _| (level, level, level)).unwrap();
    let text = scene_toml("file = \"square.gltf\", material = \"print\"");
    fs::write(&path, text.replace("print.png", "level.exr")).unwrap();
    let [_, green, _] = colour(&Scene::read(&path).unwrap(), 0.4, 0.6);
    assert!((green - 0.25).abs() < 2e-3, "{green}");
    let jpeg = folder.path().join("level.jpg");
    image::RgbImage::from_pixel(8, 8, image::Rgb([188; 3]))
        .save(&jpeg)
        .unwrap();
    fs::write(&path, text.replace("print.png", "level.jpg")).unwrap();
    // ((188/255 + 0.055) / 1.055)^2.4 = 0.5029.
    let [_, green, _] = colour(&Scene::read(&path).unwrap(), 0.4, 0.6);
    assert!((green - 0.5029).abs() < 6e-3, "{green}");
}

#[test]
fn an_absurdly_large_scene_file_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    // A file with a hole takes no room on the disk.
    fs::File::create(&path)
        .unwrap()
        .set_len((1 << 26) + 1)
        .unwrap();
    told(&path, &["large.toml", "a larger file"]);
    let mesh = folder.path().join("large.glb");
    fs::File::create(&mesh)
        .unwrap()
        .set_len((1 << 30) + 1)
        .unwrap();
    told(&mesh, &["large.glb", "a larger file"]);
}

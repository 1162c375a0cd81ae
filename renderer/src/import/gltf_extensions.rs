//! What the JSON of a glTF says before it is read as one: extensions that are required and unknown, and
//! positions that are nowhere, are errors; other unknown extensions are warnings.

use gltf::binary::Glb;
use protocols::InputError;
use serde_json::Value;

use super::Source;

/// The extensions that are read, or whose effect is told elsewhere.
const KNOWN: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_texture_transform",
];

/// The lists of a glTF in which things may be extended, and what one of them is called.
const LISTS: [(&str, &str); 12] = [
    ("accessors", "accessor"),
    ("bufferViews", "buffer view"),
    ("buffers", "buffer"),
    ("cameras", "camera"),
    ("images", "image"),
    ("materials", "material"),
    ("meshes", "mesh"),
    ("nodes", "node"),
    ("samplers", "sampler"),
    ("scenes", "scene"),
    ("skins", "skin"),
    ("textures", "texture"),
];

/// Checks the extensions that a file requires, and names those that it uses and that are not known.
///
/// # Errors
///
/// If the file is no JSON, or requires what is not known.
pub(super) fn check(source: &Source, warnings: &mut Vec<String>) -> Result<(), InputError> {
    let expected = "a glTF 2.0 file";
    let glb;
    let json = if source.bytes.starts_with(b"glTF") {
        let length = source
            .bytes
            .get(8..)
            .and_then(|rest| rest.first_chunk::<4>());
        if length.is_some_and(|length| u32::from_le_bytes(*length) < 12) {
            return Err(source.error("a length of less than 12 bytes", expected));
        }
        glb = Glb::from_slice(&source.bytes)
            .map_err(|error| source.error(error.to_string(), expected))?;
        glb.json.as_ref()
    } else {
        &source.bytes
    };
    let root: Value = serde_json::from_slice(json)
        .map_err(|error| source.error(format!("JSON with an error: {error}"), expected))?;
    let version = &root["asset"]["version"];
    if !version
        .as_str()
        .is_some_and(|version| version.starts_with("2."))
    {
        let found = format!("version {version}");
        return Err(source.error(found, expected).at("asset"));
    }
    let required = root["extensionsRequired"].as_array().into_iter().flatten();
    let unknown = required
        .filter_map(Value::as_str)
        .find(|name| !KNOWN.contains(name));
    if let Some(unknown) = unknown {
        let expected = format!("only extensions that are known: {}", KNOWN.join(", "));
        return Err(source
            .error(format!("\"{unknown}\""), expected)
            .at("extensionsRequired")
            .remedy("export the file without it"));
    }
    check_positions(source, &root)?;
    check_choices(source, &root)?;
    for (list, kind) in LISTS {
        let things = root[list].as_array().into_iter().flatten();
        for (index, thing) in things.enumerate() {
            let name = super::gltf_file::named(kind, thing["name"].as_str(), index);
            warn_of(source, &name, thing, warnings);
        }
    }
    let root_only = serde_json::json!({ "extensions": root["extensions"] });
    warn_of(source, "the file", &root_only, warnings);
    let animations = root["animations"].as_array().map_or(0, Vec::len);
    if animations > 0 {
        let what =
            format!("animations ({animations}) are not supported: it stands as it was saved");
        warnings.push(source.warning("the file", &what));
    }
    Ok(())
}

/// Checks that every primitive has its positions in an accessor that is there: the reader takes it for granted.
fn check_positions(source: &Source, root: &Value) -> Result<(), InputError> {
    let accessors = root["accessors"].as_array().map_or(0, Vec::len);
    let meshes = root["meshes"].as_array().into_iter().flatten();
    for (index, mesh) in meshes.enumerate() {
        let primitives = mesh["primitives"].as_array().into_iter().flatten();
        for primitive in primitives {
            let position = &primitive["attributes"]["POSITION"];
            let is_there = position
                .as_u64()
                .is_none_or(|accessor| accessor < accessors as u64);
            if !is_there {
                let found = format!("POSITION in the accessor {position} of {accessors}");
                let name = super::gltf_file::named("mesh", mesh["name"].as_str(), index);
                let expected = "an accessor that is there (from 0)";
                return Err(source.error(found, expected).at(name));
            }
        }
    }
    Ok(())
}

/// Checks that images, cameras and lights have the fields that their kind asks for: the reader takes it for
/// granted.
fn check_choices(source: &Source, root: &Value) -> Result<(), InputError> {
    let lights = &root["extensions"]["KHR_lights_punctual"]["lights"];
    for (kind, list) in [
        ("image", &root["images"]),
        ("camera", &root["cameras"]),
        ("light", lights),
    ] {
        let things = list.as_array().into_iter().flatten();
        for (index, thing) in things.enumerate() {
            let needed: &[&str] = match (kind, thing["type"].as_str()) {
                ("image", _) if !thing["bufferView"].is_null() => &["mimeType"],
                ("image", _) => &["uri"],
                ("camera", Some("perspective")) => &["perspective"],
                ("camera", Some("orthographic")) => &["orthographic"],
                ("light", Some("spot")) => &["spot"],
                _ => &[],
            };
            if let Some(missing) = needed.iter().find(|field| thing[**field].is_null()) {
                let name = super::gltf_file::named(kind, thing["name"].as_str(), index);
                return Err(source.error(format!("no {missing}"), "one").at(name));
            }
        }
    }
    Ok(())
}

/// Names every unknown extension of a thing, at any depth; JSON here is at most 128 deep.
fn warn_of(source: &Source, name: &str, thing: &Value, warnings: &mut Vec<String>) {
    match thing {
        Value::Object(fields) => {
            let extensions = fields.get("extensions").and_then(Value::as_object);
            for extension in extensions.into_iter().flat_map(|map| map.keys()) {
                if !KNOWN.contains(&extension.as_str()) {
                    let what = format!("{extension} is not supported: ignored");
                    let warning = source.warning(name, &what);
                    if !warnings.contains(&warning) {
                        warnings.push(warning);
                    }
                }
            }
            let inner = fields.iter().filter(|(key, _)| *key != "extras");
            inner.for_each(|(_, field)| warn_of(source, name, field, warnings));
        }
        Value::Array(items) => {
            // Lists of numbers, such as indices, are long and hold no extension.
            let inner = items.iter().filter(|item| !item.is_number());
            inner.for_each(|item| warn_of(source, name, item, warnings));
        }
        _ => {}
    }
}

//! What a glTF asks for beyond the standard: an error where it is required and unknown, else a warning.

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
        glb = Glb::from_slice(&source.bytes)
            .map_err(|error| source.error(error.to_string(), expected))?;
        glb.json.as_ref()
    } else {
        &source.bytes
    };
    let root: Value = serde_json::from_slice(json)
        .map_err(|error| source.error(format!("JSON with an error: {error}"), expected))?;
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

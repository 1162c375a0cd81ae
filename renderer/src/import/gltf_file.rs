//! glTF 2.0: a file, its buffers, and the nodes of its scene.
//!
//! Read: triangles (lists, strips, fans) with normals and texture points, node transforms, materials, cameras,
//! point and directional lights. Everything else that the file has is named in a warning.
//!
//! Source: Khronos, *glTF 2.0 Specification*, version 2.0.1 (ISO/IEC 12113:2022).

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::{Gltf, Node};
use protocols::{InputError, ReadError, Sha256Digest};

use super::source::bounded_bytes;
use super::{Import, Placement, Source};
use super::{gltf_extensions, gltf_lights, gltf_material, gltf_mesh, gltf_texture};

/// A glTF with its bytes.
pub(super) struct GltfFile<'source> {
    pub(super) source: &'source Source,
    pub(super) gltf: Gltf,
    pub(super) buffers: Vec<Vec<u8>>,
}

/// Reads a glTF and places it in the world; its y is up.
pub(super) fn read(source: &Source, placement: &Placement) -> Result<Import, ReadError> {
    let mut import = Import::default();
    gltf_extensions::check(source, &mut import.warnings)?;
    let mut gltf = Gltf::from_slice(&source.bytes)
        .map_err(|error| source.error(error.to_string(), "a glTF 2.0 file"))?;
    let blob = gltf.blob.take();
    let buffers = buffers(source, &gltf, blob)?;
    import.digests = buffers
        .iter()
        .map(|bytes| Sha256Digest::of(bytes))
        .collect();
    let file = GltfFile {
        source,
        gltf,
        buffers,
    };
    import.pictures = gltf_texture::pictures(&file, &mut import.warnings)?;
    for material in file.gltf.materials() {
        let material = gltf_material::material(&file, &material, &mut import);
        import.materials.push(material);
    }
    file.walk(placement, &mut import)?;
    Ok(import)
}

impl GltfFile<'_> {
    fn walk(&self, placement: &Placement, import: &mut Import) -> Result<(), InputError> {
        let scenes = self.gltf.scenes().len();
        let scene = self
            .gltf
            .default_scene()
            .or_else(|| self.gltf.scenes().next());
        let Some(scene) = scene else {
            let expected = "a glTF with a scene";
            return Err(self.source.error("no scene", expected));
        };
        if scenes > 1 {
            let what = format!("one of {scenes} scenes: the others are left out");
            let thing = format!("scene {}", scene.index());
            import.warnings.push(self.source.warning(&thing, &what));
        }
        let mut seen = vec![false; self.gltf.nodes().len()];
        let mut waiting: Vec<(Node<'_>, Placement)> =
            scene.nodes().map(|node| (node, *placement)).collect();
        waiting.reverse();
        while let Some((node, above)) = waiting.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
                let found = format!("node {} twice in the tree", node.index());
                return Err(self.source.error(found, "nodes that are a tree"));
            }
            let here = above.after(&transform(&node));
            self.node(&node, &here, import)?;
            let children: Vec<Node<'_>> = node.children().collect();
            waiting.extend(children.into_iter().rev().map(|child| (child, here)));
        }
        Ok(())
    }

    fn node(
        &self,
        node: &Node<'_>,
        placement: &Placement,
        import: &mut Import,
    ) -> Result<(), InputError> {
        let name = named("node", node.name(), node.index());
        if node.skin().is_some() {
            let what = "skins are not supported: the mesh stands as it was modelled";
            import.warnings.push(self.source.warning(&name, what));
        }
        if let Some(mesh) = node.mesh() {
            gltf_mesh::add(self, &mesh, placement, import)?;
        }
        if let Some(camera) = node.camera() {
            gltf_lights::add_camera(self, &camera, placement, import);
        }
        if let Some(light) = node.light() {
            gltf_lights::add_light(self, &light, placement, import);
        }
        Ok(())
    }

    /// A warning about a thing of the file.
    pub(super) fn warn(&self, import: &mut Import, thing: &str, what: &str) {
        let warning = self.source.warning(thing, what);
        if !import.warnings.contains(&warning) {
            import.warnings.push(warning);
        }
    }
}

/// How to speak of a thing: by its name, or by its number from 0 as the file counts.
pub(super) fn named(kind: &str, name: Option<&str>, index: usize) -> String {
    name.map_or_else(
        || format!("{kind} {index}"),
        |name| format!("{kind} \"{name}\""),
    )
}

fn transform(node: &Node<'_>) -> Placement {
    // Column by column.
    let columns = node
        .transform()
        .matrix()
        .map(|column| column.map(f64::from));
    Placement {
        linear: [0, 1, 2].map(|row| [0, 1, 2].map(|column| columns[column][row])),
        offset: [0, 1, 2].map(|row| columns[3][row]),
    }
}

fn buffers(
    source: &Source,
    gltf: &Gltf,
    mut blob: Option<Vec<u8>>,
) -> Result<Vec<Vec<u8>>, ReadError> {
    let mut buffers = Vec::new();
    for buffer in gltf.buffers() {
        let place = format!("buffer {}", buffer.index());
        let bytes = match buffer.source() {
            gltf::buffer::Source::Bin => blob.take().ok_or_else(|| {
                let expected = "a binary chunk (a .glb), or a uri";
                source.error("no bytes for it", expected).at(place.as_str())
            })?,
            gltf::buffer::Source::Uri(uri) => bytes_of_uri(source, uri, &place)?,
        };
        if bytes.len() < buffer.length() {
            let found = format!("{} bytes", bytes.len());
            let expected = format!("{} bytes, as the file says", buffer.length());
            return Err(source.error(found, expected).at(place).into());
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// The bytes of a file beside this one, or of a `data:` URI.
pub(super) fn bytes_of_uri(source: &Source, uri: &str, place: &str) -> Result<Vec<u8>, ReadError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let encoded = data.split_once(";base64,").map(|(_, encoded)| encoded);
        let decoded = encoded.and_then(|encoded| STANDARD.decode(encoded).ok());
        return decoded.ok_or_else(|| {
            let expected = "bytes in base64 after \"data:...;base64,\"";
            source.error("other data", expected).at(place).into()
        });
    }
    if uri.contains("://") {
        let expected = "a file beside this one, or bytes within it";
        return Err(source
            .error(format!("\"{uri}\""), expected)
            .at(place)
            .into());
    }
    bounded_bytes(&source.beside(&unescaped(uri))).map_err(|error| match error {
        ReadError::Input(error) => error
            .at(format!("{place} of \"{}\"", source.path.display()))
            .into(),
        other @ ReadError::Io { .. } => other,
    })
}

/// A relative URI with its `%20` and the like as bytes.
fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| first == b'%');
        let code = code.and_then(|code| std::str::from_utf8(code).ok());
        let code = code.and_then(|code| u8::from_str_radix(code, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = &after[if code.is_some() { 2 } else { 0 }..];
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uri_is_unescaped_byte_by_byte() {
        assert_eq!(unescaped("a%20b%C3%A9.bin"), "a bé.bin");
        assert_eq!(unescaped("100%.bin"), "100%.bin");
        assert_eq!(unescaped("%"), "%");
    }
}

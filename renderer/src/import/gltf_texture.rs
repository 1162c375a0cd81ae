//! The pictures of a glTF, and how its materials use them.

use gltf::image::Source as ImageSource;
use gltf::texture::{Info, MagFilter, WrappingMode};
use protocols::ReadError;

use super::gltf_file::{GltfFile, bytes_of_uri, named};
use super::{Filter, ImportedTexture, Picture, Wrap};

/// Reads all pictures that are the base colour of a material; others stand as one black pixel.
pub(super) fn pictures(
    file: &GltfFile<'_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Picture>, ReadError> {
    let used: Vec<usize> = file
        .gltf
        .materials()
        .filter_map(|material| material.pbr_metallic_roughness().base_color_texture())
        .map(|info| info.texture().source().index())
        .collect();
    let mut pictures = Vec::new();
    for image in file.gltf.images() {
        let place = named("image", image.name(), image.index());
        if !used.contains(&image.index()) {
            pictures.push(Picture::black());
            continue;
        }
        let picture = match image.source() {
            ImageSource::Uri { uri, .. } => {
                let bytes = bytes_of_uri(file.source, uri, &place)?;
                Picture::decode(&file.source.path, &place, &bytes)?
            }
            ImageSource::View { view, .. } => {
                let end = view.offset().checked_add(view.length());
                let buffer = &file.buffers[view.buffer().index()];
                let bytes = end.and_then(|end| buffer.get(view.offset()..end));
                let bytes = bytes.ok_or_else(|| {
                    let found = "a buffer view beyond the end of its buffer";
                    file.source.error(found, "one within it").at(place.as_str())
                })?;
                Picture::decode(&file.source.path, &place, bytes)?
            }
        };
        if picture.has_alpha {
            let what = "its transparency is not supported: ignored";
            warnings.push(file.source.warning(&place, what));
        }
        pictures.push(picture);
    }
    Ok(pictures)
}

/// The texture of a base colour.
pub(super) fn texture(info: &Info<'_>) -> ImportedTexture {
    let texture = info.texture();
    let sampler = texture.sampler();
    let wrap = |mode| match mode {
        WrappingMode::ClampToEdge => Wrap::Clamp,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::Repeat => Wrap::Repeat,
    };
    let filter = match sampler.mag_filter() {
        Some(MagFilter::Nearest) => Filter::Nearest,
        Some(MagFilter::Linear) | None => Filter::Bilinear,
    };
    ImportedTexture {
        picture: texture.source().index(),
        wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
        filter,
    }
}

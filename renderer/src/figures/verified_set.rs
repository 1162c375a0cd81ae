//! A stimulus set whose every file is checked against the manifest before it is used.

use std::path::Path;

use protocols::{
    InputError, Manifest, ManifestStimulus, PerChannel, RayCount, StimulusId, StimulusPlan, Study,
};

use crate::channel_image::ChannelImage;
use crate::error::RendererError;
use crate::opponent_exr::read_opponent_exr;
use crate::srgb_png::SrgbImage;

/// The set of a study.
#[derive(Debug)]
pub(super) struct VerifiedSet<'a> {
    manifest: Manifest,
    folder: &'a Path,
}

impl<'a> VerifiedSet<'a> {
    pub(super) fn read(study: &Study, folder: &'a Path) -> Result<Self, RendererError> {
        study.render_plan()?;
        let manifest = Manifest::read(folder)?;
        manifest.check_made_for(study, folder)?;
        Ok(Self { manifest, folder })
    }

    pub(super) fn plan(&self) -> &StimulusPlan {
        &self.manifest.plan
    }

    fn stimulus(
        &self,
        rays_a: RayCount,
        rays_c1c2: RayCount,
    ) -> Result<&ManifestStimulus, InputError> {
        let id = StimulusId::from_ray_counts(rays_a, rays_c1c2);
        self.manifest.stimulus(&id).ok_or_else(|| {
            let path = self.folder.join(Manifest::FILE_NAME);
            InputError::new(path, "no such entry", format!("the stimulus {id}"))
        })
    }

    /// The opponent channels of one image.
    pub(super) fn channels(
        &self,
        rays_a: RayCount,
        rays_c1c2: RayCount,
    ) -> Result<PerChannel<ChannelImage>, RendererError> {
        let file = &self.stimulus(rays_a, rays_c1c2)?.exr;
        let bytes = file.read_verified(self.folder)?;
        let path = self.folder.join(&file.name);
        let channels = read_opponent_exr(&bytes, &path)?;
        self.check_size(channels.a.size_px(), &path)?;
        Ok(channels)
    }

    fn check_size(&self, found_px: [u32; 2], path: &Path) -> Result<(), InputError> {
        let size = |[width, height]: [u32; 2]| format!("{width} x {height} pixels");
        let expected_px = self.plan().size_px;
        if found_px == expected_px {
            return Ok(());
        }
        Err(InputError::new(path, size(found_px), size(expected_px)).remedy("render the set again"))
    }

    /// One image as a display is given it.
    pub(super) fn picture(
        &self,
        rays_a: RayCount,
        rays_c1c2: RayCount,
    ) -> Result<SrgbImage, RendererError> {
        let stimulus = self.stimulus(rays_a, rays_c1c2)?;
        let bytes = stimulus.png.read_verified(self.folder)?;
        let decoded = image::load_from_memory_with_format(&bytes, image::ImageFormat::Png);
        let path = self.folder.join(&stimulus.png.name);
        let picture = decoded.map_err(|error| {
            InputError::new(&path, error.to_string(), "a PNG file").remedy("render the set again")
        })?;
        let picture = picture.into_rgb8();
        let size_px = [picture.width(), picture.height()];
        self.check_size(size_px, &path)?;
        Ok(SrgbImage {
            size_px,
            bytes: picture.into_raw(),
            out_of_gamut_px: stimulus.out_of_gamut_px,
        })
    }
}

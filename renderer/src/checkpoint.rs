//! What is kept of a trace that was ended early, so that it goes on to the same bytes.
//!
//! Where a sample lies and which cell is split next follow from the seed and the values before, so the
//! values are all that is kept: the tree is grown again from them, without a ray.
//!
//! The file: one line of JSON ([`Header`]), then for each sample A, C1 and C2 as little-endian 32-bit
//! floats, 0 where a channel was not shaded. A file that is damaged, or that was made from another scene,
//! plan or version of the program, is refused and never mended.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use protocols::{
    Access, Channel, InputError, PerChannel, Quadrature, ReadError, Sha256Digest, write_atomically,
};
use serde::{Deserialize, Serialize};

use crate::error::RendererError;
use crate::refine::{TracePlan, trace_from};
use crate::sampler::Sampler;
use crate::screen_tree::ScreenTree;
use crate::watch::{Stage, Watch};

const KIND: &str = "the checkpoint of this picture";
const REMEDY: &str = "remove it to begin anew";
/// A, C1 and C2.
const BYTES_PER_SAMPLE: usize = 12;

/// The value of each channel of one sample; 0 where a channel was not shaded.
pub(crate) type TakenSample = PerChannel<f32>;

/// The first line of the file.
#[derive(Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    acuity_checkpoint: u32,
    /// The digest of all that the tree follows from.
    made_from: Sha256Digest,
    samples: u64,
    /// The digest of all that comes after this line.
    values_sha256: Sha256Digest,
}

/// Where the samples of one trace are kept while it is not finished.
#[derive(Clone, Debug)]
pub(crate) struct Checkpoint {
    path: PathBuf,
    made_from: Sha256Digest,
}

impl Checkpoint {
    /// The checkpoint beside `output`: a file of that name and `.checkpoint`.
    pub(crate) fn beside(
        output: &Path,
        plan: &TracePlan,
        quadrature: Quadrature,
        scene_sha256: &Sha256Digest,
    ) -> Self {
        let mut name = output.as_os_str().to_owned();
        name.push(".checkpoint");
        let quadrature = String::from(quadrature);
        let made_from = format!(
            "acuity {}, scene {scene_sha256}, {quadrature}, {plan:?}",
            env!("CARGO_PKG_VERSION")
        );
        Self {
            path: name.into(),
            made_from: Sha256Digest::of(made_from.as_bytes()),
        }
    }

    /// The tree of a plan: the samples that are kept here first, and new ones from then on.
    ///
    /// # Errors
    ///
    /// [`RendererError::Interrupted`] if the watch ends the work; the samples so far are then kept here.
    /// [`RendererError::Input`] if the file is damaged or of another picture.
    pub(crate) fn trace(
        &self,
        sampler: &impl Sampler,
        plan: &TracePlan,
        watch: &Watch<'_>,
    ) -> Result<ScreenTree, RendererError> {
        let taken = self.read()?;
        let told = |done, total| watch.tell(Stage::Rays, done, total);
        let tree = trace_from(sampler, plan, &taken, (&told, &|| watch.is_cancelled()));
        self.keep_if_cancelled(&tree, plan, watch)?;
        Ok(tree)
    }

    /// Keeps the samples of a tree and gives an error, if the watch ends the work.
    ///
    /// # Errors
    ///
    /// [`RendererError::Interrupted`], or that the file could not be written.
    pub(crate) fn keep_if_cancelled(
        &self,
        tree: &ScreenTree,
        plan: &TracePlan,
        watch: &Watch<'_>,
    ) -> Result<(), RendererError> {
        if !watch.is_cancelled() {
            return Ok(());
        }
        write_atomically(&self.path, &self.encode(tree)?, Access::Ordinary)
            .map_err(|error| RendererError::writing(&self.path, error))?;
        Err(self.interruption(tree, plan))
    }

    /// What is said when the work was ended.
    pub(crate) fn interruption(&self, tree: &ScreenTree, plan: &TracePlan) -> RendererError {
        RendererError::Interrupted {
            checkpoint: self.path.clone(),
            rays: tree.len() as u64,
            of_rays: plan.rays() as u64,
        }
    }

    /// Removes the file, if there is one: the picture is made.
    pub(crate) fn remove(&self) -> Result<(), RendererError> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                Err(RendererError::writing(&self.path, error))
            }
            _ => Ok(()),
        }
    }

    fn encode(&self, tree: &ScreenTree) -> Result<Vec<u8>, RendererError> {
        let mut values = Vec::with_capacity(tree.len() * BYTES_PER_SAMPLE);
        for sample in (0..u32::MAX).take(tree.len()) {
            for channel in Channel::ALL {
                let value = tree.value(channel, sample).unwrap_or_default();
                values.extend(value.to_le_bytes());
            }
        }
        let header = Header {
            acuity_checkpoint: 1,
            made_from: self.made_from.clone(),
            samples: tree.len() as u64,
            values_sha256: Sha256Digest::of(&values),
        };
        let header = serde_json::to_vec(&header).map_err(|error| RendererError::Encoding {
            path: self.path.clone(),
            reason: error.to_string(),
        })?;
        Ok([header, b"\n".to_vec(), values].concat())
    }

    /// The samples that are kept; none if there is no file.
    fn read(&self) -> Result<Vec<TakenSample>, RendererError> {
        match fs::read(&self.path) {
            Ok(bytes) => Ok(self.decode(&bytes)?),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
            Err(error) => Err(ReadError::from_io(&self.path, KIND, error).into()),
        }
    }

    fn decode(&self, bytes: &[u8]) -> Result<Vec<TakenSample>, InputError> {
        let wrong = |found: &str, expected: &str| {
            InputError::new(&self.path, found, expected).remedy(REMEDY)
        };
        let first_line = bytes.iter().take(4096).position(|&byte| byte == b'\n');
        let (header, values) = first_line
            .map(|end| (&bytes[..end], &bytes[end + 1..]))
            .ok_or_else(|| wrong("a file without a first line", KIND))?;
        let header: Header = serde_json::from_slice(header)
            .map_err(|error| wrong(&error.to_string(), KIND).at("line 1"))?;
        if header.acuity_checkpoint != 1 || header.made_from != self.made_from {
            let found = "the checkpoint of another scene, plan or version of the program";
            return Err(wrong(found, KIND));
        }
        let length = u64::try_from(BYTES_PER_SAMPLE).map(|bytes| header.samples.checked_mul(bytes));
        if length != Ok(Some(values.len() as u64)) {
            let found = format!("{} bytes of values", values.len());
            let expected = format!("{} samples of {BYTES_PER_SAMPLE} bytes", header.samples);
            return Err(wrong(&found, &expected));
        }
        if Sha256Digest::of(values) != header.values_sha256 {
            return Err(wrong("values that were changed", "those of its first line"));
        }
        let (samples, _rest) = values.as_chunks::<BYTES_PER_SAMPLE>();
        Ok(samples.iter().copied().map(taken_sample).collect())
    }
}

fn taken_sample(bytes: [u8; BYTES_PER_SAMPLE]) -> TakenSample {
    let (values, _rest) = bytes.as_chunks::<4>();
    PerChannel {
        a: f32::from_le_bytes(values[0]),
        c1: f32::from_le_bytes(values[1]),
        c2: f32::from_le_bytes(values[2]),
    }
}

"""Independent renders of an exported scene by Mitsuba 3, as mean and standard error for each pixel.

Scenes in which no surface that scatters sees another lit one in a path of the length given are rendered by
Mitsuba's own `path`. It samples one light at random; so every light is rendered alone and the pictures are
added, and all lights count. Other scenes are rendered by `whitted.py`.
"""

import os
import tempfile
from pathlib import Path

os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1")

import mitsuba as mi
import numpy as np

VARIANT = "llvm_ad_spectral"
mi.set_variant(VARIANT)

import whitted  # noqa: F401, registers its plugins
from export import Exported

# How many hits a path of Mitsuba's own integrator may have; 1 is direct light only.
PATH_HITS = {"lights": 1, "shadows": 1, "patterns": 1, "areas": 1, "meshes": 1, "mirror": 2}


def load(scene_file, size_px, samples):
    """The scenes whose pictures add up to that of the file."""
    stem = Path(scene_file).stem
    with tempfile.TemporaryDirectory() as folder:
        exported = Exported(scene_file, folder, exact=stem not in PATH_HITS)
        for note in exported.notes:
            print(f"note: {note}")
        if exported.exact:
            return [mi.load_string(exported.xml(size_px, samples))]
        depth = f'<integer name="max_depth" value="{PATH_HITS[stem] + 1}"/>'
        integrator = f'<integrator type="path">{depth}</integrator>'
        return [
            mi.load_string(exported.xml(size_px, samples, [light], integrator))
            for light in range(exported.light_count())
        ]


def renders(scene_file, size_px, samples, seeds):
    """The XYZ of each seed: an array of seeds x height x width x 3."""
    scenes = load(scene_file, size_px, samples)

    def render(number, seed):
        # No two renders share a random stream.
        return np.array(mi.render(scenes[number], spp=samples, seed=seed * len(scenes) + number))

    return np.stack([sum(render(number, seed) for number in range(len(scenes))) for seed in seeds])


def mean_and_error(images):
    """The mean over the first axis and its standard error."""
    return images.mean(axis=0), images.std(axis=0, ddof=1) / np.sqrt(len(images))

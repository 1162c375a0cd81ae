"""Independent renders of an exported scene by Mitsuba 3, as mean and standard error for each pixel.

Mitsuba's `path` samples one light at random; here every light is rendered alone and the pictures are added,
so that all lights count and none adds to the noise of the others.
"""

import os
import tempfile
from pathlib import Path

os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1")

import mitsuba as mi
import numpy as np

VARIANT = "llvm_ad_spectral"
mi.set_variant(VARIANT)

from export import Exported

# How many hits a path may have before it must reach a light: 1 is direct light only.
BOUNCES = {"mirror": 2}


def renders(scene_file, size_px, samples, seeds):
    """The XYZ of each seed: an array of seeds x height x width x 3."""
    hits = BOUNCES.get(Path(scene_file).stem, 1)
    integrator = f'<integrator type="path"><integer name="max_depth" value="{hits + 1}"/></integrator>'
    with tempfile.TemporaryDirectory() as folder:
        exported = Exported(scene_file, folder)
        for note in exported.notes:
            print(f"note: {note}")
        scenes = [
            mi.load_string(exported.xml(size_px, samples, [light], integrator))
            for light in range(len(exported.lights()))
        ]

    def render(number, seed):
        # No two renders share a random stream.
        return np.array(mi.render(scenes[number], spp=samples, seed=seed * len(scenes) + number))

    return np.stack([sum(render(number, seed) for number in range(len(scenes))) for seed in seeds])


def mean_and_error(images):
    """The mean over the first axis and its standard error."""
    return images.mean(axis=0), images.std(axis=0, ddof=1) / np.sqrt(len(images))

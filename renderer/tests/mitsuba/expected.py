"""Makes the expected images, `expected/*.exr`: Mitsuba's mean XYZ and its standard error for each pixel.

    pip install mitsuba==3.9.1 numpy
    DRJIT_LIBLLVM_PATH=.../libLLVM.so.19.1 python expected.py [CASE ...]

It needs LLVM 19 or newer. Each file holds the channels X, Y, Z and error.X, error.Y, error.Z and says in its
comments what made it, from which scene.
"""

import hashlib
import sys
from pathlib import Path

import numpy as np

from mitsuba_render import VARIANT, mean_and_error, mi, renders

HERE = Path(__file__).resolve().parent
OF_THE_STUDY = HERE.parents[2] / "stimuli/scenes/opponent-solids.toml"
SIZE_PX = (48, 48)
SAMPLES, SEEDS = 256, 32


def make(scene_file):
    mean, error = mean_and_error(renders(scene_file, SIZE_PX, SAMPLES, range(1, SEEDS + 1)))
    names = ["X", "Y", "Z", "error.X", "error.Y", "error.Z"]
    pixels = np.concatenate([mean, error], axis=2).astype(np.float32)
    bitmap = mi.Bitmap(pixels, mi.Bitmap.PixelFormat.MultiChannel, names)
    digest = hashlib.sha256(scene_file.read_bytes()).hexdigest()
    bitmap.metadata()["comments"] = (
        f"Mitsuba {mi.__version__}, {VARIANT}, {SEEDS} renders of {SAMPLES} samples a pixel for each light; "
        f"scene {scene_file.name} sha256 {digest}"
    )
    out = HERE / "expected" / f"{scene_file.stem}.exr"
    out.parent.mkdir(exist_ok=True)
    bitmap.write(str(out))
    print(f"{out.name}: mean XYZ {mean.mean(axis=(0, 1))}, median error {np.median(error):.5f}")


def main():
    for scene_file in [*sorted((HERE / "scenes").glob("*.toml")), OF_THE_STUDY]:
        if scene_file.stem in (sys.argv[1:] or [scene_file.stem]):
            make(scene_file)


if __name__ == "__main__":
    main()

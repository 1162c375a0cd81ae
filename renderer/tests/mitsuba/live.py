"""Renders scenes with Acuity and with Mitsuba 3 and compares them in XYZ, pixel by pixel.

    python live.py [SCENE.toml ...] [--acuity target/release/acuity] [--size 48] [--samples 256] [--seeds 16]

Both renderers make as many independent pictures as there are seeds: Acuity with its whole program, 150 rays a
pixel by the screen tree, 61 bands; Mitsuba one picture for each light, added. A pixel or a block of pixels whose
means differ by more standard errors than chance allows (Sidak, an error of 0.001 over the picture, Student's t)
fails. Then a picture of three parts is written beside the scene's name: Acuity, Mitsuba, and the difference in
standard errors of Y (red: Acuity is brighter, blue: Mitsuba is). Exit code 1 if a scene fails.

Needs `pip install mitsuba==3.9.1 numpy` and LLVM 19 or newer by DRJIT_LIBLLVM_PATH.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import NormalDist

import numpy as np

from mitsuba_render import mean_and_error, mi, renders

HERE = Path(__file__).resolve().parent
# Eq. 2 of Meyer & Liu (1992).
AC1C2_FROM_XYZ = [[-0.0177, 1.0090, 0.0073], [-1.5370, 1.0821, 0.3209], [0.1946, -0.2045, 0.5264]]
RAYS_A_PIXEL = 150
BLOCK_PX = 8
# The tent makes neighbours share samples: over a block as if it held this many times fewer pixels.
SHARED = 2.25


def acuity_renders(program, scene_file, size_px, seeds):
    """As `renders`, by Acuity."""
    rays = str(RAYS_A_PIXEL * size_px[0] * size_px[1])
    pictures = []
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "picture.exr"
        for seed in seeds:
            command = [program, "image", scene_file, "--rays-a", rays, "--rays-c1c2", rays, "-o", out]
            command += ["--size", "{}x{}".format(*size_px), "--quadrature", "61 bands", "--seed", str(seed)]
            subprocess.run([str(word) for word in command], check=True, capture_output=True)
            bitmap = mi.Bitmap(str(out))
            pixels = np.array(bitmap)
            names = [field.name for field in bitmap.struct_()]
            ac1c2 = np.stack([pixels[..., names.index(name)] for name in ("A", "C1", "C2")], axis=-1)
            pictures.append(ac1c2 @ np.linalg.inv(AC1C2_FROM_XYZ).T)
    return np.stack(pictures)


def most(tests, freedom):
    """The largest |t| that chance allows: Sidak's level and Hill's (1970) expansion of Student's quantile."""
    z = -NormalDist().inv_cdf(0.5 * (1 - (1 - 0.001) ** (1 / tests)))
    n = freedom
    terms = [
        z,
        (z**3 + z) / 4 / n,
        (5 * z**5 + 16 * z**3 + 3 * z) / 96 / n**2,
        (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384 / n**3,
        (79 * z**9 + 776 * z**7 + 1482 * z**5 - 1920 * z**3 - 945 * z) / 92160 / n**4,
    ]
    return sum(terms)


def contrast(image):
    """From the least to the largest value in each pixel and its neighbours."""
    padded = np.pad(image, ((1, 1), (1, 1), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (3, 3), axis=(0, 1))
    return windows.max(axis=(-1, -2)) - windows.min(axis=(-1, -2))


def blocks(image):
    height, width = (size // BLOCK_PX * BLOCK_PX for size in image.shape[:2])
    cut = image[:height, :width].reshape(height // BLOCK_PX, BLOCK_PX, width // BLOCK_PX, BLOCK_PX, 3)
    return cut.mean(axis=(1, 3))


def z_scores(ours, theirs):
    """The differences in standard errors, for pixels and for blocks; the allowances are those of judge.rs."""
    (our_mean, our_error), (their_mean, their_error) = mean_and_error(ours), mean_and_error(theirs)
    missed = np.maximum(contrast(our_mean), contrast(their_mean)) / (RAYS_A_PIXEL * len(ours))
    variance = our_error**2 + their_error**2 + missed**2

    def score(ours, theirs, variance):
        return (ours - theirs) / np.sqrt(variance + (5e-4 * np.abs(theirs) + 1e-5) ** 2)

    pixels = score(our_mean, their_mean, variance)
    of_blocks = SHARED * blocks(variance) / BLOCK_PX**2
    return pixels, score(blocks(our_mean), blocks(their_mean), of_blocks)


def write_error_image(path, ours, theirs, scores):
    def shown(xyz):
        bitmap = mi.Bitmap(np.ascontiguousarray(xyz, dtype=np.float32), mi.Bitmap.PixelFormat.XYZ)
        return np.array(bitmap.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, True))

    strength = np.clip(scores[..., 1] / 8, -1, 1)
    map_of_errors = np.ones((*strength.shape, 3))
    map_of_errors[..., 1] -= np.abs(strength)
    map_of_errors[..., 2] -= np.clip(strength, 0, 1)
    map_of_errors[..., 0] -= np.clip(-strength, 0, 1)
    parts = [shown(ours), shown(theirs), (255 * map_of_errors).astype(np.uint8)]
    large = np.kron(np.concatenate(parts, axis=1), np.ones((6, 6, 1), np.uint8))
    mi.Bitmap(np.ascontiguousarray(large)).write(str(path))


def compare(scene_file, arguments):
    size_px, seeds = (arguments.size, arguments.size), range(1, arguments.seeds + 1)
    ours = acuity_renders(arguments.acuity, scene_file, size_px, seeds)
    theirs = renders(scene_file, size_px, arguments.samples, seeds)
    pixels, of_blocks = z_scores(ours, theirs)
    limits = [most(scores.size, arguments.seeds - 1) for scores in (pixels, of_blocks)]
    worst = [np.abs(scores).max() for scores in (pixels, of_blocks)]
    is_same = all(found < limit for found, limit in zip(worst, limits))
    print(
        f"{scene_file.name}: {'same' if is_same else 'DIFFERENT'}; worst pixel {worst[0]:.1f} of {limits[0]:.1f} "
        f"errors, worst block {worst[1]:.1f} of {limits[1]:.1f}; median error of Y "
        f"{np.median(mean_and_error(theirs)[1][..., 1]):.5f}"
    )
    if not is_same:
        path = Path(f"{scene_file.stem}-errors.png")
        write_error_image(path, ours.mean(axis=0), theirs.mean(axis=0), pixels)
        print(f"see {path}")
    return is_same


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", type=Path, default=sorted((HERE / "scenes").glob("*.toml")))
    parser.add_argument("--acuity", type=Path, default=HERE.parents[2] / "target/release/acuity")
    parser.add_argument("--size", type=int, default=48)
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=16)
    arguments = parser.parse_args()
    results = [compare(scene_file, arguments) for scene_file in arguments.scenes]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()

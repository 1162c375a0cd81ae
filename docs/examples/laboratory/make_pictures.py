"""Makes the pictures of this example and their table (Python 3, numpy, pillow).

    acuity image ../../../stimuli/scenes/toy-village.toml --size 128x96 --rays-a 200K -o village.png
    acuity image ../../../stimuli/scenes/still-life.toml --size 128x96 --rays-a 200K -o still.png
    python make_pictures.py village.png still.png

Either the luma or both chroma channels of a picture are blurred by a Gaussian; the other is left exact.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from PIL import Image

BLURS_PX = [1, 2, 4]  # standard deviations

# ITU-T T.871 (JFIF): Y, Cb - 128, Cr - 128 from RGB.
YCC = np.array([[0.299, 0.587, 0.114], [-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]])


def blurred(channel, sd_px):
    reach = 4 * sd_px
    kernel = np.exp(-(np.arange(-reach, reach + 1) ** 2) / (2 * sd_px**2))
    kernel /= kernel.sum()
    for axis in range(2):
        wider = np.pad(channel, [(reach, reach) if axis == a else (0, 0) for a in range(2)], mode="edge")
        channel = np.apply_along_axis(np.convolve, axis, wider, kernel, "valid")
    return channel


def save(rgb, name):
    Image.fromarray(np.clip(np.round(rgb), 0, 255).astype(np.uint8)).save(f"pictures/{name}", optimize=True)


lines = []
for path in sys.argv[1:]:
    scene = Path(path).stem
    rgb = np.asarray(Image.open(path).convert("RGB")).astype(float)
    original = f"{scene}-original.png"
    save(rgb, original)
    lines.append([original, "", "", "", ""])
    for varied, places in [("luma", [0]), ("chroma", [1, 2])]:
        for sd_px in BLURS_PX:
            ycc = rgb @ YCC.T
            for place in places:
                ycc[..., place] = blurred(ycc[..., place], sd_px)
            name = f"{scene}-{varied}-{sd_px}.png"
            save(ycc @ np.linalg.inv(YCC).T, name)
            lines.append([name, original, scene, varied, sd_px])
with open("pictures/factors.csv", "w", newline="") as file:
    table = csv.writer(file, lineterminator="\n")
    table.writerow(["image", "reference", "scene", "blurred", "blur_px"])
    table.writerows(lines)

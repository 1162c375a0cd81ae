"""Makes the pictures of this example and their table (Python 3, numpy, pillow).

    acuity image ../../../stimuli/scenes/opponent-solids.toml --rays-a 400K --rays-c1c2 400K -o whole.png
    python make_pictures.py whole.png

Two details of the picture are coded like JPEG does it: YCbCr, 8 x 8 blocks, DCT, coefficients rounded to
multiples of a step. The step is applied either to luma or to both chroma channels; the other is left exact.
"""

import csv
import sys

import numpy as np
from PIL import Image

DETAILS = {"sphere": (4, 110), "rods": (208, 95)}  # left and top corner
WIDTH, HEIGHT = 96, 80
STEPS = [20, 40, 80, 160]

# ITU-T T.871 (JFIF): Y, Cb - 128, Cr - 128 from RGB.
YCC = np.array([[0.299, 0.587, 0.114], [-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]])
# The orthonormal DCT-II of 8 points.
K = np.arange(8)
DCT = np.cos(np.pi * (2 * K[None, :] + 1) * K[:, None] / 16) * np.where(K == 0, 8**-0.5, 0.5)[:, None]


def quantised(channel, step):
    blocks = channel.reshape(HEIGHT // 8, 8, WIDTH // 8, 8).transpose(0, 2, 1, 3)
    coefficients = DCT @ blocks @ DCT.T
    blocks = DCT.T @ (step * np.round(coefficients / step)) @ DCT
    return blocks.transpose(0, 2, 1, 3).reshape(HEIGHT, WIDTH)


def save(rgb, name):
    Image.fromarray(np.clip(np.round(rgb), 0, 255).astype(np.uint8)).save(f"pictures/{name}", optimize=True)


whole = np.asarray(Image.open(sys.argv[1]).convert("RGB")).astype(float)
lines = []
for detail, (left, top) in DETAILS.items():
    rgb = whole[top : top + HEIGHT, left : left + WIDTH]
    original = f"{detail}-original.png"
    save(rgb, original)
    lines.append([original, "", "", "", ""])
    for varied, places in [("luma", [0]), ("chroma", [1, 2])]:
        for step in STEPS:
            ycc = rgb @ YCC.T
            for place in places:
                ycc[..., place] = quantised(ycc[..., place], step)
            name = f"{detail}-{varied}-{step:03}.png"
            save(ycc @ np.linalg.inv(YCC).T, name)
            lines.append([name, original, detail, varied, step])
with open("pictures/factors.csv", "w", newline="") as file:
    table = csv.writer(file, lineterminator="\n")
    table.writerow(["image", "reference", "detail", "quantised", "step"])
    table.writerows(lines)

"""S-CIELAB of two small images: the functions separableFilters, gauss, separableConv, pad4conv, changeColorSpace and
scielab of Zhang and Wandell's MATLAB program (1996), transcribed for numpy. Prints what src/scielab.rs is compared with.

One thing is added: each Gaussian sums to its weight after it is read at the pixels, as in src/scielab.rs."""

import numpy as np

OPP = np.array([[278.7336, 721.8031, -106.5520], [-448.7736, 289.8056, 77.1569], [85.9513, -589.9859, 501.1089]]) / 1000
RGB = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
X = [[0.05, 1.00327, 0.225, 0.114416, 7.0, -0.117686], [0.0685, 0.616725, 0.826, 0.383275], [0.0920, 0.567885, 0.6451, 0.432115]]


def gauss(half_width, width):
    alpha = 2 * np.sqrt(np.log(2)) / (half_width - 1)
    x = np.arange(1, width + 1) - np.floor(width / 2 + 0.5)
    g = np.exp(-alpha * alpha * x * x)
    return g / g.sum()


def separable_filters(spd):
    up = int(np.ceil(224 / spd)) if spd < 224 else 1
    spd *= up
    width = int(np.ceil(spd / 2)) * 2 - 1
    filters = []
    for x in X:
        rows = [(gauss(h * spd, width) * np.sqrt(abs(w)) * np.sign(w)) for h, w in zip(x[::2], x[1::2])]
        if up > 1:
            col = np.concatenate([np.arange(1, up + 1), np.arange(up - 1, 0, -1)]) / up
            rows = [np.convolve(row, col, "full")[up - 1: up - 1 + width] for row in rows]
            mid = (width + 1) // 2 - 1
            places = list(range(mid, -1, -up))[::-1] + list(range(mid + up, width, up))
            rows = [row[places] for row in rows]
            # Not in the program, whose filters sum to .995 to 1.007 here, so that grey would change.
            rows = [row / abs(row.sum()) * np.sqrt(abs(w)) for row, w in zip(rows, x[1::2])]
        filters.append(rows)
    return filters


def conv(plane, kernel, axis):
    n = plane.shape[axis]
    h = n // 2 if len(kernel) >= n else len(kernel) // 2
    pad = [(0, 0), (0, 0)]
    pad[axis] = (h, h)
    padded = np.pad(plane, pad, mode="symmetric")
    full = np.apply_along_axis(lambda row: np.convolve(row, kernel), axis, padded)
    start = (full.shape[axis] - n) // 2
    return np.take(full, range(start, start + n), axis)


def scielab_lab(rgb, spd):
    c = rgb / 255.0
    linear = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    opp = linear @ RGB.T @ OPP.T
    for channel, rows in enumerate(separable_filters(spd)):
        opp[..., channel] = sum(conv(conv(opp[..., channel], k, 1), abs(k), 0) for k in rows)
    xyz = opp @ np.linalg.inv(OPP).T / RGB.sum(1)
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])], -1)


y, x = np.mgrid[0:80, 0:96]
checks = np.where((x // 4 + y // 4) % 2 == 0, 12, 0)
reference = np.stack([7 * x + 3 * y, 5 * x * y, 200 + 11 * y], -1) % 256
test = np.stack([7 * x + 3 * y + checks, 5 * x * y, 200 + 11 * y + checks], -1) % 256
for spd in (52.6, 70.0):
    de = np.linalg.norm(scielab_lab(reference.astype(float), spd) - scielab_lab(test.astype(float), spd), axis=-1)
    print(spd, repr(float(de.mean())))

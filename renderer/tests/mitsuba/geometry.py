"""Vectors, frames and fans of triangles for the export: as in `renderer/src/geometry`."""

import math
import struct
from collections import namedtuple

FAN_TRIANGLES = 2048


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def difference(a, b):
    return tuple(x - y for x, y in zip(a, b))


def scaled(a, factor):
    return tuple(x * factor for x in a)


def length(a):
    return math.sqrt(sum(x * x for x in a))


def unit(a):
    return scaled(a, 1 / length(a))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


class Frame(namedtuple("Frame", "axis across along")):
    """An axis with two directions across it, `renderer/src/geometry/frame.rs`."""

    @classmethod
    def about(cls, axis):
        helper = (0, 0, 1) if abs(axis[2]) < 0.9 else (0, 1, 0)
        across = unit(cross(helper, axis))
        return cls(axis, across, cross(axis, across))


def matrix(rows):
    """Sixteen numbers, row by row, as an element."""
    return '<matrix value="{}"/>'.format(" ".join(f"{value:.9g}" for value in rows))


def fan(file, apex, rim):
    """Writes a fan of triangles as binary PLY: a cone's side or a disc, with surface coordinates.

    `apex` is a place and a function from the angle to its surface coordinates; `rim` is the middle, frame and
    radius of a circle, and such a function. Every triangle has corners of its own.
    """
    (tip, tip_coordinates), (center, frame, radius, rim_coordinates) = apex, rim
    corners, faces = [], []
    for triangle in range(FAN_TRIANGLES):
        angles = [2 * math.pi * (triangle + step) / FAN_TRIANGLES - math.pi for step in (0, 1)]
        faces.append(struct.pack("<B3i", 3, 3 * triangle, 3 * triangle + 1, 3 * triangle + 2))
        for angle in angles:
            aside = add(scaled(frame.across, math.cos(angle)), scaled(frame.along, math.sin(angle)))
            corners.append((*add(center, scaled(aside, radius)), *rim_coordinates(angle)))
        corners.append((*tip, *tip_coordinates(sum(angles) / 2)))
    properties = "".join(f"property float {name}\n" for name in "xyzuv")
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(corners)}\n{properties}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    packed = b"".join(struct.pack("<5f", *corner) for corner in corners)
    file.write_bytes(header.encode() + packed + b"".join(faces))

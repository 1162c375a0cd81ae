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


def ring(steps):
    """The pairs of neighbouring angles round a circle, from -pi."""
    angles = [2 * math.pi * step / steps - math.pi for step in range(steps + 1)]
    return zip(angles, angles[1:])


def on_circle(center, frame, radius, angle):
    aside = add(scaled(frame.across, math.cos(angle)), scaled(frame.along, math.sin(angle)))
    return add(center, scaled(aside, radius))


def fan(apex, rim):
    """The corners of a fan of triangles: a cone's side or a disc, with surface coordinates.

    `apex` is a place and a function from the angle to its surface coordinates; `rim` is the middle, frame and
    radius of a circle, and such a function. Every triangle has corners of its own.
    """
    (tip, tip_coordinates), (center, frame, radius, rim_coordinates) = apex, rim
    for angles in ring(FAN_TRIANGLES):
        for angle in angles:
            yield (*on_circle(center, frame, radius, angle), *rim_coordinates(angle))
        yield (*tip, *tip_coordinates(sum(angles) / 2))


def tube(base, top, frame, radius):
    """The corners of the triangles of a cylinder's side, with surface coordinates."""
    height = length(difference(top, base))
    for left, right in ring(FAN_TRIANGLES // 4):
        low = [(*on_circle(base, frame, radius, angle), radius * angle, 0.0) for angle in (left, right)]
        high = [(*on_circle(top, frame, radius, angle), radius * angle, height) for angle in (left, right)]
        yield from (low[0], low[1], high[1], low[0], high[1], high[0])


def write_triangles(file, corners):
    """Writes triangles of three corners each, with surface coordinates, as binary PLY."""
    corners = list(corners)
    faces = [struct.pack("<B3i", 3, first, first + 1, first + 2) for first in range(0, len(corners), 3)]
    properties = "".join(f"property float {name}\n" for name in "xyzuv")
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(corners)}\n{properties}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    packed = b"".join(struct.pack("<5f", *corner) for corner in corners)
    file.write_bytes(header.encode() + packed + b"".join(faces))

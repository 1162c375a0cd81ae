#!/usr/bin/env python3
"""Writes island.glb: a mountainous island with a painted texture. Needs nothing but Python 3.

Heights are five octaves of smoothed lattice noise under a dome that falls into the sea; the texture is sand, grass,
rock and snow by height and slope. The lattice is a hash, so that the file is the same on every machine.
"""
import json
import math
import pathlib
import struct
import zlib

SIDE = 100  # vertices along each side
SIZE_M = 20.0
TEXTURE_PX = 320


def lattice(x, y):
    """A number from 0 to 1 for a whole place."""
    n = (x * 374761393 + y * 668265263 + 1013904223) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((n ^ (n >> 16)) & 0xFFFF) / 65535.0


def noise(x, y):
    """Lattice noise with smooth steps between."""
    i, j = math.floor(x), math.floor(y)
    u, v = x - i, y - j
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    low = lattice(i, j) * (1 - u) + lattice(i + 1, j) * u
    high = lattice(i, j + 1) * (1 - u) + lattice(i + 1, j + 1) * u
    return low * (1 - v) + high * v


def height(x, y):
    """Metres above the sea at a place of the square from 0 to 1; y is to the back."""
    px, py = 4.6 * x, 4.6 * y
    ridges, size, total = 0.0, 1.0, 0.0
    for octave in range(5):
        n = noise(px * 2**octave + 17.3 * octave, py * 2**octave + 5.1 * octave)
        ridges += size * (1 - abs(2 * n - 1))
        total += size
        size *= 0.5
    d = math.sqrt(((x - 0.47) / 0.50) ** 2 + ((y - 0.55) / 0.46) ** 2)
    dome = max(0.0, 1 - d * d)
    return 5.6 * dome**1.25 * (ridges / total) ** 1.7 - 0.9 * d * d + 0.30 * dome


def colour(x, y):
    """Encoded sRGB at a place."""
    e = 1.0 / SIDE
    h = height(x, y)
    slope = math.hypot(height(x + e, y) - h, height(x, y + e) - h) / (e * SIZE_M)
    n = noise(61 * x, 61 * y) - 0.5
    m = noise(19 * x + 3, 19 * y) - 0.5
    sand, grass = (222, 200, 148), (104 + 70 * m, 148 + 40 * m, 62)
    rock, snow = (150 + 30 * m, 128 + 24 * m, 112 + 20 * m), (244, 246, 250)

    def step(low, high, value):
        t = min(1.0, max(0.0, (value - low) / (high - low)))
        return t * t * (3 - 2 * t)

    def mix(a, b, t):
        return tuple(p + (q - p) * t for p, q in zip(a, b))

    c = mix(sand, grass, step(0.10, 0.24, h + 0.12 * n))
    c = mix(c, rock, max(step(0.85, 1.25, slope + 0.5 * n), step(1.7, 2.3, h + 0.8 * n)))
    c = mix(c, snow, step(2.3, 2.7, h + 0.8 * n) * (1 - 0.7 * step(1.3, 2.0, slope)))
    shade = 1 + 0.16 * n
    return bytes(int(min(255, max(0, v * shade))) for v in c)


def png():
    rows = b""
    for row in range(TEXTURE_PX):
        y = 1 - (row + 0.5) / TEXTURE_PX
        rows += b"\0" + b"".join(colour((i + 0.5) / TEXTURE_PX, y) for i in range(TEXTURE_PX))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", TEXTURE_PX, TEXTURE_PX, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def main():
    last = SIDE - 1
    places = [(i / last, j / last) for j in range(SIDE) for i in range(SIDE)]
    positions, normals, points = b"", b"", b""
    low, high = [math.inf] * 3, [-math.inf] * 3
    for x, y in places:
        # glTF: y is up, the back is -z.
        p = ((x - 0.5) * SIZE_M, height(x, y), (0.5 - y) * SIZE_M)
        e = 0.5 / last
        dx = (height(x + e, y) - height(x - e, y)) / (2 * e * SIZE_M)
        dy = (height(x, y + e) - height(x, y - e)) / (2 * e * SIZE_M)
        r = math.sqrt(dx * dx + dy * dy + 1)
        positions += struct.pack("<3f", *p)
        normals += struct.pack("<3f", -dx / r, 1 / r, dy / r)
        points += struct.pack("<2f", x, 1 - y)
        low, high = [min(a, b) for a, b in zip(low, p)], [max(a, b) for a, b in zip(high, p)]
    faces = []
    for j in range(last):
        for i in range(last):
            a = j * SIDE + i
            faces += [a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE]
    parts = [positions, normals, points, struct.pack(f"<{len(faces)}H", *faces), png()]
    views, blob = [], b""
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(part)})
        blob += part + b"\0" * (-len(part) % 4)
    count = len(places)
    root = {
        "asset": {"version": "2.0", "generator": "island.py"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "island", "mesh": 0}],
        "meshes": [{"name": "island", "primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
        "materials": [{"name": "ground", "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 1}}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 33071, "wrapT": 33071}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": low, "max": high},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": count, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": len(faces), "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": len(blob)}],
    }
    text = json.dumps(root, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(blob)
    out = struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
    out += struct.pack("<I4s", len(blob), b"BIN\0") + blob
    pathlib.Path(__file__).with_name("island.glb").write_bytes(out)


main()

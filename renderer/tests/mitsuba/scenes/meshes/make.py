"""Makes the meshes beside it: `ring.ply`, a torus with smooth normals, and `gem.obj`, an icosahedron of flat faces."""

import math
import struct
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROUND, ACROSS = 48, 24


def ring():
    vertices, faces = [], []
    for i in range(ROUND):
        for j in range(ACROSS):
            a, b = 2 * math.pi * i / ROUND, 2 * math.pi * j / ACROSS
            normal = (math.cos(a) * math.cos(b), math.sin(a) * math.cos(b), math.sin(b))
            middle = (math.cos(a), math.sin(a), 0)
            vertices.append([m + 0.35 * n for m, n in zip(middle, normal)] + list(normal))
            corner = [(i + p) % ROUND * ACROSS + (j + q) % ACROSS for p, q in ((0, 0), (1, 0), (1, 1), (0, 1))]
            faces += [(corner[0], corner[1], corner[2]), (corner[0], corner[2], corner[3])]
    properties = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{properties}"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    body = b"".join(struct.pack("<6f", *vertex) for vertex in vertices)
    body += b"".join(struct.pack("<B3i", 3, *face) for face in faces)
    (HERE / "ring.ply").write_bytes(header.encode() + body)


def gem():
    golden = (1 + math.sqrt(5)) / 2
    signs = [(s, t) for s in (-1, 1) for t in (-1, 1)]
    vertices = [(0, s, t * golden) for s, t in signs]
    vertices += [(s, t * golden, 0) for s, t in signs] + [(t * golden, 0, s) for s, t in signs]

    def is_face(corners):
        pairs = ((0, 1), (1, 2), (0, 2))
        return all(abs(math.dist(vertices[corners[i]], vertices[corners[j]]) - 2) < 1e-9 for i, j in pairs)

    triples = [(i, j, k) for i in range(12) for j in range(i) for k in range(j)]
    lines = ["v {:.6f} {:.6f} {:.6f}".format(*vertex) for vertex in vertices]
    for i, j, k in filter(is_face, triples):
        a, b, c = (vertices[place] for place in (i, j, k))
        u, v = [[q - p for p, q in zip(a, other)] for other in (b, c)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        outwards = sum(p * q for p, q in zip(normal, a)) > 0
        lines.append("f {} {} {}".format(*[place + 1 for place in ((i, j, k) if outwards else (i, k, j))]))
    (HERE / "gem.obj").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    ring()
    gem()

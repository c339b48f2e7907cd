"""Meshes for the tests, as numpy arrays."""

import numpy as np


def grid(columns=12, rows=10, height=0.25):
    """Wavy sheet of triangles."""
    x, y = np.meshgrid(np.arange(columns + 1) / columns, np.arange(rows + 1) / rows)
    z = height * np.sin(4 * x) * np.cos(5 * y)
    vertices = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + columns + 2, corner + columns + 1])
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return vertices, triangles, quads


def cube():
    """Closed cube of quads."""
    vertices = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    faces = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    return vertices, faces


def ball(around=24, rows=12):
    """Closed ball of triangles."""
    latitude = np.pi * np.arange(1, rows) / rows
    longitude = 2 * np.pi * np.arange(around) / around
    x = np.sin(latitude)[:, None] * np.cos(longitude)
    y = np.sin(latitude)[:, None] * np.sin(longitude)
    z = np.repeat(np.cos(latitude)[:, None], around, axis=1)
    vertices = np.concatenate([[[0, 0, 1]], np.stack([x, y, z], -1).reshape(-1, 3), [[0, 0, -1]]])
    ring = np.arange(around)
    following = (ring + 1) % around
    faces = [np.column_stack([np.zeros_like(ring), 1 + ring, 1 + following])]
    for row in range(rows - 2):
        a, b = 1 + row * around, 1 + (row + 1) * around
        faces.append(np.column_stack([a + ring, b + ring, b + following]))
        faces.append(np.column_stack([a + ring, b + following, a + following]))
    last = 1 + (rows - 2) * around
    faces.append(np.column_stack([last + ring, np.full_like(ring, len(vertices) - 1), last + following]))
    return vertices, np.concatenate(faces)


def write_obj(path, vertices, faces):
    """Writes an OBJ file."""
    lines = ["v {!r} {!r} {!r}".format(*map(float, vertex)) for vertex in vertices]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


def areas(vertices, faces):
    """Signed areas of triangles in the plane."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2

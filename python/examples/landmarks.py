"""Pins landmarks of a mesh to a picture, and measures the distortion of each face: python landmarks.py"""

import numpy as np

import freebound

# A wavy sheet of 20 by 20 squares.
x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 21), np.linspace(0, 1, 21)))
vertices = np.column_stack([x, y, 0.2 * np.sin(5 * x) * np.cos(4 * y)])
first = (np.arange(20)[:, None] * 21 + np.arange(20)).ravel()
faces = np.concatenate([np.column_stack([first, first + 1, first + 22]), np.column_stack([first, first + 22, first + 21])])

landmarks = {0: (0.1, 0.1), 20: (0.9, 0.05), 220: (0.55, 0.45), 420: (0.12, 0.9), 440: (0.95, 0.95)}
layout = freebound.flatten(vertices, faces, pins=landmarks)
assert layout.verdict and all((layout.uv[vertex] == place).all() for vertex, place in landmarks.items())

squares = layout.singular_values**2
energy = (squares + 1 / squares).sum(axis=1)
print(f"worst face {energy.argmax()}: energy {energy.max():.3f}; mean {layout.energy:.3f}")
reported = layout.report["distortion"]["symmetric_dirichlet"]["mean"]
assert abs(layout.energy / reported - 1) < 1e-12

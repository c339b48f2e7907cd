"""Unwraps a surface that pyvista has read, and stores distortion for its plots: python surfaces_with_pyvista.py IN OUT.vtp"""

import sys

import pyvista

import freebound

surface = pyvista.read(sys.argv[1]).extract_surface(algorithm="dataset_surface").triangulate()
layout = freebound.unwrap(surface.points, surface.regular_faces)
print(layout.verdict.summary, f"energy {layout.energy:.3f}")

# A vertex on a seam has several texture coordinates, and pyvista has one for each point.
unwrapped = pyvista.PolyData.from_regular_faces(layout.vertices[layout.source], layout.faces)
unwrapped.active_texture_coordinates = layout.uv
unwrapped.cell_data["chart"] = layout.chart
unwrapped.cell_data["energy"] = layout.triangle_energy
unwrapped.save(sys.argv[2])
# To look at it: unwrapped.plot(scalars="energy", texture=pyvista.read_texture("checker.png"))

"""Unwraps a model that trimesh has read, and keeps its material: python materials_with_trimesh.py IN.glb OUT.glb"""

import sys

import trimesh

import freebound

mesh = trimesh.load(sys.argv[1], force="mesh", process=False)
layout = freebound.unwrap(mesh.vertices, mesh.faces, distortion=4.1, pack=freebound.Pack(size=1024, gap=4))
print(layout.verdict.summary, f"energy {layout.energy:.3f}")

# A vertex on a seam has several texture coordinates, and glTF has one for each vertex.
unwrapped = trimesh.Trimesh(
    vertices=layout.vertices[layout.source],
    faces=layout.faces,
    visual=trimesh.visual.TextureVisuals(uv=layout.uv, material=mesh.visual.material),
    process=False,
)
unwrapped.export(sys.argv[2])

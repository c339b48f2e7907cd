"""Drawing of layouts."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import OptionError
from ._layout import Layout


def plot(layout: Layout, axes: Any = None, *, colour: str | None = "energy", edges: bool = True) -> Any:
    """Draws a layout with matplotlib, and returns the axes. Flipped faces are red.

    Args:
        layout: the layout.
        axes: axes to draw into. Default: new ones.
        colour: "energy" for the distortion of each face, "chart" for its chart, or None.
        edges: True if edges are drawn.
    """
    try:
        from matplotlib import pyplot
        from matplotlib.collections import PolyCollection
    except ImportError as error:
        raise OptionError("plot needs matplotlib: pip install freebound[plot]") from error
    if colour not in ("energy", "chart", None):
        raise OptionError("colour: choose one of energy, chart, None")
    if axes is None:
        _, axes = pyplot.subplots(figsize=(6, 6), layout="constrained")
    drawn = np.flatnonzero(layout.chart >= 0)
    faces = layout.faces
    corner_uv = layout.corner_uv
    if isinstance(faces, tuple):
        starts = faces[1]
    else:
        starts = np.arange(0, faces.size + 1, faces.shape[1])
    polygons = PolyCollection(
        [corner_uv[starts[face] : starts[face + 1]] for face in drawn],
        edgecolors="#0006" if edges else "none",
        linewidths=0.3,
        facecolors="#d8dfe8",
    )
    if colour == "chart":
        polygons.set_array(layout.chart[drawn] % 20)
        polygons.set_cmap("tab20")
    elif colour == "energy":
        squares = np.maximum(layout.singular_values, 1e-150) ** 2
        energy = (squares + 1 / squares).sum(axis=1)
        worst = np.full(len(layout.chart), 4.0)
        np.fmax.at(worst, layout.triangle_face, energy)
        shown = np.clip(worst[drawn], 4, 10)
        polygons.set_array(shown)
        # Faces without distortion have the lowest colour.
        polygons.set_clim(4, max(4.2, shown.max(initial=4)))
        polygons.set_cmap("cividis")
        axes.figure.colorbar(polygons, ax=axes, label="symmetric Dirichlet energy (4 is isometric)", shrink=0.8)
    axes.add_collection(polygons)
    flipped = set(layout.verdict.flipped_faces)
    if flipped:
        faces_flipped = [face for face in drawn if layout.face_of[face] in flipped]
        shapes = [corner_uv[starts[face] : starts[face + 1]] for face in faces_flipped]
        axes.add_collection(PolyCollection(shapes, facecolors="#d62728", edgecolors="#d62728"))
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_xlabel("u")
    axes.set_ylabel("v")
    return axes

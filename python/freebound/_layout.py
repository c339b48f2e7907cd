"""Finished layouts."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from . import _arrays
from ._check import check
from ._errors import NotProved


@dataclass(frozen=True)
class Verdict:
    """Exact verdict on a layout. Faces have their numbers in the input."""

    planar: bool
    """True if the layout is one-to-one: no face is flipped, and no two faces overlap."""
    planar_in_f32: bool
    """True if it stays one-to-one with all coordinates rounded to 32 bits."""
    flipped_faces: tuple[int, ...]
    """Flipped faces."""
    overlapping_faces: tuple[tuple[int, int], ...]
    """Pairs of overlapping faces of different charts."""
    boundary_crossings: int
    """Number of places at which the boundary of a chart crosses itself."""
    unmet_pins: tuple[int, ...]
    """Vertices with hard pins that are not at their targets."""
    summary: str
    """Sentence on the verdict."""

    def __bool__(self) -> bool:
        return self.planar and not self.unmet_pins


class Layout:
    """Texture coordinates of a mesh, with their proof.

    Arrays are read-only. Faces and vertices keep the numbers of the input. New vertices come after all others; a face
    that they split is replaced by its parts, in place. Corners of faces that are not flattened have the index −1 in
    ``faces``, and NaN in ``corner_uv``.
    """

    def __init__(self, native: Any) -> None:
        self._native = native

    @cached_property
    def vertices(self) -> np.ndarray:
        """Positions in space, with those of the new vertices at the end, shape (n, 3)."""
        return self._native.vertices

    @cached_property
    def uv(self) -> np.ndarray:
        """Texture coordinates, v up, shape (k, 2). A vertex on a seam has several."""
        return self._native.uv

    @cached_property
    def faces(self) -> np.ndarray | tuple[np.ndarray, np.ndarray]:
        """Faces by rows of ``uv``: shape (m, 3) or (m, 4), or (indices, offsets) if their sizes differ."""
        return _arrays.faces_of(self._native.corners, self._native.starts)

    @cached_property
    def vertex_faces(self) -> np.ndarray | tuple[np.ndarray, np.ndarray]:
        """Faces by rows of ``vertices``, in the form of ``faces``."""
        return _arrays.faces_of(self._native.vertex_corners, self._native.starts)

    @cached_property
    def source(self) -> np.ndarray:
        """Row of ``vertices`` for each row of ``uv``, shape (k,); −1 if no face uses the coordinate."""
        return self._native.source

    @cached_property
    def corner_uv(self) -> np.ndarray:
        """Texture coordinates of the corners, in the order of the faces, shape (c, 2)."""
        return self._native.corner_uv

    @cached_property
    def face_of(self) -> np.ndarray:
        """Face of the input that each face is, or is a part of, shape (m,)."""
        return self._native.face_of

    @cached_property
    def new_vertex_edges(self) -> np.ndarray:
        """Edge of the input that each new vertex lies on, by its two vertices, shape (j, 2)."""
        return self._native.new_vertex_edges

    @cached_property
    def new_vertex_at(self) -> np.ndarray:
        """Place of each new vertex on its edge: 0 at the first end, 1 at the second, shape (j,)."""
        return self._native.new_vertex_at

    @cached_property
    def chart(self) -> np.ndarray:
        """Chart of each face, shape (m,); −1 for faces that are not flattened."""
        return self._native.chart

    @cached_property
    def cut_edges(self) -> np.ndarray:
        """Inner edges whose two sides have different coordinates, by rows of ``vertices``, shape (e, 2)."""
        return self._native.cut_edges

    @cached_property
    def triangle_face(self) -> np.ndarray:
        """Face of each triangle of ``singular_values``, shape (t,). A triangle mesh has one triangle for each face."""
        return self._native.triangle_face

    @cached_property
    def singular_values(self) -> np.ndarray:
        """Singular values of the map of each triangle, the greater first, shape (t, 2).

        They are at the scale at which the chart has the area of its surface, as in the report. NaN for faces that are
        not flattened, and for triangles that the map collapses.
        """
        return self._native.singular_values

    @cached_property
    def triangle_area(self) -> np.ndarray:
        """Area of each triangle of ``singular_values`` in space, shape (t,); 0 for faces that are not flattened."""
        return self._native.triangle_area

    @cached_property
    def triangle_energy(self) -> np.ndarray:
        """Symmetric Dirichlet energy of each triangle, shape (t,); 4 is isometric. NaN for faces that are not flattened."""
        return self._native.triangle_energy

    @cached_property
    def report(self) -> dict[str, Any]:
        """Report of the run, as the program writes it. Infinite numbers are None."""
        return self._native.report

    @property
    def steps(self) -> list[dict[str, Any]]:
        """Steps of the solver. With several charts the report has those of each chart."""
        return self.report["steps"]

    @cached_property
    def verdict(self) -> Verdict:
        """Exact verdict."""
        report = self.report
        whole = report.get("atlas") or report["verdict"]
        charts = whole.get("charts", [whole])
        flipped = sorted({face for chart in charts for face in chart.get("flipped_faces", ())})
        return Verdict(
            planar=self._native.planar,
            planar_in_f32=bool(whole["f32"]),
            flipped_faces=tuple(flipped),
            overlapping_faces=tuple(tuple(pair) for pair in whole.get("overlapping_faces", ())),
            boundary_crossings=sum(len(chart.get("boundary_crossings", ())) for chart in charts),
            unmet_pins=tuple(self._native.unmet_pins),
            summary=self._native.summary,
        )

    @property
    def energy(self) -> float:
        """Mean symmetric Dirichlet energy of all triangles by their areas in space; 4 is an isometric map.

        NaN for a mesh without area.
        """
        used = self.triangle_area > 0
        if not used.any():
            return math.nan
        return float(np.average(self.triangle_energy[used], weights=self.triangle_area[used]))

    def check(self, **options: Any) -> dict[str, Any]:
        """Checks the layout like :func:`freebound.check`, which takes the same options.

        The findings name all faces at fault of a layout that is not one-to-one, such as that of a :class:`NotProved`.
        Faces and vertices are rows of :attr:`faces` and :attr:`vertices`.
        """
        return check(self.vertices, self.vertex_faces, self.corner_uv, **options)

    def save(self, path: str | os.PathLike[str], *, precision: str | None = None) -> list[str]:
        """Writes the mesh with its coordinates (.obj, .ply, .glb), a drawing (.svg, .png) or the report (.json).

        A mesh that came from a file keeps everything else of the file. Coordinates are rounded to the precision of the
        format and proved again.

        Raises:
            NotProved: the layout is planar, and rounding folds it. The file is written all the same.

        Args:
            path: file to write. Its extension names the format.
            precision: "f64" or "f32". Default: that of the run, or 64 bits for OBJ and 32 bits for PLY and GLB.

        Returns:
            The files written, ``path`` first.
        """
        files, planar, summary = self._native.write(os.fspath(path), precision)
        if self._native.planar and not planar:
            raise NotProved(f"{os.fspath(path)}: the rounded coordinates are not planar: {summary}", layout=self)
        return [os.fspath(file) for file in files]

    def __repr__(self) -> str:
        return f"<freebound.Layout: {len(self.chart)} faces, {self._native.summary}>"

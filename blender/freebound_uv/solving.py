# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the solver on gathered faces. Nothing here touches Blender, so that it can run in a thread."""

import math
from dataclasses import dataclass

import freebound
import numpy as np

#: Longer side of the picture for which charts are packed if the editor shows none, pixels.
_SIDE = 1024


@dataclass
class Sheet:
    """Picture that charts are packed into."""

    size: tuple | None
    """Width and height of the picture in the editor in pixels, or None."""
    margin: int
    """Least distance of charts, pixels."""

    @property
    def pack(self):
        """Packing of a given layout."""
        return freebound.Pack(size=self.size or _SIDE, gap=self.margin)

    @property
    def options(self):
        """Options of a run."""
        if self.size is None or self.size[0] == self.size[1]:
            return {"pack": self.pack}
        # The coordinates are stretched with the picture, whose size is given by its aspect.
        gap = math.ceil(self.margin * _SIDE / max(self.size))
        return {"aspect": self.size[0] / self.size[1], "pack": freebound.Pack(gap=gap)}


@dataclass
class Done:
    """Coordinates for the corners of the selected faces."""

    corner_uv: np.ndarray
    text: str
    """Verdict in words."""
    warning: str = ""
    seams: np.ndarray | None = None
    """Edges between charts, by vertices of the selection."""


def unwrap(task, selection, others, sheet, options, marks_seams):
    """Unwraps the selected faces. Faces of ``others`` stay, and the charts are packed around them."""
    job = freebound.start(
        selection.vertices,
        selection.faces(),
        unwrap=True,
        seams=selection.seams if len(selection.seams) else None,
        corner_pins=_pins(selection),
        new_vertices=False,
        precision="f32",
        **sheet.options,
        **options,
    )
    layout, warning = _solved(task, "Unwrapping", job)
    done = Done(layout.corner_uv, _proved(layout), warning, layout.cut_edges if marks_seams else None)
    is_single = layout.chart.max() == 0 and not selection.is_hard.any()
    if others is not None or is_single:
        task.enter("Packing")
        _settle(done, selection, others, sheet)
    return done


def relax(task, selection, others, sheet, rounds):
    """Lowers the distortion of the charts. Each stays where it is, unless it would overlap others."""
    refuse_bare(selection)
    aspect = {"aspect": sheet.options["aspect"]} if "aspect" in sheet.options else {}
    job = freebound.start(
        selection.vertices,
        selection.faces(),
        layout=selection.uv,
        charts="uv",
        corner_pins=_pins(selection),
        relax=rounds,
        new_vertices=False,
        precision="f32",
        **aspect,
    )
    layout, warning = _solved(task, "Relaxing", job)
    done = Done(layout.corner_uv, _proved(layout), warning)
    if others is not None:
        task.enter("Checking")
        vertices, faces, uv, _ = _joined(selection, done.corner_uv, others)
        if not freebound.check(vertices, faces, uv)["planar"]:
            if not freebound.check(others.vertices, others.faces(), others.uv)["planar"]:
                done.warning = done.warning or "Faces that are not selected overlap others"
            else:
                task.enter("Packing")
                _settle(done, selection, others, sheet)
    return done


def pack(task, selection, others, sheet, keeps_sizes):
    """Packs the charts of the selected faces, around pinned charts and faces that are not selected."""
    refuse_bare(selection)
    task.enter("Packing")
    done = Done(selection.uv, "")
    packed = _settle(done, selection, others, sheet, keeps_sizes)
    charts = counted(len(np.unique(packed.chart[: selection.face_count])))
    if packed.planar:
        done.text = f"{charts} packed, no overlaps: proved"
    else:
        done.text = f"{charts} packed"
        done.warning = "Faces overlap: Check selects them"
    return done


def _proved(layout):
    """Verdict on a proved layout in words."""
    return f"{counted(int(layout.chart.max()) + 1)}, no overlaps: proved; energy {layout.energy:.3f}"


def counted(charts):
    """Number of charts in words."""
    return f"{charts} chart{'s' if charts != 1 else ''}"


def _pins(selection):
    """Pins for the package, one for each pinned corner. Pins of vertices in the group are soft."""
    at = np.flatnonzero(selection.pinned)
    return (at, selection.uv[at], selection.weights[at]) if len(at) else None


def refuse_bare(selection):
    """Rejects corners without coordinates."""
    if np.isnan(selection.uv).any():
        raise freebound.InputError("corners have coordinates that are no numbers: unwrap the faces first")


def _solved(task, words, job):
    """Layout of a job, and a warning if it misses pins."""
    try:
        return task.run(words, job), ""
    except freebound.NotProved as error:
        if error.layout is None or not error.layout.verdict.planar_in_f32:
            raise
        return error.layout, sentence(error)


def sentence(error):
    """First line of an error, as a sentence."""
    text = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    return text[:1].upper() + text[1:]


def _joined(selection, corner_uv, others):
    """Mesh of the selected faces and the others, and its coordinates. Faces without coordinates are left out: the last
    pair has True for each corner that is in, and the numbers of the faces that are in."""
    parts = [(selection, corner_uv)] + ([(others, others.uv)] if others is not None else [])
    corners, sizes, uv, first = [], [], [], 0
    for part, coordinates in parts:
        corners.append(part.corners + first)
        sizes.append(np.diff(part.starts))
        uv.append(coordinates)
        first += len(part.vertices)
    corners, sizes, uv = (np.concatenate(arrays) for arrays in (corners, sizes, uv))
    is_known = np.isfinite(uv).all(axis=1)
    is_used = np.logical_and.reduceat(is_known, np.cumsum(sizes) - sizes)
    of_corner = np.repeat(is_used, sizes)
    starts = np.concatenate([[0], np.cumsum(sizes[is_used])])
    vertices = np.concatenate([part.vertices for part, _ in parts])
    return vertices, (corners[of_corner], starts), uv[of_corner], (of_corner, np.flatnonzero(is_used))


def _settle(done, selection, others, sheet, keeps_sizes=False):
    """Packs the selected charts around pinned ones and the others. Changes ``done``, and returns the packing."""
    vertices, faces, uv, (of_corner, used) = _joined(selection, done.corner_uv, others)
    count = selection.face_count
    is_locked = np.arange(count + (others.face_count if others is not None else 0)) >= count
    is_locked[selection.face_of[selection.is_hard]] = True
    packed = freebound.pack(
        vertices, faces, uv, pack=sheet.pack, lock=is_locked[used], keep_sizes=keeps_sizes, precision="f32"
    )
    corners = len(selection.uv)
    own = np.flatnonzero(of_corner[:corners])
    settled = np.array(done.corner_uv)
    settled[own] = packed.corner_uv[: len(own)]
    done.corner_uv = settled
    if not packed.planar and others is not None:
        done.warning = done.warning or "Faces that are not selected overlap, or leave no proof: Check selects them"
    elif others is not None:
        done.text += "; packed around the others"
    if len(own) and not is_locked[:count].all() and settled[own].max() > 1:
        done.warning = done.warning or "The others leave no room: the charts lie beside the picture"
    return packed

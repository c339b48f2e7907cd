# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the solver on gathered faces. Nothing here touches Blender, so that it can run in a thread."""

import math
from dataclasses import dataclass
from functools import partial

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
    """What was done, in words."""
    warning: str = ""
    seams: np.ndarray | None = None
    """Edges between charts, by vertices of the selection."""

    def warn(self, text):
        """Adds a sentence to the warning."""
        if text not in self.warning:
            self.warning = f"{self.warning}. {text}" if self.warning else text


def unwrap(task, selection, sheet, options, marks_seams):
    """Unwraps the selected faces. Charts with pins stay at their pins, and the others are packed around them."""
    job = freebound.start(
        selection.vertices,
        selection.faces(),
        unwrap=True,
        seams=selection.seams if len(selection.seams) else None,
        corner_pins=_pins(selection, selection.pinned),
        new_vertices=False,
        precision="f32",
        **sheet.options,
        **options,
    )
    layout, warning = _solved(task, "Unwrapping", job)
    if not layout.verdict.planar_in_f32:
        raise freebound.NotProved(warning, layout=layout)
    seams = layout.cut_edges if marks_seams else None
    done = Done(layout.corner_uv, counted(int(layout.chart.max()) + 1), warning, seams)
    is_single = layout.chart.max() == 0 and not selection.pinned.any()
    if not is_single and _around(selection) is None:
        done.text += f", {_proved(selection)}"
    else:
        is_free = ~selection.of_faces(selection.pinned)
        packed = _pack(task, selection, done, sheet, is_free)
        done.text += ", packed around the others" if _around(selection) is not None and is_free.any() else ""
        _tell_overlaps(task, selection, done, packed.planar)
    done.text += f"; energy {layout.energy:.3f}"
    return done


def relax(task, selection, sheet, rounds):
    """Lowers the distortion of the charts. Each stays where it is, unless it would come to lie over another."""
    refuse_bare(selection)
    aspect = {"aspect": sheet.options["aspect"]} if "aspect" in sheet.options else {}
    chart_of = _charts(task, selection)
    held = selection.pinned | selection.is_attached
    # A mirrored chart is relaxed in the mirror.
    side = np.where(is_mirrored(selection, chart_of), -1.0, 1.0)[:, None] * (1, 0) + (0, 1)
    job = freebound.start(
        selection.vertices,
        selection.faces(),
        layout=selection.uv * side,
        charts="uv",
        corner_pins=_pins(selection, held, selection.uv * side),
        lock=True,
        relax=rounds,
        new_vertices=False,
        precision="f32",
        **aspect,
    )
    layout, _ = _solved(task, "Relaxing", job)
    done = Done(np.array(layout.corner_uv) * side, "")
    done.corner_uv[held] = selection.uv[held]
    _keep_stacks(selection, chart_of, done.corner_uv)
    check = partial(task.call, "Checking", freebound.check)
    before = _overlaps(selection, selection.uv, check)
    after = _overlaps(selection, done.corner_uv, check)
    spoiled = np.isin(chart_of, chart_of[sorted(after.faces_at_fault - before.faces_at_fault)])
    if spoiled.any():
        of_corner = spoiled[selection.face_of]
        done.corner_uv[of_corner] = selection.uv[of_corner]
        after = _overlaps(selection, done.corner_uv, check)
    relaxed = len(np.unique(chart_of[~spoiled]))
    done.text = f"{counted(relaxed)} relaxed"
    moved = _colliding(selection, chart_of, before, after)
    planar = after.planar
    if moved:
        is_free = np.isin(chart_of, sorted(moved)) & ~selection.of_faces(held)
        planar = _pack(task, selection, done, sheet, is_free, keeps_sizes=True).planar
        done.text += f", {len(moved)} moved"
    _tell_overlaps(task, selection, done, planar)
    done.text += f"; energy {layout.energy:.3f}"
    if spoiled.any():
        done.warn(f"{counted(len(np.unique(chart_of[spoiled])))} left as before, because of pins or small faces")
    return done


def pack(task, selection, sheet, keeps_sizes):
    """Packs the charts of the selected faces. Charts with pins stay, and charts that are partly selected."""
    refuse_bare(selection)
    done = Done(selection.uv, "")
    is_held = selection.of_faces(selection.pinned | selection.is_attached)
    packed = _pack(task, selection, done, sheet, ~is_held, keeps_sizes)
    charts = packed.chart[: selection.face_count]
    held = np.unique(charts[is_held])
    done.text = f"{counted(len(np.setdiff1d(charts, held)))} packed"
    if len(held):
        done.text += f", {len(held)} stayed"
    _tell_overlaps(task, selection, done, packed.planar)
    return done


def _proved(selection):
    """Verdict on a layout of which every pair of faces was compared exactly."""
    ignores_others = selection.others is not None and not selection.is_around
    return "no overlaps of the selected: proved" if ignores_others else "no overlaps: proved"


#: Largest number of overlapping pairs of faces that are looked at.
LISTED = 1_000_000


@dataclass
class Overlaps:
    """What an exact check says about a layout. Faces that are not selected come after the selected ones."""

    planar: bool
    faces_at_fault: set
    """Selected faces that spoil a chart by themselves."""
    pairs: np.ndarray
    """Pairs of overlapping faces of different charts, shape (p, 2)."""
    is_at_fault: np.ndarray
    """True for each face that is at fault, or may be if there are too many to list."""


def _overlaps(selection, corner_uv, check=freebound.check):
    """Checks the selected faces together with the others that are kept clear."""
    vertices, faces, uv, (_, used) = _joined(selection, corner_uv)
    others = np.arange(len(faces[1]) - 1 - len(used)) + selection.face_count
    number_of = np.concatenate([used, others])
    found = check(vertices, faces, uv, listed=LISTED)
    pairs, alone, is_at_fault = [], set(), np.zeros(selection.face_count + len(others), dtype=bool)
    for finding in found["findings"]:
        if finding["severity"] != "error":
            continue
        own_pairs = number_of[np.array(finding.get("pairs", []), dtype=np.int64).reshape(-1, 2)]
        at_fault = np.concatenate([number_of[np.array(finding.get("faces", []), dtype=np.int64)], own_pairs.ravel()])
        is_at_fault[at_fault] = True
        is_at_fault |= bool(finding.get("more"))
        if finding["code"] in ("overlap-of-charts", "overlap-mirrored"):
            pairs.append(own_pairs)
        elif finding["code"] == "stacked":
            # Only the upper ones of stacked faces are listed.
            boxes = np.full((len(is_at_fault), 4), np.nan)
            boxes[number_of] = _boxes_of_faces(uv, faces[1])
            is_at_fault |= np.isin(_as_values(boxes), _as_values(boxes[at_fault]))
        else:
            alone.update(at_fault[at_fault < selection.face_count].tolist())
    pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *pairs])
    return Overlaps(found["planar"] and found["f32"], alone, pairs, is_at_fault)


def _boxes_of_faces(uv, starts):
    """Least and largest coordinates of each face."""
    low, high = np.minimum.reduceat(uv, starts[:-1]), np.maximum.reduceat(uv, starts[:-1])
    # Adding 0 turns −0 into 0.
    return np.column_stack([low, high]) + 0.0


def _as_values(rows):
    """Each row as one value."""
    return np.ascontiguousarray(rows).view([("", rows.dtype)] * rows.shape[1]).ravel()


def _tell_overlaps(task, selection, done, planar):
    """Adds the verdict on the selected faces and the others to the words. ``planar`` is True if it is known."""
    check = partial(task.call, "Checking", freebound.check)
    found = None if planar else _overlaps(selection, done.corner_uv, check)
    if found is None or found.planar:
        done.text += f", {_proved(selection)}"
    elif found.is_at_fault[: selection.face_count].any():
        done.warn("Selected faces overlap others: Check selects them")
    else:
        done.text += ", selected faces overlap nothing: proved"
        done.warn("Faces that are not selected overlap: Check selects them")
    if selection.new_count and selection.is_around:
        done.text += f"; {selection.new_count} faces are not unwrapped yet"


def told_of_chart(selection, corner_uv, corners):
    """Verdict in words on the chart of some corners, and a warning or an empty text."""
    found = _overlaps(selection, corner_uv)
    if found.planar:
        return _proved(selection), ""
    if found.is_at_fault[selection.face_of[corners]].any():
        return "one-to-one: proved", "The chart lies over others: Pack moves them apart"
    return "the chart overlaps nothing: proved", "Other faces overlap: Check selects them"


def _charts(task, selection):
    """Chart of each selected face, by its coordinates."""
    everything = np.ones(selection.face_count, dtype=bool)
    packed = task.call(
        "Finding charts", freebound.pack, selection.vertices, selection.faces(), selection.uv, lock=everything
    )
    return packed.chart


def is_mirrored(selection, chart_of):
    """True for each corner of a chart that is turned over."""
    area = np.zeros(selection.face_count)
    before = np.arange(len(selection.uv)) - 1
    before[selection.starts[:-1]] = selection.starts[1:] - 1
    cross = selection.uv[before, 0] * selection.uv[:, 1] - selection.uv[before, 1] * selection.uv[:, 0]
    np.add.at(area, selection.face_of, cross)
    of_chart = np.bincount(chart_of + 1, weights=area)
    return (of_chart[chart_of + 1] < 0)[selection.face_of]


def _boxes(selection, chart_of):
    """Box of each chart: largest coordinates, and largest negated ones. The first row is of faces without a chart."""
    boxes = np.full((chart_of.max() + 2, 4), -np.inf)
    np.maximum.at(boxes, chart_of[selection.face_of] + 1, np.column_stack([selection.uv, -selection.uv]))
    return boxes


def _keep_stacks(selection, chart_of, corner_uv):
    """Lays charts without pins that shared all places with another onto it again. Changes ``corner_uv``."""
    held = set(chart_of[selection.of_faces(selection.pinned | selection.is_attached)].tolist())
    chart_of_corner = chart_of[selection.face_of]
    _, first, like = np.unique(_boxes(selection, chart_of), axis=0, return_index=True, return_inverse=True)
    for upper, lower in enumerate(first[like.ravel()] - 1, start=-1):
        if upper in held or lower in (-1, upper):
            continue
        above, below = chart_of_corner == upper, chart_of_corner == lower
        places, at = np.unique(selection.uv[below], axis=0, return_index=True)
        both = np.concatenate([places, selection.uv[above]])
        _, number = np.unique(both, axis=0, return_inverse=True)
        number = number.ravel()
        if number.max() < len(places):
            corner_uv[above] = corner_uv[below][at][number[len(places) :]]


def _colliding(selection, chart_of, before, after):
    """Charts that may move, and that overlap others only now. Of two such charts the later one is enough."""
    count = selection.face_count

    def pairs(found):
        """Pairs of charts. Each face that is not selected is a chart of its own, with a number above the charts."""
        own = np.concatenate([chart_of, np.arange(found.pairs.max(initial=-1) + 1 - count) + chart_of.max() + 1])
        return set(map(tuple, np.unique(np.sort(own[found.pairs], axis=1), axis=0).tolist()))

    stays = set(chart_of[selection.of_faces(selection.pinned | selection.is_attached)].tolist())
    boxes = _boxes(selection, chart_of)
    moved = set()
    for low, high in sorted(pairs(after) - pairs(before)):
        is_stacked = high <= chart_of.max() and (boxes[low + 1] == boxes[high + 1]).all()
        movable = [chart for chart in (high, low) if chart <= chart_of.max() and chart not in stays]
        if movable and not is_stacked and not moved.intersection((low, high)):
            moved.add(movable[0])
    return moved


def counted(charts):
    """Number of charts in words."""
    return f"{charts} chart{'s' if charts != 1 else ''}"


def _pins(selection, is_pinned, uv=None):
    """Pins for the package, one for each pinned corner. Pins of vertices in the group are soft."""
    uv = selection.uv if uv is None else uv
    at = np.flatnonzero(is_pinned)
    return (at, uv[at], selection.weights[at]) if len(at) else None


def refuse_bare(selection):
    """Rejects corners without coordinates."""
    if np.isnan(selection.uv).any():
        raise freebound.InputError("corners have coordinates that are no numbers: unwrap the faces first")


def _solved(task, words, job):
    """Layout of a job, and a warning if it misses pins."""
    try:
        return task.run(words, job), ""
    except freebound.NotProved as error:
        if error.layout is None:
            raise
        return error.layout, sentence(error)


def sentence(error):
    """First line of an error, as a sentence."""
    text = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    return text[:1].upper() + text[1:]


def _around(selection):
    """Faces that are kept clear, or None."""
    return selection.others if selection.is_around else None


def _joined(selection, corner_uv):
    """Mesh of the selected faces and those that are kept clear, and its coordinates. Selected faces without coordinates
    are left out: the last pair has True for each selected corner that is in, and the selected faces that are in."""
    sizes = np.diff(selection.starts)
    is_used = np.logical_and.reduceat(np.isfinite(corner_uv).all(axis=1), selection.starts[:-1])
    of_corner = np.repeat(is_used, sizes)
    corners, uv, sizes = selection.corners[of_corner], corner_uv[of_corner], sizes[is_used]
    others = _around(selection)
    if others is not None:
        corners = np.concatenate([corners, others.corners])
        uv = np.concatenate([uv, others.uv])
        sizes = np.concatenate([sizes, np.diff(others.starts)])
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return selection.vertices, (corners, starts), uv, (of_corner, np.flatnonzero(is_used))


def _pack(task, selection, done, sheet, is_free, keeps_sizes=False):
    """Packs the charts of the free faces around all others. Changes ``done``, and returns the packing."""
    vertices, faces, uv, (of_corner, used) = _joined(selection, done.corner_uv)
    is_locked = np.ones(len(faces[1]) - 1, dtype=bool)
    is_locked[: len(used)] = ~is_free[used]
    options = {"pack": sheet.pack, "keep_sizes": keeps_sizes, "precision": "f32", "lock": is_locked}
    packed = task.call("Packing", freebound.pack, vertices, faces, uv, **options)
    settled = np.array(done.corner_uv)
    settled[of_corner] = packed.corner_uv[: of_corner.sum()]
    is_moved = (settled != done.corner_uv).any(axis=1) & of_corner
    done.corner_uv = settled
    if settled[is_moved].max(initial=0) > 1:
        done.warn("The others leave no room: the charts lie beside the picture")
    return packed

# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of the solver on gathered faces. Nothing here touches Blender, so that it can run in a thread."""

import math
from dataclasses import dataclass
from functools import partial

import freebound
import numpy as np

from .meshes import as_values, boxes_of, corner_after

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
    def pack_size(self):
        """Width and height of the picture that a given layout is packed into."""
        return self.size or (_SIDE, _SIDE)

    @property
    def pack(self):
        """Packing of a given layout."""
        return freebound.Pack(size=self.pack_size, gap=self.margin)

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
        done.text += f", {_proved(selection)}{_not_yet(selection)}"
    else:
        is_free = ~selection.of_faces(selection.pinned)
        packed = _pack(task, selection, done, sheet, is_free)
        done.text += ", packed around the others" if _around(selection) is not None and is_free.any() else ""
        _tell_overlaps(task, selection, done, packed.planar)
    done.text += _energy(layout)
    return done


def relax(task, selection, sheet, rounds):
    """Lowers the distortion of the charts. Each stays where it is, unless it would come to lie over another."""
    aspect = {"aspect": sheet.options["aspect"]} if "aspect" in sheet.options else {}
    charts = Charts(selection)
    held = selection.pinned | selection.is_attached | charts.is_shared
    # A mirrored chart is relaxed in the mirror.
    side = np.where(is_mirrored(selection, charts.of_face), -1.0, 1.0)[:, None] * (1, 0) + (0, 1)
    # Charts share no vertices, so that each is a mesh of its own.
    keys = np.column_stack([charts.of_face[selection.face_of], selection.places])
    _, first, vertex_of = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    job = freebound.start(
        selection.vertices[selection.corners[first]],
        (vertex_of.ravel(), selection.starts),
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
    stays = charts.follow(done.corner_uv, selection.of_faces(held))
    check = partial(task.call, "Checking", freebound.check)
    before = _overlaps(selection, selection.uv, check)
    after = _overlaps(selection, done.corner_uv, check)
    spoiled = np.isin(charts.of_face, charts.of_face[sorted(after.faces_at_fault - before.faces_at_fault)])
    if spoiled.any():
        of_corner = spoiled[selection.face_of]
        done.corner_uv[of_corner] = selection.uv[of_corner]
        after = _overlaps(selection, done.corner_uv, check)
    done.text = f"{counted(len(np.setdiff1d(charts.of_face[~spoiled], [-1, *stays])))} relaxed"
    moved = charts.colliding(before, after, done.corner_uv, selection.of_faces(held) | np.isin(charts.of_face, stays))
    planar = after.planar
    if moved:
        _move(task, selection, done, sheet, charts, moved)
        planar = False
        done.text += f", {len(moved)} moved"
    _tell_overlaps(task, selection, done, planar)
    done.text += _energy(layout)
    if spoiled.any():
        done.warn(f"{counted(len(np.unique(charts.of_face[spoiled])))} left as before, because of pins or small faces")
    return done


def _move(task, selection, done, sheet, charts, moved):
    """Moves charts to free places. Those that lie on them follow."""
    before = np.array(done.corner_uv)
    is_free = np.isin(charts.of_face, sorted(moved))
    _pack(task, selection, done, sheet, is_free, keeps_sizes=True)
    of_corner = is_free[selection.face_of]
    sides = [_side_lengths(selection, uv, is_free) for uv in (before, done.corner_uv)]
    if sides[1] < 0.999 * sides[0]:
        # There is no room at their size.
        done.corner_uv[of_corner] = before[of_corner]
        others = _around(selection)
        stay = [before[~of_corner]] + ([others.uv] if others is not None else [])
        _lay_beside(selection, done, charts, sorted(moved), np.concatenate(stay))
        done.warn("There is no room: charts lie beside the picture")
    charts.carry_along(before, done.corner_uv, moved)


def pack(task, selection, sheet, keeps_sizes):
    """Packs the charts of the selected faces. Charts with pins stay, and charts that are partly selected."""
    done = Done(selection.uv, "")
    is_held = selection.of_faces(selection.pinned | selection.is_attached)
    packed = _pack(task, selection, done, sheet, ~is_held, keeps_sizes)
    charts = packed.chart[: selection.face_count]
    held = np.unique(charts[is_held])
    done.text = f"{counted(len(np.setdiff1d(charts, [-1, *held])))} packed"
    if len(held):
        done.text += f", {len(held)} stayed"
    _tell_overlaps(task, selection, done, packed.planar)
    return done


def copy_layout(task, source, selection, names, fit, marks_seams):
    """Copies the layout of one object to each object of a selection."""
    done = Done(np.empty_like(selection.uv), "")
    of_source = (source.vertices, source.faces(), source.uv)
    planar = 0
    for name, (vertices, faces, corners) in zip(names, selection.meshes()):
        copied = task.call(f"Copying to {name}", freebound.transfer, of_source, (vertices, faces), fit=fit)
        # Blender keeps coordinates in 32 bits.
        uv = copied.corner_uv.astype(np.float32).astype(np.float64)
        done.corner_uv[corners] = uv
        if task.call(f"Checking {name}", freebound.check, vertices, faces, uv)["planar"]:
            planar += 1
        else:
            done.warn(f"The layout of {name} folds or overlaps: relax it")
        if copied.apart:
            done.warn(f"{name} lies apart: use Fit, or move the objects to one place")
    done.text = "Layout copied to 1 mesh" if len(names) == 1 else f"Layout copied to {len(names)} meshes"
    done.text += ", no overlaps: proved" if planar == len(names) else ""
    if marks_seams:
        done.seams = cut_edges(selection.corners, selection.starts, done.corner_uv)
    return done


def cut_edges(corners, starts, uv):
    """Edges with two faces whose coordinates differ there, by their vertices."""
    here, after = np.arange(len(corners)), corner_after(starts)
    is_turned = corners > corners[after]
    first, second = np.where(is_turned, after, here), np.where(is_turned, here, after)
    rows = np.column_stack([corners[first], corners[second], uv[first], uv[second]])
    rows = rows[np.lexsort((corners[second], corners[first]))]
    is_same_edge = (rows[1:, :2] == rows[:-1, :2]).all(axis=1)
    differs = is_same_edge & (rows[1:, 2:] != rows[:-1, 2:]).any(axis=1)
    return np.unique(rows[1:][differs, :2].astype(np.int64), axis=0)


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
            upper = np.array(finding["faces"], dtype=np.int64)
            is_at_fault[number_of[with_stacked(uv, faces[1], upper)]] = True
        else:
            alone.update(at_fault[at_fault < selection.face_count].tolist())
    pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *pairs])
    return Overlaps(found["planar"] and found["f32"], alone, pairs, is_at_fault)


def with_stacked(uv, starts, faces):
    """Some faces, and all that have the same box. Of stacked faces a check lists the upper ones alone."""
    boxes = as_values(np.column_stack(boxes_of(uv, starts)))
    return np.flatnonzero(np.isin(boxes, boxes[faces]))


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
    done.text += _not_yet(selection)


def _energy(layout):
    """Words about the mean energy of a layout. None if the surface has no area."""
    return f"; energy {layout.energy:.3f}" if np.isfinite(layout.energy) else ""


def _not_yet(selection):
    """Words about faces that have no place yet."""
    if not (selection.new_count and selection.is_around):
        return ""
    faces = "1 face is" if selection.new_count == 1 else f"{selection.new_count} faces are"
    return f"; {faces} not unwrapped yet"


def told_of_chart(selection, corner_uv, corners):
    """Verdict in words on the chart of some corners, and a warning or an empty text."""
    found = _overlaps(selection, corner_uv)
    if found.planar:
        return _proved(selection) + _not_yet(selection), ""
    own = selection.face_of[corners]
    if found.faces_at_fault.intersection(own.tolist()):
        return "and now over parts of the chart that are not shown", "Undo, or show all faces and unwrap them"
    if found.is_at_fault[own].any():
        return "one-to-one: proved", "The chart lies over others: Pack moves them apart"
    return "the chart overlaps nothing: proved", "Other faces overlap: Check selects them"


def is_mirrored(selection, chart_of):
    """True for each corner of a chart that is turned over."""
    uv, after = selection.uv, corner_after(selection.starts)
    cross = uv[:, 0] * uv[after, 1] - uv[:, 1] * uv[after, 0]
    area = np.add.reduceat(cross, selection.starts[:-1])
    of_chart = np.bincount(chart_of + 1, weights=area)
    return (of_chart[chart_of + 1] < 0)[selection.face_of]


def _side_lengths(selection, uv, chosen):
    """Sum of the lengths of all sides of some faces."""
    sides = uv[corner_after(selection.starts)] - uv
    return np.linalg.norm(sides, axis=1)[chosen[selection.face_of]].sum()


def _lay_beside(selection, done, charts, moved, stay):
    """Lays charts in a row to the right of all coordinates that stay."""
    right, gap = max(1.0, np.ceil(stay[:, 0].max(initial=1.0))), 1 / 256
    for chart in moved:
        own = charts.of_corner == chart
        low, high = done.corner_uv[own].min(axis=0), done.corner_uv[own].max(axis=0)
        done.corner_uv[own] += (right + gap, gap) - low
        right += high[0] - low[0] + gap


class Charts:
    """Charts of the selected faces and of the others, and the stacks that they form."""

    def __init__(self, selection):
        others = selection.others
        count = selection.face_count
        corners, starts, uv = selection.corners, selection.starts, selection.uv
        if others is not None:
            corners, uv = np.concatenate([corners, others.corners]), np.concatenate([uv, others.uv])
            starts = np.concatenate([starts, starts[-1] + others.starts[1:]])
        self.of_any = freebound.charts(selection.vertices, (corners, starts), uv)
        """Chart of each selected face and each other; −1 for faces without a triangle."""
        self.of_face = self.of_any[:count]
        """Chart of each selected face."""
        self.of_corner = self.of_face[selection.face_of]
        """Chart of each corner of a selected face."""
        places = selection.places
        # A vertex and its coordinates, once for each chart.
        once = np.unique(np.column_stack([self.of_corner, places]), axis=0)[:, 1:]
        values, counts = np.unique(as_values(once), return_counts=True)
        self.is_shared = np.isin(as_values(places), values[counts > 1])
        """True for each corner whose vertex has the same place in another chart of the selection."""
        self._uv = selection.uv
        face_of = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
        self.leader_of = self._leaders(self.of_any[face_of], uv)
        """First chart with the same places, for each chart."""
        self._own_count = count

    @staticmethod
    def _leaders(chart_of_corner, uv):
        count = chart_of_corner.max() + 1
        leader_of = np.arange(count)
        known = chart_of_corner >= 0
        boxes = np.full((count, 4), -np.inf)
        np.maximum.at(boxes, chart_of_corner[known], np.column_stack([uv, -uv])[known])
        _, like = np.unique(boxes, axis=0, return_inverse=True)
        like = like.ravel()
        is_twin = np.bincount(like)[like] > 1
        corners = np.flatnonzero(known & is_twin[chart_of_corner])
        order = corners[np.argsort(chart_of_corner[corners], kind="stable")]
        first_of = {}
        for own in np.split(order, np.flatnonzero(np.diff(chart_of_corner[order])) + 1) if len(order) else []:
            chart = chart_of_corner[own[0]]
            key = np.unique(uv[own] + 0.0, axis=0).tobytes()
            leader_of[chart] = first_of.setdefault(key, chart)
        return leader_of

    def _stacks(self):
        """Charts of each stack of several."""
        order = np.argsort(self.leader_of, kind="stable")
        groups = np.split(order, np.flatnonzero(np.diff(self.leader_of[order])) + 1)
        return [group for group in groups if len(group) > 1]

    def follow(self, corner_uv, is_held):
        """Lays charts that shared all places before onto one of them. Changes ``corner_uv``, and returns the charts that
        have to stay, because others lie there that are not selected."""
        held, own = set(self.of_face[is_held].tolist()), set(self.of_face.tolist())
        others = set(self.of_any[self._own_count :].tolist())
        stays = set()
        for stack in self._stacks():
            members = [chart for chart in stack.tolist() if chart in own]
            if others.intersection(stack.tolist()):
                free = [chart for chart in members if chart not in held]
                stays.update(free)
                for chart in free:
                    corner_uv[self.of_corner == chart] = self._uv[self.of_corner == chart]
                continue
            leader = next((chart for chart in members if chart in held), members[0])
            for chart in members:
                if chart != leader and chart not in held:
                    self._copy(self._uv, corner_uv, leader, chart)
        return sorted(stays)

    def carry_along(self, before, corner_uv, moved):
        """Lays charts that lie on moved ones onto their new places. Changes ``corner_uv``."""
        for stack in self._stacks():
            leaders = [chart for chart in stack.tolist() if chart in moved]
            for chart in stack.tolist() if leaders else []:
                if chart != leaders[0]:
                    self._copy(before, corner_uv, leaders[0], chart)

    def _copy(self, before, corner_uv, leader, chart):
        """Gives a chart the new coordinates of another, where both had the same places."""
        own, of_leader = self.of_corner == chart, self.of_corner == leader
        places, at = np.unique(as_values(before[of_leader]), return_index=True)
        number = np.searchsorted(places, as_values(before[own])).clip(max=len(places) - 1)
        if (places[number] == as_values(before[own])).all():
            corner_uv[own] = corner_uv[of_leader][at][number]

    def colliding(self, before, after, corner_uv, is_held):
        """Leaders of stacks that overlap others only now and may move. Of two the one that changed more moves."""

        def pairs(found):
            charts = self.leader_of[self.of_any[found.pairs]]
            return set(map(tuple, np.unique(np.sort(charts, axis=1), axis=0).tolist()))

        staying = np.concatenate([self.of_face[is_held], self.of_any[self._own_count :]])
        stay = set(self.leader_of[staying[staying >= 0]].tolist())
        change = np.zeros(len(self.leader_of))
        known = self.of_corner >= 0
        np.maximum.at(
            change,
            self.leader_of[self.of_corner[known]],
            np.linalg.norm(corner_uv - self._uv, axis=1)[known],
        )
        moved = set()
        for pair in sorted(pairs(after) - pairs(before)):
            movable = sorted((chart for chart in pair if chart not in stay), key=lambda chart: -change[chart])
            if movable and not moved.intersection(pair):
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
        done.warn("There is no room: charts lie beside the picture")
    width, height = packed.report["packing"]["picture"]
    if is_moved.any() and max(width, height) > max(sheet.pack_size):
        done.warn(f"The margin needs a picture of {width} × {height}: it is smaller here")
    return packed

"""The paper's iteration step by step, its matrices, and dragged pins."""

import numpy as np
import pytest

import freebound
from meshes import cube, grid


def test_the_iteration_shows_each_step():
    vertices, faces, _ = grid()
    pins = {0: (0, 0), 12: (1, 0), 142: (1, 1), 70: (0.8, 0.8)}
    flattener = freebound.Flattener(vertices, faces, pins=pins, method="iterate", max_steps=5)
    assert flattener.ending is None
    steps = list(flattener)
    assert [step.index for step in steps] == list(range(len(steps))) and flattener.ending
    for step in steps:
        assert step.uv.shape == (len(vertices), 2) and step.triangles.shape == faces.shape
        a, b, c = (step.uv[step.triangles[:, k]] for k in range(3))
        area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
        assert set(np.flatnonzero(area < -1e-12)) <= set(step.flipped)
        assert step.report["flipped_faces"] == len(step.flipped)
    assert "Step 0" in repr(steps[0])


def test_pins_of_corners_are_met_and_options_of_the_layout_are_refused():
    vertices, faces, _ = grid()
    corner = int(np.flatnonzero(faces.ravel() == 70)[0])
    steps = list(freebound.Flattener(vertices, faces, pins={0: (0, 0), 12: (1, 0)}, corner_pins={corner: (0.4, 0.5)}))
    assert (steps[-1].uv[70] == (0.4, 0.5)).all()
    with pytest.raises(freebound.OptionError):
        freebound.Flattener(vertices, faces, pack=freebound.Pack(size=512))


def test_a_mesh_that_is_no_disk_has_no_steps():
    with pytest.raises(freebound.InputError):
        freebound.Flattener(*cube())


def test_the_equations_hold_for_the_map_that_solves_them():
    pytest.importorskip("scipy")
    vertices, faces, _ = grid()
    matrix = freebound.equations(vertices, faces, family="conformal")
    assert matrix.shape == (len(vertices),) * 2
    assert abs(matrix @ np.ones(len(vertices))).max() < 1e-12
    layout = freebound.flatten(vertices, faces, pins={0: (0, 0), 12: (1, 0)}, method="natural", family="conformal")
    map_of_vertices = layout.uv @ [1, 1j]
    residual = abs(matrix @ map_of_vertices) / (abs(matrix) @ abs(map_of_vertices) + 1e-300)
    free = np.setdiff1d(np.arange(len(vertices)), [0, 12])
    assert residual[free].max() < 1e-12
    # Floater's mean value weights are positive, and reproduce linear functions on a flat mesh.
    flat, faces, _ = grid(height=0)
    inside = np.flatnonzero((flat[:, :2] > 0).all(axis=1) & (flat[:, :2] < 1).all(axis=1))
    matrix = freebound.equations(flat, faces, family="mean-value", boundary="fixed")
    assert abs((matrix @ (flat[:, 0] + 2 * flat[:, 1]))[inside]).max() < 1e-10
    with pytest.raises(freebound.OptionError):
        freebound.equations(flat, faces, family="uniform-ish")


def test_a_dragged_vertex_reaches_its_place_and_the_layout_stays_planar():
    vertices, faces, _ = grid()
    layout = freebound.flatten(vertices, faces, pins={0: (0, 0), 12: (1, 0), 130: (0, 1), 142: (1, 1)})
    drag = freebound.Drag(layout)
    place = layout.uv[70] + 0.05
    uv, verdict = drag.move(70, place)
    assert verdict["planar"] and np.array_equal(uv[70], place)
    assert all(np.array_equal(uv[vertex], layout.uv[vertex]) for vertex in (0, 12, 130, 142))
    # Beyond the boundary it stops, and the layout stays planar.
    uv, verdict = drag.move(70, (3.0, 3.0))
    assert verdict["planar"]
    a, b, c = (uv[faces[:, k]] for k in range(3))
    assert ((b - a)[:, 0] * (c - a)[:, 1] > (b - a)[:, 1] * (c - a)[:, 0]).all()
    with pytest.raises(freebound.OptionError):
        drag.move(100000, (0, 0))
    with pytest.raises(freebound.OptionError):
        freebound.Drag(freebound.unwrap(*cube(), seams="sharp"))


def test_a_drag_may_go_frame_by_frame():
    layout = freebound.flatten(*grid()[:2])
    whole, once = freebound.Drag(layout), freebound.Drag(layout)
    target = tuple(layout.uv[0] + 0.05)
    places, _ = whole.move(0, target)
    frames = 0
    while frames == 0 or not once.at_rest:
        stepped, verdict = once.move(0, target, frames=1)
        assert verdict["planar"]
        frames += 1
    assert frames > 1 and whole.at_rest
    assert (places == stepped).all()
    with pytest.raises(freebound.OptionError, match="frames"):
        once.move(0, target, frames=0)

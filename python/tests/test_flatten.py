"""Disks: flattening with and without pins."""

from fractions import Fraction

import numpy as np
import pytest

import freebound
from meshes import cube, grid, write_obj


def is_left_turn(a, b, c):
    """Exact orientation."""
    (ax, ay), (bx, by), (cx, cy) = [[Fraction(float(number)) for number in point] for point in (a, b, c)]
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0


def test_a_sheet_is_flattened_planar_with_all_triangles_upright():
    vertices, faces, _ = grid()
    layout = freebound.flatten(vertices, faces)
    assert layout.verdict and layout.verdict.planar_in_f32
    assert np.array_equal(layout.faces, faces) and np.array_equal(layout.source, np.arange(len(vertices)))
    assert all(is_left_turn(*layout.uv[face]) for face in faces)
    assert layout.uv.min() == 0 and layout.uv.max() == 1


def test_hard_pins_are_met_to_the_last_bit():
    vertices, faces, _ = grid()
    pins = {0: (0.1, 0.2), 12: (0.9, 0.3), 142: (1 / 3, 0.7), 70: (0.45, 0.5)}
    layout = freebound.flatten(vertices, faces, pins=pins)
    for vertex, place in pins.items():
        at = layout.uv[layout.source == vertex]
        assert (at == np.array(place)).all() and len(at) >= 1
    assert layout.report["pins"]["unmet"] == []


def test_pins_may_be_arrays_and_soft():
    vertices, faces, _ = grid()
    places = np.array([[0, 0], [1, 0], [0.5, 0.9]])
    by_arrays = freebound.flatten(vertices, faces, pins=(np.array([0, 12, 142], dtype=np.uint8), places))
    by_table = freebound.flatten(vertices, faces, pins={0: (0, 0), 12: (1, 0), 142: (0.5, 0.9)})
    assert np.array_equal(by_arrays.uv, by_table.uv)
    soft = freebound.flatten(vertices, faces, pins={0: (0, 0), 12: (1, 0), 142: (0.5, 0.9, 2.0)})
    assert [pin["vertex"] for pin in soft.report["pins"]["soft"]] == [142]


@pytest.mark.parametrize("kind", [np.int32, np.int64, np.uint32, np.uint64, np.int16])
@pytest.mark.parametrize("precision", [np.float32, np.float64])
def test_any_type_of_numbers_gives_the_same_layout(kind, precision):
    vertices, faces, _ = grid(6, 5)
    vertices = vertices.astype(np.float32)
    layout = freebound.flatten(vertices.astype(precision), faces.astype(kind))
    assert np.array_equal(layout.uv, freebound.flatten(vertices, faces).uv)


def test_quads_and_polygons_keep_their_faces():
    vertices, _, quads = grid()
    of_quads = freebound.flatten(vertices, quads)
    assert of_quads.faces.shape == quads.shape and np.array_equal(of_quads.vertex_faces, quads)
    starts = np.arange(0, quads.size + 1, 4)
    of_polygons = freebound.flatten(vertices, (quads.ravel(), starts))
    assert np.array_equal(of_polygons.uv, of_quads.uv)
    mixed = freebound.flatten(vertices, [list(face) for face in quads[:-1]] + [list(quads[-1][:3]), list(quads[-1][[0, 2, 3]])])
    indices, offsets = mixed.faces
    assert offsets[-1] == len(indices) == quads.size + 2


def test_results_are_read_only_and_outlive_their_layout():
    vertices, faces, _ = grid()
    layout = freebound.flatten(vertices, faces)
    uv, before = layout.uv, layout.uv.copy()
    with pytest.raises(ValueError):
        uv[0] = 0
    del layout
    freebound.flatten(vertices, faces)
    assert np.array_equal(uv, before)


def test_the_distortion_of_the_faces_sums_up_to_that_of_the_report():
    vertices, faces, _ = grid()
    layout = freebound.flatten(vertices, faces, relax=3)
    reported = layout.report["distortion"]
    assert layout.energy == pytest.approx(reported["symmetric_dirichlet"]["mean"], rel=1e-12)
    angle = layout.singular_values[:, 0] / layout.singular_values[:, 1]
    assert angle.max() == pytest.approx(reported["angle"]["max"], rel=1e-12)
    # An independent measure: the map of each face by a QR factorization.
    for face, (first, second) in zip(faces[:20], layout.singular_values):
        space, plane = vertices[face], layout.uv[face]
        frame, flat = np.linalg.qr((space[1:] - space[0]).T)
        jacobian = (plane[1:] - plane[0]).T @ np.linalg.inv(flat)
        values = np.linalg.svd(jacobian, compute_uv=False)
        assert values[0] / values[1] == pytest.approx(first / second, rel=1e-9)


def test_new_vertices_lie_on_their_edges_and_name_their_faces():
    vertices, faces, _ = grid(6, 6)
    # A swirl that needs edges to be split.
    middle = np.flatnonzero((abs(vertices[:, :2] - 0.5) < 0.2).all(axis=1))
    turned = 0.5 + (vertices[middle, :2] - 0.5) @ np.array([[-1, 0], [0, -1]])
    rim = np.flatnonzero((abs(vertices[:, :2] - 0.5) > 0.49).any(axis=1))
    places = np.concatenate([turned, vertices[rim, :2]])
    layout = freebound.flatten(vertices, faces, pins=(np.concatenate([middle, rim]), places))
    assert layout.verdict and len(layout.new_vertex_at) > 0
    first = len(vertices)
    assert np.array_equal(layout.vertices[:first], vertices)
    a, b = layout.vertices[layout.new_vertex_edges[:, 0]], layout.vertices[layout.new_vertex_edges[:, 1]]
    expected = a + layout.new_vertex_at[:, None] * (b - a)
    assert np.allclose(layout.vertices[first:], expected, rtol=0, atol=1e-12)
    assert len(layout.faces) > len(faces) and set(layout.face_of) == set(range(len(faces)))
    kept = freebound.start(vertices, faces, pins=(np.concatenate([middle, rim]), places), new_vertices=False)
    with pytest.raises(freebound.NotProved) as found:
        kept.result()
    assert found.value.layout.verdict.planar and found.value.layout.verdict.unmet_pins
    assert not found.value.layout.verdict


def test_wrong_options_and_meshes_are_named(tmp_path):
    vertices, faces, _ = grid()
    with pytest.raises(freebound.OptionError, match="metod"):
        freebound.flatten(vertices, faces, metod="auto")
    with pytest.raises(freebound.OptionError, match="method"):
        freebound.flatten(vertices, faces, method="magic")
    with pytest.raises(freebound.OptionError, match="layers"):
        freebound.flatten(vertices, faces, layers=3)
    with pytest.raises(freebound.OptionError):
        freebound.flatten(vertices, faces, pins={0: (0, 0, -1)})
    with pytest.raises(freebound.InputError) as found:
        freebound.flatten(vertices, np.array([[0, 1, 999], [0, 1, -2], [0, 1, 2]]))
    assert found.value.faults[0]["faces"] == [0, 1]
    broken = vertices.copy()
    broken[7, 1] = np.nan
    with pytest.raises(freebound.InputError) as found:
        freebound.flatten(broken, faces)
    assert found.value.faults[0]["vertices"] == [7]
    with pytest.raises(freebound.InputError) as found:
        freebound.flatten(*cube())
    assert found.value.faults
    with pytest.raises(freebound.OptionError, match="9999"):
        freebound.flatten(vertices, faces, pins={9999: (0, 0)})
    with pytest.raises(freebound.OptionError):
        freebound.flatten(vertices, faces, pins={0: (0, 0), 12: (0, 0)})
    with pytest.raises(freebound.InputError):
        freebound.read(tmp_path / "missing.obj")
    with pytest.raises(freebound.OptionError):
        freebound.flatten(vertices)


def test_a_layout_starts_from_given_coordinates():
    vertices, faces, _ = grid()
    first = freebound.flatten(vertices, faces)
    again = freebound.flatten(vertices, faces, layout=first.corner_uv)
    assert np.array_equal(again.corner_uv, first.corner_uv) and again.report["start"] == "uv"


def test_files_keep_what_they_hold(tmp_path):
    vertices, faces, _ = grid()
    path = write_obj(tmp_path / "sheet.obj", vertices, faces)
    text = "# a remark\nmtllib sheet.mtl\nusemtl red\n" + path.read_text()
    path.write_text(text)
    mesh = freebound.read(path)
    assert np.array_equal(mesh.vertices, vertices) and np.array_equal(mesh.faces, faces) and mesh.corner_uv is None
    written = freebound.flatten(mesh).save(tmp_path / "flat.obj")
    assert written[0] == str(tmp_path / "flat.obj")
    saved = (tmp_path / "flat.obj").read_text()
    assert "# a remark" in saved and "usemtl red" in saved
    assert freebound.check(tmp_path / "flat.obj")["planar"]
    for name in ("flat.ply", "flat.glb", "flat.svg", "flat.png", "flat.json"):
        freebound.flatten(path).save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 100
    with pytest.raises(freebound.OptionError):
        freebound.flatten(path).save(tmp_path / "flat.xyz")

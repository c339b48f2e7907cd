"""Any mesh: automatic seams, charts and packing."""

import numpy as np
import pytest

import freebound
from meshes import ball, cube, grid, write_obj


def test_a_closed_mesh_is_cut_and_packed_with_little_distortion():
    vertices, faces = ball()
    layout = freebound.unwrap(vertices, faces, distortion=4.2, pack=freebound.Pack(size=512, gap=4))
    assert layout.verdict.planar and layout.energy <= 4.2
    assert layout.uv.min() >= 0 and layout.uv.max() <= 1
    assert len(layout.cut_edges) > 0 and (layout.chart >= 0).all()
    # The check of a layout is another algorithm than its proof.
    found = freebound.check(vertices, faces, layout.corner_uv)
    assert found["planar"] and found["charts"] == layout.chart.max() + 1


def test_cut_edges_are_those_at_which_the_coordinates_differ():
    vertices, faces = cube()
    layout = freebound.unwrap(vertices, faces)
    sides = {}
    for face, places in zip(faces, layout.corner_uv.reshape(-1, 4, 2)):
        for k in range(4):
            a, b = face[k], face[(k + 1) % 4]
            ends = (tuple(places[k]), tuple(places[(k + 1) % 4]))
            sides.setdefault((min(a, b), max(a, b)), []).append(ends if a < b else ends[::-1])
    differing = sorted(edge for edge, both in sides.items() if both[0] != both[1])
    assert differing == [tuple(edge) for edge in layout.cut_edges]


def test_seams_can_be_given_by_edges_and_by_kind():
    vertices, faces = cube()
    by_kind = freebound.unwrap(vertices, faces, seams="sharp=60")
    assert by_kind.chart.max() == 5 and by_kind.energy == pytest.approx(4, abs=1e-9)
    edges = {tuple(sorted((face[k], face[(k + 1) % 4]))) for face in faces for k in range(4)}
    by_edges = freebound.unwrap(vertices, faces, seams=np.array(sorted(edges)))
    assert np.array_equal(by_edges.corner_uv, by_kind.corner_uv)


def test_a_corner_names_one_side_of_a_seam():
    vertices, faces, _ = grid(4, 4, 0)
    middle = [(5 * row + 2, 5 * (row + 1) + 2) for row in range(4)]
    corners = faces.ravel()
    right = next(k for k, face in enumerate(faces) if 2 in face and (vertices[face, 0] >= 0.5).all())
    at = 3 * right + int(np.flatnonzero(faces[right] == 2)[0])
    layout = freebound.flatten(
        vertices, faces, seams=middle, repair="all", cut="shortest",
        corner_pins={at: (0.7, 0.1), 3 * right + (at + 1) % 3: (0.9, 0.3)},
    )
    assert corners[at] == 2 and (layout.corner_uv[at] == (0.7, 0.1)).all()
    other = [k for k in np.flatnonzero(corners == 2) if not (layout.corner_uv[k] == (0.7, 0.1)).all()]
    assert other, "the other side of the seam lies elsewhere"


def test_sizes_and_parts_of_charts_are_those_asked_for():
    vertices, faces = cube()
    layout = freebound.unwrap(vertices, faces, seams="sharp", chart_size={0: 2.0})
    flat = layout.corner_uv.reshape(-1, 4, 2)
    side = np.linalg.norm(flat[:, 1] - flat[:, 0], axis=1)
    assert side[0] == pytest.approx(2 * side[1], rel=1e-6)
    with pytest.raises(freebound.OptionError, match="chart 9"):
        freebound.unwrap(vertices, faces, seams="sharp", chart_size={9: 2.0})
    two = np.concatenate([vertices, vertices + 3])
    both = np.concatenate([faces, faces + 8])
    one = freebound.unwrap(two, both, parts=1)
    assert (one.chart[:6] == -1).all() and (one.chart[6:] >= 0).all()
    assert np.isnan(one.corner_uv[:24]).all() and (one.faces[:6] == -1).all()
    assert np.isnan(one.singular_values[:6]).all()


def test_the_mean_energy_of_polygons_is_that_of_the_report():
    vertices, _, quads = grid()
    layout = freebound.flatten(vertices, quads, relax=2)
    assert layout.energy == pytest.approx(layout.report["distortion"]["symmetric_dirichlet"]["mean"], rel=1e-12)
    assert len(layout.triangle_face) == 2 * len(quads)


def test_options_that_contradict_each_other_are_refused():
    vertices, faces = cube()
    for wrong in (
        {"fit": "true", "pack": freebound.Pack(density=10.0)},
        {"fit": "true", "chart_size": {0: 2.0}, "seams": "sharp"},
        {"fit": "true", "aspect": 2.0},
        {"aspect": 2.0, "pack": freebound.Pack(size=512)},
        {"lock": [0]},
        {"chart_size": {0: 2.0}, "cut": "shortest"},
        {"relax": "many"},
        {"pins": ([1, 1], [(0, 0), (1, 1)])},
        {"corner_pins": {0: (0, 0), 23: (1, 1)}, "seams": None, "cut": "shortest", "pins": {0: (0.5, 0.5)}},
    ):
        with pytest.raises(freebound.OptionError):
            freebound.unwrap(vertices, faces, **wrong)
    with pytest.raises(freebound.OptionError, match="relax"):
        freebound.unwrap(vertices, faces, relax="many")


def test_a_check_finds_what_was_damaged():
    vertices, faces = ball()
    layout = freebound.unwrap(vertices, faces)
    damaged = layout.corner_uv.copy()
    damaged[0] = damaged[0] + 0.5
    found = freebound.check(vertices, faces, damaged)
    assert not found["planar"] and found["findings"]
    with pytest.raises(freebound.OptionError):
        freebound.check(vertices, faces)


def test_threads_do_not_change_the_bytes():
    vertices, faces = ball(40, 20)
    layouts = [freebound.unwrap(vertices, faces, threads=threads) for threads in (1, 2, 3)]
    assert all(layout.uv.tobytes() == layouts[0].uv.tobytes() for layout in layouts)


def test_materials_are_kept_with_trimesh(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = ball()
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    layout = freebound.unwrap(mesh.vertices, mesh.faces)
    material = trimesh.visual.material.PBRMaterial(baseColorFactor=[200, 30, 40, 255], name="red")
    unwrapped = trimesh.Trimesh(
        layout.vertices[layout.source], layout.faces, process=False,
        visual=trimesh.visual.TextureVisuals(uv=layout.uv, material=material),
    )
    assert unwrapped.area == pytest.approx(mesh.area, rel=1e-12)
    unwrapped.export(tmp_path / "ball.glb")
    again = trimesh.load(tmp_path / "ball.glb", force="mesh", process=False)
    assert np.allclose(again.visual.uv, layout.uv, atol=1e-6) and again.visual.material.name == "red"
    assert freebound.check(tmp_path / "ball.glb")["planar"]
    # The file keeps its material when it is unwrapped itself.
    freebound.unwrap(tmp_path / "ball.glb").save(tmp_path / "again.glb")
    assert trimesh.load(tmp_path / "again.glb", force="mesh").visual.material.name == "red"


def test_the_program_and_the_package_write_the_same_bytes(tmp_path, program):
    vertices, faces = ball()
    path = write_obj(tmp_path / "ball.obj", vertices, faces)
    program("unwrap", path, "-o", tmp_path / "program.obj")
    freebound.unwrap(path).save(tmp_path / "package.obj")
    assert (tmp_path / "program.obj").read_bytes() == (tmp_path / "package.obj").read_bytes()
    program("unwrap", path, "-o", tmp_path / "program.ply", "--aspect", "2:1")
    freebound.unwrap(path, aspect=2.0).save(tmp_path / "package.ply")
    assert (tmp_path / "program.ply").read_bytes() == (tmp_path / "package.ply").read_bytes()
    vertices, faces, _ = grid()
    path = write_obj(tmp_path / "grid.obj", vertices, faces)
    program("flatten", path, "-o", tmp_path / "program.obj", "--pin", "0:0.1,0.2", "--pin", "12:0.8,0.3")
    freebound.flatten(path, pins={0: (0.1, 0.2), 12: (0.8, 0.3)}).save(tmp_path / "package.obj")
    assert (tmp_path / "program.obj").read_bytes() == (tmp_path / "package.obj").read_bytes()


def scattered():
    """A cube with a chart for each face, all in one place."""
    vertices, faces = cube()
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * 0.25 + 0.125
    return vertices, faces, np.tile(square, (6, 1))


def test_charts_of_a_given_layout_are_packed_and_keep_their_shapes(tmp_path):
    vertices, faces, uv = scattered()
    assert not freebound.check(vertices, faces, uv)["planar"]
    packed = freebound.pack(vertices, faces, uv, pack=freebound.Pack(size=256, gap=4))
    assert freebound.charts(vertices, faces, uv).tolist() == list(range(6))
    assert packed.planar and packed.chart.tolist() == list(range(6)) and packed.report["packing"]["gap"] == 4
    # The check of a layout is another algorithm than its proof.
    assert freebound.check(vertices, faces, packed.corner_uv, gap=3.9, size=256)["passes"]
    sides = np.linalg.norm(np.diff(packed.corner_uv.reshape(-1, 4, 2), axis=1), axis=2)
    assert np.ptp(sides) < 1e-12
    file, *_ = packed.save(tmp_path / "packed.obj")
    assert np.array_equal(freebound.read(file).corner_uv, packed.corner_uv)
    with pytest.raises(freebound.OptionError, match="png"):
        packed.save(tmp_path / "packed.png")


@pytest.mark.parametrize("lock", [[2], np.arange(6) == 2])
def test_locked_charts_keep_their_bits_and_others_are_packed_around_them(lock):
    vertices, faces, uv = scattered()
    packed = freebound.pack(vertices, faces, uv, lock=lock)
    assert packed.planar and np.array_equal(packed.corner_uv[8:12], uv[8:12])
    others = np.delete(packed.corner_uv.reshape(-1, 4, 2), 2, axis=0)
    assert others.min() >= 0 and others.max() <= 1 and (others != uv[:4]).any(axis=(1, 2)).all()


def test_a_packing_with_all_charts_locked_reports_their_density():
    vertices, faces, uv = scattered()
    packed = freebound.pack(vertices, faces, uv, pack=freebound.Pack(density=1e6), lock=np.ones(6, dtype=bool))
    assert (packed.corner_uv == uv).all()
    charts = [chart["density"] for chart in packed.report["packed_charts"]]
    assert min(charts) <= packed.report["packing"]["density"] <= max(charts)
    assert "wanted_density" not in packed.report["packing"]


def test_all_charts_of_a_given_layout_may_be_locked_although_they_overlap():
    vertices, faces, _ = grid(8, 6)
    twice = np.vstack([vertices, vertices + (2, 0, 0)]), np.vstack([faces, faces + len(vertices)])
    # Both sheets at one place, each sheared.
    uv = np.tile((vertices[:, :2] @ [[0.5, 0.0], [0.2, 0.5]])[faces].reshape(-1, 2), (2, 1))
    with pytest.raises(freebound.NotProved) as failure:
        freebound.flatten(*twice, layout=uv, charts="uv", relax=30, lock=True)
    layout = failure.value.layout
    first, second = np.array_split(layout.corner_uv, 2)
    assert np.allclose(first, second, atol=1e-9) and not layout.verdict.planar
    findings = layout.check(listed=10)["findings"]
    assert {finding["code"] for finding in findings} & {"overlap-of-charts", "stacked"}
    assert np.allclose(first.mean(axis=0), uv.mean(axis=0), atol=0.02)
    assert freebound.check(twice[0], twice[1], np.vstack([first, second + 3.0]))["planar"]
    # Without locks they are packed.
    assert freebound.flatten(*twice, layout=uv, charts="uv", relax=30).verdict.planar
    with pytest.raises(freebound.OptionError, match="lock"):
        freebound.flatten(*twice, layout=uv, charts="uv", lock="all")


def test_a_function_stops_a_packing_and_a_check():
    random = np.random.default_rng(5)
    low = random.random((40_000, 2))
    uv = (low[:, None] + 0.05 * random.random((40_000, 3, 2))).reshape(-1, 2)
    vertices, faces = np.column_stack([uv, np.zeros(len(uv))]), np.arange(len(uv)).reshape(-1, 3)
    calls = []

    def stop():
        calls.append(len(calls))
        return True

    for work, options in ((freebound.pack, {}), (freebound.check, {"listed": 10_000_000})):
        with pytest.raises(freebound.Cancelled):
            work(vertices, faces, uv, stop=stop, **options)
    assert calls == [0, 1]

    def broken():
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        freebound.pack(vertices, faces, uv, stop=broken)


def test_a_check_lists_as_many_faces_as_are_asked_for():
    vertices, faces, _ = grid(60, 40)
    # All faces lie on a line.
    uv = (vertices[:, :2] @ [[1, 0], [0.37, 0]])[faces].reshape(-1, 2)
    for listed, count in ((None, 1000), (7, 7), (10_000, len(faces))):
        found = freebound.check(vertices, faces, uv, listed=listed)["findings"]
        degenerate = next(finding for finding in found if finding["code"] == "degenerate")
        assert (degenerate["count"], len(degenerate["faces"])) == (len(faces), count)
    assert (freebound.charts(vertices, faces, vertices[faces].reshape(-1, 3)[:, :2]) == 0).all()
    with pytest.raises(freebound.OptionError, match="corner_uv"):
        freebound.charts(vertices, faces)
    with pytest.raises(freebound.OptionError, match="^listed: .*-1"):
        freebound.check(vertices, faces, uv, listed=-1)


def test_wrong_options_of_packing_are_refused():
    vertices, faces, uv = scattered()
    for options in ({"lock": [6]}, {"lock": [-1]}, {"lock": [True]}, {"lock": [0.5]}, {"aspect": 0}, {"precision": "f16"}):
        with pytest.raises(freebound.OptionError):
            freebound.pack(vertices, faces, uv, **options)
    with pytest.raises(freebound.OptionError, match="pass them"):
        freebound.pack(vertices, faces)
    with pytest.raises(freebound.InputError) as caught:
        freebound.pack(vertices, faces, np.where(np.arange(24)[:, None] < 4, np.nan, uv))
    assert caught.value.faults

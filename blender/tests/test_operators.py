# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators on twenty meshes, judged by Blender's own selection of overlaps and by the signs of its own triangles."""

import math

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")


@pytest.fixture(autouse=True)
def fresh():
    """An empty file with the extension."""
    import freebound_uv

    bpy.ops.wm.read_factory_settings(use_empty=True)
    freebound_uv.register()
    yield
    freebound_uv.unregister()


def edit(*objects):
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.select_all(action="DESELECT")
    for item in objects:
        item.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")


def in_object_mode():
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def uv_of(item):
    in_object_mode()
    layer = item.data.uv_layers.active
    values = np.empty(2 * len(layer.uv), dtype=np.float32)
    layer.uv.foreach_get("vector", values)
    return values.reshape(-1, 2)


def flips(item):
    """Triangles of Blender's own triangulation that are turned over."""
    uv = uv_of(item).astype(np.float64)
    mesh = item.data
    mesh.calc_loop_triangles()
    loops = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    a, b, c = uv[loops.reshape(-1, 3)].transpose(1, 0, 2)
    return int(((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0).sum())


def overlaps(*objects):
    """Corners that Blender selects as overlapping."""
    edit(*objects)
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    bpy.ops.uv.select_overlap()
    in_object_mode()
    count = 0
    for item in objects:
        attribute = item.data.attributes.get(".uv_select_vert")
        if attribute is not None:
            chosen = np.empty(len(attribute.data), dtype=bool)
            attribute.data.foreach_get("value", chosen)
            count += int(chosen.sum())
    return count


def mesh_of(vertices, faces, name="mesh"):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(vertex) for vertex in vertices], [], [tuple(face) for face in faces])
    item = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.objects.active = item
    return item


def primitive(name, **options):
    getattr(bpy.ops.mesh, f"primitive_{name}_add")(**options)
    return bpy.context.active_object


def wavy(columns=14, rows=11):
    x, y = np.meshgrid(np.arange(columns + 1) / columns, np.arange(rows + 1) / rows)
    vertices = np.column_stack([x.ravel(), y.ravel(), (0.2 * np.sin(5 * x) * np.cos(4 * y)).ravel()])
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + columns + 2, corner + columns + 1])
    return vertices, quads


def with_bevel(item):
    edit(item)
    bpy.ops.mesh.bevel(offset=0.1, segments=3)
    in_object_mode()
    return item


def with_inset(item):
    edit(item)
    bpy.ops.mesh.inset(thickness=0.1, use_individual=True)
    in_object_mode()
    return item


def with_dissolved(item):
    """Larger polygons."""
    edit(item)
    bpy.ops.mesh.dissolve_limited(angle_limit=math.radians(8))
    in_object_mode()
    return item


def house():
    """Concave polygons."""
    vertices = [(0, 0, 0), (4, 0, 0), (4, 3, 0), (2, 1.5, 0), (0, 3, 0)]
    top = [(x, y, 2) for x, y, _ in vertices]
    sides = [(k, (k + 1) % 5, (k + 1) % 5 + 5, k + 5) for k in range(5)]
    return mesh_of(vertices + top, [(4, 3, 2, 1, 0), (5, 6, 7, 8, 9), *sides], "house")


MESHES = {
    "cube": lambda: primitive("cube"),
    "sphere": lambda: primitive("uv_sphere"),
    "monkey": lambda: primitive("monkey"),
    "torus": lambda: primitive("torus"),
    "cone": lambda: primitive("cone"),
    "cylinder": lambda: primitive("cylinder"),
    "tube": lambda: primitive("cylinder", end_fill_type="NOTHING"),
    "plane": lambda: primitive("plane"),
    "circle": lambda: primitive("circle", fill_type="NGON", vertices=17),
    "grid": lambda: primitive("grid", x_subdivisions=20, y_subdivisions=15),
    "icosphere": lambda: primitive("ico_sphere", subdivisions=4),
    "wavy": lambda: mesh_of(*wavy()),
    "house": house,
    "bevelled": lambda: with_bevel(primitive("cube")),
    "inset": lambda: with_inset(primitive("ico_sphere", subdivisions=2)),
    "polygons": lambda: with_dissolved(primitive("monkey")),
    "scaled": lambda: primitive("cube", scale=(1, 5, 0.2)),
    "tiny": lambda: primitive("uv_sphere", radius=1e-4),
    "fan": lambda: primitive("circle", fill_type="TRIFAN", vertices=12),
    "coarse": lambda: primitive("uv_sphere", segments=5, ring_count=3),
}


@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_is_unwrapped_without_flips_and_overlaps(name):
    item = MESHES[name]()
    before = len(item.data.vertices), len(item.data.polygons)
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    verdict = bpy.context.window_manager.freebound_verdict
    assert "proved" in verdict
    assert bpy.context.mode == "EDIT_MESH"
    assert (flips(item), overlaps(item)) == (0, 0)
    uv = uv_of(item)
    assert uv.min() >= 0 and uv.max() <= 1
    assert before == (len(item.data.vertices), len(item.data.polygons)), "the topology stays"
    edit(item)
    assert bpy.ops.uv.freebound_check() == {"FINISHED"}
    assert "proved" in bpy.context.window_manager.freebound_verdict


@pytest.mark.parametrize("name", MESHES)
def test_every_operator_keeps_every_mesh_free_of_flips_and_overlaps(name):
    item = MESHES[name]()
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    near = uv_of(item)[0]
    calls = {
        "relax": {},
        "pack": {"margin": 8},
        "drag_pin": {"start": near, "target": near + 0.01},
        "check": {},
    }
    for operator, options in calls.items():
        edit(item)
        assert getattr(bpy.ops.uv, f"freebound_{operator}")(**options) == {"FINISHED"}, operator
        assert "proved" in bpy.context.window_manager.freebound_verdict, operator
        assert (flips(item), overlaps(item)) == (0, 0), operator


def pin(item, places):
    """Pins all corners of some vertices."""
    in_object_mode()
    mesh = item.data
    layer = mesh.uv_layers.active or mesh.uv_layers.new()
    for loop in mesh.loops:
        if loop.vertex_index in places:
            layer.uv[loop.index].vector = places[loop.vertex_index]
            layer.pin_ensure()
            layer.pin[loop.index].value = True


def test_pins_are_kept_to_the_last_bit():
    item = mesh_of(*wavy())
    places = {0: (0.1, 0.2), 14: (0.9, 0.15), 90: (0.45, 0.55), 179: (0.8, 0.9)}
    pin(item, places)
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    uv = uv_of(item)
    for loop in item.data.loops:
        if loop.vertex_index in places:
            expected = np.array(places[loop.vertex_index], dtype=np.float32)
            assert (uv[loop.index] == expected).all()
    assert (flips(item), overlaps(item)) == (0, 0)


def test_a_pinned_vertex_on_a_seam_is_kept_in_each_of_its_charts():
    item = mesh_of(*wavy())
    in_object_mode()
    for edge in item.data.edges:
        x = [item.data.vertices[vertex].co.x for vertex in edge.vertices]
        edge.use_seam = all(abs(place - 0.5) < 1e-6 for place in x)
    mesh = item.data
    layer = mesh.uv_layers.new()
    layer.pin_ensure()
    expected = {}
    for face in mesh.polygons:
        side = 0.4 if face.center.x < 0.5 else 0.6
        for loop in face.loop_indices:
            at = mesh.vertices[mesh.loops[loop].vertex_index].co
            if abs(at.x - 0.5) < 1e-6 and at.y in (0, 1):
                expected[loop] = np.array((side, 0.1 + 0.8 * at.y), dtype=np.float32)
                layer.uv[loop].vector = expected[loop]
                layer.pin[loop].value = True
    assert len(expected) == 4
    edit(item)
    assert bpy.ops.uv.freebound_unwrap(adds_seams=False) == {"FINISHED"}
    uv = uv_of(item)
    assert all((uv[loop] == place).all() for loop, place in expected.items())
    assert (flips(item), overlaps(item)) == (0, 0)
    # Charts that their pins lay upon each other are refused by name, and nothing changes.
    for loop in expected:
        mesh.uv_layers.active.uv[loop].vector.x = 0.5
    before = uv_of(item)
    edit(item)
    with pytest.raises(RuntimeError, match="overlap"):
        bpy.ops.uv.freebound_unwrap(adds_seams=False)
    assert (uv_of(item) == before).all()


def test_a_group_makes_pins_soft():
    item = mesh_of(*wavy())
    pin(item, {0: (0, 0), 14: (1, 0), 90: (0.9, 0.1)})
    item.vertex_groups.new(name="soft").add([90], 0.5, "REPLACE")
    edit(item)
    assert bpy.ops.uv.freebound_unwrap(soft_pins="soft") == {"FINISHED"}
    uv = uv_of(item)
    at = [uv[loop.index] for loop in item.data.loops if loop.vertex_index == 90]
    assert not np.allclose(at[0], (0.9, 0.1), atol=1e-3)


def test_marked_seams_are_used_and_no_others_are_added_unless_asked_for():
    item = primitive("cube")
    in_object_mode()
    for edge in item.data.edges:
        edge.use_seam = True
    edit(item)
    assert bpy.ops.uv.freebound_unwrap(adds_seams=False) == {"FINISHED"}
    assert bpy.context.window_manager.freebound_verdict.startswith("6 charts")
    ball = primitive_in_object_mode("uv_sphere")
    edit(ball)
    assert bpy.ops.uv.freebound_unwrap(marks_seams=False) == {"FINISHED"}
    in_object_mode()
    assert not any(edge.use_seam for edge in ball.data.edges)
    edit(ball)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    in_object_mode()
    assert any(edge.use_seam for edge in ball.data.edges)


def primitive_in_object_mode(name):
    in_object_mode()
    return primitive(name)


def test_only_selected_faces_change():
    item = primitive("grid", x_subdivisions=8, y_subdivisions=8)
    layer = item.data.uv_layers.active or item.data.uv_layers.new()
    layer.uv.foreach_set("vector", np.full(2 * len(layer.uv), 0.25, dtype=np.float32))
    edit(item)
    bpy.ops.mesh.select_all(action="DESELECT")
    in_object_mode()
    chosen = np.arange(len(item.data.polygons)) < 20
    item.data.polygons.foreach_set("select", chosen)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    uv = uv_of(item).reshape(-1, 4, 2)
    assert (uv[20:] == 0.25).all() and not (uv[:20] == 0.25).all()


def test_all_objects_in_edit_mode_share_one_picture():
    first, second = primitive("cube"), primitive_in_object_mode("uv_sphere")
    second.location.x = 5
    bpy.context.view_layer.update()
    edit(first, second)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    assert flips(first) == flips(second) == 0
    assert overlaps(first, second) == 0
    assert min(uv_of(first).min(), uv_of(second).min()) >= 0


def test_the_active_of_two_maps_is_written_and_linked_data_once():
    item = primitive("cube")
    in_object_mode()
    mesh = item.data
    other = mesh.uv_layers.active or mesh.uv_layers.new(name="first")
    other.uv.foreach_set("vector", np.full(2 * len(other.uv), 0.5, dtype=np.float32))
    mesh.uv_layers.active = mesh.uv_layers.new(name="second")
    assert (uv_of(item) == 0.5).all(), "a new map is a copy"
    twin = bpy.data.objects.new("twin", mesh)
    bpy.context.scene.collection.objects.link(twin)
    edit(item, twin)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    in_object_mode()
    values = np.empty(2 * len(mesh.loops), dtype=np.float32)
    mesh.uv_layers[0].uv.foreach_get("vector", values)
    assert (values == 0.5).all()
    assert uv_of(item).std() > 0.1
    assert flips(item) == 0 and overlaps(item) == 0


def test_a_check_selects_what_is_wrong():
    item = primitive("grid", x_subdivisions=6, y_subdivisions=6)
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    in_object_mode()
    layer = item.data.uv_layers.active
    inner = next(vertex.index for vertex in item.data.vertices if abs(vertex.co.x) < 0.2 and abs(vertex.co.y) < 0.2)
    for loop in item.data.loops:
        if loop.vertex_index == inner:
            layer.uv[loop.index].vector.x += 0.4
    edit(item)
    assert bpy.ops.uv.freebound_check() == {"FINISHED"}
    assert "Not one-to-one" in bpy.context.window_manager.freebound_verdict
    in_object_mode()
    chosen = [face.index for face in item.data.polygons if face.select]
    assert 0 < len(chosen) < len(item.data.polygons)


def test_a_check_selects_mirrored_charts_and_corners_without_numbers():
    item = primitive("grid", x_subdivisions=3, y_subdivisions=3)
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    uv = uv_of(item)
    uv[:, 0] = 1 - uv[:, 0]
    item.data.uv_layers.active.uv.foreach_set("vector", uv.ravel())
    edit(item)
    assert bpy.ops.uv.freebound_check() == {"FINISHED"}
    assert "mirrored" in bpy.context.window_manager.freebound_verdict
    in_object_mode()
    item.data.uv_layers.active.uv[0].vector.x = float("nan")
    edit(item)
    assert bpy.ops.uv.freebound_check() == {"FINISHED"}
    assert bpy.context.window_manager.freebound_verdict.startswith("Not one-to-one")


def test_objects_that_are_not_edited_stay_out_of_edit_mode():
    first, second = primitive("cube"), primitive_in_object_mode("cone")
    edit(first)
    second.select_set(True)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    assert list(bpy.context.objects_in_mode) == [first] and second.select_get()


def test_a_run_that_fails_changes_nothing():
    item = mesh_of([(0, 0, 0), (1, 0, 0), (1, 0, 1)], [(0, 1, 2)])
    item.scale = (1, 1, 0)
    bpy.context.view_layer.update()
    edit(item)
    with pytest.raises(RuntimeError, match="scale"):
        bpy.ops.uv.freebound_unwrap()
    in_object_mode()
    assert not item.data.uv_layers


def test_a_mesh_that_changed_during_a_run_is_left_alone():
    from freebound_uv import meshes

    item = primitive("cube")
    edit(item)
    selection = meshes.gather(bpy.context)
    bpy.ops.mesh.subdivide()
    with pytest.raises(meshes.Changed):
        meshes.write(bpy.context, selection, selection.uv)
    assert bpy.context.mode == "EDIT_MESH"


class Fake:
    """Parts of a context that a modal operator uses, and what was told to them."""

    def __init__(self):
        self.window = self
        self.workspace = self
        self.window_manager = bpy.context.window_manager
        self.said = []

    def status_text_set(self, text):
        self.said.append(text)


def test_a_modal_run_tells_its_progress_and_ends_by_escape():
    from types import SimpleNamespace

    import freebound
    from freebound_uv import operators
    from freebound_uv.tasks import Task

    class Timers:
        removed = 0

        def event_timer_remove(self, timer):
            Timers.removed += 1

    x, y = np.meshgrid(np.arange(400) / 40, np.arange(400) / 40)
    vertices = np.column_stack([x.ravel(), y.ravel(), np.sin(x.ravel()) * np.cos(y.ravel())])
    first = (np.arange(399)[:, None] * 400 + np.arange(399)).ravel()
    faces = np.column_stack([first, first + 1, first + 401, first + 400])
    reports = []
    run = operators.Run()
    run.report = lambda kind, text: reports.append(text)
    run._workspace, run._timer = Fake(), object()
    job = freebound.start(vertices, faces, unwrap=True, distortion=4.0001)
    run._task = operators.Run.running = Task(lambda task: task.run("Unwrapping", job))
    context = SimpleNamespace(window_manager=Timers())
    assert run.modal(context, SimpleNamespace(type="TIMER", value="NOTHING")) == {"PASS_THROUGH"}
    assert "Esc cancels" in run._workspace.said[-1]
    assert run.modal(context, SimpleNamespace(type="LEFTMOUSE", value="PRESS")) == {"RUNNING_MODAL"}
    assert run.modal(context, SimpleNamespace(type="ESC", value="RELEASE")) == {"RUNNING_MODAL"}
    assert not job.done
    assert run.modal(context, SimpleNamespace(type="ESC", value="PRESS")) == {"RUNNING_MODAL"}
    while not run._task.wait(0.05):
        assert run.modal(context, SimpleNamespace(type="TIMER", value="NOTHING")) == {"PASS_THROUGH"}
    assert run.modal(context, SimpleNamespace(type="TIMER", value="NOTHING")) == {"CANCELLED"}
    assert reports == ["Cancelled"] and run._workspace.said[-1] is None
    assert Timers.removed == 1 and operators.Run.running is None


def test_a_picture_that_is_not_square_keeps_the_shapes_of_faces():
    import freebound
    from freebound_uv.solving import Sheet

    vertices, quads = wavy()
    vertices[:, 2] = 0
    sheet = Sheet((2048, 1024), 4)
    layout = freebound.unwrap(vertices, quads, precision="f32", **sheet.options)
    packed = freebound.pack(vertices, quads, layout.corner_uv, pack=sheet.pack)
    for uv in (layout.corner_uv, packed.corner_uv):
        side = np.diff(uv.reshape(-1, 4, 2)[:, :3], axis=1) * (2048, 1024)
        lengths = np.linalg.norm(side, axis=2)
        assert np.allclose(lengths[:, 0] / lengths[:, 1], (1 / 14) / (1 / 11), rtol=1e-3)


def two_sheets():
    """Two wavy sheets of one object beside each other. The faces of the second are the later half."""
    vertices, quads = wavy()
    item = mesh_of(np.vstack([vertices, vertices + (2, 0, 0)]), np.vstack([quads, quads + len(vertices)]))
    return item, len(quads)


def lay(item, of_corner):
    """Coordinates of all corners, by a function of the vertex's place and the face."""
    in_object_mode()
    mesh = item.data
    layer = mesh.uv_layers.active or mesh.uv_layers.new()
    values = np.empty((len(mesh.loops), 2), dtype=np.float32)
    for face in mesh.polygons:
        for loop in face.loop_indices:
            values[loop] = of_corner(mesh.vertices[mesh.loops[loop].vertex_index].co, face.index)
    layer.uv.foreach_set("vector", values.ravel())
    return values


def select_faces(item, chosen):
    edit(item)
    bpy.ops.mesh.select_all(action="DESELECT")
    in_object_mode()
    item.data.polygons.foreach_set("select", chosen)
    bpy.ops.object.mode_set(mode="EDIT")


def test_charts_are_packed_around_faces_that_are_not_selected():
    item, half = two_sheets()
    corner = 4 * half
    lay(item, lambda co, face: (0.5 * co.x, 0.5 * co.y) if face < half else (0.1, 0.1))
    before = uv_of(item)
    chosen = np.arange(2 * half) >= half
    select_faces(item, chosen)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    assert "around the others" in bpy.context.window_manager.freebound_verdict
    uv = uv_of(item)
    assert (uv[:corner] == before[:corner]).all()
    assert uv.min() >= 0 and uv.max() <= 1 and (flips(item), overlaps(item)) == (0, 0)
    # The new chart has no more texels than the other.
    areas = [np.prod(np.ptp(part, axis=0)) for part in (uv[:corner], uv[corner:])]
    assert areas[1] < 1.3 * areas[0]
    # Packed alone, it fills the picture.
    select_faces(item, chosen)
    assert bpy.ops.uv.freebound_unwrap(is_around=False) == {"FINISHED"}
    assert (uv_of(item)[:corner] == before[:corner]).all() and np.ptp(uv_of(item)[corner:], axis=0).max() > 0.9


def test_a_single_chart_keeps_the_margin_to_the_edge_of_the_picture():
    item = mesh_of(*wavy())
    edit(item)
    assert bpy.ops.uv.freebound_unwrap(margin=64) == {"FINISHED"}
    uv = uv_of(item)
    # Half the margin, of 1024 pixels.
    assert uv.min() >= 0.03125 and uv.max() <= 1 - 0.03125


def energy(item):
    import freebound
    from freebound_uv import meshes

    edit(item)
    selection = meshes.gather(bpy.context)
    layout = freebound.flatten(
        selection.vertices, selection.faces(), layout=selection.uv, charts="uv", relax=0, new_vertices=False
    )
    return layout.energy


def test_relaxing_lowers_the_distortion_and_keeps_pins_and_places():
    item, half = two_sheets()
    lay(item, lambda co, face: (0.4 * co.x, 0.2 * co.y) if face < half else (1.4 - 0.4 * co.y, 0.2 * co.x))
    pinned = {0: (0.0, 0.0), 14: (0.4, 0.0)}
    pin(item, pinned)
    before, corner = uv_of(item), 4 * half
    was = energy(item)
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    uv = uv_of(item)
    assert energy(item) < was - 0.3
    for loop in item.data.loops:
        if loop.vertex_index in pinned:
            assert (uv[loop.index] == before[loop.index]).all()
    assert (flips(item), overlaps(item)) == (0, 0)
    # The chart without pins stays about its place.
    assert np.allclose(uv[corner:].mean(axis=0), before[corner:].mean(axis=0), atol=0.02)


def test_a_relaxed_chart_that_would_cover_others_is_packed_beside_them():
    item, half = two_sheets()
    # Stretched, the first sheet just leaves room for the second.
    lay(item, lambda co, face: (0.45 * co.x, 0.9 * co.y) if face < half else (0.46 + 0.2 * (co.x - 2), 0.2 * co.y))
    before, corner = uv_of(item), 4 * half
    select_faces(item, np.arange(2 * half) < half)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    assert "1 moved" in bpy.context.window_manager.freebound_verdict
    assert (uv_of(item)[corner:] == before[corner:]).all()
    assert (flips(item), overlaps(item)) == (0, 0)


def test_packing_moves_whole_charts_and_leaves_pinned_ones():
    item, half = two_sheets()
    lay(item, lambda co, face: (0.3 * co.x, 0.3 * co.y) if face < half else (0.3 * (co.x - 2), 0.3 * co.y))
    pin(item, {0: (0.0, 0.0)})
    before, corner = uv_of(item), 4 * half
    edit(item)
    assert bpy.ops.uv.freebound_pack() == {"FINISHED"}
    uv = uv_of(item)
    assert (uv[:corner] == before[:corner]).all() and (uv[corner:] != before[corner:]).any()
    assert (flips(item), overlaps(item)) == (0, 0)
    assert "1 chart packed, 1 stayed" in bpy.context.window_manager.freebound_verdict


def test_packing_may_keep_the_sizes_of_charts():
    item, half = two_sheets()
    lay(item, lambda co, face: (0.4 * co.x, 0.4 * co.y) if face < half else (0.1 * (co.x - 2), 0.1 * co.y))
    corner = 4 * half

    def ratio():
        uv = uv_of(item)
        side = [np.linalg.norm(part[1] - part[0]) for part in (uv[:corner], uv[corner:])]
        return side[0] / side[1]

    edit(item)
    assert bpy.ops.uv.freebound_pack(keeps_sizes=True) == {"FINISHED"}
    assert abs(ratio() - 4) < 1e-4
    edit(item)
    assert bpy.ops.uv.freebound_pack() == {"FINISHED"}
    assert abs(ratio() - 1) < 1e-4


def test_relaxing_and_packing_need_a_map():
    item = mesh_of(*wavy())
    for operator in (bpy.ops.uv.freebound_relax, bpy.ops.uv.freebound_pack):
        edit(item)
        with pytest.raises(RuntimeError, match="UV map"):
            operator()


def flat_sheet():
    item = mesh_of(*wavy())
    lay(item, lambda co, face: (0.2 + 0.6 * co.x, 0.2 + 0.6 * co.y))
    return item


def test_a_dragged_corner_takes_the_chart_along_and_pins_stay():
    item = flat_sheet()
    pinned = {0: (0.2, 0.2), 179: (0.8, 0.8)}
    pin(item, pinned)
    edit(item)
    to = (0.62, 0.47)
    assert bpy.ops.uv.freebound_drag_pin(start=(0.5, 0.5), target=to) == {"FINISHED"}
    assert "proved" in bpy.context.window_manager.freebound_verdict
    uv = uv_of(item)
    at = np.linalg.norm(uv - np.array(to), axis=1).min()
    assert at < 1e-6 and (flips(item), overlaps(item)) == (0, 0)
    for loop in item.data.loops:
        if loop.vertex_index in pinned:
            assert (uv[loop.index] == np.array(pinned[loop.vertex_index], dtype=np.float32)).all()
    # The dragged corner is pinned now, in each of its faces.
    layer = item.data.uv_layers.active
    is_pinned = np.array([entry.value for entry in layer.pin])
    assert is_pinned.sum() == 1 + 1 + 4


def test_a_corner_that_is_dragged_beyond_the_chart_stops_before_faces_flip():
    item = flat_sheet()
    pin(item, {0: (0.2, 0.2), 14: (0.8, 0.2), 165: (0.2, 0.8), 179: (0.8, 0.8)})
    edit(item)
    assert bpy.ops.uv.freebound_drag_pin(start=(0.5, 0.5), target=(3, 0.5)) == {"FINISHED"}
    assert (flips(item), overlaps(item)) == (0, 0)


def test_a_chart_that_overlaps_itself_is_not_dragged():
    item = mesh_of(*wavy())
    lay(item, lambda co, face: (abs(co.x - 0.5), co.y))
    edit(item)
    with pytest.raises(RuntimeError, match="unwrap or relax it first"):
        bpy.ops.uv.freebound_drag_pin(start=(0.2, 0.5), target=(0.3, 0.5))


def test_a_chart_with_holes_is_dragged():
    item = primitive("monkey")
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    uv = uv_of(item)
    near = uv[len(uv) // 2]
    edit(item)
    assert bpy.ops.uv.freebound_drag_pin(start=near, target=near + 0.01) == {"FINISHED"}
    assert (flips(item), overlaps(item)) == (0, 0)
    assert (uv_of(item) != uv).any()


class View:
    """View of 1000 pixels for the unit square."""

    def view_to_region(self, x, y, clip=True):
        return (1000 * x, 1000 * y)

    def region_to_view(self, x, y):
        return (x / 1000, y / 1000)


def dragging(item):
    """Drag of a person, with a context that stands for the window's."""
    from types import SimpleNamespace

    from freebound_uv import dragging

    charts = SimpleNamespace(type="WINDOW", x=100, y=50, width=1000, height=1000, view2d=View())
    panel = SimpleNamespace(type="UI", x=900, y=50, width=200, height=1000)
    context = SimpleNamespace(
        mode="EDIT_MESH",
        objects_in_mode=[item],
        objects_in_mode_unique_data=[item],
        view_layer=bpy.context.view_layer,
        area=SimpleNamespace(type="IMAGE_EDITOR", regions=[panel, charts]),
        space_data=None,
        tool_settings=SimpleNamespace(use_uv_select_sync=True),
        window=SimpleNamespace(cursor_set=lambda name: None),
        workspace=Fake(),
        window_manager=SimpleNamespace(
            modal_handler_add=lambda operator: None,
            event_timer_add=lambda seconds, window: "timer",
            event_timer_remove=lambda timer: None,
            freebound_verdict="",
            freebound_is_fine=False,
        ),
    )
    kind = dragging.FREEBOUND_OT_drag_pin
    drag = SimpleNamespace(pins=True, said=[], bl_label=kind.bl_label)
    for name, method in vars(kind).items():
        if callable(method) and name not in ("poll", "execute", "cancel"):
            setattr(drag, name, lambda *given, method=method: method(drag, *given))
    drag.report = lambda kind, text: drag.said.append(text)

    def event(kind, value, x, y):
        return SimpleNamespace(type=kind, value=value, mouse_x=x + 100, mouse_y=y + 50, ctrl=False, oskey=False)

    return drag, context, event


def dragging_loops(drag):
    """Corners again after a visit to object mode."""
    from freebound_uv import dragging

    return dragging._EditedLoops(drag._selection, drag._grab)


def test_a_chart_that_is_dragged_over_another_is_told():
    item, half = two_sheets()
    lay(item, lambda co, face: (0.4 * co.x, 0.4 * co.y) if face < half else (0.5 + 0.4 * (co.x - 2), 0.4 * co.y))
    edit(item)
    assert bpy.ops.uv.freebound_drag_pin(start=(0.2, 0.2), target=(0.6, 0.2)) == {"FINISHED"}
    assert "Pack" in bpy.context.window_manager.freebound_verdict
    assert not bpy.context.window_manager.freebound_is_fine


def test_a_person_drags_corners_one_after_another_and_each_stays_pinned():
    item = flat_sheet()
    edit(item)
    drag, context, event = dragging(item)
    # From a button of the panel.
    assert drag.invoke(context, event("LEFTMOUSE", "RELEASE", 850, 500)) == {"RUNNING_MODAL"}
    for near, to in (((500, 475), (690, 450)), ((400, 600), (340, 670))):
        uv = 1000 * uv_of(item)
        x, y = uv[np.linalg.norm(uv - near, axis=1).argmin()].round().astype(int)
        edit(item)
        assert drag.modal(context, event("LEFTMOUSE", "PRESS", x, y)) == {"RUNNING_MODAL"}
        for step in range(11):
            place = (x + (to[0] - x) * step // 10, y + (to[1] - y) * step // 10)
            assert drag.modal(context, event("MOUSEMOVE", "NOTHING", *place)) == {"RUNNING_MODAL"}
            assert drag.modal(context, event("TIMER", "NOTHING", *place)) == {"PASS_THROUGH"}
        assert drag.modal(context, event("LEFTMOUSE", "RELEASE", *to)) == {"RUNNING_MODAL"}
    assert drag.modal(context, event("WHEELUPMOUSE", "PRESS", 500, 500)) == {"PASS_THROUGH"}
    assert drag.modal(context, event("RET", "PRESS", 500, 500)) == {"CANCELLED"}, "the drags are steps of undo"
    uv = uv_of(item)
    for to in ((0.69, 0.45), (0.34, 0.67)):
        assert np.linalg.norm(uv - to, axis=1).min() < 1e-6
    assert (flips(item), overlaps(item)) == (0, 0)
    is_pinned = np.array([entry.value for entry in item.data.uv_layers.active.pin])
    assert np.allclose(np.unique(uv[is_pinned], axis=0), [(0.34, 0.67), (0.69, 0.45)])


def test_a_drag_that_is_put_back_leaves_every_coordinate_as_it_was():
    item = flat_sheet()
    before = uv_of(item)
    edit(item)
    drag, context, event = dragging(item)
    drag.invoke(context, event("RET", "PRESS", 0, 0))
    drag.modal(context, event("LEFTMOUSE", "PRESS", 503, 475))
    drag.modal(context, event("MOUSEMOVE", "NOTHING", 640, 450))
    drag.modal(context, event("TIMER", "NOTHING", 640, 450))
    assert (uv_of(item) != before).any()
    edit(item)
    drag._loops = dragging_loops(drag)
    assert drag.modal(context, event("ESC", "PRESS", 640, 450)) == {"RUNNING_MODAL"}
    assert (uv_of(item) == before).all() and not len(item.data.uv_layers.active.pin)
    edit(item)
    assert drag.modal(context, event("LEFTMOUSE", "PRESS", 50, 750)) == {"RUNNING_MODAL"}
    assert drag.said[-1] == "Press on a corner of a chart"
    # A click on the panel ends the drag and reaches the panel.
    assert drag.modal(context, event("LEFTMOUSE", "PRESS", 850, 500)) == {"CANCELLED", "PASS_THROUGH"}
    assert context.workspace.said[-1] is None


def verdict():
    """Words of the panel, and True if nothing is wrong."""
    manager = bpy.context.window_manager
    return manager.freebound_verdict, manager.freebound_is_fine


def sheets(count):
    """Wavy sheets of one object in a row, and the number of faces of each."""
    vertices, quads = wavy()
    places = [vertices + (2 * k, 0, 0) for k in range(count)]
    return mesh_of(np.vstack(places), np.vstack([quads + k * len(vertices) for k in range(count)])), len(quads)


def lay_sheets(item, half, *places):
    """Lays sheet k at a place (u, v, width, height). A negative width mirrors it."""

    def of_corner(co, face):
        u, v, width, height = places[face // half]
        return u + width * (co.x - 2 * (face // half)), v + height * co.y

    return lay(item, of_corner)


@pytest.mark.parametrize("operator", ["relax", "unwrap", "pack"])
def test_overlaps_with_faces_that_are_not_selected_are_told(operator):
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.2, 0.2, 0.4, 0.4))
    # Pins hold the selected sheet on the other.
    pin(item, {0: (0.0, 0.0), 14: (0.4, 0.0)})
    select_faces(item, np.arange(2 * half) < half)
    assert getattr(bpy.ops.uv, f"freebound_{operator}")() == {"FINISHED"}
    text, is_fine = verdict()
    assert not is_fine and "no overlaps" not in text and "Check" in text
    assert bpy.ops.uv.freebound_check() == {"FINISHED"}
    in_object_mode()
    chosen = np.array([face.select for face in item.data.polygons])
    assert chosen[:half].any() and chosen[half:].any() and not chosen.all()


def test_a_selected_chart_below_an_equal_one_overlaps_it():
    item, half = sheets(2)
    lay_sheets(item, half, (0.1, 0.1, 0.3, 0.3), (0.1, 0.1, 0.3, 0.3))
    uv = uv_of(item)
    uv[4 * half :] = uv[: 4 * half]
    item.data.uv_layers.active.uv.foreach_set("vector", uv.ravel())
    vertices = len(item.data.vertices) // 2
    pin(item, {0: (0.1, 0.1), 14: (0.4, 0.1), vertices: (0.1, 0.1), vertices + 14: (0.4, 0.1)})
    for is_first in (True, False):
        select_faces(item, (np.arange(2 * half) < half) == is_first)
        assert bpy.ops.uv.freebound_pack() == {"FINISHED"}
        text, is_fine = verdict()
        assert not is_fine and "nothing" not in text and "Selected faces overlap" in text


def test_a_verdict_that_leaves_others_out_says_so():
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.9, 0.9), (0.1, 0.1, 0.3, 0.3))
    select_faces(item, np.arange(2 * half) < half)
    assert bpy.ops.uv.freebound_relax(is_around=False) == {"FINISHED"}
    assert "no overlaps of the selected: proved" in verdict()[0]


def test_overlaps_of_other_faces_alone_leave_the_proof_of_the_selected():
    item, half = sheets(3)
    lay_sheets(item, half, (0, 0, 0.3, 0.3), (0.5, 0.5, 0.3, 0.3), (0.6, 0.6, 0.3, 0.3))
    select_faces(item, np.arange(3 * half) < half)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    text, is_fine = verdict()
    assert not is_fine and "selected faces overlap nothing: proved" in text


@pytest.mark.parametrize("is_around", [True, False])
def test_soft_pins_hold_their_chart_in_place(is_around):
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.6, 0.6, 0.3, 0.3))
    soft = {0: (0.1, 0.1), 14: (0.4, 0.1), 165: (0.1, 0.4)}
    pin(item, soft)
    item.vertex_groups.new(name="soft").add(list(soft), 0.9, "REPLACE")
    select_faces(item, np.arange(2 * half) < half)
    assert bpy.ops.uv.freebound_unwrap(soft_pins="soft", is_around=is_around) == {"FINISHED"}
    uv = uv_of(item)
    for loop in item.data.loops:
        if loop.vertex_index in soft:
            assert np.linalg.norm(uv[loop.index] - soft[loop.vertex_index]) < 0.05


def test_a_group_that_is_not_there_is_named():
    item = mesh_of(*wavy())
    edit(item)
    with pytest.raises(RuntimeError, match="no vertex group lips"):
        bpy.ops.uv.freebound_unwrap(soft_pins="lips")
    assert verdict()[1] is False


def test_only_charts_that_come_to_overlap_are_moved_by_relaxing():
    item, half = sheets(3)
    # The first is stretched, and would grow over the second.
    lay_sheets(item, half, (0, 0, 0.2, 0.9), (0.21, 0.4, 0.2, 0.17), (0.7, 0.7, 0.2, 0.17))
    before, corner = uv_of(item), 4 * half
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    text, is_fine = verdict()
    assert is_fine and "3 charts relaxed, 1 moved, no overlaps: proved" in text
    assert (flips(item), overlaps(item)) == (0, 0)
    uv = uv_of(item)
    shift = [np.linalg.norm((uv - before)[k * corner : (k + 1) * corner].mean(axis=0)) for k in range(3)]
    assert shift[0] > 0.05 and max(shift[1:]) < 1e-3, "the one that grew moves"
    sides = [np.linalg.norm(uv[k * corner + 1] - uv[k * corner]) for k in (1, 2)]
    assert abs(sides[0] / sides[1] - 1) < 1e-3, "sizes stay"


def test_mirrored_and_stacked_charts_stay_so():
    item, half = sheets(3)
    lay_sheets(item, half, (0.5, 0, -0.4, 0.3), (0.5, 0.5, 0.4, 0.3), (0.5, 0.5, 0.4, 0.3))
    corner = 4 * half
    before = uv_of(item)
    before[2 * corner :] = before[corner : 2 * corner]
    item.data.uv_layers.active.uv.foreach_set("vector", before.ravel())
    was = energy_of_sheet(item, half)
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    assert "moved" not in verdict()[0]
    uv = uv_of(item)
    assert flips(item) == 2 * half and energy_of_sheet(item, half) < was
    assert (uv[corner : 2 * corner] == uv[2 * corner :]).all()
    assert np.allclose(uv[:corner].mean(axis=0), before[:corner].mean(axis=0), atol=0.02)


def energy_of_sheet(item, half):
    """Energy of the mirror image of the first sheet."""
    import freebound

    vertices, quads = wavy()
    uv = uv_of(item)[: 4 * half].astype(np.float64) * (-1, 1)
    return freebound.flatten(vertices, quads, layout=uv, relax=0, new_vertices=False).energy


def test_two_sides_of_a_face_that_lie_apart_stay_apart():
    item = mesh_of([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3), (0, 3, 2, 1)])
    square = np.array([(0, 0), (0.3, 0), (0.3, 0.3), (0, 0.3)])
    uv = np.vstack([square + 0.1, square + 0.55])
    item.data.uv_layers.new().uv.foreach_set("vector", uv.ravel())
    before = uv_of(item)
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"} and verdict()[1]
    assert np.allclose(uv_of(item), before, atol=1e-6) and overlaps(item) == 0


def stacked_pair(*third):
    """Two sheets at one place, and others."""
    item, half = sheets(2 + len(third))
    lay_sheets(item, half, *[(0.2, 0.05, 0.19, 0.6)] * 2, *third)
    uv = uv_of(item)
    uv[4 * half : 8 * half] = uv[: 4 * half]
    item.data.uv_layers.active.uv.foreach_set("vector", uv.ravel())
    return item, half


def test_a_stack_that_collides_moves_as_a_whole():
    item, half = stacked_pair((0.4, 0.05, 0.05, 0.6))
    corner = 4 * half
    before = uv_of(item)
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    uv = uv_of(item)
    assert (uv[:corner] == uv[corner : 2 * corner]).all() and "1 moved" in verdict()[0]
    # Apart from the stack itself nothing overlaps.
    uv[corner : 2 * corner] += 3
    item.data.uv_layers.active.uv.foreach_set("vector", uv.ravel())
    assert overlaps(item) == 0 and (uv != before).any()


def test_a_stack_follows_its_pinned_or_unselected_member():
    item, half = stacked_pair()
    corner = 4 * half
    before = uv_of(item)
    select_faces(item, np.arange(2 * half) >= half)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    assert (uv_of(item) == before).all(), "a stack with faces that are not selected stays"
    pin(item, {len(item.data.vertices) // 2: (0.2, 0.05)})
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    uv = uv_of(item)
    assert (uv != before).any() and (uv[:corner] == uv[corner:]).all()


def test_a_moved_chart_keeps_its_size_even_if_there_is_no_room():
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.6, 0.97), (0.61, 0, 0.37, 1))
    corner = 4 * half
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    text, is_fine = verdict()
    assert not is_fine and "no room" in text and "no overlaps: proved" in text
    uv = uv_of(item)
    sides = [np.linalg.norm(np.diff(own.reshape(-1, 4, 2), axis=1), axis=2).sum() for own in (uv[:corner], uv[corner:])]
    assert 0.7 < sides[0] / sides[1] < 1.3 and overlaps(item) == 0


def test_charts_in_one_box_that_did_not_overlap_count_as_colliding():
    root = 3**0.5 / 2
    item = mesh_of(
        [(0, 0, 0), (1, 0, 0), (0.5, root, 0), (2, 0, 0), (3, 0, 0), (2.5, root, 0)], [(0, 1, 2), (3, 4, 5)]
    )
    uv = np.array([(0.2, 0.2), (0.6, 0.2), (0.6, 0.6), (0.2, 0.2), (0.6, 0.6), (0.2, 0.6)])
    item.data.uv_layers.new().uv.foreach_set("vector", uv.ravel())
    edit(item)
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    assert "1 moved" in verdict()[0] and verdict()[1] and overlaps(item) == 0


def places_of(item):
    """Places of each vertex."""
    uv, places = uv_of(item), {}
    for loop in item.data.loops:
        places.setdefault(loop.vertex_index, set()).add(tuple(uv[loop.index].tolist()))
    return places


def test_faces_without_a_place_and_charts_that_touch_at_a_vertex_hold_what_they_share():
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 2, 0), (2.5, 1, 0), (1, 2, 0)]
    first = [(0.1, 0.1), (0.4, 0.1), (0.5, 0.3), (0.1, 0.3)]
    for others, chosen in (
        ([(0.5, 0.3)] * 3, [True, False]),
        ([(0.5, 0.3)] * 3, [True, True]),
        ([(0.5, 0.3), (0.9, 0.3), (float("nan"), 0.4)], [True, False]),
        ([(0.5, 0.3), (0.9, 0.3), (0.9, 0.4)], [True, True]),
    ):
        item = mesh_of(corners, [(0, 1, 2, 3), (2, 4, 5)])
        item.data.uv_layers.new().uv.foreach_set("vector", np.array(first + others).ravel())
        select_faces(item, chosen)
        assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
        text, is_fine = verdict()
        has_place = (0.9, 0.4) in others
        assert is_fine and "inf" not in text and ("1 face is not unwrapped yet" in text) != has_place
        assert len(places_of(item)[2]) == 1


def test_the_last_face_of_a_new_map_does_not_count():
    item = primitive("cube")
    in_object_mode()
    while item.data.uv_layers:
        item.data.uv_layers.remove(item.data.uv_layers[0])
    item.data.uv_layers.new()
    # Otherwise the last face is selected with its vertices.
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    select_faces(item, np.arange(6) < 5)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    assert verdict()[1] and "1 face is not unwrapped yet" in verdict()[0]
    assert uv_of(item).max() <= 1


def test_a_flat_mesh_may_be_scaled_to_nothing_across():
    item = primitive("grid", x_subdivisions=3, y_subdivisions=3)
    item.scale = (1, 1, 0)
    bpy.context.view_layer.update()
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"} and verdict()[1]


def test_faces_with_infinite_coordinates_are_left_out():
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.5, 0.5, 0.4, 0.4))
    uv = uv_of(item)
    uv[3] = np.inf
    item.data.uv_layers.active.uv.foreach_set("vector", uv.ravel())
    edit(item)
    assert bpy.ops.uv.freebound_pack() == {"FINISHED"}
    assert "1 face is not unwrapped yet" in verdict()[0]


def test_a_margin_that_does_not_fit_is_told():
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.5, 0.5, 0.4, 0.4))
    from freebound_uv import meshes, solving
    from freebound_uv.tasks import Task

    edit(item)
    selection = meshes.gather(bpy.context, needs_uv=True, is_around=True)
    for margin, is_met in ((4, True), (80, False)):
        sheet = solving.Sheet((96, 96), margin)
        done = Task(lambda task, sheet=sheet: solving.pack(task, selection, sheet, False)).result()
        assert ("margin" not in done.warning) == is_met, done


def test_an_object_that_cannot_be_selected_stays_in_edit_mode():
    item = flat_sheet()
    edit(item)
    item.hide_select = True
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH" and item.hide_select


def test_a_drag_over_faces_that_are_not_shown_is_told():
    item, half = sheets(2)
    lay_sheets(item, half, (0.1, 0.1, 0.3, 0.3), (0.1, 0.1, 0.3, 0.3))
    cube = primitive_in_object_mode("cube")
    in_object_mode()
    while cube.data.uv_layers:
        cube.data.uv_layers.remove(cube.data.uv_layers[0])
    cube.data.uv_layers.new()
    edit(item, cube)
    bpy.ops.mesh.select_all(action="DESELECT")
    in_object_mode()
    item.data.polygons.foreach_set("select", np.arange(2 * half) < half)
    edit_again(item)
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    assert bpy.ops.uv.freebound_drag_pin(start=(0.2, 0.2), target=(0.62, 0.6)) == {"FINISHED"}
    assert "6 faces are not unwrapped yet" in verdict()[0]


def test_charts_that_are_partly_selected_are_not_torn():
    for operator in (bpy.ops.uv.freebound_pack, bpy.ops.uv.freebound_relax):
        item = mesh_of(*wavy())
        lay(item, lambda co, face: (0.2 + 0.6 * co.x, 0.2 + 0.2 * co.y))
        before = uv_of(item)
        chosen = np.arange(len(item.data.polygons)) < 70
        select_faces(item, chosen)
        assert operator() == {"FINISHED"} and verdict()[1]
        assert (uv_of(item)[4 * 70 :] == before[4 * 70 :]).all()
        assert all(len(own) == 1 for own in places_of(item).values()), "each vertex has one place"
        assert (flips(item), overlaps(item)) == (0, 0)


def test_a_new_mesh_is_unwrapped_part_by_part():
    for has_map in (False, True):
        item, half = sheets(2)
        if has_map:
            item.data.uv_layers.new()
        for k in range(2):
            select_faces(item, np.arange(2 * half) // half == k)
            assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
            text, is_fine = verdict()
            assert is_fine and ("not unwrapped yet" in text) == (k == 0)
        uv = uv_of(item)
        assert uv.min() >= 0 and uv.max() <= 1 and (flips(item), overlaps(item)) == (0, 0)


def test_the_selection_of_the_uv_editor_counts_if_it_is_not_synchronized():
    from types import SimpleNamespace

    from freebound_uv import meshes

    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.5, 0.5, 0.4, 0.4))
    edit(item)
    bpy.context.scene.tool_settings.use_uv_select_sync = False
    bpy.ops.uv.select_all(action="DESELECT")
    context = SimpleNamespace(
        mode="EDIT_MESH",
        objects_in_mode=[item],
        objects_in_mode_unique_data=[item],
        view_layer=bpy.context.view_layer,
        area=SimpleNamespace(type="IMAGE_EDITOR"),
        tool_settings=bpy.context.scene.tool_settings,
    )
    with pytest.raises(meshes.Nothing, match="UV editor"):
        meshes.gather(context)
    bpy.ops.uv.select_all(action="SELECT")
    assert meshes.gather(context).face_count == 2 * half
    in_object_mode()
    attribute = item.data.attributes[".uv_select_face"]
    attribute.data.foreach_set("value", np.arange(2 * half) < half)
    bpy.ops.object.mode_set(mode="EDIT")
    selection = meshes.gather(context)
    assert selection.face_count == half and selection.others.face_count == half
    context.area.type = "VIEW_3D"
    assert meshes.gather(context).face_count == 2 * half


def test_a_map_that_changed_during_a_run_is_left_alone():
    from freebound_uv import meshes

    item = flat_sheet()
    edit(item)
    selection = meshes.gather(bpy.context)
    in_object_mode()
    item.data.uv_layers.active.uv[7].vector.x += 0.1
    before = uv_of(item)
    edit(item)
    with pytest.raises(meshes.Changed):
        meshes.write(bpy.context, selection, selection.uv)
    assert (uv_of(item) == before).all()


@pytest.mark.parametrize("function", ["pack", "check"])
def test_escape_ends_a_packing_and_a_check(function):
    import freebound
    from freebound_uv.tasks import Task

    random = np.random.default_rng(5)
    low = random.random((40000, 2))
    uv = (low[:, None] + 0.05 * random.random((40000, 3, 2))).reshape(-1, 2)
    vertices, faces = np.column_stack([uv, np.zeros(len(uv))]), np.arange(len(uv)).reshape(-1, 3)
    work = {"pack": freebound.pack, "check": freebound.check}[function]
    options = {"listed": 10**7} if function == "check" else {}
    task = Task(lambda task: task.call("Working", work, vertices, faces, uv, **options))
    assert not task.wait(0.02)
    task.cancel()
    with pytest.raises(freebound.Cancelled):
        task.result()


def test_a_run_that_fails_takes_the_old_verdict_back():
    item = mesh_of(*wavy())
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"} and verdict()[1]
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="[Ss]elect faces"):
        bpy.ops.uv.freebound_unwrap()
    text, is_fine = verdict()
    assert not is_fine and "elect faces" in text


def test_pins_beyond_the_picture_are_no_lack_of_room():
    item, half = sheets(2)
    lay_sheets(item, half, (1.2, 0, 0.4, 0.4), (0.2, 0.2, 0.4, 0.4))
    pin(item, {0: (1.2, 0.0), 14: (1.6, 0.0)})
    edit(item)
    assert bpy.ops.uv.freebound_pack() == {"FINISHED"}
    assert verdict()[1], verdict()


def test_a_check_reads_all_faces_and_selects_whole_mirrored_charts():
    item, half = sheets(2)
    lay_sheets(item, half, (0.4, 0, -0.4, 0.4), (0.5, 0.5, 0.4, 0.4))
    # Of the mirrored sheet nothing is selected, and a few of its faces are hidden.
    select_faces(item, np.arange(2 * half) >= half + 100)
    in_object_mode()
    item.data.polygons.foreach_set("hide", np.arange(2 * half) < 3)
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.uv.freebound_check() == {"FINISHED"}
    text, is_fine = verdict()
    assert is_fine and f"{half - 3} faces selected: mirrored; 3 more are hidden" in text
    in_object_mode()
    chosen = np.array([face.select for face in item.data.polygons])
    assert (chosen == ((np.arange(2 * half) < half) & (np.arange(2 * half) >= 3))).all()


def grabbed(item, near, aspect=1.0):
    """Grab of the corner nearest to a place."""
    from freebound_uv import dragging, meshes

    edit(item)
    selection = meshes.gather_shown(bpy.context)
    return dragging.Grab(selection, int(np.linalg.norm(selection.uv - near, axis=1).argmin()), aspect)


def test_a_drag_keeps_shapes_on_a_picture_that_is_not_square():
    vertices, quads = wavy()
    item = mesh_of(vertices * (1, 1, 0), quads)
    lay(item, lambda co, face: (0.1 + 0.2 * co.x, 0.1 + 0.4 * co.y))
    pin(item, {0: (0.1, 0.1)})
    for aspect, is_rigid in ((2.0, True), (1.0, False)):
        grab = grabbed(item, (0.3, 0.1), aspect)

        def lengths(grab=grab):
            sides = np.diff(grab.uv.astype(np.float64).reshape(-1, 4, 2), axis=1) * (2, 1)
            return np.linalg.norm(sides, axis=2)

        before = lengths()
        # Turned by 60 degrees about the pin.
        grab.move(np.array((0.2, 0.1 + 0.4 * 3**0.5 / 2)))
        assert (abs(lengths() / before - 1).max() < 0.1) == is_rigid


def test_a_mirrored_chart_is_dragged_and_stays_mirrored():
    item = mesh_of(*wavy())
    lay(item, lambda co, face: (0.8 - 0.6 * co.x, 0.2 + 0.6 * co.y))
    count = flips(item)
    edit(item)
    assert bpy.ops.uv.freebound_drag_pin(start=(0.5, 0.5), target=(0.6, 0.45)) == {"FINISHED"}
    assert verdict()[1] and flips(item) == count > 0 and overlaps(item) == 0
    assert np.linalg.norm(uv_of(item) - (0.6, 0.45), axis=1).min() < 1e-6


def test_a_drag_knows_faces_that_are_not_selected():
    item, half = sheets(2)
    lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.5, 0, 0.4, 0.4))
    for shows_all in (True, False):
        select_faces(item, np.arange(2 * half) < half)
        bpy.context.scene.tool_settings.use_uv_select_sync = shows_all
        assert bpy.ops.uv.freebound_drag_pin(start=(0.2, 0.2), target=(0.6, 0.2)) == {"FINISHED"}
        text, is_fine = verdict()
        assert not is_fine and "Pack" in text
        lay_sheets(item, half, (0, 0, 0.4, 0.4), (0.5, 0, 0.4, 0.4))
    # Corners that hidden faces share stay.
    select_faces(item, np.arange(2 * half) < half)
    in_object_mode()
    item.data.polygons.foreach_set("hide", (np.arange(2 * half) < 14))
    bpy.ops.object.mode_set(mode="EDIT")
    before = uv_of(item)
    edit_again(item)
    assert bpy.ops.uv.freebound_drag_pin(start=(0.2, 0.2), target=(0.22, 0.22)) == {"FINISHED"}
    assert (uv_of(item)[: 4 * 14] == before[: 4 * 14]).all()


def edit_again(item):
    bpy.context.view_layer.objects.active = item
    bpy.ops.object.mode_set(mode="EDIT")


def test_an_error_during_a_drag_leaves_nothing_behind():
    item = flat_sheet()
    edit(item)
    drag, context, event = dragging(item)
    removed = []
    context.window_manager.event_timer_remove = removed.append
    drag.invoke(context, event("RET", "PRESS", 0, 0))
    drag.modal(context, event("LEFTMOUSE", "PRESS", 503, 475))

    def broken(frames=1):
        raise ZeroDivisionError

    drag._take_frame = broken
    with pytest.raises(ZeroDivisionError):
        drag.modal(context, event("TIMER", "NOTHING", 503, 475))
    assert removed == ["timer"] and context.workspace.said[-1] is None


def test_a_verdict_is_forgotten_if_its_run_is_undone():
    item = flat_sheet()
    edit(item)
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.uv.freebound_relax() == {"FINISHED"} and verdict()[1]
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert verdict() == ("", False)


def test_undo_is_left_to_blender_between_drags():
    item = flat_sheet()
    edit(item)
    drag, context, event = dragging(item)
    drag.invoke(context, event("RET", "PRESS", 0, 0))
    key = event("Z", "PRESS", 0, 0)
    assert drag.modal(context, key) == {"RUNNING_MODAL"}
    key.ctrl = True
    assert drag.modal(context, key) == {"PASS_THROUGH"}
    from freebound_uv import dragging as module

    assert module.FREEBOUND_OT_drag_pin.bl_options == {"UNDO"}


def test_without_faces_the_message_tells_what_to_do():
    item = primitive("cube")
    edit(item)
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="[Ss]elect faces"):
        bpy.ops.uv.freebound_unwrap()
    assert bpy.context.mode == "EDIT_MESH"


def test_the_judges_of_these_tests_see_flips_and_overlaps():
    item = mesh_of(*wavy())
    edit(item)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    in_object_mode()
    layer = item.data.uv_layers.active
    for loop in item.data.loops:
        if loop.vertex_index == 90:
            layer.uv[loop.index].vector.x += 0.3
    assert flips(item) > 0 and overlaps(item) > 0


def copy_layout(source, *targets, **options):
    """Copies the layout of an object to others, in object mode."""
    in_object_mode()
    bpy.ops.object.select_all(action="DESELECT")
    for item in (source, *targets):
        item.select_set(True)
    bpy.context.view_layer.objects.active = source
    return bpy.ops.object.freebound_copy_layout(**options)


def ball(segments, rings, at=(0, 0, 0), size=1.0):
    in_object_mode()
    item = primitive("uv_sphere", segments=segments, ring_count=rings, location=at)
    item.data.transform(item.matrix_world.Scale(size, 4))
    return item


def test_a_layout_is_copied_to_other_levels_of_detail_with_its_seams():
    fine = ball(40, 24)
    edit(fine)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    # Their own coordinates are compared, wherever the objects stand.
    coarse, rough = ball(32, 20, at=(4, 0, 0)), ball(20, 12, at=(8, 0, 0))
    coarse.data.uv_layers.remove(coarse.data.uv_layers.active)
    assert copy_layout(fine, coarse, rough) == {"FINISHED"}
    for item in (coarse, rough):
        assert flips(item) == 0 and overlaps(item) == 0
        in_object_mode()
        assert any(edge.use_seam for edge in item.data.edges)
    assert "proved" in bpy.context.window_manager.freebound_verdict
    assert bpy.context.window_manager.freebound_is_fine


def test_a_copy_onto_the_same_faces_keeps_every_coordinate():
    source = mesh_of(*wavy())
    edit(source)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    in_object_mode()
    other = mesh_of(*wavy(), name="other")
    assert copy_layout(source, other) == {"FINISHED"}
    assert np.array_equal(uv_of(source), uv_of(other))


def test_an_object_that_lies_apart_is_named_and_fitted_on_request():
    fine = ball(40, 24)
    edit(fine)
    assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
    in_object_mode()
    small = ball(24, 14, size=0.1)
    assert copy_layout(fine, small) == {"FINISHED"}
    assert "lies apart" in bpy.context.window_manager.freebound_verdict
    assert copy_layout(fine, small, fit=True) == {"FINISHED"}
    assert bpy.context.window_manager.freebound_is_fine and flips(small) == 0


def test_a_copy_needs_a_layout_and_another_object():
    bare, other = mesh_of(*wavy(), name="bare"), mesh_of(*wavy(), name="other")
    with pytest.raises(RuntimeError, match="no UV map on bare"):
        copy_layout(bare, other)
    assert not other.data.uv_layers
    bpy.ops.object.select_all(action="DESELECT")
    bare.select_set(True)
    bpy.context.view_layer.objects.active = bare
    assert not bpy.ops.object.freebound_copy_layout.poll()

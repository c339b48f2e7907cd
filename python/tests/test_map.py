"""Many files, on executors."""

from concurrent.futures import ProcessPoolExecutor

import pytest

import freebound
from meshes import ball, cube, grid, write_obj


@pytest.fixture
def files(tmp_path):
    """A folder of small meshes, one of which is no mesh."""
    folder = tmp_path / "in"
    folder.mkdir()
    paths = []
    for k in range(8):
        vertices, faces = ball(8 + k, 6) if k % 2 else cube()
        paths.append(write_obj(folder / f"mesh{k}.obj", vertices * (1 + k), faces))
    broken = folder / "broken.obj"
    broken.write_text("v 0 0 nan\nf 1 2 3\n")
    return [*paths, broken]


def test_files_are_run_one_after_the_other_and_a_broken_one_stops_nothing(files, tmp_path):
    records = list(freebound.map(files, tmp_path / "out"))
    assert [record.status for record in records] == ["proved"] * 8 + ["refused"]
    assert all(freebound.check(record.output)["planar"] for record in records[:8])
    assert records[8].output is None and records[8].message


def test_a_second_run_does_nothing_twice(files, tmp_path):
    first = list(freebound.map(files, tmp_path / "out"))
    stamps = {record.output: (tmp_path / "out" / record.output).stat().st_mtime_ns for record in first if record.output}
    files[0].write_text(files[0].read_text() + "# changed\n")
    # A result that was damaged is made again.
    (tmp_path / "out" / "mesh1.obj").write_text("gone")
    again = list(freebound.map(files, tmp_path / "out"))
    resumed = {record.input: record.resumed for record in again}
    assert not resumed[str(files[0])] and not resumed[str(files[1])]
    assert all(resumed[str(path)] for path in files[2:])
    for record in again[2:8]:
        assert (tmp_path / "out" / record.output).stat().st_mtime_ns == stamps[record.output]
    other = list(freebound.map(files, tmp_path / "out", distortion=4.2))
    assert not any(record.resumed for record in other)


def test_processes_give_the_same_files(files, tmp_path):
    alone = {record.input: record for record in freebound.map(files, tmp_path / "alone", threads=1)}
    with ProcessPoolExecutor(2) as pool:
        together = list(freebound.map(files, tmp_path / "together", executor=pool, threads=1))
    assert len(together) == len(files)
    for record in together:
        assert (record.status, record.output_digest) == (alone[record.input].status, alone[record.input].output_digest)


def test_equal_names_are_told_apart_and_formats_can_be_chosen(tmp_path):
    vertices, faces = cube()
    paths = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        paths.append(write_obj(tmp_path / name / "box.obj", vertices, faces))
    records = list(freebound.map(paths, tmp_path / "out", suffix=".glb"))
    assert sorted(path.name for path in (tmp_path / "out").glob("*.glb")) == ["box-2.glb", "box.glb"]
    assert all(record.status == "proved" for record in records)
    with pytest.raises(freebound.OptionError):
        list(freebound.map(paths, tmp_path / "out", suffix=".stl"))
    # Before anything is asked for.
    with pytest.raises(freebound.OptionError):
        freebound.map(paths, tmp_path / "out", metod="auto")


def test_no_result_replaces_a_mesh_or_another_result(tmp_path):
    vertices, faces = cube()
    for name in ("a", "b", "c"):
        (tmp_path / name).mkdir()
    paths = [write_obj(tmp_path / place, vertices, faces) for place in ("a/box.obj", "b/box.obj", "c/box-2.obj")]
    records = list(freebound.map(paths, tmp_path / "out"))
    assert len({record.output for record in records}) == 3
    before = paths[0].read_bytes()
    with pytest.raises(freebound.OptionError):
        freebound.map(paths, tmp_path / "a")
    assert paths[0].read_bytes() == before


def test_results_keep_the_way_to_their_materials_and_can_be_read_by_others(tmp_path):
    vertices, faces = cube()
    folder = tmp_path / "in"
    folder.mkdir()
    path = write_obj(folder / "box.obj", vertices, faces)
    path.write_text("mtllib box.mtl\nusemtl red\n" + path.read_text())
    (folder / "box.mtl").write_text("newmtl red\nKd 1 0 0\n")
    [record] = freebound.map([path], tmp_path / "out")
    [library] = [line.split()[1] for line in open(record.output) if line.startswith("mtllib")]
    assert (tmp_path / "out" / library).resolve() == (folder / "box.mtl").resolve()
    (tmp_path / "plain").touch()
    assert (tmp_path / "out" / "box.obj").stat().st_mode == (tmp_path / "plain").stat().st_mode
    assert (tmp_path / "out" / "box.obj.freebound.json").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_a_result_that_is_not_made_again_does_not_stay(tmp_path):
    vertices, faces = cube()
    path = write_obj(tmp_path / "box.obj", vertices, faces)
    [record] = freebound.map([path], tmp_path / "out")
    assert record.status == "proved"
    path.write_text("v 0 0 nan\nf 1 2 3\n")
    [record] = freebound.map([path], tmp_path / "out")
    assert record.status == "refused" and not (tmp_path / "out" / "box.obj").exists()


def test_object_stores_are_read_and_written():
    fsspec = pytest.importorskip("fsspec")
    vertices, faces, _ = grid()
    lines = ["v {} {} {}".format(*vertex) for vertex in vertices]
    lines += ["f {} {} {}".format(*(face + 1)) for face in faces]
    store = fsspec.filesystem("memory")
    store.pipe_file("/in/sheet.obj", "\n".join(lines).encode())
    [record] = freebound.map(["memory://in/sheet.obj"], "memory://out")
    assert record.status == "proved" and store.exists("/out/sheet.obj")
    [again] = freebound.map(["memory://in/sheet.obj"], "memory://out")
    assert again.resumed

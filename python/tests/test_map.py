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
    with pytest.raises(freebound.OptionError):
        list(freebound.map(paths, tmp_path / "out", metod="auto"))


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

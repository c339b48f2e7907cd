"""The examples, and the code of the book, run as they stand."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import freebound
from meshes import ball, cube, grid, write_obj

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "python" / "examples"


def run(name, *arguments):
    command = [sys.executable, str(EXAMPLES / name), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_materials_are_kept_with_trimesh(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    vertices, faces = ball()
    red = trimesh.visual.material.PBRMaterial(baseColorFactor=[200, 30, 40, 255], name="red")
    visual = trimesh.visual.TextureVisuals(uv=np.zeros((len(vertices), 2)), material=red)
    trimesh.Trimesh(vertices, faces, visual=visual, process=False).export(tmp_path / "in.glb")
    assert "planar: proved" in run("materials_with_trimesh.py", tmp_path / "in.glb", tmp_path / "out.glb")
    again = trimesh.load(tmp_path / "out.glb", force="mesh", process=False)
    assert again.visual.material.name == "red" and len(again.faces) == len(faces)
    assert freebound.check(tmp_path / "out.glb")["planar"]


def test_surfaces_of_pyvista_are_unwrapped(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    vertices, faces = ball()
    pyvista.PolyData.from_regular_faces(vertices, faces).save(tmp_path / "in.ply")
    assert "planar: proved" in run("surfaces_with_pyvista.py", tmp_path / "in.ply", tmp_path / "out.vtp")
    again = pyvista.read(tmp_path / "out.vtp")
    uv = np.asarray(again.active_texture_coordinates, dtype=np.float64)
    assert again.n_cells == len(faces) and again.cell_data["energy"].min() >= 4 - 1e-9
    corner_uv = uv[again.regular_faces].reshape(-1, 2)
    found = freebound.check(np.asarray(again.points, dtype=np.float64), again.regular_faces, corner_uv)
    assert found["planar"] and found["charts"] == again.cell_data["chart"].max() + 1


def test_landmarks_are_met_and_their_distortion_is_that_of_the_report():
    assert "worst face" in run("landmarks.py")


def test_a_thousand_files_are_run_by_processes_and_a_second_run_keeps_them(tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    vertices, faces = cube()
    for k in range(1000):
        write_obj(folder / f"box{k}.obj", vertices * (1, 1, 1 + k / 1000), faces)
    assert "{'proved': 1000} 0 of an earlier run" in run("many_files.py", folder, tmp_path / "out")
    (tmp_path / "out" / "box7.obj").unlink()
    assert "{'proved': 1000} 999 of an earlier run" in run("many_files.py", folder, tmp_path / "out")


@pytest.mark.parametrize("page", ["python.md"])
def test_the_code_of_the_book_runs_as_it_stands(page, tmp_path, monkeypatch):
    text = (ROOT / "book" / "src" / page).read_text()
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
    assert len(blocks) > 5
    monkeypatch.chdir(tmp_path)
    write_obj(tmp_path / "model.obj", *ball())
    write_obj(tmp_path / "sheet.obj", *grid()[:2])
    names = {"__name__": "book"}
    for block in blocks:
        exec(compile(block, page, "exec"), names)  # noqa: S102


def test_the_notebook_draws_figure_4_with_the_flips_of_the_program(monkeypatch):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(EXAMPLES)
    notebook = json.loads((EXAMPLES / "figure4.ipynb").read_text())
    names = {"__name__": "notebook"}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), "figure4.ipynb", "exec"), names)  # noqa: S102
    # As `freebound figures` draws them: src/cli/figures/pairs.rs.
    kinds = [name for name, _ in names["weights"]]
    assert [[names["flips"][pair, kind] for kind in kinds] for pair in names["pairs"]] == [[4, 2, 1], [8, 5, 4]]
    assert all(count >= 1 for count in names["iterations"].values())
    assert not any(cell.get("outputs") for cell in notebook["cells"])

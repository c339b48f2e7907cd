"""Layouts and pictures of one mesh on another mesh."""

import freebound
import numpy as np
import pytest

from meshes import ball, grid, write_obj


@pytest.fixture(scope="module")
def layout():
    """A ball with a layout."""
    return freebound.unwrap(*ball(32, 20))


def with_uv(layout):
    return (layout.vertices, layout.vertex_faces, layout.corner_uv)


def test_a_layout_is_copied_to_a_coarser_mesh_and_proved(layout, tmp_path):
    copied = freebound.transfer(with_uv(layout), ball(18, 11))
    assert copied.planar and not copied.corner_uv.flags.writeable
    assert copied.corner_uv.shape == (3 * len(ball(18, 11)[1]), 2)
    assert copied.report["transfer"]["by"] == "nearest-points"
    for name in ("out.obj", "out.ply", "out.glb"):
        assert copied.save(tmp_path / name) == [str(tmp_path / name)]
        assert freebound.check(tmp_path / name)["planar"]
    assert np.array_equal(freebound.read(tmp_path / "out.obj").corner_uv, copied.corner_uv)


def test_a_layout_returns_to_its_own_mesh_bit_for_bit(layout):
    copied = freebound.transfer(with_uv(layout), (layout.vertices, layout.vertex_faces))
    assert np.array_equal(copied.corner_uv, layout.corner_uv)
    assert copied.report["transfer"] == {"by": "corners"}


def test_a_mesh_of_another_size_is_fitted_on_request(layout):
    vertices, faces = ball(18, 11)
    small = (0.01 * vertices + [3, 4, 5], faces)
    copied = freebound.transfer(with_uv(layout), small, fit=True)
    report = copied.report["transfer"]
    assert copied.planar and not copied.apart and report["mean_distance"] < 0.01 * report["diagonal"]
    assert freebound.transfer(with_uv(layout), small).apart
    # Less apart than surfaces of one size may be.
    assert freebound.transfer(with_uv(layout), (0.75 * vertices, faces)).apart


def test_the_program_and_the_package_write_the_same_bytes(layout, tmp_path, program):
    uv, plain, theirs, ours = (tmp_path / name for name in ("uv.obj", "plain.obj", "theirs.obj", "ours.obj"))
    layout.save(uv)
    write_obj(plain, *ball(18, 11))
    program("transfer", uv, plain, "-o", theirs)
    freebound.transfer(uv, plain).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()
    pixels = np.random.default_rng(3).integers(0, 256, (16, 24, 3), dtype=np.uint8)
    old, drawn, again = (tmp_path / name for name in ("old.png", "drawn.png", "again.png"))
    freebound.bake(uv, uv, pixels, margin=0).save(old)
    program("bake", uv, theirs, "--picture", old, "-o", drawn, "--size", "64x48")
    assert freebound.bake(uv, theirs, old, size=(64, 48)).save(again) == str(again)
    assert again.read_bytes() == drawn.read_bytes()


def test_a_picture_is_drawn_for_another_layout_of_a_sheet():
    vertices, faces, _ = grid(height=0.0)
    uv = vertices[faces.ravel(), :2]
    gradient = np.zeros((64, 64, 3), dtype=np.uint8)
    gradient[..., 0] = (255 * (np.arange(64) + 0.5) / 64)[None, :]
    mirrored = uv * [-1, 1] + [1, 0]
    baked = freebound.bake((vertices, faces, uv), (vertices, faces, mirrored), gradient)
    assert baked.pixels.shape == (64, 64, 4) and baked.pixels.dtype == np.uint8
    error = baked.pixels[..., 0].astype(int) - gradient[:, ::-1, 0]
    assert np.abs(error).max() <= 2 and (baked.pixels[..., 3] == 255).all()
    assert baked.report["covered"] == 1.0 and baked.report["largest_distance"] < 1e-12
    assert freebound.bake((vertices, faces, uv), (vertices, faces, uv), gradient, size=(8, 4)).pixels.shape == (4, 8, 4)
    numbers = {"size": np.int64(16), "margin": np.int32(2), "fit": np.bool_(True)}
    assert freebound.bake((vertices, faces, uv), (vertices, faces, uv), gradient, **numbers).pixels.shape == (16, 16, 4)


def test_wrong_input_is_refused(layout, tmp_path):
    with pytest.raises(freebound.OptionError):
        freebound.transfer(ball(), ball())
    with pytest.raises(freebound.OptionError):
        freebound.bake(with_uv(layout), with_uv(layout))
    with pytest.raises(freebound.OptionError):
        freebound.bake(with_uv(layout), with_uv(layout), np.zeros((4, 4), dtype=np.uint8))
    with pytest.raises(freebound.OptionError):
        freebound.bake(with_uv(layout), with_uv(layout), np.zeros((4, 4, 3), dtype=np.uint8), size=0)
    with pytest.raises(freebound.OptionError):
        freebound.bake(with_uv(layout), with_uv(layout), np.zeros((4, 4, 3), dtype=np.uint8), margin=-1)
    with pytest.raises(freebound.OptionError):
        freebound.bake(with_uv(layout), with_uv(layout), np.zeros((4, 4, 3), dtype=np.uint8), margin=2000)
    with pytest.raises(freebound.InputError):
        freebound.bake(with_uv(layout), with_uv(layout), tmp_path / "nowhere.png")
    with pytest.raises(freebound.OptionError):
        freebound.transfer(with_uv(layout), ball()).save(tmp_path / "out.stl")


def test_a_copy_and_a_drawing_can_be_stopped(layout):
    fine = ball(700, 500)
    with pytest.raises(freebound.Cancelled):
        freebound.transfer(with_uv(layout), fine, stop=lambda: True)
    pixels = np.zeros((4, 4, 3), dtype=np.uint8)
    with pytest.raises(freebound.Cancelled):
        freebound.bake(with_uv(layout), with_uv(layout), pixels, size=8192, stop=lambda: True)

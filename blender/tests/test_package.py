# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension as Blender installs it: built and validated by Blender's own tool, in a fresh profile."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

SCRIPT = """
import bpy, importlib.abc, importlib.machinery, sys

class FromProfileOnly(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name != "freebound":
            return None
        places = [place for place in sys.path if place.startswith(sys.argv[2])]
        found = importlib.machinery.PathFinder.find_spec(name, places)
        if found is None:
            raise ImportError("the bundled wheel is not installed")
        return found

sys.meta_path.insert(0, FromProfileOnly())
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=True)
bpy.ops.mesh.primitive_monkey_add()
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.mesh.select_all(action="SELECT")
assert bpy.ops.uv.freebound_unwrap() == {"FINISHED"}
import freebound
print("from", freebound.__file__)
print("verdict", bpy.context.window_manager.freebound_verdict)
"""


def test_the_zip_file_is_installed_into_a_fresh_profile_and_works(tmp_path):
    wheel = os.environ.get("FREEBOUND_WHEEL")
    if wheel is None:
        pytest.skip("FREEBOUND_WHEEL does not name the wheel")
    [tool] = Path(bpy.utils.system_resource("SCRIPTS")).rglob("bl_pkg/cli/blender_ext.py")
    import build

    zip_file = build.build(str(tool), tmp_path / "dist", [wheel])
    (tmp_path / "profile").mkdir()
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path / "profile"), "PYTHONSAFEPATH": "1"}
    run = [sys.executable, "-c", SCRIPT, str(zip_file), str(tmp_path / "profile")]
    done = subprocess.run(run, env=environment, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "proved" in done.stdout
    assert str(tmp_path / "profile") in done.stdout, "the bundled wheel is used"

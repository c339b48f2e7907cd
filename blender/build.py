# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension with its wheels: python build.py BLENDER_EXT OUTPUT WHEEL…

BLENDER_EXT is blender_ext.py of Blender, or Blender itself. The wheels are bundled as they are.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

#: Platforms of Blender by the ends of the names of wheels.
PLATFORMS = {
    "x86_64.whl": "linux-x64",
    "aarch64.whl": "linux-arm64",
    "win_amd64.whl": "windows-x64",
    "arm64.whl": "macos-arm64",
}


def command_of(tool):
    """Command of Blender's tool for extensions."""
    return [sys.executable, tool] if tool.endswith(".py") else [tool, "--command", "extension"]


def build(tool, output, wheels):
    """Builds and validates the zip file, and returns its path."""
    source = Path(__file__).parent / "freebound_uv"
    with tempfile.TemporaryDirectory() as folder:
        staged = Path(folder) / "freebound_uv"
        shutil.copytree(source, staged, ignore=shutil.ignore_patterns("__pycache__"))
        (staged / "wheels").mkdir()
        platforms = set()
        for wheel in wheels:
            shutil.copy(wheel, staged / "wheels")
            platforms.update(platform for end, platform in PLATFORMS.items() if str(wheel).endswith(end))
        names = ", ".join(f'"./wheels/{Path(wheel).name}"' for wheel in wheels)
        kinds = ", ".join(f'"{platform}"' for platform in sorted(platforms))
        with open(staged / "blender_manifest.toml", "a") as manifest:
            manifest.write(f"\nplatforms = [{kinds}]\nwheels = [{names}]\n")
        Path(output).mkdir(parents=True, exist_ok=True)
        run = command_of(tool)
        subprocess.run([*run, "validate", str(staged)], check=True)
        subprocess.run([*run, "build", "--source-dir", str(staged), "--output-dir", str(output)], check=True)
    [zip_file] = Path(output).glob("freebound_uv-*.zip")
    subprocess.run([*run, "validate", str(zip_file)], check=True)
    return zip_file


if __name__ == "__main__":
    tool, output, *wheels = sys.argv[1:]
    print(build(tool, output, wheels))

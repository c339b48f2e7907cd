# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the extension with its wheels: python build.py BLENDER_EXT OUTPUT WHEEL…

BLENDER_EXT is blender_ext.py of Blender, or Blender itself. The wheels are bundled as they are.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

#: Platforms of Blender by the system and the processor in the names of wheels.
PLATFORMS = {
    ("manylinux", "x86_64"): "linux-x64",
    ("manylinux", "aarch64"): "linux-arm64",
    # Built for this machine alone.
    ("linux", "x86_64"): "linux-x64",
    ("linux", "aarch64"): "linux-arm64",
    ("win", "amd64"): "windows-x64",
    ("win", "arm64"): "windows-arm64",
    ("macosx", "arm64"): "macos-arm64",
    ("macosx", "x86_64"): "macos-x64",
}


def platform_of(wheel):
    """Platform of a wheel by its name."""
    tag = Path(wheel).stem.rsplit("-", 1)[-1]
    for (system, processor), platform in PLATFORMS.items():
        if tag.startswith(system) and tag.endswith(processor):
            return platform
    raise SystemExit(f"{wheel}: Blender does not run on the platform {tag}")


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
        platforms = {platform_of(wheel) for wheel in wheels}
        for wheel in wheels:
            shutil.copy(wheel, staged / "wheels")
        names = ", ".join(f'"./wheels/{Path(wheel).name}"' for wheel in wheels)
        kinds = ", ".join(f'"{platform}"' for platform in sorted(platforms))
        with open(staged / "blender_manifest.toml", "a") as manifest:
            manifest.write(f"\nplatforms = [{kinds}]\nwheels = [{names}]\n")
        Path(output).mkdir(parents=True, exist_ok=True)
        run = command_of(tool)
        subprocess.run([*run, "validate", str(staged)], check=True)
        built = Path(folder) / "built"
        built.mkdir()
        subprocess.run([*run, "build", "--source-dir", str(staged), "--output-dir", str(built)], check=True)
        [zip_file] = built.glob("*.zip")
        zip_file = Path(shutil.copy(zip_file, output))
    subprocess.run([*run, "validate", str(zip_file)], check=True)
    return zip_file


if __name__ == "__main__":
    tool, output, *wheels = sys.argv[1:]
    print(build(tool, output, wheels))

"""Fixtures of all tests."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture
def program():
    """Runs the program. The variable FREEBOUND_PROGRAM names it."""
    path = os.environ.get("FREEBOUND_PROGRAM")
    if path is None:
        pytest.skip("FREEBOUND_PROGRAM does not name the program")

    def run(*arguments):
        return subprocess.run([path, *map(str, arguments)], check=True, capture_output=True, text=True)

    return run

"""Unwraps all meshes of a folder on all cores; a second run goes on: python many_files.py FOLDER OUTPUT"""

import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import freebound

if __name__ == "__main__":
    folder, output = map(Path, sys.argv[1:3])
    files = sorted(folder.rglob("*.obj"))
    count, resumed = Counter(), 0
    with ProcessPoolExecutor() as pool:
        for record in freebound.map(files, output, executor=pool, threads=1):
            count[record.status] += 1
            resumed += record.resumed
            if record.status != "proved":
                print(record.input, record.message)
    print(dict(count), f"{resumed} of an earlier run")

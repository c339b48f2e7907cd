"""A cluster of two workers, one of which dies in the middle."""

import os
import threading
import time

import pytest

import freebound
from meshes import ball, write_obj

distributed = pytest.importorskip("distributed")


def test_files_that_a_killed_worker_had_are_run_by_the_other(tmp_path):
    paths = []
    for k in range(12):
        vertices, faces = ball(30 + k, 16)
        paths.append(write_obj(tmp_path / f"ball{k}.obj", vertices, faces))
    alone = {record.input: record.output_digest for record in freebound.map(paths, tmp_path / "alone", threads=1)}
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        workers = list(client.run(os.getpid).values())
        first_ended = threading.Event()

        def kill():
            first_ended.wait(120)
            os.kill(workers[0], 9)

        killer = threading.Thread(target=kill)
        killer.start()
        records = []
        for record in freebound.map(paths, tmp_path / "cluster", executor=client, threads=1):
            records.append(record)
            first_ended.set()
        killer.join()
        deadline = time.monotonic() + 60
        while workers[0] in client.run(os.getpid).values() and time.monotonic() < deadline:
            time.sleep(0.2)
    assert sorted(record.input for record in records) == sorted(alone)
    assert all(record.status == "proved" for record in records), [record.message for record in records]
    assert {record.input: record.output_digest for record in records} == alone

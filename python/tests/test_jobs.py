"""Runs in the background: progress, cancellation, signals, threads, processes."""

import gc
import multiprocessing
import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import freebound
from meshes import ball, grid


def large():
    return ball(160, 80)


def test_a_job_reports_progress_and_gives_its_result_again():
    seen = []
    vertices, faces = large()
    layout = freebound.unwrap(vertices, faces, progress=seen.append)
    assert seen and all(set(state) == {"stage", "phase", "steps", "planar", "seconds"} for state in seen)
    assert len(seen) <= 10 * seen[-1]["seconds"] + 1
    job = freebound.start(vertices, faces, unwrap=True)
    assert np.array_equal(job.result().uv, layout.uv) and job.done and job.wait(0)
    assert np.array_equal(job.result().uv, layout.uv)


def _threads():
    return len(os.listdir("/proc/self/task"))


@pytest.mark.skipif(not os.path.exists("/proc/self/task"), reason="needs the numbers of Linux")
def test_a_cancelled_job_ends_at_once():
    before = _threads()
    vertices, faces = large()
    for k in range(100):
        job = freebound.start(vertices, faces, unwrap=True, distortion=4.0001)
        time.sleep(0.001 * k)
        assert not job.done, "the run takes seconds"
        job.cancel()
        with pytest.raises(freebound.Cancelled):
            job.result()
    # The threads of the runs end, too.
    deadline = time.monotonic() + 60
    while _threads() > before and time.monotonic() < deadline:
        time.sleep(0.05)
    assert _threads() <= before


def test_a_result_may_be_late():
    job = freebound.start(*large(), unwrap=True)
    with pytest.raises(TimeoutError):
        job.result(timeout=0)
    assert job.result().verdict.planar


def test_an_error_of_the_progress_function_stops_the_run():
    def fail(state):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        freebound.unwrap(*large(), distortion=4.01, progress=fail)


@pytest.fixture
def ctrl_c():
    """Makes SIGINT an exception. A shell ignores it in processes that it starts in the background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("ctrl_c")
def test_ctrl_c_stops_a_run():
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        freebound.unwrap(*ball(400, 200), distortion=4.0001)
    timer.join()


@pytest.mark.usefixtures("ctrl_c")
def test_ctrl_c_stops_a_step():
    timer = threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT))
    vertices, faces, _ = grid(500, 400)
    flattener = freebound.Flattener(vertices, faces)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        next(flattener)
        time.sleep(1)
    timer.join()


def test_threads_run_side_by_side_without_the_lock_of_the_interpreter():
    vertices, faces = ball(60, 30)
    alone = freebound.unwrap(vertices, faces)
    ticks = 0
    with ThreadPoolExecutor(3) as pool:
        futures = [pool.submit(freebound.unwrap, vertices, faces) for _ in range(3)]
        while not all(future.done() for future in futures):
            ticks += 1
            time.sleep(0.001)
    assert ticks > 3
    assert all(np.array_equal(future.result().uv, alone.uv) for future in futures)


def _in_child(queue):
    vertices, faces = ball(30, 15)
    queue.put(freebound.unwrap(vertices, faces).uv)


def test_a_fork_after_use_works():
    vertices, faces = ball(30, 15)
    here = freebound.unwrap(vertices, faces).uv
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_in_child, args=(queue,))
    child.start()
    there = queue.get(timeout=120)
    child.join(60)
    assert child.exitcode == 0 and np.array_equal(here, there)


def _resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="needs the numbers of Linux")
def test_a_thousand_calls_leave_no_memory_behind():
    vertices, faces, _ = grid(20, 20)
    size = vertices.nbytes + faces.nbytes

    def calls(count):
        for _ in range(count):
            layout = freebound.flatten(vertices, faces, method="natural", threads=1)
            layout.uv, layout.report, layout.singular_values
        gc.collect()

    calls(300)
    before = _resident()
    calls(1000)
    grown = _resident() - before
    # Every call that kept its arrays would add their size.
    assert grown < 0.2 * 1000 * size, f"{grown} bytes"

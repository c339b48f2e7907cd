# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in a thread of its own, so that Blender's window stays alive."""

import threading
import time

import freebound


class Task:
    """Work that runs solver jobs. Inside it ``run`` waits for a job; outside it ``progress`` and ``cancel`` reach it."""

    def __init__(self, work):
        self._job = None
        self._words = "working"
        self._start = time.monotonic()
        self._is_cancelled = False
        self._result = None
        self._error = None
        self._thread = threading.Thread(target=self._run, args=(work,), name="freebound", daemon=True)
        self._thread.start()

    def _run(self, work):
        try:
            self._result = work(self)
        except BaseException as error:
            self._error = error

    def run(self, words, job):
        """Waits for a job of the solver, and returns its layout."""
        self._words, self._job = words, job
        if self._is_cancelled:
            job.cancel()
        try:
            return job.result()
        finally:
            self._job = None

    def call(self, words, function, *given, **named):
        """Result of a function of the package that takes ``stop``."""
        self._words = words
        return function(*given, **named, stop=lambda: self._is_cancelled)

    @property
    def progress(self):
        """What the work does, and for how long, in words."""
        job = self._job
        stage = job.progress["stage"] if job is not None else ""
        words = f"{self._words}: {stage}" if stage else self._words
        return f"{words}, {time.monotonic() - self._start:.1f} s"

    def cancel(self):
        """Stops the work at its next step."""
        self._is_cancelled = True
        job = self._job
        if job is not None:
            job.cancel()

    def wait(self, seconds):
        """Waits for the end, at most for a time. Returns True if the work has ended."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def result(self):
        """Result of the work, or its error. Waits for it."""
        while not self.wait(0.05):
            pass
        if self._error is not None:
            raise self._error
        if self._is_cancelled:
            raise freebound.Cancelled("the run was cancelled")
        return self._result

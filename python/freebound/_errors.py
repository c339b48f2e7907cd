"""Errors of the package."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """Base class of all errors of this package."""


class OptionError(Error, ValueError):
    """An option is unknown, out of range, or does not fit the method or the mesh."""


class InputError(Error, ValueError):
    """The mesh or the file cannot be used.

    ``faults`` is a list of dictionaries with ``kind``, ``message``, perhaps ``remedy``, and the elements at fault:
    ``vertices``, ``edges``, ``faces``, ``loops``, ``line`` or ``byte``.
    """

    def __init__(self, message: str, *, faults: list[dict[str, Any]] | None = None) -> None:
        super().__init__(message)
        self.faults = faults or []


class NotProved(Error):
    """The result is not planar, misses a hard pin, or misses the density that was asked for.

    ``layout`` is the :class:`freebound.Layout`, or None if the method has found none.
    """

    def __init__(self, message: str, *, layout: Any = None) -> None:
        super().__init__(message)
        self.layout = layout


class Cancelled(Error):
    """The run was cancelled."""

"""What goes wrong, as exceptions that say what, where, and how to mend it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class RecrashError(Exception):
    """Anything that recrash could not do.

    ``diagnostics`` holds every single problem, where there are several: dicts with ``severity``, ``code``, ``location``
    (``file``, ``row``, ``line``, ``column``, ``path``), ``message`` and ``hint``.
    """

    diagnostics: list[dict[str, Any]]

    def __init__(self, message: str, diagnostics: Sequence[dict[str, Any]] = ()) -> None:
        super().__init__(message)
        self.diagnostics = list(diagnostics)


class InputError(RecrashError, ValueError):
    """What was given cannot be used."""


class EgoError(RecrashError):
    """An ego raised, or answered something that is no control. What it raised is the ``__cause__``."""

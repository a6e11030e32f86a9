"""Real crashes of automated vehicles as simulation tests.

- :func:`read` reads crash files into accounts, :func:`records` into a table of their fields.
- :class:`Scenario` is one checked scenario: :meth:`Scenario.load`, :meth:`Scenario.run`.
- :func:`run` makes a :class:`Suite`, a folder with a test for each picked crash; :meth:`Suite.open` opens one.
- :func:`test` runs many scenarios with one ego, and gives a table; :func:`sweep` and :func:`tune` look around them.
- :mod:`recrash.plots` draws runs and corpora (needs ``matplotlib``), :mod:`recrash.ray` uses a cluster (needs ``ray``).
- :mod:`recrash.gym` has environments for learning drivers (needs ``gymnasium``).

Units are SI and angles are radians. x points along the first road, y to its left, headings count anticlockwise from x.
"""

from __future__ import annotations

from recrash._recrash import EGOS, METADRIVE_EGOS, STATE, Accounts, Run, Scenario, Table, __version__
from recrash.errors import EgoError, InputError, RecrashError
from recrash.suite import Suite, load_scenarios, read, records, run, sweep, test, tune

__all__ = [
    "EGOS",
    "METADRIVE_EGOS",
    "STATE",
    "Accounts",
    "EgoError",
    "InputError",
    "RecrashError",
    "Run",
    "Scenario",
    "Suite",
    "Table",
    "__version__",
    "load_scenarios",
    "read",
    "records",
    "run",
    "sweep",
    "test",
    "tune",
]

"""Crash files, suites of tests, and tests of an ego."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from recrash import _recrash
from recrash._recrash import Accounts, Run, Scenario, Table
from recrash.errors import EgoError, InputError, RecrashError

#: A file's or folder's path.
Location = str | os.PathLike[str]
#: Told ``(stage, units, begins)``: a stage begins with so many units of work, or so many of them are done.
Progress = Callable[[str, int, bool], None]


def _files(files: Location | Iterable[Location] | None) -> list[Location] | None:
    if files is None or isinstance(files, (str, os.PathLike)):
        return None if files is None else [files]
    return list(files)


def read(
    files: Location | Iterable[Location] | None = None,
    *,
    where: str | None = None,
    mapping: Location | None = None,
    profile: str | None = None,
) -> Accounts:
    """Read crash files into accounts: what the reports of each incident tell.

    Without ``files`` the built-in sample is read. ``where`` keeps the records of which a filter is true (``road = street``);
    ``mapping`` names a mapping file for another database's columns.
    """
    return _recrash.read_accounts(_files(files), where, mapping, profile)


def records(
    files: Location | Iterable[Location] | None = None,
    *,
    where: str | None = None,
    mapping: Location | None = None,
    profile: str | None = None,
    all_rows: bool = False,
) -> Table:
    """Read crash files into a table of their fields: the records that the profile can use, or all."""
    return _recrash.read_records(_files(files), where, mapping, profile, all_rows)


def load_scenarios(source: Location | Iterable[Scenario | Location]) -> list[Scenario]:
    """Load scenarios: of a folder (a suite, or any folder of scenario files), of one file, or of a list of files.

    Of two files of one name the later one counts, in the order of their paths: a suite's tuned scenario in place of the
    designed one. Files that are no scenario are passed over in folders, and refused where they are named.
    """
    if isinstance(source, (str, os.PathLike)):
        folder = Path(source)
        if not folder.is_dir():
            return [Scenario.load(folder)]
        found = {}
        for file in sorted(folder.rglob("*.json")):
            if _is_scenario(file):
                found[file.name] = file
        if not found:
            raise InputError(f"{folder} holds no scenario file; name a suite, or a folder of scenario files")
        return [Scenario.load(file) for file in found.values()]
    return [each if isinstance(each, Scenario) else Scenario.load(each) for each in source]


def _is_scenario(file: Path) -> bool:
    import json

    if file.stat().st_size > 1 << 20:
        return False
    try:
        content = json.loads(file.read_text("utf-8"))
    except ValueError:
        return False
    return isinstance(content, dict) and str(content.get("format", "")).startswith("recrash.scenario/")


def runs(scenarios: Sequence[Scenario], ego: object = None, *, profile: str | None = None) -> list[Run | RecrashError]:
    """Run scenarios with one ego, in their order. What one fails of stands in its place, and the others go on.

    An ego by name runs on all cores. A Python object is called from this thread, a class is made anew for each run.
    """
    if ego is None or isinstance(ego, str):
        return [_as_result(each) for each in _recrash.run_all(scenarios, ego, profile)]
    results: list[Run | RecrashError] = []
    for scenario in scenarios:
        try:
            results.append(scenario.run(ego, profile=profile))
        except EgoError as error:
            results.append(error)
    return results


def _as_result(each: Run | Exception) -> Run | RecrashError:
    if isinstance(each, (Run, RecrashError)):
        return each
    raise each


def test(scenarios: Location | Iterable[Scenario | Location], ego: object = None, *, profile: str | None = None) -> Table:
    """Test an ego in scenarios. A row each: how its run ended, what it failed of, how near and how bad it was.

    ``ego`` is a name (see ``recrash.EGOS``), a command (``"cmd:./my_stack"``), or a Python object: a function of an
    observation, or a class or object with ``control(observation)`` and, if it likes, ``reset(world)`` and ``end(ending)``.
    An ego that raises fails its scenario, with ``error`` saying what and where; the rest goes on.
    """
    loaded = load_scenarios(scenarios)
    return Table.of_rows(
        [_row(scenario, result) for scenario, result in zip(loaded, runs(loaded, ego, profile=profile), strict=True)]
    )


test.__test__ = False  # type: ignore[attr-defined]  # pytest takes it for one of its own.


def _row(scenario: Scenario, result: Run | RecrashError) -> dict[str, Any]:
    row: dict[str, Any] = {"scenario": scenario.id, "template": scenario.template}
    if isinstance(result, RecrashError):
        return {**row, "error": str(result)}
    severity = result.severity
    failures = [finding["kind"] for finding in result.findings]
    return {
        **row,
        "ego": result.ego,
        "failed": result.failed,
        "termination": result.termination,
        "duration_s": result.duration_s,
        "findings": ";".join(dict.fromkeys(failures)) or None,
        "min_gap_m": result.min_gap_m,
        "closing_speed_mps": severity["closing_speed_mps"] if severity else None,
        "delta_v_mps": severity["first"]["delta_v_mps"] if severity else None,
        "state_hash": result.state_hash,
        "error": None,
    }


class Suite:
    """A folder with a test for each picked crash, made by :func:`run` or by the command ``recrash run``."""

    def __init__(self, folder: Location) -> None:
        self.folder = Path(folder)
        #: What the suite was made with.
        self.options: dict[str, Any] = _recrash.suite_options(self.folder)

    @classmethod
    def open(cls, folder: Location) -> Suite:
        """Open the suite in a folder, to read it. Others may work in it."""
        return cls(folder)

    @property
    def summary(self) -> dict[str, Any]:
        """The whole run in numbers, as ``recrash run --json`` prints it."""
        import json

        file = self.folder / "summary.json"
        if not file.is_file():
            raise InputError(f"{self.folder}: its report is not made yet; run the suite to its end")
        summary: dict[str, Any] = json.loads(file.read_text("utf-8"))
        return summary

    @property
    def cases(self) -> Table:
        """A row for each test: what the summary says of it."""
        return Table.of_rows(self.summary["cases"])

    def scenarios(self) -> list[Scenario]:
        """The scenarios, tuned where they were tuned."""
        return load_scenarios(self.folder)

    def test(self, ego: object = None, *, profile: str | None = None) -> Table:
        """Test an ego in the suite's scenarios, see :func:`test`. Nothing in the folder changes.

        Without ``ego`` the suite's own drives; a program that the suite names is not started, since a suite may be anybody's.
        """
        own = self.options.get("ego")
        if ego is None and own is not None and own not in _recrash.EGOS:
            raise InputError(f"{self.folder}: the suite wants to start {own!r} as the ego; name it yourself if you trust it")
        return test(self.scenarios(), own if ego is None else ego, profile=profile or self.options["profile"])

    def report(self) -> Path:
        """The page of the suite."""
        return self.folder / "report.html"

    def __len__(self) -> int:
        return len(self.summary["cases"])

    def __repr__(self) -> str:
        return f"Suite({str(self.folder)!r})"

    def _repr_html_(self) -> str:
        from recrash._show import table_html

        return table_html(self.cases)


def run(
    folder: Location,
    files: Location | Iterable[Location] | None = None,
    *,
    progress: bool | Progress | None = None,
    threads: int | None = None,
    replace: bool = False,
    trust: bool = False,
    until: str | None = None,
    **options: Any,
) -> Suite:
    """Make a suite in a folder, or go on with the one there; finished work is kept.

    ``files`` are crash files; the built-in sample without any. ``options`` are those of the command, with underscores:
    ``budget=20, ego="idm", seed=1, tune_budget=160``. ``progress`` shows a bar (by itself on a terminal and in a
    notebook), or is called with what happens. Ctrl-C stops between two units of work, and nothing is half written.
    """
    chosen = _files(files)
    # A program is started that the caller names, and none that only the suite's file does.
    trust = trust or options.get("ego") is not None
    if chosen is not None:
        options["records"] = {"files": [os.fspath(file) for file in chosen]}
    if callable(progress):
        listener: Progress | None = progress
    else:
        from recrash._show import progress_bar

        shown = sys.stderr.isatty() or "ipykernel" in sys.modules if progress is None else progress
        listener = progress_bar() if shown else None
    _recrash.run_suite(folder, options, listener, threads, replace, trust, until)
    return Suite(folder)

"""Crash files, suites of tests, and tests of an ego."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from recrash import _recrash
from recrash._recrash import Accounts, Run, Scenario, Table
from recrash._show import StageBars, counted, suite_html, wants_progress
from recrash.errors import EgoError, InputError, RecrashError

#: A file's or folder's path.
Location = str | os.PathLike[str]
#: Columns of a row of :func:`test` behind those of the scenario.
RESULTS = (
    "ego", "verdict", "failed", "met", "cause", "termination", "duration_s", "findings", "min_gap_m", "closing_speed_mps",
    "delta_v_mps", "other_delta_v_mps", "state_hash", "error",
)  # fmt: skip
#: Scenarios that are run between two looks at Ctrl-C.
AT_ONCE = 256
#: Rollouts of a sweep between two looks at Ctrl-C.
SWEEP_CHUNK = 4096
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
        types = _recrash.crash_types(folder)
        return [Scenario.load(file, crash_type=types.get(name.removesuffix(".json"))) for name, file in found.items()]
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


def runs(
    scenarios: Sequence[Scenario],
    ego: object = None,
    *,
    profile: str | None = None,
    simulator: str | None = None,
    python: Location | None = None,
    threads: int | None = None,
    progress: bool | None = None,
) -> list[Run | RecrashError]:
    """Run scenarios with one ego, in their order. What one fails of stands in its place, and the others go on.

    An ego by name runs on all cores, or on as many ``threads``. A Python object is called from this thread, a class is made anew
    for each run. The other arguments are those of :func:`test`.
    """
    shown = wants_progress(progress)
    if ego is None or isinstance(ego, str):
        host = _recrash.Simulator(ego, profile, simulator, python, threads)
        # Few enough that Ctrl-C is heard soon.
        parts = [scenarios[begin : begin + AT_ONCE] for begin in range(0, len(scenarios), AT_ONCE)]
        done = (in_tested(host.run_all, part) for part in parts)
        told = counted(done, "test", len(parts), shown and len(parts) > 1)
        return [as_result(each) for part in told for each in part]
    results: list[Run | RecrashError] = []
    for scenario in counted(scenarios, "test", len(scenarios), shown):
        if not scenario.tested:
            results.append(nothing_to_test(scenario))
            continue
        try:
            results.append(scenario.run(ego, profile=profile, simulator=simulator))
        except EgoError as error:
            results.append(error)
    return results


def in_tested(run: Callable[[list[Scenario]], Sequence[Run | Exception]], scenarios: Sequence[Scenario]) -> list[Run | Exception]:
    """Run the scenarios in which there is something to test; in the places of the others stands that there is nothing."""
    tested = [each for each in scenarios if each.tested]
    done = iter(run(tested) if tested else ())
    return [next(done) if each.tested else nothing_to_test(each) for each in scenarios]


def nothing_to_test(scenario: Scenario) -> RecrashError:
    """Say of the crash of a parked ego that nobody takes over."""
    return RecrashError(f"{scenario.id}: its ego was parked, so there is nothing to test")


def as_result(each: Run | Exception) -> Run | RecrashError:
    """Keep what a scenario failed of as a value; anything else is raised."""
    if isinstance(each, (Run, RecrashError)):
        return each
    raise each


def test(
    scenarios: Location | Iterable[Scenario | Location],
    ego: object = None,
    *,
    profile: str | None = None,
    simulator: str | None = None,
    python: Location | None = None,
    threads: int | None = None,
    progress: bool | None = None,
) -> Table:
    """Test an ego in scenarios. A row each: how its run ended, what it failed of, how near and how bad it was.

    ``ego`` is a name (see ``recrash.EGOS``), a command (``"cmd:./my_stack"``), or a Python object: a function of an
    observation, or a class or object with ``control(observation)`` and, if it likes, ``reset(world)`` and ``end(ending)``.
    A scenario in which an ego raises is not run, with ``error`` saying what and where; the rest goes on.

    ``verdict`` is ``failed``, ``passed``, ``unmet`` (no failure, and never in the situation of its record: no pass) or
    ``not_run``, as of records whose ego was parked: ``error`` says why.

    ``simulator="metadrive"`` runs MetaDrive's own egos (``recrash.METADRIVE_EGOS``) in MetaDrive; ``python`` is the interpreter
    that has it, this one without. ``progress`` shows a bar, by itself on a terminal and in a notebook.
    """
    loaded = load_scenarios(scenarios)
    options: dict[str, Any] = {"simulator": simulator, "python": python, "threads": threads, "progress": progress}
    results = runs(loaded, ego, profile=profile, **options)
    return Table.of_rows([row_of(scenario, result) for scenario, result in zip(loaded, results, strict=True)])


test.__test__ = False  # type: ignore[attr-defined]  # pytest takes it for one of its own.


def sweep(
    scenarios: Location | Iterable[Scenario | Location],
    rollouts: int,
    *,
    vary: Sequence[str] = (),
    ego: str | None = None,
    profile: str | None = None,
    seed: int = 0,
    progress: bool | None = None,
) -> Table:
    """Run very many rollouts around scenarios, each with other numbers, on all cores. A row each, as ``docs/sweep.md`` has it.

    ``vary`` are numbers of the scenarios and their ranges (``"/partners/0/speed_mps=5:12"``); without it what a search for
    failures would move. Rollout by rollout the scenarios take turns; those whose ego was parked are left out. A
    rollout is made of its number and the ``seed`` alone. :func:`recrash.ray.sweep` does the same on a cluster.
    """
    points = _recrash.Points(load_scenarios(scenarios), list(vary), ego, profile, seed)
    ranges = [(begin, min(begin + SWEEP_CHUNK, rollouts)) for begin in range(0, rollouts, SWEEP_CHUNK)] or [(0, 0)]
    shown = wants_progress(progress)
    return Table.concat([points.rows(*each) for each in counted(ranges, "sweep", len(ranges), shown)])


def tune(
    scenarios: Location | Iterable[Scenario | Location],
    ego: str | None = None,
    *,
    profile: str | None = None,
    budget: int = 160,
    seed: int = 0,
    searcher: str = "cma",
    progress: bool | None = None,
) -> tuple[list[Scenario], Table]:
    """Search the nearest failure of an ego around each scenario: the tuned scenarios, and a row for each.

    ``budget`` is the number of points that are tried at most, ``searcher`` is ``cma`` or ``halton``. A scenario in which nothing
    can vary, or whose ego was parked, stays as it is, with ``error`` saying so. Suites are tuned as they are made (:func:`run`),
    where the search also keeps what their records tell.
    """
    loaded = load_scenarios(scenarios)
    tuned: list[Scenario] = []
    rows = []
    for scenario in counted(loaded, "tune", len(loaded), wants_progress(progress)):
        made, row = tune_one(scenario, ego, profile, budget, seed, searcher)
        tuned.append(made)
        rows.append(row)
    return tuned, Table.of_rows(rows)


def tune_one(
    scenario: Scenario, ego: str | None, profile: str | None, budget: int, seed: int, searcher: str
) -> tuple[Scenario, dict[str, Any]]:
    """Tune one scenario; its row says how its run ends then, and what was moved."""
    try:
        made, run, log = _recrash.tune_one(scenario, ego, profile, budget, seed, searcher)
    except RecrashError as error:
        return scenario, {**row_of(scenario, error), "points": 0, "moved": None}
    values = log["points"][log["best"]]["values"]
    moved = {parameter["pointer"]: value for parameter, value in zip(log["parameters"], values, strict=True)}
    return made, {**row_of(scenario, run), "points": len(log["points"]), "moved": moved}


def row_of(scenario: Scenario, result: Run | RecrashError) -> dict[str, Any]:
    """Put a run, or what a scenario failed of, as a row of :func:`test`."""
    row: dict[str, Any] = {"scenario": scenario.id, "template": scenario.template, "crash_type": scenario.crash_type}
    if isinstance(result, RecrashError):
        return {**row, **dict.fromkeys(RESULTS), "verdict": "not_run", "error": str(result)}
    severity = result.severity
    failures = [finding["kind"] for finding in result.findings]
    return {
        **row,
        "ego": result.ego,
        "verdict": "failed" if result.failed else "unmet" if result.met is False else "passed",
        "failed": result.failed,
        "met": result.met,
        "cause": result.cause,
        "termination": result.termination,
        "duration_s": result.duration_s,
        "findings": ";".join(dict.fromkeys(failures)) or None,
        "min_gap_m": result.min_gap_m,
        "closing_speed_mps": severity["closing_speed_mps"] if severity else None,
        "delta_v_mps": severity["first"]["delta_v_mps"] if severity else None,
        "other_delta_v_mps": severity["second"]["delta_v_mps"] if severity else None,
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

    def test(self, ego: object = None, *, profile: str | None = None, **options: Any) -> Table:
        """Test an ego in the suite's scenarios, ``options`` as of :func:`test`. Nothing in the folder changes.

        Without ``ego`` the suite's own drives; a program that the suite names is not started, since a suite may be anybody's.
        """
        own = self.options.get("ego")
        if ego is None and own is not None and own not in {*_recrash.EGOS, *_recrash.METADRIVE_EGOS}:
            raise InputError(f"{self.folder}: the suite wants to start {own!r} as the ego; name it yourself if you trust it")
        options.setdefault("simulator", self.options.get("simulator") if ego is None else None)
        return test(self.scenarios(), own if ego is None else ego, profile=profile or self.options["profile"], **options)

    def report(self, *, show: bool = False) -> Path:
        """The page of the suite; ``show`` opens it in a browser."""
        file = self.folder / "report.html"
        if not file.is_file():
            raise InputError(f"{self.folder}: its report is not made yet; run the suite to its end")
        if show:
            import webbrowser

            webbrowser.open(file.resolve().as_uri())
        return file

    def __len__(self) -> int:
        return len(self.summary["cases"])

    def __repr__(self) -> str:
        return f"Suite({str(self.folder)!r})"

    def _repr_html_(self) -> str:
        return suite_html(self)


def run(
    folder: Location,
    files: Location | Iterable[Location] | None = None,
    *,
    progress: bool | Progress | None = None,
    threads: int | None = None,
    replace: bool = False,
    trust: bool = False,
    until: str | None = None,
    python: Location | None = None,
    **options: Any,
) -> Suite:
    """Make a suite in a folder, or go on with the one there; finished work is kept.

    ``files`` are crash files; the built-in sample without any. ``options`` are those of the command, with underscores:
    ``budget=20, ego="idm", seed=1, tune_budget=160, simulator="metadrive"``; ``python`` is the interpreter that has MetaDrive,
    this one without. ``progress`` shows a bar (by itself on a terminal and in a
    notebook), or is called with what happens. Ctrl-C stops between two units of work, and nothing is half written.
    """
    chosen = _files(files)
    # A program is started that the caller names, and none that only the suite's file does.
    trust = trust or options.get("ego") is not None
    if chosen is not None:
        options["records"] = {"files": [os.fspath(file) for file in chosen]}
    bars = StageBars()
    listener: Progress | None = progress if callable(progress) else bars if wants_progress(progress) else None
    try:
        _recrash.run_suite(folder, options, listener, threads, replace, trust, until, python)
    finally:
        bars.close()
    return Suite(folder)

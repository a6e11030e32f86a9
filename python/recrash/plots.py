"""Plots for papers: a run, the crashes of a corpus, the results of an ego (needs ``matplotlib``).

Every function draws into a figure of its own, or into the axes it is given, and hands it back: ``figure.savefig("run.pdf")``.
Units are SI and stand on the axes; the colours (Okabe and Ito) are told apart by everybody and in print.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib import pyplot

if TYPE_CHECKING:
    from recrash._recrash import Run, Table
    from recrash.suite import Suite

__all__ = ["COLOURS", "STYLE", "corpus", "results", "run", "series", "suite", "tracks"]

#: Colours by what they stand for.
COLOURS = {
    "ego": "#0072B2",
    "partner": "#D55E00",
    "traffic": "#999999",
    "part": "#E69F00",
    "shown": "#009E73",
    "not_shown": "#E69F00",
    "untold": "#CCCCCC",
    "passed": "#009E73",
    "failed": "#D55E00",
    "not_run": "#000000",
    "parked": "#E8E8E8",
    "unmet": "#CCCCCC",
}
#: What all plots share: sizes of a column of a paper, and letters that stay letters in a PDF.
STYLE = {
    "font.size": 8.0,
    "axes.titlesize": 8.0,
    "axes.labelsize": 8.0,
    "legend.fontsize": 7.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "savefig.dpi": 300,
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
}
#: A column, and a page of two columns. [inch]
COLUMN, PAGE = 3.5, 7.16
#: What lies on the ground, by its shape.
GROUND = {"bike": "#d5e8dc", "median": "#dbe5d3", "sidewalk": "#eeeeee", "crosswalk": "#ffffff", "building": "#cfc8c0"}
#: Around everybody's way. [m]
MARGIN_M = 8.0


def _columns(table: Table | Mapping[str, Sequence[Any]]) -> dict[str, list[Any]]:
    """Columns of a table, or what is columns already."""
    if isinstance(table, Mapping):
        return {name: list(values) for name, values in table.items()}
    return table.to_dict()


def _words(name: object) -> str:
    """A name as people read it."""
    return "not told" if name is None else str(name).replace("_", " ")


def tracks(run: Run, *, every_s: float = 1.0, ax: Any = None) -> Any:
    """Draw the roads and everybody's box over time, darker the later; contacts are crosses. Gives the axes.

    ``every_s`` is the time between two boxes [s].
    """
    with matplotlib.rc_context(STYLE):
        if ax is None:
            _, ax = pyplot.subplots(figsize=(PAGE, 3.2), layout="constrained")
        states, actors, times = run.states, run.actors, run.times
        _roads(ax, run.drawing)
        every = max(1, round(every_s / 0.1))
        handles: dict[str, Any] = {}
        near = []
        for number, actor in reversed(list(enumerate(actors))):
            gone = float("inf") if actor["gone_s"] is None else actor["gone_s"]
            there = np.flatnonzero((times >= actor["appears_s"] - 1e-9) & (times < gone - 1e-9))
            if len(there) == 0:
                continue
            colour, way = COLOURS[actor["role"]], states[there, number, :2]
            ax.plot(way[:, 0], way[:, 1], color=colour, linewidth=0.6, zorder=3)
            if actor["role"] in ("ego", "partner"):
                near.append(way)
            chosen = sorted({*there[::every].tolist(), int(there[-1])})
            for step in chosen:
                shade = 0.15 + 0.75 * step / max(1, len(times) - 1)
                x, y, heading = states[step, number, :3]
                box = _box(x, y, heading, actor["length_m"], actor["width_m"])
                (drawn,) = ax.fill(*box.T, facecolor=colour, edgecolor=colour, alpha=shade, linewidth=0.5, zorder=4)
                handles[actor["role"]] = drawn
        for event in run.events:
            if event["kind"]["event"] == "contact":
                first, second = event["kind"]["a_state"], event["kind"]["b_state"]
                middle = ((first["x"] + second["x"]) / 2, (first["y"] + second["y"]) / 2)
                (cross,) = ax.plot(*middle, marker="x", color="black", markersize=6, linestyle="none", zorder=6)
                handles.setdefault(f"contact at {event['time_s']:.1f} s", cross)
        points = np.concatenate(near)
        low, high = points.min(axis=0) - MARGIN_M, points.max(axis=0) + MARGIN_M
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), xlabel="x [m]", ylabel="y [m]")
        ax.set_aspect("equal", adjustable="box")
        ax.set_title(f"{run.scenario_id}, {run.ego}: a box every {every_s:g} s")
        order = sorted(handles, key=lambda name: (*COLOURS, name).index(name))
        ax.legend([handles[name] for name in order], order, loc="best", frameon=True)
    return ax


def _roads(ax: Any, drawing: Mapping[str, Any] | None) -> None:
    """Draw what is drawn of the road."""
    if drawing is None:
        return
    for surface in drawing["surfaces"]:
        ax.fill(*_points(surface).T, facecolor="#e3e5e8", edgecolor="none", zorder=0)
    for area in drawing.get("areas", ()):
        colour = GROUND.get(area["shape"], "#dcdfe3")
        ax.fill(*_points(area["points"]).T, facecolor=colour, edgecolor="none", zorder=1)
    dashes = {"lane_divider": (0, (6, 6)), "guide": (0, (1, 3))}
    for line in drawing["lines"]:
        colour = {"centre": "#c8a415", "stop": "#444444"}.get(line["kind"], "#9aa1a9")
        broad = 1.6 if line["kind"] == "stop" else 0.6
        style = dashes.get(line["kind"], "solid")
        ax.plot(*_points(line["points"]).T, color=colour, linewidth=broad, linestyle=style, zorder=2)


def _points(points: Iterable[Mapping[str, float]]) -> Any:
    return np.array([(point["x"], point["y"]) for point in points])


def _box(x: float, y: float, heading: float, length: float, width: float) -> Any:
    """Corners of a box around its middle, shape (4, 2). [m]"""
    corners = 0.5 * np.array([(length, width), (-length, width), (-length, -width), (length, -width)])
    turn = np.array([(np.cos(heading), np.sin(heading)), (-np.sin(heading), np.cos(heading))])
    return corners @ turn + (x, y)


def series(run: Run, *, axes: Sequence[Any] | None = None, most_ttc_s: float = 10.0) -> Any:
    """Draw speed, gap and time to collision over time, one above the other. Gives the three axes.

    A time to collision above ``most_ttc_s`` [s] is left out; contacts of the ego are dotted lines.
    """
    with matplotlib.rc_context(STYLE):
        if axes is None:
            _, axes = pyplot.subplots(3, 1, figsize=(COLUMN, 4.2), sharex=True, layout="constrained")
        speed, gap, ttc = axes
        told = run.series
        time = np.array(told["time_s"])
        speed.plot(time, told["ego_speed_mps"], color=COLOURS["ego"], label="ego")
        for number, partner in enumerate(told["partners"]):
            style = ("solid", "dashed", "dotted", "dashdot")[number % 4]
            look = {"color": COLOURS["partner"], "linestyle": style, "label": partner["id"]}
            there = len(partner["gap_m"])
            speed.plot(time[:there], partner["speed_mps"], **look)
            gap.plot(time[:there], partner["gap_m"], **look)
            seconds = np.array([np.nan if value is None else value for value in partner["ttc_s"]], dtype=float)
            ttc.plot(time[:there], np.where(seconds <= most_ttc_s, seconds, np.nan), **look)
        for event in run.events:
            if 0 in (event["kind"].get("a"), event["kind"].get("actor")):
                for ax in axes:
                    ax.axvline(event["time_s"], color="black", linestyle="dotted", linewidth=0.8)
        speed.set_ylabel("speed [m/s]")
        gap.set_ylabel("gap of boxes [m]")
        ttc.set(ylabel="time to\ncollision [s]", xlabel="time [s]", ylim=(0.0, most_ttc_s))
        gap.set_ylim(bottom=0.0)
        speed.set_ylim(bottom=0.0)
        speed.legend(loc="best")
    return axes


def run(run: Run, *, every_s: float = 1.0) -> Any:
    """Draw a run: tracks with boxes on the left, speed, gap and time to collision on the right. Gives the figure."""
    with matplotlib.rc_context(STYLE):
        figure = pyplot.figure(figsize=(PAGE, 3.6), layout="constrained")
        grid = figure.add_gridspec(3, 2, width_ratios=(1.7, 1.0))
        tracks(run, every_s=every_s, ax=figure.add_subplot(grid[:, 0]))
        first = figure.add_subplot(grid[0, 1])
        rest = [figure.add_subplot(grid[row, 1], sharex=first) for row in (1, 2)]
        for ax in (first, rest[0]):
            ax.tick_params(labelbottom=False)
        series(run, axes=[first, *rest])
    return figure


def corpus(made: Table | Mapping[str, Sequence[Any]], *, ax: Any = None) -> Any:
    """Draw how many incidents of each crash type are told. Gives the axes.

    ``made`` is the second of what :meth:`recrash.Accounts.reconstruct` gives: columns ``crash_type`` and ``standing``.
    """
    columns = _columns(made)
    counts = Counter(zip(columns["crash_type"], columns["standing"], strict=True))
    types = [each for each, _ in Counter(columns["crash_type"]).most_common()][::-1]
    words = {"shown": "told, every fact shown", "not_shown": "a told fact not shown", "untold": "cannot be told yet"}
    with matplotlib.rc_context(STYLE):
        if ax is None:
            _, ax = pyplot.subplots(figsize=(PAGE * 0.6, 0.6 + 0.19 * len(types)), layout="constrained")
        _stacked(ax, types, {name: [counts[each, name] for each in types] for name in words}, words)
        ax.set_xlabel("incidents")
    return ax


def _stacked(ax: Any, names: Sequence[Any], parts: Mapping[str, Sequence[int]], words: Mapping[str, str]) -> None:
    """Bars side by side on one line for each name."""
    left = np.zeros(len(names), dtype=int)
    for part, values in parts.items():
        ax.barh(range(len(names)), values, left=left, color=COLOURS[part], height=0.75, label=words[part])
        left = left + np.array(values, dtype=int)
    ax.set_yticks(range(len(names)), [_words(name) for name in names])
    ax.set_xlim(left=0)
    ax.xaxis.get_major_locator().set_params(integer=True)
    ax.legend(loc="lower right")


def results(table: Table | Mapping[str, Sequence[Any]], *, axes: Sequence[Any] | None = None, by: str = "crash_type") -> Any:
    """Draw what an ego did: verdicts by crash type, and how bad its contacts were. Gives the two axes.

    ``table`` is what :func:`recrash.test` gives. ``by`` is the column of the bars.
    """
    columns = _columns(table)
    verdicts = columns["verdict"]
    counts = Counter(zip(columns[by], verdicts, strict=True))
    names = [each for each, _ in Counter(columns[by]).most_common()][::-1]
    words = {"passed": "passed", "failed": "failed", "unmet": "never in the situation", "not_run": "not run"}
    used = {name: word for name, word in words.items() if name in verdicts}
    with matplotlib.rc_context(STYLE):
        if axes is None:
            size = (PAGE, max(2.2, 0.6 + 0.19 * len(names)))
            _, axes = pyplot.subplots(1, 2, figsize=size, layout="constrained", width_ratios=(1.4, 1.0))
        bars, hist = axes
        _stacked(bars, names, {name: [counts[each, name] for each in names] for name in used}, used)
        bars.set_xlabel("tests")
        speeds = [value for value in columns.get("delta_v_mps", ()) if value is not None]
        most = max(speeds, default=1.0)
        hist.hist(speeds, bins=np.arange(0.0, most + 1.0, max(0.5, np.ceil(most) / 20)), color=COLOURS["failed"])
        hist.set(xlabel="change of velocity in the first contact [m/s]", ylabel="contacts")
        hist.set_title(f"{len(speeds)} contacts in {len(verdicts)} tests")
        hist.yaxis.get_major_locator().set_params(integer=True)
    return axes


def _suite_verdict(case: Mapping[str, Any], last: Mapping[str, Any] | None) -> str:
    """What the last run of a case says: a run that never came into the situation of its record and did not fail is no pass."""
    if last is None:
        return "not_run" if case.get("failure") else "parked"
    if last["failed"]:
        return "failed"
    return "unmet" if last.get("met") is False else "passed"


def suite(suite: Suite) -> Any:
    """Draw a suite as it was run: verdicts by crash type (or template), and least gaps. Gives the figure."""
    summary = suite.summary
    cases = summary["cases"]
    last = [case.get("tuned") or case.get("first") for case in cases]
    names = [_case_type(case) for case in cases]
    verdicts = [_suite_verdict(case, each) for case, each in zip(cases, last, strict=True)]
    words = {
        "passed": "passed",
        "failed": "failed",
        "unmet": "never in the situation",
        "parked": "nothing to test",
        "not_run": "not run",
    }
    order = [each for each, _ in Counter(names).most_common()][::-1]
    counts = Counter(zip(names, verdicts, strict=True))
    with matplotlib.rc_context(STYLE):
        size = (PAGE, max(2.2, 0.6 + 0.19 * len(order)))
        figure, (bars, gaps) = pyplot.subplots(1, 2, figsize=size, layout="constrained", width_ratios=(1.4, 1.0))
        used = {name: word for name, word in words.items() if name in verdicts}
        _stacked(bars, order, {name: [counts[each, name] for each in order] for name in used}, used)
        bars.set_xlabel("tests")
        least = [each["min_gap_m"] for each in last if each is not None and each["min_gap_m"] is not None]
        gaps.hist(least, bins=20, color=COLOURS["ego"])
        gaps.set(xlabel="least gap of boxes to a partner [m]", ylabel="tests")
        gaps.yaxis.get_major_locator().set_params(integer=True)
        figure.suptitle(
            f"{len(cases)} tests, {summary['ego']} on {summary['simulator']}, profile {summary['profile']}", fontsize=8
        )
    return figure


def _case_type(case: Mapping[str, Any]) -> str:
    """The crash type of a case; of a suite by templates its template."""
    kind = case.get("crash_type") or case["template"]
    return " ".join(str(value) for value in kind.values()) if isinstance(kind, Mapping) else str(kind)

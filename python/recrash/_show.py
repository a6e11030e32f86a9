"""Progress, tables and replays for people."""

from __future__ import annotations

import html
import shutil
import sys
import warnings
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from recrash._recrash import Run, Scenario, Table
    from recrash.suite import Suite

Item = TypeVar("Item")

#: Rows of a table that a notebook shows.
MOST_ROWS = 50
#: Rows of a table that a terminal shows; characters of a cell, and to what they are cut where room is scarce.
MOST_PRINTED, CELLS = 20, (44, 28, 20, 14)
#: Colours of the report's page.
COLOURS = {"ego": "#47b1f2", "partner": "#ff9a45", "part": "#ff9a45", "traffic": "#b9c1c9"}
GROUND = {"bike": "#4c7564", "median": "#9aac8d", "sidewalk": "#c2c8cd", "crosswalk": "#e6eaee", "building": "#a99f92"}
#: Around everybody's way. [m]
MARGIN_M = 9.0


def table_html(table: Table) -> str:
    """A table for a notebook. Every text of it is escaped: narratives are somebody else's."""
    cells = [f"<th>{html.escape(name)}</th>" for name in table.column_names]
    rows = [f"<tr>{''.join(cells)}</tr>"]
    for row in table.head(MOST_ROWS).to_dicts():
        values = ["" if value is None else str(value) for value in row.values()]
        rows.append("<tr>" + "".join(f"<td>{html.escape(value[:80])}</td>" for value in values) + "</tr>")
    more = f"<p>{len(table)} rows, the first {MOST_ROWS} shown</p>" if len(table) > MOST_ROWS else ""
    return f"<table>{''.join(rows)}</table>{more}"


def table_text(table: Table) -> str:
    """A table for a terminal: its first rows, cells cut where that makes room, and the columns that fit; the others are named."""
    names, rows = table.column_names, table.head(MOST_PRINTED).to_dicts()
    room = shutil.get_terminal_size((120, 24)).columns
    for most in CELLS:
        columns = [
            [_cell(name, CELLS[0]), *(_cell(row[name], CELLS[0] if name == names[0] else most) for row in rows)] for name in names
        ]
        widths = [max(map(len, column)) for column in columns]
        if sum(widths) + 2 * len(widths) - 2 <= room:
            break
    shown = 1
    while shown < len(names) and sum(widths[: shown + 1]) + 2 * shown <= room:
        shown += 1
    lines = ["  ".join(map(str.ljust, line, widths)).rstrip() for line in zip(*columns[:shown], strict=True)]
    lines.insert(1, "  ".join("\u2500" * width for width in widths[:shown]))
    if len(table) > MOST_PRINTED:
        lines.append(f"{len(table)} rows, the first {MOST_PRINTED} shown")
    if shown < len(names):
        lines.append(f"not shown: {', '.join(names[shown:])}")
    return "\n".join(lines)


def _cell(value: object, most: int) -> str:
    """A value in one line. What a terminal would obey is not: texts are somebody else's."""
    text = "" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)
    plain = "".join(each if each.isprintable() else " " for each in text)
    return plain if len(plain) <= most else plain[: most - 1] + "\u2026"


def _facts(facts: Mapping[str, object]) -> str:
    """Names and values, a line each."""
    rows = "".join(
        f"<tr><th style='text-align:left'>{html.escape(name)}</th><td style='text-align:left'>{html.escape(str(value))}</td></tr>"
        for name, value in facts.items()
        if value not in (None, "", [])
    )
    return f"<table>{rows}</table>"


def scenario_html(scenario: Scenario) -> str:
    """A scenario for a notebook: what it is, and its replay with the recorded driver."""
    facts = {
        "scenario": scenario.id,
        "crash": (scenario.crash_type or "").replace("_", " "),
        "others": ", ".join(scenario.kinds).replace("_", " "),
        "reports": ", ".join(scenario.reports),
        "at most": f"{scenario.duration_s:g} s",
    }
    return _facts(facts) + replay(scenario.run("recorded"))


def run_html(run: Run) -> str:
    """A run for a notebook: what it shows, and its replay."""
    change = run.delta_v_mps
    facts = {
        "scenario": run.scenario_id,
        "ego": run.ego,
        "ended": f"{run.termination.replace('_', ' ')} after {run.duration_s:.1f} s",
        "failed": {True: "yes", False: "no", None: "not tested"}[run.failed],
        "findings": "; ".join(finding["sentence"] for finding in run.findings),
        "change of velocity": None if change is None else f"{change:.1f} m/s",
    }
    return _facts(facts) + replay(run)


def suite_html(suite: Suite) -> str:
    """A suite for a notebook: its numbers, and a row for each test."""
    summary = suite.summary
    last = [case.get("tuned") or case.get("first") for case in summary["cases"]]
    failed = sum(bool(each and each["failed"]) for each in last)
    facts = {
        "suite": suite.folder,
        "tests": len(last),
        "failed": failed,
        "ego": summary["ego"],
        "simulator": summary["simulator"],
        "profile": summary["profile"],
        "page": suite.report(),
    }
    return _facts(facts) + table_html(suite.cases)


def replay(run: Run) -> str:
    """A run as a picture that moves (SVG, no script): the roads, and everybody's box from start to end, again and again."""
    # Not above: the package is imported quickly.
    import numpy as np

    states, actors, times = run.states, run.actors, run.times
    least = [number for number, actor in enumerate(actors) if actor["role"] in ("ego", "partner")]
    seen = states[:, least, :2].reshape(-1, 2)
    (left, low), (right, high) = seen.min(axis=0) - MARGIN_M, seen.max(axis=0) + MARGIN_M
    shapes = [f"<title>{html.escape(run.scenario_id)}: {html.escape(run.ego)}</title>"]
    shapes += [f'<rect x="{left:.1f}" y="{-high:.1f}" width="{right - left:.1f}" height="{high - low:.1f}" fill="#dfe5dc"/>']
    shapes += list(_ground(run.drawing))
    lasts_s = max(float(times[-1]), 0.1)
    moves = f'dur="{lasts_s:.1f}s" repeatCount="indefinite"'
    for number, actor in reversed(list(enumerate(actors))):
        there = states[:, number]
        turns = np.degrees(np.unwrap(there[:, 2]))
        places = ";".join(f"{x:.2f} {-y:.2f}" for x, y in there[:, :2])
        angles = ";".join(f"{-turn:.1f}" for turn in turns)
        length, width = actor["length_m"], actor["width_m"]
        shown = _presence(actor, lasts_s, moves)
        nose = (
            ""
            if actor["role"] == "part"
            else f'<path d="M{0.25 * length:.2f} {-0.5 * width:.2f}v{width:.2f}" stroke="#101820" stroke-width=".15"/>'
        )
        shapes.append(
            f'<g>{shown}<animateTransform attributeName="transform" type="translate" values="{places}" {moves}/>'
            f'<g><animateTransform attributeName="transform" type="rotate" values="{angles}" {moves}/>'
            f'<rect x="{-0.5 * length:.2f}" y="{-0.5 * width:.2f}" width="{length:.2f}" height="{width:.2f}" '
            f'fill="{COLOURS.get(actor["role"], "#b9c1c9")}" stroke="#101820" stroke-width=".12"/>{nose}</g></g>'
        )
    box = f"{left:.1f} {-high:.1f} {right - left:.1f} {high - low:.1f}"
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="720" style="max-width:100%">{"".join(shapes)}</svg>'


def _presence(actor: Mapping[str, Any], lasts_s: float, moves: str) -> str:
    """Hides whoever is not there yet, or not any more."""
    comes, goes = actor["appears_s"], actor["gone_s"]
    if comes <= 0.0 and goes is None:
        return ""
    begin, end = min(comes / lasts_s, 1.0), min((lasts_s if goes is None else goes) / lasts_s, 1.0)
    times, values = [0.0], ["visible" if begin <= 0.0 else "hidden"]
    for at, value in ((begin, "visible"), (end, "hidden")):
        if times[-1] < at < 1.0:
            times.append(at)
            values.append(value)
    told = ";".join(f"{at:.4f}" for at in times)
    return f'<animate attributeName="visibility" calcMode="discrete" values="{";".join(values)}" keyTimes="{told}" {moves}/>'


def _ground(drawing: Mapping[str, Any] | None) -> Iterator[str]:
    """Roads as SVG."""
    if drawing is None:
        return

    def data(points: Iterable[Mapping[str, float]]) -> str:
        return " ".join(f"{point['x']:.1f},{-point['y']:.1f}" for point in points)

    for surface in drawing["surfaces"]:
        yield f'<polygon points="{data(surface)}" fill="#59616a"/>'
    for area in drawing.get("areas", ()):
        yield f'<polygon points="{data(area["points"])}" fill="{GROUND.get(area["shape"], "#656e78")}"/>'
    for line in drawing["lines"]:
        colour = {"centre": "#f2c230", "guide": "#8b949d"}.get(line["kind"], "#eef1f4")
        dashes = ' stroke-dasharray="3 4.5"' if line["kind"] == "lane_divider" else ""
        broad = 0.45 if line["kind"] == "stop" else 0.15
        yield f'<polyline points="{data(line["points"])}" fill="none" stroke="{colour}" stroke-width="{broad}"{dashes}/>'


def wants_progress(asked: bool | None) -> bool:
    """Whether somebody looks on: a terminal or a notebook, where nobody said."""
    return sys.stderr.isatty() or "ipykernel" in sys.modules if asked is None else asked


class Bar:
    """Counts what is done: tqdm's bar where it is installed (a widget in notebooks), else a line on the standard error."""

    def __init__(self, name: str, total: int) -> None:
        self.name, self.total, self.done = name, total, 0
        self.bar: Any = None
        try:
            with warnings.catch_warnings():
                # Without ipywidgets tqdm warns, and draws its bar in letters.
                warnings.simplefilter("ignore")
                from tqdm.auto import tqdm
        except ImportError:
            self._line()
        else:
            self.bar = tqdm(total=total, desc=name)

    def advance(self, units: int = 1) -> None:
        """So many more are done."""
        self.done += units
        if self.bar is not None:
            self.bar.update(units)
        else:
            self._line()

    def close(self) -> None:
        """Leave the line as it stands: nothing more is done, or somebody pressed Ctrl-C."""
        if self.bar is not None:
            self.bar.close()
        elif self.done < self.total:
            sys.stderr.write("\n")

    def _line(self) -> None:
        width = 30 * self.done // max(self.total, 1)
        end = "\n" if self.done >= self.total else ""
        sys.stderr.write(f"\r{self.name:>12} [{'=' * width:<30}] {self.done}/{self.total}{end}")
        sys.stderr.flush()

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def counted(items: Iterable[Item], name: str, total: int, shown: bool) -> Iterator[Item]:
    """Items one by one, with a bar where it is shown; the bar is closed whatever happens."""
    if not shown:
        yield from items
        return
    with Bar(name, total) as bar:
        for item in items:
            yield item
            bar.advance()


class StageBars:
    """A bar for each stage of a suite; called with what happens."""

    def __init__(self) -> None:
        self.bar: Bar | None = None

    def __call__(self, stage: str, units: int, begins: bool) -> None:
        """Take note."""
        if begins:
            self.close()
            self.bar = Bar(stage, units)
        elif self.bar is not None:
            self.bar.advance(units)

    def close(self) -> None:
        """Close the last bar."""
        if self.bar is not None:
            self.bar.close()
            self.bar = None

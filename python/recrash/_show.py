"""Progress and tables for people."""

from __future__ import annotations

import html
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from recrash._recrash import Table

#: Rows of a table that a notebook shows.
MOST_ROWS = 50


def table_html(table: Table) -> str:
    """A table for a notebook. Every text of it is escaped: narratives are somebody else's."""
    cells = [f"<th>{html.escape(name)}</th>" for name in table.column_names]
    rows = [f"<tr>{''.join(cells)}</tr>"]
    for row in table.to_dicts()[:MOST_ROWS]:
        values = ["" if value is None else str(value) for value in row.values()]
        rows.append("<tr>" + "".join(f"<td>{html.escape(value[:80])}</td>" for value in values) + "</tr>")
    more = f"<p>{len(table)} rows, the first {MOST_ROWS} shown</p>" if len(table) > MOST_ROWS else ""
    return f"<table>{''.join(rows)}</table>{more}"


def progress_bar() -> Callable[[str, int, bool], None]:
    """A line on the standard error that counts the units of each stage; in a notebook as well."""
    stage_now, total, done = "", 0, 0

    def told(stage: str, units: int, begins: bool) -> None:
        nonlocal stage_now, total, done
        if begins:
            stage_now, total, done = stage, units, 0
        else:
            done += units
        width = 30 * done // max(total, 1)
        sys.stderr.write(f"\r{stage_now:>12} [{'=' * width:<30}] {done}/{total}" + ("\n" if done >= total else ""))
        sys.stderr.flush()

    return told

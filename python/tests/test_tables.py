"""Crash files, and tables that leave by the Arrow PyCapsule interface."""

from __future__ import annotations

import copy
import pickle

import pandas
import polars
import pyarrow
import pytest
from conftest import case, command

import recrash
from recrash import InputError, Scenario, Table
from recrash._show import table_html, table_text


def test_the_sample_is_read_and_reconstructed():
    accounts = recrash.read()
    assert len(accounts) == len(accounts.table) > 200
    assert accounts.incidents >= len(accounts)
    assert accounts[0]["incident"] == accounts.table.to_dicts()[0]["incident"]
    assert accounts[-1] == accounts[len(accounts) - 1]
    with pytest.raises(IndexError):
        accounts[len(accounts)]


def test_records_and_accounts_are_joined_by_their_incident():
    accounts = pandas.DataFrame.from_arrow(recrash.read().table)
    records = pandas.DataFrame.from_arrow(recrash.records(all_rows=True))
    joined = accounts.merge(records, on=["report", "version"], suffixes=("", "_of_record"))
    assert len(joined) == len(accounts) and (joined["incident"] == joined["incident_of_record"]).all()
    assert joined["entity"].eq(joined["entity_of_record"]).all()


def test_a_pickled_or_copied_table_is_the_same(rows):
    table = Table.concat([Table.of_rows([*rows, {"name": None, "count": None, "share": 1 / 3, "yes": None, "more": "x"}])] * 2)
    empty = Table.of_rows([{"a": None}])
    for one in (table, empty, Table.of_rows([]), table.head(0)):
        for same in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), copy.copy(one)):
            assert pyarrow.table(same) == pyarrow.table(one)


def test_accounts_keep_their_columns_when_they_are_pickled():
    accounts = recrash.read()
    part = pickle.loads(pickle.dumps(accounts.part(3, 9)))
    assert part.table.to_dicts() == accounts.table.to_dicts()[3:9]
    assert part.table.to_dict()["entity"][0]


def test_made_has_the_impact_of_what_is_shown():
    scenarios, made = recrash.read().reconstruct()
    by_id = {scenario.id: scenario for scenario in scenarios}
    rows = made.to_dicts()
    shown = [row for row in rows if row["standing"] == "shown"]
    assert len(shown) == len(scenarios) and all(row["facts_shown"] <= row["facts_told"] for row in shown)
    assert all(row["delta_v_mps"] is None for row in rows if row not in shown)
    for row in shown[::25] + [row for row in shown if row["delta_v_mps"] is None]:
        severity = by_id[row["scenario"]].run("recorded").severity
        if severity is None:
            assert row["ego_impact_speed_mps"] is row["delta_v_mps"] is None
            continue
        assert row["ego_impact_speed_mps"] == severity["first"]["impact_speed_mps"]
        assert row["other_impact_speed_mps"] == severity["second"]["impact_speed_mps"]
        assert row["delta_v_mps"] == severity["first"]["delta_v_mps"]


def test_scenes_of_the_command_keep_their_crash_types(tmp_path):
    done = command("reconstruct", "--where", "road = highway", "--to-dir", tmp_path / "scenes", "--quiet")
    assert done.returncode == 0, done.stderr
    types = {scenario.id: scenario.crash_type for scenario in recrash.load_scenarios(tmp_path / "scenes")}
    told = {each.id: each.crash_type for each in recrash.read(where="road = highway").reconstruct()[0]}
    assert types == told and len(types) > 10


def test_a_filter_keeps_some_records_and_a_wrong_one_is_told():
    everything, some = recrash.records(), recrash.records(where="road = intersection")
    assert 0 < len(some) < len(everything)
    with pytest.raises(InputError, match="roda"):
        recrash.records(where="roda = intersection")


def test_a_file_that_is_no_crash_file_is_refused(tmp_path):
    (tmp_path / "a.csv").write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match=r"a\.csv"):
        recrash.read(tmp_path / "a.csv")
    with pytest.raises(InputError, match=r"nothing\.csv"):
        recrash.read([tmp_path / "nothing.csv"])


@pytest.fixture
def rows():
    return [
        {"name": "a", "count": 1, "share": 0.5, "yes": True, "more": [1, 2]},
        {"name": None, "count": 2, "share": 1, "yes": False, "more": None},
    ]


def test_the_first_rows_are_a_table_of_their_own(rows):
    many = Table.concat([Table.of_rows(rows)] * 1000)
    for count in (0, 1, 2, 3, 5, 2000, 9999):
        head = many.head(count)
        assert head.column_names == many.column_names
        assert head.to_dicts() == many.to_dicts()[:count]
        assert pyarrow.table(head).to_pylist() == head.to_dicts()


def test_a_printed_table_converts_what_it_shows(rows):
    many, converted = Table.concat([Table.of_rows(rows)] * 1000), []

    class Watched:
        column_names = many.column_names

        def __len__(self):
            return len(many)

        def head(self, count):
            converted.append(count)
            return many.head(count)

    assert "2000 rows, the first 20 shown" in table_text(Watched())
    assert "2000 rows, the first 50 shown" in table_html(Watched())
    assert converted == [20, 50]


def test_pyarrow_polars_and_pandas_take_a_table(rows):
    table = Table.of_rows(rows)
    assert table.shape == (2, 5)
    arrow = pyarrow.table(table)
    assert arrow.schema.names == table.column_names == ["name", "count", "share", "yes", "more"]
    kinds = [pyarrow.string(), pyarrow.int64(), pyarrow.float64(), pyarrow.bool_(), pyarrow.string()]
    assert arrow.schema.types == kinds
    assert arrow.to_pylist() == [{**rows[0], "more": "[1,2]"}, {**rows[1], "share": 1.0}]
    assert polars.DataFrame(table).to_dicts() == arrow.to_pylist()
    assert pandas.DataFrame.from_arrow(table)["count"].tolist() == [1, 2]
    assert table.to_dicts() == arrow.to_pylist()
    assert table.to_dict()["name"] == ["a", None]


def test_a_table_is_handed_out_as_often_as_it_is_asked_for(rows):
    table = Table.of_rows(rows)
    first, second = pyarrow.table(table), pyarrow.table(table)
    # The same memory: nothing was copied.
    assert first["count"].chunks[0].buffers()[1].address == second["count"].chunks[0].buffers()[1].address
    del table, first
    assert second["share"].to_pylist() == [0.5, 1.0]


def test_an_empty_table_is_one():
    table = Table.of_rows([])
    assert (len(table), pyarrow.table(table).num_rows) == (0, 0)


def test_tracks_are_the_states_of_who_is_there():
    run = Scenario.load(case("acts/13-leave")).run("recorded")
    frame = polars.DataFrame(run.tracks)
    walker = frame.filter(polars.col("actor") == "walker")
    # It leaves at 1.8 s, and has no rows after that.
    assert walker["time_s"].max() == pytest.approx(1.7)
    ego = frame.filter(polars.col("actor") == "ego")
    assert ego["x_m"].to_list() == run.states[:, 0, 0].tolist()


def test_a_table_is_printed_as_it_fits_and_obeys_nobody(monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    rows = [
        {"name": f"case-{number}", "gap": number / 3, "said": "\x1b[31m<b>red</b>\nline", "long": "x" * 90}
        for number in range(30)
    ]
    table = Table.of_rows(rows)
    lines = str(table).splitlines()
    assert lines[0].split() == ["name", "gap", "said"]
    assert lines[3].split()[:2] == ["case-1", "0.3333"]
    assert lines[-2:] == ["30 rows, the first 20 shown", "not shown: long"]
    assert len(lines) == 24 and all(len(line) <= 40 for line in lines[:22])
    assert "\x1b" not in str(table)
    assert "&lt;b&gt;red" in table._repr_html_() and repr(table).startswith("Table(30 rows: name, gap")
    assert str(Table.of_rows([{"a": None}])).splitlines()[0] == "a"

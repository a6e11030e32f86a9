"""Suites: made, gone on with, opened, tested; Ctrl-C."""

from __future__ import annotations

import csv
import json
import time
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

import recrash
from recrash import InputError, RecrashError, Suite
from recrash.gym import CrashVectorEnv

SAMPLE = Path(__file__).parents[2] / "crates" / "records" / "data" / "sample.csv"


@pytest.fixture(scope="module")
def options(tmp_path_factory) -> dict[str, Any]:
    """Of a small suite of the first rows of the sample: to stage it whole takes ten times as long."""
    few = tmp_path_factory.mktemp("records") / "few.csv"
    with SAMPLE.open(encoding="utf-8", newline="") as all_rows, few.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(row for number, row in enumerate(csv.reader(all_rows)) if number <= 60)
    return {"files": few, "budget": 3, "tune_budget": 2, "seed": 5}


@pytest.fixture(scope="module")
def suite(options, tmp_path_factory):
    return recrash.run(tmp_path_factory.mktemp("suite") / "made", progress=False, **options)


def test_a_suite_is_made_and_opened(suite):
    opened = Suite.open(suite.folder)
    assert opened.options["seed"] == 5
    assert len(opened) == len(opened.cases) == 3
    assert opened.report().is_file()
    assert "<table>" in opened._repr_html_()
    assert len(opened.scenarios()) > 0


def test_an_ego_is_tested_in_a_suite_and_nothing_in_the_folder_changes(suite):
    before = {file: file.read_bytes() for file in suite.folder.rglob("*") if file.is_file()}
    table = suite.test(lambda _: (0.0, 0.0))
    assert len(table) == len(suite.scenarios())
    assert {file: file.read_bytes() for file in suite.folder.rglob("*") if file.is_file()} == before


def test_scenarios_of_a_suite_know_their_crash_types(suite):
    accounts = suite.folder / "3-narratives"
    told = {
        scenario.id: json.loads((accounts / f"{scenario.id}.account.json").read_text())["crash_type"]["value"]
        for scenario in suite.scenarios()
    }
    assert {scenario.id: scenario.crash_type for scenario in suite.scenarios()} == told
    assert {scenario.crash_type for scenario in CrashVectorEnv(suite, 1, crash_types=[min(told.values())]).scenarios} == {
        min(told.values())
    }


def test_who_was_parked_is_not_tested_and_who_was_never_there_has_not_passed(options):
    scenarios, _ = recrash.read(options["files"]).reconstruct()
    parked = [scenario.id for scenario in scenarios if not scenario.tested]
    assert parked
    for ego in ("metadrive-idm", lambda _: (0.0, -1.0)):
        rows = recrash.test(scenarios, ego, progress=False).to_dicts()
        assert [row["scenario"] for row in rows if row["verdict"] == "not_run"] == parked
        assert all("its ego was parked" in row["error"] for row in rows if row["scenario"] in parked)
        driven = [row for row in rows if row["scenario"] not in parked]
        for row in driven:
            assert row["verdict"] == ("failed" if row["failed"] else "passed" if row["met"] else "unmet"), row
            assert (row["cause"] is None) == (not row["failed"])
            assert (row["other_delta_v_mps"] is None) == (row["delta_v_mps"] is None)
        assert {row["verdict"] for row in driven} >= {"failed", "unmet"}


def test_progress_is_told_and_ctrl_c_keeps_what_is_done(options, tmp_path):
    told = []

    def stops(stage, units, begins):
        told.append((stage, units, begins))
        if stage == "tune":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        recrash.run(tmp_path / "s", progress=stops, **options)
    stages = {stage for stage, _, begins in told if begins}
    assert {"records", "design", "tune"} <= stages
    assert "report" not in stages
    # Nothing is half written, and the same call goes on to the same end.
    for file in (tmp_path / "s").rglob("*.json"):
        json.loads(file.read_text())
    resumed = recrash.run(tmp_path / "s", progress=False, **options)
    fresh = recrash.run(tmp_path / "t", progress=False, **options)
    assert resumed.summary["cases"] == fresh.summary["cases"]


def test_a_slow_listener_hears_progress_to_its_end(options, tmp_path):
    begun, advanced = Counter(), Counter()

    def listens(stage, units, begins):
        time.sleep(0.02)
        (begun if begins else advanced)[stage] += units

    recrash.run(tmp_path / "s", progress=listens, **options)
    assert "report" in begun
    assert +advanced == +begun


def test_a_listener_that_raises_stops_the_run_with_what_it_raised(options, tmp_path):
    def breaks(*_):
        raise LookupError("bar")

    with pytest.raises(LookupError, match="bar"):
        recrash.run(tmp_path / "s", progress=breaks, **options)


def test_a_folder_without_a_suite_is_told(options, tmp_path):
    with pytest.raises(InputError, match="no suite in .*check the folder"):
        Suite.open(tmp_path)
    with pytest.raises(InputError, match="holds no scenario file"):
        recrash.load_scenarios(tmp_path)
    (tmp_path / "mine.txt").write_text("notes")
    with pytest.raises(RecrashError, match="not overwritten"):
        recrash.run(tmp_path, progress=False, **options)


def test_a_suite_of_another_version_is_told(suite, tmp_path):
    saved = json.loads((suite.folder / "suite.json").read_text())
    (tmp_path / "suite.json").write_text(json.dumps({**saved, "format": "recrash.suite/99"}))
    with pytest.raises(RecrashError, match=r"suite\.json"):
        Suite.open(tmp_path)


def test_options_that_there_are_not_and_cannot_be_are_told(options, tmp_path):
    with pytest.raises(InputError, match='no option "budgte"; there are: .*budget'):
        recrash.run(tmp_path / "s", budgte=3)
    with pytest.raises(InputError, match="cannot be used"):
        recrash.run(tmp_path / "s", budget="many")
    with pytest.raises(InputError, match='no stage "desing"'):
        recrash.run(tmp_path / "s", until="desing", **options)
    assert not (tmp_path / "s").exists()


def test_a_program_that_only_the_suite_names_is_not_started(suite, tmp_path):
    saved = json.loads((suite.folder / "suite.json").read_text())
    marker = tmp_path / "ran"
    saved["options"]["ego"] = f"cmd:touch {marker}"
    (suite.folder / "suite.json").write_text(json.dumps(saved))
    try:
        with pytest.raises(InputError, match="name it yourself if you trust it"):
            Suite.open(suite.folder).test()
    finally:
        saved["options"]["ego"] = None
        (suite.folder / "suite.json").write_text(json.dumps(saved))
    assert not marker.exists()

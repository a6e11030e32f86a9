"""A suite's files, read the way a user of Python reads them: csv, json and xml of the standard library."""

import csv
import json
import math
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import junitparser
import xunitparser


def test_results_csv_has_a_row_for_every_run(suite: Path) -> None:
    with open(suite / "results.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    ids = {cluster["scenario_id"] for cluster in json.loads((suite / "2-selection.json").read_text())["clusters"]}
    assert {row["scenario"] for row in rows} == ids
    assert all(None not in row and None not in row.values() for row in rows), "ragged rows"


def test_junit_counts_what_it_holds(suite: Path) -> None:
    root = ElementTree.parse(suite / "junit.xml").getroot()
    suites = [root] if root.tag == "testsuite" else root.findall("testsuite")
    for element in suites:
        assert int(element.get("tests", "-1")) == len(element.findall("testcase"))
        assert int(element.get("failures", "-1")) == len(element.findall("testcase/failure"))
    names = [(element.get("name"), case.get("name")) for element in suites for case in element.findall("testcase")]
    assert len(names) == len(set(names)) > 0
    one = junitparser.JUnitXml.fromfile(str(suite / "junit.xml"))
    with (suite / "junit.xml").open() as file:
        _, other = xunitparser.parse(file)
    assert (one.tests, one.failures) == (other.testsRun, len(other.failures))
    assert one.tests == len(names)


def test_the_summary_agrees_with_the_rollouts(suite: Path) -> None:
    summary = json.loads((suite / "summary.json").read_text())
    for case in summary["cases"]:
        run = json.loads((suite / "7-tuned-runs" / f"{case['id']}.json").read_text())
        assert run["judgement"]["metrics"]["min_gap"]["value"] == case["tuned"]["min_gap_m"]
        ego, *others = run["rollout"]["actors"]
        apart = [
            math.dist((a["x"], a["y"]), (b["x"], b["y"]))
            for other in others
            if other["role"] == "partner"
            for a, b in zip(ego["states"], other["states"], strict=False)
        ]
        assert abs(min(apart) - case["tuned"]["min_centre_distance_m"]) < 0.7, case["id"]


def test_every_scenario_file_can_be_run_alone_and_gives_the_same_states(recrash: str, suite: Path) -> None:
    runs = sorted(path for path in (suite / "7-tuned-runs").glob("*.json") if path.name.count(".") == 1)
    assert runs
    for run_file in runs:
        scenario = suite / "6-tuned" / run_file.name
        shown = subprocess.run([recrash, "simulate", str(scenario), "--json"], check=True, capture_output=True)
        again = json.loads(shown.stdout)["rollout"]["state_hash"]
        assert again == json.loads(run_file.read_text())["rollout"]["state_hash"], scenario.name

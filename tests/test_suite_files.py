"""A suite's files, read the way a user of Python reads them: csv, json and xml of the standard library."""

import csv
import json
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path


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


def test_the_summary_agrees_with_the_rollouts(suite: Path) -> None:
    summary = json.loads((suite / "summary.json").read_text())
    for case in summary["cases"]:
        run = json.loads((suite / "6-tuned" / f"{case['id']}.run.json").read_text())
        assert run["metrics"]["min_gap"]["value"] == case["tuned"]["min_gap_m"]
        gaps = [gap for partner in run["series"]["partners"] for gap in partner["gap_m"]]
        assert abs(min(gaps) - case["tuned"]["min_gap_m"]) < 0.7, case["id"]


def test_every_scenario_file_can_be_run_alone_and_gives_the_same_states(recrash: str, suite: Path) -> None:
    scenarios = sorted((suite / "6-tuned").glob("*.run.json"))
    assert scenarios
    for run_file in scenarios:
        scenario = run_file.with_name(run_file.name.replace(".run.json", ".json"))
        shown = subprocess.run([recrash, "simulate", str(scenario), "--json"], check=True, capture_output=True)
        again = json.loads(shown.stdout)["rollout"]["state_hash"]
        assert again == json.loads(run_file.read_text())["rollout"]["state_hash"], scenario.name

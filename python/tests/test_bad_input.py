"""Bad input and bad luck: an exception that says what and where, the rest goes on, and nothing is half written."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import METADRIVE, case

import recrash
from recrash import EgoError, InputError, RecrashError, Scenario, Suite

OPTIONS = {"budget": 2, "tune_budget": 2, "seed": 5, "profile": "paper"}


@pytest.fixture
def scenario():
    return Scenario.load(case("crashes/32-lead-reverses"))


@pytest.mark.parametrize(
    "answer",
    [np.zeros((2, 2)), np.array([np.nan, 0.0]), [], [[0.0], [0.0]], {"acceleration_mps2": np.zeros(3), "wheel_angle_rad": 0.0}],
    ids=["matrix", "nan", "empty", "nested", "array in a dict"],
)
def test_a_control_of_a_wrong_shape_is_told_with_ego_and_step(scenario, answer):
    with pytest.raises(EgoError, match=r"(?s)crashes-32-lead-reverses: the ego py:.* at step 0 \(0.0 s\)"):
        scenario.run(lambda _: answer)


def test_an_array_of_two_numbers_is_a_control(scenario):
    assert scenario.run(lambda _: np.array([0.0, 0.0])).state_hash == scenario.run(lambda _: (0.0, 0.0)).state_hash


def test_a_class_that_cannot_be_made_raises_what_it_raised(scenario):
    class Heavy:
        def __init__(self):
            raise MemoryError("no room for the network")

        def control(self, _):
            return 0.0, 0.0

    with pytest.raises(MemoryError, match="no room"):
        scenario.run(Heavy)


DIES = """
import os
class Dies:
    def reset(self, world):
        self.world = world
    def control(self, step):
        if self.world["scenario"] == "crashes-32-lead-reverses" and step["step"] == 3:
            os._exit(7)
        return 0.0, 0.0
"""


def test_a_worker_that_dies_fails_its_scenario_and_the_rest_goes_on(crashes, tmp_path, monkeypatch):
    (tmp_path / "dies.py").write_text(DIES)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("RECRASH_PYTHON", sys.executable)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(str(Path(part).resolve()) for part in sys.path if part))
    rows = recrash.test(crashes, "py:dies.py:Dies", threads=1).to_dicts()
    (failed,) = [row for row in rows if row["error"]]
    assert failed["scenario"] == "crashes-32-lead-reverses"
    assert "crashes-32-lead-reverses: " in failed["error"]
    assert "ended" in failed["error"]
    assert all(row["state_hash"] for row in rows if row is not failed)


def test_what_metadrive_needs_is_told_where_it_is_not(scenario):
    with pytest.raises(InputError, match="metadrive-simulator"):
        scenario.run("metadrive-idm", simulator="metadrive")
    with pytest.raises(InputError, match="cannot start Python as `no-such-python`"):
        recrash.test([scenario], "metadrive-expert", simulator="metadrive", python="no-such-python")
    with pytest.raises(InputError, match="drives on MetaDrive alone"):
        scenario.run("metadrive-expert")
    with pytest.raises(InputError, match="its own egos: metadrive-idm, metadrive-expert"):
        scenario.run(lambda _: (0.0, 0.0), simulator="metadrive")
    with pytest.raises(InputError, match='no simulator "carla"; there are: native, metadrive'):
        scenario.run("idm", simulator="carla")


@pytest.mark.skipif(METADRIVE is None, reason="RECRASH_METADRIVE_PYTHON names no interpreter with MetaDrive")
def test_metadrive_and_its_expert_are_driven_from_python(tmp_path):
    suite = recrash.run(tmp_path / "s", progress=False, until="design", **OPTIONS)
    options: dict = {"profile": "paper", "simulator": "metadrive", "python": METADRIVE, "threads": 1}
    scenarios = suite.scenarios()
    by_expert = recrash.test(scenarios, "metadrive-expert", **options).to_dicts()
    assert {row["ego"] for row in by_expert} == {"metadrive-expert"}
    assert not any(row["error"] for row in by_expert)
    # In another order, by another worker: the same.
    again = recrash.test(scenarios[::-1], "metadrive-expert", **options).to_dicts()
    assert [row["state_hash"] for row in again[::-1]] == [row["state_hash"] for row in by_expert]


MAKES = """
import sys, recrash
def told(stage, units, begins):
    print(stage, flush=True)
    if stage == "design":
        sys.stdin.readline()
recrash.run(sys.argv[1], progress=told, budget=2, tune_budget=2, seed=5, profile="paper")
"""


def test_of_two_processes_on_one_suite_the_second_is_told_and_spoils_nothing(tmp_path):
    folder = tmp_path / "suite"
    first = subprocess.Popen([sys.executable, "-c", MAKES, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert first.stdout is not None
    assert first.stdin is not None
    for line in first.stdout:
        if line.strip() == "design":
            break
    with pytest.raises(RecrashError, match="another recrash is at work in .*suite; wait until it is done"):
        recrash.run(folder, progress=False, **OPTIONS)
    # Reading goes on beside it.
    assert Suite.open(folder).options["seed"] == 5
    first.communicate("go on\n", timeout=60)
    assert first.returncode == 0
    alone = recrash.run(tmp_path / "alone", progress=False, **OPTIONS)
    assert Suite.open(folder).summary["cases"] == alone.summary["cases"]


def test_a_process_that_is_killed_leaves_a_suite_that_goes_on(tmp_path):
    folder = tmp_path / "suite"
    first = subprocess.Popen([sys.executable, "-c", MAKES, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert first.stdout is not None
    for line in first.stdout:
        if line.strip() == "design":
            break
    first.kill()
    first.communicate(timeout=30)
    for file in folder.rglob("*.json"):
        json.loads(file.read_text())
    # Its lock is gone with it.
    suite = recrash.run(folder, progress=False, **OPTIONS)
    assert suite.report().is_file()


def test_a_report_that_is_not_made_yet_is_told(tmp_path):
    suite = recrash.run(tmp_path / "s", progress=False, until="records", **OPTIONS)
    with pytest.raises(InputError, match="its report is not made yet; run the suite to its end"):
        suite.report()
    with pytest.raises(InputError, match="its report is not made yet"):
        len(suite)


def test_sweeps_and_searches_say_what_they_cannot_do(scenario):
    with pytest.raises(InputError, match="no such number in crashes-32-lead-reverses"):
        recrash.sweep([scenario], 3, vary=["/nobody=1:2"])
    with pytest.raises(InputError, match="POINTER=MIN:MAX"):
        recrash.sweep([scenario], 3, vary=["speed"])
    with pytest.raises(InputError, match="no scenario to sweep"):
        recrash.sweep([], 3)
    tuned, rows = recrash.tune([scenario], "idm", searcher="luck", budget=3)
    assert tuned == [scenario]
    assert "no search is called" in rows.to_dicts()[0]["error"]
    with pytest.raises(InputError, match="table 1 has other columns"):
        recrash.Table.concat([recrash.Table.of_rows([{"a": 1}]), recrash.Table.of_rows([{"b": 1}])])


def test_a_sweep_is_that_of_the_command(tmp_path, scenario):
    import pyarrow.parquet
    from conftest import command

    out = tmp_path / "rollouts.parquet"
    words = ("--rollouts", 40, "--vary", "/ego/speed_mps=5:12", "--ego", "idm", "--seed", 7, "--out", out)
    done = command("sweep", case("crashes/32-lead-reverses"), *words, "--profile", "open")
    assert done.returncode == 0, done.stderr
    own = recrash.sweep([scenario], 40, vary=["/ego/speed_mps=5:12"], ego="idm", seed=7)
    assert pyarrow.parquet.read_table(out).to_pylist() == own.to_dicts()


def test_progress_of_many_runs_stops_at_ctrl_c(crashes):
    begun, seen = time.monotonic(), []

    def slow(observation):
        seen.append(observation["step"])
        if len(seen) == 50:
            raise KeyboardInterrupt
        return 0.0, 0.0

    with pytest.raises(KeyboardInterrupt):
        recrash.test(crashes, slow, progress=True)
    assert len(seen) == 50
    assert time.monotonic() - begun < 30

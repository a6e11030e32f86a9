"""Scenarios: read, checked, run, judged; the same bytes as the command's."""

from __future__ import annotations

import copy
import json
import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import case, command, gallery

import recrash
from recrash import InputError, Scenario


@pytest.mark.parametrize("ego", ["idm", "recorded"])
def test_state_hashes_are_the_commands_on_the_whole_gallery(ego, tmp_path):
    def of_command(file):
        rollout = tmp_path / f"{file.parent.name}-{file.name}"
        done = command("simulate", file, "--ego", ego, "--rollout", rollout, "--quiet")
        assert rollout.is_file(), done.stderr
        return json.loads(rollout.read_text())["state_hash"]

    files = gallery()
    assert len(files) > 100
    with ThreadPoolExecutor(2) as pool:
        expected = list(pool.map(of_command, files))
    own = [run.state_hash for run in recrash.suite.runs([Scenario.load(file) for file in files], ego)]
    assert own == expected


def test_a_run_tells_what_happened_in_arrays_and_plain_objects():
    run = Scenario.load(case("crashes/32-lead-reverses")).run("recorded")
    assert (run.termination, run.ego, run.failed) == ("contact", "recorded", True)
    assert "contact" in run.finding_kinds
    assert run.findings[0]["sentence"].startswith("The ego and")
    steps, actors, numbers = run.states.shape
    assert (numbers, actors, steps) == (len(recrash.STATE), len(run.actors), len(run.times))
    assert run.actors[0]["id"] == "ego"
    assert run.times[1] == pytest.approx(0.1)
    # It moves by its velocity.
    moved = np.diff(run.states[:10, 0, 0])
    assert moved == pytest.approx(0.1 * run.states[:9, 0, 3], abs=0.02)
    assert run.severity["first"]["delta_v_mps"] == run.delta_v_mps > 0
    assert run.metrics["contact"]["time_s"] <= run.duration_s
    assert run.to_dict()["rollout"]["state_hash"] == run.state_hash


def test_a_run_goes_from_process_to_process():
    run = Scenario.load(case("crashes/32-lead-reverses")).run("idm")
    same = pickle.loads(pickle.dumps(run))
    assert same.to_dict() == run.to_dict()
    assert same.drawing == run.drawing is not None
    assert copy.deepcopy([run])[0] is run


def test_a_run_without_a_contact_has_no_severity():
    run = Scenario.load(case("acts/01-lanes")).run("recorded")
    assert run.severity is None
    assert run.delta_v_mps is None


def test_a_scenario_is_the_same_from_a_file_a_dict_and_a_pickle():
    scenario = Scenario.load(case("control/01-green"))
    assert Scenario.load(json.loads(case("control/01-green").read_text())) == scenario
    assert Scenario.load(scenario.to_dict()) == scenario
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    assert copy.deepcopy(scenario) == scenario
    assert hash(Scenario.load(str(case("control/01-green")))) == hash(scenario)
    assert Scenario.load(case("control/02-yellow-too-late-to-stop")) != scenario


def test_a_seed_changes_the_background_traffic_and_nothing_else():
    draft = Scenario.load(case("roads/26-block-crossing")).to_dict()
    draft["traffic"] = {"density": 0.2, "seed": 1}
    scenario = Scenario.load(draft)
    first, again, other = (scenario.run("idm", seed=seed).state_hash for seed in (1, 1, 2))
    assert first == again == scenario.run("idm").state_hash
    assert first != other


def test_a_file_that_is_not_there_is_named():
    with pytest.raises(InputError, match=r"cannot read no/such.json: .*check the path"):
        Scenario.load("no/such.json")


def test_every_problem_of_a_scenario_has_its_path_and_what_is_allowed():
    draft = Scenario.load(case("acts/01-lanes")).to_dict()
    draft["duration_s"] = 1e9
    with pytest.raises(InputError, match="duration_s") as caught:
        Scenario.load(draft)
    (problem,) = caught.value.diagnostics
    assert problem["location"]["path"] == "duration_s"
    assert "120" in problem["message"] + problem.get("hint", "")


def test_what_is_no_scenario_is_refused():
    with pytest.raises(InputError):
        Scenario.load({"format": "something else"})
    with pytest.raises(TypeError):
        Scenario.load(3)


def test_an_unknown_ego_and_an_unknown_profile_are_told_with_what_there_is():
    scenario = Scenario.load(case("acts/01-lanes"))
    with pytest.raises(InputError, match="no ego is called `human`.*metadrive-idm"):
        scenario.run("human")
    with pytest.raises(InputError, match="no-such-profile"):
        scenario.run("idm", profile="no-such-profile")


def test_import_is_quick():
    # The least of five fresh processes: others may be at work on the machine.
    script = "import time; t = time.perf_counter(); import recrash; print(time.perf_counter() - t)"
    done = [subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True) for _ in range(5)]
    assert min(float(each.stdout) for each in done) < 0.1


def test_the_command_comes_with_the_wheel():
    done = subprocess.run([sys.executable, "-m", "recrash", "--version"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, f"recrash {recrash.__version__}\n")
    wrong = subprocess.run([sys.executable, "-m", "recrash", "no-such"], capture_output=True, text=True, check=False)
    assert wrong.returncode == 2
    assert "no-such" in wrong.stderr

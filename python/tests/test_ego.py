"""Python objects in the ego's seat, in process and behind the command."""

from __future__ import annotations

import json
import math
import sys

import pytest
from conftest import EXAMPLES, case, command

import recrash
from recrash import EgoError, InputError, Scenario


@pytest.fixture
def scenario():
    return Scenario.load(case("crashes/32-lead-reverses"))


def steady(observation):
    return {"throttle": 0.1, "steer": 0.0}


class Follower:
    """Keeps a distance; remembers what it was told."""

    def __init__(self):
        self.told = []

    def reset(self, world):
        self.world = world
        self.told.append("reset")

    def control(self, observation):
        me = observation["ego"]
        gaps = [math.hypot(o["x"] - me["x"], o["y"] - me["y"]) for o in observation["actors"]]
        return (-6.0 if min(gaps, default=99.0) < 25.0 else 0.0), 0.0

    def end(self, ending):
        self.told.append(ending["kind"])


def test_a_function_drives(scenario):
    run = scenario.run(steady)
    assert run.ego == "py:steady"
    # The recorded driver drives until the handover; then the function's pedal is in the states.
    assert run.states[-5, 0, 6] == pytest.approx(0.1)
    assert run.state_hash == scenario.run(steady).state_hash


def test_a_function_sees_the_world_every_time(scenario):
    seen = []

    def look(observation):
        seen.append((observation["step"], observation["world"]["vehicle"]["length_m"], len(observation["actors"])))
        return 0.0, 0.0

    scenario.run(look)
    assert [step for step, _, _ in seen] == list(range(len(seen)))
    assert seen[0][1] > 4.0
    assert seen[0][2] == 1


def test_a_class_is_made_for_the_run_and_an_object_stays(scenario):
    assert scenario.run(Follower).ego == "py:Follower"
    follower = Follower()
    first, second = scenario.run(follower), scenario.run(follower)
    assert first.state_hash == second.state_hash
    assert follower.told == ["reset", first.termination] * 2
    assert follower.world["scenario"] == scenario.id


def test_what_an_ego_raises_is_the_cause_and_the_place_is_told(scenario):
    def breaks(observation):
        if observation["step"] == 7:
            raise ZeroDivisionError("seven")
        return 0.0, 0.0

    with pytest.raises(
        EgoError, match=r"crashes-32-lead-reverses: the ego py:.*breaks raised .*seven at step 7 \(0.7 s\)"
    ) as caught:
        scenario.run(breaks)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        ({"throttle": math.nan, "steer": 0.0}, "answered throttle = NaN"),
        ((math.inf, 0.0), "answered acceleration_mps2 = inf"),
        ({"throttle": 0.0}, "answered {'throttle': 0.0}, which is no control"),
        (None, "answered None, which is no control"),
        ("fast", "answered 'fast', which is no control"),
        ((0.0,), "which is no control"),
    ],
)
def test_an_answer_that_is_no_control_is_told(scenario, answer, said):
    with pytest.raises(EgoError) as caught:
        scenario.run(lambda _: answer)
    assert said in str(caught.value)
    assert "at step 0 (0.0 s)" in str(caught.value)


def test_ctrl_c_in_an_ego_is_ctrl_c(scenario):
    def interrupted(_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        scenario.run(interrupted)


def test_what_cannot_drive_is_refused(scenario):
    with pytest.raises(InputError, match="cannot drive"):
        scenario.run(object())


def test_a_test_goes_on_after_an_ego_that_raises(crashes):
    def breaks_in_one(observation):
        if observation["world"]["scenario"] == "crashes-32-lead-reverses":
            raise RuntimeError("no")
        return 0.0, 0.0

    rows = recrash.test(crashes, breaks_in_one).to_dicts()
    assert len(rows) == 36
    (failed,) = [row for row in rows if row["error"]]
    assert failed["scenario"] == "crashes-32-lead-reverses"
    assert failed["state_hash"] is None
    assert all(row["state_hash"] for row in rows if row is not failed)


EGO = """
class Example:
    def reset(self, world):
        self.world = world
    def control(self, step):
        scope = {"math": __import__("math"), "json": None, "sys": None}
        return control(self.world, step)
"""


def test_the_command_drives_with_a_class_as_with_a_program_and_in_process(tmp_path, scenario):
    # The documented example, as a class.
    source = (EXAMPLES / "ego.py").read_text().split("world = {}")[0]
    (tmp_path / "mine.py").write_text(
        source + EGO.replace('        scope = {"math": __import__("math"), "json": None, "sys": None}\n', "")
    )
    file = case("crashes/32-lead-reverses")
    hashes = []
    for ego in ("py:mine.py:Example", "py:mine:Example", f"cmd:{sys.executable} '{EXAMPLES / 'ego.py'}'"):
        done = command("simulate", file, "--ego", ego, "--rollout", "rollout.json", "--quiet", cwd=tmp_path)
        rollout = tmp_path / "rollout.json"
        assert rollout.is_file(), (ego, done.stdout, done.stderr)
        hashes.append(json.loads(rollout.read_text())["state_hash"])
        rollout.unlink()
    namespace: dict = {}
    exec(source.split("def control")[0] + "def control" + source.split("def control")[1] + EGO, namespace)
    hashes.append(scenario.run(namespace["Example"]).state_hash)
    assert len(set(hashes)) == 1


def test_the_command_says_what_is_wrong_with_a_class(tmp_path):
    (tmp_path / "mine.py").write_text("def breaks(_):\n    raise KeyError('gone')\n")
    file = case("crashes/32-lead-reverses")
    for ego, said in [
        ("py:mine:breaks", "KeyError: 'gone'"),
        ("py:mine:nothing", "mine has no nothing"),
        ("py:no_such_module:x", "no_such_module"),
        ("py:mine", "needs a module and a name"),
    ]:
        done = command("simulate", file, "--ego", ego, cwd=tmp_path)
        assert done.returncode == 3, (ego, done.stderr)
        assert said in done.stderr

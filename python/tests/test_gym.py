"""Environments: gymnasium's own checks, episodes that are the simulator's runs, and bad input."""

from __future__ import annotations

import copy
import json
import pickle
import sys

import gymnasium
import numpy as np
import pytest
from conftest import case
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import recrash.gym
from recrash import InputError, Scenario
from recrash.gym import TERMS, WEIGHTS, CrashEnv, CrashVectorEnv, evaluate, observation_fields, split

VIEWS = ["kinematic", "rays", "raster"]
ACTIONS = ["pedals", "guided", "discrete"]


@pytest.mark.parametrize("observation", VIEWS)
@pytest.mark.parametrize("actions", ACTIONS)
def test_gymnasiums_checker_is_content(crashes, observation, actions, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    env = gymnasium.make("recrash/Crash-v0", suite=crashes, observation=observation, actions=actions)
    check_env(env.unwrapped, skip_render_check=True)


def test_stable_baselines3s_checker_is_content(crashes):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    for actions in ACTIONS:
        checker.check_env(CrashEnv(crashes, actions=actions))


@pytest.mark.parametrize("observation", VIEWS)
@pytest.mark.parametrize("actions", ACTIONS)
@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_spaces_hold_what_a_vector_gives(crashes, observation, actions, mode):
    env = CrashVectorEnv(crashes, 5, observation=observation, actions=actions, autoreset_mode=mode)
    env.action_space.seed(0)
    seen, _ = env.reset(seed=1)
    assert seen in env.observation_space
    for _ in range(30):
        seen, rewards, terminated, truncated, _ = env.step(env.action_space.sample())
        assert seen in env.observation_space
        for array, kind in ((rewards, np.float64), (terminated, np.bool_), (truncated, np.bool_)):
            assert (array.shape, array.dtype) == ((5,), kind)
        ended = terminated | truncated
        if mode is AutoresetMode.DISABLED and ended.any():
            env.reset(options={"reset_mask": ended})


def test_make_vec_gives_the_native_vector(crashes):
    env = gymnasium.make_vec("recrash/Crash-v0", num_envs=4, suite=crashes, vectorization_mode="vector_entry_point")
    assert isinstance(env.unwrapped, CrashVectorEnv)
    assert env.reset(seed=3)[0].shape == (4, len(observation_fields()))


def drive(env, seed, steps=250):
    shown = [env.reset(seed=seed)[0]]
    actions = np.random.default_rng(7)
    for _ in range(steps):
        seen, rewards, terminated, truncated, infos = env.step(actions.uniform(-0.5, 0.5, (env.num_envs, 2)).astype(np.float32))
        shown += [seen, rewards, terminated, truncated, infos["scenario"], infos["reward_terms"]]
    return shown


def test_the_same_seed_gives_the_same_for_any_number_of_threads(crashes):
    def equal(one, other):
        return all(np.array_equal(a, b) for a, b in zip(one, other, strict=True))

    first = drive(CrashVectorEnv(crashes, 40, threads=1), 1)
    assert equal(first, drive(CrashVectorEnv(crashes, 40, threads=2), 1))
    assert not equal(first, drive(CrashVectorEnv(crashes, 40, threads=1), 2))


def test_one_of_many_is_as_one_alone(crashes):
    scenarios = recrash.load_scenarios(crashes)[:6]
    many = CrashVectorEnv(scenarios, 6, autoreset_mode=AutoresetMode.NEXT_STEP)
    seen, _ = many.reset(seed=1, options={"scenarios": list(range(6))})
    alone = []
    for slot, scenario in enumerate(scenarios):
        env = CrashEnv(scenarios)
        first, info = env.reset(seed=9, options={"scenario": scenario.id})
        assert info["scenario"] == scenario.id
        assert np.array_equal(first, seen[slot])
        alone.append(env)
    over = np.zeros(6, bool)
    for _ in range(120):
        action = np.tile(np.float32([0.02, 0.1]), (6, 1))
        seen, rewards, terminated, truncated, infos = many.step(action)
        for slot, env in enumerate(alone):
            if over[slot]:
                continue
            own, reward, end, cut, info = env.step(action[slot])
            assert np.array_equal(own, seen[slot])
            assert (reward, end, cut) == (rewards[slot], terminated[slot], truncated[slot])
            if end or cut:
                over[slot] = True
                assert info["ending"] == infos["ending"][slot]
                assert info["run"].state_hash == infos["run"][slot].state_hash
                assert info["failed"] == infos["failed"][slot]
    assert over.all()


def test_an_episode_is_the_run_of_an_ego_with_the_same_controls():
    scenario = Scenario.load(case("crashes/32-lead-reverses"))
    env = CrashEnv([scenario])
    env.reset(seed=1)
    done = False
    while not done:
        _, _, terminated, truncated, info = env.step(np.float32([0.01, 0.25]))
        done = terminated or truncated
    run = scenario.run(lambda _: {"steer": float(np.float32(0.01)), "throttle": 0.25})
    assert info["run"].state_hash == run.state_hash
    assert info["findings"] == run.finding_kinds
    assert info["severity"] == run.severity
    assert info["ending"] == run.termination


def test_autoreset_in_the_same_step_keeps_what_was_last(crashes):
    following = CrashVectorEnv(crashes, 8, autoreset_mode=AutoresetMode.NEXT_STEP)
    same = CrashVectorEnv(crashes, 8, autoreset_mode="SameStep")
    assert same.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    following.reset(seed=1)
    same.reset(seed=1)
    action = np.zeros((8, 2), np.float32)
    for _ in range(200):
        last, rewards, _, _, infos = following.step(action)
        first, same_rewards, _, _, same_infos = same.step(action)
        assert np.array_equal(rewards, same_rewards)
        ended = infos.get("_ending")
        if ended is not None:
            assert np.array_equal(same_infos["_final_obs"], ended)
            for slot in np.flatnonzero(ended):
                assert np.array_equal(same_infos["final_obs"][slot], last[slot])
                assert not np.array_equal(first[slot], last[slot])
            assert same_infos["final_info"]["run"][slot].state_hash == infos["run"][slot].state_hash
            break
    else:
        pytest.fail("no episode ended")
    action[~ended] = np.float32([0.5, 1.0])
    again, rewards, terminated, truncated, _ = following.step(action)
    assert not (rewards[ended].any() or terminated[ended].any() or truncated[ended].any())
    assert np.array_equal(again[ended], first[ended])


def test_the_reward_is_the_weighted_sum_of_its_terms(crashes):
    env = CrashVectorEnv(crashes, 16, reward={"progress": 3.0, "contact": -1.0})
    env.reset(seed=1)
    weights = np.array([{**WEIGHTS, "progress": 3.0, "contact": -1.0}[term] for term in TERMS])
    for _ in range(60):
        _, rewards, _, _, infos = env.step(np.zeros((16, 2), np.float32))
        assert rewards == pytest.approx(infos["reward_terms"] @ weights, abs=1e-5)


def test_a_function_replaces_the_reward_and_the_returns_are_its(crashes):
    env = CrashVectorEnv(crashes, 4, reward=lambda terms: np.full(len(terms), 2.0))
    env.reset(seed=1)
    ends, begins = 0, np.zeros(4, bool)
    for _ in range(300):
        _, rewards, _, _, infos = env.step(np.zeros((4, 2), np.float32))
        assert (rewards == np.where(begins, 0.0, 2.0)).all()
        begins = infos.get("_episode", np.zeros(4, bool))
        for slot in np.flatnonzero(begins):
            ends += 1
            assert infos["episode"]["r"][slot] == 2.0 * infos["episode"]["l"][slot]
    assert ends > 3


@pytest.fixture(scope="module")
def told():
    """The crashes of the built-in sample, as told."""
    return recrash.read().reconstruct()[0]


def test_a_split_has_no_crash_on_both_sides(told):
    train, held_out = split(told, 0.25)
    assert len(train) + len(held_out) == len(told)
    assert 0.15 < len(held_out) / len(told) < 0.35

    def reports(part):
        return {name.rsplit("/", 1)[0] for scenario in part for name in scenario.reports}

    assert not reports(train) & reports(held_out)
    env = CrashVectorEnv(told, 2, split="held_out")
    assert env.scenarios == [scenario for scenario in held_out if scenario.tested]


def test_a_curriculum_draws_the_types_that_it_names(told):
    env = CrashVectorEnv(told, 400)
    env.set_curriculum({"front_to_rear": 3.0, "backing": 1.0})
    _, infos = env.reset(seed=1)
    drawn = [env.scenarios[number].crash_type for number in infos["scenario"]]
    assert set(drawn) == {"front_to_rear", "backing"}
    assert 250 < drawn.count("front_to_rear") < 350
    with pytest.raises(InputError, match="rear_end.*there are:.*front_to_rear"):
        env.set_curriculum({"rear_end": 1.0})
    only = CrashVectorEnv(told, 1, crash_types=["pedestrian"])
    assert {scenario.crash_type for scenario in only.scenarios} == {"pedestrian"}


def test_evaluate_drives_every_scenario_once(crashes):
    runs = evaluate(lambda seen: np.zeros((len(seen), 2), np.float32), crashes)
    assert [run.scenario_id for run in runs] == [scenario.id for scenario in recrash.load_scenarios(crashes)]


def test_a_policy_of_one_observation_is_told_how_it_is_wrapped(crashes):
    with pytest.raises(InputError, match=r"of shape \(\d+, 2\); it gave shape \(2,\); wrap a policy of one observation"):
        evaluate(lambda seen: np.zeros(2, np.float32), crashes)

    def one(seen):
        assert seen.ndim == 1, "one observation at a time"
        return np.zeros(2, np.float32)

    with pytest.raises(AssertionError, match="one observation at a time") as raised:
        evaluate(one, crashes)
    if sys.version_info >= (3, 11):
        assert "numpy.stack" in raised.value.__notes__[0]
    few = recrash.load_scenarios(crashes)[:3]
    assert len(evaluate(lambda seen: np.stack([one(each) for each in seen]), few)) == 3


@pytest.mark.parametrize("environment", [CrashEnv, CrashVectorEnv])
def test_an_environment_is_neither_pickled_nor_copied(crashes, environment):
    env = environment(crashes)
    for does in (pickle.dumps, copy.deepcopy):
        with pytest.raises(TypeError, match="make it anew from its scenarios"):
            does(env)


@pytest.mark.parametrize("option", [{"judge": False}, {"autoreset_mode": "same_step"}, {"num_envs": 2}])
def test_evaluate_refuses_what_would_give_it_no_runs(crashes, option):
    with pytest.raises(InputError, match=next(iter(option))):
        evaluate(lambda seen: np.zeros((len(seen), 2), np.float32), crashes, **option)


def test_a_judged_run_has_the_scenario_that_was_driven(crashes):
    first = recrash.load_scenarios(crashes)[0]
    other = Scenario.load({**first.to_dict(), "duration_s": 3.0})
    assert other.id == first.id
    runs = evaluate(lambda seen: np.full((len(seen), 2), [0, -1], np.float32), [first, other])
    # A pickled run has its scenario with it.
    assert [json.loads(run.__reduce__()[1][1])["duration_s"] for run in runs] == [first.duration_s, 3.0]


def test_findings_have_the_words_of_the_findings(crashes):
    runs = evaluate(lambda seen: np.full((len(seen), 2), [0, 0.5], np.float32), crashes)
    assert any(run.finding_kinds for run in runs)
    for run in runs:
        assert run.finding_kinds == sorted({finding["kind"] for finding in run.findings}, key=run.finding_kinds.index)
        assert not any(" " in kind for kind in run.finding_kinds)


def test_pictures_for_people(crashes):
    env = CrashEnv(crashes, render_mode="rgb_array")
    env.reset(seed=1)
    picture = env.render()
    assert (picture.shape, picture.dtype) == ((320, 320, 3), np.uint8)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 2
    many = CrashVectorEnv(crashes, 2, render_mode="rgb_array")
    many.reset(seed=1)
    assert len(many.render()) == 2


@pytest.mark.parametrize(
    ("actions", "said"),
    [
        (np.zeros((3, 2)), r"shape \(3, 2\).*wanted are numbers of shape \(4, 2\)"),
        (np.zeros(4), r"shape \(4,\)"),
        (np.array([["a", "b"]] * 4), "type <U1"),
        (np.float32([[0, 0], [0, 0], [0, np.nan], [0, 0]]), "environment 2 has NaN at position 1"),
        (np.float32([[0, np.inf], [0, 0], [0, 0], [0, 0]]), "environment 0 has inf at position 1"),
    ],
)
def test_bad_actions_are_told_and_the_episode_goes_on(crashes, actions, said):
    env = CrashVectorEnv(crashes, 4)
    env.reset(seed=1)
    with pytest.raises(InputError, match=said):
        env.step(actions)
    env.step(np.zeros((4, 2)))


def test_bad_discrete_actions_are_told(crashes):
    env = CrashVectorEnv(crashes, 2, actions="discrete")
    env.reset(seed=1)
    with pytest.raises(InputError, match="environment 1 is 99: actions are 0 to 11"):
        env.step(np.array([0, 99]))
    with pytest.raises(InputError, match="float64"):
        env.step(np.zeros(2))


def test_what_cannot_be_made_is_told(crashes, tmp_path):
    for options, said in [
        ({"observation": "radar"}, "no observation 'radar'; there are: kinematic, rays, raster"),
        ({"observation": {"kind": "rays", "beams": 3}}, "has no 'beams'; it has: kind, count, range_m"),
        ({"observation": {"kind": "kinematic", "neighbours": 99}}, "99 neighbours: a view has 1 to 32"),
        ({"actions": "levers"}, "no actions 'levers'"),
        ({"reward": {"speed": 1.0}}, "the reward has no 'speed'; it has: progress"),
        ({"split": "test"}, "no split 'test'"),
        ({"judge": "no-such"}, "no-such"),
    ]:
        with pytest.raises(InputError, match=said):
            CrashVectorEnv(crashes, 2, **options)
    with pytest.raises(InputError, match="0 environments"):
        CrashVectorEnv(crashes, 0)
    with pytest.raises(InputError, match="no scenario"):
        CrashVectorEnv([], 1)
    with pytest.raises(InputError, match="holds no scenario"):
        CrashVectorEnv(tmp_path, 1)


def test_a_step_before_the_first_reset_and_bad_resets_are_told(crashes):
    env = CrashVectorEnv(crashes, 2)
    with pytest.raises(InputError, match="was never begun"):
        env.step(np.zeros((2, 2)))
    with pytest.raises(InputError, match="one seed is for all"):
        env.reset(seed=[1, 2])
    with pytest.raises(InputError, match="reset_mask"):
        env.reset(options={"reset_mask": np.zeros(2, bool)})
    with pytest.raises(InputError, match="scenario 99"):
        env.reset(options={"scenarios": [0, 99]})
    with pytest.raises(InputError, match=r"no option \['nonsense'\]; it has: scenario"):
        CrashEnv(crashes).reset(options={"nonsense": 1})
    with pytest.raises(InputError, match="no scenario 'nobody'"):
        CrashEnv(crashes).reset(options={"scenario": "nobody"})


def test_a_reward_function_that_gives_nonsense_is_told(crashes):
    env = CrashVectorEnv(crashes, 2, reward=lambda terms: np.zeros(3))
    env.reset(seed=1)
    with pytest.raises(InputError, match=r"gave shape \(3,\); wanted are 2"):
        env.step(np.zeros((2, 2)))

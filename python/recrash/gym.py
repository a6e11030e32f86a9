"""Environments for learning drivers (needs ``gymnasium``).

After ``import recrash.gym``, ``gymnasium.make("recrash/Crash-v0", suite=...)`` is one environment, and
``gymnasium.make_vec("recrash/Crash-v0", num_envs=1024, suite=...)`` (or :class:`CrashVectorEnv` itself) steps many in Rust
threads, without Python's lock, into arrays that are made once.

An episode is one scenario from its handover on: the recorded driver brings the situation about, then the driver that learns
decides every 0.1 s. It ends as the simulator's run ends; ``terminated`` is true for every ending but ``timeout``, for which
``truncated`` is. See ``docs/python.md`` for what is observed, done and rewarded.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ClassVar, Literal

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from recrash import _recrash
from recrash._recrash import ACTS, ENDINGS, FIELDS_ALWAYS, FIELDS_OF_OTHER, TERMS, Run, Scenario
from recrash.errors import InputError
from recrash.suite import Location, Suite, load_scenarios

__all__ = [
    "ACTS",
    "ENDINGS",
    "ENVIRONMENT",
    "FIELDS_ALWAYS",
    "FIELDS_OF_OTHER",
    "TERMS",
    "WEIGHTS",
    "CrashEnv",
    "CrashVectorEnv",
    "evaluate",
    "observation_fields",
    "split",
]

#: Name of the environments for gymnasium, told to it when this module is imported.
ENVIRONMENT = "recrash/Crash-v0"

#: Weights of the reward's terms, where none are given.
WEIGHTS: dict[str, float] = dict(zip(TERMS, _recrash.WEIGHTS, strict=True))

#: A suite, a folder or file of scenarios, or a list of scenarios.
Source = Suite | Location | Iterable[Scenario | Location]
#: What is observed: a name, or a dict with ``kind`` and its numbers.
View = str | Mapping[str, Any]
#: Weights by term, or a function of terms (environments, ``len(TERMS)``) that gives rewards (environments,).
RewardLike = Mapping[str, float] | Callable[[NDArray[np.float32]], NDArray[Any]]
Split = Literal["train", "held_out"]

_VIEWS: dict[str, dict[str, Any]] = {
    "kinematic": {"kind": "kinematic", "neighbours": 6},
    "rays": {"kind": "rays", "count": 64, "range_m": 60.0},
    "raster": {"kind": "raster", "pixels": 64, "pixel_m": 1.0},
}
_MODES = {
    AutoresetMode.NEXT_STEP: "next_step",
    AutoresetMode.SAME_STEP: "same_step",
    AutoresetMode.DISABLED: "disabled",
}
#: How episodes end, by the batch's code; 0 has not.
_BY_CODE = np.array([None, *ENDINGS], object)
#: How pictures for people are coloured: off the road, road, route; then somebody, something; the ego.
_GROUND = np.array([[44, 62, 50], [90, 90, 96], [126, 126, 134]], np.uint8)


def _view(observation: View) -> dict[str, Any]:
    given = {"kind": observation} if isinstance(observation, str) else dict(observation)
    kind = given.get("kind")
    if kind not in _VIEWS:
        raise InputError(f"there is no observation {kind!r}; there are: {', '.join(_VIEWS)}")
    unknown = given.keys() - _VIEWS[kind].keys()
    if unknown:
        known = ", ".join(_VIEWS[kind].keys())
        raise InputError(f"the observation {kind} has no {', '.join(map(repr, sorted(unknown)))}; it has: {known}")
    return {**_VIEWS[kind], **given}


def observation_fields(observation: View = "kinematic") -> list[tuple[str, str, float]]:
    """Name, unit and scale of every number of an observation: what is observed is the value divided by the scale."""
    view = _view(observation)
    fields = list(FIELDS_ALWAYS)
    if view["kind"] == "kinematic":
        for number in range(view["neighbours"]):
            fields += [(f"other_{number}_{name}", unit, scale) for name, unit, scale in FIELDS_OF_OTHER]
    elif view["kind"] == "rays":
        fields += [(f"ray_{number}_distance", "m", view["range_m"]) for number in range(view["count"])]
        fields += [(f"ray_{number}_closing_speed", "m/s", 30.0) for number in range(view["count"])]
    return fields


def split(suite: Source, held_out_share: float = 0.25) -> tuple[list[Scenario], list[Scenario]]:
    """Split scenarios into those for training and those held out, crash by crash: nothing of a crash is in both."""
    scenarios = _scenarios(suite)
    held = _recrash.held_out(scenarios, held_out_share)
    pairs = list(zip(scenarios, held, strict=True))
    return [each for each, out in pairs if not out], [each for each, out in pairs if out]


def _scenarios(suite: Source) -> list[Scenario]:
    return suite.scenarios() if isinstance(suite, Suite) else load_scenarios(suite)


def _chosen(suite: Source, part: Split | None, held_out_share: float, crash_types: Iterable[str] | None) -> list[Scenario]:
    scenarios = _scenarios(suite)
    if part is not None:
        if part not in ("train", "held_out"):
            raise InputError(f"there is no split {part!r}; there are: train, held_out")
        scenarios = split(scenarios, held_out_share)[part == "held_out"]
    if crash_types is not None:
        wanted = set(crash_types)
        there = {scenario.crash_type for scenario in scenarios}
        if wanted - there:
            raise InputError(f"no scenario is of {sorted(wanted - there)}; there are: {sorted(filter(None, there))}")
        scenarios = [scenario for scenario in scenarios if scenario.crash_type in wanted]
    # Of a record whose ego was parked nobody takes over.
    scenarios = [scenario for scenario in scenarios if scenario.tested]
    if not scenarios:
        raise InputError("no scenario is left to drive in; choose another suite, split or crash type")
    return scenarios


class _Core:
    """A batch of runs, with the spaces and checks that both environments share."""

    def __reduce__(self) -> Any:
        raise TypeError(
            "an environment is a simulation that runs, and is not pickled nor copied; make it anew from its scenarios"
        )

    def __init__(
        self,
        scenarios: Sequence[Scenario],
        slots: int,
        observation: View,
        actions: str,
        reward: RewardLike | None,
        autoreset: str,
        judge: bool | str,
        threads: int,
    ) -> None:
        self.scenarios = list(scenarios)
        self.slots = slots
        self.view = _view(observation)
        self.custom = reward if callable(reward) else None
        weights = dict(WEIGHTS)
        if isinstance(reward, Mapping):
            unknown = reward.keys() - weights.keys()
            if unknown:
                raise InputError(f"the reward has no {', '.join(map(repr, sorted(unknown)))}; it has: {', '.join(TERMS)}")
            weights.update(reward)
        handles = {"pedals": "pedals", "guided": "guided", "discrete": "acts"}.get(actions)
        if handles is None:
            raise InputError(f"there are no actions {actions!r}; there are: pedals, guided, discrete")
        profile = judge if isinstance(judge, str) else None
        self.judges = judge is not False
        self.batch = _recrash.Batch(
            self.scenarios, slots, self.view, handles, [float(weights[term]) for term in TERMS], autoreset,
            profile, self.judges, threads,
        )  # fmt: skip
        self.discrete = handles == "acts"
        self.action_space: spaces.Space[Any] = (
            spaces.Discrete(len(ACTS)) if self.discrete else spaces.Box(-1.0, 1.0, (2,), np.float32)
        )
        numbers = spaces.Box(-1.0, 1.0, (self.batch.numbers.shape[1],), np.float32)
        self.pictures = self.view["kind"] == "raster"
        self.observation_space: spaces.Space[Any] = numbers
        if self.pictures:
            image = spaces.Box(0, 255, self.batch.pictures.shape[1:], np.uint8)
            self.observation_space = spaces.Dict({"image": image, "state": numbers})

    def step(self, actions: Any) -> None:
        if self.discrete:
            given = np.asarray(actions)
            if given.shape != (self.slots,) or given.dtype.kind not in "iu":
                wanted = f"whole numbers of shape ({self.slots},)"
                raise InputError(f"the actions have shape {given.shape} and type {given.dtype}; wanted are {wanted}")
            self.batch.step_acts(np.ascontiguousarray(given, np.int64))
        else:
            given = np.asarray(actions)
            if given.shape != (self.slots, 2) or given.dtype.kind not in "fiu":
                wanted = f"numbers of shape ({self.slots}, 2)"
                raise InputError(f"the actions have shape {given.shape} and type {given.dtype}; wanted are {wanted}")
            self.batch.step_numbers(np.ascontiguousarray(given, np.float32))

    def observations(self, copy: bool, final: bool = False) -> Any:
        batch = self.batch
        numbers = batch.final_numbers if final else batch.numbers
        if copy:
            numbers = numbers.copy()
        if not self.pictures:
            return numbers
        pictures = batch.final_pictures if final else batch.pictures
        return {"image": pictures.copy() if copy else pictures, "state": numbers}

    def rewards(self) -> NDArray[np.float64]:
        if self.custom is None:
            return self.batch.rewards.copy()
        given: Any = self.custom(self.batch.terms)
        rewards: NDArray[np.float64] = np.asarray(given, np.float64)
        if rewards.shape != (self.slots,) or not np.isfinite(rewards).all():
            shape = f"shape {rewards.shape}" if rewards.shape != (self.slots,) else "numbers that are not finite"
            raise InputError(f"the reward function gave {shape}; wanted are {self.slots} finite numbers")
        return rewards

    def weights_of(self, curriculum: Mapping[str, float]) -> list[float]:
        there = {scenario.crash_type for scenario in self.scenarios}
        unknown = curriculum.keys() - there
        if unknown:
            raise InputError(f"no scenario is of {sorted(unknown)}; there are: {sorted(filter(None, there))}")
        counts: dict[str | None, int] = {}
        for scenario in self.scenarios:
            counts[scenario.crash_type] = counts.get(scenario.crash_type, 0) + 1
        return [curriculum.get(each.crash_type or "", 0.0) / counts[each.crash_type] for each in self.scenarios]

    def picture(self, slot: int, pixels: int = 320, pixel_m: float = 0.25) -> NDArray[np.uint8]:
        ground, users = self.batch.picture(slot, pixels, pixel_m)
        image: NDArray[np.uint8] = _GROUND[ground.astype(np.intp) // 127]
        image[users == 255] = (232, 160, 60)
        image[users == 128] = (200, 80, 80)
        row, column = int(0.75 * pixels), pixels // 2
        length, width = int(4.5 / pixel_m) // 2, int(1.9 / pixel_m) // 2
        image[row - length : row + length, column - width : column + width] = (90, 170, 255)
        return image


class CrashVectorEnv(VectorEnv[Any, Any, NDArray[Any]]):
    """Many environments, stepped together in Rust threads.

    :param suite: where the scenarios come from: a :class:`recrash.Suite`, a folder, or a list.
    :param num_envs: how many environments.
    :param observation: ``"kinematic"`` (default), ``"rays"``, ``"raster"``, or a dict such as
        ``{"kind": "kinematic", "neighbours": 3}``. Numbers are float32 of shape (num_envs, fields) from -1 to 1, see
        :func:`observation_fields`; a raster is a dict with ``image``, uint8 of shape (num_envs, 2, rows, columns), and
        ``state``.
    :param actions: ``"pedals"``: float32 (num_envs, 2) from -1 to 1, steering (left positive) and throttle (negative brakes);
        ``"guided"``: acceleration, and the place beside the route to steer to (1 is 3.5 m to its right); ``"discrete"``: int64
        (num_envs,), positions in :data:`ACTS`.
    :param reward: weights by term (see :data:`WEIGHTS`), or a function of all terms that gives the rewards.
    :param autoreset_mode: when the next episode begins, as gymnasium 1.x has it.
    :param judge: whether episodes that end are judged, by the default profile or the one named here; then ``infos`` hold
        ``run``, ``failed``, ``findings`` and ``delta_v_mps``.
    :param split: ``"train"`` or ``"held_out"``: those scenarios only, see :func:`split`.
    :param crash_types: scenarios of these types only.
    :param threads: threads that step; as many as there are cores where not given.
    :param copy: whether observations are copies. Without, the next step overwrites them.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        suite: Source,
        num_envs: int = 1,
        *,
        observation: View = "kinematic",
        actions: str = "pedals",
        reward: RewardLike | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        judge: bool | str = True,
        split: Split | None = None,
        held_out_share: float = 0.25,
        crash_types: Iterable[str] | None = None,
        threads: int | None = None,
        copy: bool = True,
        render_mode: str | None = None,
    ) -> None:
        super().__init__()
        mode = AutoresetMode(autoreset_mode)
        scenarios = _chosen(suite, split, held_out_share, crash_types)
        threads = threads if threads is not None else min(os.cpu_count() or 1, max(num_envs // 16, 1))
        self._core = _Core(scenarios, num_envs, observation, actions, reward, _MODES[mode], judge, threads)
        self.metadata = {**type(self).metadata, "autoreset_mode": mode}
        self.render_mode = render_mode
        self.num_envs = num_envs
        self.single_observation_space = self._core.observation_space
        self.single_action_space = self._core.action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._mode, self._copy, self._seeded = mode, copy, False
        self._totals, self._begins = np.zeros(num_envs), np.zeros(num_envs, bool)

    @property
    def scenarios(self) -> list[Scenario]:
        """What is driven in; ``infos["scenario"]`` has positions in it."""
        return self._core.scenarios

    def set_curriculum(self, curriculum: Mapping[str, float] | Sequence[float]) -> None:
        """Draw the scenarios of later episodes by weights: of crash types (each shared out evenly), or one for each scenario."""
        weights = self._core.weights_of(curriculum) if isinstance(curriculum, Mapping) else [float(w) for w in curriculum]
        self._core.batch.set_weights(weights)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin episodes. ``options``: ``reset_mask`` (bool, those environments only), ``scenarios`` (positions, one each)."""
        options = options or {}
        unknown = options.keys() - {"reset_mask", "scenarios"}
        if unknown:
            raise InputError(f"reset has no option {sorted(unknown)}; it has: reset_mask, scenarios")
        if seed is not None and not isinstance(seed, (int, np.integer)):
            raise InputError("one seed is for all environments, each of which has a stream of its own; give one whole number")
        mask, scenes = options.get("reset_mask"), options.get("scenarios")
        if mask is not None:
            mask = np.asarray(mask)
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
                raise InputError(f"reset_mask is bool of shape ({self.num_envs},), one of them true; it is {mask!r}")
        if scenes is not None:
            scenes = np.ascontiguousarray(scenes, np.int64)
        if seed is not None:
            self._np_random, self._np_random_seed = gymnasium.utils.seeding.np_random(int(seed))
        elif not self._seeded:
            seed = int(self.np_random.integers(1 << 62))
        self._seeded = True
        self._core.batch.reset(None if seed is None else int(seed), mask, scenes)
        begun = slice(None) if mask is None else mask
        self._totals[begun], self._begins[begun] = 0.0, False
        return self._core.observations(self._copy), {"scenario": self._core.batch.scenes.copy()}

    def step(self, actions: Any) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Go on by 0.1 s in every environment."""
        core = self._core
        core.step(actions)
        batch = core.batch
        rewards = core.rewards()
        if core.custom is not None:
            # The step that only begins an episode is none of it.
            rewards = np.where(self._begins, 0.0, rewards)
            self._totals += rewards
        terminated, truncated = batch.terminated.copy(), batch.truncated.copy()
        infos: dict[str, Any] = {"scenario": batch.scenes.copy(), "reward_terms": batch.terms.copy()}
        ended = batch.endings != 0
        self._begins = ended if self._mode is AutoresetMode.NEXT_STEP else np.zeros(self.num_envs, bool)
        if ended.any():
            final = self._ended(ended)
            if self._mode is AutoresetMode.SAME_STEP:
                observations: NDArray[Any] = np.empty(self.num_envs, object)
                last = core.observations(copy=True, final=True)
                for slot in np.flatnonzero(ended):
                    own = {name: part[slot] for name, part in last.items()} if core.pictures else last[slot]
                    observations[slot] = own
                infos.update(final_obs=observations, _final_obs=ended, final_info=final, _final_info=ended)
            else:
                infos.update(final)
        return core.observations(self._copy), rewards, terminated, truncated, infos

    def _ended(self, ended: NDArray[np.bool_]) -> dict[str, Any]:
        batch = self._core.batch
        returns = batch.episode_returns.copy()
        if self._core.custom is not None:
            returns = np.where(ended, self._totals, 0.0)
            self._totals[ended] = 0.0
        endings = _BY_CODE[batch.endings]
        episode = {"r": returns, "_r": ended, "l": batch.episode_steps.copy(), "_l": ended}
        found: dict[str, Any] = {"ending": endings, "_ending": ended, "episode": episode, "_episode": ended}
        if self._core.judges:
            runs: NDArray[Any] = np.full(self.num_envs, None, object)
            findings: NDArray[Any] = np.full(self.num_envs, None, object)
            failed, delta_v = np.zeros(self.num_envs, bool), np.zeros(self.num_envs)
            for slot in np.flatnonzero(ended):
                run = batch.judged(int(slot))
                if run is not None:
                    runs[slot], findings[slot] = run, run.finding_kinds
                    failed[slot], delta_v[slot] = run.failed, run.delta_v_mps or 0.0
            told = {"run": runs, "findings": findings, "failed": failed, "delta_v_mps": delta_v}
            for name, values in told.items():
                found[name], found[f"_{name}"] = values, ended
        return found

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """Pictures from above, uint8 of shape (320, 320, 3), one for each environment."""
        if self.render_mode != "rgb_array":
            return None
        return tuple(self._core.picture(slot) for slot in range(self.num_envs))


class CrashEnv(gymnasium.Env[Any, Any]):
    """One environment: ``gymnasium.make("recrash/Crash-v0", suite=...)``. Arguments as of :class:`CrashVectorEnv`.

    At the end of an episode ``info`` has ``ending``, ``episode`` and, where episodes are judged, ``run``, ``failed``,
    ``findings`` (kinds) and ``severity`` (``None`` without a contact).
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array", "human"], "render_fps": 10}  # type: ignore[misc]

    def __init__(
        self,
        suite: Source,
        *,
        observation: View = "kinematic",
        actions: str = "pedals",
        reward: RewardLike | None = None,
        judge: bool | str = True,
        split: Split | None = None,
        held_out_share: float = 0.25,
        crash_types: Iterable[str] | None = None,
        render_mode: str | None = None,
    ) -> None:
        scenarios = _chosen(suite, split, held_out_share, crash_types)
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise InputError(f"there is no render mode {render_mode!r}; there are: rgb_array, human")
        self._core = _Core(scenarios, 1, observation, actions, reward, "disabled", judge, 1)
        self.observation_space = self._core.observation_space
        self.action_space = self._core.action_space
        self.render_mode = render_mode
        self._seeded, self._total = False, 0.0
        self._window: Any = None

    @property
    def scenarios(self) -> list[Scenario]:
        """What is driven in."""
        return self._core.scenarios

    def set_curriculum(self, curriculum: Mapping[str, float] | Sequence[float]) -> None:
        """Draw the scenarios of later episodes by weights, see :meth:`CrashVectorEnv.set_curriculum`."""
        weights = self._core.weights_of(curriculum) if isinstance(curriculum, Mapping) else [float(w) for w in curriculum]
        self._core.batch.set_weights(weights)

    def _observation(self) -> Any:
        if self._core.pictures:
            return {name: part[0] for name, part in self._core.observations(copy=True).items()}
        return self._core.observations(copy=True)[0]

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode. ``options``: ``scenario``, the id of one or its position; drawn without it."""
        unknown = (options or {}).keys() - {"scenario"}
        if unknown:
            raise InputError(f"reset has no option {sorted(unknown)}; it has: scenario")
        super().reset(seed=seed)
        if seed is None and not self._seeded:
            seed = int(self.np_random.integers(1 << 62))
        self._seeded = True
        scenes = None
        wanted = (options or {}).get("scenario")
        if wanted is not None:
            ids = [scenario.id for scenario in self.scenarios]
            if isinstance(wanted, str) and wanted not in ids:
                raise InputError(f"there is no scenario {wanted!r} to drive in; the first of {len(ids)} is {ids[0]!r}")
            scenes = np.array([ids.index(wanted) if isinstance(wanted, str) else wanted], np.int64)
        self._core.batch.reset(seed, None, scenes)
        self._total = 0.0
        info = {"scenario": self.scenarios[int(self._core.batch.scenes[0])].id}
        if self.render_mode == "human":
            self.render()
        return self._observation(), info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Go on by 0.1 s."""
        core, batch = self._core, self._core.batch
        given = np.asarray(action)
        if given.shape != self.action_space.shape:
            raise InputError(f"the action has shape {given.shape}; wanted is {self.action_space.shape}")
        core.step(given[np.newaxis])
        reward = float(core.rewards()[0])
        self._total += reward
        info: dict[str, Any] = {"scenario": self.scenarios[int(batch.scenes[0])].id}
        info["reward_terms"] = dict(zip(TERMS, map(float, batch.terms[0]), strict=True))
        if batch.endings[0]:
            info["ending"] = ENDINGS[batch.endings[0] - 1]
            info["episode"] = {"r": self._total, "l": int(batch.episode_steps[0])}
            run = batch.judged(0)
            if run is not None:
                info.update(run=run, failed=run.failed, findings=run.finding_kinds, severity=run.severity)
        if self.render_mode == "human":
            self.render()
        return self._observation(), reward, bool(batch.terminated[0]), bool(batch.truncated[0]), info

    def render(self) -> NDArray[np.uint8] | None:
        """Show the scene from above: as an array of shape (320, 320, 3), or in a window of matplotlib's."""
        if self.render_mode is None:
            return None
        picture = self._core.picture(0)
        if self.render_mode == "rgb_array":
            return picture
        import matplotlib.pyplot as plt

        if self._window is None:
            self._window = plt.imshow(picture)
            plt.axis("off")
        self._window.set_data(picture)
        plt.pause(0.001)
        return None

    def close(self) -> None:
        """Close the window."""
        if self._window is not None:
            import matplotlib.pyplot as plt

            plt.close(self._window.figure)
            self._window = None


def evaluate(policy: Callable[[Any], Any], suite: Source, **options: Any) -> list[Run]:
    """Drive every scenario once with a policy; the judged runs, in order.

    The policy is handed the observations of all scenarios at once, as :class:`CrashVectorEnv` gives them (a row each; a dict of
    arrays with ``"raster"``), and gives an action for each: ``lambda seen: numpy.stack([one(each) for each in seen])`` where
    ``one`` goes by a single observation. ``options`` are those of :class:`CrashVectorEnv` but ``num_envs`` and
    ``autoreset_mode``; episodes are always judged.
    """
    if own := options.keys() & {"num_envs", "autoreset_mode"}:
        raise InputError(f"evaluate chooses {', '.join(sorted(own))} itself; leave it out")
    if options.get("judge", True) is False:
        raise InputError("evaluate gives judged runs: judge is True or the name of a profile; it is False")
    scenarios = _chosen(suite, options.pop("split", None), options.pop("held_out_share", 0.25), options.pop("crash_types", None))
    env = CrashVectorEnv(scenarios, len(scenarios), **options)
    observations, _ = env.reset(seed=0, options={"scenarios": np.arange(len(scenarios))})
    actions = _first_actions(policy, observations, env)
    runs: list[Run | None] = [None] * len(scenarios)
    while True:
        observations, _, _, _, infos = env.step(actions)
        for slot in np.flatnonzero(infos.get("_run", ())):
            # Later episodes of a slot are others' scenarios; the first is its own.
            runs[slot] = runs[slot] or infos["run"][slot]
        if all(run is not None for run in runs):
            return [run for run in runs if run is not None]
        actions = policy(observations)


def _first_actions(policy: Callable[[Any], Any], observations: Any, env: CrashVectorEnv) -> Any:
    """Ask a policy for the first time: one that goes by a single observation is told how it is wrapped."""
    batch = f"evaluate hands the policy the observations of all {env.num_envs} scenarios at once, and wants an action for each"
    wrap = "wrap a policy of one observation: lambda seen: numpy.stack([policy(each) for each in seen])"
    try:
        actions = policy(observations)
    except Exception as error:
        if hasattr(error, "add_note"):  # Since Python 3.11.
            error.add_note(f"{batch}; {wrap}")
        raise
    wanted, given = env.action_space.shape, np.shape(actions)
    if given != wanted:
        raise InputError(f"{batch}, of shape {wanted}; it gave shape {given}; {wrap}")
    return actions


gymnasium.register(ENVIRONMENT, "recrash.gym:CrashEnv", vector_entry_point="recrash.gym:CrashVectorEnv")

"""Stable-Baselines3 on the native vector environment (needs ``stable-baselines3``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.vec_env import VecEnv

from recrash.gym import CrashVectorEnv, Source

__all__ = ["CrashVecEnv"]


class CrashVecEnv(VecEnv):
    """Many environments as Stable-Baselines3 wants them. Arguments as of :class:`recrash.gym.CrashVectorEnv`."""

    def __init__(self, suite: Source, num_envs: int, **options: Any) -> None:
        options.setdefault("judge", False)
        self.vector = CrashVectorEnv(suite, num_envs, autoreset_mode=AutoresetMode.SAME_STEP, **options)
        super().__init__(num_envs, self.vector.single_observation_space, self.vector.single_action_space)

    def reset(self) -> Any:
        """Begin an episode everywhere."""
        seed = self._seeds[0]
        self._reset_seeds()
        return self.vector.reset(seed=seed)[0]

    def step_async(self, actions: Any) -> None:
        """Keep the actions for :meth:`step_wait`."""
        self._actions = actions

    def step_wait(self) -> tuple[Any, Any, Any, list[dict[str, Any]]]:
        """Go on by 0.1 s."""
        observations, rewards, terminated, truncated, infos = self.vector.step(self._actions)
        done = terminated | truncated
        told: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        if done.any():
            final = infos["final_info"]
            for slot in np.flatnonzero(done):
                told[slot] = {
                    "terminal_observation": infos["final_obs"][slot],
                    "TimeLimit.truncated": bool(truncated[slot]),
                    "episode": {"r": float(final["episode"]["r"][slot]), "l": int(final["episode"]["l"][slot])},
                    "ending": final["ending"][slot],
                }
        return observations, rewards.astype(np.float32), done, told

    def close(self) -> None:
        """Nothing is open."""

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute, the same for each environment."""
        return [getattr(self.vector, attr_name)] * self._count(indices)

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Set an attribute of all."""
        setattr(self.vector, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **options: Any) -> list[Any]:
        """Call a method once, for all."""
        return [getattr(self.vector, method_name)(*args, **options)] * self._count(indices)

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """No environment is wrapped."""
        return [False] * self._count(indices)

    def _count(self, indices: int | Sequence[int] | None) -> int:
        if indices is None:
            return self.num_envs
        return 1 if isinstance(indices, int) else len(indices)

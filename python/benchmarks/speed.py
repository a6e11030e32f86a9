"""Environment steps per second: recrash's vector, highway-env and MetaDrive, each with two road users and numbers, in one run.

    python benchmarks/speed.py --metadrive-python .../bin/python

Everything is measured in turns, and the best turn counts, so that other work on the machine meets all alike. Figures are given
by the wall clock and by the time that processors spent on it: on a machine that others use too, only the second is a figure
per core.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import time

ROUNDS, SECONDS = 5, 2.0

METADRIVE = """
import json, logging, sys, time
logging.disable(logging.CRITICAL)
from metadrive import MetaDriveEnv
from metadrive.engine.base_engine import BaseEngine
# Pictures only; without it the engine would download its assets.
BaseEngine.try_pull_asset = staticmethod(lambda *arguments, **options: None)
env = MetaDriveEnv(dict(use_render=False, log_level=50, map="S", traffic_density=0.0, num_scenarios=1, horizon=1000,
    accident_prob=0.0, vehicle_config=dict(lidar=dict(num_lasers=0, num_others=0), side_detector=dict(num_lasers=0),
    lane_line_detector=dict(num_lasers=0))))
env.reset()
for line in sys.stdin:
    begun, spent, steps = time.perf_counter(), time.process_time(), 0
    while time.perf_counter() - begun < float(line):
        _, _, over, cut, _ = env.step([0.0, 0.3])
        steps += 1
        if over or cut:
            env.reset()
    print(json.dumps([steps, time.perf_counter() - begun, time.process_time() - spent]), flush=True)
"""


class Recrash:
    """The vector, in a scenario of the ego and one other car that brakes ahead of it."""

    def __init__(self, threads: int, judge: bool, size: int = 1024) -> None:
        import numpy as np

        from recrash.gym import CrashVectorEnv

        self.name = f"recrash, {threads} thread{'s' if threads > 1 else ''}{', episodes judged' if judge else ''}"
        here = os.path.join(os.path.dirname(__file__), "../../cases/crashes/32-lead-reverses.json")
        view = {"kind": "kinematic", "neighbours": 4}
        self.env = CrashVectorEnv([here], size, observation=view, actions="pedals", threads=threads, judge=judge)
        self.env.reset(seed=1)
        random = np.random.default_rng(1)
        self.actions = [random.uniform(-0.2, 0.2, (size, 2)).astype(np.float32) for _ in range(16)]
        self.size = size

    def turn(self) -> tuple[int, float, float]:
        """Step for a while: steps, wall and processor time."""
        begun, spent, calls = time.perf_counter(), time.process_time(), 0
        while time.perf_counter() - begun < SECONDS:
            self.env.step(self.actions[calls % 16])
            calls += 1
        return calls * self.size, time.perf_counter() - begun, time.process_time() - spent


class Highway:
    """highway-env with one other vehicle, kinematic observation, continuous actions, a decision each 0.1 s."""

    def __init__(self) -> None:
        import gymnasium
        import highway_env

        self.name = f"highway-env {highway_env.__version__ if hasattr(highway_env, '__version__') else ''}".strip()
        config = {
            "observation": {"type": "Kinematics", "vehicles_count": 5}, "action": {"type": "ContinuousAction"},
            "vehicles_count": 1, "controlled_vehicles": 1, "simulation_frequency": 50, "policy_frequency": 10, "duration": 100,
        }  # fmt: skip
        gymnasium.register_envs(highway_env)
        self.env = gymnasium.make("highway-v0", config=config, disable_env_checker=True)
        self.env.reset(seed=1)

    def turn(self) -> tuple[int, float, float]:
        """Step for a while."""
        begun, spent, steps = time.perf_counter(), time.process_time(), 0
        while time.perf_counter() - begun < SECONDS:
            _, _, over, cut, _ = self.env.step([0.1, 0.0])
            steps += 1
            if over or cut:
                self.env.reset()
        return steps, time.perf_counter() - begun, time.process_time() - spent


class Metadrive:
    """MetaDrive in a Python of its own, without lasers; the ego alone, which is to its favour."""

    def __init__(self, python: str) -> None:
        self.name = "MetaDrive (one road user)"
        self.program = subprocess.Popen(
            [python, "-c", METADRIVE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
        )

    def turn(self) -> tuple[int, float, float]:
        """Step for a while."""
        assert self.program.stdin is not None
        assert self.program.stdout is not None
        self.program.stdin.write(f"{SECONDS}\n")
        self.program.stdin.flush()
        for line in self.program.stdout:
            if line.startswith("["):
                steps, wall, spent = json.loads(line)
                return steps, wall, spent
        raise RuntimeError("MetaDrive ended")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--metadrive-python", help="interpreter that has MetaDrive; left out without")
    arguments = parser.parse_args()
    sides = [Recrash(1, False), Recrash(2, False), Recrash(1, True), Highway()]
    if arguments.metadrive_python:
        sides.append(Metadrive(arguments.metadrive_python))
    wall, spent = {}, {}
    for _ in range(ROUNDS):
        for side in sides:
            steps, wall_s, processor_s = side.turn()
            wall[side.name] = max(wall.get(side.name, 0.0), steps / wall_s)
            spent[side.name] = max(spent.get(side.name, 0.0), steps / processor_s)
    print(f"{os.cpu_count()} cores, {platform.platform()}, Python {platform.python_version()}; load {os.getloadavg()}")
    print(f"{'':36} {'steps/s by the wall':>20} {'steps/s per core':>18}")
    for name in wall:
        print(f"{name:36} {wall[name]:>20,.0f} {spent[name]:>18,.0f}")
    own = spent[sides[0].name]
    print(f"\nasked for: 600,000 steps/s per core: {own:,.0f}")
    for side in sides[3:]:
        print(f"times {side.name}, per core: {own / spent[side.name]:,.0f}")
    print(f"times one thread by the wall, two threads: {wall[sides[1].name] / wall[sides[0].name]:.2f} (asked for: 1.8)")


if __name__ == "__main__":
    sys.exit(main())

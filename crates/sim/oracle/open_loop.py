"""Drives MetaDrive's StaticDefaultVehicle open loop and writes its trajectories as CSV.

Measures what the native vehicle model is held against (docs/models/vehicle.md). Needs Python 3.11 and
`pip install metadrive-simulator==0.4.3`; no assets, no GPU.

    python open_loop.py random  --seed 1 --runs 12 --limits 0.05,0.2,0.5 > ../tests/fixtures/open_loop.csv
    python open_loop.py steady                                           > steady.csv

Each run is 5 s on a wide, flat road. Columns: run, limit (greatest |steering|), time_s, steer, throttle, x, y, heading,
speed, yaw_rate. The controls of a row are those applied from that time on.
"""

import argparse
import math
import random
import sys

from metadrive.component.vehicle.vehicle_type import StaticDefaultVehicle
from metadrive.engine.base_engine import BaseEngine
from metadrive.envs.metadrive_env import MetaDriveEnv
from metadrive.obs.observation_base import DummyObservation

BaseEngine.try_pull_asset = staticmethod(lambda *a, **k: None)

SUBSTEPS = 5


def make_env():
    return MetaDriveEnv(
        dict(
            use_render=False,
            log_level=50,
            num_scenarios=1,
            start_seed=0,
            traffic_density=0.0,
            agent_observation=DummyObservation,
            map_config=dict(type="block_sequence", config="S", lane_num=3, exit_length=200),
            vehicle_config=dict(vehicle_model="static_default", show_navi_mark=False),
            random_spawn_lane_index=False,
            show_sidewalk=False,
            show_crosswalk=False,
            force_destroy=True,
            out_of_road_done=False,
            on_continuous_line_done=False,
            crash_vehicle_done=False,
            crash_object_done=False,
            horizon=None,
        )
    )


def run(env, speed, plan, steps, every=SUBSTEPS):
    """Applies plan(step) -> (steer, throttle) for `steps` decisions; yields a row every `every` substeps."""
    env.config["agent_configs"]["default_agent"].update(
        dict(
            spawn_lane_index=(">", ">>", 1),
            spawn_longitude=5.0,
            spawn_velocity=[speed, 0.0],
            spawn_velocity_car_frame=True,
        )
    )
    env.reset(seed=0)
    vehicle = env.agent
    assert isinstance(vehicle, StaticDefaultVehicle), type(vehicle)
    body = vehicle.body
    x0, y0 = vehicle.position

    def row(time, steer, throttle):
        x, y = vehicle.position
        return (time, steer, throttle, x - x0, y - y0, vehicle.heading_theta, vehicle.speed, body.getAngularVelocity()[2])

    for step in range(steps):
        steer, throttle = plan(step)
        yield row(step * 0.1, steer, throttle)
        vehicle._set_action([steer, throttle])
        for sub in range(SUBSTEPS):
            env.engine.step_physics_world()
            if (sub + 1) % every == 0 and sub + 1 < SUBSTEPS:
                yield row(step * 0.1 + (sub + 1) * 0.02, steer, throttle)
    yield row(steps * 0.1, 0.0, 0.0)


def random_plan(rng, limit, steps):
    """Controls that change every 0.8 s: throttle, brake or coast, and any steering within the limit."""
    controls = []
    for _ in range(0, steps, 8):
        kind = rng.random()
        throttle = rng.uniform(0.1, 1.0) if kind < 0.55 else (-rng.uniform(0.05, 1.0) if kind < 0.8 else 0.0)
        controls += [(rng.uniform(-limit, limit), throttle)] * 8
    return lambda step: controls[step]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["random", "steady", "steps"])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=12)
    parser.add_argument("--limits", default="0.05,0.2,0.5")
    parser.add_argument("--fine", action="store_true", help="every physics step, not every decision")
    args = parser.parse_args()
    env = make_env()
    every = 1 if args.fine else SUBSTEPS
    plans = []
    if args.what == "random":
        rng = random.Random(args.seed)
        for limit in map(float, args.limits.split(",")):
            for _ in range(args.runs):
                plans.append((limit, rng.uniform(2.0, 18.0), random_plan(rng, limit, 50), 50))
    elif args.what == "steady":
        for steer in (0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 1.0):
            for speed in (3.0, 6.0, 10.0, 15.0, 20.0):
                plans.append((steer, speed, (lambda s: lambda step: (s if step >= 10 else 0.0, 0.1))(steer), 50))
    else:
        for throttle in (1.0, 0.5, 0.0, -0.02, -0.1, -0.2, -0.3, -0.4, -0.5, -0.7, -0.8, -0.9, -1.0):
            for speed in (0.0, 10.0, 20.0):
                plans.append((0.0, speed, (lambda t: lambda step: (0.0, t))(throttle), 50))
    print("run,limit,time_s,steer,throttle,x,y,heading,speed,yaw_rate")
    for number, (limit, speed, plan, steps) in enumerate(plans):
        for values in run(env, speed, plan, steps, every):
            print(f"{number},{limit}," + ",".join(f"{v:.5f}" for v in values))
    env.close()


if __name__ == "__main__":
    main()

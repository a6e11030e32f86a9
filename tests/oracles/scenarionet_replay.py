"""Reads ScenarioNet files as MetaDrive does, checks them by its `sanity_check`, and replays them in its `ScenarioEnv`.

Runs in the environment of requirements/metadrive.txt. One argument is the folder of the files; one JSON object is printed per
file: where everything was at every step, in the file's coordinates, and how many of the map's features MetaDrive took.
"""

import json
import pickle
import sys
from pathlib import Path

import numpy
from metadrive.engine.base_engine import BaseEngine
from metadrive.envs.scenario_env import ScenarioEnv
from metadrive.policy.replay_policy import ReplayEgoCarPolicy
from metadrive.scenario.scenario_description import ScenarioDescription

# Pictures only; without it the engine would download its assets.
BaseEngine.try_pull_asset = staticmethod(lambda *arguments, **options: None)


def environment(folder, count):
    return ScenarioEnv(
        {
            "data_directory": str(folder),
            "num_scenarios": count,
            "agent_policy": ReplayEgoCarPolicy,
            "store_map": False,
            "force_destroy": True,
            "filter_overlapping_car": False,
            "max_lateral_dist": 50,
            "log_level": 50,
        }
    )


def checked(path):
    """The dict, checked: plain types, nothing but zeros where something is not there."""
    with open(path, "rb") as file:
        content = pickle.load(file)
    ScenarioDescription.sanity_check(content, check_self_type=True, valid_check=True)
    # What ScenarioNet makes of every file of a data set.
    ScenarioDescription.update_summaries(ScenarioDescription(content))
    return content


def replay(env, seed, content):
    env.reset(seed=seed)
    traffic, lights = env.engine.traffic_manager, env.engine.light_manager
    sdc = content["metadata"]["sdc_id"]
    places = {}
    shown = {}

    def look(step):
        there = {sdc: env.agent}
        for track, name in traffic._scenario_id_to_obj_id.items():
            there[track] = traffic.spawned_objects[name]
        for track, thing in there.items():
            x, y = thing.position
            places.setdefault(track, {})[step] = [float(x), float(y), float(thing.heading_theta)]
        for lane, name in lights._scenario_id_to_obj_id.items():
            shown.setdefault(lane, []).append(str(lights.spawned_objects[name].status))

    look(0)
    for step in range(1, content["length"]):
        env.step([0.0, 0.0])
        look(step)
    return places, shown


def main():
    folder = Path(sys.argv[1])
    contents = {path.name: checked(path) for path in sorted(folder.glob("*.pkl"))}
    env = environment(folder, len(contents))
    env.reset(seed=0)
    names = list(env.engine.data_manager.summary_lookup)
    for seed, name in enumerate(names):
        content = contents[name]
        places, shown = replay(env, seed, content)
        lanes = env.engine.current_map.road_network.graph
        tracks = {
            track: {
                "type": value["type"],
                "position": value["state"]["position"][:, :2].tolist(),
                "heading": value["state"]["heading"].tolist(),
                "valid": value["state"]["valid"].tolist(),
                "finite": bool(all(numpy.isfinite(part).all() for part in value["state"].values())),
                "replayed": places.get(track, {}),
            }
            for track, value in content["tracks"].items()
        }
        answer = {
            "file": name,
            "id": content["id"],
            "length": content["length"],
            "origin": (-content["metadata"]["old_origin_in_current_coordinate"]).tolist(),
            "contacts": content["metadata"]["contacts"],
            "tracks": tracks,
            "lights": shown,
            "lanes": len(lanes),
            "features": [value["type"] for value in content["map_features"].values()],
        }
        print(json.dumps(answer))
    env.close()


main()

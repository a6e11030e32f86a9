"""Writes every lane of a set of maps, as MetaDrive 0.4.3 builds them, to a JSON fixture.

    PYTHONHASHSEED=0 python crates/roads/oracle/metadrive_lanes.py crates/roads/tests/fixtures/metadrive_lanes.json

Needs `pip install metadrive-simulator==0.4.3` (Python < 3.12). The Rust test `metadrive_lanes.rs` builds the same maps
from the `map` objects in the fixture and compares every lane. Numbers are rounded to 1e-9 m to keep the file small.
"""

import json
import sys

from metadrive.component.map.pg_map import PGMap
from metadrive.component.pgblock.curve import Curve
from metadrive.component.pgblock.first_block import FirstPGBlock
from metadrive.component.pgblock.roundabout import Roundabout
from metadrive.component.pgblock.std_intersection import StdInterSection
from metadrive.component.pgblock.std_t_intersection import StdTInterSection
from metadrive.component.pgblock.straight import Straight
from metadrive.engine.base_engine import BaseEngine
from metadrive.envs.metadrive_env import MetaDriveEnv
from metadrive.manager.pg_map_manager import PGMapManager

BLOCKS = {"S": Straight, "C": Curve, "X": StdInterSection, "T": StdTInterSection, "O": Roundabout}
MISSING = {"right": 0, "ahead": 1, "left": 2}
SAMPLES = [0.0, 0.25, 0.5, 0.75, 1.0]


def block_parameters(spec):
    kind = spec["type"]
    if kind == "S":
        return {"length": spec["length_m"]}
    if kind == "C":
        return {
            "length": spec["length_m"],
            "radius": spec["radius_m"],
            "angle": spec["angle_deg"],
            "dir": {"left": 0, "right": 1}[spec["direction"]],
        }
    junction = {"change_lane_num": 0, "decrease_increase": 0}
    if kind == "X":
        return junction
    if kind == "T":
        return dict(junction, t_type=MISSING[spec["missing"]])
    return {"exit_radius": spec["exit_radius_m"], "inner_radius": spec["inner_radius_m"], "angle": 60}


class SpecMap(PGMap):
    """A map of one block behind the first, with every parameter fixed."""

    spec = None

    def _generate(self):
        spec = type(self).spec
        parent, physics = self.engine.worldNP, self.engine.physics_world
        first = FirstPGBlock(
            self.road_network,
            spec["lane_width_m"],
            spec["lanes"],
            parent,
            physics,
            length=spec["approach_m"],
            ignore_intersection_checking=True,
        )
        block_type = BLOCKS[spec["type"]]
        if "arm_m" in spec:
            block_type.EXIT_PART_LENGTH = spec["arm_m"]
        block = block_type(
            1, first.get_socket(0), self.road_network, random_seed=1, ignore_intersection_checking=True
        )
        block.construct_block(parent, physics, extra_config=block_parameters(spec))
        self.blocks = [first, block]
        self.road_network.after_init()


class SpecMapManager(PGMapManager):
    def reset(self):
        config = self.engine.global_config["map_config"].copy()
        self.current_map = self.spawn_object(SpecMap, map_config=config, random_seed=None)


class SpecEnv(MetaDriveEnv):
    def setup_engine(self):
        super().setup_engine()
        self.engine.update_manager("map_manager", SpecMapManager())


def rounded(values):
    return [round(float(value), 9) + 0.0 for value in values]


def describe(network):
    lanes = []
    for start, ends in network.graph.items():
        for end, road in ends.items():
            for index, lane in enumerate(road):
                lanes.append(
                    {
                        "from": start,
                        "to": end,
                        "index": index,
                        "length_m": round(float(lane.length), 9),
                        "width_m": round(float(lane.width_at(0)), 9),
                        "points": [rounded(lane.position(f * lane.length, 0)) for f in SAMPLES],
                        "headings": rounded(lane.heading_theta_at(f * lane.length) for f in SAMPLES),
                        "right_edge": rounded(lane.position(0.5 * lane.length, 0.5 * lane.width_at(0))),
                    }
                )
    return sorted(lanes, key=lambda lane: (lane["from"], lane["to"], lane["index"]))


def specs():
    for lanes in (1, 2, 3, 4):
        base = {"lanes": lanes, "lane_width_m": 3.5, "approach_m": 60.0}
        yield dict(base, type="S", length_m=80.0)
        yield dict(base, type="C", radius_m=50.0, angle_deg=90.0, direction="left", length_m=40.0)
        yield dict(base, type="C", radius_m=40.0, angle_deg=60.0, direction="right", length_m=25.0)
        yield dict(base, type="X", arm_m=60.0)
        for missing in ("right", "ahead", "left"):
            yield dict(base, type="T", arm_m=45.0, missing=missing)
        yield dict(base, type="O", arm_m=50.0, exit_radius_m=10.0, inner_radius_m=30.0)
    narrow = {"lanes": 2, "lane_width_m": 3.0, "approach_m": 35.0}
    yield dict(narrow, type="S", length_m=120.0)
    yield dict(narrow, type="C", radius_m=25.0, angle_deg=120.0, direction="right", length_m=15.0)
    yield dict(narrow, type="X", arm_m=100.0)
    yield dict(narrow, type="T", arm_m=30.0, missing="ahead")
    yield dict(narrow, type="O", arm_m=30.0, exit_radius_m=7.5, inner_radius_m=18.0)


def main(path):
    BaseEngine.try_pull_asset = staticmethod(lambda: None)
    maps = []
    for spec in specs():
        SpecMap.spec = spec
        env = SpecEnv(dict(use_render=False, log_level=50, num_scenarios=1, start_seed=0, traffic_density=0.0))
        env.reset()
        maps.append({"map": spec, "lanes": describe(env.current_map.road_network)})
        env.close()
    with open(path, "w", encoding="utf-8") as file:
        file.write('{"simulator": "MetaDrive 0.4.3", "samples": %s, "maps": [\n' % json.dumps(SAMPLES))
        file.write(",\n".join(json.dumps(entry, separators=(",", ":")) for entry in maps))
        file.write("\n]}\n")


if __name__ == "__main__":
    main(sys.argv[1])

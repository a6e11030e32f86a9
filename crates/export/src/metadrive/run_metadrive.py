"""Runs an exported scenario in plain MetaDrive 0.4.3, without recrash.

    pip install metadrive-simulator==0.4.3        (Python 3.8 to 3.11)
    python run_metadrive.py SCENARIO.metadrive.json            a window from above where there is a display
    python run_metadrive.py SCENARIO.metadrive.json --headless --trace states.json

The last line printed is JSON: how it ended, when, and the least distance between the boxes of ego and partners.
To test another system, replace `drive_ego`.
"""

import argparse
import json
import math
import os

from metadrive.component.map.pg_map import PGMap
from metadrive.component.pg_space import ConstantSpace, ParameterSpace
from metadrive.component.pgblock.curve import Curve
from metadrive.component.pgblock.first_block import FirstPGBlock
from metadrive.component.pgblock.roundabout import Roundabout
from metadrive.component.pgblock.std_intersection import StdInterSection
from metadrive.component.pgblock.std_t_intersection import StdTInterSection
from metadrive.component.pgblock.straight import Straight
from metadrive.component.static_object.traffic_object import TrafficBarrier, TrafficCone, TrafficWarning
from metadrive.component.vehicle.vehicle_type import StaticDefaultVehicle, vehicle_class_to_type, vehicle_type
from metadrive.engine.base_engine import BaseEngine
from metadrive.envs.metadrive_env import MetaDriveEnv
from metadrive.manager.pg_map_manager import PGMapManager
from metadrive.obs.observation_base import DummyObservation
from metadrive.policy.idm_policy import IDMPolicy
from shapely.geometry import Polygon

BLOCKS = {"S": Straight, "C": Curve, "X": StdInterSection, "T": StdTInterSection, "O": Roundabout}
OBSTACLES = {"cone": TrafficCone, "barrier": TrafficBarrier, "warning": TrafficWarning}
STEP_S = 0.1

# The engine would download pictures that nobody needs from above.
BaseEngine.try_pull_asset = staticmethod(lambda *arguments, **options: None)


def drive_ego(env, vehicle, policy):
    """[steering, throttle] of the ego, each -1 to 1, steering positive to the left. Here: MetaDrive's IDM policy."""
    return policy.act()


class EgoPolicy(IDMPolicy):
    """MetaDrive's IDM policy at the speed the scenario wants."""

    target_speed_mps = 0.0

    def __init__(self, vehicle, random_seed):
        super().__init__(vehicle, random_seed)
        self.NORMAL_SPEED = self.target_speed = 3.6 * type(self).target_speed_mps


class PartnerPolicy(IDMPolicy):
    """Steers along the partner's way with the IDM policy's gains; its speed follows the script."""

    def __init__(self, vehicle, spec, network):
        super().__init__(vehicle, 0)
        self.spec, self.script, self.enable_lane_change = spec, spec["policy"], False
        self.lanes = [network.get_lane(tuple(index)) for index in spec["way"]]
        self.segment = 0
        self.NORMAL_SPEED = self.target_speed = 3.6 * self.script.get("target_speed_mps", 0.0)

    def locate(self):
        """(s, t) on the lane of its way it is on."""
        s, t = self.lanes[self.segment].local_coordinates(self.control_object.position)
        while s > self.lanes[self.segment].length and self.segment + 1 < len(self.lanes):
            self.segment += 1
            s, t = self.lanes[self.segment].local_coordinates(self.control_object.position)
        return s, t

    def lateral_target(self, now):
        """Where it wants to be to the right of its lane, and how fast that moves."""
        offset = self.spec["t_m"]
        for move in self.spec["lateral"]:
            if now < move["start_s"]:
                break
            rate = (move["to_t_m"] - offset) / move["duration_s"]
            if now < move["start_s"] + move["duration_s"]:
                return offset + rate * (now - move["start_s"]), rate
            offset = move["to_t_m"]
        return offset, 0.0

    def decide(self, step, ego_gap_s):
        vehicle = self.control_object
        s, t = self.locate()
        wanted, rate = self.lateral_target(step * STEP_S)
        drift = max(-0.5, min(0.5, -rate / max(vehicle.speed, 1.0)))
        error = self.lanes[self.segment].heading_theta_at(s + 1) + drift - vehicle.heading_theta
        error = math.atan2(math.sin(error), math.cos(error))
        steering = self.heading_pid.get_result(-error) + self.lateral_pid.get_result(-(t - wanted))
        return [steering, self.throttle(step, ego_gap_s)]

    def throttle(self, step, ego_gap_s):
        script, kind, speed = self.script, self.script["type"], self.control_object.speed
        hold = lambda wanted: script.get("speed_kp", 0.3) * (wanted - speed)
        if kind in ("sudden_brake", "accel_then_brake"):
            if script["brake_step"] <= step < script["brake_step"] + script["brake_steps"]:
                return -1.0
            if step < script.get("accel_steps", 0):
                return script["accel_mag"]
            return hold(script["target_speed"] if kind == "sudden_brake" else script["cruise_speed"])
        if kind == "stopped":
            waits = script.get("depart_step") is None or step < script["depart_step"]
            return -1.0 if waits else hold(script["target_speed_mps"])
        if kind == "yielding":
            conflict = self.spec.get("conflict")
            if conflict and 0 < ego_gap_s < script["gap_s"]:
                driven = sum(lane.length for lane in self.lanes[: self.segment]) + self.locate()[0]
                left = conflict["partner_s_m"] - 6.0 - driven
                if left > 0:
                    return hold(min(script["target_speed_mps"], math.sqrt(6.0 * max(left - 0.5, 0.0))))
            return hold(script["target_speed_mps"])
        self.target_speed = self.NORMAL_SPEED
        return self.act()[1]


class ScenarioMap(PGMap):
    """The scenario's block behind its approach, every number fixed."""

    def _generate(self):
        spec = self._config["scenario"]
        parent, physics = self.engine.worldNP, self.engine.physics_world
        first = FirstPGBlock(
            self.road_network, spec["lane_width_m"], spec["lanes"], parent, physics,
            length=spec["approach_m"], ignore_intersection_checking=True,
        )
        kind = BLOCKS[spec["block"]]
        if spec["arm_m"] is not None:
            kind.EXIT_PART_LENGTH = spec["arm_m"]
        block = kind(1, first.get_socket(0), self.road_network, random_seed=1, ignore_intersection_checking=True)
        block.construct_block(parent, physics, extra_config=spec["parameters"])
        self.blocks = [first, block]
        self.road_network.after_init()


class ScenarioMapManager(PGMapManager):
    spec = None

    def reset(self):
        self.load_map(self.spawn_object(ScenarioMap, map_config={"scenario": self.spec}, random_seed=None))


class ScenarioEnv(MetaDriveEnv):
    def setup_engine(self):
        super().setup_engine()
        self.engine.update_manager("map_manager", ScenarioMapManager())


def vehicle_class(spec):
    """MetaDrive's car with another outline, tyres, engine and brakes (forces are per wheel, brakes per physics step)."""
    mass = StaticDefaultVehicle.MASS
    space = {
        "wheel_friction": spec["tyre_friction"],
        "max_engine_force": spec["max_acceleration_mps2"] * mass / 4.0,
        "max_brake_force": spec["brake_demand_mps2"] * mass * 0.02 / 4.0,
        "max_steering": spec["max_wheel_angle_deg"],
        "max_speed_km_h": 3.6 * spec["max_speed_mps"],
    }
    body = {
        "PARAMETER_SPACE": ParameterSpace({name: ConstantSpace(value) for name, value in space.items()}),
        "DEFAULT_LENGTH": spec["length_m"], "DEFAULT_WIDTH": spec["width_m"],
        "FRONT_WHEELBASE": spec["front_axle_m"], "REAR_WHEELBASE": spec["rear_axle_m"],
    }
    kind = type("Vehicle", (StaticDefaultVehicle,), body)
    vehicle_class_to_type[kind] = "static_default"
    return kind


def spawn_config(spec):
    return {
        "spawn_lane_index": tuple(spec["spawn_lane"]),
        "spawn_longitude": spec["spawn_s_m"],
        "spawn_lateral": 0.0,
        "spawn_velocity": [spec["speed_mps"], 0.0],
        "spawn_velocity_car_frame": True,
        "destination": spec["way"][-1][1],
    }


def outline(vehicle, spec):
    c, s = math.cos(vehicle.heading_theta), math.sin(vehicle.heading_theta)
    x, y = vehicle.position
    half = (0.5 * spec["length_m"], 0.5 * spec["width_m"])
    corners = [(half[0], half[1]), (-half[0], half[1]), (-half[0], -half[1]), (half[0], -half[1])]
    return Polygon([(x + a * c - b * s, y + a * s + b * c) for a, b in corners])


def run(scenario, window, trace):
    ScenarioMapManager.spec = scenario["map"]
    vehicle_type["static_default"] = vehicle_class(scenario["ego"])
    EgoPolicy.target_speed_mps = scenario["ego"]["target_speed_mps"]
    env = ScenarioEnv(
        {
            "use_render": False, "log_level": 50, "num_scenarios": 1, "start_seed": 0, "traffic_density": 0.0,
            "agent_observation": DummyObservation, "agent_policy": EgoPolicy, "force_destroy": True,
            "vehicle_config": {"vehicle_model": "static_default", "show_navi_mark": False},
            "random_spawn_lane_index": False, "out_of_road_done": False, "on_continuous_line_done": False,
            "crash_vehicle_done": False, "crash_object_done": False, "horizon": None,
        }
    )
    env.config["agent_configs"]["default_agent"].update(spawn_config(scenario["ego"]))
    env.reset(seed=0)
    engine, network, ego = env.engine, env.engine.current_map.road_network, env.agent
    specs, vehicles, policies = [scenario["ego"]], [ego], [engine.get_policy(ego.name)]
    for spec in scenario["partners"]:
        config = spawn_config(spec)
        vehicle = engine.spawn_object(vehicle_class(spec), vehicle_config=config, random_seed=0)
        if spec["t_m"]:
            vehicle.set_position(network.get_lane(tuple(spec["spawn_lane"])).position(spec["spawn_s_m"], spec["t_m"]))
        specs.append(spec)
        vehicles.append(vehicle)
        policies.append(PartnerPolicy(vehicle, spec, network))
    for obstacle in scenario["obstacles"]:
        engine.spawn_object(
            OBSTACLES[obstacle["kind"]], lane=network.get_lane(tuple(obstacle["lane"])), static=True,
            position=[obstacle["x_m"], obstacle["y_m"]], heading_theta=obstacle["heading_rad"],
        )
    for vehicle in vehicles:
        vehicle.after_step()

    states, least, end, step = [], (math.inf, None), "timeout", 0
    ego_lanes = [network.get_lane(tuple(index)) for index in scenario["ego"]["way"]]
    while True:
        states.append([[float(v.position[0]), float(v.position[1]), float(v.heading_theta), float(v.speed)] for v in vehicles])
        ego_box = outline(ego, specs[0])
        for vehicle, spec in zip(vehicles[1:], specs[1:]):
            gap = ego_box.distance(outline(vehicle, spec))
            if gap < least[0]:
                least = (gap, step * STEP_S)
        if least[0] == 0.0:
            end = "contact"
        elif env._is_arrive_destination(ego):
            end = "arrived"
        elif not ego.on_lane:
            end = "off_road"
        if end != "timeout" or step >= scenario["max_steps"]:
            break
        actions = [drive_ego(env, ego, policies[0])]
        for policy, spec in zip(policies[1:], specs[1:]):
            actions.append(policy.decide(step, ego_time_to(spec.get("conflict"), ego, ego_lanes)))
        for vehicle, action in zip(vehicles, actions):
            vehicle.before_step([max(-1.0, min(1.0, float(part))) for part in action])
        for _ in range(5):  # of 0.02 s
            engine.step_physics_world()
        for vehicle in vehicles:
            vehicle.after_step()
        step += 1
        if window:
            env.render(mode="topdown", window=True, screen_size=(900, 700))
    env.close()
    if trace:
        with open(trace, "w", encoding="utf-8") as file:
            json.dump({"step_s": STEP_S, "columns": ["x_m", "y_m", "heading_rad", "speed_mps"],
                       "actors": ["ego"] + [spec["id"] for spec in specs[1:]], "states": states}, file)
    gap, when = least
    return {"scenario": scenario["id"], "end": end, "time_s": round(step * STEP_S, 1),
            "min_gap_m": None if math.isinf(gap) else round(gap, 3), "min_gap_time_s": when and round(when, 1)}


def ego_time_to(conflict, ego, lanes):
    """Seconds until the ego is where the ways meet; infinite behind it."""
    if not conflict:
        return math.inf
    driven = 0.0
    for lane in lanes:
        s, t = lane.local_coordinates(ego.position)
        if 0 <= s <= lane.length and abs(t) < lane.width:
            left = conflict["ego_s_m"] - driven - s
            return left / max(ego.speed, 1.0) if left > 0 else math.inf
        driven += lane.length
    return math.inf


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario", help="an exported *.metadrive.json")
    parser.add_argument("--headless", action="store_true", help="no window even where there is a display")
    parser.add_argument("--trace", help="write every state to this JSON file")
    arguments = parser.parse_args()
    with open(arguments.scenario, encoding="utf-8") as source:
        content = json.load(source)
    display = os.name == "nt" or "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
    print(json.dumps(run(content, display and not arguments.headless, arguments.trace)))

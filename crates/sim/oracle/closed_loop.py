"""Runs resolved scenarios closed loop in MetaDrive and writes what happened, one JSON line each.

What the native simulator is held against (docs/models/metadrive-idm.md). Needs Python 3.11 and
`pip install metadrive-simulator==0.4.3`; no assets, no GPU. The input comes from

    cargo run -p recrash-sim --example resolve -- SCENARIO.json... > specs.jsonl
    PYTHONHASHSEED=0 python closed_loop.py < specs.jsonl > metadrive.jsonl
    PYTHONHASHSEED=0 python closed_loop.py --fixture < specs.jsonl > ../tests/fixtures/closed_loop.jsonl

With --fixture each line holds the scenario and one position a second, no more.

The native driver's deliberate differences are made here too: MetaDrive's random overtaking timer starts in the middle
of its range, and partners follow the lane number they start in (docs/models/policies.md).
"""

import json
import math
import sys

from metadrive.component.map.pg_map import PGMap
from metadrive.component.pgblock.curve import Curve
from metadrive.component.pgblock.first_block import FirstPGBlock
from metadrive.component.pgblock.intersection import InterSection
from metadrive.component.pgblock.roundabout import Roundabout
from metadrive.component.pgblock.std_intersection import StdInterSection
from metadrive.component.pgblock.std_t_intersection import StdTInterSection
from metadrive.component.pgblock.straight import Straight
from metadrive.component.road_network.node_road_network import NodeRoadNetwork
from metadrive.component.static_object.traffic_object import TrafficBarrier, TrafficCone, TrafficWarning
from metadrive.component.vehicle.vehicle_type import StaticDefaultVehicle
from metadrive.engine.base_engine import BaseEngine
from metadrive.envs.metadrive_env import MetaDriveEnv
from metadrive.manager.pg_map_manager import PGMapManager
from metadrive.obs.observation_base import DummyObservation
from metadrive.policy.idm_policy import IDMPolicy
from panda3d.core import LVector3
from shapely.geometry import Polygon

BaseEngine.try_pull_asset = staticmethod(lambda *a, **k: None)

# MetaDrive routes by the shortest way, which is not always the scenario's (a partner that goes round the ring).
NodeRoadNetwork.shortest_path = lambda self, start, goal: list(World.route)

OBSTACLES = dict(cone=TrafficCone, barrier=TrafficBarrier, warning=TrafficWarning)
SPAWNED = []
MISSING_ARM = dict(right=0, ahead=1, left=2)


class FixedMap(PGMap):
    """One block behind the approach, with the numbers of a scenario."""

    def _generate(self):
        spec = self._config["spec"]
        world, physics = self.engine.worldNP, self.engine.physics_world
        letter = spec["type"]
        first = FirstPGBlock(
            self.road_network,
            lane_width=spec["lane_width_m"],
            lane_num=spec["lanes"],
            render_root_np=world,
            physics_world=physics,
            length=spec["approach_m"],
            ignore_intersection_checking=True,
        )
        blocks = dict(S=Straight, C=Curve, X=StdInterSection, T=StdTInterSection, O=Roundabout)
        extra = {}
        if letter == "S":
            extra = dict(length=spec["length_m"])
        elif letter == "C":
            extra = dict(
                length=spec["length_m"],
                radius=spec["radius_m"],
                angle=spec["angle_deg"],
                dir=0 if spec["direction"] == "left" else 1,
            )
        elif letter == "T":
            extra = dict(t_type=MISSING_ARM[spec["missing"]])
        elif letter == "O":
            extra = dict(exit_radius=spec["exit_radius_m"], inner_radius=spec["inner_radius_m"])
        # The length of the arms is an attribute of the class.
        kept = InterSection.EXIT_PART_LENGTH, Roundabout.EXIT_PART_LENGTH
        InterSection.EXIT_PART_LENGTH = Roundabout.EXIT_PART_LENGTH = spec.get("arm_m", 35)
        block = blocks[letter](
            1, first.get_socket(0), self.road_network, random_seed=1, ignore_intersection_checking=True
        )
        block.construct_block(world, physics, extra_config=extra)
        InterSection.EXIT_PART_LENGTH, Roundabout.EXIT_PART_LENGTH = kept
        self.blocks = [first, block]
        self.road_network.after_init()


class FixedMapManager(PGMapManager):
    """Keeps the maps it has built."""

    spec = None
    built = {}

    def reset(self):
        key = json.dumps(self.spec, sort_keys=True)
        if key not in self.built:
            self.built[key] = self.spawn_object(FixedMap, map_config=dict(spec=self.spec), random_seed=None)
        self.load_map(self.built[key])


class World(MetaDriveEnv):
    route = []

    def setup_engine(self):
        super().setup_engine()
        self.engine.update_manager("map_manager", FixedMapManager())


class Middle:
    """In place of the random numbers: the middle of the range."""

    def randint(self, low, high):
        return (low + high) // 2


class Ego(IDMPolicy):
    target = 30.0

    def __init__(self, vehicle, seed):
        super().__init__(vehicle, seed)
        self.NORMAL_SPEED = self.target_speed = Ego.target
        self.overtake_timer = 25
        self.np_random = Middle()


class Partner(IDMPolicy):
    def __init__(self, vehicle, seed, spec):
        super().__init__(vehicle, seed)
        self.spec = spec
        self.step = 0
        nodes, number = spec["route"], spec["lane"][2]
        network = vehicle.navigation.map.road_network
        self.path = [network.get_lane((a, b, number)) for a, b in zip(nodes, nodes[1:])]
        self.NORMAL_SPEED = self.target_speed = 3.6 * spec["policy"].get("target_speed_mps", 8.0)
        self.enable_lane_change = False

    def lateral_target(self):
        time, start = 0.1 * self.step, self.spec["t_m"]
        moves = self.spec.get("lateral", [])
        for position, move in enumerate(moves):
            if time < move["start_s"]:
                return start, 0.0
            rate = (move["to_t_m"] - start) / max(move["duration_s"], 1e-3)
            following = moves[position + 1]["start_s"] if position + 1 < len(moves) else math.inf
            until = min(following, move["start_s"] + move["duration_s"])
            if time < until:
                return start + rate * (time - move["start_s"]), rate
            start += rate * max(until - move["start_s"], 0.0)
        return start, 0.0

    def act(self, *args, **kwargs):
        vehicle, policy = self.control_object, self.spec["policy"]
        if policy["type"] == "stopped" and self.step < (policy.get("depart_step") or math.inf):
            self.step += 1
            return [0.0, -1.0 if vehicle.speed > 0.5 else -0.1]
        s, t = self.path[0].local_coordinates(vehicle.position)
        while s > self.path[0].length and len(self.path) > 1:
            del self.path[0]
            s, t = self.path[0].local_coordinates(vehicle.position)
        lane = self.path[0]
        target, rate = self.lateral_target()
        drift = math.asin(max(-1.0, min(1.0, -rate / max(vehicle.speed, 1.0))))
        drift = max(-0.5, min(0.5, drift))
        error = lane.heading_theta_at(s + 1) + drift - vehicle.heading_theta
        error = (error + math.pi) % (2 * math.pi) - math.pi
        steer = self.heading_pid.get_result(-error) + self.lateral_pid.get_result(-(t - target))
        throttle = self.throttle(policy, vehicle, lane)
        self.step += 1
        return [steer, throttle]

    def throttle(self, policy, vehicle, lane):
        kind, speed = policy["type"], vehicle.speed
        gain = policy.get("speed_kp") or 0.3
        if kind in ("sudden_brake", "accel_then_brake"):
            if policy["brake_step"] <= self.step < policy["brake_step"] + policy["brake_steps"]:
                return -1.0 if speed > 0.5 else -0.1
            if kind == "accel_then_brake" and self.step < policy["accel_steps"]:
                return policy["accel_mag"]
            wanted = policy["target_speed"] if kind == "sudden_brake" else policy["cruise_speed"]
            return gain * (wanted - speed)
        if kind == "stopped":
            return 0.3 * (policy["target_speed_mps"] - speed)
        # idm_nominal: MetaDrive's gap law on the lane it is on.
        from metadrive.policy.idm_policy import FrontBackObjects

        self.target_speed = self.NORMAL_SPEED
        objects = vehicle.lidar.get_surrounding_objects(vehicle)
        try:
            around = FrontBackObjects.get_find_front_back_objs(objects, vehicle.lane, vehicle.position, 30)
            return self.acceleration(around.front_object(), around.front_min_distance())
        except AttributeError:
            return self.acceleration(None, 5)


def make_world():
    return World(
        dict(
            use_render=False,
            log_level=50,
            num_scenarios=1,
            start_seed=0,
            traffic_density=0.0,
            agent_observation=DummyObservation,
            agent_policy=Ego,
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


def placed(spec):
    World.route = spec["route"]
    return dict(
        spawn_lane_index=tuple(spec["lane"]),
        spawn_longitude=spec["s_m"],
        spawn_lateral=spec["t_m"],
        spawn_velocity=[spec["speed_mps"], 0.0],
        spawn_velocity_car_frame=True,
        destination=spec["destination"],
    )


def outline(vehicle):
    (x, y), h = vehicle.position, vehicle.heading_theta
    c, s = math.cos(h), math.sin(h)
    a, b = 4.515 / 2, 1.852 / 2
    return Polygon([(x + u * c - v * s, y + u * s + v * c) for u, v in ((a, b), (-a, b), (-a, -b), (a, -b))])


def run(env, spec):
    FixedMapManager.spec = spec["map"]
    Ego.target = 3.6 * spec["ego"]["target_speed_mps"]
    env.config["agent_configs"]["default_agent"].update(placed(spec["ego"]))
    env.reset(seed=0)
    engine = env.engine
    ego = env.agent
    network = engine.current_map.road_network
    actors = [(ego, engine.get_policy(ego.name))]
    for partner in spec["partners"]:
        vehicle = engine.spawn_object(
            StaticDefaultVehicle,
            vehicle_config=dict(placed(partner), enable_reverse=False),
            random_seed=0,
            auto_fill_random_seed=False,
        )
        SPAWNED.append(vehicle.id)
        actors.append((vehicle, Partner(vehicle, 0, partner)))
        vehicle.after_step()
    things = []
    for obstacle in spec["obstacles"]:
        lane = network.get_lane(tuple(obstacle["lane"]))
        thing = engine.spawn_object(
            OBSTACLES[obstacle["kind"]],
            lane=lane,
            position=[obstacle["x"], obstacle["y"]],
            heading_theta=obstacle["heading"],
            static=True,
        )
        SPAWNED.append(thing.id)
        things.append(thing)
    for (vehicle, _), wanted in zip(actors, [spec["ego"]] + spec["partners"]):
        assert vehicle.navigation.checkpoints[-1] == wanted["destination"], vehicle.navigation.checkpoints
        assert tuple(vehicle.lane_index) == tuple(wanted["lane"]), (vehicle.lane_index, wanted["lane"])
    tracks = [[] for _ in actors]
    end, gap, halted, step = None, (math.inf, 0.0), set(), 0
    while True:
        boxes = [outline(vehicle) for vehicle, _ in actors]
        for box in boxes[1:]:
            distance = boxes[0].distance(box)
            if distance < gap[0]:
                gap = (distance, 0.1 * step)
        actions = []
        if step and ego.crash_vehicle:
            end = "contact"
        elif env._is_arrive_destination(ego):
            end = "arrived"
        elif not ego.on_lane:
            end = "off_road"
        elif step >= spec["max_steps"]:
            end = "timeout"
        for number, (vehicle, policy) in enumerate(actors):
            if number and vehicle.crash_vehicle:
                halted.add(number)
            action = [0.0, 0.0] if end else policy.act()
            if number in halted:
                action = [action[0], -1.0 if vehicle.speed > 0.5 else -0.1]
            actions.append([max(-1.0, min(1.0, a)) for a in action])
        for track, (vehicle, _), action in zip(tracks, actors, actions):
            x, y = vehicle.position
            track.append([round(v, 5) for v in (x, y, vehicle.heading_theta, vehicle.speed, *action)])
        if end:
            break
        for (vehicle, _), action in zip(actors, actions):
            vehicle.before_step(action)
        for _ in range(5):
            engine.step_physics_world()
        for thing in things:
            # A fixed obstacle that was hit keeps its place but gets a velocity, which the IDM would believe.
            thing.body.setLinearVelocity(LVector3(0, 0, 0))
        for vehicle, _ in actors:
            vehicle.after_step()
        step += 1
    return dict(
        id=spec["id"], end=end, time_s=round(0.1 * step, 1), min_gap_m=round(gap[0], 4), min_gap_time_s=round(gap[1], 1),
        object_contact=bool(ego.crash_object), tracks=tracks,
    )


def main():
    env = make_world()
    for line in sys.stdin:
        spec = json.loads(line)
        try:
            result = run(env, spec)
        except Exception as error:  # one bad scenario must not end the comparison
            result = dict(id=spec["id"], end="error", error=f"{type(error).__name__}: {error}")
        env.engine.clear_objects(SPAWNED, force_destroy=True)
        SPAWNED.clear()
        if "--fixture" in sys.argv:
            if result["end"] == "error":
                continue
            positions = [[[round(v, 2) for v in pose[:2]] for pose in track[::10]] for track in result.pop("tracks")]
            result = dict(draft=spec["draft"], **result, positions=positions)
        print(json.dumps(result), flush=True)
    env.close()


if __name__ == "__main__":
    main()

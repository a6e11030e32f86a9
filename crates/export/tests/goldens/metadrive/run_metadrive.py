"""Runs a recrash scenario in plain MetaDrive 0.4.3, without recrash.

    pip install metadrive-simulator==0.4.3        (Python 3.8 to 3.11)
    python run_metadrive.py SCENARIO.metadrive.json            a window from above where there is a display
    python run_metadrive.py SCENARIO.metadrive.json --headless --trace states.json

The last line printed is JSON: how it ended, when, and the least gap between the boxes of the ego and the partners.
To test another system, replace `drive_ego`.

recrash itself runs this same file as a worker, with `--worker`: it reads one JSON request a line from stdin and answers
with one JSON line each. The first line that it writes then is

    {"hello": {"python": "3.11.7", "metadrive": "0.4.3", "problem": null}}

and for every {"id": 1, "run": {...}} either {"id": 1, "done": {...}} or {"id": 1, "error": "..."}. What a run holds is
written down in crates/plan/src/metadrive. It brings every number with it: places, sizes, what each partner plans, and
the constants that give plans their meaning; docs/models/policies.md says what they mean, metadrive-backend.md how the
world is set up.
"""

import argparse
import json
import math
import os
import sys
from collections import OrderedDict

WANTED = "0.4.3"
SUBSTEPS = 5
WORKER = "--worker" in sys.argv[1:]

if WORKER:
    # Libraries may print what they like: the real stdout is ours alone, theirs goes to stderr.
    ANSWERS = os.fdopen(os.dup(1), "w", encoding="utf-8", newline="\n")
    os.dup2(2, 1)


def drive_ego(world, policy):
    """[steering, throttle] of the ego, each -1 to 1, steering positive to the left. Here: MetaDrive's IDM policy.

    `world.actors` holds everybody, the ego first; `world.env` is the MetaDrive environment.
    """
    return policy.act()


def send(message):
    ANSWERS.write(json.dumps(message, allow_nan=False, separators=(",", ":")) + "\n")
    ANSWERS.flush()


def hello(metadrive=None, kind=None, detail=""):
    problem = None if kind is None else {"kind": kind, "detail": detail[:500]}
    python = ".".join(str(part) for part in sys.version_info[:3])
    send({"hello": {"python": python, "metadrive": metadrive, "problem": problem}})


def installed_version():
    try:
        from importlib import metadata
    except ImportError:  # Python 3.7 and older
        return None
    for name in ("metadrive-simulator", "metadrive_simulator", "metadrive"):
        try:
            return metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return None


def give_up(kind, detail="", version=None):
    """Tells in one line why it cannot run."""
    if not WORKER:
        sys.exit("%s: %s; pip install metadrive-simulator==%s" % (kind, detail or version, WANTED))
    hello(version, kind, detail)
    sys.exit(0)


class Colours:
    """Stands in for seaborn, of which MetaDrive takes ten colours and nothing else: loading it, with pandas and statistics,
    takes longer than all that is done here until the first step."""

    @staticmethod
    def color_palette(_):
        codes = "0173b2 de8f05 029e73 d55e00 cc78bc ca9161 fbafe4 949494 ece133 56b4e9".split()
        return [tuple(part / 255 for part in bytes.fromhex(code)) for code in codes]


sys.modules.setdefault("seaborn", Colours)

VERSION = installed_version()
if VERSION is None:
    give_up("metadrive_missing")
if VERSION != WANTED:
    give_up("metadrive_version", VERSION, VERSION)
try:
    import numpy as np
    from metadrive.component.block.base_block import BaseBlock
    from metadrive.component.lane.circular_lane import CircularLane
    from metadrive.component.lane.straight_lane import StraightLane
    from metadrive.component.map.pg_map import PGMap
    from metadrive.component.pg_space import ConstantSpace, ParameterSpace
    from metadrive.component.pgblock.curve import Curve
    from metadrive.component.pgblock.first_block import FirstPGBlock
    from metadrive.component.pgblock.pg_block import PGBlock
    from metadrive.component.pgblock.roundabout import Roundabout
    from metadrive.component.pgblock.std_intersection import StdInterSection
    from metadrive.component.pgblock.std_t_intersection import StdTInterSection
    from metadrive.component.pgblock.straight import Straight
    from metadrive.component.road_network.node_road_network import NodeRoadNetwork
    from metadrive.component.static_object.traffic_object import (
        TrafficBarrier,
        TrafficCone,
        TrafficObject,
        TrafficWarning,
    )
    from metadrive.component.vehicle.vehicle_type import StaticDefaultVehicle, vehicle_class_to_type, vehicle_type
    from metadrive.constants import PGLineType
    from metadrive.engine.base_engine import BaseEngine
    from metadrive.engine.physics_node import BaseRigidBodyNode
    from metadrive.envs.metadrive_env import MetaDriveEnv
    from metadrive.manager.pg_map_manager import PGMapManager
    from metadrive.obs.observation_base import DummyObservation
    from metadrive.policy.idm_policy import FrontBackObjects, IDMPolicy
    from panda3d.bullet import BulletBoxShape
    from panda3d.core import LVector3, Vec3
except Exception as error:  # whatever it is, it is told in one line
    give_up("import_failed", "%s: %s" % (type(error).__name__, error), VERSION)

# Pictures only; without it the engine would download its assets.
BaseEngine.try_pull_asset = staticmethod(lambda *arguments, **options: None)


class Route:
    """The nodes of whoever is placed next: MetaDrive would take the shortest way, which may not be the scenario's."""

    nodes = []


NodeRoadNetwork.shortest_path = lambda self, start, goal: list(Route.nodes)

BLOCKS = {"S": Straight, "C": Curve, "X": StdInterSection, "T": StdTInterSection, "O": Roundabout}
# The node at which the entrance of the ego's road begins.
ENTRANCE = FirstPGBlock.NODE_1
MISSING_ARM = {"right": 0, "ahead": 1, "left": 2}
OBSTACLES = {"cone": TrafficCone, "barrier": TrafficBarrier, "warning": TrafficWarning}


def block_parameters(spec):
    kind = spec["type"]
    if kind == "S":
        return {"length": spec["length_m"]}
    if kind == "C":
        turn = 0 if spec["direction"] == "left" else 1
        return {"length": spec["length_m"], "radius": spec["radius_m"], "angle": spec["angle_deg"], "dir": turn}
    if kind == "T":
        return {"t_type": MISSING_ARM[spec["missing"]], "change_lane_num": 0, "decrease_increase": 0}
    if kind == "O":
        return {"exit_radius": spec["exit_radius_m"], "inner_radius": spec["inner_radius_m"], "angle": 60}
    return {"change_lane_num": 0, "decrease_increase": 0}


class ScenarioMap(PGMap):
    """One block behind the approach, every number fixed; or all lanes of a network of roads."""

    def _generate(self):
        spec = self._config["scenario"]
        parent, physics = self.engine.worldNP, self.engine.physics_world
        if spec["type"] == "G":
            self.blocks = [LaneBlock(self._config["lanes"], self.road_network)]
            self.blocks[0].construct_block(parent, physics)
            self.road_network.after_init()
            return
        size = (self.road_network, spec["lane_width_m"], spec["lanes"], parent, physics)
        first = FirstPGBlock(*size, length=spec["approach_m"], ignore_intersection_checking=True)
        kind = BLOCKS[spec["type"]]
        if "arm_m" in spec:
            # The length of the arms is an attribute of the class.
            kind.EXIT_PART_LENGTH = spec["arm_m"]
        block = kind(1, first.get_socket(0), self.road_network, random_seed=1, ignore_intersection_checking=True)
        block.construct_block(parent, physics, extra_config=block_parameters(spec))
        self.blocks = [first, block]
        self.road_network.after_init()


class ScenarioMapManager(PGMapManager):
    """Keeps the maps it has built."""

    spec, lanes = None, []
    built = {}

    def reset(self):
        key = json.dumps([self.spec, self.lanes], sort_keys=True)
        if key not in self.built:
            self.built[key] = self.spawn_object(ScenarioMap, map_config={"scenario": self.spec, "lanes": self.lanes}, random_seed=None)
            self.current_map = self.built[key]
        else:
            self.load_map(self.built[key])


class ScenarioEnv(MetaDriveEnv):
    def setup_engine(self):
        super().setup_engine()
        self.engine.update_manager("map_manager", ScenarioMapManager())


class MiddleOfTheRange:
    """In place of random numbers, so that a run depends on nothing but its scenario."""

    @staticmethod
    def randint(low, high):
        return (low + high) // 2


class Law:
    """The constants of recrash's crates/plan, each by its name there; set by every run."""

    step_s = 0.1


def hold_still(speed):
    """Throttle that brakes to a stand and holds it."""
    return -1.0 if speed > Law.hold_below_mps else Law.hold_brake


def wrap(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


class FreePolicy(IDMPolicy):
    """MetaDrive's IDM policy at the speed somebody wants: the ego's and that of background traffic."""

    target_mps, timer_steps, beside = 30.0 / 3.6, 25, 0.0

    def __init__(self, vehicle, random_seed):
        super().__init__(vehicle, random_seed)
        self.NORMAL_SPEED = self.target_speed = 3.6 * type(self).target_mps
        self.overtake_timer = type(self).timer_steps
        self.np_random = MiddleOfTheRange()

    def decide(self, world, me):
        actor, errand = world.actors[me], world.errand if me == 0 else None
        halt = errand and errand.nearest(world.step * Law.step_s, actor.place.path_s, actor.vehicle.speed)
        self.beside = errand.beside(actor.place.path_s) if errand else 0.0
        steering, throttle = drive_ego(world, self) if me == 0 else self.act()
        if actor.halted:
            throttle = hold_still(actor.vehicle.speed)
        if halt is not None:
            throttle = errand.before(throttle, halt, actor.vehicle.speed, actor.brake_mps2)
        return [steering, throttle]

    def steering_control(self, target_lane):
        if self.beside == 0.0:
            return super().steering_control(target_lane)
        s, t = target_lane.local_coordinates(self.control_object.position)
        off = wrap(target_lane.heading_theta_at(s + 1) - self.control_object.heading_theta)
        return float(self.heading_pid.get_result(-off) + self.lateral_pid.get_result(self.beside - t))

    def has_plans(self, step):
        return False


class ExpertPolicy(FreePolicy):
    """The PPO expert that MetaDrive ships: the mean of its network over its own lasers and navigation. It knows no target speed."""

    def act(self):
        from metadrive.examples.ppo_expert.numpy_expert import expert

        return expert(self.control_object, deterministic=True)


class TrafficPolicy(FreePolicy):
    """Stands until the ego has left the entrance of its road."""

    def decide(self, world, me):
        return super().decide(world, me) if world.released else [0.0, 0.0]


class Place:
    """Where an actor is on the lanes of its way; it never goes back."""

    def __init__(self, network, spec):
        self.lanes = [network.get_lane((start, end, number)) for start, end, number in spec["way"]]
        self.starts = [spec["begins_m"]]
        for lane in self.lanes:
            self.starts.append(self.starts[-1] + lane.length)
        self.ends = [lane.length for lane in self.lanes]
        if "way_m" in spec:
            # A way that changes lanes takes parts of them.
            self.starts = [start - first for start, first, _ in spec["way_m"]]
            self.ends = [last for _, _, last in spec["way_m"]]
        self.segment = 0

    def update(self, position):
        s, t = self.lanes[self.segment].local_coordinates(position)
        while s > self.ends[self.segment] and self.segment + 1 < len(self.lanes):
            self.segment += 1
            s, t = self.lanes[self.segment].local_coordinates(position)
        self.s, self.t = s, t
        self.path_s = self.starts[self.segment] + s

    def way_at(self, path_s):
        """Heading and curvature (positive to the left) at a place not behind the lane it is on."""
        segment = self.segment
        while segment + 1 < len(self.lanes) and self.starts[segment + 1] <= path_s:
            segment += 1
        lane, s = self.lanes[segment], path_s - self.starts[segment]
        if s > lane.length:
            return lane.heading_theta_at(lane.length), 0.0
        radius = getattr(lane, "radius", None)
        return lane.heading_theta_at(s), lane.direction / radius if radius else 0.0


class OpenLoopPolicy:
    """Given controls, one pair a step; none behind their end."""

    def __init__(self, controls):
        self.controls = controls

    def decide(self, world, me):
        return self.controls[world.step] if world.step < len(self.controls) else [0.0, 0.0]


class Actor:
    def __init__(self, vehicle, policy, place, spec):
        self.vehicle, self.policy, self.place = vehicle, policy, place
        self.radius = 0.5 * math.hypot(spec["body"]["length_m"], spec["body"]["width_m"])
        self.halted, self.parts, self.brake_mps2 = False, [], spec["body"]["brake_mps2"]
        # Background traffic that has driven off the map: its last state, going straight on.
        self.gone = None

    @property
    def away(self):
        return self.gone is not None

    def carry(self, now):
        """Puts it where its recorded driver was."""
        x, y, heading, vx, vy = now
        self.vehicle.set_position((x, y))
        self.vehicle.set_heading_theta(heading)
        self.vehicle.set_velocity([vx, vy])

    def let_go(self, now, turning):
        """Puts it on its wheels where its recorded driver leaves it: its springs carry it, and its body is a physics step
        ahead of what one sees, as that of any vehicle that drives."""
        x, y, heading, vx, vy = now
        ahead = Law.step_s / SUBSTEPS
        self.vehicle.set_position((x + vx * ahead, y + vy * ahead), Law.settled_height_m)
        self.vehicle.set_heading_theta(heading + turning * ahead)
        self.vehicle.body.setLinearVelocity(LVector3(vx, vy, 0.0))
        self.vehicle.set_angular_velocity(turning)

    def state(self):
        """Position, heading and velocity."""
        if self.gone is not None:
            return self.gone
        x, y = self.vehicle.position
        heading = math.atan2(math.sin(self.vehicle.heading_theta), math.cos(self.vehicle.heading_theta))
        vx, vy = self.vehicle.velocity
        return [float(x), float(y), float(heading), float(vx), float(vy)]

    def go_on(self):
        x, y, heading, vx, vy = self.gone
        self.gone = [x + vx * Law.step_s, y + vy * Law.step_s, heading, vx, vy]


CLASSES = {}


def vehicle_class(body):
    """StaticDefaultVehicle with another body, tyres, engine and brakes."""
    key = json.dumps(body, sort_keys=True)
    if key not in CLASSES:
        # Per wheel: force over mass, and brake impulse over mass and physics step (measured, METADRIVE 3.4).
        mass = StaticDefaultVehicle.MASS
        space = {
            "wheel_friction": body["friction"],
            "max_engine_force": body["acceleration_mps2"] * mass / 4.0,
            "max_brake_force": body["brake_mps2"] * mass * 0.02 / 4.0,
            "max_steering": math.degrees(body["wheel_angle_rad"]),
            "max_speed_km_h": 3.6 * body["speed_mps"],
        }
        fields = {
            "PARAMETER_SPACE": ParameterSpace({name: ConstantSpace(value) for name, value in space.items()}),
            "DEFAULT_LENGTH": body["length_m"],
            "DEFAULT_WIDTH": body["width_m"],
            "FRONT_WHEELBASE": body["front_axle_m"],
            "REAR_WHEELBASE": body["rear_axle_m"],
            "LATERAL_TIRE_TO_CENTER": body["half_track_m"],
        }
        CLASSES[key] = type("Vehicle%d" % len(CLASSES), (StaticDefaultVehicle,), fields)
        vehicle_class_to_type[CLASSES[key]] = "static_default"
    return CLASSES[key]


def adjust_inertia(vehicle, body):
    """A body shorter than its chassis keeps the chassis's inertia, or it would tumble."""
    if body["length_m"] == body["chassis_length_m"]:
        return
    length, width, height = body["chassis_length_m"], body["chassis_width_m"], vehicle.HEIGHT
    share = vehicle.MASS / 12.0
    # Panda's vehicles face along y.
    about = (length**2 + height**2, width**2 + height**2, length**2 + width**2)
    vehicle.body.setInertia(Vec3(*(share * each for each in about)))


def nodes_of(spec):
    nodes = list(spec["way"][0][:1])
    for _, end, _ in spec["way"]:
        # A way that changes lanes names its road more than once.
        nodes += [end] if end != nodes[-1] else []
    return nodes


def spawn_config(spec):
    start, end, number = spec["way"][0]
    Route.nodes = nodes_of(spec)
    return {
        "spawn_lane_index": (start, end, number),
        "spawn_longitude": spec["s_m"],
        # Far from its lane's centre MetaDrive would take it for a vehicle of another road; it is moved there later.
        **{"spawn_lateral": 0.0, "spawn_velocity": [spec["speed_mps"], 0.0], "spawn_velocity_car_frame": True},
        "destination": spec["way"][-1][1],
    }


def make_env():
    # Recycled bodies keep the state of their solver: only new ones (force_destroy) give the same bits again.
    ended_by_nothing = ("out_of_road_done", "on_continuous_line_done", "crash_vehicle_done", "crash_object_done")
    config = dict.fromkeys(ended_by_nothing, False)
    config.update(use_render=False, log_level=50, num_scenarios=1, start_seed=0, traffic_density=0.0, horizon=None)
    config.update(agent_observation=DummyObservation, agent_policy=FreePolicy, force_destroy=True)
    config.update(random_spawn_lane_index=False, show_sidewalk=False, show_crosswalk=False)
    config["vehicle_config"] = {"vehicle_model": "static_default", "show_navi_mark": False}
    return ScenarioEnv(config)


class World:
    """One scenario in the engine."""

    def __init__(self, env, spec):
        self.env, self.spec, self.step = env, spec, 0
        self.engine = env.engine
        self.spawned = []
        self.events = []
        self.released = False
        self.scene = spec.get("scene")
        self.errand = Errand(self.scene) if self.scene else None
        self.attached = []

    def set_up(self):
        env, spec = self.env, self.spec
        for name, value in spec["constants"].items():
            setattr(Law, name, value)
        ScenarioMapManager.spec = spec["map"]
        ScenarioMapManager.lanes = self.scene["lanes"] if self.scene else []
        ego = spec["ego"]
        FreePolicy.target_mps, FreePolicy.timer_steps = ego["target_speed_mps"], ego["overtake_timer_steps"]
        vehicle_type["static_default"] = vehicle_class(ego["body"])
        env.config["agent_configs"]["default_agent"].update(spawn_config(ego))
        env.reset(seed=0)
        self.engine = env.engine
        self.network = self.engine.current_map.road_network
        driver = self.engine.get_policy(env.agent.name)
        if ego.get("controls") is not None:
            driver = OpenLoopPolicy(ego["controls"])
        elif ego.get("policy") == "expert":
            driver = ExpertPolicy(env.agent, 0)
        self.actors = [self.introduce(env.agent, driver, ego)]
        for partner in spec["partners"]:
            vehicle = self.spawn(partner)
            self.actors.append(self.introduce(vehicle, PartnerPolicy(vehicle, partner), partner))
        if self.scene:
            self.actors += [PlannedActor(self, planned) for planned in self.scene["planned"]]
        self.first_traffic = len(self.actors)
        for other in spec["traffic"]:
            vehicle = self.spawn(other)
            TrafficPolicy.target_mps = other["target_speed_mps"]
            TrafficPolicy.timer_steps = other["overtake_timer_steps"]
            self.actors.append(self.introduce(vehicle, TrafficPolicy(vehicle, 0), other))
        if self.scene:
            if self.scene["recorded"] is not None:
                # Where its record begins, whoever drives then.
                self.actors[0].carry(self.scene["recorded"]["states"][0])
                env.agent.after_step()
                self.actors[0].place.update(env.agent.position)
            self.attached = [Attached(self, part) for part in self.scene["parts"]]
            self.carry(0.0)
        self.obstacles = []
        for obstacle in spec["obstacles"]:
            place = {"position": [obstacle["x"], obstacle["y"]], "heading_theta": obstacle["heading"]}
            place["lane"] = self.lane(obstacle["lane"])
            if obstacle["kind"] in OBSTACLES and not self.scene:
                thing = self.engine.spawn_object(OBSTACLES[obstacle["kind"]], static=True, **place)
                self.spawned.append(thing.id)
            else:
                thing = self.box(obstacle, **place)
            self.obstacles.append((thing, math.hypot(obstacle["length_m"], obstacle["width_m"])))

    def lane(self, name):
        """A lane by its name; None where nobody may drive on it."""
        start, end, number = name
        lanes = self.network.graph.get(start, {}).get(end)
        return lanes[number] if lanes else None

    def box(self, spec, position=(0.0, 0.0), heading_theta=0.0, lane=None):
        size = {"length": spec["length_m"], "width": spec["width_m"]}
        box = self.engine.spawn_object(Box, position=position, heading_theta=heading_theta, lane=lane, **size)
        self.spawned.append(box.id)
        box.put(*position, heading_theta)
        return box

    def drives(self):
        """Whether the ego's policy drives, and not its recorded driver."""
        return not self.scene or self.scene["recorded"] is None or self.step >= self.scene["handover"]

    def carry(self, share):
        """Puts everybody with a plan where the plan has them, at a share of this step."""
        if not self.scene:
            return
        if not self.drives():
            self.actors[0].carry(between(self.scene["recorded"]["states"], self.step, share))
        for actor in self.actors:
            if isinstance(actor, PlannedActor):
                actor.carry(self, self.step, share)
        for part in self.attached:
            part.carry(self.step, share)

    def spawn(self, spec):
        kind, config = vehicle_class(spec["body"]), spawn_config(spec)
        vehicle = self.engine.spawn_object(kind, vehicle_config=config, random_seed=0, auto_fill_random_seed=False)
        self.spawned.append(vehicle.id)
        return vehicle

    def introduce(self, vehicle, policy, spec):
        adjust_inertia(vehicle, spec["body"])
        # A contact is an event and pushes nobody, as in the native simulator.
        vehicle.body.setCollisionResponse(False)
        place = Place(self.network, spec)
        if spec["t_m"] != 0.0:
            vehicle.set_position(place.lanes[0].position(spec["s_m"], spec["t_m"]))
        vehicle.after_step()
        # A start that MetaDrive takes for one on another road is no error to it.
        if list(vehicle.navigation.checkpoints) != nodes_of(spec):
            raise RuntimeError("route %s instead of %s" % (vehicle.navigation.checkpoints, nodes_of(spec)))
        place.update(vehicle.position)
        return Actor(vehicle, policy, place, spec)

    def state(self, number, action):
        return self.actors[number].state() + [float(action[0]), float(action[1])]

    def run(self, window=False):
        physics = self.engine.physics_world.dynamic_world
        tracks, parts = [[] for _ in self.actors], [[] for _ in self.attached]
        touched = set()
        ego, standing = self.actors[0].vehicle, 0
        while True:
            self.released = self.released or ego.navigation.current_road.start_node != ENTRANCE
            waits = not self.drives() or (self.errand and self.errand.stays())
            standing = standing + 1 if ego.speed < Law.standing_mps and not waits else 0
            self.carry(0.0)
            end = self.verdict(touched, standing)
            actions = [[0.0, 0.0]] * len(self.actors)
            if end is None:
                self.refuse()
                actions = []
                for number, actor in enumerate(self.actors):
                    plays = actor.gone or (number == 0 and not self.drives())
                    action = [0.0, 0.0] if plays else actor.policy.decide(self, number)
                    actions.append([max(-1.0, min(1.0, float(part))) for part in action])
            for number, track in enumerate(tracks):
                track.append(self.state(number, actions[number]))
            for part, track in zip(self.attached, parts):
                track.append(part.now + [0.0, 0.0])
            if end is not None:
                tracks += parts
                return {"end": end, "time_s": self.step * Law.step_s, "tracks": tracks, "events": self.events}
            if self.scene and self.scene["recorded"] and self.step == self.scene["handover"]:
                self.actors[0].let_go(self.scene["recorded"]["states"][self.step], self.scene["handover_turns_radps"])
            present = [actor for actor in self.actors if actor.gone is None]
            for actor, action in zip(self.actors, actions):
                if actor.gone is None:
                    actor.vehicle.before_step(action)
            near = self.near_pairs()
            for substep in range(1, SUBSTEPS + 1):
                # Bullet's bodies are a tick ahead of the places MetaDrive shows: what touches now is shown after the step.
                self.carry(substep / SUBSTEPS)
                touching = self.touching(physics, near, touched)
                self.engine.step_physics_world()
                self.carry(substep / SUBSTEPS)
                self.note(touching, touched, actions, self.step * Law.step_s + substep * 0.02)
            for thing, _ in self.obstacles:
                # One that was hit keeps its place but gets a velocity, which the IDM would believe.
                thing.body.setLinearVelocity(LVector3(0, 0, 0))
            for actor in self.actors:
                if actor.gone is not None:
                    actor.go_on()
            for actor in present:
                actor.vehicle.after_step()
                actor.place.update(actor.vehicle.position)
            self.remove_who_left()
            self.step += 1
            if window:
                self.env.render(mode="topdown", window=True, screen_size=(900, 700))

    def refuse(self):
        """Ends a run whose plans go on in a way that cannot be known here."""
        ends = self.scene and self.scene["ends"]
        if ends and self.step >= ends[0]:
            raise Refused("at %.1f s %s" % (ends[0] * Law.step_s, ends[1]))

    def remove_who_left(self):
        """Background traffic that is on no lane any more is unseen and untouchable from then on."""
        for actor in self.actors[self.first_traffic :]:
            if actor.gone is None and self.is_off_road(actor.vehicle):
                actor.gone = actor.state()
                self.spawned.remove(actor.vehicle.id)
                self.engine.clear_objects([actor.vehicle.id], force_destroy=True)

    def near_pairs(self):
        """Who may touch whom within this step: actors by number, obstacles behind them."""
        found, count = [], len(self.actors)
        for a, first in enumerate(self.actors):
            if first.away:
                continue
            x, y = first.vehicle.position
            reach = first.radius + 0.1 * first.vehicle.speed + 1.0
            for b in range(a + 1, count):
                second = self.actors[b]
                if second.away:
                    continue
                u, v = second.vehicle.position
                if math.hypot(u - x, v - y) < reach + second.radius + 0.1 * second.vehicle.speed:
                    found.append((a, b))
            for number, (thing, radius) in enumerate(self.obstacles):
                u, v = thing.position
                if math.hypot(u - x, v - y) < reach + radius:
                    found.append((a, count + number))
        return found

    def touching(self, physics, near, touched):
        """Pairs that touch for the first time, by Bullet's own contact test (what MetaDrive's crash flags come from)."""
        things = [[actor.vehicle] + actor.parts for actor in self.actors] + [[thing] for thing, _ in self.obstacles]

        def touch(a, b):
            pairs = ((mine.body, theirs.body) for mine in things[a] for theirs in things[b])
            return any(physics.contactTestPair(mine, theirs).getNumContacts() > 0 for mine, theirs in pairs)

        return [(a, b) for a, b in near if (a, b) not in touched and touch(a, b)]

    def note(self, touching, touched, actions, time):
        count = len(self.actors)
        for a, b in touching:
            touched.add((a, b))
            if a != 0 and b < count and isinstance(self.actors[b], PlannedActor) != isinstance(self.actors[a], PlannedActor):
                raise Refused("at %.2f s somebody with a plan is pushed" % time)
            event = {"time_s": time, "a": a, "a_state": self.state(a, actions[a])}
            if b < count:
                self.actors[a].halted = self.actors[b].halted = True
                event.update(b=b, b_state=self.state(b, actions[b]))
            else:
                event.update(obstacle=b - count)
            self.events.append(event)

    def verdict(self, touched, standing):
        ego, count = self.actors[0].vehicle, len(self.actors)
        if not all(math.isfinite(part) for n in range(count) for part in self.state(n, [0.0, 0.0])):
            raise RuntimeError("a state is no longer finite")
        if any(a == 0 and b < count for a, b in touched):
            return "contact"
        # Given controls are played to their end, wherever that is.
        if self.drives() and not isinstance(self.actors[0].policy, OpenLoopPolicy):
            if self.env._is_arrive_destination(ego):
                return "arrived"
            if self.is_off_road(ego):
                return "off_road"
            if standing >= Law.stuck_steps and not self.anybody_moves():
                return "stuck"
        if self.step * Law.step_s >= self.spec["duration_s"] - 0.5 * Law.step_s:
            return "arrived" if self.drives() and self.errand and self.errand.stays() else "timeout"
        return None

    def is_off_road(self, vehicle):
        """MetaDrive's rule; but its ray misses a long lane now and then for a step, in the middle of the road."""
        if vehicle.on_lane:
            return False
        lanes = (lane for ends in self.network.graph.values() for lanes in ends.values() for lane in lanes)
        places = ((lane, lane.local_coordinates(vehicle.position)) for lane in lanes)
        return not any(0.0 <= s <= lane.length and abs(t) <= 0.5 * width_at(lane, s) for lane, (s, t) in places)

    def anybody_moves(self):
        return any(
            actor.vehicle.speed >= Law.standing_mps or (not actor.halted and actor.policy.has_plans(self.step))
            for actor in self.actors[1:]
            if not actor.away
        )

    def clear(self):
        self.engine.clear_objects(self.spawned, force_destroy=True)


def work():
    """Answers requests until there are no more."""
    hello(VERSION)
    env = make_env()
    for line in sys.stdin.buffer:
        request = json.loads(line)
        world = World(env, request["run"])
        try:
            world.set_up()
            done = world.run()
            done["maps"] = len(ScenarioMapManager.built)
            answer = {"id": request["id"], "done": done}
        except Refused as error:
            answer = {"id": request["id"], "refused": str(error)[:500]}
        except Exception as error:  # told, and the next request goes on
            answer = {"id": request["id"], "error": ("%s: %s" % (type(error).__name__, error))[:500]}
        if world.engine is not None:
            world.clear()
        send(answer)
    env.close()


def least_gap(run, done):
    """Least gap between the boxes of the ego and the partners at the steps, and its time; none at a contact."""
    from shapely.geometry import Polygon

    def outline(spec, state):
        x, y, heading = state[:3]
        c, s = math.cos(heading), math.sin(heading)
        a, b = 0.5 * spec["body"]["length_m"], 0.5 * spec["body"]["width_m"]
        return Polygon([(x + u * c - v * s, y + u * s + v * c) for u, v in ((a, b), (-a, b), (-a, -b), (a, -b))])

    tracks, partners = done["tracks"], run["partners"]
    touched = [event for event in done["events"] if event["a"] == 0 and 0 < event.get("b", 0) <= len(partners)]
    least = [(0.0, event["time_s"]) for event in touched]
    for number, partner in enumerate(partners, 1):
        for step, (mine, theirs) in enumerate(zip(tracks[0], tracks[number])):
            gap = outline(run["ego"], mine).distance(outline(partner, theirs))
            least.append((gap, step * Law.step_s))
    return min(least, default=(math.inf, None))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario", help="an exported *.metadrive.json")
    parser.add_argument("--headless", action="store_true", help="no window even where there is a display")
    parser.add_argument("--trace", help="write every state to this JSON file")
    arguments = parser.parse_args()
    with open(arguments.scenario, encoding="utf-8") as source:
        content = json.load(source)
    run, env = content["run"], make_env()
    world = World(env, run)
    world.set_up()
    display = os.name == "nt" or not {"DISPLAY", "WAYLAND_DISPLAY"}.isdisjoint(os.environ)
    done = world.run(display and not arguments.headless)
    env.close()
    if arguments.trace:
        scene = run.get("scene") or {"planned": [], "parts": []}
        specs = [run["ego"]] + run["partners"] + scene["planned"] + run["traffic"] + scene["parts"]
        actors = [spec["id"] for spec in specs]
        columns = ["x_m", "y_m", "heading_rad", "vx_mps", "vy_mps", "steering", "throttle"]
        trace = {"step_s": Law.step_s, "columns": columns, "actors": actors, "states": list(zip(*done["tracks"]))}
        with open(arguments.trace, "w", encoding="utf-8") as file:
            json.dump(trace, file)
    gap, when = least_gap(run, done)
    last = {"min_gap_m": None if when is None else round(gap, 3), "min_gap_time_s": when and round(when, 2)}
    print(json.dumps({"scenario": content["id"], "end": done["end"], "time_s": round(done["time_s"], 2), **last}))


# The second part of the script: what partners do. recrash joins its parts to one file; what is used here and not defined
# here stands in the first.


class PartnerPolicy(IDMPolicy):
    """What a plan asks for: the same law as recrash's crates/plan, function by function."""

    def __init__(self, vehicle, spec):
        super().__init__(vehicle, 0)
        self.spec, self.plan, self.way = spec, spec["plan"], spec["partner_way"]
        self.script = self.plan["speed"]
        # Of the IDM policy the gap law is used, nothing else.
        self.NORMAL_SPEED = self.target_speed = 3.6 * self.script["speed_mps"]
        self.enable_lane_change = False
        self.standing_steps = 0
        self.last_heading = None

    def waits(self, step):
        return self.script["type"] == "wait" and (self.script["until"] is None or step < self.script["until"])

    def has_plans(self, step):
        script, kind = self.script, self.script["type"]
        if kind == "wait":
            return script["speed_mps"] > 0 and script["until"] is not None and step <= script["until"]
        if kind == "timed":
            return script["speed_mps"] > 0 or step < max(script["brake_until"], script["throttle_until"])
        return False

    def decide(self, world, me):
        actor = world.actors[me]
        if self.waits(world.step):
            # The controllers begin when it sets off. On its brakes alone a vehicle creeps at some centimetres a second.
            if actor.vehicle.speed < Law.standing_mps:
                actor.vehicle.set_velocity([0.0, 0.0])
            return [0.0, hold_still(actor.vehicle.speed)]
        throttle = hold_still(actor.vehicle.speed) if actor.halted else self.pedal(world, me)
        return [self.steer(world, actor), throttle]

    def lateral_target(self, time):
        """Offset wanted from the lane's centre, and its rate; a move takes over from wherever the last one is."""
        offset, moves = self.plan["start_t_m"], self.way["moves"]
        for position, move in enumerate(moves):
            if time < move["start_s"]:
                return offset, 0.0
            rate = (move["to_t_m"] - offset) / max(move["duration_s"], Law.shortest_move_s)
            following = moves[position + 1]["start_s"] if position + 1 < len(moves) else math.inf
            until = min(following, move["start_s"] + move["duration_s"])
            if time < until:
                return offset + rate * (time - move["start_s"]), rate
            offset += rate * max(until - move["start_s"], 0.0)
        return offset, 0.0

    def line(self, time):
        """The line of its moves, each corner rounded."""
        half = 0.5 * self.way["blend_s"]
        if half <= 0.0:
            return self.lateral_target(time)
        before, now, after = (self.lateral_target(time + share * half)[0] for share in (-1, 0, 1))
        return (before + 4.0 * now + after) / 6.0, (after - before) / (2.0 * half)

    def steer(self, world, actor):
        plan, vehicle, place = self.plan, actor.vehicle, actor.place
        preview, greatest = Law.preview_s, plan["greatest_drift_rad"]
        wanted, rate = self.line(world.step * Law.step_s + preview - Law.seen_late_s)
        drift = math.asin(max(-1.0, min(1.0, -rate / max(vehicle.speed, Law.slow_mps))))
        drift = max(-greatest, min(greatest, drift))

        heading, speed, last = vehicle.heading_theta, vehicle.speed, self.last_heading
        yaw_rate = 0.0 if last is None else wrap(heading - last) / Law.step_s
        self.last_heading = heading
        arm = plan["rear_axle_m"] - plan["slip_s"] * speed
        lane, curvature = place.way_at(place.path_s)
        here = wrap(heading + arm * curvature - lane)
        lane, curvature = place.way_at(place.path_s + speed * preview)
        ahead = wrap(heading + yaw_rate * preview + arm * curvature - lane)
        offset = place.t - speed * preview * math.sin(0.5 * (here + ahead))

        length = max(speed * Law.return_s, Law.return_wheelbases * plan["wheelbase_m"])
        per_offset = 1.0 / length**2
        per_course = max(2.0 / length - arm * per_offset, 1.0 / length)
        angle = drift - (wanted - offset) * per_offset / per_course
        angle = max(-greatest, min(greatest, angle))
        bend = curvature / max(1.0 + curvature * offset, 0.1) + per_course * wrap(angle - ahead)
        most = plan["sideways_mps2"] / max(speed, Law.slow_mps) ** 2
        return math.atan(plan["wheelbase_m"] * max(-most, min(most, bend))) / plan["full_wheel_rad"]

    def pedal(self, world, me):
        plan, script, kind = self.plan, self.script, self.script["type"]
        actor = world.actors[me]
        speed, place = actor.vehicle.speed, actor.place
        if kind == "timed" and script["brake_from"] <= world.step < script["brake_until"]:
            return hold_still(speed)
        if kind == "timed" and world.step < script["throttle_until"]:
            wanted = self.meaning(script["throttle"])
        elif kind == "follow":
            wanted = self.meaning(self.gap_law(actor.vehicle))
        else:
            if script["speed_mps"] < Law.standing_mps and speed < Law.hold_below_mps:
                return Law.hold_brake
            wanted = max(plan["gain_per_s"] * (script["speed_mps"] - speed), -plan["comfortable_mps2"])
        acceleration = wanted
        stop = min([math.inf] + self.give_way(world, me) + self.blocked_ahead(world, place))
        if -Law.committed_m <= stop < math.inf:
            left = max(stop - Law.stop_short_m, 0.0)
            at_line = math.sqrt(2.0 * plan["stopping_mps2"] * left)
            if at_line < Law.standing_mps and speed < Law.hold_below_mps:
                return Law.hold_brake
            acceleration = min(acceleration, self.come_down(speed, 0.0, left, plan["stopping_mps2"]))
        for bend in self.way["bends"]:
            if bend["to_m"] > place.path_s:
                left = max(bend["from_m"] - place.path_s, 0.0)
                slower = self.come_down(speed, bend["speed_mps"], left, plan["comfortable_mps2"])
                acceleration = min(acceleration, slower)
        hardest = min(-plan["greatest_braking_mps2"], wanted)
        acceleration = max(hardest, min(acceleration, plan["full_throttle_mps2"]))
        if acceleration < 0.0:
            return acceleration / plan["full_brake_mps2"]
        return max(acceleration / max(plan["full_throttle_mps2"], 1e-3), Law.least_throttle)

    def meaning(self, pedal):
        """The acceleration that a pedal asks for."""
        pedal = max(-1.0, min(1.0, pedal))
        return pedal * self.plan["full_brake_mps2" if pedal < 0.0 else "full_throttle_mps2"]

    @staticmethod
    def come_down(speed, target, distance, deceleration):
        """The acceleration along the parabola that ends at a place with a speed."""
        on_parabola = math.sqrt(target * target + 2.0 * deceleration * distance)
        slope = deceleration * speed / on_parabola if distance > 0.0 else 0.0
        return (on_parabola - speed) / Law.catch_up_s - slope

    def gap_law(self, vehicle):
        self.target_speed = self.NORMAL_SPEED
        front, distance = None, 5
        try:
            objects = vehicle.lidar.get_surrounding_objects(vehicle)
            around = FrontBackObjects.get_find_front_back_objs(
                objects, vehicle.lane, vehicle.position, self.MAX_LONG_DIST
            )
            front, distance = around.front_object(), around.front_min_distance()
        except AttributeError:
            pass
        return self.acceleration(front, distance)

    def blocked_ahead(self, world, place):
        """Distances to obstacles that lie on its line."""
        wanted, half = self.line(world.step * Law.step_s)[0], self.plan["half_width_m"] - Law.brushes_m
        left, right = min(place.t, wanted) - half, max(place.t, wanted) + half
        there = [each for each in self.way["blocked"] if each["left_m"] < right and each["right_m"] > left]
        aheads = (each["from_m"] - self.plan["half_length_m"] - place.path_s for each in there)
        return [ahead for ahead in aheads if ahead >= -Law.committed_m]

    def give_way(self, world, me):
        """Distances to where it has to wait for others."""
        if self.script["type"] != "give_way":
            return []
        speed, place = world.actors[me].vehicle.speed, world.actors[me].place
        self.standing_steps = self.standing_steps + 1 if speed < Law.standing_mps else 0
        aheads = []
        for crossing in self.spec["crossings"]:
            ahead = crossing["mine"]["from"] - place.path_s
            if ahead >= -Law.committed_m and self.must_wait(world, me, crossing, ahead):
                aheads.append(max(ahead, 0.0))
        return aheads

    def must_wait(self, world, me, crossing, ahead):
        number, merges, mine, theirs = (crossing[name] for name in ("other", "merges", "mine", "theirs"))
        own, other = world.actors[me], world.actors[number]
        if other.gone:
            return False
        other_s, other_speed = other.place.path_s, other.vehicle.speed
        if other_s > (theirs["from"] + Law.merged_m if merges else theirs["to"]):
            return False
        if other_s > theirs["from"]:
            return True
        own_speed = own.vehicle.speed
        if other_speed < Law.standing_mps:
            patient = self.standing_steps < Law.patience_steps
            return number < me and own_speed < Law.standing_mps and patient
        speed = max(own_speed, 0.5 * self.script["speed_mps"], Law.standing_mps)
        own_entry = max(ahead, 0.0) / speed
        own_exit = own_entry + Law.merging_s if merges else (mine["to"] - own.place.path_s) / speed
        way = theirs["from"] - other_s
        # The earliest they can be there.
        a = Law.their_acceleration_mps2
        their_entry = (math.sqrt(other_speed * other_speed + 2.0 * a * way) - other_speed) / a
        their_exit = way / other_speed + Law.merging_s if merges else (theirs["to"] - other_s) / other_speed
        if their_entry > Law.horizon_s or own_entry > Law.horizon_s:
            return False
        gap = self.script["gap_s"]
        return own_exit + gap > their_entry and their_exit + 0.5 * gap > own_entry


# The third part of the script: networks of roads, plans that are replayed, control, and the start of it all. recrash joins
# its parts to one file; what is used here and not defined here stands in the first.


class Refused(Exception):
    """What happens from here on depends on something that MetaDrive cannot know."""


class LaneBlock(PGBlock):
    """All lanes of a network of roads, as they are."""

    ID = "G"
    PARAMETER_SPACE = ParameterSpace({})
    SOCKET_NUM = 0

    def __init__(self, lanes, network):
        self.name = "1G"
        # Without the block before it that PGBlock wants.
        BaseBlock.__init__(self, 1, network, 1, ignore_intersection_checking=True)
        self.lanes, self.number_of_sample_trial, self._sockets = lanes, 0, OrderedDict()

    def get_intermediate_spawn_lanes(self):
        return []

    def _try_plug_into_previous_block(self):
        for shape in self.lanes:
            start, end, _ = shape["name"]
            self.block_network.add_lane(start, end, network_lane(shape))
        return True

    def create_in_world(self):
        for start, ends in self.block_network.graph.items():
            for end, lanes in ends.items():
                for number, lane in enumerate(lanes):
                    self._construct_lane(lane, (start, end, number))


def network_lane(shape):
    (kind, line), (first, last) = next(iter(shape["line"].items())), shape["widths_m"]
    common = {"width": 0.5 * (first + last), "line_types": (PGLineType.NONE, PGLineType.NONE)}
    if kind == "straight":
        lane = StraightLane(line["start"], line["end"], **common)
    else:
        angle = shape["length_m"] / line["radius"]
        lane = CircularLane(line["centre"], line["radius"], line["start_angle"], angle, line["turn"] < 0, **common)
    lane.widths = (first, last)
    return lane


def width_at(lane, s):
    first, last = getattr(lane, "widths", (lane.width, lane.width))
    return first + (last - first) * max(0.0, min(1.0, s / lane.length))


class Box(TrafficObject):
    """A box that is where it is put: an obstacle of any size, somebody with a plan, a door."""

    HEIGHT = 2.0
    # Beside all lanes, where MetaDrive's policy does not look.
    NOWHERE = StraightLane([9000.0, 9000.0], [9001.0, 9000.0], 1.0)

    def __init__(self, position, heading_theta, length, width, lane=None, random_seed=None, name=None):
        super().__init__(position, heading_theta, lane or self.NOWHERE, random_seed, name)
        self.size, self.moving = (length, width), (0.0, 0.0)
        self.add_body(BaseRigidBodyNode(self.name, self.CLASS_NAME))
        self.body.addShape(BulletBoxShape((0.5 * length, 0.5 * width, 0.5 * self.HEIGHT)))
        self.set_static(True)

    def put(self, x, y, heading, moving=(0.0, 0.0)):
        self.set_position((x, y), 0.5 * self.HEIGHT)
        self.set_heading_theta(heading)
        self.moving = moving

    velocity = property(lambda self: np.asarray(self.moving))
    velocity_km_h = property(lambda self: 3.6 * self.velocity)
    speed = property(lambda self: math.hypot(*self.moving))
    speed_km_h = property(lambda self: 3.6 * self.speed)
    LENGTH = top_down_length = property(lambda self: self.size[0])
    WIDTH = top_down_width = property(lambda self: self.size[1])

    def before_step(self, action=None):
        return {}

    def after_step(self):
        return {}


def between(states, step, share):
    """Where somebody is on the way from one state to the next."""
    first, second = (states[min(number, len(states) - 1)] for number in (step, step + 1))
    if share == 0.0 or first is second:
        return list(first)
    mixed = [a + (b - a) * share for a, b in zip(first, second)]
    mixed[2] = wrap(first[2] + wrap(second[2] - first[2]) * share)
    return mixed


class PlannedActor:
    """Somebody whose plan is replayed: a stand-in for an actor with its own driver."""

    policy_name = "plan"

    def __init__(self, world, spec):
        self.spec, self.parts, self.now = spec, [], spec["states"][0]
        # Policies find a body by where it was in the last physics step, and a new one where it was made: whoever is there
        # from the beginning is seen at once, and who appears a step later, as in the native simulator.
        self.vehicle = world.box(spec, self.now[:2], self.now[2])
        self.radius = 0.5 * math.hypot(spec["length_m"], spec["width_m"])
        self.halted, self.gone, self.place, self.policy = False, None, self, self
        self.carry(world, 0, 0.0)

    def is_there(self, step):
        return step >= self.spec["appears"] and (self.spec["gone"] is None or step < self.spec["gone"])

    @property
    def away(self):
        return not self.there

    def carry(self, world, step, share):
        self.now = between(self.spec["states"], step, share)
        # Who leaves or appears does so at a step.
        self.there = self.is_there(step)
        x, y, heading, vx, vy = self.now
        self.vehicle.put(*((x, y) if self.there else (5000.0, 5000.0)), heading, (vx, vy))
        if share == 0.0:
            names = [name for since, name in self.spec["lanes"] if since <= step]
            self.vehicle.lane = (names[-1] and world.lane(names[-1])) or Box.NOWHERE

    def state(self):
        return list(self.now)

    def update(self, position):
        pass

    def decide(self, world, me):
        return [0.0, 0.0]

    def has_plans(self, step):
        return step < self.spec["over"]


class Attached:
    """A box that belongs to somebody."""

    def __init__(self, world, spec):
        self.spec, self.owner = spec, world.actors[spec["owner"]]
        self.vehicle = world.box(spec)
        self.of_ego = spec["owner"] == 0
        self.owner.parts.append(self.vehicle)
        self.carry(0, 0.0)
        reach = max(math.hypot(x, y) for x, y, _ in self.around())
        self.owner.radius = max(self.owner.radius, reach + 0.5 * math.hypot(spec["length_m"], spec["width_m"]))

    def around(self):
        """Its places as seen from its owner."""
        if self.of_ego:
            return self.spec["states"]
        owners = self.owner.spec["states"]
        return [(x - u, y - v, h) for (x, y, h), (u, v, *_) in zip(self.spec["states"], owners)]

    def carry(self, step, share):
        x, y, heading = between(self.spec["states"], step, share)
        if self.of_ego:
            u, v, facing = self.owner.state()[:3]
            c, s = math.cos(facing), math.sin(facing)
            x, y, heading = u + x * c - y * s, v + x * s + y * c, wrap(facing + heading)
        self.now = [x, y, heading] + self.owner.state()[3:5]
        self.vehicle.put(*((5000.0, 5000.0) if self.owner.away else (x, y)), heading)


class Errand:
    """Where the ego has to stand: the same law as recrash's crates/sim/src/halts.rs."""

    def __init__(self, scene):
        self.scene, self.stops = scene, scene["stops"]
        self.stops_done = self.stood = self.stood_at_sign = 0
        self.free_to = -math.inf

    @staticmethod
    def aspect(device, time):
        """What a signal shows; None for signs."""
        signal = device.get("signal")
        if signal is None:
            return None
        cycle = sum(phase["for_s"] for phase in signal["program"])
        left = (time + signal.get("offset_s", 0.0)) % cycle
        for phase in signal["program"]:
            if left < phase["for_s"]:
                return phase["show"]
            left -= phase["for_s"]
        return signal["program"][-1]["show"]

    def nearest(self, time, path_s, speed):
        """The distance to the nearest place where it must stand now."""
        distances, stands, at_sign = [], speed < Law.standing_mps, False
        for at, control in self.scene["lines"]:
            device, distance = self.scene["control"][control], at - path_s
            shown = self.aspect(device, time)
            if distance < -Law.passed_line_m or "yield_sign" in device or shown in ("green", "dark"):
                continue
            if shown == "yellow":
                if speed * speed > 2.0 * Law.yellow_mps2 * max(distance, 0.1) or distance < -Law.halt_short_m:
                    continue
            elif shown == "red":
                if distance < -Law.halt_short_m:
                    continue
            else:
                if at <= self.free_to:
                    continue
                if stands and distance < 1.0:
                    at_sign, self.stood_at_sign = True, self.stood_at_sign + (not at_sign)
                    if self.stood_at_sign >= Law.sign_steps:
                        self.free_to = at
                        continue
            distances.append(distance)
        if not at_sign:
            self.stood_at_sign = 0
        distances += self.next_stop(path_s, stands)
        return min(distances, default=None)

    def next_stop(self, path_s, stands):
        if self.stops_done >= len(self.stops):
            return []
        stop = self.stops[self.stops_done]
        distance = stop["s_m"] - path_s
        if distance < -5.0:
            self.stops_done, self.stood = self.stops_done + 1, 0
            return []
        if stands and distance < 1.0:
            self.stood += 1
            if stop.get("for_s") is not None and 0.1 * self.stood >= stop["for_s"]:
                self.stops_done, self.stood = self.stops_done + 1, 0
                return []
        else:
            self.stood = 0
        return [distance]

    def stays(self):
        """Whether it stands where its task ends."""
        rest = self.stops[self.stops_done :]
        return bool(rest) and rest[0].get("for_s") is None and self.stood > 0

    def beside(self, path_s):
        """How far to the right of its lane's centre its task wants it here."""

        def share(distance):
            x = 1.0 - max(0.0, min(1.0, (distance - Law.straight_before_m) / Law.pull_over_m))
            return x * x * (3.0 - 2.0 * x)

        number = self.stops_done
        stops = [dict({"t_m": 0.0}, **stop) for stop in self.stops]
        coming = [stop["t_m"] * share(stop["s_m"] - path_s) for stop in stops[number : number + 1]]
        leaving = [stop["t_m"] * share(path_s - stop["s_m"]) for stop in stops[max(number - 1, 0) : number]]
        return max(coming + leaving, key=abs, default=0.0)

    @staticmethod
    def before(throttle, distance, speed, brake):
        """A throttle that also leads to a stand at a place this far ahead."""
        left = distance - Law.halt_short_m
        if left <= 0.0 or (speed < Law.standing_mps and left < 0.5):
            return min(throttle, hold_still(speed))
        needed = speed * speed / (2.0 * left)
        if needed < 0.9 * Law.halt_mps2 and speed < 0.95 * math.sqrt(2.0 * Law.halt_mps2 * left):
            return throttle
        return max(-1.0, min(throttle, -needed / brake))


work() if WORKER else main()

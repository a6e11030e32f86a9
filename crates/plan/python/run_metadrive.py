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

"""Oracle for following and crossing measures, by CommonRoad-CriMe.

Writes crime_following.csv and crime_crossing.csv beside this file; the tests in `crates/metrics/src/oracle.rs` compare,
and docs/models/metric-oracles.md says where the definitions differ. Needs Python 3.11 and commonroad-crime==0.4.5:

    python crates/metrics/oracle/crime.py [following] [crossing]

- Following: 100 drives along +x, 6 s at 0.1 s, sampled twelve times each: HW, TTC, THW, ALongReq.
- Crossing: 60 drives on a crossing whose lanes are exactly as wide as the vehicles, at 0.02 s: PET. (CriMe's conflict
  area is that of the lanes; with lanes as wide as the vehicles it is that of the swept paths.)

CriMe rounds its results to two decimals, and takes a lane direction of exactly zero for none at all. Both are patched.
"""

import contextlib
import csv
import io
import logging
import math
import pathlib
import sys
import warnings

import numpy as np

warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)

import commonroad_crime.utility.general as utils_gen  # noqa: E402
import commonroad_crime.utility.solver as utils_sol  # noqa: E402
from commonroad.geometry.shape import Rectangle  # noqa: E402
from commonroad.prediction.prediction import TrajectoryPrediction  # noqa: E402
from commonroad.scenario.intersection import Intersection, IntersectionIncomingElement  # noqa: E402
from commonroad.scenario.lanelet import Lanelet, LaneletNetwork, LaneletType  # noqa: E402
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType  # noqa: E402
from commonroad.scenario.scenario import Scenario, Tag  # noqa: E402
from commonroad.scenario.state import CustomState, InitialState  # noqa: E402
from commonroad.scenario.trajectory import Trajectory  # noqa: E402
from commonroad_crime.data_structure.configuration import CriMeConfiguration  # noqa: E402
from commonroad_crime.measure import HW, PET, THW, TTC, ALongReq  # noqa: E402

utils_gen.int_round = lambda value, tolerance=1: value
width_and_orientation = utils_sol.compute_lanelet_width_orientation


def never_exactly_zero(lanelet, position):
    width, orientation = width_and_orientation(lanelet, position)
    return width, 1e-12 if orientation == 0.0 else orientation


utils_sol.compute_lanelet_width_orientation = never_exactly_zero

HERE = pathlib.Path(__file__)
LENGTH, WIDTH = 4.515, 1.852
EGO, OTHER = 100, 101


def lanelet(number, start, heading, length, width, kind, predecessor=None, successor=None):
    forward = np.array([math.cos(heading), math.sin(heading)])
    left = np.array([-forward[1], forward[0]]) * width / 2
    s = np.linspace(0.0, length, max(2, int(length / 2.0) + 1))[:, None]
    centre = np.asarray(start) + s * forward
    return Lanelet(centre + left, centre, centre - left, number, predecessor=predecessor or [],
                   successor=successor or [], lanelet_type={kind})


def vehicle(number, positions, heading, speeds):
    states = [dict(time_step=k, position=p, orientation=heading, velocity=v) for k, (p, v) in enumerate(zip(positions, speeds))]
    initial = InitialState(**states[0], yaw_rate=0.0, slip_angle=0.0, acceleration=0.0)
    shape = Rectangle(LENGTH, WIDTH)
    trajectory = Trajectory(1, [CustomState(**state) for state in states[1:]])
    return DynamicObstacle(number, ObstacleType.CAR, shape, initial, TrajectoryPrediction(trajectory, shape))


def configured(network, dt, vehicles, tags=()):
    scenario = Scenario(dt)
    scenario.add_objects(network)
    scenario.tags = set(tags)
    scenario.add_objects(vehicles)
    scenario.assign_obstacles_to_lanelets()
    configuration = CriMeConfiguration()
    configuration.update(ego_id=EGO, sce=scenario)
    return configuration


def quiet(measure, configuration, step):
    with contextlib.redirect_stdout(io.StringIO()):
        found = measure(configuration)
        value = found.compute(vehicle_id=OTHER, time_step=step, verbose=False)
    return float(value), found


def profile(rng, steps, dt):
    """Speeds: constant, or constant with a stretch of braking or accelerating."""
    speeds = np.full(steps, rng.uniform(4.0, 20.0))
    if rng.random() < 0.5:
        begin, end = sorted(rng.integers(0, steps, 2))
        rate = rng.choice([rng.uniform(-5.0, -0.5), rng.uniform(0.5, 2.0)])
        speeds = speeds + np.clip(np.arange(steps) - begin, 0, end - begin) * dt * rate
    return np.maximum(speeds, 0.0)


def following(rng):
    dt, steps = 0.1, 61
    rows = []
    network = LaneletNetwork()
    network.add_lanelet(lanelet(1, (0.0, 0.0), 0.0, 600.0, 3.5, LaneletType.HIGHWAY))
    drive = 0
    while drive < 100:
        speeds = [profile(rng, steps, dt) for _ in range(2)]
        travelled = [np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * dt)]) for v in speeds]
        x = [20.0 + travelled[0], 20.0 + LENGTH + rng.uniform(3.0, 70.0) + travelled[1]]
        if (x[1] - x[0]).min() < LENGTH + 0.5 or max(x[1].max(), x[0].max()) > 590.0:
            continue
        made = [vehicle(number, np.column_stack([x[i], np.zeros(steps)]), 0.0, speeds[i])
                for i, number in enumerate((EGO, OTHER))]
        configuration = configured(network, dt, made)
        for step in range(2, steps - 1, 5):
            values = {}
            for measure in (HW, TTC, THW, ALongReq):
                values[measure.__name__], found = quiet(measure, configuration, step)
            accelerations = [v.state_at_time(step).acceleration for v in (found.ego_vehicle, found.other_vehicle)]
            rows.append([drive, step, x[0][step], speeds[0][step], x[1][step], speeds[1][step], *accelerations,
                         values["HW"], values["TTC"], values["THW"], values["ALongReq"]])
        drive += 1
    write("crime_following.csv", ["drive", "step", "ego_x", "ego_v", "other_x", "other_v", "ego_a", "other_a", "hw",
                                  "ttc", "thw", "a_long_req"], rows)


def crossing(rng):
    dt = 0.02
    rows = []
    while len(rows) < 60:
        angle = math.pi / 2 if len(rows) % 2 else rng.uniform(0.6, 2.4)
        heading = float(rng.choice([-1.0, 1.0])) * angle
        speeds = rng.uniform(5.0, 15.0, 2)
        late = rng.choice([-1.0, 1.0]) * rng.uniform(0.8, 3.0)
        at = [4.0, 4.0 + late]
        steps = int((max(at) + 3.0) / dt)
        network = LaneletNetwork()
        # Each way: in, through the crossing (at the origin), out.
        for first, h, in_number in ((1, 0.0, 1), (11, heading, 2)):
            forward = np.array([math.cos(h), math.sin(h)])
            for part, (begin, end) in enumerate([(-200.0, -8.0), (-8.0, 8.0), (8.0, 200.0)]):
                number = first + part
                kind = LaneletType.INTERSECTION if part == 1 else LaneletType.URBAN
                network.add_lanelet(lanelet(number, forward * begin, h, end - begin, WIDTH, kind,
                                            [number - 1] if part else [], [number + 1] if part < 2 else []))
        network.add_intersection(Intersection(50, [
            IntersectionIncomingElement(51, {1}, set(), {2}, set()),
            IntersectionIncomingElement(52, {11}, set(), {12}, set()),
        ]))
        times = np.arange(steps) * dt
        made = []
        for number, h, speed, when in ((EGO, 0.0, speeds[0], at[0]), (OTHER, heading, speeds[1], at[1])):
            s = speed * (times - when)
            made.append(vehicle(number, np.column_stack([s * math.cos(h), s * math.sin(h)]), h, np.full(steps, speed)))
        configuration = configured(network, dt, made, [Tag.INTERSECTION])
        try:
            value, _ = quiet(PET, configuration, 0)
        except AssertionError:  # CommonRoad cannot tell the direction at some seams of lanes.
            continue
        rows.append([heading, speeds[0], at[0], speeds[1], at[1], steps, value])
    write("crime_crossing.csv", ["heading", "ego_v", "ego_at", "other_v", "other_at", "steps", "pet"], rows)


def write(name, columns, rows):
    with open(HERE.with_name(name), "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([[str(v) if isinstance(v, int) else repr(round(float(v), 9)) for v in row] for row in rows])
    print(name, len(rows), "rows")


if __name__ == "__main__":
    parts = sys.argv[1:] or ["following", "crossing"]
    if "following" in parts:
        following(np.random.default_rng(11))
    if "crossing" in parts:
        crossing(np.random.default_rng(12))

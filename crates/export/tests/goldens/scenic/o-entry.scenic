"""
o-entry (Traffic circle, SV proceeding straight, CP proceeding straight). Made by recrash from crash records: 90006-1006/1. The ego enters a roundabout in front of an SUV on the ring, which keeps its speed.

Not carried by Scenic's driving domain, so for information only: {"surface":"dry","lighting":"daylight","weather":"fog"}

Run it:
  scenic o-entry.scenic --2d -S --count 1 --time 400 -m scenic.simulators.newtonian.driving_model
  netconvert --opendrive-files o-entry.xodr -o o-entry.net.xml    # once, for MetaDrive
  scenic o-entry.scenic --2d -S --count 1 --time 400 -m scenic.simulators.metadrive.model
With `-p sweep 1` the parameters below are drawn from their ranges. Newtonian brakes with 6.8 m/s^2 at most,
and lets vehicles pass through each other. MetaDrive gets no cones: its Scenic interface has none.
"""
param map = localPath('o-entry.xodr')
param sumo_map = localPath('o-entry.net.xml')
param render = False
param real_time = False
param time_step = 0.1
param timestep = 0.1
param sweep = 0
model scenic.domains.driving.model

import math
import shapely.geometry
from scenic.core.distributions import distributionFunction

def varied(value, low, high):
    return Range(low, high) if globalParameters.sweep else value

EGO_S_M = 10
EGO_SPEED_MPS = 6
EGO_TARGET_SPEED_MPS = varied(6.5, 5.5, 7.5)    # [m/s] a test
PARTNER1_START_ARRIVAL_GAP_S = varied(-0.6, -1.1, -0.09999999999999998)    # [s] a test
PARTNER1_SPEED_MPS = 6.5
PARTNER1_POLICY_TARGET_SPEED_MPS = 7
DURATION_S = 40

# What recrash's plans mean (docs/models/policies.md): SI units, and MetaDrive's own for its gap law.
GAIN = 0.3
GREATEST_BRAKING = 6
CATCH_UP = 0.5
STANDING = 0.3
HOLD_BELOW = 0.5
HOLD_BRAKE = -0.1
STOP_SHORT = 0.5
COMMITTED = 1
PATIENCE = 30
HORIZON = 12
MERGED = 12
MERGING = 1
THEIR_ACCELERATION = 1
SIGHT = 30
STANDSTILL_DISTANCE = 10
TIME_HEADWAY = 1.5
COMFORT = 4.472135955

# ---- driving: the same in every file -----------------------------------------------------------------------------

STEP = 0.1            # [s]
IN_METADRIVE = 'metadrive' in Car.__module__

def seconds():
    """Time since the beginning. [s]"""
    return simulation().currentTime * STEP

@distributionFunction
def place(way, s, t):
    """The point s metres along a way and t metres to the right of it."""
    here, ahead = way.interpolate(max(s - 0.05, 0)), way.interpolate(s + 0.05)
    length = math.hypot(ahead.x - here.x, ahead.y - here.y)
    forward = ((ahead.x - here.x) / length, (ahead.y - here.y) / length)
    point = way.interpolate(max(s, 0))
    return Vector(point.x + t * forward[1], point.y - t * forward[0])

@distributionFunction
def direction(way, s):
    """Where a way leads, as Scenic counts: 0 is north, anticlockwise. [rad]"""
    here, ahead = way.interpolate(max(s - 0.05, 0)), way.interpolate(s + 0.05)
    return math.atan2(ahead.y - here.y, ahead.x - here.x) - math.pi / 2

def along(way, car):
    """How far along its way a car is. [m]"""
    return way.project(shapely.geometry.Point(car.position.x, car.position.y))

def look_ahead(car):
    """How far ahead of a car the point lies that it steers for. [m]"""
    return max(4.0, 0.6 * car.speed)

def lateral(car, start, moves):
    """Where a car wants to be to the right of its way when it is there: moves are (begin, duration, target). [m]"""
    now, t = seconds() + look_ahead(car) / max(car.speed, 1.0), start
    for begin, duration, target in moves:
        if now >= begin:
            t += (target - t) * min((now - begin) / duration, 1)
    return t

def steering(car, way, t):
    """Pure pursuit: the wheel angle whose circle meets the way a little ahead. (-1 to 1, right positive)"""
    goal = place(way, min(along(way, car) + look_ahead(car), way.length - 0.1), t)
    heading = car.heading + math.pi / 2
    dx, dy = goal.x - car.position.x, goal.y - car.position.y
    left = -dx * math.sin(heading) + dy * math.cos(heading)
    curvature = 2 * left / max(dx * dx + dy * dy, 1.0)
    if IN_METADRIVE:      # wheels turn by up to 40 degrees, 2.469 m wheelbase
        steer = math.atan(2.469 * curvature) / math.radians(40)
    else:                 # Newtonian: radius = length / sin(steer * pi / 2)
        steer = math.asin(max(-1.0, min(1.0, curvature * car.length))) / (math.pi / 2)
    return max(-1.0, min(1.0, -steer))

def pedals(car, command):
    """Throttle and brake for a command from -1 (full brake) to 1 (full throttle) in terms of recrash's vehicles."""
    engine, demand, tyres, comfortable, stopping = car.limits
    command = max(-1.0, min(1.0, command))
    acceleration = command * engine if command >= 0 else max(command * demand, -tyres)
    if acceleration >= 0:
        return min(acceleration / (2.909 if IN_METADRIVE else 5.6), 1.0), 0.0
    if not IN_METADRIVE:
        return 0.0, min(-acceleration / 6.8, 1.0)
    return 0.0, -acceleration / 27.27 if acceleration > -8.17 else min(0.3 + (-8.17 - acceleration) / 9.94, 1.0)

def come_down(car, target, distance, deceleration):
    """The acceleration that leads down to a speed at a place, along the parabola that ends there. [m/s^2]"""
    parabola = math.sqrt(target ** 2 + 2 * deceleration * distance)
    slope = deceleration * car.speed / parabola if distance > 0 else 0.0
    return (parabola - car.speed) / CATCH_UP - slope

def slowed(car, way, command, bends, wait):
    """The command of who also slows for the bends of its way, each (begin, end, speed), and waits after so many metres."""
    engine, demand, tyres, comfortable, stopping = car.limits
    wanted = command * (engine if command >= 0 else demand)
    acceleration, here, left = wanted, along(way, car), max(wait - STOP_SHORT, 0.0)
    if math.sqrt(2 * stopping * left) < STANDING and car.speed < HOLD_BELOW:
        return HOLD_BRAKE
    if wait < math.inf:
        acceleration = min(acceleration, come_down(car, 0.0, left, stopping))
    for begin, end, speed in bends:
        if end > here:
            acceleration = min(acceleration, come_down(car, speed, max(begin - here, 0.0), comfortable))
    acceleration = max(acceleration, min(-GREATEST_BRAKING, wanted))
    return acceleration / (engine if acceleration >= 0 else demand)

def wait_after(car, way, crossings, speed, gap, standing):
    """How far ahead it has to wait for others now. Crossings are (number of the other, its way, whether the ways merge, begin
    and end on the own way, on the other's); `standing` counts the steps it has stood."""
    places = [max(crossing[3] - along(way, car), 0.0) for crossing in crossings
              if crossing[3] - along(way, car) >= -COMMITTED and must_wait(car, way, crossing, speed, gap, standing)]
    return min(places + [math.inf])

def must_wait(car, way, crossing, wanted, gap, standing):
    """Whether it lets another go first at a crossing."""
    number, other_way, merges, begin, end, other_begin, other_end = crossing
    other, me = simulation().objects[number], simulation().objects.index(car)
    here, there = along(way, car), along(other_way, other)
    if there > (other_begin + MERGED if merges else other_end):
        return False
    if there > other_begin:
        return True
    if other.speed < STANDING:
        return number < me and car.speed < STANDING and standing < PATIENCE
    speed, left = max(car.speed, 0.5 * wanted, STANDING), other_begin - there
    entry = max(begin - here, 0.0) / speed
    exit = entry + MERGING if merges else (end - here) / speed
    # The earliest they can be there.
    other_entry = (math.sqrt(other.speed ** 2 + 2 * THEIR_ACCELERATION * left) - other.speed) / THEIR_ACCELERATION
    other_exit = left / other.speed + MERGING if merges else (other_end - there) / other.speed
    if max(entry, other_entry) > HORIZON:
        return False
    return exit + gap > other_entry and other_exit + 0.5 * gap > entry

def drive(car, way, command, t, bends=(), wait=math.inf):
    """The actions of one step: pedals for a command, slowed for bends and others, wheels for a lateral target."""
    throttle, brake = pedals(car, slowed(car, way, command, bends, wait))
    return (SetThrottleAction(throttle), SetBrakeAction(brake), SetSteerAction(steering(car, way, t)))

def hold(car, speed, gain=GAIN):
    """The command that holds a speed, or comes down to it comfortably."""
    engine, demand, tyres, comfortable, stopping = car.limits
    acceleration = max(gain * engine * (speed - car.speed), -comfortable)
    return acceleration / (engine if acceleration >= 0 else demand)

def follow(car, way, speed):
    """MetaDrive's gap law: speed in km/h, gaps in m, blind to whatever is not ahead on its own way within 30 m."""
    command, here = 1 - (car.speed / speed) ** 10, along(way, car)
    for other in simulation().objects:
        point = shapely.geometry.Point(other.position.x, other.position.y)
        gap = way.project(point) - here
        if other is not car and 0 < gap < SIGHT and way.distance(point) < 1.75:
            v, dv = 3.6 * car.speed, 3.6 * (car.speed - getattr(other, 'speed', 0.0))
            command = min(command, 1 - (car.speed / speed) ** 10 - ((STANDSTILL_DISTANCE + TIME_HEADWAY * v + v * dv / COMFORT) / gap) ** 2)
    return command

def contact(a, b):
    """Whether two boxes share a point."""
    return shapely.geometry.Polygon(a._corners2D).intersects(shapely.geometry.Polygon(b._corners2D))

behavior Follow(way, speed):
    while True:
        take drive(self, way, follow(self, way, speed), 0)

behavior Hold(way, speed, start=0, moves=()):
    while True:
        take drive(self, way, hold(self, speed), lateral(self, start, moves))

# ---- ways: the centre lines driven on, from the beginning of the arm to the end of the exit [m] ----------------

EGO_WAY = shapely.geometry.LineString([
    (0, 0), (10, 0), (60, 0), (60.951, -0.045), (61.893, -0.181), (62.817, -0.405),
    (63.717, -0.716), (64.582, -1.112), (65.406, -1.587), (66.182, -2.139), (66.901, -2.763), (67.557, -3.451),
    (68.146, -4.199), (68.66, -5), (69.152, -5.829), (69.664, -6.646), (70.194, -7.451), (70.744, -8.242),
    (71.312, -9.021), (71.899, -9.785), (72.504, -10.536), (73.126, -11.272), (73.766, -11.993), (74.423, -12.698),
    (75.096, -13.388), (75.786, -14.061), (76.492, -14.718), (77.212, -15.358), (77.948, -15.98), (78.699, -16.585),
    (79.464, -17.172), (80.242, -17.74), (81.034, -18.29), (81.838, -18.821), (82.655, -19.332), (83.484, -19.824),
    (84.341, -20.292), (85.218, -20.718), (86.115, -21.102), (87.029, -21.443), (87.959, -21.74), (88.901, -21.993),
    (89.855, -22.2), (90.817, -22.362), (91.786, -22.478), (92.759, -22.547), (93.734, -22.571), (94.71, -22.547),
    (95.683, -22.478), (96.652, -22.362), (97.614, -22.2), (98.567, -21.993), (99.51, -21.74), (100.439, -21.443),
    (101.353, -21.102), (102.25, -20.718), (103.128, -20.292), (103.984, -19.824), (104.813, -19.332), (105.63, -18.821),
    (106.435, -18.29), (107.227, -17.74), (108.005, -17.172), (108.77, -16.585), (109.52, -15.98), (110.256, -15.358),
    (110.977, -14.718), (111.682, -14.061), (112.372, -13.388), (113.046, -12.698), (113.702, -11.993), (114.342, -11.272),
    (114.965, -10.536), (115.569, -9.785), (116.156, -9.021), (116.725, -8.242), (117.274, -7.451), (117.805, -6.646),
    (118.316, -5.829), (118.808, -5), (119.323, -4.199), (119.911, -3.451), (120.568, -2.763), (121.287, -2.139),
    (122.062, -1.587), (122.886, -1.112), (123.752, -0.716), (124.651, -0.405), (125.576, -0.181), (126.518, -0.045),
    (127.469, 0), (187.469, 0),])
PARTNER1_WAY = shapely.geometry.LineString([
    (103.984, 30.324), (103.128, 30.792), (102.25, 31.218), (101.353, 31.602), (100.439, 31.943), (99.51, 32.24),
    (98.567, 32.493), (97.614, 32.7), (96.652, 32.862), (95.683, 32.978), (94.71, 33.047), (93.734, 33.071),
    (92.759, 33.047), (91.786, 32.978), (90.817, 32.862), (89.855, 32.7), (88.901, 32.493), (87.959, 32.24),
    (87.029, 31.943), (86.115, 31.602), (85.218, 31.218), (84.341, 30.792), (83.484, 30.324), (82.655, 29.832),
    (81.838, 29.321), (81.034, 28.79), (80.242, 28.24), (79.464, 27.672), (78.699, 27.085), (77.948, 26.48),
    (77.212, 25.858), (76.492, 25.218), (75.786, 24.561), (75.096, 23.888), (74.423, 23.198), (73.766, 22.493),
    (73.126, 21.772), (72.504, 21.036), (71.899, 20.285), (71.312, 19.521), (70.744, 18.742), (70.194, 17.951),
    (69.664, 17.146), (69.152, 16.329), (68.66, 15.5), (68.193, 14.644), (67.766, 13.766), (67.382, 12.869),
    (67.041, 11.955), (66.744, 11.026), (66.492, 10.083), (66.284, 9.13), (66.122, 8.167), (66.007, 7.199),
    (65.937, 6.225), (65.914, 5.25), (65.937, 4.275), (66.007, 3.301), (66.122, 2.333), (66.284, 1.37),
    (66.492, 0.417), (66.744, -0.526), (67.041, -1.455), (67.382, -2.369), (67.766, -3.266), (68.193, -4.144),
    (68.66, -5), (69.152, -5.829), (69.664, -6.646), (70.194, -7.451), (70.744, -8.242), (71.312, -9.021),
    (71.899, -9.785), (72.504, -10.536), (73.126, -11.272), (73.766, -11.993), (74.423, -12.698), (75.096, -13.388),
    (75.786, -14.061), (76.492, -14.718), (77.212, -15.358), (77.948, -15.98), (78.699, -16.585), (79.464, -17.172),
    (80.242, -17.74), (81.034, -18.29), (81.838, -18.821), (82.655, -19.332), (83.484, -19.824), (84.341, -20.292),
    (85.218, -20.718), (86.115, -21.102), (87.029, -21.443), (87.959, -21.74), (88.901, -21.993), (89.855, -22.2),
    (90.817, -22.362), (91.786, -22.478), (92.759, -22.547), (93.734, -22.571), (94.71, -22.547), (95.683, -22.478),
    (96.652, -22.362), (97.614, -22.2), (98.567, -21.993), (99.51, -21.74), (100.439, -21.443), (101.353, -21.102),
    (102.25, -20.718), (103.128, -20.292), (103.984, -19.824), (104.813, -19.332), (105.63, -18.821), (106.435, -18.29),
    (107.227, -17.74), (108.005, -17.172), (108.77, -16.585), (109.52, -15.98), (110.256, -15.358), (110.977, -14.718),
    (111.682, -14.061), (112.372, -13.388), (113.046, -12.698), (113.702, -11.993), (114.342, -11.272), (114.965, -10.536),
    (115.569, -9.785), (116.156, -9.021), (116.725, -8.242), (117.274, -7.451), (117.805, -6.646), (118.316, -5.829),
    (118.808, -5), (119.323, -4.199), (119.911, -3.451), (120.568, -2.763), (121.287, -2.139), (122.062, -1.587),
    (122.886, -1.112), (123.752, -0.716), (124.651, -0.405), (125.576, -0.181), (126.518, -0.045), (127.469, 0),
    (187.469, 0),])
PARTNER1_BENDS = ((0, 21.468, 11.454), (21.468, 42.673, 16.1), (42.673, 64.141, 11.454), (64.141, 85.347, 16.1), (85.347, 106.814, 11.454), (106.814, 128.02, 16.1), (128.02, 138.492, 8),)    # begin and end along it, and the most it drives there [m, m, m/s]

# ---- who does what ------------------------------------------------------------------------------------------------

behavior Partner1():    # "cp1", idm_nominal: MetaDrive's gap law
    while True:
        take drive(self, PARTNER1_WAY, follow(self, PARTNER1_WAY, PARTNER1_POLICY_TARGET_SPEED_MPS), 0, PARTNER1_BENDS)

# The system under test: replace Follow by your own behavior.
ego = new Car at place(EGO_WAY, EGO_S_M, 0), facing direction(EGO_WAY, EGO_S_M),
    with length 4.515, with width 1.852, with limits (2.909090909, 27.272727273, 15.13, 2, 3),
    with speed EGO_SPEED_MPS, with requireVisible False,
    with behavior Follow(EGO_WAY, EGO_TARGET_SPEED_MPS)

PARTNER1_S = 59.483957601 - PARTNER1_POLICY_TARGET_SPEED_MPS * ((65.171329776 - EGO_S_M) / EGO_TARGET_SPEED_MPS + PARTNER1_START_ARRIVAL_GAP_S)    # start along its way [m]
require 0 <= PARTNER1_S <= PARTNER1_WAY.length
partner1 = new Car at place(PARTNER1_WAY, PARTNER1_S, 0), facing direction(PARTNER1_WAY, PARTNER1_S),
    with length 4.87, with width 2.046, with limits (2.909090909, 27.272727273, 15.13, 2, 3),
    with speed PARTNER1_SPEED_MPS, with requireVisible False,
    with behavior Partner1()

record (distance from ego to partner1) as "centre distance to partner1"
terminate when contact(ego, partner1)
terminate when along(EGO_WAY, ego) > EGO_WAY.length - 5
terminate after DURATION_S seconds

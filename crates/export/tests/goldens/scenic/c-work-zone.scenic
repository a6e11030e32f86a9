"""
c-work-zone (Street, SV proceeding straight, CP proceeding straight, work zone). Made by recrash from crash records: 90002-1002/1. In a work zone on a left curve a truck ahead of the ego sets off late; cones stand on the right.

Not carried by Scenic's driving domain, so for information only: {"surface":"dry","lighting":"dawn_dusk","weather":"cloudy"}

Run it:
  scenic c-work-zone.scenic --2d -S --count 1 --time 300 -m scenic.simulators.newtonian.driving_model
  netconvert --opendrive-files c-work-zone.xodr -o c-work-zone.net.xml    # once, for MetaDrive
  scenic c-work-zone.scenic --2d -S --count 1 --time 300 -m scenic.simulators.metadrive.model
With `-p sweep 1` the parameters below are drawn from their ranges. Newtonian brakes with 6.8 m/s^2 at most,
and lets vehicles pass through each other. MetaDrive gets no cones: its Scenic interface has none.
"""
param map = localPath('c-work-zone.xodr')
param sumo_map = localPath('c-work-zone.net.xml')
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

EGO_S_M = 15
EGO_SPEED_MPS = 9
EGO_TARGET_SPEED_MPS = varied(10, 9, 11)    # [m/s] a test
PARTNER1_START_DELTA_S_M = varied(60, 57, 63)    # [m] a test
PARTNER1_START_DELTA_T_M = 0
PARTNER1_SPEED_MPS = 0
PARTNER1_POLICY_DEPART_STEP = 25
PARTNER1_POLICY_TARGET_SPEED_MPS = 6
PARTNER2_START_DELTA_S_M = 150
PARTNER2_START_DELTA_T_M = 0
PARTNER2_SPEED_MPS = 8
PARTNER2_POLICY_TARGET_SPEED_MPS = 9
DURATION_S = 30
OBSTACLE1_T_M = varied(2, 1.75, 2.25)    # [m] a test

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
    (0, 3.5), (10, 3.5), (80, 3.5), (80.999, 3.509), (81.997, 3.535), (82.994, 3.579),
    (83.991, 3.641), (84.986, 3.72), (85.98, 3.817), (86.972, 3.932), (87.962, 4.064), (88.949, 4.213),
    (89.934, 4.38), (90.915, 4.564), (91.893, 4.766), (92.868, 4.985), (93.838, 5.221), (94.804, 5.474),
    (95.765, 5.744), (96.722, 6.031), (97.673, 6.335), (98.619, 6.656), (99.559, 6.993), (100.492, 7.347),
    (101.42, 7.718), (102.34, 8.104), (103.254, 8.507), (104.16, 8.926), (105.059, 9.361), (105.95, 9.812),
    (106.833, 10.278), (107.708, 10.76), (108.574, 11.258), (109.431, 11.77), (110.278, 12.298), (111.117, 12.841),
    (111.945, 13.398), (112.764, 13.97), (113.572, 14.556), (114.37, 15.157), (115.157, 15.771), (115.934, 16.399),
    (116.699, 17.041), (117.452, 17.696), (118.194, 18.365), (118.924, 19.046), (119.641, 19.741), (120.347, 20.448),
    (121.039, 21.167), (121.719, 21.898), (122.386, 22.641), (123.04, 23.396), (123.68, 24.163), (124.307, 24.94),
    (124.919, 25.729), (125.518, 26.528), (126.102, 27.338), (126.672, 28.158), (127.228, 28.988), (127.769, 29.827),
    (128.294, 30.676), (128.805, 31.534), (129.301, 32.401), (129.781, 33.277), (130.245, 34.161), (130.694, 35.053),
    (131.127, 35.953), (131.544, 36.86), (131.945, 37.774), (132.33, 38.696), (132.698, 39.624), (133.05, 40.559),
    (133.385, 41.499), (133.704, 42.446), (134.006, 43.397), (134.291, 44.355), (134.559, 45.316), (134.81, 46.283),
    (135.043, 47.254), (135.26, 48.229), (135.46, 49.207), (135.642, 50.189), (149.533, 128.973),])
PARTNER1_WAY = shapely.geometry.LineString([
    (0, 0), (10, 0), (80, 0), (80.997, 0.008), (81.994, 0.033), (82.991, 0.075),
    (83.986, 0.133), (84.981, 0.207), (85.974, 0.298), (86.966, 0.406), (87.955, 0.53), (88.943, 0.67),
    (89.927, 0.827), (90.91, 1), (91.889, 1.19), (92.865, 1.395), (93.837, 1.617), (94.805, 1.855),
    (95.77, 2.109), (96.73, 2.38), (97.685, 2.666), (98.636, 2.968), (99.581, 3.285), (100.521, 3.618),
    (101.456, 3.967), (102.384, 4.332), (103.306, 4.711), (104.222, 5.106), (105.131, 5.517), (106.033, 5.942),
    (106.928, 6.382), (107.815, 6.837), (108.695, 7.307), (109.567, 7.791), (110.431, 8.29), (111.286, 8.803),
    (112.133, 9.33), (112.971, 9.871), (113.799, 10.426), (114.619, 10.994), (115.428, 11.576), (116.228, 12.172),
    (117.018, 12.781), (117.798, 13.403), (118.567, 14.037), (119.326, 14.685), (120.074, 15.345), (120.81, 16.017),
    (121.536, 16.701), (122.25, 17.398), (122.952, 18.106), (123.642, 18.826), (124.321, 19.557), (124.987, 20.299),
    (125.641, 21.052), (126.282, 21.816), (126.91, 22.591), (127.525, 23.375), (128.127, 24.17), (128.716, 24.975),
    (129.292, 25.79), (129.854, 26.614), (130.402, 27.447), (130.936, 28.289), (131.456, 29.14), (131.962, 30),
    (132.453, 30.868), (132.93, 31.744), (133.392, 32.627), (133.84, 33.519), (134.273, 34.417), (134.69, 35.323),
    (135.093, 36.235), (135.48, 37.154), (135.852, 38.08), (136.209, 39.011), (136.55, 39.948), (136.876, 40.891),
    (137.185, 41.839), (137.479, 42.792), (137.757, 43.75), (138.02, 44.712), (138.266, 45.678), (138.496, 46.649),
    (138.71, 47.623), (138.907, 48.6), (139.088, 49.581), (152.98, 128.366),])
PARTNER2_WAY = shapely.geometry.LineString([
    (146.087, 129.581), (132.195, 50.797), (132.014, 49.827), (131.816, 48.86), (131.6, 47.897), (131.365, 46.939),
    (131.113, 45.985), (130.844, 45.036), (130.556, 44.092), (130.251, 43.154), (129.929, 42.221), (129.589, 41.295),
    (129.233, 40.375), (128.859, 39.462), (128.468, 38.556), (128.06, 37.657), (127.636, 36.766), (127.195, 35.884),
    (126.738, 35.009), (126.265, 34.143), (125.776, 33.287), (125.27, 32.439), (124.749, 31.601), (124.213, 30.773),
    (123.661, 29.955), (123.094, 29.147), (122.513, 28.351), (121.916, 27.565), (121.305, 26.79), (120.68, 26.027),
    (120.04, 25.275), (119.387, 24.536), (118.72, 23.809), (118.039, 23.094), (117.346, 22.393), (116.639, 21.704),
    (115.92, 21.029), (115.188, 20.367), (114.444, 19.719), (113.688, 19.084), (112.921, 18.464), (112.142, 17.859),
    (111.352, 17.268), (110.551, 16.691), (109.739, 16.13), (108.918, 15.584), (108.086, 15.053), (107.244, 14.538),
    (106.393, 14.039), (105.533, 13.556), (104.664, 13.088), (103.786, 12.637), (102.901, 12.203), (102.007, 11.785),
    (101.105, 11.384), (100.197, 10.999), (99.281, 10.632), (98.359, 10.281), (97.43, 9.948), (96.495, 9.632),
    (95.555, 9.334), (94.609, 9.053), (93.658, 8.79), (92.702, 8.545), (91.742, 8.317), (90.778, 8.107),
    (89.81, 7.916), (88.839, 7.742), (87.864, 7.587), (86.887, 7.449), (85.908, 7.33), (84.926, 7.229),
    (83.943, 7.147), (82.959, 7.083), (81.973, 7.037), (80.987, 7.009), (80, 7), (10, 7),
    (0, 7),])
PARTNER1_BENDS = ((80, 163.776, 10.954),)    # begin and end along it, and the most it drives there [m, m, m/s]
PARTNER2_BENDS = ((80, 154.002, 18.417),)    # begin and end along it, and the most it drives there [m, m, m/s]

# ---- who does what ------------------------------------------------------------------------------------------------

behavior Partner1():    # "truck", stopped: stands, then sets off
    try:
        while True:
            take drive(self, PARTNER1_WAY, hold(self, PARTNER1_POLICY_TARGET_SPEED_MPS), PARTNER1_START_DELTA_T_M, PARTNER1_BENDS)
    interrupt when 0 <= seconds() + 1e-6 < PARTNER1_POLICY_DEPART_STEP * STEP:
        take drive(self, PARTNER1_WAY, -1, PARTNER1_START_DELTA_T_M, PARTNER1_BENDS)

behavior Partner2():    # "oncoming", idm_nominal: MetaDrive's gap law
    while True:
        take drive(self, PARTNER2_WAY, follow(self, PARTNER2_WAY, PARTNER2_POLICY_TARGET_SPEED_MPS), PARTNER2_START_DELTA_T_M, PARTNER2_BENDS)

# The system under test: replace Follow by your own behavior.
ego = new Car at place(EGO_WAY, EGO_S_M, 0), facing direction(EGO_WAY, EGO_S_M),
    with length 4.515, with width 1.852, with limits (2.909090909, 27.272727273, 15.13, 2, 3),
    with speed EGO_SPEED_MPS, with requireVisible False,
    with behavior Follow(EGO_WAY, EGO_TARGET_SPEED_MPS)

PARTNER1_S = EGO_S_M + PARTNER1_START_DELTA_S_M    # start along its way [m]
require 0 <= PARTNER1_S <= PARTNER1_WAY.length
partner1 = new Car at place(PARTNER1_WAY, PARTNER1_S, PARTNER1_START_DELTA_T_M), facing direction(PARTNER1_WAY, PARTNER1_S),
    with length 9.1, with width 2.4, with limits (1.1, 6, 6, 2, 3),
    with speed PARTNER1_SPEED_MPS, with requireVisible False,
    with behavior Partner1()

PARTNER2_S = 238.88888219 - (EGO_S_M + PARTNER2_START_DELTA_S_M)    # start along its way [m]
require 0 <= PARTNER2_S <= PARTNER2_WAY.length
partner2 = new Car at place(PARTNER2_WAY, PARTNER2_S, PARTNER2_START_DELTA_T_M), facing direction(PARTNER2_WAY, PARTNER2_S),
    with length 4.515, with width 1.852, with limits (2.909090909, 27.272727273, 15.13, 2, 3),
    with speed PARTNER2_SPEED_MPS, with requireVisible False,
    with behavior Partner2()

if not IN_METADRIVE:
    new Object at place(EGO_WAY, 45, OBSTACLE1_T_M), facing direction(EGO_WAY, 45), with length 0.4, with width 0.4,
        with requireVisible False, with regionContainedIn everywhere    # cone
    new Object at place(EGO_WAY, 50, 2), facing direction(EGO_WAY, 50), with length 0.4, with width 0.4,
        with requireVisible False, with regionContainedIn everywhere    # cone
    new Object at place(EGO_WAY, 95, 1.95), facing direction(EGO_WAY, 95), with length 0.4, with width 0.4,
        with requireVisible False, with regionContainedIn everywhere    # cone
    new Object at place(EGO_WAY, 130, 5.5), facing direction(EGO_WAY, 130), with length 0.3, with width 2,
        with requireVisible False, with regionContainedIn everywhere    # barrier
    new Object at place(EGO_WAY, 30, 6.5), facing direction(EGO_WAY, 30), with length 1, with width 1,
        with requireVisible False, with regionContainedIn everywhere    # warning sign

record (distance from ego to partner1) as "centre distance to partner1"
terminate when contact(ego, partner1)
record (distance from ego to partner2) as "centre distance to partner2"
terminate when contact(ego, partner2)
terminate when along(EGO_WAY, ego) > EGO_WAY.length - 5
terminate after DURATION_S seconds

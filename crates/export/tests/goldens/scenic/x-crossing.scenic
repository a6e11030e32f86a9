"""
x-crossing (Intersection, SV proceeding straight, CP proceeding straight). Made by recrash from crash records: 90003-1003/2. A car from the left enters the intersection at speed and crosses the way of the ego.

Not carried by Scenic's driving domain, so for information only: {"surface":"dry","lighting":"daylight","weather":"clear"}

Run it:
  scenic x-crossing.scenic --2d -S --count 1 --time 300 -m scenic.simulators.newtonian.driving_model
  netconvert --opendrive-files x-crossing.xodr -o x-crossing.net.xml    # once, for MetaDrive
  scenic x-crossing.scenic --2d -S --count 1 --time 300 -m scenic.simulators.metadrive.model
With `-p sweep 1` the parameters below are drawn from their ranges. Newtonian brakes with 6.8 m/s^2 at most,
and lets vehicles pass through each other. MetaDrive gets no cones: its Scenic interface has none.
"""
param map = localPath('x-crossing.xodr')
param sumo_map = localPath('x-crossing.net.xml')
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

EGO_S_M = 5
EGO_SPEED_MPS = 8
EGO_TARGET_SPEED_MPS = varied(8.3, 7.300000000000001, 9.3)    # [m/s] a test
PARTNER1_START_ARRIVAL_GAP_S = varied(-0.4, -0.9, 0.09999999999999998)    # [s] a test
PARTNER1_SPEED_MPS = 9
PARTNER1_POLICY_ACCEL_MAG = 0.6
PARTNER1_POLICY_ACCEL_STEPS = 10
PARTNER1_POLICY_CRUISE_SPEED = 9.5
PARTNER1_POLICY_BRAKE_STEP = 75
PARTNER1_POLICY_BRAKE_STEPS = 20
DURATION_S = 30

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
    (0, 0), (10, 0), (60, 0), (90.5, 0), (170.5, 0),])
PARTNER1_WAY = shapely.geometry.LineString([
    (70, 100.5), (70, 20.5), (70, -10), (70, -90),])

# ---- who does what ------------------------------------------------------------------------------------------------

behavior Partner1():    # "cp1", accel_then_brake: a throttle, a speed, full brake for a while, the speed again
    try:
        while True:
            take drive(self, PARTNER1_WAY, hold(self, PARTNER1_POLICY_CRUISE_SPEED), 0, ())
    interrupt when 0 <= seconds() + 1e-6 < PARTNER1_POLICY_ACCEL_STEPS * STEP:
        take drive(self, PARTNER1_WAY, PARTNER1_POLICY_ACCEL_MAG, 0, ())
    interrupt when PARTNER1_POLICY_BRAKE_STEP * STEP <= seconds() + 1e-6 < PARTNER1_POLICY_BRAKE_STEP * STEP + PARTNER1_POLICY_BRAKE_STEPS * STEP:
        take drive(self, PARTNER1_WAY, -1, 0, ())

# The system under test: replace Follow by your own behavior.
ego = new Car at place(EGO_WAY, EGO_S_M, 0), facing direction(EGO_WAY, EGO_S_M),
    with length 4.515, with width 1.852, with limits (2.909090909, 27.272727273, 15.13, 2, 3),
    with speed EGO_SPEED_MPS, with requireVisible False,
    with behavior Follow(EGO_WAY, EGO_TARGET_SPEED_MPS)

PARTNER1_S = 100.5 - PARTNER1_POLICY_CRUISE_SPEED * ((70 - EGO_S_M) / EGO_TARGET_SPEED_MPS + PARTNER1_START_ARRIVAL_GAP_S)    # start along its way [m]
require 0 <= PARTNER1_S <= PARTNER1_WAY.length
partner1 = new Car at place(PARTNER1_WAY, PARTNER1_S, 0), facing direction(PARTNER1_WAY, PARTNER1_S),
    with length 4.515, with width 1.852, with limits (2.909090909, 27.272727273, 15.13, 2, 3),
    with speed PARTNER1_SPEED_MPS, with requireVisible False,
    with behavior Partner1()

record (distance from ego to partner1) as "centre distance to partner1"
terminate when contact(ego, partner1)
terminate when along(EGO_WAY, ego) > EGO_WAY.length - 5
terminate after DURATION_S seconds

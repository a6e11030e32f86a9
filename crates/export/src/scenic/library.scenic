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

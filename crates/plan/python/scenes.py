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

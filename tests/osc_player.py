"""Plays the partners of an exported OpenSCENARIO file on its OpenDRIVE map: a second reading, with no code of recrash.

It knows the subset that `docs/formats/coverage.md` lists, and refuses whatever else it meets. Reactions to other road
users do not exist in it, as in the files: time triggers alone make things happen.
"""

import ast
import math
import operator
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

STEP_S = 0.02
#: Share of the way after a share of the time.
SHAPES = {
    "linear": lambda x: x,
    "cubic": lambda x: x * x * (3 - 2 * x),
    "sinusoidal": lambda x: 0.5 - 0.5 * math.cos(math.pi * x),
}
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}


@dataclass
class Road:
    """One road of the map: a line or an arc, and its lanes."""

    id: str
    x: float
    y: float
    heading: float
    length: float
    curvature: float
    junction: str
    predecessor: tuple[str, str] | None
    successor: tuple[str, str] | None
    widths: dict[int, float]

    def point(self, s: float, t: float) -> tuple[float, float, float]:
        """Position and heading at s along the reference line and t to its left."""
        heading = self.heading + s * self.curvature
        if self.curvature == 0:
            x, y = self.x + s * math.cos(heading), self.y + s * math.sin(heading)
        else:
            x = self.x + (math.sin(heading) - math.sin(self.heading)) / self.curvature
            y = self.y - (math.cos(heading) - math.cos(self.heading)) / self.curvature
        return x - t * math.sin(heading), y + t * math.cos(heading), heading

    def lane_centre(self, lane: int) -> float:
        """t of a lane's centre."""
        side = 1 if lane > 0 else -1
        inner = sum(self.widths[side * number] for number in range(1, abs(lane)))
        return side * (inner + self.widths[lane] / 2)


class DriveMap:
    """An OpenDRIVE file."""

    def __init__(self, path: Path) -> None:
        root = ElementTree.parse(path).getroot()
        self.roads: dict[str, Road] = {}
        for element in root.findall("road"):
            (geometry,) = element.findall("planView/geometry")
            arc = geometry.find("arc")
            assert arc is not None or geometry.find("line") is not None, "lines and arcs only"
            (section,) = element.findall("lanes/laneSection")
            widths = {int(lane.get("id")): float(lane.find("width").get("a")) for lane in section.iter("lane") if lane.get("id") != "0"}
            self.roads[element.get("id")] = Road(
                element.get("id"), float(geometry.get("x")), float(geometry.get("y")), float(geometry.get("hdg")),
                float(geometry.get("length")), 0.0 if arc is None else float(arc.get("curvature")), element.get("junction"),
                self.link(element, "predecessor"), self.link(element, "successor"), widths,
            )
        self.connections = {
            junction.get("id"): [
                (connection.get("incomingRoad"), connection.get("connectingRoad"),
                 {int(link.get("from")): int(link.get("to")) for link in connection.findall("laneLink")})
                for connection in junction.findall("connection")
            ]
            for junction in root.findall("junction")
        }
        self.lane_links = {
            (road.get("id"), int(lane.get("id")), end): int(link.get("id"))
            for road in root.findall("road")
            for lane in road.iter("lane")
            for end in ("predecessor", "successor")
            if (link := lane.find(f"link/{end}")) is not None
        }

    @staticmethod
    def link(road: ElementTree.Element, end: str) -> tuple[str, str] | None:
        link = road.find(f"link/{end}")
        return None if link is None else (link.get("elementType"), link.get("elementId"))

    def next(self, road: str, lane: int, towards: str | None) -> tuple[str, int] | None:
        """The road and lane behind the end that a lane is driven to; `towards` chooses the way through a junction."""
        end = "successor" if lane < 0 else "predecessor"
        link = getattr(self.roads[road], end)
        if link is None:
            return None
        kind, target = link
        if kind == "road":
            return target, self.lane_links[road, lane, end]
        for incoming, connecting, lanes in self.connections[target]:
            # Every connecting road is driven along its reference line.
            if incoming == road and lane in lanes and self.roads[connecting].successor == ("road", towards):
                return connecting, lanes[lane]
        raise AssertionError(f"no way from road {road} lane {lane} to road {towards}")


class Parameters:
    """Values of the declared parameters, and expressions of them."""

    def __init__(self, root: ElementTree.Element) -> None:
        self.values = {p.get("name"): p.get("value") for p in root.iter("ParameterDeclaration")}

    def number(self, text: str) -> float:
        if text.startswith("${"):
            for name in sorted(self.values, key=len, reverse=True):
                text = text.replace(f"${name}", self.values[name])
            return self.evaluate(ast.parse(text[2:-1], mode="eval").body)
        return float(self.values[text[1:]] if text.startswith("$") else text)

    def evaluate(self, node: ast.expr) -> float:
        if isinstance(node, ast.BinOp):
            return OPERATORS[type(node.op)](self.evaluate(node.left), self.evaluate(node.right))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return -self.evaluate(node.operand)
        assert isinstance(node, ast.Constant), ast.dump(node)
        return float(node.value)


class Line:
    """A polyline of positions and headings."""

    def __init__(self, polyline: ElementTree.Element) -> None:
        at = [vertex.find("Position/WorldPosition") for vertex in polyline.findall("Vertex")]
        self.points = [tuple(float(position.get(key)) for key in "xyh") for position in at]
        self.times = [float(vertex.get("time", "nan")) for vertex in polyline.findall("Vertex")]
        self.ends = [0.0]
        for a, b in zip(self.points, self.points[1:]):
            self.ends.append(self.ends[-1] + math.dist(a[:2], b[:2]))

    def centre(self, along: float, to_centre: float, measure: list[float] | None = None) -> tuple[float, float]:
        """The centre of a box whose reference point is so far along: in metres, or by another measure of the vertices."""
        measure = measure or self.ends
        k = next((k for k in range(1, len(measure) - 1) if along < measure[k]), len(measure) - 1)
        share = min(max((along - measure[k - 1]) / (measure[k] - measure[k - 1]), 0.0), 1.0)
        (xa, ya, ha), (xb, yb, hb) = self.points[k - 1], self.points[k]
        heading = ha + math.remainder(hb - ha, math.tau) * share
        x, y = xa + (xb - xa) * share, ya + (yb - ya) * share
        return x + to_centre * math.cos(heading), y + to_centre * math.sin(heading)


@dataclass
class Player:
    """One partner while it is played."""

    drive_map: DriveMap
    route: list[str]
    to_centre: float
    road: str
    lane: int
    s: float
    left: float
    speed: float
    speed_plan: list[tuple[float, float]] = field(default_factory=list)
    lateral_plan: tuple[float, float, float, float, str] | None = None
    #: Speed to the left of its lane. [m/s]
    sideways: float = 0.0
    #: The line it follows instead of its lane, and how far along that it is. [m]
    line: "Line | None" = None
    along: float = 0.0
    ended: bool = False

    def pose(self) -> tuple[float, float]:
        """Centre of its box."""
        if self.line:
            return self.line.centre(self.along, self.to_centre)
        road = self.drive_map.roads[self.road]
        sign = 1 if self.lane < 0 else -1
        x, y, heading = road.point(self.s, road.lane_centre(self.lane) + sign * self.left)
        heading += 0 if self.lane < 0 else math.pi
        # It faces the way it moves.
        heading += math.atan2(self.sideways, self.speed) if self.speed > 0 else 0
        return x + self.to_centre * math.cos(heading), y + self.to_centre * math.sin(heading)

    def advance(self, now: float) -> None:
        before = self.speed
        self.speed = self.planned_speed(now + STEP_S)
        if self.lateral_plan:
            begin, duration, start, target, shape = self.lateral_plan
            share = min((now + STEP_S - begin) / duration, 1.0)
            before_left, self.left = self.left, start + (target - start) * SHAPES[shape](share)
            self.sideways = (self.left - before_left) / STEP_S
        way = 0.5 * (before + self.speed) * STEP_S
        if self.line:
            self.along += way
            self.ended = self.along > self.line.ends[-1]
        else:
            self.move(math.sqrt(max(way**2 - (self.sideways * STEP_S) ** 2, 0.0)))

    def planned_speed(self, now: float) -> float:
        plan = self.speed_plan
        if not plan or now <= plan[0][0]:
            return self.speed if not plan else plan[0][1]
        for (t0, v0), (t1, v1) in zip(plan, plan[1:]):
            if now <= t1:
                return v0 + (v1 - v0) * (now - t0) / (t1 - t0)
        return plan[-1][1]

    def move(self, distance: float) -> None:
        while distance > 0 and not self.ended:
            road = self.drive_map.roads[self.road]
            sign = 1 if self.lane < 0 else -1
            # A metre of the lane is more or less than a metre of the reference line.
            scale = 1 - (road.lane_centre(self.lane) + sign * self.left) * road.curvature
            left_over = (road.length - self.s if self.lane < 0 else self.s) * scale
            if distance < left_over:
                self.s += sign * distance / scale
                return
            distance -= left_over
            while self.road in self.route[:1]:
                self.route.pop(0)
            following = self.drive_map.next(self.road, self.lane, self.route[0] if self.route else None)
            if following is None:
                self.ended = True
                return
            self.road, self.lane = following
            self.s = 0.0 if self.lane < 0 else self.drive_map.roads[self.road].length


def play(scenario: Path, seconds: float) -> dict[str, list[tuple[float, float]]]:
    """Positions of every partner's centre each 0.1 s, until its road ends."""
    root = ElementTree.parse(scenario).getroot()
    drive_map = DriveMap(scenario.parent / root.find("RoadNetwork/LogicFile").get("filepath"))
    parameters = Parameters(root)
    tracks = {}
    for entity in root.findall("Entities/ScenarioObject"):
        name = entity.get("name")
        if name == "ego" or name.startswith("obstacle."):
            continue
        to_centre = float(entity.find(".//BoundingBox/Center").get("x"))
        init = root.find(f"Storyboard/Init/Actions/Private[@entityRef='{name}']")
        events = [
            event
            for group in root.iter("ManeuverGroup")
            if [ref.get("entityRef") for ref in group.findall("Actors/EntityRef")] == [name]
            for event in group.iter("Event")
        ]
        recorded = next((event for event in events if event.find(".//TimeReference/Timing") is not None), None)
        if recorded is not None:
            tracks[name] = replay(Line(recorded.find(".//Polyline")), to_centre)
        else:
            tracks[name] = act(drive_map, parameters, init, events, to_centre, seconds)
    return tracks


def replay(line: Line, to_centre: float) -> list[tuple[float, float]]:
    """Centres on a recorded line each 0.1 s."""
    return [line.centre(0.1 * step, to_centre, line.times) for step in range(round(line.times[-1] / 0.1) + 1)]


def act(drive_map, parameters, init, events, to_centre, seconds):
    route = [p.get("roadId") for p in init.findall(".//Waypoint/Position/LanePosition")]
    place = init.find(".//TeleportAction/Position/LanePosition")
    if place is None:
        # Its rear axle is still behind the beginning of the first road.
        first, at = init.find(".//Waypoint/Position/LanePosition"), init.find(".//TeleportAction/Position/WorldPosition")
        lane, offset = int(first.get("laneId")), 0.0
        x, y, heading = drive_map.roads[route[0]].point(parameters.number(first.get("s")), 0.0)
        s = parameters.number(first.get("s")) + (float(at.get("x")) - x) * math.cos(heading) + (float(at.get("y")) - y) * math.sin(heading)
        road = route[0]
    else:
        road, lane = place.get("roadId"), int(place.get("laneId"))
        s, offset = parameters.number(place.get("s")), parameters.number(place.get("offset"))
    player = Player(
        drive_map, route, to_centre, road, lane, s, offset if lane < 0 else -offset,
        parameters.number(init.find(".//AbsoluteTargetSpeed").get("value")),
    )
    waiting = []
    for event in events:
        times = [parameters.number(c.get("value")) for c in event.iter("SimulationTimeCondition")]
        if times:
            waiting.append((times[0], event))
    waiting.sort(key=lambda item: item[0])
    track, steps = [], round(seconds / STEP_S)
    for step in range(steps + 1):
        now = step * STEP_S
        while waiting and waiting[0][0] <= now + 1e-9:
            begin(player, parameters, waiting.pop(0)[1], now)
        if player.ended:
            break
        if step % 5 == 0:
            track.append(player.pose())
        player.advance(now)
    return track


def begin(player: Player, parameters: Parameters, event: ElementTree.Element, now: float) -> None:
    action = event.find("Action/PrivateAction")
    profile, speed, change = action.find(".//SpeedProfileAction"), action.find(".//SpeedAction"), action.find(".//LaneChangeAction")
    follow = action.find(".//FollowTrajectoryAction")
    if follow is not None:
        assert follow.find("TimeReference/None") is not None
        player.line, player.along = Line(follow.find(".//Polyline")), parameters.number(follow.get("initialDistanceOffset"))
    elif profile is not None:
        plan, time = [(now, player.speed)], now
        for entry in profile.findall("SpeedProfileEntry"):
            time += parameters.number(entry.get("time"))
            plan.append((time, parameters.number(entry.get("speed"))))
        player.speed_plan = plan
    elif speed is not None:
        dynamics = speed.find("SpeedActionDynamics")
        target = parameters.number(speed.find(".//AbsoluteTargetSpeed").get("value"))
        value = parameters.number(dynamics.get("value"))
        if dynamics.get("dynamicsShape") == "step":
            player.speed, player.speed_plan = target, [(now, target)]
            return
        assert dynamics.get("dynamicsShape") == "linear"
        duration = value if dynamics.get("dynamicsDimension") == "time" else abs(target - player.speed) / value
        player.speed_plan = [(now, player.speed), (now + max(duration, 1e-6), target)]
    elif change is not None:
        dynamics = change.find("LaneChangeActionDynamics")
        absolute, relative = change.find(".//AbsoluteTargetLane"), change.find(".//RelativeTargetLane")
        offset = parameters.number(change.get("targetLaneOffset"))
        road = player.drive_map.roads[player.road]
        if absolute is not None:
            target = road.lane_centre(int(absolute.get("value"))) - road.lane_centre(player.lane)
        else:
            assert relative.get("value") == "0", "only within its lane"
            target = 0.0
        # Offsets are in the road's direction.
        target = target + offset if player.lane < 0 else -target - offset
        player.lateral_plan = (now, parameters.number(dynamics.get("value")), player.left, target, dynamics.get("dynamicsShape"))
    else:
        raise AssertionError(f"an action this player does not know: {ElementTree.tostring(action)[:200]}")

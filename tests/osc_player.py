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
    lateral_plan: tuple[float, float, float, float] | None = None
    #: Speed to the left of its lane. [m/s]
    sideways: float = 0.0
    ended: bool = False

    def pose(self) -> tuple[float, float]:
        """Centre of its box."""
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
            begin, duration, start, target = self.lateral_plan
            share = (now + STEP_S - begin) / duration
            self.left = start + (target - start) * min(share, 1.0)
            self.sideways = (target - start) / duration if share < 1 else 0.0
        self.move(0.5 * (before + self.speed) * STEP_S)

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
        polyline = next((event.find(".//Polyline") for event in events if event.find(".//Polyline") is not None), None)
        if polyline is not None:
            tracks[name] = replay(polyline, to_centre)
        else:
            tracks[name] = act(drive_map, parameters, init, events, to_centre, seconds)
    return tracks


def replay(polyline: ElementTree.Element, to_centre: float) -> list[tuple[float, float]]:
    """Centres on a recorded polyline whose vertices lie 0.1 s apart."""
    points = []
    for number, vertex in enumerate(polyline.findall("Vertex")):
        assert abs(float(vertex.get("time")) - 0.1 * number) < 1e-9
        at = vertex.find("Position/WorldPosition")
        x, y, h = (float(at.get(key)) for key in "xyh")
        points.append((x + to_centre * math.cos(h), y + to_centre * math.sin(h)))
    return points


def act(drive_map, parameters, init, events, to_centre, seconds):
    place = init.find(".//TeleportAction/Position/LanePosition")
    lane = int(place.get("laneId"))
    offset = parameters.number(place.get("offset"))
    route = [p.get("roadId") for p in init.findall(".//Waypoint/Position/LanePosition")]
    player = Player(
        drive_map, route, to_centre, place.get("roadId"), lane, parameters.number(place.get("s")),
        offset if lane < 0 else -offset, parameters.number(init.find(".//AbsoluteTargetSpeed").get("value")),
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
    if profile is not None:
        plan, time = [(now, player.speed)], now
        for entry in profile.findall("SpeedProfileEntry"):
            time += float(entry.get("time"))
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
        lanes_left = int(change.find(".//RelativeTargetLane").get("value"))
        offset = parameters.number(change.get("targetLaneOffset"))
        width = player.drive_map.roads[player.road].widths[player.lane]
        # Lanes are counted from the one it is on by now; offsets are in the road's direction.
        on_lane = round(player.left / width)
        target = (on_lane + lanes_left) * width + (offset if player.lane < 0 else -offset)
        player.lateral_plan = (now, parameters.number(dynamics.get("value")), player.left, target)
    else:
        raise AssertionError(f"an action this player does not know: {ElementTree.tostring(action)[:200]}")

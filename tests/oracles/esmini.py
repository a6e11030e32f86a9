"""esmini, where its binary is at hand: plays exported OpenSCENARIO with our recorded ego in the slot for the system under test."""

import math
import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

from exports import Export
from osc_player import play

#: Columns of an object in esmini's CSV log, and those that are read.
COLUMNS, TO_CENTRE, X, Y, HEADING = 31, 5, 11, 12, 24
#: A line of its log that tells of a contact.
COLLISION = r"\[([\d.]+)\] \[warn\] Collision between (.*) and (.*)"


@dataclass(frozen=True)
class Played:
    """One file, played to its end."""

    exit_code: int
    errors: list[str]
    #: The greatest distance of a partner's centre from ours until first contact or the end of its road; in all, and in the
    #: first 5 s. [m]
    off_m: float
    off_5_s_m: float
    #: First contact of the ego, there and here. [s]
    contact_s: float | None
    our_contact_s: float | None


def find() -> str | None:
    """The binary, from $ESMINI_BIN."""
    return os.environ.get("ESMINI_BIN")


def version(esmini: str) -> str:
    done = subprocess.run([esmini, "--version"], capture_output=True, text=True, timeout=60)
    found = re.search(r"\d+\.\d+\.\d+", done.stdout)
    return found.group(0) if found else "of an unnamed build"


@dataclass(frozen=True)
class Scene:
    """A scene with plans, played to its end as it was recorded."""

    exit_code: int
    errors: list[str]
    #: The greatest distance of a road user's centre from ours, until its first contact. [m]
    off_m: float
    #: When the whole recording ended here, and there. [s]
    our_end_s: float
    end_s: float
    #: The ego's first contact, a part counted as what it is a part of: when [s] and with whom.
    contact: tuple[float, str] | None
    our_contact: tuple[float, str] | None


def play_scene(esmini: str, export: Export, folder: Path) -> Scene:
    exit_code, text, states = run_to_the_end(esmini, export.path("openscenario", ".xosc"), folder)
    tracks = read_states(states)
    off = [
        distance
        for actor in export.rollout["actors"]
        for _, distance in distances(export, actor, tracks[actor["id"]], len(actor["states"]))
    ]
    return Scene(
        exit_code,
        [line for line in text.splitlines() if "[error]" in line],
        max(off),
        0.1 * (len(export.rollout["actors"][0]["states"]) - 1),
        max(tracks["ego"]) / 100,
        next(iter(contacts_of_ego(export, text)), None),
        next(iter(our_contacts_of_ego(export)), None),
    )


def contacts_of_ego(export: Export, log: str) -> list[tuple[float, str]]:
    """What esmini says, in order; a touch of one's own parts is none."""
    actors = export.rollout["actors"]
    host = {actor["id"]: actors[actor.get("part_of", number)]["id"] for number, actor in enumerate(actors)}
    found = []
    for time, *pair in re.findall(COLLISION, log):
        a, b = sorted((host.get(name, name) for name in pair), key=lambda name: name != "ego")
        if a == "ego" != b:
            found.append((float(time), b))
    return found


def our_contacts_of_ego(export: Export) -> list[tuple[float, str]]:
    """The same in our rollout."""
    found = []
    for event in export.rollout["events"]:
        kind = event["kind"]
        if 0 in (kind.get("a"), kind.get("b")):
            other = kind["b"] if kind["a"] == 0 else kind["a"]
            found.append((event["time_s"], export.rollout["actors"][other]["id"]))
        elif kind.get("actor") == 0 and "obstacle" in kind:
            found.append((event["time_s"], f"obstacle.{kind['obstacle'] + 1}"))
    return found


def run_to_the_end(esmini: str, source: Path, folder: Path) -> tuple[int, str, Path]:
    """The exit code, the text of the log, and the file with all states."""
    log, states = folder / "esmini.log", folder / "esmini.csv"
    command = [esmini, "--osc", str(source), "--headless", "--fixed_timestep", "0.01", "--collision", "--disable_stdout",
               "--csv_logger", str(states), "--logfile_path", str(log), "--seed", "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    return done.returncode, log.read_text(), states


def play_with_our_ego(esmini: str, export: Export, scenario: Path, folder: Path) -> Played:
    # Beside the original, because it names its map by a relative path.
    source = scenario.with_name(f"{export.id}.played.xosc")
    put_in_the_slot(export, scenario, source)
    exit_code, text, states = run_to_the_end(esmini, source, folder)
    source.unlink()
    theirs = [float(time) for time, a, b in re.findall(COLLISION, text) if "ego" in (a, b) and "obstacle." not in a + b]
    ours = [event["time_s"] for event in export.rollout["events"] if 0 in (event["kind"].get("a"), event["kind"].get("b"))]
    until_s = min(theirs[0] if theirs else math.inf, 0.1 * (len(export.rollout["actors"][0]["states"]) - 1))
    tracks, until_road_ends = read_states(states), play(scenario, until_s)
    off = [
        distance
        for actor in export.partners()
        for distance in distances(export, actor, tracks[actor["id"]], len(until_road_ends[actor["id"]]))
    ]
    return Played(
        exit_code,
        [line for line in text.splitlines() if "[error]" in line],
        max(distance for _, distance in off),
        max(distance for time, distance in off if time <= 5),
        theirs[0] if theirs else None,
        ours[0] if ours else None,
    )


def put_in_the_slot(export: Export, scenario: Path, target: Path) -> None:
    """The ego's own action gives way to the trajectory that our ego drove."""
    tree = ElementTree.parse(scenario)
    root = tree.getroot()
    to_centre = float(root.find("Entities/ScenarioObject[@name='ego']//BoundingBox/Center").get("x"))
    action = root.find("Storyboard/Story[@name='ego: story']//Event/Action")
    action.remove(action.find("PrivateAction"))
    follow = below(action, "PrivateAction", "RoutingAction", "FollowTrajectoryAction")
    trajectory = ElementTree.SubElement(follow, "Trajectory", name="ego", closed="false")
    polyline = below(trajectory, "Shape", "Polyline")
    for time, state in ego_until_contact(export):
        x = state["x"] - to_centre * math.cos(state["heading"])
        y = state["y"] - to_centre * math.sin(state["heading"])
        position = below(ElementTree.SubElement(polyline, "Vertex", time=f"{time:.2f}"), "Position")
        ElementTree.SubElement(position, "WorldPosition", x=f"{x:.6f}", y=f"{y:.6f}", z="0", h=f"{state['heading']:.6f}")
    ElementTree.SubElement(below(follow, "TimeReference"), "Timing", domainAbsoluteRelative="absolute", scale="1", offset="0")
    ElementTree.SubElement(follow, "TrajectoryFollowingMode", followingMode="position")
    tree.write(target)


def ego_until_contact(export: Export) -> list[tuple[float, dict]]:
    """Times and states of our ego. After its first contact, if any, it goes on as it came: what the contact did to it does not
    happen where there is none."""
    states = [(0.1 * step, state) for step, state in enumerate(export.rollout["actors"][0]["states"])]
    found = next(((e["time_s"], e["kind"]["a_state"]) for e in export.rollout["events"] if e["kind"].get("a") == 0), None)
    if found is None:
        return states
    at, contact = found
    before = [(time, state) for time, state in states if time < at - 1e-6]
    turning = math.remainder(contact["heading"] - before[-1][1]["heading"], math.tau) / (at - before[-1][0])
    goes_on = []
    for after in (0.1, 0.2, 0.3, 0.4, 0.5):
        along = math.atan2(contact["vy"], contact["vx"]) + 0.5 * turning * after
        way = math.hypot(contact["vx"], contact["vy"]) * after
        goes_on.append((at + after, {
            "x": contact["x"] + way * math.cos(along), "y": contact["y"] + way * math.sin(along),
            "heading": contact["heading"] + turning * after,
        }))
    return [*before, found, *goes_on]


def below(element: ElementTree.Element, *names: str) -> ElementTree.Element:
    for name in names:
        element = ElementTree.SubElement(element, name)
    return element


def read_states(path: Path) -> dict[str, dict[int, tuple[float, float]]]:
    """Centres by object and hundredth of a second."""
    tracks: dict[str, dict[int, tuple[float, float]]] = {}
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.split(",")]
        if not cells[0].isdigit():
            continue
        for first in range(2, len(cells) - COLUMNS + 1, COLUMNS):
            to_centre, x, y, heading = (float(cells[first + column]) for column in (TO_CENTRE, X, Y, HEADING))
            centre = (x + to_centre * math.cos(heading), y + to_centre * math.sin(heading))
            tracks.setdefault(cells[first], {})[round(float(cells[1]) * 100)] = centre
    return tracks


def distances(export: Export, actor: dict, track: dict, most_steps: int) -> list[tuple[float, float]]:
    """Time and distance from ours, at each step until contact or the end of its road."""
    steps = range(min(export.steps_until_contact(actor["id"]), most_steps))
    found = [
        (0.1 * step, math.dist(track[10 * step], (state["x"], state["y"])))
        for step, state in zip(steps, actor["states"])
        if 10 * step in track
    ]
    assert found, f"{export} {actor['id']}"
    return found


def table(esmini: str, rows: list[tuple[Export, Played, Played]]) -> str:
    """The results as a page for the docs."""
    lines = [
        f"Played by esmini {version(esmini)} with `--fixed_timestep 0.01 --collision`. Distances are between centres, until first "
        "contact or the end of the road. No file made it end with another exit code than 0, or write a line with `[error]`.",
        "",
        "| suite | scenario | partners | acting, first 5 s [m] | acting [m] | recorded [m] | contact [s] | esmini, acting [s] | esmini, recorded [s] |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    time = lambda value: "-" if value is None else f"{value:.2f}"
    for export, acting, recorded in rows:
        assert acting.errors == recorded.errors == [] and acting.exit_code == recorded.exit_code == 0, export
        kinds = ", ".join(f"{p['kind'].replace('_', ' ')}, {p['turn']}" for p in export.scenario["partners"])
        lines.append(
            f"| {export.suite} | {export.id} | {kinds} | {acting.off_5_s_m:.2f} | {acting.off_m:.2f} | {recorded.off_m:.2f} "
            f"| {time(acting.our_contact_s)} | {time(acting.contact_s)} | {time(recorded.contact_s)} |"
        )
    return "\n".join(lines) + "\n"


def alike(scene: Scene) -> bool:
    """Whether the ego first touches the same, a tenth of a second (a step of ours) apart at most; or nobody in both."""
    if scene.contact is None or scene.our_contact is None:
        return scene.contact == scene.our_contact
    return scene.contact[1] == scene.our_contact[1] and abs(scene.contact[0] - scene.our_contact[0]) <= 0.1 + 1e-6


def table_of_scenes(rows: list[tuple[Export, Scene]]) -> str:
    """How the scenes were played, in words, and those with a contact as a table."""
    same = sum(alike(scene) for _, scene in rows)
    lines = [
        f"{len(rows)} scenes: each played to its end; the farthest road user {max(scene.off_m for _, scene in rows):.2f} m off before its "
        f"first contact; the ego's first contact, or that there is none, agrees in {same} ({100 * same / len(rows):.1f} %).",
        "",
        "| scene | farthest [m] | contact here | contact in esmini |",
        "|---|---|---|---|",
    ]
    told = lambda contact: "-" if contact is None else f"{contact[1]} at {contact[0]:.2f} s"
    for export, scene in rows:
        if scene.contact or scene.our_contact:
            lines.append(f"| {export.id} | {scene.off_m:.2f} | {told(scene.our_contact)} | {told(scene.contact)} |")
    return "\n".join(lines) + "\n"

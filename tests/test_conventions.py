"""The table of `docs/formats/conventions.md`, held against what is exported."""

import json
import math
import xml.etree.ElementTree as ElementTree

import pytest
from exports import ROOT, Export
from oracles import Answering
from osc_player import DriveMap, Parameters


@pytest.fixture(scope="module")
def crossing(cases: list[Export]) -> Export:
    return next(export for export in cases if export.id == "x-crossing")


@pytest.fixture(scope="module")
def table() -> dict[str, tuple[float, float, float]]:
    """x, y and heading of the start, per format."""
    rows = {}
    for line in (ROOT / "docs" / "formats" / "conventions.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 9 and cells[0] not in ("format", "---"):
            rows[cells[0]] = (float(cells[2]), float(cells[3]), float(cells[5]))
    assert set(rows) == {"recrash", "openscenario", "scenic", "metadrive", "commonroad"}
    return rows


def close(found: tuple[float, float, float], expected: tuple[float, float, float]) -> None:
    turned = math.remainder(found[2] - expected[2], math.tau)
    assert math.dist(found[:2], expected[:2]) < 1e-3 and abs(turned) < 1e-3, f"{found} is not {expected}"


def test_recrash(crossing: Export, table: dict) -> None:
    state = crossing.partners()[0]["states"][0]
    close((state["x"], state["y"], state["heading"]), table["recrash"])


def test_openscenario_by_lane_and_by_recording(crossing: Export, table: dict) -> None:
    root = ElementTree.parse(crossing.path("openscenario", ".xosc")).getroot()
    place = root.find(".//Private[@entityRef='cp1']//TeleportAction/Position/LanePosition")
    road = DriveMap(crossing.path("openscenario", ".xodr")).roads[place.get("roadId")]
    parameters = Parameters(root)
    lane, offset = int(place.get("laneId")), parameters.number(place.get("offset"))
    x, y, along = road.point(parameters.number(place.get("s")), road.lane_centre(lane) + offset)
    assert lane > 0, "the case is one against the reference line"
    assert place.find("Orientation") is None, "it faces the way its lane is driven"
    close((x, y, along + math.pi), table["openscenario"])

    at = ElementTree.parse(crossing.recorded()).getroot().find(".//Private[@entityRef='cp1']//TeleportAction/Position/WorldPosition")
    close(tuple(float(at.get(key)) for key in "xyh"), table["openscenario"])


def test_scenic(scenic: Answering, crossing: Export, table: dict) -> None:
    (report,) = scenic("compile", "1", str(crossing.path("scenic", ".scenic")))
    close(tuple(report["start"][1]), table["scenic"])


def test_metadrive(crossing: Export, table: dict) -> None:
    """From the left arm lane n - 1 comes in at x = E + 10, the others w further on; the arm reaches from y = 20.5 m up
    (n = 2, w = 3.5 m), and s counts from its far end."""
    (partner,) = json.loads(crossing.path("metadrive", ".metadrive.json").read_text())["run"]["partners"]
    start, end, lane = partner["way"][0]
    assert (start, end) == ("-1X2_1_", "-1X2_0_")
    spec = crossing.scenario["map"]
    x = spec["approach_m"] + 10 + (spec["lanes"] - 1 - lane) * spec["lane_width_m"]
    close((x, 20.5 + spec["arm_m"] - partner["s_m"], -math.pi / 2), table["metadrive"])


def test_commonroad(crossing: Export, table: dict) -> None:
    start = ElementTree.parse(crossing.path("commonroad", ".cr.xml")).getroot().find("dynamicObstacle/initialState")
    point = start.find("position/point")
    heading = float(start.find("orientation/exact").text)
    close((float(point.find("x").text), float(point.find("y").text), heading), table["commonroad"])

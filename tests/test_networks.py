"""Maps made of roads and junctions, as OpenDRIVE, read by ASAM's checkers and by netconvert."""

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from exports import ROOT, run
from oracles import answers, netconvert

NETWORKS = ROOT / "crates" / "export" / "tests" / "networks"

#: From which road to which one can drive, read off each map by hand.
WAYS = {
    "town": {
        "west+": {"east+", "north+", "south+"},
        "east-": {"west-", "north+", "south+"},
        "north-": {"west-", "east+", "south+", "north+"},
        "south-": {"west-", "east+", "north+"},
        "east+": {"on+"},
        "on-": {"east-"},
    },
    "ramps": {
        "highway+": {"merge+"},
        "entry+": {"merge+"},
        "merge+": {"leave+"},
        "leave+": {"drop+", "exit+"},
    },
    "roundabout": {
        "arm0-": {"ring0+"},
        "arm1-": {"ring1+"},
        "arm2-": {"ring2+"},
        "arm3-": {"ring3+"},
        "ring0+": {"arm1+", "ring1+"},
        "ring1+": {"arm2+", "ring2+"},
        "ring2+": {"arm3+", "ring3+"},
        "ring3+": {"arm0+", "ring0+"},
    },
}


@pytest.fixture(scope="module")
def maps(recrash: str, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("networks")
    for path in NETWORKS.glob("*.json"):
        run(recrash, "export", "--quiet", path, "--to", "openscenario", "--to-dir", folder / path.stem)
    return {path.stem: next(folder.rglob(f"{path.stem}.xodr")) for path in NETWORKS.glob("*.json")}


def test_asam_checkers_find_nothing(maps: dict[str, Path]) -> None:
    assert set(maps) == set(WAYS)
    for report in answers("qc", "qc.py", *map(str, maps.values())):
        assert report["issues"] == [], report["file"]
        assert "error" not in report["status"], report["file"]
        assert len(report["status"]["completed"]) >= 22, report


def test_netconvert_drives_where_the_map_leads(maps: dict[str, Path], tmp_path: Path) -> None:
    for name, path in maps.items():
        net = tmp_path / f"{name}.net.xml"
        netconvert(path, net, "--no-turnarounds")
        root = ElementTree.parse(net).getroot()
        roads = json.loads((NETWORKS / f"{name}.json").read_text())["map"]["roads"]

        def road(edge: str) -> str:
            # SUMO cuts an edge where its lanes begin or end, and writes a minus before those along the reference line.
            number = int(edge.split("#")[0])
            return roads[abs(number) - 1]["id"] + ("+" if number < 0 else "-")

        found: dict[str, set[str]] = {}
        for connection in root.findall("connection"):
            if not connection.get("from").startswith(":"):
                start, end = road(connection.get("from")), road(connection.get("to"))
                if start != end:
                    found.setdefault(start, set()).add(end)
        assert found == WAYS[name], name


def test_roads_are_as_long_as_they_are_written(maps: dict[str, Path]) -> None:
    for name, path in maps.items():
        lengths = {road.get("name"): float(road.get("length")) for road in ElementTree.parse(path).getroot().findall("road")}
        for road in json.loads((NETWORKS / f"{name}.json").read_text())["map"]["roads"]:
            pieces = [next(iter(piece.values())) for piece in road["line"]]
            if all("length_m" in piece for piece in pieces):
                # Where a ramp joins or leaves, a metre belongs to the junction.
                given_up = 1.0 if road["id"] in ("merge", "leave") else 0.0
                written = sum(piece["length_m"] for piece in pieces)
                assert lengths[road["id"]] == pytest.approx(written - given_up, abs=1e-3), road["id"]

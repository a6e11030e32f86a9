"""Scenes with plans as OpenSCENARIO with OpenDRIVE, read by ASAM's checkers, netconvert and esmini."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from exports import Export
from oracles import answers, netconvert
from oracles.esmini import alike, find, play_scene, table_of_scenes


def test_asam_checkers_find_nothing(scenes: list[Export]) -> None:
    files = [str(scene.path("openscenario", suffix)) for scene in scenes for suffix in (".xosc", ".xodr")]
    for report in answers("qc", "qc.py", *files):
        assert report["issues"] == [], report["file"]
        assert "error" not in report["status"], report["file"]


def test_netconvert_reads_every_map(scenes: list[Export], tmp_path: Path) -> None:
    """Each side of a road that is driven or cycled on becomes an edge, and nothing else does."""
    # Scenes may share a map; the lines above and of the header alone name the scene.
    maps = {scene.path("openscenario", ".xodr").read_text().split("<header", 1)[1].split("\n", 1)[1]: scene for scene in scenes}
    assert len(maps) >= 60
    for scene in maps.values():
        path, net = scene.path("openscenario", ".xodr"), tmp_path / f"{scene.id}.net.xml"
        netconvert(path, net, "--no-turnarounds")
        roads = [road for road in ElementTree.parse(path).getroot().findall("road") if road.get("junction") == "-1"]
        edges = [edge.get("id") for edge in ElementTree.parse(net).getroot().findall("edge") if not edge.get("function")]
        # SUMO cuts an edge where its lanes begin or end, and writes a minus before those along the reference line.
        numbers = [int(edge.split("#")[0].split(".")[0]) for edge in edges]
        read = {(str(abs(number)), "right" if number < 0 else "left") for number in numbers}
        written = {(road.get("id"), side) for road in roads for side in ("left", "right") if driven(road, side)}
        assert read == written, scene


def driven(road: ElementTree.Element, side: str) -> bool:
    return any(lane.get("type") in ("driving", "biking") for lane in road.findall(f"lanes/laneSection/{side}/lane"))


def test_esmini_plays_every_scene_as_it_was_recorded(scenes: list[Export], tmp_path: Path) -> None:
    """A part of docs/formats/esmini.md is what one run of this test wrote."""
    esmini = find()
    if not esmini:
        pytest.skip("set ESMINI_BIN to its binary; no registry has it")
    rows = [(scene, play_scene(esmini, scene, tmp_path)) for scene in scenes]
    (tmp_path / "scenes.md").write_text(table_of_scenes(rows))
    print(f"table: {tmp_path / 'scenes.md'}")
    for scene, played in rows:
        assert played.exit_code == 0 and played.errors == [], scene
        assert played.end_s == pytest.approx(played.our_end_s, abs=0.02), scene
        assert played.off_m <= 0.3, f"{scene}: {played}"
    assert sum(alike(played) for _, played in rows) >= 0.95 * len(rows)

"""CommonRoad files, valid by the schema of 2020a and read by commonroad-io."""

import math

import pytest
from exports import Export, lane_lengths
from oracles import answers


def test_files_are_valid_and_read_back(exports: list[Export]) -> None:
    found = answers("commonroad", "commonroad_read.py", *(str(e.path("commonroad", ".cr.xml")) for e in exports))
    assert len(found) == len(exports)
    for export, report in zip(exports, found):
        assert report["valid"], f"{export}: {report['errors']}"
        assert report["dt"] == 0.1 and report["goals"] == 1
        assert report["static_obstacles"] == len(export.scenario["obstacles"])
        others = export.rollout["actors"][1:]
        assert len(report["dynamic_obstacles"]) == len(others)
        for obstacle, actor in zip(report["dynamic_obstacles"], others):
            for (x, y), state in zip(obstacle["positions"], actor["states"], strict=len(actor["states"]) > 1):
                assert math.hypot(x - state["x"], y - state["y"]) < 1e-5
        check_lanelets(export, report["lanelets"])


def check_lanelets(export: Export, lanelets: dict) -> None:
    """Links agree in both directions, and the roads are as long as the map says."""
    for number, lanelet in lanelets.items():
        for successor in lanelet["successors"]:
            assert int(number) in lanelets[str(successor)]["predecessors"], export
    spec = export.scenario["map"]
    junction = {"S": 0, "C": 0, "X": 12, "T": 6, "O": 12}[spec["type"]]
    lengths = sorted(lanelet["length"] for lanelet in lanelets.values())
    expected = [length for lanes in lane_lengths(spec) for length in lanes]
    assert len(lengths) == len(expected) + junction * spec["lanes"], export
    for length in expected:
        nearest = min(lengths, key=lambda other: abs(other - length))
        assert nearest == pytest.approx(length, abs=0.02), export
        lengths.remove(nearest)

"""ScenarioNet files, checked and replayed by MetaDrive itself."""

import json
import math
import shutil
from pathlib import Path

from exports import Export
from oracles import answers

#: Everybody is replayed this near to where it was. [m, rad]
NEAR = 0.1
TURNED = 0.02

#: Types that MetaDrive's replay has no body for.
UNSEEN = {"OTHER", "TRAFFIC_OBJECT"}


def test_files_load_and_replay_what_was_driven(
    exports: list[Export], cases: list[Export], scenes: list[Export], tmp_path: Path
) -> None:
    """One case per map, every third file of the suites and every second scene: MetaDrive replays each to its end."""
    assert scenes
    suites = [export for export in exports if export.suite != "cases"]
    found = check(cases + suites[::3] + scenes[::2], tmp_path / "files")
    seen = {track["type"] for report in found.values() for track in report["tracks"].values()}
    assert {"VEHICLE", "PEDESTRIAN", "CYCLIST", "TRAFFIC_CONE"} <= seen
    features = {kind for report in found.values() for kind in report["features"]}
    assert {"LANE_SURFACE_STREET", "LANE_BIKE_LANE", "ROAD_EDGE_SIDEWALK", "CROSSWALK", "STOP_SIGN"} <= features
    lights = [states for report in found.values() for states in report["lights"].values()]
    assert any("TRAFFIC_LIGHT_RED" in states for states in lights)


def check(exports: list[Export], folder: Path) -> dict[str, dict]:
    """Every file of these exports, in one folder as a data set has them."""
    folder.mkdir()
    by_file = {}
    for number, export in enumerate(exports):
        # Suites may have scenarios of one name; the file's name is what MetaDrive goes by.
        name = f"sd_{number}_{export.id}.pkl"
        shutil.copy(export.folder / "scenarionet" / f"sd_recrash_{export.id}.pkl", folder / name)
        by_file[name] = export
    found = {report["file"]: report for report in answers("metadrive", "scenarionet_replay.py", str(folder))}
    assert set(found) == set(by_file)
    for name, export in by_file.items():
        replayed(export, found[name])
    return found


def replayed(export: Export, report: dict) -> None:
    steps = len(export.rollout["actors"][0]["states"])
    assert report["length"] == steps, export
    assert report["lanes"] > 0
    x0, y0 = report["origin"]
    for actor in export.rollout["actors"]:
        track = report["tracks"][actor["id"]]
        assert track["finite"], f"{export} {actor['id']}"
        there = [number for number, valid in enumerate(track["valid"]) if valid]
        for number in there:
            x, y = track["position"][number]
            state = actor["states"][number]
            assert math.hypot(x + x0 - state["x"], y + y0 - state["y"]) < 1e-3
        if track["type"] in UNSEEN:
            continue
        assert {int(step) for step in track["replayed"]} == set(there), f"{export} {actor['id']}"
        for step, (x, y, heading) in track["replayed"].items():
            state = actor["states"][int(step)]
            assert math.hypot(x + x0 - state["x"], y + y0 - state["y"]) < NEAR, f"{export} {actor['id']} {step}"
            assert abs(math.remainder(heading - state["heading"], math.tau)) < TURNED
    signals = [c for c in export.scenario.get("control", []) if "signal" in c["device"]]
    assert bool(report["lights"]) == bool(signals), export
    assert all(len(states) == steps for states in report["lights"].values())
    touched = [event for event in export.rollout["events"] if event["kind"]["event"].endswith("contact")]
    assert len(report["contacts"]) == len(touched), json.dumps(report["contacts"])

"""Scenic files on both their simulators, and the MetaDrive export without recrash: all in the environment of Scenic."""

import ast
import json
import math
from pathlib import Path

from exports import Export
from oracles import Answering, answers, netconvert


def test_scenic_compiles_every_map_and_samples_its_ranges(scenic: Answering, exports: list[Export], cases: list[Export]) -> None:
    """One case per map, and every third file of the suites: each takes 1.5 s, and they are written by the same lines."""
    files = scenic_files(cases + [export for export in exports if export.suite != "cases"][::3])
    found = scenic("compile", "1", "sweep=1", *files)
    assert len(found) == len(files)
    assert [report for report in found if "error" in report] == []


def test_scenic_drives_each_map_as_our_simulator_does(scenic: Answering, cases: list[Export]) -> None:
    """Newtonian has no tyres and its own brakes; over 5 s, and before any contact, it stays within 0.5 m all the same
    (0.7 m for a partner that moves sideways)."""
    check_driven(cases, scenic("newtonian", "50", *scenic_files(cases)), 0.7)


def test_scenic_on_metadrive_drives_each_map_as_our_simulator_does(scenic: Answering, cases: list[Export]) -> None:
    for export in cases:
        net = export.path("scenic", ".net.xml")
        netconvert(export.path("scenic", ".xodr"), net)
    check_driven(cases, scenic("metadrive", "50", *scenic_files(cases)), 0.5)


def test_scenic_shows_recorded_road_users_where_they_were(scenic: Answering, scenes: list[Export]) -> None:
    """Scenes whose road users have plans: everybody, the ego too, over the whole recording; who is not in the world stands
    1000 m to the east. Every eighth scene: each takes 1.5 s, and their differences are of few kinds."""
    scenes = scenes[::8]
    found = scenic("newtonian", "1200", *scenic_files(scenes))
    for scene, report in zip(scenes, found, strict=True):
        assert "error" not in report, report
        actors, trajectory = scene.rollout["actors"], report["trajectory"]
        # Things come behind the road users.
        assert len(trajectory) == len(actors[0]["states"]) and len(trajectory[0]) >= len(actors), scene
        for step, places in enumerate(trajectory):
            for actor, (x, y, *_) in zip(actors, places):
                away = step < round(actor.get("appears_s", 0) / 0.1) or step >= actor.get("gone_s", math.inf) / 0.1 - 1e-6
                state = actor["states"][step]
                off = math.dist((x, y), (state["x"] + 1000 * away, state["y"]))
                assert off <= 0.01, f"{scene} {actor['id']}: {off:.3f} m at {0.1 * step:.1f} s"
        # Somebody else than the ego is there.
        assert len(actors) == 1 or report["objects"] >= 2, scene


def scenic_files(exports: list[Export]) -> list[str]:
    return [str(export.path("scenic", ".scenic")) for export in exports]


def check_driven(cases: list[Export], found: list[dict], sideways_m: float) -> None:
    assert len(cases) == len(found) == 5
    for export, report in zip(cases, found):
        assert "error" not in report, report
        sideways = {spec["id"] for spec in export.scenario["partners"] if spec.get("lateral")}
        within(export, report["trajectory"], {actor: sideways_m for actor in sideways})


def within(export: Export, trajectory: list, bounds_m: dict[str, float]) -> None:
    """The first 5 s of ego and partners, until contact, against ours: within 0.5 m, or the actor's own bound."""
    actors = export.rollout["actors"][: 1 + len(export.scenario["partners"])]
    steps = min([len(trajectory), 51] + [export.steps_until_contact(actor["id"]) for actor in actors])
    assert steps > 25, export
    for step in range(steps):
        # Obstacles come behind the road users.
        assert len(trajectory[step]) >= len(actors), export
        for actor, (x, y, *_) in zip(actors, trajectory[step]):
            off = math.dist((x, y), (actor["states"][step]["x"], actor["states"][step]["y"]))
            most = bounds_m.get(actor["id"], 0.5)
            assert off <= most, f"{export} {actor['id']}: {off:.2f} m at {0.1 * step:.1f} s"


def test_metadrive_script_is_python_and_its_scenario_complete(exports: list[Export]) -> None:
    for export in exports:
        ast.parse((export.folder / "metadrive" / "run_metadrive.py").read_text())
        scenario = json.loads(export.path("metadrive", ".metadrive.json").read_text())
        drawn = scenario["run"]
        assert drawn["map"] == export.scenario["map"]
        assert [partner["id"] for partner in drawn["partners"]] == [p["id"] for p in export.scenario["partners"]]
        assert len(drawn["obstacles"]) == len(export.scenario["obstacles"])


def test_metadrive_script_drives_each_map_as_our_simulator_does(cases: list[Export], tmp_path: Path) -> None:
    """In an environment with another selection of MetaDrive's libraries."""
    traces = [tmp_path / f"{export.id}.json" for export in cases]
    scripts = [(e.folder / "metadrive" / "run_metadrive.py", e.path("metadrive", ".metadrive.json"), t) for e, t in zip(cases, traces)]
    answers("scenic", "metadrive_scripts.py", *(str(path) for script in scripts for path in script))
    for export, trace in zip(cases, traces):
        within(export, json.loads(trace.read_text())["states"], {})

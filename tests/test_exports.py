"""The exports, read by programs that none of us wrote: ASAM's checkers, netconvert, Scenic and commonroad-io.

OpenSCENARIO is also played by `osc_player.py`, as no player can be installed from a registry.
"""

import ast
import json
import math
import os
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from exports import CASES, ROOT, Export, lane_connections, lane_lengths, make, run
from oracles import answers, ask, environment
from osc_player import play

MAPS = "SCXTO"


def scenarios_of(suite: Path) -> list[Path]:
    found = [path for path in sorted((suite / "6-tuned").glob("*.json")) if path.name.count(".") == 1]
    assert found
    return found


@pytest.fixture(scope="session")
def exports(recrash: str, suite: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Export]:
    """Every scenario of the sample suite, and one case per map."""
    return make(recrash, [*sorted(CASES.glob("*.json")), *scenarios_of(suite)], tmp_path_factory.mktemp("exports"))


@pytest.fixture(scope="session")
def paper(recrash: str, tmp_path_factory: pytest.TempPathFactory) -> list[Export]:
    """Every scenario of the suite of the paper's own crash file, where that is at hand."""
    records = Path(os.environ.get("RECRASH_SHARED", ROOT.parent / "shared")) / "data/nhtsa/ads-2021-06-to-2025-06.csv"
    if not records.exists():
        pytest.skip("skipped: the paper's suite (needs ../shared)")
    folder = tmp_path_factory.mktemp("paper")
    run(recrash, "run", "--quiet", "--records", records, "--profile", "paper", "--out", folder / "suite")
    return make(recrash, scenarios_of(folder / "suite"), folder)


@pytest.fixture(scope="session")
def swept(recrash: str, suite: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The suite as a whole, with the logical scenarios that only a suite has."""
    folder = tmp_path_factory.mktemp("swept")
    run(recrash, "export", "--quiet", suite, "--to", "openscenario,scenic", "--to-dir", folder)
    return folder


def is_case(export: Export) -> bool:
    """Whether it is one of the cases, rather than of the suite."""
    return (CASES / f"{export.id}.json").exists()


def test_there_is_a_scenario_for_every_map(exports: list[Export]) -> None:
    assert {export.scenario["map"]["type"] for export in exports} == set(MAPS)


# ---- OpenDRIVE and OpenSCENARIO ----


def test_asam_checkers_find_nothing(exports: list[Export], swept: Path) -> None:
    files = [path for export in exports if is_case(export) for path in sorted(export.folder.glob("openscenario/*.x*"))]
    files += [path for export in exports for path in sorted(export.folder.glob("recorded/openscenario/*.xosc"))]
    check_clean([*files, *sorted((swept / "openscenario").glob("*.x*"))])


def check_clean(files: list[Path]) -> None:
    found = answers("qc", "qc.py", *map(str, files))
    assert len(found) == len(files) > 0
    for report in found:
        path = report["file"]
        assert report["issues"] == [], path
        assert "error" not in report["status"], path
        # A file of distributions has no entities for the other rules to look at.
        distribution = path.endswith((".ranges.xosc", ".points.xosc"))
        wanted = 22 if path.endswith(".xodr") else 12 if distribution else 16
        assert len(report["status"]["completed"]) >= wanted, f"{path}: {report['status']}"


def test_a_damaged_file_does_not_pass_the_checkers(exports: list[Export], tmp_path: Path) -> None:
    """The gate can fail: a lane link into nothing, and an entity nobody declared."""
    export = exports[0]
    damaged = {".xodr": ('<successor id="-1"/>', '<successor id="-9"/>'), ".xosc": ('entityRef="ego"', 'entityRef="nobody"')}
    for suffix, (old, new) in damaged.items():
        text = export.path("openscenario", suffix).read_text()
        assert old in text
        (tmp_path / f"x{suffix}").write_text(text.replace(old, new, 1))
    found = answers("qc", "qc.py", *(str(tmp_path / f"x{suffix}") for suffix in damaged))
    assert any(report["issues"] for report in found)


def test_netconvert_reads_the_maps_as_they_are(exports: list[Export], tmp_path: Path) -> None:
    netconvert = environment("sumo") / "netconvert"
    seen = set()
    for export in exports:
        spec = export.scenario["map"]
        if json.dumps(spec) in seen:
            continue
        seen.add(json.dumps(spec))
        net = tmp_path / f"{export.id}.net.xml"
        run(netconvert, "--no-turnarounds", "--xml-validation", "never", "--opendrive-files", export.path("openscenario", ".xodr"), "-o", net)
        root = ElementTree.parse(net).getroot()
        edges = [edge for edge in root.findall("edge") if edge.get("function") != "internal"]
        expected = lane_lengths(spec)
        assert len(edges) == len(expected), export.id
        assert sum(not c.get("from").startswith(":") for c in root.findall("connection")) == lane_connections(spec), export.id
        widths = {float(lane.get("width", "3.2")) for edge in edges for lane in edge.findall("lane")}
        assert all(width == pytest.approx(spec["lane_width_m"], abs=0.006) for width in widths), export.id
        # SUMO gives all lanes of an edge one length, their mean, measured along chords and cut a little at junctions.
        lengths = sorted(float(edge.find("lane").get("length")) for edge in edges)
        for length, mean in zip(lengths, sorted(sum(lanes) / len(lanes) for lanes in expected)):
            assert length == pytest.approx(mean, rel=0.012, abs=0.3), export.id


def test_partners_played_by_their_actions_are_where_ours_are(exports: list[Export]) -> None:
    """Along the way 0.35 m. Across it an action follows a lane, or a straight line from lane to lane, and a vehicle on
    tyres does not, least of all in a bend (see `docs/formats/openscenario.md`)."""
    check_played(exports)


def check_played(exports: list[Export]) -> None:
    for export in exports:
        for spec, along, across in deviations(export, export.path("openscenario", ".xosc")):
            bends = export.scenario["map"]["type"] == "O" or spec["turn"] != "straight"
            most = 1.0 if bends else 0.5
            assert along <= 0.35, f"{export.id} {spec['id']}: {along:.2f} m along its way"
            assert across <= most, f"{export.id} {spec['id']}: {across:.2f} m across its way"


def test_partners_played_by_their_recording_are_where_ours_are(exports: list[Export]) -> None:
    for export in exports:
        for spec, along, across in deviations(export, export.folder / "recorded" / "openscenario" / f"{export.id}.xosc"):
            assert max(along, across) <= 1e-3, f"{export.id} {spec['id']}"


def deviations(export: Export, scenario: Path) -> list[tuple[dict, float, float]]:
    """Per partner how far the played one is from ours until its first contact, along our heading and across it."""
    tracks = play(scenario, 0.1 * (len(export.rollout["actors"][0]["states"]) - 1))
    assert set(tracks) == {actor["id"] for actor in export.partners()}
    found = []
    for actor, spec in zip(export.partners(), export.scenario["partners"]):
        steps = export.steps_until_contact(actor["id"])
        along = across = 0.0
        pairs = list(zip(tracks[actor["id"]][:steps], actor["states"]))
        assert pairs
        for point, state in pairs:
            dx, dy = point[0] - state["x"], point[1] - state["y"]
            forward = (math.cos(state["heading"]), math.sin(state["heading"]))
            along = max(along, abs(dx * forward[0] + dy * forward[1]))
            across = max(across, abs(dy * forward[0] - dx * forward[1]))
        found.append((spec, along, across))
    return found


def test_the_papers_suite_is_clean_and_played_as_well(paper: list[Export]) -> None:
    check_clean([path for export in paper for path in sorted(export.folder.glob("openscenario/*.x*"))])
    check_played(paper)
    check_commonroad(paper)


def test_esmini_plays_every_file_to_its_end(exports: list[Export], tmp_path: Path) -> None:
    esmini = os.environ.get("ESMINI_BIN")
    if not esmini:
        pytest.skip("skipped: esmini (set ESMINI_BIN to its binary; no registry has it)")
    for export in exports:
        log = tmp_path / f"{export.id}.log"
        command = [esmini, "--osc", str(export.path("openscenario", ".xosc")), "--headless", "--fixed_timestep", "0.01",
                   "--collision", "--disable_stdout", "--logfile_path", str(log), "--seed", "1"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, export.id
        assert "[error]" not in log.read_text(), export.id


# ---- Scenic ----


def test_scenic_compiles_every_file_and_samples_its_ranges(exports: list[Export], swept: Path) -> None:
    files = [export.path("scenic", ".scenic") for export in exports if is_case(export)]
    files += sorted((swept / "scenic").glob("*.scenic"))
    found = answers("scenic", "scenic_run.py", "compile", "1", "sweep=1", *map(str, files))
    assert len(found) == len(files)
    assert [report for report in found if "error" in report] == []


def test_scenic_drives_each_map_as_our_simulator_does(exports: list[Export]) -> None:
    """Newtonian has no tyres and its own brakes; over 5 s, and before any contact, it stays within 0.5 m all the same
    (0.7 m for a partner that moves sideways)."""
    cases = [export for export in exports if is_case(export)]
    assert {export.scenario["map"]["type"] for export in cases} == set(MAPS)
    check_driven(cases, answers("scenic", "scenic_run.py", "newtonian", "50", *scenic_files(cases)))


def test_scenic_on_metadrive_drives_each_map_as_our_simulator_does(exports: list[Export]) -> None:
    python = os.environ.get("RECRASH_SCENIC_METADRIVE_PYTHON")
    if not python:
        pytest.skip("skipped: Scenic on MetaDrive (set RECRASH_SCENIC_METADRIVE_PYTHON, see docs/formats/scenic.md)")
    cases = [export for export in exports if is_case(export)]
    for export in cases:
        net = export.path("scenic", ".net.xml")
        run(environment("sumo") / "netconvert", "--opendrive-files", export.path("scenic", ".xodr"), "-o", net)
    check_driven(cases, ask(python, "scenic_run.py", "metadrive", "50", *scenic_files(cases)))


def scenic_files(cases: list[Export]) -> list[str]:
    return [str(export.path("scenic", ".scenic")) for export in cases]


def check_driven(cases: list[Export], found: list[dict]) -> None:
    for export, report in zip(cases, found):
        assert "error" not in report, report
        actors = export.rollout["actors"][: 1 + len(export.scenario["partners"])]
        steps = min([len(report["trajectory"]), 51] + [export.steps_until_contact(actor["id"]) for actor in actors])
        assert steps > 25, export.id
        sideways = {spec["id"] for spec in export.scenario["partners"] if spec.get("lateral")}
        for step in range(steps):
            for actor, (x, y) in zip(actors, report["trajectory"][step]):
                state = actor["states"][step]
                off = math.hypot(x - state["x"], y - state["y"])
                assert off <= (0.7 if actor["id"] in sideways else 0.5), f"{export.id} {actor['id']}: {off:.2f} m at {0.1 * step:.1f} s"


# ---- CommonRoad ----


def test_commonroad_files_are_valid_and_read_back(exports: list[Export]) -> None:
    check_commonroad(exports)


def check_commonroad(exports: list[Export]) -> None:
    found = answers("commonroad", "commonroad_read.py", *(str(e.path("commonroad", ".cr.xml")) for e in exports))
    for export, report in zip(exports, found):
        assert report["valid"], f"{export.id}: {report['errors']}"
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
            assert int(number) in lanelets[str(successor)]["predecessors"], export.id
    spec = export.scenario["map"]
    junction = {"S": 0, "C": 0, "X": 12, "T": 6, "O": 12}[spec["type"]]
    lengths = sorted(lanelet["length"] for lanelet in lanelets.values())
    expected = [length for lanes in lane_lengths(spec) for length in lanes]
    assert len(lengths) == len(expected) + junction * spec["lanes"], export.id
    for length in expected:
        nearest = min(lengths, key=lambda other: abs(other - length))
        assert nearest == pytest.approx(length, abs=0.02), export.id
        lengths.remove(nearest)


# ---- MetaDrive ----


def test_metadrive_script_is_python_and_its_scenario_complete(exports: list[Export]) -> None:
    for export in exports:
        script = (export.folder / "metadrive" / "run_metadrive.py").read_text()
        ast.parse(script)
        scenario = json.loads(export.path("metadrive", ".metadrive.json").read_text())
        assert scenario["map"]["block"] == export.scenario["map"]["type"]
        assert [partner["id"] for partner in scenario["partners"]] == [p["id"] for p in export.scenario["partners"]]
        assert len(scenario["obstacles"]) == len(export.scenario["obstacles"])


def test_metadrive_script_drives_each_map_as_our_simulator_does(exports: list[Export], tmp_path: Path) -> None:
    python = os.environ.get("RECRASH_METADRIVE_PYTHON")
    if not python:
        pytest.skip("skipped: MetaDrive (set RECRASH_METADRIVE_PYTHON to a Python 3.11 with metadrive-simulator 0.4.3)")
    for export in filter(is_case, exports):
        trace = tmp_path / f"{export.id}.json"
        script = export.folder / "metadrive" / "run_metadrive.py"
        run(python, script, export.path("metadrive", ".metadrive.json"), "--headless", "--trace", trace)
        states = json.loads(trace.read_text())["states"]
        actors = export.rollout["actors"][: 1 + len(export.scenario["partners"])]
        steps = min([len(states), 51] + [export.steps_until_contact(actor["id"]) for actor in actors])
        for step in range(steps):
            for actor, (x, y, _, _) in zip(actors, states[step]):
                state = actor["states"][step]
                off = math.hypot(x - state["x"], y - state["y"])
                assert off <= 0.5, f"{export.id} {actor['id']}: {off:.2f} m at {0.1 * step:.1f} s"


# ---- bad input ----


def test_one_damaged_scenario_is_named_and_the_rest_is_exported(recrash: str, suite: Path, tmp_path: Path) -> None:
    copy = tmp_path / "suite"
    shutil.copytree(suite, copy)
    scenarios = [path for path in sorted((copy / "6-tuned").glob("*.json")) if path.name.count(".") == 1]
    scenarios[0].write_text("{ damaged")
    done = subprocess.run([recrash, "export", str(copy), "--to", "metadrive"], capture_output=True, text=True)
    assert done.returncode != 0
    assert scenarios[0].stem in done.stdout + done.stderr
    written = sorted(path.name for path in (copy / "exports" / "metadrive").glob("*.metadrive.json"))
    assert written == [f"{path.stem}.metadrive.json" for path in scenarios[1:]]


def test_unknown_format_and_full_target_are_refused(recrash: str, tmp_path: Path) -> None:
    case = str(sorted(CASES.glob("*.json"))[0])
    done = subprocess.run([recrash, "export", case, "--to", "opendrive"], capture_output=True, text=True)
    assert done.returncode == 2 and "openscenario" in done.stderr
    target = tmp_path / "target"
    command = [recrash, "export", case, "--to", "scenic", "--to-dir", str(target)]
    assert subprocess.run(command, capture_output=True).returncode == 0
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode != 0 and "--force" in done.stderr

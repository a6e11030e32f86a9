"""OpenSCENARIO and OpenDRIVE, read by programs that none of us wrote: ASAM's checkers, netconvert and esmini.

It is also played by `osc_player.py`, as no player can be installed from a registry.
"""

import json
import math
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import pytest
from exports import Export, lane_connections, lane_lengths, run
from oracles import answers, netconvert
from oracles.esmini import Played, find, play_with_our_ego, table
from osc_player import play

MAPS = "SCXTO"


def test_there_is_a_scenario_for_every_map(cases: list[Export]) -> None:
    assert {export.scenario["map"]["type"] for export in cases} == set(MAPS)


def test_the_papers_suite_is_among_them(exports: list[Export]) -> None:
    if not any(export.suite == "paper" for export in exports):
        pytest.skip("needs ../shared")
    assert sum(export.suite == "paper" for export in exports) == 20


# ---- ASAM's checkers ----


def test_asam_checkers_find_nothing(exports: list[Export]) -> None:
    files = [path for export in exports for path in sorted((export.folder / "openscenario").glob(f"{export.id}.*"))]
    files += [export.recorded() for export in exports]
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


def test_a_damaged_file_does_not_pass_the_checkers(cases: list[Export], tmp_path: Path) -> None:
    """The gate can fail: a lane link into nothing, and an entity nobody declared."""
    export = cases[0]
    damaged = {".xodr": ('<successor id="-1"/>', '<successor id="-9"/>'), ".xosc": ('entityRef="ego"', 'entityRef="nobody"')}
    for suffix, (old, new) in damaged.items():
        text = export.path("openscenario", suffix).read_text()
        assert old in text
        (tmp_path / f"x{suffix}").write_text(text.replace(old, new, 1))
    found = answers("qc", "qc.py", *(str(tmp_path / f"x{suffix}") for suffix in damaged))
    assert all(report["issues"] for report in found)


# ---- netconvert ----


def test_netconvert_reads_the_maps_as_they_are(exports: list[Export], tmp_path: Path) -> None:
    seen = set()
    for export in exports:
        spec = export.scenario["map"]
        if json.dumps(spec) in seen:
            continue
        seen.add(json.dumps(spec))
        net = tmp_path / f"{export.suite}-{export.id}.net.xml"
        netconvert(export.path("openscenario", ".xodr"), net, "--no-turnarounds")
        root = ElementTree.parse(net).getroot()
        edges = [edge for edge in root.findall("edge") if edge.get("function") != "internal"]
        expected = lane_lengths(spec)
        assert len(edges) == len(expected), export
        assert sum(not c.get("from").startswith(":") for c in root.findall("connection")) == lane_connections(spec), export
        widths = {float(lane.get("width", "3.2")) for edge in edges for lane in edge.findall("lane")}
        assert all(width == pytest.approx(spec["lane_width_m"], abs=0.006) for width in widths), export
        # SUMO gives all lanes of an edge one length, their mean, measured along chords and cut a little at junctions.
        lengths = sorted(float(edge.find("lane").get("length")) for edge in edges)
        for length, mean in zip(lengths, sorted(sum(lanes) / len(lanes) for lanes in expected)):
            assert length == pytest.approx(mean, rel=0.012, abs=0.3), export


# ---- our second reading ----


def test_partners_played_by_their_actions_are_where_ours_are(exports: list[Export]) -> None:
    for export in exports:
        for name, off in deviations(export, export.path("openscenario", ".xosc")):
            assert off <= 0.3, f"{export} {name}: {off:.2f} m"


def test_partners_played_by_their_recording_are_where_ours_are(exports: list[Export]) -> None:
    for export in exports:
        for name, off in deviations(export, export.recorded()):
            assert off <= 1e-3, f"{export} {name}: {off:.4f} m"


def deviations(export: Export, scenario: Path, most_steps: int | None = None) -> list[tuple[str, float]]:
    """Per partner how far the played one is from ours at most, until its first contact, or for so many steps."""
    tracks = play(scenario, 0.1 * (len(export.rollout["actors"][0]["states"]) - 1))
    assert set(tracks) == {actor["id"] for actor in export.partners()}
    found = []
    for actor in export.partners():
        pairs = list(zip(tracks[actor["id"]][: export.steps_until_contact(actor["id"])], actor["states"]))[:most_steps]
        assert pairs
        found.append((actor["id"], max(math.dist(point, (state["x"], state["y"])) for point, state in pairs)))
    return found


# ---- esmini ----


def test_esmini_plays_every_file_as_our_simulator_does(exports: list[Export], tmp_path: Path) -> None:
    """With our ego in the slot. The page docs/formats/esmini.md is what one run of this test wrote."""
    esmini = find()
    if not esmini:
        pytest.skip("set ESMINI_BIN to its binary; no registry has it")
    rows = []
    for export in exports:
        acting = play_with_our_ego(esmini, export, export.path("openscenario", ".xosc"), tmp_path)
        recorded = play_with_our_ego(esmini, export, export.recorded(), tmp_path)
        rows.append((export, acting, recorded))
    (tmp_path / "esmini.md").write_text(table(esmini, rows))
    print(f"table: {tmp_path / 'esmini.md'}")
    for export, acting, recorded in rows:
        # Where roads of a roundabout meet, esmini moved a bus that changes lanes there to the side, for two steps.
        assert acting.off_m <= 0.4, f"{export}: {acting}"
        assert recorded.off_m <= 0.1, f"{export}: {recorded}"
    near = sum(acting.off_m <= 0.3 for _, acting, _ in rows)
    alike = [collides_alike(acting, 0.2) for _, acting, _ in rows], [collides_alike(recorded, 0.05) for _, _, recorded in rows]
    assert near >= 0.95 * len(rows)
    assert all(sum(each) >= 0.95 * len(rows) for each in alike), alike


def collides_alike(played: Played, within_s: float) -> bool:
    if played.contact_s is None or played.our_contact_s is None:
        return played.contact_s == played.our_contact_s
    return abs(played.contact_s - played.our_contact_s) <= within_s


# ---- the logical scenario ----


def parameter_name(pointer: str) -> str:
    """`/partners/0/start/arrival_gap_s` is `partner1StartArrivalGapS` (`docs/formats/openscenario.md`)."""
    words: list[str] = []
    for part in pointer.strip("/").replace("_", "/").split("/"):
        if part.isdigit():
            words[-1] = words[-1].removesuffix("s") + str(int(part) + 1)
        else:
            words.append(part[:1].upper() + part[1:] if words else part)
    return "".join(words)


def test_ranges_are_those_that_tuning_may_move(exports: list[Export]) -> None:
    suites = [export for export in exports if export.suite != "cases"]
    for export in suites:
        expected = {parameter_name(p["pointer"]): (p["min"], p["max"]) for p in export.parameters}
        assert expected, export
        root = ElementTree.parse(export.path("openscenario", ".ranges.xosc")).getroot()
        distribution = root.find("ParameterValueDistribution")
        assert distribution.find("ScenarioFile").get("filepath") == f"{export.id}.xosc"
        found = {
            each.get("parameterName"): limits(each.find("UniformDistribution/Range"))
            for each in distribution.findall("Stochastic/StochasticDistribution")
        }
        assert found == expected, export
        declared = ElementTree.parse(export.path("openscenario", ".xosc")).getroot().findall("ParameterDeclarations/ParameterDeclaration")
        constrained = {
            each.get("name"): tuple(float(limit.get("value")) for limit in each.iter("ValueConstraint"))
            for each in declared
            if each.find("ConstraintGroup") is not None
        }
        assert constrained == expected, export


def limits(element: ElementTree.Element) -> tuple[float, float]:
    return float(element.get("lowerLimit")), float(element.get("upperLimit"))


def test_points_of_a_sweep_play_as_they_run(recrash: str, exports: list[Export]) -> None:
    """A runner puts a point's values into the declarations. The first point is the scenario as it is; in the last, partners are
    still near to where they are in our simulator with the same values."""
    for export in [export for export in exports if export.suite == "sample"]:
        points = ElementTree.parse(export.path("openscenario", ".points.xosc")).getroot().findall(".//ParameterValueSet")
        assert len(points) > 5, export
        for number in (0, len(points) - 1):
            tree = ElementTree.parse(export.path("openscenario", ".xosc"))
            declared = {each.get("name"): each for each in tree.getroot().iter("ParameterDeclaration")}
            for assignment in points[number].findall("ParameterAssignment"):
                declared[assignment.get("parameterRef")].set("value", assignment.get("value"))
            # Beside the original, because it names its map by a relative path.
            swept = export.path("openscenario", f".{number}.xosc")
            tree.write(swept)
            shown = run(recrash, "import", swept, "--out", swept.with_suffix(".json"), "--simulate", "--json")
            rollout = json.loads(shown)["run"]["rollout"]
            assert (rollout["state_hash"] == export.rollout["state_hash"]) == (number == 0), f"{export} point {number}"
            for name, off in deviations(replace(export, rollout=rollout), swept, most_steps=50):
                assert off <= 0.8, f"{export} point {number}, {name}: {off:.2f} m"

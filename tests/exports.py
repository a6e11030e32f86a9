"""What the tests of exports share: one case per map, the sample's suite and the paper's, in every format."""

import json
import math
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CASES = ROOT / "crates" / "export" / "tests" / "cases"
#: Scenes of `recrash.scenario/2` that only some formats are tested with.
SCENES = [ROOT / "crates" / "export" / "tests" / "scenes", ROOT / "cases"]
FORMATS = "openscenario,scenic,metadrive,commonroad,scenarionet"


@dataclass(frozen=True)
class Export:
    """One scenario: its file, its rollout, and where its exports are."""

    suite: str
    id: str
    scenario: dict
    rollout: dict
    folder: Path
    #: Parameters that may move, as the log of the search has them.
    parameters: list[dict]

    def __str__(self) -> str:
        return f"{self.suite} {self.id}"

    def path(self, format_name: str, suffix: str) -> Path:
        return self.folder / format_name / f"{self.id}{suffix}"

    def recorded(self) -> Path:
        """The OpenSCENARIO file whose partners follow what was recorded."""
        return self.folder / "recorded" / "openscenario" / f"{self.id}.xosc"

    def partners(self) -> list[dict]:
        return [actor for actor in self.rollout["actors"] if actor["role"] == "partner"]

    def steps_until_contact(self, actor_id: str) -> int:
        """Steps of an actor before it first touches anything."""
        number = [actor["id"] for actor in self.rollout["actors"]].index(actor_id)
        steps = len(self.rollout["actors"][0]["states"])
        for event in self.rollout["events"]:
            kind = event["kind"]
            if number in (kind.get("a"), kind.get("b"), kind.get("actor")):
                return min(steps, int(event["time_s"] / 0.1))
        return steps


def of_cases(recrash: str, folder: Path) -> list[Export]:
    """The case of each map, exported as single files."""
    found = []
    for path in sorted(CASES.glob("*.json")):
        scenario = json.loads(path.read_text())
        target = folder / scenario["id"]
        target.mkdir(parents=True)
        run(recrash, "simulate", "--quiet", path, "--rollout", target / "rollout.json")
        export(recrash, path, target)
        rollout = json.loads((target / "rollout.json").read_text())
        found.append(Export("cases", scenario["id"], scenario, rollout, target, []))
    return found


def of_scenes(recrash: str, folder: Path) -> list[Export]:
    """Scenes with plans: the recorded driver in the ego's seat where there is one."""
    found = []
    for path in sorted(path for scenes in SCENES for path in scenes.glob("**/*.json")):
        scenario = json.loads(path.read_text())
        target = folder / scenario["id"]
        target.mkdir(parents=True)
        ego = ["--ego", "recorded"] if "recorded" in scenario["ego"] else []
        run(recrash, "simulate", "--quiet", path, *ego, "--rollout", target / "rollout.json")
        run(recrash, "export", "--quiet", path, "--to", "scenarionet,openscenario,scenic", "--to-dir", target)
        rollout = json.loads((target / "rollout.json").read_text())
        found.append(Export("scenes", scenario["id"], scenario, rollout, target, []))
    return found


def of_suite(recrash: str, suite: Path, name: str, folder: Path) -> list[Export]:
    """Every scenario of a suite, exported as a whole."""
    export(recrash, suite, folder)
    found = []
    for path in sorted((suite / "6-tuned").glob("*.search.json")):
        name_of_case = path.name.replace(".search.json", ".json")
        scenario = json.loads(path.with_name(name_of_case).read_text())
        log = json.loads(path.read_text())
        rollout = json.loads((suite / "7-tuned-runs" / name_of_case).read_text())["rollout"]
        found.append(Export(name, scenario["id"], scenario, rollout, folder, log["parameters"]))
    assert found
    return found


def export(recrash: str, source: Path, target: Path) -> None:
    run(recrash, "export", "--quiet", source, "--to", FORMATS, "--to-dir", target)
    run(recrash, "export", "--quiet", source, "--to", "openscenario", "--as", "trajectory", "--to-dir", target / "recorded")


def shared() -> Path:
    """The folder of real data, which users do not have."""
    return Path(os.environ.get("RECRASH_SHARED", ROOT.parent / "shared"))


def run(*command: object) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert done.returncode == 0, f"{command}: {done.stderr}"
    return done.stdout


def lane_lengths(spec: dict) -> list[list[float]]:
    """Lengths of the lanes of every road outside junctions, from the map's numbers alone (`docs/models/roads.md`)."""
    lanes, width = spec["lanes"], spec["lane_width_m"]
    straight = lambda length: [[length] * lanes] * 2
    roads = [*straight(10.0), *straight(spec["approach_m"] - 10.0)]
    if spec["type"] == "S":
        roads += straight(spec["length_m"])
    elif spec["type"] == "C":
        side = 1 if spec["direction"] == "right" else -1
        angle = math.radians(spec["angle_deg"])
        # Lane n - 1 is the rightmost; the opposite lanes lie behind lane 0.
        forward = [angle * (spec["radius_m"] + side * (lanes - 1 - k) * width) for k in range(lanes)]
        backward = [angle * (spec["radius_m"] + side * (lanes + k) * width) for k in range(lanes)]
        roads += [forward, backward, *straight(spec["length_m"])]
    elif spec["type"] in "XT":
        for _ in range(3 if spec["type"] == "X" else 2):
            roads += straight(spec["arm_m"])
    else:
        for _ in range(3):
            roads += straight(spec["arm_m"])
        radius = (2 * lanes - 1) * width + spec["inner_radius_m"]
        roads += [[math.radians(30) * (radius - (lanes - 1 - k) * width) for k in range(lanes)]] * 4
    return roads


def lane_connections(spec: dict) -> int:
    """Ways from one lane to the next, those through junctions counted once."""
    ways = {"S": 4, "C": 6, "X": 2 + 12, "T": 2 + 6, "O": 2 + 12}[spec["type"]]
    return ways * spec["lanes"]

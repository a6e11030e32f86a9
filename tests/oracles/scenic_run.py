"""Compiles Scenic files and runs each once. Prints one JSON object per file: its trajectories and how it ended.

Runs in the environment of requirements/scenic.txt. Each line it reads is a question, ["newtonian"|"metadrive"|"compile", STEPS, FILE...];
behind the answers to it stands {"end": true}.
"""

import ast
import json
import os
import random
import sys
import traceback
from pathlib import Path

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ.setdefault("MPLBACKEND", "Agg")

import metadrive
import numpy
import scenic
from scenic.syntax import translator

MODELS = {
    "newtonian": "scenic.simulators.newtonian.driving_model",
    "metadrive": "scenic.simulators.metadrive.model",
    "compile": "scenic.simulators.newtonian.driving_model",
}


def parsed_once(parse):
    """Scenic parses its own library again for every file, which takes longer than anything else here. What it makes of a syntax
    tree changes the tree, so each gets one of its own."""
    trees = {}

    def parsed(source, mode, filename):
        if (source, filename) not in trees:
            trees[source, filename] = parse(source, mode, filename=filename)
        return copied(trees[source, filename])

    return parsed


def copied(part):
    """A syntax tree, node by node; those of Scenic are not made for the module copy."""
    if isinstance(part, (list, tuple)):
        return type(part)(copied(each) for each in part)
    if not isinstance(part, ast.AST):
        return part
    node = type(part).__new__(type(part))
    node.__dict__.update((name, copied(value)) for name, value in part.__dict__.items())
    return node


def without_pictures():
    """MetaDrive wants to download its pictures at the first start, which nothing here looks at; two files stop it."""
    assets = Path(metadrive.__file__).parent / "assets"
    if not (assets / "version.txt").exists():
        (assets / "textures" / "grass1").mkdir(parents=True)
        (assets / "textures" / "grass1" / "GroundGrassGreen002_COL_1K.jpg").touch()
        (assets / "version.txt").write_text("0.4.3")


def run(path, simulator, steps, params):
    random.seed(1)
    numpy.random.seed(1)
    scenario = scenic.scenarioFromFile(path, mode2D=True, model=MODELS[simulator], params=params)
    scene, iterations = scenario.generate(maxIterations=2000)
    names = [getattr(obj, "name", None) for obj in scene.objects]
    if simulator == "compile":
        poses = [[obj.position.x, obj.position.y, obj.heading] for obj in scene.objects]
        return {"file": path, "iterations": iterations, "objects": len(names), "start": poses}
    result = scenario.getSimulator().simulate(scene, maxSteps=steps).result
    moving = [i for i, obj in enumerate(scene.objects) if getattr(obj, "behavior", None) is not None]
    # In 2-D mode positions are x, y, z of the centre.
    trajectory = [[[state.positions[i].x, state.positions[i].y] for i in moving] for state in result.trajectory] \
        if hasattr(result.trajectory[0], "positions") else [[[p.x, p.y] for p in state] for state in result.trajectory]
    return {
        "file": path,
        "iterations": iterations,
        "objects": len(names),
        "trajectory": trajectory,
        "end": str(result.terminationReason),
        "records": {name: len(values) for name, values in result.records.items() if hasattr(values, "__len__")},
    }


def answer(chosen, count, *files):
    extra = dict(item.split("=") for item in files if "=" in item and not item.endswith(".scenic"))
    for name in (name for name in files if name.endswith(".scenic")):
        try:
            print(json.dumps(run(name, chosen, int(count), {key: float(value) for key, value in extra.items()})))
        except Exception as problem:  # whatever is wrong with a file is the answer
            traceback.print_exc()
            print(json.dumps({"file": name, "error": f"{type(problem).__name__}: {problem}"}))


if __name__ == "__main__":
    translator.parse_string = parsed_once(translator.parse_string)
    without_pictures()
    for question in sys.stdin:
        answer(*json.loads(question))
        print(json.dumps({"end": True}), flush=True)

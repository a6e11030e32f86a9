"""The exported MetaDrive script against recrash's own worker: the same file, alone and asked."""

import json
import math
import subprocess
from pathlib import Path

from exports import Export, run
from oracles import answers, environment


def test_the_exported_script_tells_what_the_worker_tells(recrash: str, exports: list[Export], tmp_path: Path) -> None:
    """Every scenario of a suite, the paper's where its crash file is at hand: the same end at the same time, and everybody
    within 0.3 m of where the worker has them, to the end."""
    paper = [export for export in exports if export.suite == "paper"]
    chosen = paper or [export for export in exports if export.suite == "sample"]
    assert len(chosen) == 20
    traces = [tmp_path / f"{export.id}.script.json" for export in chosen]
    scripts = [(script_of(export), drawn_of(export), trace) for export, trace in zip(chosen, traces)]
    alone = answers("metadrive", "metadrive_scripts.py", *(str(path) for script in scripts for path in script))
    contacts = 0
    for export, worker, trace, told in zip(chosen, asked(chosen), traces, alone, strict=True):
        trace = json.loads(trace.read_text())
        assert told["end"] == worker["end"], export
        assert abs(told["time_s"] - worker["time_s"]) < 0.011, export
        contacts += worker["end"] == "contact"
        assert len(trace["states"]) == len(worker["tracks"][0]), export
        assert len(trace["actors"]) == len(worker["tracks"]), export
        off = max(
            math.dist(state[:2], track[step][:2])
            for step, states in enumerate(trace["states"])
            for state, track in zip(states, worker["tracks"])
        )
        assert off <= 0.3, f"{export}: {off:.2f} m"
    assert contacts >= 10, "a suite of failures has contacts"


def test_recrash_asks_the_worker_for_what_it_exports(recrash: str, cases: list[Export], tmp_path: Path) -> None:
    """The rollout of `recrash simulate --sim metadrive` is what the worker answers to the exported run."""
    export = cases[0]
    drawn, rollout = tmp_path / "scenario.json", tmp_path / "rollout.json"
    drawn.write_text(json.dumps(export.scenario))
    python = environment("metadrive") / "python"
    run(recrash, "simulate", "--quiet", drawn, "--sim", "metadrive", "--python", python, "--rollout", rollout)
    rollout = json.loads(rollout.read_text())
    (worker,) = asked([export])
    assert rollout["termination"]["kind"] == worker["end"]
    tracks = [[(state["x"], state["y"]) for state in actor["states"]] for actor in rollout["actors"]]
    assert tracks == [[tuple(state[:2]) for state in track] for track in worker["tracks"]]


def script_of(export: Export) -> Path:
    return export.folder / "metadrive" / "run_metadrive.py"


def drawn_of(export: Export) -> Path:
    return export.path("metadrive", ".metadrive.json")


def asked(exports: list[Export]) -> list[dict]:
    """What one worker answers to the runs of these exports."""
    runs = [json.loads(drawn_of(export).read_text())["run"] for export in exports]
    requests = "".join(json.dumps({"id": number, "run": drawn}) + "\n" for number, drawn in enumerate(runs))
    command = [str(environment("metadrive") / "python"), str(script_of(exports[0])), "--worker"]
    done = subprocess.run(command, input=requests, capture_output=True, text=True, timeout=600)
    hello, *answered = (json.loads(line) for line in done.stdout.splitlines())
    assert hello["hello"]["problem"] is None
    assert [answer["id"] for answer in answered] == list(range(len(runs))), done.stderr[-2000:]
    return [answer["done"] for answer in answered]

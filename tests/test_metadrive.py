"""The exported MetaDrive script against recrash's own worker: the same file, alone and asked."""

import json
import math
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from exports import Export, run
from oracles import environment


def test_the_exported_script_tells_what_the_worker_tells(recrash: str, exports: list[Export], tmp_path: Path) -> None:
    """Every scenario of a suite, the paper's where its crash file is at hand: the same end at the same time, and everybody
    within 0.3 m of where the worker has them, to the end."""
    paper = [export for export in exports if export.suite == "paper"]
    chosen = paper or [export for export in exports if export.suite == "sample"]
    assert len(chosen) == 20
    python = environment("metadrive") / "python"

    def both(export: Export) -> tuple[dict, dict, dict]:
        drawn, asked, trace = (tmp_path / f"{export.id}.{kind}.json" for kind in ("scenario", "worker", "script"))
        drawn.write_text(json.dumps(export.scenario))
        run(recrash, "simulate", "--quiet", drawn, "--sim", "metadrive", "--python", python, "--rollout", asked)
        script = export.folder / "metadrive" / "run_metadrive.py"
        told = run(python, script, export.path("metadrive", ".metadrive.json"), "--headless", "--trace", trace)
        return json.loads(asked.read_text()), json.loads(trace.read_text()), json.loads(told.splitlines()[-1])

    contacts = 0
    with ThreadPoolExecutor(2) as threads:
        for export, (worker, trace, told) in zip(chosen, threads.map(both, chosen)):
            end = worker["termination"]
            assert told["end"] == end["kind"], export
            assert abs(told["time_s"] - end["time_s"]) < 0.011, export
            contacts += end["kind"] == "contact"
            tracks = [actor["states"] for actor in worker["actors"]]
            assert trace["actors"] == [actor["id"] for actor in worker["actors"]], export
            assert len(trace["states"]) == len(tracks[0]), export
            off = max(
                math.dist(state[:2], (track[step]["x"], track[step]["y"]))
                for step, states in enumerate(trace["states"])
                for state, track in zip(states, tracks)
            )
            assert off <= 0.3, f"{export}: {off:.2f} m"
    assert contacts >= 10, "a suite of failures has contacts"


"""Ray against the plain command on one machine: a million rollouts, and 1,000 tests with a Python ego.

    python benchmarks/cluster.py --rollouts 1000000

Each side is measured by the wall clock and by the processor time of all its processes: on a machine that others use too, only the
second says what Ray costs. The rows of both sides are held against each other.
"""

from __future__ import annotations

import argparse
import contextlib
import inspect
import json
import os
import platform
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pyarrow.parquet

import recrash

# Ray runs its workers with less priority than anybody else; the command has the usual one.
os.environ.setdefault("RAY_worker_niceness", "0")

TICKS = os.sysconf("SC_CLK_TCK")


class Steady:
    """A Python ego that holds its speed and its lane."""

    def control(self, observation: dict) -> tuple[float, float]:
        """Answer one step."""
        me = observation["ego"]
        gaps = [(other["x"] - me["x"]) ** 2 + (other["y"] - me["y"]) ** 2 for other in observation["actors"]]
        return (-4.0 if min(gaps, default=1e4) < 225.0 else 0.3), -0.1 * me["route_t_m"]


class Watched:
    """Processor time of this process and of all that it starts: looked at often, because Ray does not wait for its dead."""

    def __init__(self) -> None:
        self.seen: dict[int, int] = {}
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self) -> None:
        while True:
            self.look()
            time.sleep(0.05)

    def look(self) -> float:
        """What they took so far. [s]"""
        parents, used = {}, {}
        for entry in Path("/proc").iterdir():
            if entry.name.isdigit():
                with contextlib.suppress(OSError):
                    fields = (entry / "stat").read_text().rsplit(") ", 1)[1].split()
                    parents[int(entry.name)], used[int(entry.name)] = int(fields[1]), int(fields[11]) + int(fields[12])
        waiting = [os.getpid()]
        while waiting:
            pid = waiting.pop()
            self.seen[pid] = used[pid]
            waiting += [child for child, parent in parents.items() if parent == pid]
        return sum(self.seen.values()) / TICKS


def measured(name: str, work: Callable[[], object], spent: Callable[[], float]) -> tuple[float, float]:
    """Do it, and print what it took."""
    begun, before = time.perf_counter(), spent()
    work()
    wall, processor = time.perf_counter() - begun, spent() - before
    print(f"{name:44} {wall:>10.1f} {processor:>12.1f}", flush=True)
    return wall, processor


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--rollouts", type=int, default=1_000_000)
    parser.add_argument("--tests", type=int, default=1000)
    parser.add_argument("--folder", type=Path, help="keeps the tables; the command is not run where its table is there")
    arguments = parser.parse_args()
    import ray

    from recrash import ray as cluster

    cores = os.cpu_count() or 1
    folder = arguments.folder or Path(tempfile.mkdtemp())
    crash = Path(__file__).parents[2] / "cases/crashes/32-lead-reverses.json"
    vary = ["/ego/speed_mps=5:12"]
    print(
        f"{cores} cores, {platform.platform()}, Python {platform.python_version()}, Ray {ray.__version__}; load {os.getloadavg()}"
    )
    print(f"{'':44} {'wall [s]':>10} {'processor [s]':>12}")

    words = [
        "sweep",
        crash,
        "--rollouts",
        arguments.rollouts,
        "--vary",
        vary[0],
        "--ego",
        "idm",
        "--profile",
        "open",
        "--seed",
        1,
    ]
    command = [
        sys.executable,
        "-m",
        "recrash",
        *map(str, words),
        "--threads",
        str(cores),
        "--quiet",
        "--out",
        str(folder / "command.parquet"),
    ]

    def of_children() -> float:
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    plain = None
    if not (folder / "command.parquet").is_file():
        plain = measured(f"command, {arguments.rollouts:,} rollouts", lambda: subprocess.run(command, check=True), of_children)
    ray.init(num_cpus=cores, object_store_memory=300 << 20, include_dashboard=False, log_to_driver=False, logging_level="ERROR")
    options = {"vary": vary, "ego": "idm", "seed": 1}
    # Workers are started: that is once for a cluster, and not for a sweep.
    cluster.sweep([crash], 4 * cores, batch=1, **options)
    spent = Watched().look
    out = folder / "ray.parquet"
    on = measured(
        f"Ray, {arguments.rollouts:,} rollouts", lambda: cluster.sweep([crash], arguments.rollouts, out=out, **options), spent
    )
    names = ["rollout", "state_hash", "verdict"]
    ours, theirs = (pyarrow.parquet.read_table(folder / f"{name}.parquet", columns=names) for name in ("command", "ray"))
    print(f"rows equal: {ours.to_pydict() == theirs.to_pydict()}")
    if plain is not None:
        wall, processor = on[0] / plain[0] - 1, on[1] / plain[1] - 1
        print(f"overhead by the wall: {wall:+.1%}, by processor time: {processor:+.1%} (asked for: 15 % at most)\n")

    # Where the ego was parked there is nothing to test.
    driven = [scenario for scenario in recrash.read().reconstruct()[0] if "handover_s" in scenario.to_dict()["ego"]]
    points = recrash._recrash.Points(driven, [], "idm", None, 1)
    suite, paths, number = folder / "suite", list[Path](), 0
    suite.mkdir(exist_ok=True)
    while len(paths) < arguments.tests:
        # What is sampled does not always fit a scenario.
        with contextlib.suppress(recrash.InputError):
            scenario = points.scenario(number)
            paths.append(suite / f"{len(paths):06}.json")
            paths[-1].write_text(scenario.to_json())
        number += 1
    (folder / "steady.py").write_text(inspect.getsource(Steady))
    words = ["freeze", suite, "--out", folder / "frozen", "--quiet"]
    subprocess.run([sys.executable, "-m", "recrash", *map(str, words)], check=True)
    words = ["test", folder / "frozen", "--ego", f"py:{folder / 'steady.py'}:Steady", "--out", folder / "results.json"]
    command = [sys.executable, "-m", "recrash", *map(str, words), "--threads", str(cores), "--quiet"]
    what = f"{len(paths):,} tests, Python ego"
    plain = measured(f"command, {what}", lambda: subprocess.run(command, check=False), of_children)
    cluster.test(paths[: 8 * cores], Steady, batch=1)
    tables: list[recrash.Table] = []
    on = measured(f"Ray, {what}", lambda: tables.append(cluster.test(paths, Steady)), spent)
    tests = json.loads((folder / "results.json").read_text())["tests"]
    hashes = [test["runs"][0]["outcome"]["state_hash"] for test in tests]
    print(f"rows equal: {sorted(hashes) == sorted(tables[0].to_dict()['state_hash'])}")
    wall, processor = on[0] / plain[0] - 1, on[1] / plain[1] - 1
    print(f"overhead by the wall: {wall:+.1%}, by processor time: {processor:+.1%} (asked for: 15 % at most)\n")

    rows: list[object] = []
    alone = measured(f"one process, {what}", lambda: rows.append(recrash.test(paths, Steady).to_dicts()), time.process_time)
    print(f"rows equal: {rows[0] == tables[0].to_dicts()}")
    print(f"Ray over one process by processor time: {on[1] / alone[1] - 1:+.1%}")
    ray.shutdown()


if __name__ == "__main__":
    main()

"""Ray against the plain way on one machine: a million rollouts, and 1,000 tests with a Python ego.

    python benchmarks/cluster.py --rollouts 1000000

Each side is measured by the wall clock and by the processor time of all its processes: on a machine that others use too, only the
second says what Ray costs. The rows of both sides are held against each other.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import platform
import resource
import subprocess
import sys
import tempfile
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


def spent_by(pids: set[int]) -> float:
    """Processor time of processes that are there, with that of their ended children. [s]"""
    total = 0
    for pid in pids:
        try:
            fields = Path(f"/proc/{pid}/stat").read_text().rsplit(") ", 1)[1].split()
        except OSError:
            continue
        total += sum(int(field) for field in fields[11:15])
    return total / TICKS


def of_ray() -> set[int]:
    """Processes of the cluster on this machine that this process has started, and this process."""
    parents = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parents[int(entry.name)] = int((entry / "stat").read_text().rsplit(") ", 1)[1].split()[1])
            except OSError:
                continue
    found, waiting = set(), [os.getpid()]
    while waiting:
        pid = waiting.pop()
        found.add(pid)
        waiting += [child for child, parent in parents.items() if parent == pid and child not in found]
    return found


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
    spent = lambda: spent_by(of_ray())  # noqa: E731
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

    points = recrash._recrash.Points(recrash.read().reconstruct()[0], [], "idm", None, 1)
    suite, number = [], 0
    while len(suite) < arguments.tests:
        # What is sampled does not always fit a scenario.
        with contextlib.suppress(recrash.InputError):
            suite.append(points.scenario(number))
        number += 1
    rows: list[object] = []
    own = lambda: time.process_time()  # noqa: E731
    alone = measured(
        f"one process, {len(suite):,} tests, Python ego", lambda: rows.append(recrash.test(suite, Steady).to_dicts()), own
    )
    cluster.test(suite[: 8 * cores], Steady, batch=1)
    many = measured(f"Ray, {len(suite):,} tests, Python ego", lambda: rows.append(cluster.test(suite, Steady).to_pylist()), spent)
    print(f"rows equal: {rows[0] == rows[1]}")
    print(f"times one process by the wall: {alone[0] / many[0]:.2f}; by processor time: {many[1] / alone[1] - 1:+.1%}")
    ray.shutdown()


if __name__ == "__main__":
    main()

"""Runs the grids of the JRC's program of reference drivers (repository ec-jrc/JRC-FSM, EUPL-1.2) from a checkout of it.

Prints one JSON object for each part of a grid: a `1` for each crash, a `0` for each scenario without, in order. Usage:

    python jrc_fsm.py FOLDER
"""

import csv
import json
import os
import sys
import tempfile
from multiprocessing import Pool
from pathlib import Path

#: Drivers, there and here.
DRIVERS = {"CC_human_driver": "careful", "FSM": "fsm", "RSS": "rss", "Reg157": "reg157"}
#: Grids of cut-ins: their name there, speeds of the ego, steps of the other's. [km/h]
CUT_INS = {
    "cut-in-fast": ("high", (70, 90, 110, 130), 30),
    "cut-in-slow": ("low", (20, 30, 40, 50, 60), 10),
}
#: Scenarios of each speed of a cut-out.
CUT_OUTS_A_SPEED = 450


def run(job: tuple[str, str, str]) -> None:
    """One grid of the program, with results below the working folder."""
    folder, module, argument = job
    sys.path.insert(0, folder)
    loop = getattr(__import__(f"utility.{module}"), module).run_loop
    with open(os.devnull, "w") as nowhere:
        sys.stdout = nowhere
        try:
            loop(*([argument] if argument else []))
        except SystemExit:
            # The loop over cut-outs ends so.
            pass


def crashes(path: Path) -> str:
    with path.open() as file:
        return "".join("1" if row["Crash"] == "True" else "0" for row in csv.DictReader(file))


def parts(results: Path):
    """Grid, driver, speed of the ego and of the other, crashes."""
    for grid, (name, speeds, step) in CUT_INS.items():
        for theirs, ours in DRIVERS.items():
            for ego in speeds:
                for other in range(10, ego, step):
                    yield grid, ours, ego, other, crashes(results / f"cut_in_{name}_speed" / f"{theirs}_{ego}_{other}.csv")
    for theirs, ours in list(DRIVERS.items())[:3]:
        found = crashes(results / "cut_out" / f"{theirs}_cut_out.csv")
        for number in range(13):
            part = found[number * CUT_OUTS_A_SPEED : (number + 1) * CUT_OUTS_A_SPEED]
            yield "cut-out", ours, 10 * (number + 1), "-", part
    for theirs, ours in list(DRIVERS.items())[:3]:
        yield "following", ours, "-", "-", crashes(results / "car_following" / f"{theirs}_car_following.csv")


def main() -> None:
    folder = str(Path(sys.argv[1]).resolve())
    jobs = [("comparison_cut_in", "high"), ("comparison_cut_in", "low"), ("comparison_cut_out", ""), ("comparison_car_following", "")]
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        os.mkdir("results")
        with Pool(2) as pool:
            pool.map(run, [(folder, *job) for job in jobs], chunksize=1)
        for grid, driver, ego, other, bits in parts(Path("results")):
            print(json.dumps({"grid": grid, "driver": driver, "ego_kmh": str(ego), "other_kmh": str(other), "crashes": bits}))
        os.chdir("/")


if __name__ == "__main__":
    main()

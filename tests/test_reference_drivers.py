"""Every verdict of the reference drivers against the JRC's own program, where a checkout of it is at hand."""

import csv
import hashlib
import os
import subprocess
from pathlib import Path

import pytest
from exports import ROOT
from oracles import answers

Part = tuple[str, str, str, str]


@pytest.fixture(scope="module")
def published() -> dict[Part, str]:
    """Crashes by grid, driver and speeds, as the program has them. It takes some minutes."""
    folder = os.environ.get("RECRASH_JRC_FSM")
    if not folder:
        pytest.skip("needs $RECRASH_JRC_FSM, a checkout of the repository ec-jrc/JRC-FSM")
    found = answers("oracle-jrc", "jrc_fsm.py", folder, timeout_s=3600)
    return {(row["grid"], row["driver"], row["ego_kmh"], row["other_kmh"]): row["crashes"] for row in found}


def part(row: dict[str, str]) -> Part:
    split = {"cut-out": (row["ego_kmh"], "-"), "following": ("-", "-")}
    return row["grid"], row["driver"], *split.get(row["grid"], (row["ego_kmh"], row["other_kmh"]))


def test_every_verdict_is_the_programs(published: dict[Part, str], recrash: str, tmp_path: Path) -> None:
    subprocess.run([recrash, "check-driver", "--quiet", "--out", str(tmp_path)], check=True)
    ours: dict[Part, str] = {}
    with (tmp_path / "verdicts.csv").open() as file:
        for row in csv.DictReader(file):
            ours[part(row)] = ours.get(part(row), "") + ("1" if row["verdict"] == "crashed" else "0")
    assert ours == published
    assert sum(len(bits) for key, bits in ours.items() if key[1] == "careful") == 36_941


def test_the_committed_digests_are_the_programs(published: dict[Part, str]) -> None:
    with (ROOT / "crates" / "drivers" / "tests" / "verdicts.csv").open() as file:
        committed = {part(row): (row["scenarios"], row["crashes"], row["sha256"]) for row in csv.DictReader(file)}
    digest = lambda bits: hashlib.sha256(bits.encode()).hexdigest()[:32]
    assert committed == {
        key: (str(len(bits)), str(bits.count("1")), digest(bits)) for key, bits in published.items()
    }

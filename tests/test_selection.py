"""Selection held against scikit-learn: principal components, and k-means over 20 seeds."""

import json
import os
import subprocess
from pathlib import Path

import pytest
from oracles import ROOT, environment

ORACLE = ROOT / "crates" / "select" / "oracle" / "oracle.py"
SHARED = Path(os.environ.get("RECRASH_SHARED", ROOT.parent / "shared"))
ARCHIVE = SHARED / "data" / "nhtsa" / "ads-2021-06-to-2025-06.csv"


def measure(recrash: str) -> list[str | Path]:
    """The example `measure`: as `cargo xtask` had it built together with $RECRASH, else as cargo builds it now."""
    built = Path(recrash).parent / "examples" / "measure"
    if "RECRASH" in os.environ and built.exists():
        return [built]
    run = ["run", "--quiet", "--package", "recrash-select", "--example", "measure", "--"]
    return [os.environ.get("CARGO", "cargo"), *run]


@pytest.fixture(scope="session", params=["sample", "archive"])
def compared(request: pytest.FixtureRequest, recrash: str, tmp_path_factory: pytest.TempPathFactory) -> dict:
    """What both sides make of the same records."""
    sample = ROOT / "crates" / "records" / "data" / "sample.csv"
    records = sample if request.param == "sample" else ARCHIVE
    if not records.exists():
        pytest.skip("needs ../shared")
    dump = tmp_path_factory.mktemp("selection") / "dump.json"
    subprocess.run([*measure(recrash), records, dump], cwd=ROOT, check=True)
    python = environment("oracle-sklearn") / "python"
    shown = subprocess.run([python, ORACLE, "compare", dump], check=True, capture_output=True, text=True).stdout
    return json.loads(shown)


def test_principal_components_are_those_of_scikit_learn(compared: dict) -> None:
    """Sums of squares inside our clusters are the same in its components as in ours, for 20 different clusterings."""
    ours, theirs = compared["explained_variance"]
    assert abs(ours - theirs) < 1e-6
    assert len(compared["recrash"]) == 20
    for here, there in zip(compared["recrash"], compared["recrash_again"], strict=True):
        assert abs(here - there) < 1e-6


def test_kmeans_is_no_worse_than_scikit_learn(compared: dict) -> None:
    ours, theirs = compared["recrash"], compared["scikit_learn"]
    print(f"mean inertia {sum(ours) / 20:.3f} against {sum(theirs) / 20:.3f}, least {min(ours):.3f}, {min(theirs):.3f}")
    assert sum(ours) <= sum(theirs)
    assert min(ours) <= min(theirs) * (1 + 1e-9)

"""What the tests share."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

# Plots are drawn into memory.
os.environ.setdefault("MPLBACKEND", "Agg")
# Ray asks nobody about its use, and warns of nothing that is to come.
os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")

CASES = Path(__file__).parents[2] / "cases"
#: An interpreter that has MetaDrive, where one is named.
METADRIVE = os.environ.get("RECRASH_METADRIVE_PYTHON")
EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"


def gallery() -> list[Path]:
    """Every case of the gallery, in order."""
    return sorted(CASES.glob("*/*.json"))


def case(name: str) -> Path:
    return CASES / f"{name}.json"


def command(*words: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run the command: the program that RECRASH names, else the one that the wheel brings."""
    program = [os.environ["RECRASH"]] if "RECRASH" in os.environ else [sys.executable, "-m", "recrash"]
    environment = {**os.environ, "RECRASH_PYTHON": sys.executable}
    return subprocess.run(
        [*program, *map(str, words)], capture_output=True, text=True, timeout=120, cwd=cwd, env=environment, check=False
    )


@pytest.fixture(scope="session")
def crashes() -> Path:
    return CASES / "crashes"

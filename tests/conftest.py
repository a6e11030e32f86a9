"""Shared by the Python tests: the command, and one small suite made with it."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def recrash() -> str:
    """Path of the recrash binary: $RECRASH, the release build, or what is on the PATH."""
    built = ROOT / "target" / "release" / "recrash"
    found = os.environ.get("RECRASH") or (str(built) if built.exists() else shutil.which("recrash"))
    assert found, "build it first: cargo build --release"
    return found


@pytest.fixture(scope="session")
def suite(recrash: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The suite of the built-in sample with all defaults."""
    folder = tmp_path_factory.mktemp("suite") / "suite"
    subprocess.run([recrash, "run", "--quiet", "--out", str(folder)], check=True)
    return folder

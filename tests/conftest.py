"""Shared by the Python tests: the command, and one small suite made with it."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from exports import Export, of_cases, of_scenes, of_suite, run, shared
from oracles import Answering

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
    """The suite of the built-in sample, by the published method."""
    folder = tmp_path_factory.mktemp("suite") / "suite"
    subprocess.run([recrash, "run", "--quiet", "--profile", "paper", "--out", str(folder)], check=True)
    return folder


@pytest.fixture(scope="session")
def exports(recrash: str, suite: Path, tmp_path_factory: pytest.TempPathFactory) -> list[Export]:
    """One case per map, every scenario of the sample's suite, and of the paper's where its crash file is at hand."""
    folder = tmp_path_factory.mktemp("exports")
    found = of_cases(recrash, folder / "cases") + of_suite(recrash, suite, "sample", folder / "sample")
    records = shared() / "data" / "nhtsa" / "ads-2021-06-to-2025-06.csv"
    if records.exists():
        paper = folder / "paper-suite"
        run(recrash, "run", "--quiet", "--records", records, "--profile", "paper", "--out", paper)
        found += of_suite(recrash, paper, "paper", folder / "paper")
    return found


@pytest.fixture(scope="session")
def scenes(recrash: str, tmp_path_factory: pytest.TempPathFactory) -> list[Export]:
    """Scenes with plans."""
    return of_scenes(recrash, tmp_path_factory.mktemp("scenes"))


@pytest.fixture(scope="session")
def cases(exports: list[Export]) -> list[Export]:
    """The cases alone."""
    return [export for export in exports if export.suite == "cases"]


@pytest.fixture(scope="session")
def scenic() -> Iterator[Answering]:
    """Scenic, and its simulators."""
    worker = Answering("scenic", "scenic_run.py")
    yield worker
    worker.end()

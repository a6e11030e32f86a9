"""The ``recrash`` command, as the wheel brings it: ``recrash`` or ``python -m recrash``."""

from __future__ import annotations

import os
import sys

from recrash._recrash import command


def main() -> int:
    """Run the command with the words of this process. Egos in Python are driven by this interpreter."""
    os.environ.setdefault("RECRASH_PYTHON", sys.executable)
    return command(["recrash", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())

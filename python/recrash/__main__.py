"""The ``recrash`` command, as the wheel brings it."""

from __future__ import annotations

import sys

from recrash._recrash import __version__


def main() -> int:
    """Run the command."""
    print(f"recrash {__version__}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

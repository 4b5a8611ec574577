"""The command ``eeruf`` of the wheel: ``python -m eeruf --help``."""

from __future__ import annotations

import sys

from eeruf._eeruf import _run_program


def main() -> int:
    """Run the command with this process's arguments, and return its exit code."""
    return _run_program(["eeruf", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())

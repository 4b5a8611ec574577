"""Type checkers find slips, and nothing in what is right."""

import subprocess
import sys
from pathlib import Path

WRONG = Path(__file__).with_name("wrong_programs.py")
FIRST = 1 + WRONG.read_text().splitlines().index('eeruf.design(8, 999, 15_000, 36_000, layout="circle")')
EVERY = set(range(FIRST, 1 + len(WRONG.read_text().splitlines())))


def lines_with_errors(checker: str, *options: str) -> set[int]:
    """The lines of the file of wrong programs in which a checker finds something."""
    run = subprocess.run([sys.executable, "-m", checker, *options, str(WRONG)], capture_output=True, text=True)
    found = [line for line in run.stdout.splitlines() if WRONG.name + ":" in line]
    assert found, run.stdout + run.stderr
    return {int(line.split(WRONG.name + ":")[1].split(":")[0]) for line in found}


def test_mypy_refuses_each_line_of_the_wrong_programs() -> None:
    assert lines_with_errors("mypy", "--strict") == EVERY


def test_pyright_refuses_each_line_of_the_wrong_programs() -> None:
    assert lines_with_errors("pyright", "--pythonpath", sys.executable) == EVERY

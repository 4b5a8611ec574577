"""Type checkers find mistakes, and nothing in correct code."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest
from eeruf import sim

HERE = Path(__file__).parent
# The wrong lines of each file begin with this one.
FIRST = {
    "wrong_programs.py": 'eeruf.design(8, 999, 15_000, 36_000, layout="circle")',
    "wrong_keywords.py": "robot.replace(t_delta=100)",
}


def every(name: str) -> set[int]:
    """Return the wrong lines of a file."""
    lines = (HERE / name).read_text().splitlines()
    return set(range(1 + lines.index(FIRST[name]), 1 + len(lines)))


def lines_with_errors(name: str, checker: str, *options: str) -> set[int]:
    """Return the lines of a file in which a checker finds something."""
    run = subprocess.run([sys.executable, "-m", checker, *options, str(HERE / name)], capture_output=True, text=True)
    found = [line for line in run.stdout.splitlines() if name + ":" in line]
    assert found, run.stdout + run.stderr
    return {int(line.split(name + ":")[1].split(":")[0]) for line in found}


@pytest.mark.parametrize("name", FIRST)
def test_mypy_refuses_each_wrong_line(name: str) -> None:
    assert len(every(name)) >= 29
    assert lines_with_errors(name, "mypy", "--strict") == every(name)


@pytest.mark.parametrize("name", FIRST)
def test_pyright_refuses_each_wrong_line(name: str) -> None:
    assert lines_with_errors(name, "pyright", "--pythonpath", sys.executable) == every(name)


@pytest.mark.parametrize(
    ("changes", "taken"),
    [("_RobotChanges", sim.Robot), ("_SceneChanges", sim.Scene)],
)
def test_stub_knows_every_keyword_that_is_changed(changes: str, taken: type) -> None:
    stub = ast.parse((HERE.parents[1] / "python" / "eeruf" / "_eeruf.pyi").read_text())
    (known,) = (node for node in stub.body if isinstance(node, ast.ClassDef) and node.name == changes)
    names = {
        line.target.id for line in known.body if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name)
    }
    assert names == set(inspect.signature(taken).parameters)

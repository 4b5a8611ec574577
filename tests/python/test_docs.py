"""Every public name says what it is, the examples hold, and so do the listings in the documents."""

import doctest
import inspect
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import ModuleType
from typing import Any

import eeruf
import matplotlib
import pytest

matplotlib.use("Agg")
ROOT = Path(__file__).parents[2]
MODULES = [eeruf, eeruf.experiments, eeruf.logs, eeruf.nav, eeruf.plot, eeruf.sim, eeruf.tables, eeruf.typing]


def public(module: ModuleType) -> list[str]:
    """Return the names of a module that users may rely on; for the types, all."""
    own = [name for name in vars(module) if name[0] != "_" and name not in ("annotations", "TYPE_CHECKING")]
    return list(getattr(module, "__all__", own))


def names(module: ModuleType) -> Iterator[tuple[str, Any]]:
    """Yield the public functions and classes of a module, and the classes' methods and properties, compiled or not."""
    for name in public(module):
        thing = getattr(module, name)
        if inspect.ismodule(thing) or not (callable(thing) or inspect.isclass(thing)):
            continue
        yield f"{module.__name__}.{name}", thing
        if inspect.isclass(thing):
            for member, value in inherited(thing).items():
                if not member.startswith("_"):
                    value = value.__func__ if isinstance(value, staticmethod) else value
                    yield f"{module.__name__}.{name}.{member}", value


def inherited(of: type) -> dict[str, Any]:
    """Return the members of a class and of its base classes in eeruf."""
    return {
        name: value
        for base in reversed(of.__mro__)
        if base.__module__.startswith("eeruf")
        for name, value in vars(base).items()
        # The default of a field is not a method, and a removed member has no attribute.
        if name not in getattr(base, "__dataclass_fields__", ()) and hasattr(base, name)
    }


# With the members of classes, in one order for all processes that run the tests.
DOCUMENTED = dict(sorted((found for module in MODULES for found in names(module)), key=lambda found: found[0]))


def test_there_are_few_names_to_learn() -> None:
    learnt = [name for module in MODULES if module is not eeruf.typing for name in module.__all__]
    # With the two of eeruf.envs, which needs Gymnasium.
    assert len(learnt) + 2 <= 70
    assert set(public(eeruf.typing)) >= {"AlcoveRun", "Violation", "is_kind"}


def test_the_package_exports_what_the_design_names() -> None:
    expected = """eeruf.Schedule eeruf.Schedule.verify eeruf.WaitSearch.best eeruf.design eeruf.EchoFilter.push_many eeruf.Ring.poll
        eeruf.Found eeruf.Needs eeruf.Ring.flow eeruf.Ring.moving eeruf.sim.Scene.paths eeruf.sim.simulate eeruf.sim.Readings.summary
        eeruf.experiments.set_one eeruf.experiments.set_two eeruf.experiments.set_three eeruf.plot.timing eeruf.plot.scene eeruf.plot.readings
        eeruf.plot.course""".split()
    assert set(expected) <= set(DOCUMENTED)


@pytest.mark.parametrize("name", DOCUMENTED)
def test_every_public_name_has_a_docstring(name: str) -> None:
    said = DOCUMENTED[name].__doc__
    assert said is not None
    assert len(said.split()) > 2, said
    assert said != getattr(type(DOCUMENTED[name]), "__doc__", None), "its own docstring, not its type's"


@pytest.mark.parametrize("name", [name for name, thing in DOCUMENTED.items() if callable(thing)])
def test_every_public_class_function_and_method_has_an_example(name: str) -> None:
    assert ">>>" in (DOCUMENTED[name].__doc__ or "")


@pytest.mark.parametrize("name", [name for name, thing in DOCUMENTED.items() if ">>>" in (thing.__doc__ or "")])
def test_an_example_in_a_docstring_holds(name: str) -> None:
    test = doctest.DocTestParser().get_doctest(DOCUMENTED[name].__doc__, {}, name, None, None)
    printed: list[str] = []
    failed, tried = doctest.DocTestRunner().run(test, out=printed.append)
    assert tried > 0
    assert failed == 0, "".join(printed)


@pytest.mark.parametrize("module", MODULES, ids=lambda module: str(module.__name__))
def test_a_module_says_what_it_is_for(module: ModuleType) -> None:
    failed, _ = doctest.testmod(module)
    assert module.__doc__
    assert failed == 0


@pytest.mark.parametrize("name", [name for name, thing in DOCUMENTED.items() if callable(thing)])
def test_help_shows_the_arguments_of_what_can_be_called(name: str) -> None:
    thing = DOCUMENTED[name]
    if inspect.isclass(thing) and (issubclass(thing, Exception) or thing.__new__ is object.__new__):
        return
    if name.rsplit(".", 1)[1] in (
        "BatchState",
        "Paths",
        "ReadingBlocks",
        "Readings",
        "RobotState",
        "WaitTables",
        "PeriodEnded",
        "Steering",
    ):
        # Only functions return them.
        return
    parameters = [parameter for parameter in inspect.signature(thing).parameters if parameter not in ("self", "cls")]
    said = thing.__doc__ or ""
    if inspect.isclass(thing) and "Args:" not in said:
        return
    assert all(f"    {parameter}: " in said for parameter in parameters), parameters


def listings(document: str) -> list[str]:
    """Return the blocks of Python in a document."""
    return re.findall(r"^```python\n(.*?)^```$", (ROOT / document).read_text(), flags=re.M | re.S)


TASKS = re.findall(
    r"^```python\n(.*?)^```$",
    (ROOT / "docs/how-to/python.md").read_text().split("## Twelve tasks")[1].split("\n## ")[0],
    flags=re.M | re.S,
)


def test_each_task_takes_fewer_than_15_lines_and_runs(tmp_path: Path) -> None:
    assert len(TASKS) == 12
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")

    def run(number: int) -> subprocess.CompletedProcess[str]:
        script = tmp_path / f"task_{number}.py"
        script.write_text(TASKS[number - 1])
        environment = {**os.environ, "MPLBACKEND": "Agg"}
        return subprocess.run(
            [sys.executable, script], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300
        )

    with ThreadPoolExecutor(2) as two:
        for number, done in zip(range(1, 13), two.map(run, range(1, 13))):
            assert len(TASKS[number - 1].strip().splitlines()) < 15, number
            assert done.returncode == 0, (number, done.stderr)
            assert done.stdout or number in (6, 10), number
    assert (tmp_path / "tables.pdf").stat().st_size > 5_000


@pytest.mark.parametrize(
    ("document", "least"),
    [
        ("README.md", 1),
        ("python/README.md", 1),
        ("docs/how-to/python.md", 8),
        ("docs/how-to/logs.md", 1),
        ("docs/how-to/method.md", 4),
        ("docs/how-to/cluster.md", 2),
    ],
)
def test_the_listings_of_a_document_run_from_top_to_bottom(
    document: str, least: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Ray has 70 MB: its listing is run by hand, last with 2.60.
    blocks = [block for block in listings(document) if block not in TASKS and "import ray" not in block]
    assert len(blocks) >= least
    shutil.copytree(ROOT / "scenes", tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)
    scope: dict[str, Any] = {}
    for block in blocks:
        exec(compile(block, document, "exec"), scope)


def test_picture_of_a_second_says_what_the_simulator_says(tmp_path: Path) -> None:
    drawn = tmp_path / "second.svg"
    subprocess.run([sys.executable, ROOT / "docs/pictures/second.py", drawn], check=True, cwd=tmp_path)
    counts = [
        re.findall(r"\d+ right, \d+ wrong in this second|>blind<", svg.read_text())
        for svg in (drawn, ROOT / "docs/pictures/second.svg")
    ]
    assert counts[0] == counts[1]
    assert len(counts[0]) == 4


def test_pictures_of_wiring_are_those_of_the_tables(tmp_path: Path) -> None:
    subprocess.run([sys.executable, ROOT / "docs/pictures/wiring.py", tmp_path], check=True)
    drawn = {picture.stem: picture.read_text() for picture in tmp_path.glob("*.svg")}
    assert drawn == {each.parent.name: each.read_text() for each in ROOT.glob("examples/*/wiring.svg")}
    assert len(drawn) == 5

"""The wheel is small, depends on NumPy alone, and is imported at once."""

import importlib
import os
import re
import shutil
import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path


def wheel() -> Path:
    """Return the tested wheel."""
    path = os.environ.get("EERUF_WHEEL")
    assert path is not None, "EERUF_WHEEL names the wheel; `cargo xtask python` sets it"
    return Path(path)


def test_the_wheel_is_small_and_for_python_3_9_on() -> None:
    # By the compilers that CI installs; by others a twentieth more.
    most = 6_650_000 * (1 if "EERUF_EXACT_SIZES" in os.environ else 1.05)
    assert wheel().stat().st_size < most, f"{wheel().stat().st_size} bytes; expected at most {most}"
    assert "-cp39-abi3-" in wheel().name
    assert metadata.metadata("eeruf")["Requires-Python"] == ">=3.9"


# Commands of workflows run on other systems' machines alone, so nothing else here would see that one cannot pass.
def test_commands_of_workflows_run() -> None:
    workflows = Path(__file__).parents[2] / ".github/workflows"
    programs = [
        program
        for workflow in sorted(workflows.glob("*.yml"))
        for program in re.findall(r"""python3? -c (?:"([^"]+)"|'([^']+)')""", workflow.read_text(encoding="utf8"))
    ]
    assert programs
    for program in programs:
        subprocess.run([sys.executable, "-c", "".join(program)], check=True, capture_output=True, text=True)


# Commands that install or publish something, or are CI itself; every other one of a workflow runs below.
ELSEWHERE = re.compile(
    r"(sudo )?(apt-get|cargo|git config|pip|gh|twine|abi3audit|\.ci/run|python -m pypi_attestations)\b"
)


def test_shell_commands_of_workflows_run(tmp_path: Path) -> None:
    root = Path(__file__).parents[2]
    program = os.environ.get("EERUF_PROGRAM")
    assert program is not None, "EERUF_PROGRAM names the program; `cargo xtask python` sets it"
    # The files that commands find in a clone after a build, and on the path.
    for name in ("target/any/wheel", "target/debug", "packaging", "python/eeruf", "bin"):
        (tmp_path / name).mkdir(parents=True)
    for name in (
        "README.md",
        "CHANGELOG.md",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "packaging/finish.py",
        "python/eeruf/_eeruf.pyi",
    ):
        shutil.copy(root / name, tmp_path / name)
    compiled = importlib.import_module("eeruf._eeruf").__file__
    assert compiled is not None
    shutil.copy(compiled, tmp_path / "target/debug/lib_eeruf.so")
    shutil.copy(program, tmp_path / "target/any/wheel/eeruf")
    for name, of in (("eeruf", program), ("python", sys.executable), ("python3", sys.executable)):
        (tmp_path / "bin" / name).write_text(f'#!/bin/sh\nexec "{of}" "$@"\n')
        (tmp_path / "bin" / name).chmod(0o755)
    run, text = (
        0,
        "\n".join(file.read_text(encoding="utf8") for file in sorted((root / ".github/workflows").glob("*.yml"))),
    )
    here = {"PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}", "TARGET": "any", "GITHUB_REF_NAME": "v1.2.3"}
    for block in re.findall(r"^( *)(?:- )?run: (?:\|\n((?:\1  .*\n|\n)+)|(.+)\n)", text, re.MULTILINE):
        lines = (block[1] or block[2]).splitlines()
        script = "\n".join(
            " && ".join(part for part in line.strip().split(" && ") if not ELSEWHERE.match(part)) for line in lines
        )
        run += bool(script.strip())
        done = subprocess.run(
            ["bash", "-euc", script], cwd=tmp_path, env={**os.environ, **here}, capture_output=True, text=True
        )
        assert done.returncode == 0, script + done.stderr
        shutil.rmtree(tmp_path / "tried", ignore_errors=True)
    assert run >= 6
    assert (tmp_path / "eeruf-1.2.3-any.tar.gz").stat().st_size > 1_000 and (tmp_path / "notes.md").stat().st_size > 100
    assert '"""' in (tmp_path / "python/eeruf/_eeruf.pyi").read_text(encoding="utf8")


def test_numpy_is_all_it_needs() -> None:
    needed = [line for line in metadata.requires("eeruf") or [] if "extra ==" not in line]
    assert [re.split(r"[<>=!~ ;]", line)[0] for line in needed] == ["numpy"]


def test_the_wheel_has_stubs_and_says_that_it_is_typed() -> None:
    names = zipfile.ZipFile(wheel()).namelist()
    assert {"eeruf/py.typed", "eeruf/_eeruf.pyi", "eeruf/plot/__init__.py", "eeruf/experiments.py"} <= set(names)
    assert not any("test" in name for name in names)


def test_the_wheel_has_its_licences() -> None:
    licenses = [name for name in zipfile.ZipFile(wheel()).namelist() if ".dist-info/licenses/" in name]
    for name in ("LICENSE-MIT", "LICENSE-APACHE", "font/LICENSE"):
        assert any(path.endswith(name) for path in licenses), licenses


def test_importing_brings_few_modules_and_no_slow_ones() -> None:
    program = "import sys; before = set(sys.modules); import eeruf; print(*sorted(set(sys.modules) - before))"
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    brought = set(run.stdout.split())
    assert {name for name in brought if name.split(".")[0] == "eeruf"} == {
        "eeruf",
        "eeruf._eeruf",
        "eeruf.nav",
        "eeruf.sim",
        "eeruf.tables",
    }
    # Written in C or as good as empty; typing or dataclasses alone would cost more than all of eeruf.
    assert {name for name in brought if name.split(".")[0] != "eeruf"} <= {"__future__", "_operator", "operator"}


def test_lazy_imports_are_listed() -> None:
    program = """
import eeruf
assert set(eeruf.__all__) <= set(dir(eeruf))
assert eeruf.read_log is eeruf.logs.read_log
from eeruf import *
print(read_log.__name__, eeruf.logs.__name__, eeruf.typing.__name__, Found.__name__)
try:
    eeruf.surveyy
except AttributeError as error:
    print(error)
"""
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert run.stdout.splitlines() == [
        "read_log eeruf.logs eeruf.typing Found",
        "module 'eeruf' has no attribute 'surveyy'",
    ]

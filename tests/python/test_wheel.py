"""The wheel is small, depends on NumPy alone, and is there at once."""

import os
import re
import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path


def wheel() -> Path:
    """The wheel that is tested."""
    path = os.environ.get("EERUF_WHEEL")
    assert path is not None, "EERUF_WHEEL names the wheel; `cargo xtask python` sets it"
    return Path(path)


def test_the_wheel_is_below_5_mb_and_for_every_python_from_3_9_on() -> None:
    assert wheel().stat().st_size < 5_000_000
    assert "-cp39-abi3-" in wheel().name
    assert metadata.metadata("eeruf")["Requires-Python"] == ">=3.9"


def test_numpy_is_all_it_needs() -> None:
    needed = [line for line in metadata.requires("eeruf") or [] if "extra ==" not in line]
    assert [re.split(r"[<>=!~ ;]", line)[0] for line in needed] == ["numpy"]


def test_the_wheel_has_stubs_and_says_that_it_is_typed() -> None:
    names = zipfile.ZipFile(wheel()).namelist()
    assert {"eeruf/py.typed", "eeruf/_eeruf.pyi", "eeruf/plot/__init__.py", "eeruf/experiments.py"} <= set(names)
    assert not any("test" in name for name in names)


def test_importing_brings_a_few_small_modules_and_numpy_only_when_there_are_arrays() -> None:
    program = "import sys; before = set(sys.modules); import eeruf; print(*sorted(set(sys.modules) - before))"
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    brought = {name.split(".")[0] for name in run.stdout.split()}
    costly = {
        "numpy",
        "asyncio",
        "concurrent",
        "multiprocessing",
        "matplotlib",
        "pandas",
        "polars",
        "tqdm",
        "dask",
        "socket",
        "ssl",
    }
    assert "eeruf" in brought
    assert not brought & costly, brought & costly
    assert {name for name in brought if name not in sys.stdlib_module_names} == {"eeruf"}

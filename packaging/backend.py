"""The build backend of `pip install .`: maturin, and `finish.py` for the wheel that it makes.

An editable installation keeps the repository's stub, which has no docstrings.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import finish
import maturin
from maturin import *  # noqa: F403


def build_wheel(
    wheel_directory: str,
    config_settings: Mapping[str, Any] | None = None,
    metadata_directory: str | None = None,
) -> str:
    """Build the wheel, with docstrings in its stub."""
    name: str = maturin.build_wheel(wheel_directory, config_settings, metadata_directory)
    wheel = Path(wheel_directory, name)
    with zipfile.ZipFile(wheel) as packed, tempfile.TemporaryDirectory() as folder:
        compiled = next(name for name in packed.namelist() if name.startswith("eeruf/_eeruf.") and name != finish.STUB)
        module = packed.extract(compiled, folder)
        # In a process of its own: Windows deletes no module that is loaded.
        finished = subprocess.run([sys.executable, finish.__file__, wheel, module])
    if finished.returncode != 0:
        print("no docstrings in the stub: this machine cannot load the module", file=sys.stderr)
    return name

"""Progress bars of ``progress=True``."""

from __future__ import annotations

import sys
from typing import Callable


def bar() -> Callable[[float | None, str], None]:
    """Return a bar of tqdm if it is installed, else a line on standard error."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return _line
    meter = tqdm(total=100, bar_format="{l_bar}{bar}| {elapsed}")

    def show(share: float | None, text: str) -> None:
        meter.set_description_str(text)
        if share is not None:
            meter.update(round(100 * share) - meter.n)
            if share >= 1:
                meter.close()

    return show


def _line(share: float | None, text: str) -> None:
    done = "" if share is None else f"{100 * share:3.0f} % "
    sys.stderr.write(f"\r{done}{text}" + ("\n" if share is not None and share >= 1 else ""))
    sys.stderr.flush()

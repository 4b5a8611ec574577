"""Logs other than local paths: file objects, and everything that fsspec opens."""

from __future__ import annotations

import contextlib
import io
import os
from typing import TYPE_CHECKING

from eeruf._eeruf import EerufError

if TYPE_CHECKING:
    from collections.abc import Iterator


class _Text:
    """A stream of bytes from a file object that gives text."""

    def __init__(self, file: io.TextIOBase) -> None:
        self._file = file

    def read(self, size: int) -> bytes:
        return self._file.read(size).encode()


@contextlib.contextmanager
def opened_log(log: object, expected: str = "the path of a log, a URL or a file object") -> Iterator[object]:
    """Return a path unchanged, and a file object with its name; close what was opened."""
    is_url = isinstance(log, str) and "://" in log
    if is_url:
        try:
            import fsspec
        except ImportError:
            raise EerufError(f"log = {log!r:.60}; expected fsspec, which opens it: pip install fsspec") from None
        files, path = fsspec.core.url_to_fs(log)
    elif isinstance(log, io.TextIOBase):
        yield _Text(log), _name(log)
        return
    elif hasattr(log, "read"):
        yield log, _name(log)
        return
    elif hasattr(log, "fs") and hasattr(log, "path"):
        files, path = log.fs, log.path
    elif isinstance(log, (str, os.PathLike)):
        yield log
        return
    else:
        raise EerufError(f"log = {log!r:.60}; expected {expected}")
    name = str(log) if is_url else str(path)
    if not name.endswith("/"):
        with files.open(path, "rb") as file:
            yield file, name
        return
    from tempfile import TemporaryDirectory

    with TemporaryDirectory(prefix="eeruf-") as folder:
        files.get(path.rstrip("/") + "/", folder + "/", recursive=True)
        yield folder


def _name(file: object) -> str:
    name = getattr(file, "full_name", None) or getattr(file, "name", None)
    return name if isinstance(name, str) else "the log"

"""Writes the docstrings of the compiled module into its stub, where editors look for them: `python tests/python/stub.py`."""

from __future__ import annotations

import ast
import inspect
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Union

from eeruf import _eeruf

STUB = Path(__file__).parents[2] / "python" / "eeruf" / "_eeruf.pyi"
Documented = Union[ast.ClassDef, ast.FunctionDef]


def documented(stub: ast.Module) -> Iterator[tuple[str, Documented, str | None]]:
    """The public classes, functions, methods and properties of a stub, each with what the compiled module says of it."""

    def each(nodes: list[ast.stmt], owner: object, name: str) -> Iterator[tuple[str, Documented, str | None]]:
        for node in nodes:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_"):
                thing = inspect.getattr_static(owner, node.name)
                said = getattr(thing.__func__ if isinstance(thing, staticmethod) else thing, "__doc__", None)
                yield f"{name}{node.name}", node, inspect.cleandoc(said) if said else None
                if isinstance(node, ast.ClassDef):
                    yield from each(node.body, thing, f"{name}{node.name}.")

    yield from each(stub.body, _eeruf, "")


def without_docstrings(text: str) -> str:
    """The stub as it was before."""
    lines = text.splitlines()
    nodes = [node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.ClassDef, ast.FunctionDef))]
    for node in sorted(nodes, key=lambda node: node.lineno, reverse=True):
        first = node.body[0]
        if ast.get_docstring(node) is not None:
            assert first.end_lineno is not None
            alone = len(node.body) == 1
            del lines[first.lineno - 1 : first.end_lineno]
            if alone:
                lines[first.lineno - 2] += " ..."
    return "\n".join(lines) + "\n"


def with_docstrings(text: str) -> str:
    """The stub with the docstrings of the compiled module."""
    text = without_docstrings(text)
    lines = text.splitlines()
    found = sorted(documented(ast.parse(text)), key=lambda found: found[1].lineno, reverse=True)
    for _, node, said in found:
        if said is None:
            continue
        indent = " " * (node.col_offset + 4)
        quoted = ('r"""' if "\\" in said else '"""') + said + ("\n" if "\n" in said else "") + '"""'
        body = [indent + line if line else "" for line in quoted.splitlines()]
        first = node.body[0]
        header = min([first.lineno, *(line.lineno for line in getattr(first, "decorator_list", []))]) - 1
        if isinstance(first, ast.Expr) and lines[header].endswith(": ..."):
            lines[header] = lines[header][: -len(" ...")]
            header += 1
        lines[header:header] = body
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    STUB.write_text(with_docstrings(STUB.read_text()))
    subprocess.run([sys.executable, "-m", "ruff", "format", "--quiet", STUB], check=True)

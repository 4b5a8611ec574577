"""Finishes what maturin packs: `python finish.py WHEEL|STUB MODULE`.

Editors show the docstrings of a stub, not those of a compiled module, and the repository has them in Rust alone: this
writes those of MODULE into the stub. It also makes wheels from different folders equal: the bill
of materials that maturin writes names packages by that folder; here they are named from the repository's root.
"""

from __future__ import annotations

import ast
import base64
import hashlib
import inspect
import re
import sys
import zipfile
from collections.abc import Iterator
from importlib.machinery import ExtensionFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType
from typing import Union

STUB = "eeruf/_eeruf.pyi"
Documented = Union[ast.ClassDef, ast.FunctionDef]


def load(file: Path) -> ModuleType:
    """Load the compiled module in a file, without the package around it, which needs NumPy."""
    loader = ExtensionFileLoader("_eeruf", str(file))
    spec = spec_from_loader("_eeruf", loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def documented(stub: ast.Module, module: ModuleType) -> Iterator[tuple[str, Documented, str | None]]:
    """Yield the public classes, functions, methods and properties of a stub, each with its docstring in the module."""

    def each(nodes: list[ast.stmt], owner: object, name: str) -> Iterator[tuple[str, Documented, str | None]]:
        for node in nodes:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and not node.name.startswith("_"):
                thing = inspect.getattr_static(owner, node.name)
                said = getattr(thing.__func__ if isinstance(thing, staticmethod) else thing, "__doc__", None)
                yield f"{name}{node.name}", node, inspect.cleandoc(said) if said else None
                if isinstance(node, ast.ClassDef):
                    yield from each(node.body, thing, f"{name}{node.name}.")

    yield from each(stub.body, module, "")


def with_docstrings(text: str, module: ModuleType) -> str:
    """Return the stub with the docstrings of the module, and the names of its methods."""
    names = ", ".join(f'"{name}"' for name in module.METHODS)
    text = re.sub(r"^_MethodName = .*$", f"_MethodName = Literal[{names}]", text, flags=re.MULTILINE)
    lines = text.splitlines()
    found = sorted(documented(ast.parse(text), module), key=lambda found: found[1].lineno, reverse=True)
    for _, node, said in found:
        if said is None or ast.get_docstring(node) is not None:
            continue
        indent = " " * (node.col_offset + 4)
        quoted = ('r"""' if "\\" in said else '"""') + said + ("\n" if "\n" in said else "") + '"""'
        body = [indent + line if line else "" for line in quoted.splitlines()]
        first = node.body[0]
        header = min([first.lineno, *(line.lineno for line in getattr(first, "decorator_list", []))]) - 1
        if isinstance(first, ast.Expr) and lines[header].endswith(": ..."):
            lines[header] = lines[header][: -len(" ...")]
            header += 1
            if node.col_offset == 0 and lines[header:] and lines[header]:
                body.append("")
        lines[header:header] = body
    return "\n".join(lines) + "\n"


def finish(wheel: Path, module: ModuleType) -> None:
    """Write the wheel again, with the docstrings of the module."""
    with zipfile.ZipFile(wheel) as old:
        entries = [(info, old.read(info)) for info in old.infolist()]
    contents = {info.filename: content for info, content in entries}
    contents[STUB] = with_docstrings(contents[STUB].decode(), module).encode()
    for name in contents:
        if "/sboms/" in name:
            at_root = rb"path+file:///eeruf\1"
            contents[name] = re.sub(rb'path\+file://[^#"]*?(/crates/[a-z0-9-]+)?(?=#)', at_root, contents[name])
    record = next(name for name in contents if name.endswith(".dist-info/RECORD"))
    lines = []
    for name, content in contents.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
        lines.append(f"{name},," if name == record else f"{name},sha256={digest},{len(content)}")
    contents[record] = ("\n".join(lines) + "\n").encode()

    packed = wheel.with_suffix(".packed")
    with zipfile.ZipFile(packed, "w") as new:
        for info, _ in entries:
            entry = zipfile.ZipInfo(info.filename, info.date_time)
            entry.external_attr = info.external_attr
            new.writestr(entry, contents[info.filename], zipfile.ZIP_DEFLATED, 9)
    print(f"{wheel.name}: {wheel.stat().st_size} bytes, finished {packed.stat().st_size}")
    packed.replace(wheel)


if __name__ == "__main__":
    file, module = Path(sys.argv[1]), load(Path(sys.argv[2]))
    if file.suffix == ".pyi":
        file.write_text(with_docstrings(file.read_text(encoding="utf-8"), module), encoding="utf-8")
    else:
        finish(file, module)

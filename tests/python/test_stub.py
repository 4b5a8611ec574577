"""The wheel's stub has the docstrings of the compiled module, for editors to show; the repository has them in Rust alone."""

import ast
import hashlib
import importlib.util
from base64 import urlsafe_b64encode
from importlib import metadata
from pathlib import Path
from typing import Union

from eeruf import _eeruf

ROOT = Path(__file__).parents[2]


def stubs() -> tuple[ast.Module, ast.Module]:
    """Return the stub in the repository and the installed one."""
    assert _eeruf.__file__ is not None
    files = (ROOT / "python/eeruf/_eeruf.pyi", Path(_eeruf.__file__).with_name("_eeruf.pyi"))
    kept, installed = (ast.parse(file.read_text(encoding="utf-8")) for file in files)
    return kept, installed


def definitions(stub: ast.Module) -> list[Union[ast.ClassDef, ast.FunctionDef]]:
    """Return the statements of a stub that may have a docstring."""
    return [node for node in ast.walk(stub) if isinstance(node, (ast.ClassDef, ast.FunctionDef))]


def named_methods(stub: ast.Module) -> str:
    """Remove the type of a method's name from the stub, and return it."""
    found = next(
        node for node in stub.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "_MethodName"
    )
    stub.body.remove(found)
    return ast.unparse(found.value)


def test_installed_stub_has_docstrings_of_module() -> None:
    spec = importlib.util.spec_from_file_location("finish", ROOT / "packaging/finish.py")
    assert spec is not None and spec.loader is not None
    finish = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(finish)
    _, installed = stubs()
    found = list(finish.documented(installed, _eeruf))
    assert len(found) > 290
    assert not [name for name, node, said in found if not said or ast.get_docstring(node) != said]


def test_kept_stub_has_signatures_alone() -> None:
    kept, installed = stubs()
    assert not [node.name for node in definitions(kept) if ast.get_docstring(node)]
    names = [named_methods(stub) for stub in (kept, installed)]
    assert names == ["str", f"Literal{list(_eeruf.METHODS)}"]
    for stub in (kept, installed):
        for node in definitions(stub):
            # Without docstrings and ellipses.
            node.body = [line for line in node.body if not isinstance(line, ast.Expr)]
    assert ast.dump(installed) == ast.dump(kept)


def test_record_has_digests_of_installed_files() -> None:
    files = [file for file in metadata.files("eeruf") or [] if file.hash]
    assert "_eeruf.pyi" in {file.name for file in files}
    for file in files:
        assert file.hash is not None
        digest = hashlib.new(file.hash.mode, file.read_binary()).digest()
        assert urlsafe_b64encode(digest).decode().rstrip("=") == file.hash.value, file

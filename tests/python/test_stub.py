"""The stub says what the compiled module says, so that editors show it."""

import ast
import importlib.util
from pathlib import Path

HERE = Path(__file__).parent


def test_stub_has_the_docstrings_of_the_compiled_module() -> None:
    spec = importlib.util.spec_from_file_location("stub", HERE / "stub.py")
    assert spec is not None and spec.loader is not None
    stub = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(stub)
    found = list(stub.documented(ast.parse(stub.STUB.read_text())))
    assert len(found) > 300
    differing = [name for name, node, said in found if ast.get_docstring(node) != said]
    assert not differing, f"{differing[:5]} and others differ; run `python tests/python/stub.py`"
    assert all(said for _, _, said in found)

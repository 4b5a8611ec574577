"""The examples in the docstrings hold, and the notebooks run."""

import doctest
import importlib

import pytest


@pytest.mark.parametrize("name", ["eeruf", "eeruf._sweep", "eeruf.experiments", "eeruf.plot", "eeruf.tables"])
def test_the_examples_in_the_docstrings_hold(name: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    failed, tried = doctest.testmod(importlib.import_module(name))
    assert tried > 0
    assert failed == 0

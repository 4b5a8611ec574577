"""Fixtures of every test."""

import signal
import sys
from collections.abc import Iterator

import pytest


def pytest_configure(config: pytest.Config) -> None:
    """Let Ctrl-C reach the tested processes: one that a shell starts in the background ignores it, and so do its children.

    Small numbers, about which the wheel warns, are usual in tests.
    """
    config.addinivalue_line("filterwarnings", "ignore::eeruf.EerufWarning")
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True)
def figures_are_closed() -> Iterator[None]:
    """Close the figures that a test drew, if any."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")

"""A short run of the fuzz harness; the long one is run by hand."""

import importlib.util
import inspect
from pathlib import Path

import eeruf

HARNESS = Path(__file__).with_name("fuzz.py")


def test_every_function_and_method_is_called_with_anything() -> None:
    called, missing = HARNESS.read_text(), set()
    for module in (eeruf, eeruf.experiments, eeruf.logs, eeruf.nav, eeruf.sim):
        for name in (name for name in dir(module) if not name.startswith("_")):
            thing = getattr(module, name)
            if inspect.isclass(thing) and not issubclass(thing, Exception):
                members = [member for member in dir(thing) if not member.startswith("_")]
                callables = [member for member in members if callable(getattr(thing, member, None))]
                missing |= {f"{name}.{member}" for member in callables if f".{member}" not in called}
            elif inspect.isroutine(thing) and str(thing.__module__).startswith("eeruf") and f".{name}" not in called:
                missing.add(name)
    # It has no arguments, and prints.
    assert missing == {"show_versions"}


def test_thousands_of_calls_end_well_in_level_memory() -> None:
    spec = importlib.util.spec_from_file_location("fuzz", HARNESS)
    assert spec is not None
    assert spec.loader is not None
    harness = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(harness)
    ended, tenths = harness.fuzz(5_000, seed=1)
    assert ended["fine"] > 500
    assert ended["EerufError"] > 1_000
    assert len(tenths) == 10
    # Caches still fill; the long run has narrower bounds.
    assert harness.grown(tenths).resident_mb < 40, tenths
    assert harness.grown(tenths).heap_mb < 2, tenths

"""A short run of the fuzz harness; the long one is run by hand."""

import importlib.util
from pathlib import Path


def test_a_few_thousand_calls_with_anything_end_well_and_the_process_does_not_grow() -> None:
    spec = importlib.util.spec_from_file_location("fuzz", Path(__file__).with_name("fuzz.py"))
    assert spec is not None
    assert spec.loader is not None
    harness = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(harness)
    ended, grown_mb = harness.fuzz(5_000, seed=1)
    assert ended["fine"] > 500
    assert ended["ArgumentError"] > 1_000
    # A single large search may leave its pages behind; the long run shows that they stay as many.
    assert grown_mb < 500

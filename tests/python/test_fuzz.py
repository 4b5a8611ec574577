"""A short run of the fuzz harness; the long one is run by hand."""

import importlib.util
from pathlib import Path


def test_a_few_thousand_calls_with_anything_end_well_and_the_process_does_not_grow() -> None:
    spec = importlib.util.spec_from_file_location("fuzz", Path(__file__).with_name("fuzz.py"))
    assert spec is not None
    assert spec.loader is not None
    harness = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(harness)
    ended, tenths = harness.fuzz(5_000, seed=1)
    assert ended["fine"] > 500
    assert ended["ArgumentError"] > 1_000
    assert len(tenths) == 10
    # Caches still fill; the long run has narrower bounds.
    assert harness.grown(tenths).resident_mb < 40, tenths
    assert harness.grown(tenths).heap_mb < 2, tenths

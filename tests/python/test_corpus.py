"""The shared corpus comes out in Python as it does in Rust."""

import functools
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import eeruf
import pytest
from eeruf import sim

DATA = Path(__file__).parents[1] / "data"


def corpus(name: str) -> Any:
    return json.loads((DATA / name).read_text())


@pytest.mark.parametrize("case", corpus("critical-paths.json")["cases"], ids=lambda case: str(case["id"]))
def test_every_path_of_the_corpus_is_found(case: dict[str, Any]) -> None:
    scene = sim.Scene(case["walls"], open=case["open"], two_sided=case.get("two_sided"), physics="plain")
    paths = scene.paths(case["source"], case["receivers"], case["max_order"])
    found: list[set[tuple[int, ...]]] = [set() for _ in case["receivers"]]
    for receiver, order, length_m, walls in zip(paths.receiver, paths.order, paths.length_m, paths.walls):
        known = {tuple(path[2]): (path[1], path[0]) for path in case["paths"][receiver]}
        assert known[walls][0] == order
        assert known[walls][1] == pytest.approx(length_m, abs=1e-9)
        found[receiver].add(walls)
    assert [len(walls) for walls in found] == [len(paths) for paths in case["paths"]]


@functools.cache
def rust() -> Any:
    """Return Rust's figures for the corpus, to the last bit."""
    program = os.environ.get("EERUF_LAB")
    assert program is not None, "EERUF_LAB names the built eeruf-lab; `cargo xtask python` sets it"
    return json.loads(subprocess.run([program, "rust-side", "paths"], check=True, capture_output=True).stdout)


@pytest.mark.parametrize("case", corpus("critical-paths.json")["cases"], ids=lambda case: str(case["id"]))
def test_paths_are_those_of_rust_to_the_last_bit(case: dict[str, Any]) -> None:
    scene = sim.Scene(
        case["walls"],
        open=case["open"],
        two_sided=case.get("two_sided"),
        poles=case.get("poles"),
        physics="plain",
    )
    paths = scene.paths(case["source"], case["receivers"], case["max_order"])
    expected = rust()[case["id"]]
    assert len(expected["length_m"]) > 0
    for name in ("receiver", "length_m", "order", "departure_rad", "arrival_rad", "amplitude"):
        assert getattr(paths, name).tolist() == expected[name], name
    assert [list(walls) for walls in paths.walls] == expected["walls"]


def separated(case: dict[str, Any]) -> int:
    """Convert a separation in ms to T_delta in us."""
    return int(case["separation"]) * 500 - 1


@pytest.mark.parametrize("case", corpus("wait-tables.json")["cases"], ids=lambda case: str(case["count"]))
def test_tables_of_waits_are_counted_as_in_the_corpus(case: dict[str, Any]) -> None:
    period_us = 1000 * int(case["period"])
    search = eeruf.WaitSearch(
        case["sensors"],
        period_us,
        1000 * case["wait_max"],
        1000,
        [period_us * (x % case["group"]) // case["group"] // 1000 * 1000 for x in range(case["sensors"])],
        t_delta_us=separated(case),
        min_interval_us=1000 * case["min_interval"],
        neighbours=case["neighbours"],
        layout=case["layout"],
        criterion=case["criterion"],
    )
    assert search.count() == case["count"]


@pytest.mark.parametrize(
    "case",
    corpus("shortest-periods.json")["cases"],
    ids=lambda case: "-".join(str(case[name]) for name in ("sensors", "layout", "window", "stale_echo")),
)
def test_the_shortest_periods_of_the_corpus_come_out_proven(case: dict[str, Any]) -> None:
    needs = {
        "t_delta_us": (case["separation"] * case["tick_us"] - 1) // 2,
        "min_interval_us": case["min_interval"] * case["tick_us"],
        "window_us": case["window"] * case["tick_us"],
        "neighbours": case["neighbours"],
        "layout": case["layout"],
        "stale_echo": case["stale_echo"],
    }
    found = eeruf.design(case["sensors"], tick_us=case["tick_us"], **needs)
    assert found.proven
    assert found.value_us == case["period"] * case["tick_us"]
    assert found.schedule is not None
    assert found.schedule.verify(**needs).ok


def test_points_run_from_source_to_receiver() -> None:
    case = corpus("critical-paths.json")["cases"][0]
    paths = sim.Scene(case["walls"], physics="plain").paths(case["source"], case["receivers"], 3)
    for path in range(len(paths)):
        points = paths.points(path)
        assert points.shape == (int(paths.order[path]) + 2, 2)
        assert points[0].tolist() == case["source"]
        assert points[-1].tolist() == case["receivers"][int(paths.receiver[path])]


def test_the_papers_best_table_keeps_neighbours_19_ms_apart() -> None:
    search = eeruf.WaitSearch(12, 100_000, 24_000, 1000, t_delta_us=999, min_interval_us=15_000, criterion="exact")
    found = search.best("interval")
    assert found.proven
    assert found.value_us == 19_000
    assert found.schedule is not None
    assert found.schedule.verify(999, min_interval_us=19_000).ok
    first = next(search.all())
    assert first.verify(999, min_interval_us=15_000).ok

"""Results are frozen, have one name for one figure, and become plain values."""

import dataclasses
import json
import pickle
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import experiments, nav, sim, tables

ROBOT = sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)
ROOM = sim.Scene([[5, 2, -5, 2]], robots=[ROBOT])


def some_of_each() -> dict[str, Any]:
    """Make one result of every kind, by the name of its class."""
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    events = [event for _ in range(60) if (event := ring.poll(ring.next_deadline_us)) is not None]
    set_one = experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
    set_two = experiments.set_two(seeds=1, methods=["eeruf"])
    speeds = experiments.speed_sweep([0.75], seeds=1, methods=["eeruf"])
    figures = set_one.methods["eeruf"]
    return {
        type(result).__name__: result
        for result in [
            eeruf.design(4, 999, 15_000, 36_000, certificate=True),
            tables.TABLE_I_B.verify(999, min_interval_us=15_000),
            tables.TABLE_I_B.verify(999, min_interval_us=15_000).violations[0],
            tables.TABLE_I_D,
            *events,
            eeruf.typing.Blind(3, 20),
            eeruf.State("unknown", None, 256, "ambiguous", "history"),
            nav.Vfh().steer(nav.Himm(), (0, 0), (5, 0)),
            sim.Simulation(ROOM).robots[0],
            eeruf.typing.FiredReading(
                eeruf.EchoFilter(1, 500).push(0, 9_000), (9_000, 11_000), 0.5, levels_db=(12.5, 3.0)
            ),
            sim.simulate(ROOM, periods=20).summary(),
            set_one,
            figures,
            figures.wrong_of_all,
            figures.nearer,
            set_two,
            set_two.methods["eeruf"],
            set_two.runs["eeruf"][0],
            speeds,
            speeds.steps[0],
        ]
    }


RESULTS = some_of_each()


def test_there_is_a_result_of_every_kind() -> None:
    assert set(RESULTS) == set(
        """Found Report Violation Schedule Fire Reading PeriodEnded Blind State Steering RobotState FiredReading
        Summary SetOne
        SetOneFigures Spread Latency SetTwo SetTwoFigures Run SpeedSweep SpeedStep""".split()
    )


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_becomes_a_dict_that_json_writes_and_reads(name: str) -> None:
    shown = RESULTS[name].to_dict()
    assert shown
    assert json.loads(json.dumps(shown)) == shown
    for field in shown:
        assert hasattr(RESULTS[name], field)


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_cannot_be_written_to_and_says_its_fields(name: str) -> None:
    result = RESULTS[name]
    field = next(iter(result.to_dict()))
    with pytest.raises((AttributeError, dataclasses.FrozenInstanceError)):
        setattr(result, field, 1)
    assert repr(result).lstrip("<").startswith(name)
    # A report is ok if it has no violations, and all numbers of a schedule stand in its repr without their names.
    assert name in ("Report", "Schedule") or field + "=" in repr(result)
    assert result == result and result != 3


@pytest.mark.parametrize("name", [name for name in RESULTS if name not in ("PeriodEnded", "Steering", "RobotState")])
def test_a_result_pickles(name: str) -> None:
    assert pickle.loads(pickle.dumps(RESULTS[name])) == RESULTS[name]


def test_a_figure_has_one_name_in_all_results() -> None:
    summary, spread = RESULTS["Summary"].to_dict(), RESULTS["SetOneFigures"].to_dict()
    of_simulations = {"method", "readings", "accepted"}
    of_geometries = {"starved_95", "nearer", "farther", "new_step"}
    assert set(summary) - of_simulations == set(spread) - of_geometries
    two, run = RESULTS["SetTwoFigures"].to_dict(), RESULTS["Run"].to_dict()
    # A share and a count are two figures: those of a run that have the same name are counts in both.
    for name in set(run) & set(two):
        assert name in ("top_speed_m_s", "nearest_m", "phantom_echoes", "phantom_cells"), name
    for name in ("wrong_of_all", "rejected", "readings_per_s"):
        assert isinstance(two[name], float) and isinstance(summary[name], float), name


def test_equal_runs_and_results_are_equal_and_others_are_not() -> None:
    again = experiments.set_two(seeds=1, methods=["eeruf"])
    assert again == RESULTS["SetTwo"]
    other = dataclasses.replace(again.runs["eeruf"][0], grid=np.zeros((0, 3)))
    assert other != again.runs["eeruf"][0]
    assert dataclasses.replace(again, runs={"eeruf": [other]}) != again


@pytest.mark.parametrize("by", [3, "history"])
def test_an_ambiguous_reading_names_its_explanation(by: Any) -> None:
    reading = eeruf.Reading(0, "ambiguous", 9_000, explained_by=by)
    assert reading.explained_by == reading.to_dict()["explained_by"] == by
    assert eval(repr(reading), {"Reading": eeruf.Reading}) == pickle.loads(pickle.dumps(reading)) == reading
    assert reading != eeruf.Reading(0, "ambiguous", 9_000)


def test_a_table_prints_as_one() -> None:
    table = eeruf.experiments.set_one(2, readings=400, methods=["eeruf", "conventional"])
    head, *rows = str(table).splitlines()
    assert head.split("  ")[0] == "method" and "wrong of all % (95 %)" in head
    assert "    wrong_of_all: Share of all readings that" in (eeruf.typing.Summary.__doc__ or "")
    assert [row.split()[0] for row in rows] == ["eeruf", "conventional"] and len(str(table)) < 500
    low, high = (100 * bound for bound in table.methods["eeruf"].rejected.median_95)  # type: ignore[union-attr]
    assert f"({low:.1f} to {high:.1f})" in rows[0]
    assert table._repr_html_().count("<tr>") == 3
    assert "0.75 m/s, finished %" in str(eeruf.experiments.speed_sweep([0.75], seeds=1, methods=["eeruf"]))
    assert "courses" in str(eeruf.experiments.set_two(1, methods=["eeruf"]))
    assert "others of accepted %" in str(eeruf.experiments.set_three(1, methods=["eeruf"]))

"""Whatever is wrong raises one clear error, and nothing panics."""

import math
from typing import Any, Callable

import eeruf
import numpy as np
import pytest
from eeruf import sim, tables
from hypothesis import given, settings
from hypothesis import strategies as st

ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(-2, 70),
    st.floats(),
    st.text(max_size=3),
    st.lists(st.integers(-1, 2**33), max_size=3),
)

BAD: list[tuple[Callable[[], Any], type[Exception], str]] = [
    (lambda: eeruf.design(0, 1, 1, 1), eeruf.ArgumentError, "sensors = 0; expected a whole number from 1 to 64"),
    (lambda: eeruf.design(65, 1, 1, 1), eeruf.ArgumentError, "sensors = 65"),
    (lambda: eeruf.design(4, -1, 1, 1), eeruf.ArgumentError, "t_delta_us = -1"),
    (lambda: eeruf.design(4, 1, 1, 0), eeruf.ArgumentError, "window_us = 0"),
    (lambda: eeruf.Schedule(10, (1, 2), (1,), (2,)), eeruf.ScheduleError, "phase a has 1 waits; expected one for each"),
    (lambda: eeruf.EchoFilter(4, 500, 9), eeruf.FilterError, "9 consecutive readings; expected 2 to 8"),
    (
        lambda: eeruf.EchoFilter(4, 500).push(4, 1),
        eeruf.ArgumentError,
        "sensor = 4; expected a whole number from 0 to 3",
    ),
    (lambda: eeruf.EchoFilter(4, 500).push_many(np.zeros((2, 3))), eeruf.ArgumentError, "shape of t_echo_us"),
    (lambda: eeruf.EchoFilter(1, 500).push_many([[1], [-1]]), eeruf.ArgumentError, r"t_echo_us\[1, 0\] = -1"),
    (lambda: eeruf.Ring(tables.TABLE_I_D, 500, window_us=0), eeruf.RingError, "window of 0 us"),
    (lambda: eeruf.WaitSearch(4, 100, 10, 0, t_delta_us=1), eeruf.SearchError, "tick"),
    (lambda: sim.Scene([[0, 0, math.nan, 1]]), eeruf.SceneError, "wall 0"),
    (lambda: sim.Scene([[0, 0, 1]]), eeruf.ArgumentError, "shape of walls"),
    (lambda: sim.Scene([[0, 0, 1, 0]]).paths((0, math.nan), [(1, 1)], 2), eeruf.PathsError, "source"),
    (lambda: sim.simulate(sim.Scene([[0, 0, 1, 0]])), eeruf.SceneError, "0 robots"),
    (lambda: eeruf.experiments.set_one(0), eeruf.ArgumentError, "seeds = 0"),
    (lambda: eeruf.experiments.set_one(1, methods=["loud"]), eeruf.ArgumentError, "no method `loud`"),
    (lambda: eeruf.experiments.set_one(1, methods=[]), eeruf.ExperimentError, "no methods"),
]


@pytest.mark.parametrize(("call", "error", "message"), BAD, ids=[message for _, _, message in BAD])
def test_bad_input_is_told_by_name_value_and_expectation(
    call: Callable[[], Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message) as told:
        call()
    assert isinstance(told.value, eeruf.EerufError)
    assert isinstance(told.value, ValueError)


@settings(deadline=None)
@given(st.lists(ANYTHING, min_size=4, max_size=4), ANYTHING)
def test_nothing_panics_whatever_it_is_given(arguments: list[Any], layout: Any) -> None:
    design: Any = eeruf.design
    calls: list[Callable[[], Any]] = [
        lambda: design(*arguments, layout=layout, budget=100),
        lambda: eeruf.Schedule(*arguments),
        lambda: eeruf.Schedule.from_firing(*arguments[:3]),
        lambda: tables.TABLE_I_D.verify(arguments[0], arguments[1], arguments[2], layout),
        lambda: tables.TABLE_I_D.scaled(*arguments[:2]),
        lambda: eeruf.EchoFilter(arguments[0], arguments[1], arguments[2]).push(0, arguments[3]),
        lambda: eeruf.Ring(tables.TABLE_I_D, arguments[0], arguments[1], window_us=arguments[2]).poll(arguments[3]),
        lambda: sim.Scene([[0, 0, 1, 0]], open=layout).paths(arguments[0], arguments[1], arguments[2]),
    ]
    for call in calls:
        try:
            call()
        except (eeruf.EerufError, TypeError):
            pass

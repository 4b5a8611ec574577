"""One wrong value for each argument of each public callable is one error with name and expectation."""

import inspect
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import eeruf
import pytest
from eeruf import experiments, logs, nav, sim, tables

RINGS = Path(__file__).parents[2] / "rings"
ROOM = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)])
RING = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
FIRINGS = logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])
OBJECTS: list[Any] = [
    RING,
    FIRINGS,
    ROOM,
    tables.TABLE_I_D,
    ROOM.paths((0, 0), (1, 0), 1),
    eeruf.Ring.flow(8, window_us=30_000),
    eeruf.EchoFilter(4, 500),
    eeruf.Adaptation([tables.TABLE_I_D], 500),
    eeruf.SensorWatch(4),
    eeruf.WaitSearch(4, 40_000, 8_000, 1_000, t_delta_us=999),
    eeruf.design(3, 500, 9_000, 20_000),
    nav.Himm(),
    nav.Vfh(),
    sim.Simulation(ROOM),
    sim.Batch([ROOM]),
    sim.simulate(ROOM, periods=3),
    sim.simulate_blocks(ROOM, periods=4, block_periods=2),
]
# Right values, since an argument has the same meaning everywhere.
RIGHT: dict[str, Any] = {
    "sensors": 8,
    "schedule": tables.TABLE_I_D,
    "schedules": [tables.TABLE_I_D],
    "period_us": 60_000,
    "t_delta_us": 500,
    "min_interval_us": 9_000,
    "window_us": 30_000,
    "wait_max_us": 8_000,
    "tick_us": 1_000,
    "step_us": 240,
    "t_lag_us": [0, 1_000],
    "t_wait_a_us": [0, 1_000],
    "t_wait_b_us": [0, 2_000],
    "t_fire_a_us": [0, 1_000],
    "t_fire_b_us": [0, 2_000],
    "t_echo_us": 5_000,
    "t_echoes_us": [5_000],
    "expected_change_us": 0,
    "at_us": 0,
    "now_us": 0,
    "sensor": 0,
    "phase": 0,
    "num": 1,
    "den": 2,
    "ring": RING,
    "event": eeruf.Fire(0),
    "kind": "first",
    "reading": eeruf.Reading(0, "first"),
    "scene": ROOM,
    "scenes": [ROOM],
    "walls": [[5, 2, -5, 2]],
    "pose": (0, 0, 1.57),
    "spacing_rad": 0.26,
    "radius_m": 0.3,
    "source": (0, 0),
    "receivers": (1, 0),
    "max_order": 1,
    "readings": sim.simulate(ROOM, periods=3),
    "seconds": 0.1,
    "robot": 0,
    "v_m_s": 0.1,
    "w_rad_s": 0.1,
    "grid": nav.Himm(),
    "place": (0, 0),
    "point": (0, 0),
    "target": (1, 1),
    "range_m": 1.0,
    "function": abs,
    "cases": [1],
    "need": "range",
    "log": "nowhere.csv",
    "judge": logs.Agree(500),
    "name": "scenes/alcove.toml",
    "text": "x",
    "path": "nowhere.toml",
    "reflection": 0.5,
    "direction_rad": 0.0,
    "separation_us": 1,
    "max_t_delta_us": 1,
    "violations": [],
    "value_us": 1,
    "required_us": 5,
    "numbers": range(1),
}
# Right values of names with two meanings, and of optional arguments without which others do nothing.
RIGHT_OF: dict[str, dict[str, Any]] = {
    **{
        key: {"sensors": 4, "t_delta_us": 999, "min_interval_us": 15000, "window_us": 36000}
        for key in ("eeruf.curve", "eeruf.design", "eeruf.fit")
    },
    **{key: {"window_us": 36000} for key in ("eeruf.Ring", "eeruf.Ring.flow")},
    "eeruf.sim.Readings.from_arrays": {"sensor": [0], "fired_s": [0.0], "t_echo_us": [5_000.0]},
    "eeruf.sim.Robot": {"sensors": 8, "spacing_rad": 0.26, "radius_m": 0.3},
    "eeruf.typing.Scenes": {"kind": "alcove"},
    "eeruf.experiments.recommend": {"ring": RINGS / "hc-sr04-8.toml"},
    "eeruf.experiments.rooms": {"ring": RINGS / "hc-sr04-8.toml"},
    **{name: {"log": FIRINGS} for name in ("eeruf.logs.diagnose", "eeruf.logs.survey")},
    "Himm().clear": {"sensor": (0, 0, 0)},
    "Himm().echo": {"sensor": (0, 0, 0)},
}


def callables() -> Iterator[tuple[str, Any]]:
    """Yield everything that users call: functions, classes except records and errors, and methods."""
    for module in (eeruf, sim, nav, experiments, logs):
        for name in module.__all__:
            thing = getattr(module, name)
            if not callable(thing) or hasattr(thing, "__dataclass_fields__"):
                continue
            if isinstance(thing, type) and issubclass(thing, (Exception, Warning)):
                continue
            yield f"{module.__name__}.{name}", thing
            if isinstance(thing, type):
                yield from ((f"{module.__name__}.{name}.{of}", getattr(thing, of)) for of in static(thing))
    for thing in OBJECTS:
        kind = type(thing)
        for of in sorted(set(dir(kind)) - set(static(kind))):
            if of[0] != "_" and callable(getattr(kind, of, None)):
                yield f"{kind.__name__}().{of}", getattr(thing, of)


def static(kind: type) -> list[str]:
    """Return the functions of a class that need no object."""
    is_static = (staticmethod, classmethod)
    return [of for of in sorted(dir(kind)) if of[0] != "_" and isinstance(inspect.getattr_static(kind, of), is_static)]


def calls() -> Iterator[tuple[str, str, Any, tuple[Any, ...], dict[str, Any]]]:
    """Yield each callable with each argument wrong, and all others right."""
    for name, function in callables():
        try:
            parameters = list(inspect.signature(function).parameters.values())
        except ValueError:  # not a class that users create
            continue
        named = [of for of in parameters if of.kind not in (of.VAR_POSITIONAL, of.VAR_KEYWORD)]
        right = {of.name: RIGHT.get(of.name) for of in named if of.default is of.empty} | RIGHT_OF.get(name, {})
        for of in named:
            if of.kind is of.POSITIONAL_ONLY:
                yield name, of.name, function, (object(),), {}
            else:
                yield name, of.name, function, (), {**right, of.name: object()}


@pytest.mark.filterwarnings("ignore::eeruf.EerufWarning")
def test_one_wrong_value_is_one_error_that_names_it() -> None:
    tried, wrong = 0, []
    for name, argument, function, args, kwargs in calls():
        tried += 1
        try:
            function(*args, **kwargs)
            wrong.append(f"{name}, {argument}: no error")
        except eeruf.EerufError as error:
            # An argument that is missing in RIGHT is None, and is refused by its own name.
            missing = [other for other, value in kwargs.items() if value is None]
            if "expected" not in str(error) or not any(of in str(error) for of in [argument, *missing]):
                wrong.append(f"{name}, {argument}: {error}")
        except Exception as error:
            wrong.append(f"{name}, {argument}: {type(error).__name__}: {error}")
    assert not wrong, "\n".join(wrong)
    assert tried > 450

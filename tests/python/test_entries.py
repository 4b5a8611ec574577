"""Methods are values that simulations and experiments take alike, and parts of experiments make the whole."""

import functools
import pickle
import re
from pathlib import Path
from typing import Any, Callable

import eeruf
import numpy as np
import pytest
from eeruf import experiments, sim

ANY: Any = eeruf
ROOT = Path(__file__).parents[2]
SCENE = experiments.alcoves()[0]


class Paper:
    """The paper's filter as a custom filter."""

    def __init__(self, robot: sim.Robot) -> None:
        """Take the robot's settings."""
        t_delta_us = robot.t_delta_us
        assert isinstance(t_delta_us, int)
        self.filter = eeruf.EchoFilter(robot.sensors, t_delta_us)

    def __call__(self, firing: eeruf.typing.FiredReading) -> eeruf.Reading:
        return self.filter.push_echoes(firing.reading.sensor, firing.t_echoes_us, firing.expected_change_us)


def believe_all(firing: eeruf.typing.FiredReading) -> Any:
    return ("accepted", firing.t_echoes_us[0]) if firing.t_echoes_us else ("clear", None)


def believing(robot: sim.Robot) -> Callable[[eeruf.typing.FiredReading], Any]:
    return believe_all


class InTurn:
    """A custom firing, one sensor after the other, like the method ``sequential``."""

    def __init__(self, robot: sim.Robot) -> None:
        """Take the number of sensors."""
        self.sensors = robot.sensors

    def __call__(self, period: int) -> Any:
        return 40_000 * self.sensors, [(40_000 * sensor, sensor) for sensor in range(self.sensors)]


MINE = sim.Method("conventional", label="mine", make_filter=Paper)


def same(one: sim.Readings, other: sim.Readings) -> bool:
    columns = other.columns()
    return len(one) == len(other) > 0 and all(
        np.array_equal(column, columns[name], equal_nan=column.dtype.kind == "f")
        for name, column in one.columns().items()
    )


def test_an_own_filter_equals_the_built_in_method_everywhere() -> None:
    assert same(sim.simulate(SCENE, MINE, 100), sim.simulate(SCENE, "comparison", 100))
    stepped, built_in = sim.Simulation(SCENE, MINE), sim.Simulation(SCENE, "comparison")
    for _ in range(3):
        assert stepped.step(0.5).kind.tolist() == built_in.step(0.5).kind.tolist()
    (block,) = sim.simulate_blocks(SCENE, MINE, 100)
    assert same(block, sim.simulate(SCENE, "comparison", 100))
    for table in (
        experiments.set_one(3, readings=400, methods=["comparison", MINE]),
        experiments.set_two(2, methods=["comparison", MINE], pilot="published"),
        experiments.set_three(3, periods=15, methods=["comparison", MINE]),
    ):
        runs = table.runs
        assert [run.figures() for run in runs["comparison"]] == [run.figures() for run in runs["mine"]]
        assert [run.seed for run in runs["mine"]] == list(range(20_000, 20_000 + table.seeds))
        assert list(table.methods) == ["comparison", "mine"]


def test_an_own_firing_enters_experiments() -> None:
    slow = sim.Method("conventional", label="slow", make_firing=InTurn)
    table = experiments.set_one(3, readings=800, methods=[slow, "sequential"])
    found = experiments.compare(table.runs["slow"], table.runs["sequential"])
    assert abs(found["good_lost"].mean) < 0.01
    rates = [table.methods[name].readings_per_s for name in table.methods]
    assert rates[0] is not None and rates[1] is not None
    assert rates[0].median == pytest.approx(rates[1].median, rel=0.2)


def test_schedules_settings_and_sketches_are_those_given() -> None:
    table = eeruf.design(8, 999, 15_000, 36_000).schedule
    assert table is not None
    designed = sim.Method("eeruf", label="designed", schedule=table)
    robots = [robot.replace(schedule=table, period_us=robot.period_us) for robot in SCENE.robots]
    assert same(sim.simulate(SCENE, designed, 100), sim.simulate(SCENE.replace(robots=robots), "eeruf", 100))
    timid = sim.Method("flow", label="timid", settings={"least_us": 20_000})
    assert len(sim.simulate(SCENE, timid, 200)) < len(sim.simulate(SCENE, "flow", 200))
    turned = sim.Method("in_turn", label="turned", sketch={"turn_us": 50_000})
    robots = [robot.replace(firing={"turn_us": 50_000}) for robot in SCENE.robots]
    assert same(sim.simulate(SCENE, turned, 50), sim.simulate(SCENE.replace(robots=robots), "in_turn", 50))
    both = experiments.set_one(2, readings=400, methods=[designed, timid, turned, "flow"])
    assert list(both.methods) == ["designed", "timid", "turned", "flow"]
    assert both.runs["designed"][0].summary == sim.simulate(SCENE, designed, 50).summary()


def test_robots_of_one_make_fire_as_rings_are_fired_today() -> None:
    today = ["in_turn", "arrays", "groups", "sync_line", "free_running", "table"]
    # A ping timer as long as the window fires one by one.
    timer = sim.Method("in_turn", label="timer", sketch={"turn_us": 36_001})
    methods: list[Any] = [*today, timer, "sequential"]
    table = experiments.set_three(4, periods=20, methods=methods)
    spreads = {name: figures.others_of_accepted for name, figures in table.methods.items()}
    others = {name: spread.mean for name, spread in spreads.items() if spread is not None}
    assert list(others) == [*today, "timer", "sequential"]
    assert all(others[name] > 0.1 for name in today)
    for one, other in zip(table.runs["timer"], table.runs["sequential"]):
        assert one.others_of_accepted == other.others_of_accepted
        assert one.right_echoes_per_s == other.right_echoes_per_s


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"name": "eruf"}, "no method `eruf`; expected simultaneous"),
        ({"settings": {"rest_us": 1}}, "settings = .*; expected none for the method eeruf"),
        ({"name": "flow", "settings": {"step": 3}}, "no setting step of flow; expected one of least_us"),
        ({"name": "flow", "settings": {"seed": 3}}, "seed = 3; expected none for a method"),
        ({"name": "flow", "settings": {"alone": True}}, "alone = True; expected none for a method"),
        ({"name": "conventional", "schedule": eeruf.tables.TABLE_I_D}, "expected none for the method conventional"),
        ({"sketch": {"turn_us": 1}}, "sketch = .*; expected none for the method eeruf"),
        ({"name": "in_turn", "sketch": {"turn": 1}}, "sketch: "),
        ({"make_filter": 3}, "make_filter = 3; expected a callable that takes a robot"),
        ({"label": 3}, "label = 3; expected a text"),
    ],
)
def test_what_a_method_does_not_take_is_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(eeruf.EerufError, match=message):
        ANY.sim.Method(**arguments)


def test_errors_of_own_code_come_out_of_experiments() -> None:
    class Weary(Exception):
        pass

    def tired(firing: eeruf.typing.FiredReading) -> Any:
        raise Weary("for today")

    def unmade(robot: sim.Robot) -> Any:
        raise Weary("never begun")

    method = sim.Method("eeruf", make_filter=lambda robot: tired)
    for run in (
        lambda: sim.simulate(SCENE, method, 10),
        lambda: sim.Simulation(SCENE, method).step(1),
        lambda: experiments.set_one(2, readings=80, methods=[method]),
        lambda: experiments.set_two(2, methods=[method]),
        lambda: experiments.set_three(2, periods=10, methods=[method]),
    ):
        with pytest.raises(Weary, match="for today"):
            run()
    with pytest.raises(Weary, match="never begun"):
        experiments.set_one(2, readings=80, methods=[sim.Method("eeruf", make_firing=unmade)])
    with pytest.raises(eeruf.EerufError, match="what make_filter returned = 3; expected a callable"):
        ANY.sim.simulate(SCENE, ANY.sim.Method(make_filter=lambda robot: 3), 10)
    with pytest.raises(eeruf.EerufError, match="12"):
        sim.simulate(SCENE, sim.Method("eeruf", schedule=eeruf.tables.TABLE_I_D))
    with pytest.raises(eeruf.EerufError, match="12"):
        experiments.set_one(1, methods=[sim.Method("eeruf", schedule=eeruf.tables.TABLE_I_D)])
    with pytest.raises(eeruf.EerufError, match="two methods `eeruf`; expected another name"):
        experiments.set_one(1, methods=["eeruf", sim.Method("eeruf")])


def test_methods_and_scenes_compare_pickle_and_show_themselves() -> None:
    turned = sim.Method("in_turn", label="turned", sketch={"turn_us": 50_000})
    timid = sim.Method("flow", label="timid", settings={"least_us": 20_000})
    for value in (MINE, turned, timid, sim.Method(), sim.Method("sequential"), experiments.alcoves(3, 9)[2:]):
        again = pickle.loads(pickle.dumps(value))
        assert again == value and hash(again) == hash(value)
        assert value != sim.Method("flow")
    assert eval(repr(turned), {"Method": sim.Method}) == turned
    assert (MINE.name, MINE.label, repr(sim.Method("flow"))) == (
        "conventional", "mine", "Method(name='flow', label='flow')"
    )  # fmt: skip


def test_scenes_are_those_of_the_experiments() -> None:
    scenes = experiments.alcoves(20_000, 5)
    assert [scene.seed for scene in scenes[1:4]] == [20_001, 20_002, 20_003]
    assert scenes[-1].seed == 20_004 and len(scenes) == 5
    table = experiments.set_one(5, readings=400, methods=["eeruf", "flow"])
    for name in ("eeruf", "flow"):
        alone = [sim.simulate(scene, name, 50).summary() for scene in scenes]
        assert [run.summary for run in table.runs[name]] == alone
    course = experiments.courses(20_003, 1)[0]
    run = experiments.set_two(1, first=20_003, methods=["eeruf"]).runs["eeruf"][0]
    assert course.poles[:, :2].tolist() == run.poles[:, :2].tolist()
    assert course.robots[0].odometry and course.robots[0].t_delta_us == 150
    with pytest.raises(IndexError):
        scenes[5]
    with pytest.raises(eeruf.EerufError, match="n = -1; expected"):
        experiments.alcoves(0, -1)


def test_concat_of_parts_equals_the_undivided_run() -> None:
    methods: list[Any] = ["eeruf", MINE]
    one = functools.partial(experiments.set_one, readings=400, methods=methods)
    two = functools.partial(experiments.set_two, methods=methods, second_robot="ahead")
    three = functools.partial(experiments.set_three, periods=15, methods=methods, height="room")
    for run in (one, two, three):
        parts: list[Any] = [run(seeds, first=first) for first, seeds in ((20_003, 2), (20_000, 3), (20_005, 1))]
        assert experiments.concat(parts) == run(6)
        for broken, message in [
            (parts[:1] + parts[2:], None),
            (parts[1:2] + parts[2:], "seeds up to 20002 and from 20005 on; expected each seed once"),
            (parts + parts[1:2], "seeds up to 20002 and from 20000 on"),
            ([], "expected tables of one of set_one"),
            ([parts[0], 3], "tables: a .* and a int"),
        ]:
            if message is not None:
                with pytest.raises(eeruf.EerufError, match=message):
                    experiments.concat(broken)
    with pytest.raises(eeruf.EerufError, match="tables: periods = 50 and 10; expected parts of one experiment"):
        experiments.concat([one(1), experiments.set_one(1, first=20_001, readings=80, methods=methods)])


def test_compare_pairs_by_seed_and_covers_what_it_claims() -> None:
    table = experiments.set_one(12, readings=400, methods=["sequential", "conventional"])
    one, other = table.runs["sequential"], table.runs["conventional"]
    found, swapped = experiments.compare(one, other), experiments.compare(other, one[::-1])
    for name, difference in found.items():
        assert difference.mean == pytest.approx(-swapped[name].mean, abs=1e-12)
        assert (difference.less, difference.more) == (swapped[name].more, swapped[name].less)
        values = sorted(a.figures()[name] - b.figures()[name] for a, b in zip(one, other))  # type: ignore[operator]
        assert difference.median_95 == (values[2], values[9])
    assert found["wrong_of_all"].more == 0 and found["wrong_of_all"].p_sign == 2 / 2**12
    same = experiments.compare(one, one)["wrong_of_all"]
    assert (same.mean_95, same.median_95, same.p_sign) == ((0, 0), (0, 0), 1)
    with pytest.raises(eeruf.EerufError, match="seed 20011 and 0 others are of one method only"):
        experiments.compare(one, other[:-1])
    with pytest.raises(eeruf.EerufError, match=r"one = .*; expected runs of one method"):
        ANY.experiments.compare(table, other)


@pytest.mark.parametrize("run", [experiments.set_one, experiments.set_two, experiments.set_three])
def test_reporting_seeds_refuse_to_tune(run: Any) -> None:
    with pytest.raises(eeruf.EerufError, match="seeds up to 20000 with tune=True; expected seeds below 20000"):
        run(1, tune=True)
    with pytest.raises(eeruf.EerufError, match="seeds up to 20001"):
        run(3, first=19_999, tune=True)
    assert run(1, first=0, tune=True, methods=["sequential"]).first == 0


def test_one_process_dask_and_parts_give_equal_tables() -> None:
    from distributed import Client, LocalCluster

    run = functools.partial(part, methods=("eeruf", "sequential"))
    firsts = range(20_000, 20_006, 2)
    whole = experiments.set_one(6, readings=400, methods=["eeruf", "sequential"])
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        there = list(client.get_executor().map(run, firsts))
    assert experiments.concat(there) == experiments.concat([run(first) for first in firsts]) == whole


def part(first: int, methods: Any) -> eeruf.typing.SetOne:
    return experiments.set_one(2, first=first, readings=400, methods=list(methods))


def test_own_filter_takes_15_lines_and_its_comparison_five() -> None:
    text = (ROOT / "docs/how-to/method.md").read_text()
    entry, comparison = re.findall(r"^```python\n(.*?)^```$", text, flags=re.M | re.S)[:2]
    assert len(entry.strip().splitlines()) <= 15 and len(comparison.strip().splitlines()) <= 5
    scope: dict[str, Any] = {}
    exec(compile(entry, "entry", "exec"), scope)
    exec(compile(comparison, "comparison", "exec"), scope)
    assert set(scope["alcoves"].runs) == set(scope["courses"].runs) == {"eeruf", "mine"}

"""One object of every public class: its properties are of their annotated types, it lives on in a forked child, and it
copies.
"""

import ast
import copy
import inspect
import io
import os
import pickle
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any, Callable

import eeruf
import numpy as np
import pytest
from eeruf import envs, experiments, logs, nav, sim, tables

SOURCES = Path(__file__).parents[2] / "python/eeruf"
MODULES = (eeruf, sim, experiments, logs, nav, envs)
PUBLIC = [getattr(module, name) for module in MODULES for name in module.__all__] + list(vars(eeruf.typing).values())
ROBOT = sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)
ROOM = sim.Scene([[5, 2, -5, 2]], robots=[ROBOT])


def each() -> dict[str, Any]:
    """Make one object of every public class, by its name."""
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    events = [event for _ in range(60) if (event := ring.poll(ring.next_deadline_us)) is not None]
    waits = eeruf.WaitSearch(4, 40_000, 8_000, 1_000, t_delta_us=999)
    readings = sim.simulate(ROOM, periods=20)
    two: list[Any] = ["eeruf", "conventional"]
    set_one, set_two = experiments.set_one(2, readings=400, methods=two), experiments.set_two(1, methods=["eeruf"])
    set_three = experiments.set_three(2, methods=["eeruf"])
    speeds = experiments.speed_sweep([0.75], seeds=1, methods=["eeruf"])
    count = 4 * 60
    firings = logs.Firings.of(
        sensor=[place % 4 for place in range(count)],
        fired_us=[15_000 * place + place % 7 * 500 for place in range(count)],
        period=[place // 4 for place in range(count)],
        phase=[place // 4 % 2 for place in range(count)],
        t_echo_us=[np.nan if place % 4 == 3 else 7_000.0 + place % 4 for place in range(count)],
    )
    ranges = eeruf.read_log(io.BytesIO(b"t,left,right\n0,1.0,2.0\n0.1,1.1,2.1\n0.2,1.0,2.0\n"))
    batch = sim.Batch([ROOM, ROOM])
    objects: list[Any] = [
        ring,
        *events,
        waits,
        waits.all(),
        eeruf.Adaptation([tables.TABLE_I_D], 500),
        eeruf.typing.Blind(3, 20),
        eeruf.EchoFilter(4, 500),
        eeruf.Needs(sensors=8, module="hc-sr04"),
        eeruf.design(4, 999, 15_000, 36_000, certificate=True),
        tables.TABLE_I_B.verify(999, min_interval_us=15_000),
        tables.TABLE_I_B.verify(999, min_interval_us=15_000).violations[0],
        tables.TABLE_I_D,
        eeruf.SensorWatch(4),
        ring.state(0),
        batch,
        batch.state,
        eeruf.typing.FiredReading(eeruf.EchoFilter(1, 500).push(0, 9_000), (9_000, 11_000), 0.5, levels_db=(12.5, 3.0)),
        sim.Material(0.5),
        sim.Method("flow", label="mine"),
        sim.Noise(),
        ROOM.paths((0, 0), [(1, 0), (2, 0)], 2),
        sim.simulate_blocks(ROOM, periods=40, block_periods=2),
        readings,
        ROBOT,
        sim.Simulation(ROOM),
        sim.Simulation(ROOM).robots[0],
        ROOM,
        readings.summary(),
        experiments.alcoves(0, 2),
        experiments.compare(*(set_one.runs[name] for name in two))["wrong_of_all"],
        set_one,
        set_one.runs["eeruf"][0],
        set_one.methods["eeruf"],
        set_one.methods["eeruf"].rejected,
        set_one.methods["eeruf"].nearer,
        set_one.methods["eeruf"].new_step,
        set_two,
        set_two.runs["eeruf"][0],
        set_two.methods["eeruf"],
        set_three,
        set_three.runs["eeruf"][0],
        set_three.methods["eeruf"],
        set_three.groups[0],
        set_three.groups[0].methods["eeruf"],
        speeds,
        speeds.steps[0],
        logs.Agree(500),
        ranges.crosstalk,
        firings,
        eeruf.logs.diagnose(firings),
        eeruf.logs.survey(firings),
        ranges,
        eeruf.logs.replay(ranges, logs.Agree(500)),
        eeruf.check(ranges),
        nav.Himm(),
        nav.Vfh(),
        nav.Vfh().steer(nav.Himm(), (0, 0), (5, 0)),
        envs.CourseEnv(),
        envs.CourseVectorEnv(2),
    ]
    return {type(thing).__name__: thing for thing in objects}


def public_classes() -> set[str]:
    """Return the classes whose objects users can hold: no errors, and no bases."""
    return {
        kind.__name__
        for kind in PUBLIC
        if isinstance(kind, type) and not issubclass(kind, (Exception, Warning)) and kind.__module__.startswith("eeruf")
    }


# Uses that do long work, or work on threads, besides properties.
USES: dict[str, Callable[[Any], object]] = {
    "Adaptation": lambda of: of.adapt(eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000), eeruf.Fire(0)),
    "Batch": lambda of: (of.step(0.1), of.reset([0]), of.step(0.1, v_m_s=0.1, w_rad_s=0.0)),
    "CourseEnv": lambda of: (of.reset(seed=1), of.step(of.action_space.sample())),
    "CourseVectorEnv": lambda of: (of.reset(seed=1), of.step(of.action_space.sample())),
    "EchoFilter": lambda of: of.push_many(np.full((9, of.sensors), 9_000.0)),
    "Firings": lambda of: (eeruf.logs.diagnose(of), eeruf.logs.survey(of)),
    "ReadingBlocks": lambda of: next(of),
    "Ring": lambda of: of.poll(of.next_deadline_us),
    "Robot": lambda of: sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[of]), periods=3),
    "Scene": lambda of: (of.paths((0, 0), [(1, 0)], 2), sim.simulate(of, periods=3)),
    "Scenes": lambda of: of[0],
    "SetOne": lambda of: experiments.set_one(2, readings=8, methods=["eeruf"]),
    "SetTwo": lambda of: experiments.set_two(1, methods=["eeruf"]),
    "Simulation": lambda of: of.step(0.1),
    "WaitSearch": lambda of: of.first(),
    "WaitTables": lambda of: next(of),
}


def properties(kind: type) -> list[str]:
    # A removed name is not an attribute.
    return [of for of in dir(kind) if of[0] != "_" and not callable(getattr(kind, of, print))]


def use(thing: Any) -> None:
    for name in properties(type(thing)):
        getattr(thing, name)
    USES.get(type(thing).__name__, repr)(thing)


def test_there_is_one_of_every_class() -> None:
    assert set(each()) == public_classes()


def test_every_object_lives_on_in_a_forked_child() -> None:
    done = subprocess.run([sys.executable, __file__], capture_output=True, text=True, timeout=300)
    assert done.stdout == "child 0\n", done.stdout + done.stderr


def fork() -> None:
    """Use every object in a child, which ends by a signal if one waits for ever."""
    objects = each()
    for thing in objects.values():
        use(thing)
    child = os.fork()
    if child == 0:
        used = [""]

        def waits(*_: object) -> None:
            os.write(2, f"{used[-1]} waits for ever\n".encode())
            os._exit(2)

        status = 1
        signal.signal(signal.SIGALRM, waits)
        try:
            for name, thing in objects.items():
                used.append(name)
                signal.alarm(30)
                use(thing)
            status = 0
        finally:
            os._exit(status)
    print("child", os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))


# Types as the sources write them.
def aliases_and_annotations() -> tuple[dict[str, ast.expr], dict[tuple[str, str], ast.expr]]:
    aliases: dict[str, ast.expr] = {}
    annotations: dict[tuple[str, str], ast.expr] = {}
    for file in [*SOURCES.glob("*.py"), SOURCES / "_eeruf.pyi"]:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf8"))):
            if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
                aliases.setdefault(node.targets[0].id, node.value)
            if not isinstance(node, ast.ClassDef):
                continue
            for of in node.body:
                if isinstance(of, ast.AnnAssign) and isinstance(of.target, ast.Name):
                    annotations[node.name, of.target.id] = of.annotation
                decorators = {getattr(by, "id", "") for by in getattr(of, "decorator_list", ())}
                if isinstance(of, ast.FunctionDef) and decorators & {"property", "cached_property"} and of.returns:
                    annotations[node.name, of.name] = of.returns
    return aliases, annotations


ALIASES, ANNOTATIONS = aliases_and_annotations()
PLAIN = {"int": int, "str": str, "bool": bool, "bytes": bytes}


def fits(value: Any, of: ast.expr) -> bool:
    """Return true if a value is of a type. A float may be whole, as everywhere in Python; nothing else is converted."""
    if isinstance(of, ast.Constant):
        return value is None if of.value is None else fits(value, ast.parse(str(of.value), mode="eval").body)
    if isinstance(of, ast.BinOp):
        return fits(value, of.left) or fits(value, of.right)
    if isinstance(of, ast.Subscript):
        return fits_parameters(value, ast.unparse(of.value), of.slice)
    assert isinstance(of, (ast.Name, ast.Attribute)), ast.unparse(of)
    name = of.id if isinstance(of, ast.Name) else of.attr
    if name == "float":
        return isinstance(value, (float, int)) and not isinstance(value, bool)
    if name in PLAIN:
        return type(value) is PLAIN[name]
    if name in ALIASES and not hasattr(np, name):
        return fits(value, ALIASES[name])
    # A TypedDict is a dict.
    is_dict = name == "HeardPaths" and type(value) is dict
    return is_dict or name in ("Any", "object", *(base.__name__ for base in type(value).__mro__))


def fits_parameters(value: Any, kind: str, of: ast.expr) -> bool:
    items = of.elts if isinstance(of, ast.Tuple) else [of]
    if kind == "Literal":
        return value in [choice.value for choice in items if isinstance(choice, ast.Constant)]
    if kind == "NDArray":
        names = {node.attr.rstrip("_") for node in ast.walk(of) if isinstance(node, ast.Attribute)}
        return isinstance(value, np.ndarray) and value.dtype.name in names
    if kind in ("ClassVar", "Final"):
        return fits(value, of)
    if kind in ("list", "Sequence"):
        return isinstance(value, list) and all(fits(one, of) for one in value)
    if kind in ("dict", "Mapping"):
        return isinstance(value, dict) and all(fits(k, items[0]) and fits(v, items[1]) for k, v in value.items())
    assert kind == "tuple", kind
    if isinstance(items[-1], ast.Constant) and items[-1].value is ...:
        return isinstance(value, tuple) and all(fits(one, items[0]) for one in value)
    return isinstance(value, tuple) and len(value) == len(items) and all(map(fits, value, items))


def test_every_property_is_of_its_annotated_type() -> None:
    wrong, checked = [], 0
    for name, thing in each().items():
        kinds = [kind for kind in type(thing).__mro__ if kind.__module__.startswith("eeruf")]
        fields = [of for of in getattr(thing, "__dict__", {}) if of[0] != "_"]
        for of in {*properties(type(thing)), *fields}:
            annotation = next(
                (ANNOTATIONS[kind.__name__, of] for kind in kinds if (kind.__name__, of) in ANNOTATIONS), None
            )
            if annotation is None:
                if kinds[0].__module__ != "eeruf.envs" and of not in ("kind", "numbers", "physics"):
                    wrong.append(f"{name}.{of} has no annotation")
                continue
            checked += 1
            value = getattr(thing, of)
            if not fits(value, annotation):
                wrong.append(f"{name}.{of} = {value!r:.60}; expected {ast.unparse(annotation)}")
    assert not wrong, "\n".join(wrong)
    assert checked > 300


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy])
def test_what_has_state_goes_on_alike_in_a_copy(again: Any) -> None:
    def same(one: Any, other: Any, do: Callable[[Any], Any]) -> None:
        for _ in range(40):
            assert repr(do(one)) == repr(do(other))

    flow = eeruf.Ring.flow(8, {"seed": 3}, window_us=30_000)
    several = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, several_echoes=True)
    for ring in (eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000), several, flow):
        for _ in range(100):
            if isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Fire):
                ring.echo(event.sensor, ring.next_deadline_us)
        same(ring, again(ring), lambda of: (of.poll(of.next_deadline_us), of.next_deadline_us, of.state(1)))
    # Each goes on by itself.
    other = again(flow)
    before = other.next_deadline_us
    flow.restart(10**9)
    assert other.next_deadline_us == before != flow.next_deadline_us
    echoes = eeruf.EchoFilter(1, 500)
    echoes.push(0, 9_000)
    same(echoes, again(echoes), lambda of: of.push(0, 9_100))
    watch = eeruf.SensorWatch(1)
    watch.observe(eeruf.Reading(0, "accepted", 9_000), 50)
    same(watch, again(watch), lambda of: of.state(0, 100))
    fast, slow = tables.TABLE_I_D.scaled(3, 5), tables.TABLE_I_D
    ladder = eeruf.Adaptation([fast, slow], 500, window_periods=2)
    ring = eeruf.Ring(fast, 500, window_us=36_000)
    noisy = eeruf.PeriodEnded(0, tally={"rejected": 8})
    assert not ladder.adapt(ring, noisy)
    assert again(ladder).adapt(ring, noisy) and ladder.rung == 0
    batch = sim.Batch([ROOM, ROOM], "flow", seeds=[1, 2])
    batch.step(0.7, v_m_s=[0.1, 0.0], w_rad_s=0.2)
    same(batch, again(batch), lambda of: of.step(0.1).t_echo_us.tolist())
    grid = nav.Himm()
    grid.echo((0, 0, 0), 1.0)
    assert again(grid).value((1.0, 0.05)) == grid.value((1.0, 0.05)) != 0


def test_a_copy_of_a_long_simulation_replays_nothing() -> None:
    # Counted in instructions of the replay: none of its methods is called.
    world = sim.Simulation(ROOM)
    for _ in range(300):
        world.step(0.01)
    calls = []
    sys.setprofile(lambda frame, event, of: calls.append(getattr(of, "__name__", "")) if event == "c_call" else None)
    try:
        other = copy.copy(world)
    finally:
        sys.setprofile(None)
    assert "step" not in calls
    assert other.step(1.0).t_echo_us.tobytes() == world.step(1.0).t_echo_us.tobytes()
    # What was done before and after the copy comes again from a pickle.
    again = pickle.loads(pickle.dumps(other))
    assert again.time_s == other.time_s and again.robots == other.robots


def test_codes_compare_with_names() -> None:
    readings = sim.simulate(ROOM, periods=20)
    assert ((readings.kind == "accepted") == (readings.kind == eeruf.KINDS.index("accepted"))).all()
    assert (readings.kind == "accepted").sum() > 30 and (
        (readings.kind != "accepted") ^ (readings.kind == "accepted")
    ).all()
    assert (readings.cause[readings.kind == "accepted"] == "own").any()
    kinds = eeruf.EchoFilter(1, 500).push_many([[9_000.0], [9_000.0]])
    assert (kinds == "accepted").tolist() == [[False], [True]]
    assert type(kinds == "accepted") is np.ndarray and kinds.dtype == np.int8
    with pytest.raises(eeruf.EerufError, match="compared with 'acepted'; expected \"first\" or "):
        _ = kinds == "acepted"


@pytest.mark.parametrize(
    "call, message",
    [
        (
            lambda: sim.Robot((0, 0, 90), 8, 0.26, 0.3),
            r"pose\[2\] = 90; expected radians .*; likely degrees: 90 degrees are",
        ),
        (
            lambda: sim.Robot((0, 0, 0), 8, 15, 0.3),
            "spacing_rad = 15; expected radians from .*; likely degrees: 15 degrees",
        ),
        (lambda: sim.Simulation(ROOM).set_pose(0, (0, 0, -90.0)), r"pose\[2\] = -90; .*; likely degrees"),
        (lambda: sim.Batch([ROOM]).reset(poses=[[0, 0, 45.0]]), r"poses\[0\]\[2\] = 45; .*; likely degrees"),
        (lambda: eeruf.EchoFilter(1, 500).push_many([[0.009], [np.nan]]), "0.009 at most; .*; likely seconds"),
        (
            lambda: eeruf.EchoFilter(1, 500).push_many([[1.54], [0.8]]),
            "1.54 at most; .*; likely metres or milliseconds",
        ),
        (
            lambda: eeruf.logs.diagnose(
                logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[1.5])
            ),
            "t_echo_us = 1.5 at most; .*; likely metres",
        ),
        (
            lambda: sim.Readings.from_arrays(sensor=[0], fired_s=[0.0], t_echo_us=[0.0093]),
            "t_echo_us = 0.0093 at most; .*; likely seconds",
        ),
    ],
)
def test_another_unit_is_refused_with_the_likely_one(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(eeruf.EerufError, match=message):
        call()


if __name__ == "__main__":
    assert inspect.isfunction(fork)
    fork()

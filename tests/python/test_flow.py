"""A flow ring in a Python program: late polls, other robots, and removed names, which the errors replace."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import eeruf
import pytest
from eeruf import Ring

ANY: Any = eeruf
WINDOW_US = 27_000


def wall_us(sensor: int) -> int:
    """Return the echo time of the sensor's own wall."""
    return 5_000 + 900 * sensor


def run(
    ring: Ring,
    readings: int,
    *,
    own_us: Callable[[int], int | None] = wall_us,
    paths: list[tuple[int, int, int]] | None = None,
    late_us: int = 0,
    speed_m_s: float | None = None,
) -> list[eeruf.Reading]:
    """Return readings of a loop that is late at random; sensors hear their walls, and paths (from, to, microseconds)."""
    chance = random.Random(late_us + 1)
    found, pending, now_us = list[eeruf.Reading](), list[tuple[int, int]](), 0
    while len(found) < readings:
        now_us += ring.wait_us(now_us) + chance.randint(0, late_us)
        if speed_m_s is not None:
            ring.moving(speed_m_s, 0.0, now_us)
        for at_us, to in [heard for heard in pending if heard[0] <= now_us]:
            ring.echo(to, at_us)
            pending.remove((at_us, to))
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire):
                us = own_us(event.sensor)
                pending += [] if us is None else [(now_us + us, event.sensor)]
                pending += [(now_us + us, to) for x, to, us in paths or [] if x == event.sensor]
                pending.sort()
            # A second edge, after the firing's reading, is one more.
            elif isinstance(event, eeruf.Reading) and event.kind != "late":
                found.append(event)
    return found


@pytest.mark.parametrize("speed_m_s", [None, 1.0])
@pytest.mark.parametrize("late_us", [0, 100, 1_000, 5_000])
@pytest.mark.parametrize("sensors", [2, 8, 24])
def test_a_late_loop_believes_its_own_walls(sensors: int, late_us: int, speed_m_s: float | None) -> None:
    ring = Ring.flow(sensors, {"seed": 7}, window_us=WINDOW_US)
    # Nearer walls for many: each within the window.
    readings = run(ring, 200 * sensors, own_us=lambda x: wall_us(x % 8), late_us=late_us, speed_m_s=speed_m_s)
    accepted = [reading.kind == "accepted" for reading in readings]
    assert sum(accepted) >= 0.97 * len(accepted)
    for sensor in range(sensors):
        own = [reading.kind == "accepted" for reading in readings if reading.sensor == sensor]
        assert sum(own) >= 0.9 * len(own) and ring.state(sensor).t_echo_us == wall_us(sensor % 8)


@pytest.mark.parametrize("late_us", [0, 1_000, 5_000])
@pytest.mark.parametrize("speed_m_s", [None, 1.0])
def test_one_path_of_a_sensor_is_never_believed_by_another(late_us: int, speed_m_s: float | None) -> None:
    def believed(reach_us: int) -> int:
        accepted = 0
        for path_us in range(3_000, 33_000, 4_000):
            ring = Ring.flow(8, {"seed": 3, "least_us": 6_000}, window_us=WINDOW_US, reach_us=reach_us)
            # Sensor 3 has no wall: all that it hears is sensor 0.
            readings = run(
                ring,
                2_400,
                own_us=lambda x: None if x == 3 else wall_us(x),
                paths=[(0, 3, path_us)],
                late_us=late_us,
                speed_m_s=speed_m_s,
            )
            heard = [reading for reading in readings if reading.sensor == 3 and reading.t_echo_us is not None]
            accepted += sum(reading.kind == "accepted" for reading in heard)
            assert ring.state(3).kind != "obstacle" or reach_us < 33_500
        return accepted

    assert believed(reach_us=33_500) == 0
    # A control: if sound is heard for longer than the setting says, some are.
    assert believed(reach_us=6_000) > 0


def test_quiet_goes_to_the_sensor_that_is_fooled() -> None:
    # Sensor 0's sound reaches sensor 3, which fires next, before its wall's echo, until it gets quiet.
    ring = Ring.flow(8, {"seed": 1}, window_us=WINDOW_US, blanking_us=1_000)
    readings = run(ring, 4_000, own_us=lambda x: 12_000, paths=[(0, 3, 13_000)])
    assert {reading.t_echo_us for reading in readings if reading.kind == "accepted"} == {12_000}
    late = [reading.kind for reading in readings[-800:] if reading.sensor == 3]
    # A believed sensor gives quiet back, and is fooled again.
    assert late.count("accepted") >= 0.6 * len(late)


def test_sensors_of_uneven_rings_keep_what_each_needs() -> None:
    windows = [27_000, 27_000, 8_000, 8_000, 8_000, 8_000]
    groups: dict[str, Any] = {"shared_lines": [(0, 2)], "together": [(4, 5)], "refire_us": [0] * 5 + [100_000]}
    ring = Ring.flow(6, {"seed": 1}, window_us=windows, **groups)
    assert ring.window_us == 27_000
    fired, accepted = list[tuple[int, int]](), set[tuple[int, int | None]]()
    for _ in range(4_000):
        now_us = ring.next_deadline_us
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire):
                fired.append((now_us, event.sensor))
                ring.echo(event.sensor, now_us + (7_000 if event.sensor % 2 else 13_000))
            elif isinstance(event, eeruf.Reading) and event.kind == "accepted":
                accepted.add((event.sensor, event.t_echo_us))
    # 13 ms are beyond the short windows.
    assert accepted == {(0, 13_000), (1, 7_000), (3, 7_000), (5, 7_000)}
    of = [[at_us for at_us, sensor in fired if sensor == x] for x in range(6)]
    assert of[4] == of[5] and min(later - at_us for at_us, later in zip(of[1], of[1][1:])) >= 100_000
    assert all(not 0 <= after - at_us < 27_000 for at_us in of[0] for after in of[2])
    assert all(not 0 <= after - at_us < 8_000 for at_us in of[2] for after in of[0])


def test_several_echoes_of_a_firing_are_judged() -> None:
    def accepted(several: bool) -> set[int | None]:
        ring, fired = Ring.flow(4, {"seed": 1}, window_us=WINDOW_US, several_echoes=several), 0
        believed = set[int | None]()
        for _ in range(3_000):
            now_us = ring.next_deadline_us
            while event := ring.poll(now_us):
                if isinstance(event, eeruf.Fire):
                    fired += 1
                    # Something that never repeats, and the wall.
                    ring.echo(event.sensor, now_us + 1_000 + fired * 3_100 % 9_000)
                    ring.echo(event.sensor, now_us + 13_000)
                elif isinstance(event, eeruf.Reading) and event.kind == "accepted":
                    believed.add(event.t_echo_us)
        return believed

    assert 13_000 in accepted(several=True) and 13_000 not in accepted(several=False)


def test_hardware_reports_to_a_ring_by_flow() -> None:
    ring = Ring.flow(8, window_us=36_000, silence="needs_answer")
    ring.report_after_us = 40_000
    kinds, promised = list[tuple[int, str]](), set[int]()
    while len(kinds) < 400:
        now_us = ring.next_deadline_us
        promised |= {fire.sensor for fire in ring.upcoming()}
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire) and event.sensor < 6:
                ring.measured(event.sensor, 9_000 if event.sensor < 3 else None)
            elif isinstance(event, eeruf.Reading):
                kinds.append((event.sensor, event.kind))
    assert promised == set(range(8))
    said = [{kind for sensor, kind in kinds[-80:] if sensor == each} for each in range(8)]
    assert said == [{"accepted"}] * 3 + [{"clear"}] * 3 + [{"unanswered"}] * 2
    assert [ring.state(sensor).kind for sensor in (0, 3, 7)] == ["obstacle", "clear", "unanswered"]


def test_a_wall_that_comes_nearer_as_fast_as_the_robot_is_believed() -> None:
    def accepted(speed_m_s: float | None) -> float:
        ring, now_us, kinds = Ring.flow(4, {"seed": 1}, window_us=WINDOW_US), 0, list[str]()
        while len(kinds) < 400:
            now_us += ring.wait_us(now_us)
            if speed_m_s is not None:
                ring.moving(-speed_m_s, 0.0, now_us)
            while event := ring.poll(now_us):
                if isinstance(event, eeruf.Fire):
                    # 1 m/s, there and back.
                    ring.echo(event.sensor, now_us + 3_000 + (now_us * 2 // 343) % 15_000)
                elif isinstance(event, eeruf.Reading):
                    kinds.append(event.kind)
        return kinds.count("accepted") / len(kinds)

    assert accepted(1.0) > 0.95 > 0.1 > accepted(0.0)
    assert accepted(None) == accepted(0.0)


def test_every_echo_counts_for_a_robot_that_moves_alone() -> None:
    def accepted(settings: Any, speed_m_s: float | None) -> float:
        chance = random.Random(1)
        ring = ANY.Ring.flow(4, {"seed": 1, **settings}, window_us=WINDOW_US)
        # Never twice the same.
        readings = run(ring, 400, own_us=lambda x: chance.randrange(2_000, 20_000), speed_m_s=speed_m_s)
        return [reading.kind for reading in readings].count("accepted") / len(readings)

    assert accepted({"alone": True}, 1.0) == accepted({"votes": "every_echo"}, None) == 1.0
    for settings, speed_m_s in (({}, 1.0), ({"alone": True}, 0.0), ({"alone": True, "votes": "two_in_a_row"}, 1.0)):
        assert accepted(settings, speed_m_s) < 0.2


def test_the_same_seed_gives_the_same_firings_another_others() -> None:
    def fired(settings: Any) -> list[int]:
        ring = Ring.flow(8, settings, window_us=WINDOW_US)
        events = (ring.poll(ring.next_deadline_us) for _ in range(60))
        return [event.due_us for event in events if isinstance(event, eeruf.Fire)]

    assert fired({"seed": 1}) == fired({"seed": 1}) != fired({"seed": 2})
    # Robots with the same program draw different gaps.
    assert fired(None) != fired(None)


def test_every_setting_changes_what_it_says() -> None:
    ring = Ring.flow(8, {"t_delta_us": 60, "rest_us": 90_000, "dice_us": 0, "least_us": 20_000}, window_us=WINDOW_US)
    assert ring.t_delta_us == 60
    fires = [event for _ in range(200) if isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Fire)]
    gaps = [later.due_us - fire.due_us for fire, later in zip(fires, fires[1:])]
    assert min(gaps) >= 20_000
    again = [later.due_us - fire.due_us for fire, later in zip(fires, fires[8:])]
    assert min(again) >= 90_000


def test_a_ring_by_flow_has_no_schedule_to_change() -> None:
    ring = Ring.flow(8, window_us=WINDOW_US)
    for wrong in (
        lambda: ring.schedule,
        lambda: ring.path_change_us,
        lambda: setattr(ring, "t_delta_us", 100),
        lambda: setattr(ring, "audible_us", 100_000),
        lambda: ring.change_schedule(eeruf.tables.TABLE_I_D),
    ):
        with pytest.raises(eeruf.EerufError, match=r"of a ring by flow; expected a ring by an eeruf\.Schedule"):
            wrong()
    with pytest.raises(eeruf.EerufError, match=r"moving of a ring by a schedule; expected a ring by eeruf\.Ring\.flow"):
        Ring(eeruf.tables.TABLE_I_D, 500, window_us=36_000).moving(1.0, 0.0, 0)


def test_what_is_gone_is_answered_by_name() -> None:
    gone: dict[str, Callable[[], Any]] = {
        "EchoTracker": lambda: ANY.EchoTracker,
        "HoppingSchedule": lambda: ANY.HoppingSchedule,
        "HoppingSettings": lambda: ANY.HoppingSettings,
        "TrackerSettings": lambda: ANY.TrackerSettings,
    }
    for name, get in gone.items():
        with pytest.raises(AttributeError, match=rf"^eeruf\.{name} is gone; eeruf\.Ring\.flow does it$"):
            get()
    assert not hasattr(eeruf, "EchoTracker")


def test_each_error_says_what_is_expected() -> None:
    for make, error, text in (
        (lambda: ANY.Ring.flow(8, {"rest": 1}, window_us=9_000), eeruf.EerufError, "no setting rest of flow"),
        (lambda: ANY.Ring.flow(8, {"seed": 0}, window_us=9_000), eeruf.EerufError, "seed = 0; expected"),
        (lambda: ANY.Ring.flow(8, {"top_speed_m_s": 66}, window_us=9_000), eeruf.EerufError, "top_speed_m_s = 66"),
        (
            lambda: ANY.Ring.flow(8, "quick", window_us=9_000),
            eeruf.EerufError,
            "settings = 'quick'; expected a dict",
        ),
        (
            lambda: ANY.Ring.flow(8, {"votes": 3}, window_us=9_000),
            eeruf.EerufError,
            'votes = 3; expected "by_motion"',
        ),
        (lambda: ANY.Ring.flow(8, {"alone": 1}, window_us=9_000), eeruf.EerufError, "alone = 1; expected True or"),
        (lambda: Ring.flow(8, {"least_us": 40_000}, window_us=WINDOW_US), eeruf.EerufError, "least"),
        (lambda: Ring.flow(8, {"hold": 0}, window_us=WINDOW_US), eeruf.EerufError, "hold"),
        (
            lambda: Ring.flow(8, {"most_us": 30_000}, window_us=WINDOW_US, reach_us=30_000),
            eeruf.EerufError,
            "reach_us = 30000; expected none beside the setting most_us",
        ),
        (lambda: Ring.flow(8, window_us=9_000, blanking_us=9_000), eeruf.EerufError, "blanking"),
        (lambda: Ring.flow(65, window_us=WINDOW_US), eeruf.EerufError, "sensors = 65; expected"),
        (lambda: Ring.flow(8, window_us=WINDOW_US).moving(200.0, 0.0, 0), eeruf.EerufError, "speed_m_s = 200"),
    ):
        with pytest.raises(error, match=text):
            make()

"""A ring can be changed while it runs, watched, and adapted."""

from __future__ import annotations

from collections import Counter
from typing import Any, Callable, cast

import eeruf
import pytest
from eeruf import tables

FAST = tables.TABLE_I_D.scaled(3, 5)


def run(
    ring: eeruf.Ring,
    until: Callable[[Any], bool],
    t_echo_us: Callable[[eeruf.Fire], int | None] = lambda fire: 9_000,
    see: Callable[[Any, int], object] = lambda event, now_us: None,
) -> list[Any]:
    """Run a ring until an event is the last one, and return all events."""
    events: list[Any] = []
    while not events or not until(events[-1]):
        now_us = ring.next_deadline_us
        while (event := ring.poll(now_us)) is not None:
            events.append(event)
            see(event, now_us)
            if isinstance(event, eeruf.Fire) and (us := t_echo_us(event)) is not None:
                ring.echo(event.sensor, now_us + us)
            if until(event):
                break
    return events


def period_ended(event: Any) -> bool:
    return isinstance(event, eeruf.PeriodEnded)


def fires(events: list[Any]) -> int:
    return sum(isinstance(event, eeruf.Fire) for event in events)


def test_a_paused_ring_fires_nothing_and_starts_over() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    assert fires(run(ring, period_ended)) == 12
    run(ring, period_ended)
    ring.pause()
    assert [fires(run(ring, period_ended)) for _ in range(3)] == [0, 0, 0]
    ring.resume()
    run(ring, period_ended)
    events = run(ring, period_ended)
    kinds = Counter(event.kind for event in events if isinstance(event, eeruf.Reading))
    assert fires(events) == 12
    assert kinds["first"] >= 11 and kinds["accepted"] == 0


def test_a_schedule_is_changed_when_the_period_ends() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    ring.poll(ring.next_deadline_us)
    ring.change_schedule(FAST)
    assert ring.schedule == tables.TABLE_I_D
    run(ring, period_ended)
    assert ring.schedule == FAST
    # Back and forth as often as one likes.
    for schedule in (tables.TABLE_I_D, FAST, tables.TABLE_I_D):
        ring.change_schedule(schedule)
        run(ring, period_ended)
        assert ring.schedule == schedule


def test_a_ring_refuses_a_schedule_that_lets_crosstalk_in() -> None:
    constant = eeruf.Schedule(100_000, tables.TABLE_I_D.t_lag_us, (0,) * 12, (0,) * 12)
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    with pytest.raises(eeruf.EerufError, match=r"\(13a\)"):
        ring.change_schedule(constant)
    run(ring, period_ended)
    assert ring.schedule == tables.TABLE_I_D
    with pytest.raises(eeruf.EerufError, match="one of 8 sensors; expected one of 12 sensors, as the ring has"):
        ring.change_schedule(eeruf.Schedule.from_firing(90_000, range(0, 8_000, 1_000), range(0, 16_000, 2_000)))
    loose = eeruf.Ring.unverified(tables.TABLE_I_D, 500, window_us=36_000)
    loose.change_schedule(constant)
    run(loose, period_ended)
    assert loose.schedule == constant


def test_t_delta_window_and_blanking_are_changed_while_it_runs() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, blanking_us=400)
    assert (ring.t_delta_us, ring.window_us, ring.blanking_us) == (500, 36_000, 400)
    echoes = iter(range(9_000, 10**9, 700))
    drifting = lambda fire: next(echoes) // 10 if fire.sensor == 0 else None  # noqa: E731
    run(ring, period_ended, drifting)
    run(ring, period_ended, drifting)

    def kind_of_0() -> str:
        events = run(ring, lambda event: isinstance(event, eeruf.Reading) and event.sensor == 0, drifting)
        return str(events[-1].kind)

    # 70 us more each time.
    assert kind_of_0() == "accepted"
    ring.t_delta_us = 50
    assert kind_of_0() == "rejected"
    ring.t_delta_us = 900
    assert [kind_of_0() for _ in range(3)] == ["accepted"] * 3
    ring.path_change_us, ring.audible_us = 100, 90_000
    assert (ring.path_change_us, ring.audible_us, kind_of_0()) == (100, 90_000, "accepted")
    ring.blanking_us = 2_000
    assert [kind_of_0() for _ in range(2)] == ["too_early", "too_early"]
    ring.blanking_us = 0
    ring.window_us = 1_000
    assert kind_of_0() in ("no_echo", "clear")
    assert (ring.t_delta_us, ring.window_us, ring.blanking_us) == (900, 1_000, 0)


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("t_delta_us", 1_000, eeruf.EerufError),
        ("t_delta_us", -1, eeruf.EerufError),
        ("window_us", 100_000, eeruf.EerufError),
        ("window_us", 300, eeruf.EerufError),
        ("blanking_us", 36_000, eeruf.EerufError),
        ("blanking_us", "much", eeruf.EerufError),
    ],
)
def test_what_a_ring_cannot_be_changed_to_leaves_it_as_it_was(name: str, value: Any, error: type[Exception]) -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, blanking_us=400)
    with pytest.raises(error):
        setattr(ring, name, value)
    assert (ring.t_delta_us, ring.window_us, ring.blanking_us) == (500, 36_000, 400)


def test_a_t_delta_too_large_for_the_next_schedule_is_refused() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    ring.change_schedule(FAST)
    with pytest.raises(eeruf.EerufError, match=r"\(13"):
        ring.t_delta_us = 900
    assert ring.t_delta_us == 500


def test_a_ring_starts_again_after_a_long_sleep() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    run(ring, period_ended)
    ring.restart(40 * 60 * 1_000_000)
    first = ring.poll(40 * 60 * 1_000_000 + 24_000)
    assert isinstance(first, eeruf.Fire)
    assert (first.sensor, first.phase) == (0, 0)


@pytest.mark.parametrize("flows", [False, True])
def test_a_sensor_without_accepted_echoes_is_reported_once(flows: bool) -> None:
    ring = (
        eeruf.Ring.flow(12, {"seed": 1}, window_us=36_000, silence="trusted")
        if flows
        else eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, silence="trusted")
    )
    watch, told, count = eeruf.SensorWatch(12, blind_after=6), [], Counter[int]()

    def t_echo_us(fire: eeruf.Fire) -> int | None:
        count[fire.sensor] += 1
        # One hears nothing, one hears noise, the others a wall.
        return None if fire.sensor == 2 else 4_000 + 1_700 * (count[5] % 13) if fire.sensor == 5 else 9_000

    def see(event: Any, now_us: int) -> None:
        if (blind := watch.observe(event, now_us)) is not None:
            told.append((blind, now_us))

    run(ring, lambda event: period_ended(event) and event.period == 20, t_echo_us, see)
    assert [blind for blind, _ in told] == [eeruf.typing.Blind(5, 6)]
    now_us = ring.next_deadline_us
    assert [watch.state(sensor, now_us).kind for sensor in (2, 5)] == ["clear", "unknown"]
    last = watch.state(3, now_us)
    assert (last.kind, last.t_echo_us) == ("obstacle", 9_000)
    assert last.age_us < 130_000
    assert watch.state(3, now_us + 1_000_000).age_us == last.age_us + 1_000_000


def test_a_watch_refuses_what_is_no_event_and_no_sensor() -> None:
    watch = eeruf.SensorWatch(4)
    anything: Any = "event"
    with pytest.raises(eeruf.EerufError, match=r"event = 'event'; expected an eeruf\.Fire, Reading or PeriodEnded"):
        watch.observe(anything, 0)
    with pytest.raises(eeruf.EerufError, match="sensor = 4; expected a whole number from 0 to 3"):
        watch.state(4, 0)


def test_a_ring_knows_states_and_silence_needs_a_witness() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, silence="needs_answer")
    ended = 0
    while ended < 4:
        now_us = ring.next_deadline_us
        while (event := ring.poll(now_us)) is not None:
            if isinstance(event, eeruf.Fire) and event.sensor != 2:
                # One is not connected, one measures nothing, the others a wall.
                ring.measured(event.sensor, None if event.sensor == 5 else 9_000)
            ended += isinstance(event, eeruf.PeriodEnded)
    kinds = [ring.state(sensor).kind for sensor in range(12)]
    assert kinds == [{2: "unanswered", 5: "clear"}.get(sensor, "obstacle") for sensor in range(12)]
    # After a long sleep nothing is known, whatever the clock says.
    ring.restart(now_us + 72 * 60_000_000)
    assert [ring.state(sensor).why for sensor in range(12)] == ["no_firing"] * 12
    ring.forget(0)
    ring.answered(1, False)
    with pytest.raises(eeruf.EerufError, match="sensor = 12; expected a whole number from 0 to 11"):
        ring.state(12)


def test_a_noisy_ring_slows_down_and_a_calm_one_speeds_up() -> None:
    ladder = [FAST, tables.TABLE_I_D.scaled(4, 5), tables.TABLE_I_D]
    ring = eeruf.Ring(ladder[0], 500, window_us=36_000)
    adaptation = eeruf.Adaptation(ladder, t_delta_us=500)
    noise, changes = iter(range(0, 10**9, 7_000)), []

    def see(event: Any, now_us: int) -> None:
        if adaptation.adapt(ring, event):
            changes.append((event.period, adaptation.rung))

    last = lambda event: period_ended(event) and event.period == 47  # noqa: E731
    run(ring, last, lambda fire: 1_000 + next(noise) % 30_000, see)
    # Each window of 16 periods moves a rung up, until there is none.
    assert changes == [(15, 1), (31, 2)]
    assert adaptation.rejection_rate is not None
    assert adaptation.rejection_rate > 0.3
    run(ring, lambda event: period_ended(event) and event.period == 190, see=see)
    # Four calm windows move one down.
    assert [rung for _, rung in changes] == [1, 2, 1, 0]
    assert ring.schedule == adaptation.schedule == FAST
    assert adaptation.rejection_rate == 0.0


def test_a_refused_change_leaves_the_adaptation_on_its_rung() -> None:
    ladder = [FAST, tables.TABLE_I_D]
    ring = eeruf.Ring(FAST, 500, window_us=36_000)
    adaptation = eeruf.Adaptation([ladder[0].scaled(5, 6), ladder[0]], 400, window_periods=1)
    ring = eeruf.Ring(tables.TABLE_I_D, 700, window_us=36_000)
    noise = iter(range(0, 10**9, 7_000))
    with pytest.raises(eeruf.EerufError):
        run(
            ring,
            lambda event: False,
            lambda fire: 1_000 + next(noise) % 30_000,
            lambda event, now_us: adaptation.adapt(ring, event),
        )
    assert adaptation.rung == 0
    assert ring.schedule == tables.TABLE_I_D


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: eeruf.Adaptation([], 500), eeruf.EerufError, "a ladder without schedules"),
        (lambda: eeruf.Adaptation([tables.TABLE_I_D, FAST], 500), eeruf.EerufError, "rung 1 has a period of 60 ms"),
        (lambda: eeruf.Adaptation([tables.TABLE_I_A], 500), eeruf.EerufError, r"\(13a\)"),
        (lambda: eeruf.Adaptation([FAST], 500, noisy=0.1, calm=0.2), eeruf.EerufError, "calm = 0.2; expected at"),
        (lambda: eeruf.Adaptation([FAST], 500, noisy=2), eeruf.EerufError, "noisy = 2; expected a number from 0 to"),
    ],
)
def test_what_is_no_ladder_is_refused(call: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call()


def test_sensors_of_uneven_rings_keep_their_own_windows() -> None:
    needs: dict[str, Any] = {"t_delta_us": [999, 999, 1500, 1500], "window_us": [36_000, 36_000, 12_000, 12_000]}
    found = eeruf.design(4, min_interval_us=15_000, shared_lines=[(0, 2)], **needs)
    assert found.schedule is not None
    ring = eeruf.Ring(found.schedule, shared_lines=[(0, 2)], **needs)
    # At 13 ms only the two that look far still listen.
    last = lambda event: period_ended(event) and event.period % 8 == 7  # noqa: E731
    for schedule in (found.schedule, found.schedule.scaled(3, 2)):
        ring.change_schedule(schedule)
        events = run(ring, last, lambda fire: 13_000)
        assert ring.schedule == schedule
        accepted = {event.sensor for event in events if isinstance(event, eeruf.Reading) and event.kind == "accepted"}
        assert accepted == {0, 1}
    # Three quarters of it leave a sensor less time than it listens.
    with pytest.raises(eeruf.EerufError, match=r"sensor \d fires again [\d.]+ ms after phase [ab]; it listens for"):
        ring.change_schedule(found.schedule.scaled(3, 4))
    with pytest.raises(eeruf.EerufError, match="one of 12 sensors; expected one of 4 sensors"):
        ring.change_schedule(tables.TABLE_I_D)
    with pytest.raises(eeruf.EerufError, match="3 values; expected one for each of 4 sensors"):
        eeruf.Ring(found.schedule, [999] * 3, window_us=12_000)


@pytest.mark.parametrize(("silence", "kind", "state"), [
    ("never_free", "no_echo", "unknown"), ("needs_answer", "unanswered", "unanswered"), ("trusted", "clear", "clear"),
])  # fmt: skip
def test_silence_without_a_witness_is_free_space_only_by_name(silence: Any, kind: str, state: str) -> None:
    ring, kinds = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, silence=silence), list[str]()
    while len(kinds) < 36:
        event = ring.poll(ring.next_deadline_us)
        kinds += [event.kind] if isinstance(event, eeruf.Reading) else []
    assert set(kinds[12:]) == {kind} and ring.state(0).kind == state
    assert ring.state(0).why == ("no_witness" if state == "unknown" else None)
    with pytest.raises(eeruf.EerufError, match="silence = 'free'; expected \"never_free\" or"):
        eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000, silence=cast(Any, "free"))


def test_late_loop_with_timed_firings_accepts_walls() -> None:
    """A timer fires at the instants of `upcoming`, the loop comes up to 5 ms late, reports come after the window."""
    ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000, silence="needs_answer")
    ring.report_after_us = 60_000
    assert ring.report_after_us == 60_000
    with pytest.raises(eeruf.EerufError, match="window"):
        ring.report_after_us = 1_000_000
    kinds: list[tuple[int, str]] = []
    reports: list[tuple[int, int, int | None]] = []
    now_us = 0
    for turn in range(4_000):
        now_us += turn * 977 % 5_000
        while True:
            fires = [fire.due_us for fire in ring.upcoming()[:1] if fire.due_us <= now_us]
            until_us = fires[0] if fires else now_us
            for report in [report for report in reports if report[0] <= until_us]:
                reports.remove(report)
                ring.measured(*report[1:])
            while event := ring.poll(until_us):
                if isinstance(event, eeruf.Fire):
                    assert event.due_us == until_us
                    wall_us = None if event.sensor == 3 else 5_000 + 2_000 * event.sensor
                    reports.append((until_us + 55_000, event.sensor, wall_us))
                elif isinstance(event, eeruf.Reading):
                    kinds.append((event.sensor, event.kind))
            if not fires:
                break
    for sensor in range(12):
        mine = [kind for x, kind in kinds if x == sensor][1:]
        assert len(mine) > 80 and set(mine) == {"clear" if sensor == 3 else "accepted"}

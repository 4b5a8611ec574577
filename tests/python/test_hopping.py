"""Time hopping, as Python sees it."""

import pickle
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import HoppingSchedule, HoppingSettings, Ring, Schedule

ANY: Any = eeruf

PERIOD_US, WINDOW_US = 60_000, 36_000
EIGHT = HoppingSchedule(sensors=8, period_us=PERIOD_US, step_us=240)


def run(
    ring: Ring, periods: int, *, own_us: int | None, path: tuple[int, int, int] | None = None
) -> list[eeruf.Reading]:
    """The readings of a ring whose sensors hear a wall, and perhaps a path (from, to, microseconds)."""
    readings, pending = list[eeruf.Reading](), list[tuple[int, int]]()
    ended = 0
    while ended < periods:
        now_us = ring.next_deadline_us
        for at_us, to in [heard for heard in pending if heard[0] <= now_us]:
            ring.echo(to, at_us)
            pending.remove((at_us, to))
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire):
                if own_us is not None:
                    pending.append((now_us + own_us, event.sensor))
                if path is not None and event.sensor == path[0]:
                    pending.append((now_us + path[2], path[1]))
                pending.sort()
            elif isinstance(event, eeruf.Reading):
                readings.append(event)
            else:
                ended += 1
    return readings


def test_a_congruence_is_the_formula_for_every_number_of_sensors() -> None:
    for sensors in (1, 2, 7, 12, 24, 64):
        schedule = Schedule.congruence(sensors, 400_000, 240)
        q, m, x = schedule.phases, np.arange(schedule.phases)[:, None], np.arange(sensors)
        assert q > sensors
        assert all(q % divisor for divisor in range(2, q))
        assert schedule.t_fire_us.tolist() == (np.array(schedule.t_lag_us) + 240 * ((x + 1) * m % q)).tolist()
        assert schedule.width_us == 240 * (q - 1)


def test_schedules_are_welchs_sequence_for_every_ring() -> None:
    for sensors in (2, 7, 12, 24, 64):
        schedule = HoppingSchedule(sensors, 400_000, 240)
        q, m, x = schedule.phases + 1, np.arange(schedule.phases)[:, None], np.arange(sensors)
        root = next(g for g in range(1, q) if len({pow(g, power, q) for power in range(1, q)}) == q - 1)
        powers = np.array([pow(root, power, q) for power in range(q - 1)])
        waits = powers[(m - x) % (q - 1)] - 1
        assert schedule.t_fire_us.tolist() == (np.array(schedule.t_lag_us) + 240 * waits).tolist()
        assert schedule.width_us == 240 * (q - 2)


def test_two_phases_of_a_congruence_are_a_schedule_of_the_paper() -> None:
    two = Schedule.congruence(1, PERIOD_US, 999, phases=2)
    assert two.phases == 2
    times = two.t_fire_us
    assert Schedule.from_firing(PERIOD_US, times[0].tolist(), times[1].tolist()).verify(498).ok


def test_equal_values_hash_pickle_and_print_as_code() -> None:
    names = {"HoppingSchedule": HoppingSchedule, "HoppingSettings": HoppingSettings}
    for value in (
        EIGHT,
        HoppingSchedule(2, PERIOD_US, 301, 13, [0, 9_000], first_multiplier=5),
        HoppingSettings(),
        HoppingSettings("maps"),
        HoppingSettings("quick", votes=6, shift_interval_us=0),
    ):
        for same in (pickle.loads(pickle.dumps(value)), eval(repr(value), names)):
            assert same == value
            assert hash(same) == hash(value)
    assert EIGHT != HoppingSchedule(8, PERIOD_US, 241)
    assert HoppingSettings("maps") != HoppingSettings("quick")
    assert repr(HoppingSettings("quick", votes=6)) == "HoppingSettings('quick', votes=6)"


def test_a_schedule_survives_its_file_and_bad_files_are_named() -> None:
    for schedule in (EIGHT, HoppingSchedule(2, PERIOD_US, 301, 13, [0, 9_000], first_multiplier=5)):
        assert HoppingSchedule.from_toml(schedule.to_toml()) == schedule
    for text, expected in (
        ("period_us = 60000\nstep_us = x", "^line 2: "),
        ("period_us = 60000\nstep_us = 240", "expected either step_us, phases and t_lag_us"),
        ("period_us = 60000\nt_fire_us = [[0, 1], [2, 3]]", "^t_fire_us; expected step_us"),
    ):
        with pytest.raises(eeruf.HoppingError, match=expected):
            HoppingSchedule.from_toml(text)


def test_every_setting_can_be_changed_and_read_back() -> None:
    before = HoppingSettings()
    fields = [name for name in vars(HoppingSettings) if not name.startswith("_")]
    assert len(fields) == 15
    for field in fields:
        value = getattr(before, field)
        changed = HoppingSettings(**{field: value - 1 if field == "tentative_within_us" else value + 1})
        differ = [name for name in fields if getattr(changed, name) != getattr(before, name)]
        assert differ == [field]


@pytest.mark.parametrize("settings", ["balanced", "quick", "driving", "maps"])
def test_a_masked_sensor_is_not_fooled_and_sees_its_wall(settings: str) -> None:
    # Sensor 1 fires 7.2 ms after sensor 0, 2.2 ms less or more: its sound arrives 3 to 8 ms into the window, before the
    # wall's echo.
    ring = Ring.hopping(EIGHT, HoppingSettings(settings), window_us=WINDOW_US, blanking_us=1_000)  # type: ignore[arg-type]
    readings = run(ring, 300, own_us=12_000, path=(0, 1, 13_000))
    believed = {reading.t_echo_us for reading in readings if reading.kind in ("accepted", "tentative")}
    assert believed == {12_000}
    accepted = [reading.kind for reading in readings if reading.sensor == 1].count("accepted")
    if settings == "driving":
        # Without solo periods and with lags that stay it never hears its wall.
        assert (ring.confirmed_us(1), accepted) == (None, 0)
    else:
        assert ring.confirmed_us(1) == 12_000 and accepted >= 20
    assert ring.state(1).kind != "clear"


def test_a_ring_whose_silence_is_trusted_and_that_hears_nothing_says_clear() -> None:
    ring = Ring.hopping(EIGHT, window_us=WINDOW_US, silence="trusted")
    silent = [reading.kind for reading in run(ring, 30, own_us=None)]
    assert silent[-8:] == ["clear"] * 8
    assert all(ring.state(sensor).kind == "clear" and ring.confirmed_us(sensor) is None for sensor in range(8))


def test_a_ring_by_flow_gives_quiet_to_the_sensor_that_is_fooled() -> None:
    # Sensor 0's sound reaches sensor 3, which fires next, before its wall's echo, until it gets quiet.
    ring = Ring.flow(8, {"rest_us": 60_000}, window_us=WINDOW_US, blanking_us=1_000)
    readings = run(ring, 300, own_us=12_000, path=(0, 3, 13_000))
    assert {reading.t_echo_us for reading in readings if reading.kind in ("accepted", "tentative")} == {12_000}
    assert all(ring.confirmed_us(sensor) == 12_000 for sensor in range(8))
    late = [reading.kind for reading in readings[-80:] if reading.sensor == 3]
    # What is believed gives quiet back, and is fooled again.
    assert late.count("accepted") >= 0.4 * len(late)


def test_hardware_reports_to_rings_that_count_votes() -> None:
    hops = Ring.hopping(EIGHT, window_us=WINDOW_US, silence="needs_answer")
    flows = Ring.flow(8, {"rest_us": 60_000}, window_us=WINDOW_US, silence="needs_answer")
    flows.report_after_us = 40_000
    for ring in (hops, flows):
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


def test_a_ring_that_counts_votes_has_no_schedule_to_change() -> None:
    ring = Ring.flow(8, window_us=WINDOW_US)
    assert ring.t_delta_us == HoppingSettings().t_delta_us and ring.t_lag_us == () and ring.solo is None
    for wrong in (
        lambda: ring.schedule,
        lambda: ring.path_change_us,
        lambda: setattr(ring, "t_delta_us", 100),
        lambda: setattr(ring, "audible_us", 100_000),
        lambda: ring.change_schedule(eeruf.tables.TABLE_I_D),
    ):
        with pytest.raises(
            eeruf.RingError, match=r"of a ring that counts votes; expected a ring by an eeruf\.Schedule"
        ):
            wrong()


def test_the_same_seed_gives_the_same_lags_another_others() -> None:
    def lags(seed: int) -> tuple[int, ...]:
        ring = Ring.hopping(EIGHT, HoppingSettings(shift_after=5, shift_interval_us=0), window_us=WINDOW_US, seed=seed)
        state = 1
        for _ in range(3_000):
            now_us = ring.next_deadline_us
            while event := ring.poll(now_us):
                if isinstance(event, eeruf.Fire):
                    state = state * 1_103_515_245 % 2**31
                    ring.echo(event.sensor, now_us + 3_000 + state % 30_000)
        return ring.t_lag_us

    assert lags(1) == lags(1)
    assert lags(1) != lags(2)
    assert lags(1) != EIGHT.t_lag_us


def test_the_tracker_alone_is_the_one_in_the_ring() -> None:
    # No lag moves and no sensor gets a solo period, so that the phases follow each other.
    settings = HoppingSettings(solo_rate=0, shift_after=0)
    readings = run(Ring.hopping(EIGHT, settings, window_us=WINDOW_US), 60, own_us=12_000, path=(0, 1, 19_000))
    tracker = eeruf.EchoTracker(8, settings=settings)
    for reading in readings:
        assert reading.phase is not None
        again = tracker.push(reading.sensor, reading.phase, reading.t_echo_us)
        assert (again.kind, again.age, again.phase) == (reading.kind, reading.age, reading.phase)
    assert {"first", "tentative", "accepted"} <= {reading.kind for reading in readings}


def test_many_readings_at_once_are_judged_as_one_by_one() -> None:
    chance = np.random.default_rng(1)
    echoes = np.where(chance.random((300, 3)) < 0.2, np.nan, chance.integers(0, 3, (300, 3)) * 300 + 9_000.0)
    phases = np.arange(300) % 11
    together, alone = eeruf.EchoTracker(3).push_many(phases, echoes), eeruf.EchoTracker(3)
    for row, phase, kinds in zip(echoes, phases, together):
        for sensor, (us, kind) in enumerate(zip(row, kinds)):
            reading = alone.push(sensor, phase, None if np.isnan(us) else int(us))
            assert reading.kind == eeruf.KINDS[kind]
    assert len(np.unique(together)) > 3


def test_unsteady_firings_support_nothing_solo_ones_at_once() -> None:
    tracker = eeruf.EchoTracker(1)
    assert {tracker.push(0, phase, 9_000, steady=False).kind for phase in range(11)} == {"first"}
    assert tracker.push(0, 0, 9_000, solo=True).kind == "tentative"
    tracker.forget(0)
    assert tracker.push(0, 0, 9_000).kind == "first"


def test_each_error_counts_sensors_from_0_and_says_expected() -> None:
    for make, error, text in (
        (lambda: HoppingSchedule(65, 60_000, 240), eeruf.ArgumentError, "sensors = 65; expected"),
        (lambda: HoppingSchedule(2, 60_000, 240, 70), eeruf.ArgumentError, "phases = 70; expected"),
        (lambda: HoppingSchedule(2, 60_000, 240, 2, [0]), eeruf.ArgumentError, "t_lag_us = 1 times; expected"),
        (lambda: HoppingSchedule(2, 60_000, 240, 2, [0, 60_000]), eeruf.HoppingError, "for sensor 1; expected"),
        (lambda: HoppingSettings(tentative_within_us=151), eeruf.HoppingError, "tentative_within is 151"),
        (lambda: ANY.HoppingSettings(vote=3), eeruf.ArgumentError, "no setting vote; expected one of t_delta_us"),
        (lambda: eeruf.EchoTracker(2).push(2, 0, 9_000), eeruf.ArgumentError, "sensor = 2; expected"),
        (lambda: eeruf.EchoTracker(2).push_many([0], [[1, 2], [1, 2]]), eeruf.ArgumentError, "2 phases"),
        (
            lambda: Ring.hopping(EIGHT, HoppingSettings(t_delta_us=240), window_us=WINDOW_US),
            eeruf.HoppingError,
            "240 us",
        ),
        (
            lambda: Ring.hopping(HoppingSchedule(2, PERIOD_US, 240, 2), window_us=WINDOW_US),
            eeruf.HoppingError,
            "5 votes to confirm an echo; expected at most 4",
        ),
        (lambda: ANY.Ring.flow(8, {"rest": 1}, window_us=9_000), eeruf.ArgumentError, "no setting rest of flow"),
        (lambda: Ring.flow(8, {"step_us": 100}, window_us=9_000), eeruf.HoppingError, "100 us"),
        (lambda: Ring.hopping(EIGHT, window_us=60_000), eeruf.HoppingError, "a period of 60 ms; expected 61.2 ms"),
        (lambda: Ring.hopping(EIGHT, window_us=100, blanking_us=100), eeruf.HoppingError, "blanking"),
        (
            lambda: Ring.hopping(HoppingSchedule(8, 30_000_000, 240), window_us=16_711_680),
            eeruf.HoppingError,
            "a listening window of 16711.68 ms; expected at most 16711.679 ms",
        ),
    ):
        with pytest.raises(error, match=text):
            make()

"""Logs of robots: the same bags as Rust reads, and what a ring's log of firings says."""

import contextlib
import shutil
import sqlite3
import subprocess
import sys
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import sim

BAGS = Path(__file__).parents[2] / "crates/eeruf-logs/tests/bags"


def simulated(method: Any, periods: int) -> tuple[eeruf.logs.Firings, sim.Readings]:
    """Firings as firmware would log them, and the readings with what caused them."""
    scene = sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
    readings = sim.simulate(scene, method, periods=periods)
    fired_us = np.rint(1e6 * readings.fired_s)
    firings = eeruf.logs.Firings.of(
        sensor=readings.sensor,
        fired_us=fired_us,
        period=readings.period,
        phase=readings.phase,
        t_echo_us=readings.earliest_us,
    )
    return firings, readings


@pytest.mark.parametrize("name", ["ros1-none.bag", "ros1-bz2.bag", "ros1-lz4.bag", "mcap-jazzy", "mcap-jazzy-zstd"])
def test_bags_of_all_kinds_are_read_alike(name: str) -> None:
    log, other = eeruf.read_log(BAGS / name), eeruf.read_log(BAGS / "mcap-humble")
    assert log.damage == [] and len(other) == 12
    for topic in ["/sonar/0", "/sonar/1"]:
        here, there = log.sensor == log.names.index(topic), other.sensor == other.names.index(topic)
        assert here.sum() == 6
        np.testing.assert_array_equal(log.range_m[here], other.range_m[there])
    assert (log.at_ns > 0).all() and not log.range_m.flags.writeable


@pytest.mark.parametrize("name", ["sqlite-humble", "sqlite-jazzy", "sqlite-jazzy-packed"])
def test_a_bag_of_sqlite_is_read_as_one_of_mcap_is(name: str, tmp_path: Path) -> None:
    # The wheel's own SQLite is built without what bags do not need.
    shutil.copytree(BAGS / name, tmp_path / name)
    with contextlib.closing(sqlite3.connect(tmp_path / name / f"{name}.db3")) as database:
        database.executescript((BAGS / name / f"{name}.sql").read_text())
    log, other = eeruf.read_log(tmp_path / name), eeruf.read_log(BAGS / "mcap-humble")
    assert log.damage == []
    np.testing.assert_array_equal(np.sort(log.range_m), np.sort(other.range_m))


def test_columns_of_csv_have_any_names_and_units(tmp_path: Path) -> None:
    file = tmp_path / "log.csv"
    file.write_text("id,ms,cm\n7,100,120\n9,160,\n7,220,600\n")
    log = eeruf.read_log(file, time="ms", time_unit="ms", ranges=["cm"], range_unit="cm", sensor="id", no_echo_m=4)
    assert log.names == ["7", "9"] and log.sensor.tolist() == [0, 1, 0]
    assert log.at_ns.tolist() == [100_000_000, 160_000_000, 220_000_000]
    np.testing.assert_allclose(log.echo_us(speed_of_sound=343.2), [2.4e6 / 343.2, np.nan, np.nan])
    assert list(log.to_pandas()["range_m"]) == list(log.range_m) and log.to_polars().height == 3
    for wrong, said in [
        ({"time_unit": "h"}, "time_unit"),
        ({"speed_of_sound": 0.0}, "speed_of_sound"),
        ({"time": "t"}, "t"),
    ]:
        with pytest.raises(eeruf.EerufError, match=said):
            eeruf.read_log(file, **wrong)  # type: ignore[arg-type]


def test_a_cut_bag_gives_what_can_be_read_and_says_what_cannot(tmp_path: Path) -> None:
    whole = (BAGS / "ros1-none.bag").read_bytes()
    (tmp_path / "cut.bag").write_bytes(whole[: len(whole) // 2 + 2200])
    log = eeruf.read_log(tmp_path / "cut.bag")
    assert 0 < len(log) < len(eeruf.read_log(BAGS / "ros1-none.bag")) and "cut" in log.damage[0]
    with pytest.raises(eeruf.LogError, match=r"not-there\.bag"):
        eeruf.read_log(tmp_path / "not-there.bag")


def test_diagnose_names_senders_as_the_simulator_knows_them() -> None:
    firings, readings = simulated("eeruf_hopping", 600)
    found = eeruf.diagnose(firings)
    named = (found.sender >= 0) & (found.sender != firings.sensor)
    assert named.sum() > 300 and found.faults == [] and found.most_offsets > 5
    sent_by = np.array([readings.paths["emitter"][path] if path >= 0 else -1 for path in readings.path])
    assert (sent_by[named] == found.sender[named]).mean() > 0.98
    assert set(found.paths["receiver"]) <= set(range(8)) and (found.sure[named] >= 0.99).all()
    with pytest.raises(eeruf.EerufError, match="sensor"):
        eeruf.diagnose(eeruf.logs.Firings.of(sensor=[64], fired_us=[0], period=[0], phase=[0], t_echo_us=[1.0]))


def test_a_survey_says_who_hears_whom(tmp_path: Path) -> None:
    rows = ["sensor,fired_us,period,phase,t_echo_us"]
    # Sensor 1 hears sensor 0 after 5 ms and itself after 9 ms; sensor 0 hears itself after 7 ms.
    slot = 0
    for lead in range(0, 9_000, 500):
        begins = 100_000 * slot
        rows.append(f"0,{begins},{slot},0,7000")
        rows.append(f"1,{begins + lead},{slot},0,{9000 if lead > 4000 else 5000 - lead}")
        slot += 1
    (tmp_path / "survey.csv").write_text("\n".join(rows) + "\n")
    found = eeruf.survey(tmp_path / "survey.csv")
    ((x, y, travel_us),) = found.conflicts
    assert (x, y) == (0, 1) and abs(travel_us - 5000) < 1
    assert len(eeruf.read_firings(tmp_path / "survey.csv")) == 2 * slot


def test_the_replay_of_a_hopping_rings_log_is_the_run(tmp_path: Path) -> None:
    log, scene = tmp_path / "log.csv", tmp_path / "alcove.toml"
    scene.write_text(eeruf.example("scenes/alcove.toml"))
    study = ["study", scene, "--method", "eeruf_hopping", "--log", log]
    subprocess.run([sys.executable, "-m", "eeruf", *map(str, study), "--periods", "300"], check=True)
    run = eeruf.replay(log)
    assert len(run) > 1500 and (run.kind == run.logged).all() and (run.kind == eeruf.KINDS.index("tentative")).any()
    assert (np.diff(run.fired_us) >= 0).all() and run.damage is None
    other = eeruf.replay(log, settings="maps")
    assert (other.kind != run.kind).any() and not (other.kind == eeruf.KINDS.index("tentative")).any()
    (tmp_path / "plain.csv").write_text("sensor,fired_us,period,phase,t_echo_us\n0,0,0,0,7000\n")
    with pytest.raises(eeruf.logs.LogError, match="does not say how it was weighed"):
        eeruf.replay(tmp_path / "plain.csv")


CASES = Path(__file__).parents[1] / "data" / "field-cases"


def test_arguments_override_guesses_which_are_listed() -> None:
    log = eeruf.read_log(CASES / "semicolon-decimal-comma.csv")
    assert log.names == ["left", "right"] and log.firing == "unknown" and "no times" in log.proves
    assert {what for what, _, _ in log.guesses} >= {"separator", "decimal mark", "range unit", "no echo", "time"}
    assert set(log.at_ns.tolist()) == {-1}
    np.testing.assert_allclose(log.range_m[:2], [0.405, 0.801])
    millimetres = eeruf.read_log(CASES / "multiarray.bag", fields=[("/ultrasonic", "data[]", "mm")])
    np.testing.assert_allclose(millimetres.range_m * 1000, eeruf.read_log(CASES / "multiarray.bag").range_m)
    zero = eeruf.read_log(CASES / "zero-is-no-echo.csv", no_echo=["80"], columns=["left", "right"])
    assert zero.range_m[:2].tolist() == [0.0, np.inf]
    with pytest.raises(eeruf.LogError, match="no sensors; expected ranges; found /RosAria/sonar"):
        eeruf.read_log(CASES / "pointcloud.bag")
    assert len(eeruf.read_log(CASES / "pointcloud.bag", topics=["/RosAria/sonar"]).names) > 1
    with pytest.raises(eeruf.ArgumentError, match=r"fields = .*; expected triples"):
        eeruf.read_log(CASES / "multiarray.bag", fields=[("/ultrasonic", "data[]", "km")])

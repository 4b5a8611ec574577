"""Logs of robots: the same bags as Rust reads, and findings from a ring's log of firings."""

import contextlib
import gzip
import io
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import eeruf
import fsspec
import numpy as np
import pytest
from eeruf import sim

BAGS = Path(__file__).parents[2] / "crates/eeruf-logs/tests/bags"


def simulated(method: Any, periods: int) -> tuple[eeruf.logs.Firings, sim.Readings]:
    """Return firings as firmware would log them, and the readings with their causes."""
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


def program(words: list[object]) -> str:
    """Run the program, and return what it prints."""
    command = [sys.executable, "-m", "eeruf", *map(str, words)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def assert_same(log: eeruf.logs.Ranges, other: eeruf.logs.Ranges) -> None:
    """Compare two readings of a log in everything but the name of the file."""
    for name, column in log.columns().items():
        np.testing.assert_array_equal(column, getattr(other, name), err_msg=name)
    for name in ("names", "topics", "frames", "skipped", "guesses", "warnings", "firing", "proves", "crosstalk"):
        assert getattr(log, name) == getattr(other, name), name
    assert len(log.damage) == len(other.damage)


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
    # The wheel's own SQLite is built without features that bags do not need.
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
    firings, readings = simulated("dither", 600)
    found = eeruf.logs.diagnose(firings)
    named = (found.sender >= 0) & (found.sender != firings.sensor)
    assert named.sum() > 300 and found.faults == [] and found.most_offsets > 5
    sent_by = np.array([readings.paths["emitter"][path] if path >= 0 else -1 for path in readings.path])
    assert (sent_by[named] == found.sender[named]).mean() > 0.98
    assert set(found.paths["receiver"]) <= set(range(8)) and (found.sure[named] >= 0.99).all()
    with pytest.raises(eeruf.EerufError, match="sensor"):
        eeruf.logs.diagnose(eeruf.logs.Firings.of(sensor=[64], fired_us=[0], period=[0], phase=[0], t_echo_us=[1.0]))


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
    found = eeruf.logs.survey(tmp_path / "survey.csv")
    ((x, y, travel_us),) = found.conflicts
    assert (x, y) == (0, 1) and abs(travel_us - 5000) < 1
    assert len(eeruf.logs.read_firings(tmp_path / "survey.csv")) == 2 * slot


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
    with pytest.raises(eeruf.EerufError, match=r"fields = .*; expected triples"):
        eeruf.read_log(CASES / "multiarray.bag", fields=[("/ultrasonic", "data[]", "km")])


class Once(io.RawIOBase):
    """A stream that cannot go back, and gives few bytes at a time."""

    def __init__(self, content: bytes) -> None:
        self.content = io.BytesIO(content)

    def readable(self) -> bool:
        return True

    def read(self, size: int = -1) -> bytes:
        return self.content.read(min(size, 1000))


def in_zip(content: bytes) -> Any:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as folder:
        folder.writestr("log", content)
    return zipfile.ZipFile(packed).open("log")


def in_memory(content: bytes) -> str:
    with fsspec.open("memory://logs/log", "wb") as file:
        file.write(content)
    return "memory://logs/log"


def behind(content: bytes) -> io.BytesIO:
    """Return a file positioned at the beginning of the log."""
    file = io.BytesIO(b"before it" + content)
    file.seek(9)
    return file


SOURCES: dict[str, Callable[[bytes], Any]] = {
    "bytes": io.BytesIO,
    "stream": Once,
    "zip": in_zip,
    "gzip": lambda content: gzip.GzipFile(fileobj=io.BytesIO(gzip.compress(content))),
    "packed": lambda content: io.BytesIO(gzip.compress(content)),
    "url": in_memory,
    "openable": lambda content: fsspec.open(in_memory(content)),
    "behind": behind,
}
FILES = [
    BAGS / "ros1-bz2.bag",
    BAGS / "mcap-jazzy-zstd" / "mcap-jazzy-zstd.mcap",
    CASES / "semicolon-decimal-comma.csv",
    CASES / "multiarray.bag",
]


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_a_log_is_read_alike_from_anywhere(source: str, file: Path) -> None:
    assert_same(eeruf.read_log(SOURCES[source](file.read_bytes())), eeruf.read_log(file))


def test_bags_in_folders_and_sqlite_are_read_from_anywhere(tmp_path: Path) -> None:
    folder, name = tmp_path / "bag", "sqlite-jazzy"
    shutil.copytree(BAGS / name, folder)
    with contextlib.closing(sqlite3.connect(folder / f"{name}.db3")) as database:
        database.executescript((BAGS / name / f"{name}.sql").read_text())
    log = eeruf.read_log(folder)
    assert_same(
        eeruf.read_log(io.BytesIO((folder / f"{name}.db3").read_bytes())), eeruf.read_log(folder / f"{name}.db3")
    )
    fsspec.filesystem("memory").put(str(folder), "/bags/drive", recursive=True)
    assert_same(eeruf.read_log("memory://bags/drive/"), log)


def test_firings_are_read_from_anywhere() -> None:
    text = "# clock: board\nsensor,fired_us,period,phase,t_echo_us\n0,15000,0,0,5872\n1,16000,0,0,\n"
    for source in [io.StringIO(text), *(make(text.encode()) for make in SOURCES.values())]:
        log = eeruf.logs.read_firings(source)
        assert (log.clock, log.sensor.tolist(), log.t_echo_us[0]) == ("board", [0, 1], 5872.0)
    assert eeruf.logs.diagnose(io.StringIO(text)).sender.tolist() == [-1, -1]
    assert eeruf.logs.survey(in_memory(text.encode())).conflicts == []


def test_blocks_are_the_log_in_parts() -> None:
    file = CASES / "multiarray.bag"
    log, blocks = eeruf.read_log(file), list(eeruf.logs.blocks(file, rows=7))
    assert len(blocks) > 2 and [len(block) for block in blocks[:-1]] == [7] * (len(blocks) - 1)
    for name, column in log.columns().items():
        np.testing.assert_array_equal(np.concatenate([getattr(block, name) for block in blocks]), column)
    last = blocks[-1]
    assert (last.names, last.firing, last.proves, last.crosstalk) == (log.names, log.firing, log.proves, log.crosstalk)
    assert blocks[0].crosstalk.reasons == ["the log is not read to its end"] == [blocks[0].proves]
    assert len(list(eeruf.logs.blocks(file, rows=len(log)))) == 1
    with pytest.raises(eeruf.LogError, match="no sensors"):
        list(eeruf.logs.blocks(io.StringIO("x,y\nno,number\n")))
    with pytest.raises(TypeError, match="unexpected keyword argument 'tim'; expected time"):
        eeruf.logs.blocks(file, tim="t")  # type: ignore[call-overload]


def test_what_a_file_raises_comes_out_as_it_is() -> None:
    class Gone(io.BytesIO):
        def read(self, size: int | None = -1, /) -> bytes:
            if self.tell() > 100_000:
                raise ConnectionResetError("the store is gone")
            return super().read(size)

    content = b"left,right\n" + b"1.2,1.3\n" * 100_000
    blocks = eeruf.logs.blocks(Gone(content), rows=1_000)
    with pytest.raises(ConnectionResetError, match="the store is gone"):
        for block in blocks:
            assert len(block) == 1_000
    assert list(blocks) == []
    with pytest.raises(TypeError, match="expected bytes"):
        eeruf.read_log(type("Odd", (), {"read": lambda self, size: 7})())
    with pytest.raises(eeruf.EerufError, match="expected the path of a log, a URL or a file object"):
        eeruf.read_log(7)  # type: ignore[arg-type]


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux to count threads")
def test_blocks_that_nobody_reads_on_end_their_thread() -> None:
    content = b"left,right\n" + b"1.2,1.3\n" * 100_000
    before = len(os.listdir("/proc/self/task"))
    for _ in range(20):
        next(eeruf.logs.blocks(io.BytesIO(content), rows=10))
    for _ in range(100):
        if len(os.listdir("/proc/self/task")) <= before + 1:
            return
        time.sleep(0.1)
    raise AssertionError("threads run on")


JUDGES = [
    (eeruf.logs.Agree(500), ["--t-delta-us", "500"]),
    (eeruf.logs.Agree(300, consecutive=3), ["--t-delta-us", "300", "--consecutive", "3"]),
]


@pytest.mark.parametrize(("judge", "words"), JUDGES)
def test_judges_are_those_of_the_program(judge: Any, words: list[str], tmp_path: Path) -> None:
    scene, study = tmp_path / "alcove.toml", tmp_path / "study.mcap"
    scene.write_text(eeruf.example("scenes/alcove.toml"))
    program(["study", scene, "--method", "conventional", "--periods", "200", "--mcap", study])
    with study.open("rb") as file:
        judged = eeruf.logs.replay(file, judge, out=tmp_path / "ours.mcap")
    said = json.loads(program(["replay", study, *words, "--out", tmp_path / "theirs.mcap", "--json"]))
    kinds = [eeruf.KINDS[kind] for kind in judged.kind]
    assert {kind: kinds.count(kind) for kind in ("accepted", "rejected", "first", "clear")} == {
        kind: said["total"][kind] for kind in ("accepted", "rejected", "first", "clear")
    }
    assert len(judged) == 1600 and said["firing"]["pattern"] == judged.firing
    assert (tmp_path / "ours.mcap").read_bytes() == (tmp_path / "theirs.mcap").read_bytes()
    again = eeruf.logs.replay(eeruf.read_log(study), judge)
    np.testing.assert_array_equal(again.kind, judged.kind)
    assert (again.gaps, again.backwards, list(again.to_pandas())[-1]) == (judged.gaps, judged.backwards, "kind")
    parts = list(eeruf.logs.blocks(study, judge=judge, rows=100))
    np.testing.assert_array_equal(np.concatenate([part.kind for part in parts]), judged.kind)
    # Constant lags do not tell: exit code 3.
    command = [sys.executable, "-m", "eeruf", "logs", str(study), "--json"]
    told = subprocess.run(command, check=False, capture_output=True, text=True)
    codes = {"none seen": 0, "crosstalk": 1, "cannot tell": 3}
    assert judged.crosstalk.verdict == json.loads(told.stdout)["crosstalk"]["verdict"]
    assert told.returncode == codes[judged.crosstalk.verdict]


@pytest.mark.parametrize(("scene", "ending"), [("alcove-hc-sr04", "csv"), ("alcove-hc-sr04", "mcap"), ("lab", "csv")])
def test_log_of_a_flow_ring_is_judged_again_as_it_was(scene: str, ending: str, tmp_path: Path) -> None:
    ring, log, out = tmp_path / "scene.toml", tmp_path / f"log.{ending}", tmp_path / "again.csv"
    ring.write_text(eeruf.example(f"scenes/{scene}.toml"))
    program(["study", ring, "--method", "flow", "--periods", "300", "--log", log])
    said = json.loads(program(["replay", log, "--ring", ring, "--out", out, "--json"]))
    assert said["compared"] == said["alike"] == sum(sensor["readings"] for sensor in said["sensors"]) > 500
    again = json.loads(program(["replay", out, "--ring", ring, "--json"]))
    assert [sensor["kinds"] for sensor in again["sensors"]] == [sensor["kinds"] for sensor in said["sensors"]]
    believed = [line.rsplit(",", 1)[1] for line in out.read_text().splitlines()[2:]]
    assert 0 < sum(us != "" for us in believed) <= said["compared"]


@pytest.mark.parametrize("speed_m_s", [1.5, 3.0])
@pytest.mark.parametrize("room", [1025, 1035, 1039])
def test_no_healthy_sensor_of_a_fast_robot_is_blamed(room: int, speed_m_s: float) -> None:
    # Laps in a room with poles; the log has what each sensor would read alone, then what it reads.
    chance = np.random.default_rng(room)
    (w, h), shares = chance.uniform(3, 6, 2), chance.uniform(0.18, 0.9, 4)
    walls = [[-w, -h, w, -h], [w, -h, w, h], [w, h, -w, h], [-w, h, -w, -h]]
    places = [(-0.9, -1), (-0.9, 1), (0.9, -1), (0.9, 1)]
    poles = [[x * w, y * h * share, 0.05] for (x, y), share in zip(places, shares)]
    corners = [(0.6 * w, -0.6 * h), (0.6 * w, 0.6 * h), (-0.6 * w, 0.6 * h), (-0.6 * w, -0.6 * h)]
    robot = sim.Robot((*corners[3], 0.0), 8, 0.26, 0.3, waypoints_m=corners * 8, speed_m_s=speed_m_s)
    readings = sim.simulate(sim.Scene(walls, robots=[robot], poles=poles), "eeruf", periods=600, seed=room - 1000)
    said = []
    for echo_us in (readings.reference_us, readings.earliest_us):
        rows = [
            f"{1e6 * at:.0f},{sensor},{0.5e-6 * us * 343.2:.5f}"
            for at, sensor, us in sorted(zip(readings.fired_s, readings.sensor, echo_us), key=lambda row: row[:2])
        ]
        text = io.StringIO("\n".join(["time_us,sensor,range_m", *rows]))
        said.append(eeruf.read_log(text, time_unit="us", no_echo_m=20).crosstalk)
    alone, heard = said
    assert alone.verdict != "crosstalk" and alone.fooled == [], alone.reasons
    assert heard.verdict == "crosstalk" and len(heard.fooled) >= 3


def test_gaps_and_steps_back_are_counted_by_sensor() -> None:
    text = (
        "t,left,right\n"
        + "".join(f"{0.1 * n + (50 if n > 20 else 0):.1f},1.2,2.3\n" for n in range(40))
        + "1.0,1.2,2.3\n"
    )
    judged = eeruf.logs.replay(io.StringIO(text), eeruf.logs.Agree(500), time_unit="s")
    assert (judged.gaps, judged.backwards) == ([1, 1], [1, 1])
    # What comes first, after the gap, and after the step back.
    assert (judged.kind[judged.sensor == 1] == eeruf.KINDS.index("first")).sum() == 3
    with pytest.raises(eeruf.EerufError, match="ranges were read before"):
        eeruf.logs.replay(judged, eeruf.logs.Agree(500), out="judged.mcap")
    with pytest.raises(eeruf.EerufError, match="time = 't'; expected it only where a log of ranges is read"):
        eeruf.logs.replay(judged, eeruf.logs.Agree(500), time="t")


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs Linux to measure memory")
def test_ten_million_readings_of_a_server_take_little_memory() -> None:
    found = [far_log(readings) for readings in (1_000_000, 10_000_000)]
    for readings, said in zip((1_000_000, 10_000_000), found):
        assert said["table"]["readings"] == said["mcap"]["readings"] == readings
        assert said["table"]["accepted"] == readings // 2 and said["table"]["damage"] == said["mcap"]["damage"] == []
        # MCAP has ranges as floats of 32 bits.
        assert said["mcap"]["metres"] == pytest.approx(said["table"]["metres"], rel=1e-6)
    # Neither takes more than 200 MB, or the script fails. A reading kept in 8 bytes would take 72 MB more; how many
    # blocks wait for the reader, some 25 MB, depends on the machine's load.
    assert found[1]["largest_mb"] < 50 + found[0]["largest_mb"]


def far_log(readings: int) -> Any:
    command = [sys.executable, str(Path(__file__).with_name("far_log.py")), str(readings)]
    said = subprocess.run(command, capture_output=True, text=True)
    assert said.returncode == 0, said.stderr
    return json.loads(said.stdout)


def blocking_loop() -> list[tuple[float, float]]:
    """Make the ranges in metres of two sensors, the second of which hears the first: their sum is constant."""
    front = 0.6 + 0.3 * np.sin(np.arange(300) / 7) + 0.1 * np.sin(np.arange(300) / 2)
    return [(round(float(own), 3), round(2.1 - float(own), 3)) for own in front]


def test_anything_with_ranges_is_checked_alike(tmp_path: Path) -> None:
    rows = blocking_loop()
    text = "front_m,left_m\n" + "".join(f"{one},{two}\n" for one, two in rows)
    file = tmp_path / "log.csv"
    file.write_text(text)
    columns = {"front_m": [one for one, _ in rows], "left_m": [two for _, two in rows]}
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    given = [
        text,
        file,
        io.StringIO(text),
        columns,
        pandas.DataFrame(columns),
        polars.DataFrame(columns),
        eeruf.read_log(file),
    ]
    for log in given:
        checked = eeruf.check(log)
        assert checked.concerns == ["left_m"] and checked.verdict == "cannot tell", str(checked)
        assert str(checked).startswith("Perhaps crosstalk"), str(checked)
        assert checked.sensors["front_m"] == eeruf.check(text).sensors["front_m"]
    array = eeruf.check(np.array(rows))
    assert array.concerns == ["range 2"] and array.sensors["range 1"]["readings"] == 300
    printed = subprocess.run(
        [sys.executable, "-m", "eeruf", "logs", str(file)], check=False, capture_output=True, text=True
    )
    # The program wraps lines at the terminal's width.
    assert printed.returncode == 3 and printed.stdout.split()[:60] == str(eeruf.check(file)).split()[:60]


def test_readings_of_the_simulator_are_checked() -> None:
    scene = sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
    checked = eeruf.check(sim.simulate(scene, "eeruf", periods=300))
    assert checked.verdict == "crosstalk" and len(checked.sensors) == 8, str(checked)


def test_figure_marks_what_a_check_concerns() -> None:
    ax = eeruf.check(np.array(blocking_loop())).figure()
    colours = [line.get_color() for line in ax.lines]
    assert len(colours) == 2 and colours.count("#d55e00") == 1 and ax.get_xlabel() == "reading"


@pytest.mark.parametrize("wrong", [3, None, np.zeros((2, 2, 2)), {"a": [1.0], "b": []}])
def test_what_holds_no_ranges_is_refused(wrong: object) -> None:
    with pytest.raises(eeruf.EerufError, match="expected"):
        eeruf.check(wrong)

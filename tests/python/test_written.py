"""Readers of other projects read the program's files."""

import re
import subprocess
import sys
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pandas as pd
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

TYPES = {
    "sensor_msgs/msg/Range",
    "tf2_msgs/msg/TFMessage",
    "nav_msgs/msg/Odometry",
    "visualization_msgs/msg/MarkerArray",
    "eeruf_msgs/msg/Firing",
}


def run(*args: object) -> None:
    subprocess.run([sys.executable, "-m", "eeruf", *map(str, args)], check=True, stdout=subprocess.DEVNULL)


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study")
    (folder / "alcove.toml").write_text(eeruf.example("scenes/alcove.toml"))
    run(
        *("study", folder / "alcove.toml", "--method", "conventional,flow", "--periods", 40),
        *("--mcap", folder / "study.mcap"),
    )
    return folder / "study.mcap"


def by_mcap(file: Path) -> list[tuple[str, str, int, Any]]:
    with file.open("rb") as opened:
        messages = make_reader(opened, decoder_factories=[DecoderFactory()]).iter_decoded_messages()
        return [(channel.topic, schema.name, message.log_time, of) for schema, channel, message, of in messages]


def by_rosbags(file: Path) -> list[tuple[str, str, int, Any]]:
    with AnyReader([file]) as reader:
        return [
            (connection.topic, connection.msgtype, at, reader.deserialize(raw, connection.msgtype))
            for connection, at, raw in reader.messages()
        ]


@pytest.mark.parametrize("read", [by_mcap, by_rosbags])
def test_foreign_readers_read_a_study_as_we_do(read: Any, study: Path) -> None:
    messages = read(study)
    counts = Counter(kind for _, kind, _, _ in messages)
    assert set(counts) == TYPES and counts["tf2_msgs/msg/TFMessage"] == counts["nav_msgs/msg/Odometry"] > 40
    log = eeruf.read_log(study)
    mine = {(log.names[sensor], at): metres for sensor, at, metres in zip(log.sensor, log.at_ns, log.range_m)}
    theirs = {
        (topic, at): of.range
        for topic, kind, at, of in messages
        if kind == "sensor_msgs/msg/Range" and not topic.endswith("/accepted")
    }
    assert mine.keys() == theirs.keys() and len(mine) > 400
    assert all(np.float32(mine[key]) == np.float32(theirs[key]) for key in mine)
    for _, kind, _, of in messages:
        if kind == "tf2_msgs/msg/TFMessage":
            child = {transform.child_frame_id: transform for transform in of.transforms}
            assert len(child) == 9 and child["robot_1/sonar_1"].header.frame_id == "robot_1"
            turned = [child["robot_1"].transform.rotation.z, child["robot_1"].transform.rotation.w]
            assert np.hypot(*turned) == pytest.approx(1.0)


@pytest.mark.parametrize("read", [by_mcap, by_rosbags])
def test_foreign_readers_read_firings_as_we_do(read: Any, study: Path, tmp_path: Path) -> None:
    run(
        "study",
        study.with_name("alcove.toml"),
        "--method",
        "flow",
        "--periods",
        40,
        "--log",
        tmp_path / "f.csv",
    )
    table = pd.read_csv(tmp_path / "f.csv", comment="#")
    firings = [of for topic, _, _, of in read(study) if topic == "/flow/firings"]
    assert len(firings) == len(table) > 100
    for name in ["sensor", "fired_us", "period", "phase"]:
        assert [getattr(of, name) for of in firings] == list(table[name]), name
    echoes = [of.t_echo_us if of.has_echo else np.nan for of in firings]
    np.testing.assert_array_equal(echoes, table["t_echo_us"])


def test_what_replay_accepts_is_read_by_others(study: Path, tmp_path: Path) -> None:
    run("replay", study, "--t-delta-us", 500, "--out", tmp_path / "judged.mcap")
    mine, theirs = by_mcap(tmp_path / "judged.mcap"), by_rosbags(tmp_path / "judged.mcap")
    assert len(mine) == len(theirs) > 500 and {kind for _, kind, _, _ in mine} == {"sensor_msgs/msg/Range"}


def by_rerun(file: Path) -> dict[str, set[str]]:
    """Return the components of each topic, as Rerun shows them."""
    rerun, shown = Path(sys.executable).with_name("rerun"), file.with_suffix(".rrd")
    subprocess.run([rerun, "mcap", "convert", file, "-o", shown], check=True, capture_output=True)
    said = subprocess.run([rerun, "rrd", "print", "-v", shown], check=True, capture_output=True, text=True).stdout
    found: dict[str, set[str]] = defaultdict(set)
    for topic, columns in re.findall(r" - (/\S+) - data columns: \[(.*)\]", said):
        found[topic] |= {column.removeprefix(f"{topic}@") for column in columns.split()}
    return found


def test_rerun_shows_a_study_and_leaves_no_topic_raw(study: Path, tmp_path: Path) -> None:
    shown = by_rerun(study)
    assert {topic for topic, _, _, _ in by_mcap(study)} <= shown.keys()
    assert {"Transform3D:translation", "Transform3D:quaternion"} <= shown["/tf"]
    assert "Scalars:scalars" in shown["/conventional/robot_1/sonar_1"]
    assert [topic for topic, components in shown.items() if "McapMessage:data" in components] == []
    # A raw topic is shown like this.
    with (tmp_path / "raw.mcap").open("wb") as opened:
        writer = Writer(opened)
        writer.start()
        schema = writer.register_schema("odd", "ros2idl", b"odd")
        writer.add_message(writer.register_channel("/odd", "cdr", schema), 0, b"odd", 0)
        writer.finish()
    assert "McapMessage:data" in by_rerun(tmp_path / "raw.mcap")["/odd"]

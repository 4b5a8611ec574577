"""Write bags of every kind that `eeruf-logs` reads, with `rosbags` (PyPI), which shares no code with it.

    python write_bags.py FOLDER [--topics N] [--messages N]

The small bags in `bags/` are of two topics and six messages; SQLite ones are stored as SQL.
Message m of topic n (from 0) is stamped 1.7e9 + m/10 s and has a range of 1 + n/4 + m/64 m; but message 2 of each
topic is +Inf, message 3 is -Inf, and message 4 is NaN.
"""

import argparse
import shutil
import sqlite3
from pathlib import Path

from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

RANGE = """std_msgs/Header header
uint8 radiation_type
float32 field_of_view
float32 min_range
float32 max_range
float32 range
"""
HEADER = "=" * 80 + "\nMSG: std_msgs/Header\n{}time stamp\nstring frame_id\n"
SPECIAL = {2: float("inf"), 3: float("-inf"), 4: float("nan")}


def values(topic: int, message: int) -> tuple[int, int, str, float]:
    """Return stamp in seconds and nanoseconds, frame and range."""
    stamp = 1_700_000_000 * 10**9 + message * 10**8
    value = SPECIAL.get(message, 1 + topic / 4 + message / 64)
    return stamp // 10**9, stamp % 10**9, f"sonar_{topic}", value


def message_of(store, topic: int, number: int, *, ros1: bool, variance: bool):
    """Make a Range in a type store."""
    seconds, nanoseconds, frame, value = values(topic, number)
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)
    seq = {"seq": number} if ros1 else {}
    header = types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame, **seq)
    more = {"variance": 0.5} if variance else {}
    fields = dict(header=header, radiation_type=0, field_of_view=0.25, min_range=0.02, max_range=4.0, range=value)
    return types["sensor_msgs/msg/Range"](**fields, **more)


def scan_of(store, number: int, *, ros1: bool):
    """Make a LaserScan of four sonars."""
    import numpy

    seconds, nanoseconds, _, _ = values(0, number)
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)
    seq = {"seq": number} if ros1 else {}
    ranges = numpy.array([values(n, number)[3] for n in range(4)], dtype=numpy.float32)
    return types["sensor_msgs/msg/LaserScan"](
        header=types["std_msgs/msg/Header"](stamp=stamp, frame_id="ring", **seq),
        angle_min=-0.5,
        angle_max=0.5,
        angle_increment=0.25,
        time_increment=0.01,
        scan_time=0.1,
        range_min=0.02,
        range_max=4.0,
        ranges=ranges,
        intensities=numpy.zeros(0, dtype=numpy.float32),
    )


def write1(path: Path, compression, topics: int, messages: int) -> None:
    """Write a ROS 1 bag."""
    store = get_typestore(Stores.ROS1_NOETIC)
    definition = RANGE + HEADER.format("uint32 seq\n")
    path.unlink(missing_ok=True)
    writer = Writer1(path)
    if compression:
        writer.set_compression(compression)
    with writer:
        name = "sensor_msgs/msg/Range"
        connections = [
            writer.add_connection(f"/sonar/{n}", name, msgdef=definition, md5sum="c005c34273dc426c67a020a87bc24148")
            for n in range(topics)
        ]
        scan = writer.add_connection("/ring", "sensor_msgs/msg/LaserScan", msgdef="float32[] ranges\n", md5sum="0")
        for number in range(messages):
            for topic, connection in enumerate(connections):
                seconds, nanoseconds, _, _ = values(topic, number)
                raw = store.serialize_ros1(message_of(store, topic, number, ros1=True, variance=False), name)
                writer.write(connection, seconds * 10**9 + nanoseconds, raw)
            if number < 2:
                raw = store.serialize_ros1(scan_of(store, number, ros1=True), "sensor_msgs/msg/LaserScan")
                writer.write(scan, seconds * 10**9 + nanoseconds, raw)


def write2(path: Path, release, plugin, mode, topics: int, messages: int, *, version: int = 9) -> None:
    """Write a ROS 2 bag."""
    store = get_typestore(release)
    variance = "variance" in store.types["sensor_msgs/msg/Range"].__dataclass_fields__
    shutil.rmtree(path, ignore_errors=True)
    writer = Writer2(path, version=version, storage_plugin=plugin)
    if mode:
        writer.set_compression(mode, CompressionFormat.ZSTD)
    with writer:
        name = "sensor_msgs/msg/Range"
        definition = RANGE + ("float32 variance\n" if variance else "") + HEADER.format("builtin_interfaces/")
        known = {"msgdef": definition, "rihs01": "RIHS01_0"} if plugin is StoragePlugin.MCAP else {"typestore": store}
        connections = [writer.add_connection(f"/sonar/{n}", name, **known) for n in range(topics)]
        for number in range(messages):
            for topic, connection in enumerate(connections):
                seconds, nanoseconds, _, _ = values(topic, number)
                raw = store.serialize_cdr(message_of(store, topic, number, ros1=False, variance=variance), name)
                writer.write(connection, seconds * 10**9 + nanoseconds, raw)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--topics", type=int, default=2)
    parser.add_argument("--messages", type=int, default=6)
    parser.add_argument("--sql", action="store_true", help="put SQLite bags down as SQL")
    asked = parser.parse_args()
    folder, size = asked.folder, (asked.topics, asked.messages)
    folder.mkdir(parents=True, exist_ok=True)
    formats = Writer1.CompressionFormat
    for name, compression in [("none", None), ("bz2", formats.BZ2), ("lz4", formats.LZ4)]:
        write1(folder / f"ros1-{name}.bag", compression, *size)
    sqlite, mcap = StoragePlugin.SQLITE3, StoragePlugin.MCAP
    humble, jazzy = Stores.ROS2_HUMBLE, Stores.ROS2_JAZZY
    kinds = [
        ("sqlite-humble", humble, sqlite, None),
        ("sqlite-jazzy", jazzy, sqlite, None),
        ("sqlite-jazzy-packed", jazzy, sqlite, CompressionMode.MESSAGE),
        ("mcap-humble", humble, mcap, None),
        ("mcap-jazzy", jazzy, mcap, None),
        ("mcap-jazzy-packed", jazzy, mcap, CompressionMode.MESSAGE),
        ("mcap-jazzy-zstd", jazzy, mcap, CompressionMode.STORAGE),
    ]
    for name, release, plugin, mode in kinds:
        write2(folder / name, release, plugin, mode, *size)
        database = folder / name / f"{name}.db3"
        if asked.sql and plugin is sqlite:
            with sqlite3.connect(database) as connection:
                lines = "\n".join(connection.iterdump())
            database.unlink()
            database.with_suffix(".sql").write_text(lines + "\n")


if __name__ == "__main__":
    main()

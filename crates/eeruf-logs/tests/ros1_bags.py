"""Compare `eeruf logs` with ROS 1's own tools for bags: `/usr/bin/python3 ros1_bags.py PROGRAM`, after `apt install python3-rosbag python3-sensor-msgs`.

`eeruf logs` must read what `rosbag` records, in each compression; and `rosbag` must read the bags of the tests, which `rosbags` wrote,
like `eeruf logs`.
"""

import collections
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import genpy
import rosbag
from sensor_msgs.msg import LaserScan, Range

SENSORS = 3
BAGS = pathlib.Path(__file__).parent / "bags"
# ROS 1 refuses the lz4 of `rosbags`.
TEST_BAGS = ["ros1-none.bag", "ros1-bz2.bag"]


def record(bag: rosbag.Bag) -> None:
    """Record ranges of each kind, and a lidar that is not a ring of sonars."""
    for period in range(2000):
        at = genpy.Time.from_sec(1.6e9 + 0.06 * period)
        for sensor in range(SENSORS):
            message = Range(radiation_type=Range.ULTRASOUND, field_of_view=0.26, min_range=0.02, max_range=4.0)
            message.header.stamp, message.header.frame_id = at, f"sonar_{sensor}"
            odd = {0: math.inf, 1: -math.inf, 2: math.nan, 3: 4.5, 4: 0.01}
            message.range = odd.get((period + sensor) % 50, 0.5 + sensor + 0.001 * (period % 500))
            bag.write(f"/sonar/{sensor}", message, at)
        bag.write("/scan", LaserScan(range_max=10.0, ranges=[1.0] * 360), at)


def by_rosbag(file: pathlib.Path) -> "dict[str, list[float]]":
    """Return the ranges of each topic."""
    found = collections.defaultdict(list)
    with rosbag.Bag(str(file)) as bag:
        for topic, message, _ in bag.read_messages():
            if message._type == "sensor_msgs/Range":
                found[topic].append((message.range, message.min_range, message.max_range))
    return found


def summary(ranges: "list[tuple[float, float, float]]") -> "dict[str, object]":
    """Count as `eeruf logs` does, by REP 117."""
    echoes = [metres for metres, least, most in ranges if least <= metres < most]
    return {
        "readings": len(ranges),
        "echoes": len(echoes),
        "no_echo": sum(metres >= most for metres, _, most in ranges),
        "too_close": sum(metres < least for metres, least, _ in ranges),
        "invalid": sum(math.isnan(metres) for metres, _, _ in ranges),
        "least_m": min(echoes),
        "most_m": max(echoes),
    }


def check(program: str, file: pathlib.Path) -> int:
    """Compare the program's reading with that of ROS."""
    told = subprocess.run([program, "logs", str(file), "--json"], check=False, stdout=subprocess.PIPE)
    # 1 is crosstalk, 3 a log that cannot tell.
    assert told.returncode in (0, 1, 3), told.returncode
    said = json.loads(told.stdout)
    mine = {sensor.pop("name").split(" ")[0]: sensor for sensor in said["sensors"] if "/sonar" in sensor["name"]}
    theirs = {topic: summary(ranges) for topic, ranges in by_rosbag(file).items()}
    assert mine == theirs, (file.name, mine, theirs)
    return sum(sensor["readings"] for sensor in mine.values())


def main() -> None:
    """Check bags of every compression."""
    with tempfile.TemporaryDirectory() as folder:
        for compression in [rosbag.Compression.NONE, rosbag.Compression.BZ2, rosbag.Compression.LZ4]:
            file = pathlib.Path(folder) / f"{compression}.bag"
            with rosbag.Bag(str(file), "w", compression=compression, chunk_threshold=20_000) as bag:
                record(bag)
            assert check(sys.argv[1], file) == 2000 * SENSORS
    read = [check(sys.argv[1], BAGS / name) for name in TEST_BAGS]
    print(f"bags of three compressions by ROS 1, and {len(read)} that it reads, with {2000 * SENSORS} and {read} readings")


if __name__ == "__main__":
    main()

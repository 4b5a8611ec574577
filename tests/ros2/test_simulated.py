"""The node without hardware: the robot of a scene drives as it is asked to, and Cyclone DDS and Fast DDS each receive what
its ring reads, where it is, and what its sensors would see alone. One of its wires is cut."""

import math
import signal
import struct
import subprocess
import time

import pytest

from dds import (
    DOMAIN,
    ERROR,
    NODE,
    PATIENCE_S,
    RELIABLE,
    DiagnosticArray,
    LaserScan,
    Odometry,
    PointCloud2,
    Range,
    TFMessage,
    Twist,
    Vector3,
    environment,
    reader,
    taken,
    until,
)
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic

SENSORS, CUT = 4, 2
UNANSWERED = 4
# A wall two metres ahead, and four sensors; the wire of the third is cut from the start.
SCENE = f"""
seed = 1
max_order = 2

[[wall]]
points_m = [[2.0, -3.0], [2.0, 3.0]]
faces = "both"

[[robot]]
pose = {{ x_m = 0.0, y_m = 0.0, heading_deg = 0.0 }}
ring = {{ sensors = {SENSORS}, spacing_deg = 10.0, radius_m = 0.2 }}
module = "hc-sr04"

[[fault]]
kind = "cut"
sensors = [{CUT}]
"""


def stamp(message):
    header = message.transforms[0].header if hasattr(message, "transforms") else message.header
    return header.stamp.sec, header.stamp.nanosec


def points(cloud):
    return list(struct.iter_unpack("<fffBBxxf", bytes(cloud.data)))


def test_simulated_robot_reads_drives_and_says_the_truth(tmp_path, listener):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE)
    ranges = [reader(listener, f"/eeruf/sonar_{n + 1}", Range) for n in range(SENSORS)]
    clouds, true_clouds = [reader(listener, f"/eeruf/{name}", PointCloud2) for name in ("points", "true_points")]
    truth, transforms = reader(listener, "/eeruf/truth", Odometry), reader(listener, "/tf", TFMessage)
    reports = reader(listener, "/diagnostics", DiagnosticArray)
    scans = reader(listener, "/eeruf/scan", LaserScan)
    pilot = DomainParticipant(DOMAIN)
    velocity = DataWriter(pilot, Topic(pilot, "rt/cmd_vel", Twist, qos=RELIABLE), qos=RELIABLE)
    node = subprocess.Popen([NODE, "--simulate", str(scene)], env=environment(), stderr=subprocess.PIPE, text=True)
    everything = [*ranges, clouds, true_clouds, truth, transforms, reports, scans]
    heard = {each: [] for each in everything}
    others = [PointCloud2, PointCloud2, Odometry, TFMessage, DiagnosticArray, LaserScan]
    kinds = dict(zip(everything, [Range] * SENSORS + others))

    def take():
        for each in everything:
            heard[each] += taken(each, kinds[each])

    def has_driven():
        velocity.write(Twist(Vector3(0.3, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)))
        take()
        return heard[truth] and heard[truth][-1].pose.pose.position.x > 0.5 and len(heard[reports]) >= 2

    try:
        until("half a metre of driving", node, has_driven)
        # It stops by itself nowhere: the node is told to.
        velocity.write(Twist(Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)))
        until("standing still", node, lambda: take() or heard[truth][-1].twist.twist.linear.x == 0.0)
        stood = stamp(heard[truth][-1])
        standing = lambda: [cloud for cloud in heard[clouds] if stamp(cloud) > stood]
        until("thirty clouds", node, lambda: take() or len(standing()) >= 30)
        # What was sent last is still on its way.
        time.sleep(0.2)
    finally:
        node.send_signal(signal.SIGINT)
        said = node.communicate(timeout=PATIENCE_S)[1]
    assert node.returncode == 0, said
    take()
    for each in everything:
        heard[each] = [message for message in heard[each] if stamp(message) > stood]
    last = heard[truth][-1]
    assert (last.header.frame_id, last.child_frame_id) == ("map", "base_link")
    x = last.pose.pose.position.x
    assert 0.5 < x < 1.2 and last.pose.pose.position.y == pytest.approx(0.0, abs=1e-6)
    (transform,) = heard[transforms][-1].transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "base_link")
    assert transform.transform.translation.x == pytest.approx(x, abs=1e-9)
    stamps = [list(map(stamp, heard[each])) for each in (truth, transforms, true_clouds)]
    # The node may have left between two of them.
    shortest = min(map(len, stamps))
    assert all(each[:shortest] == stamps[0][:shortest] and len(each) <= shortest + 1 for each in stamps)
    assert abs(len(heard[truth]) - len(heard[clouds])) <= 1

    # The first and the last sensor look 15 degrees off the wall's normal, those between 5.
    for sensor in range(SENSORS):
        said = [message.range for message in heard[ranges[sensor]]]
        true = points(heard[true_clouds][-1])[sensor]
        assert true[3] == sensor
        if sensor == CUT:
            assert said == []
            assert all(points(cloud)[sensor][4] == UNANSWERED for cloud in heard[clouds])
            continue
        distance = math.hypot(true[0], true[1]) - 0.2
        assert distance == pytest.approx(2.0 - x - 0.2 * math.cos(math.radians((1.5 - sensor) * 10)), abs=0.05)
        assert len(said) >= 20
        right = [metres for metres in said if metres == pytest.approx(distance, abs=0.02)]
        assert len(right) >= 0.95 * len(said), (sensor, distance, said)
    scan = heard[scans][-1]
    assert (len(scan.ranges), scan.range_max, scan.header.frame_id) == (720, 4.0, "base_link")
    # Straight ahead the nearest arc; nobody looks behind.
    ahead, behind = scan.ranges[360], scan.ranges[0]
    assert ahead == pytest.approx(2.0 - x, abs=0.05) and math.isnan(behind)
    status = {status.name: status for status in heard[reports][-1].status}
    assert status[f"eeruf: sensor {CUT + 1}"].level == ERROR


def test_wrong_scene_is_named(tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.replace("spacing_deg", "spacing_dg"))
    ended = subprocess.run([NODE, "--no-ros", "--simulate", str(scene)], capture_output=True, text=True, timeout=60)
    assert ended.returncode == 1 and "scene.toml" in ended.stderr and "spacing_dg" in ended.stderr, ended.stderr

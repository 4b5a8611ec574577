"""Bytes that `eeruf design --program c --mavlink` writes to an autopilot's line, by pymavlink, and what autopilots make of it: eight
modules all around, each before a wall of its own."""

import os
import re
import subprocess
from collections import Counter
from pathlib import Path

os.environ["MAVLINK20"] = "1"

import pytest
from pymavlink.dialects.v20 import common

from autopilots import ArduPilot, Px4

ROOT = Path(__file__).parents[2]
SENSORS, SECONDS, DEAD = 8, 20, 2
# As tests/programs/walls.c has them, in metres at 343.2 m/s.
WALLS = [(2000 + sensor * 618 % 1000 * 20) * 343.2e-6 / 2 for sensor in range(SENSORS)]


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return built(tmp_path_factory.mktemp("mavlink") / "ring", 45)


def built(folder, apart):
    """The program of modules this many degrees apart, in its harness."""
    poses = ", ".join(f"{{ x_m = 0.1, y_m = 0.0, heading_deg = {apart * sensor} }}" for sensor in range(SENSORS))
    ring = folder.with_suffix(".toml")
    ring.write_text(f'sensors = {SENSORS}\nmodule = "hc-sr04"\nlayout = "ring"\nposes = [{poses}]\n')
    words = ["design", ring, "--places", "1", "--program", "c", "--mavlink", "--out", folder]
    subprocess.run([os.environ["EERUF_PROGRAM"], *words], check=True)
    parameters = (folder / "ardupilot.param").read_text()
    assert "\nPRX1_TYPE,2\n" in parameters and "\nSERIAL2_PROTOCOL,2\n" in parameters
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
    sources = [ROOT / "tests/programs/walls.c", folder / "sonar.c", folder / "eeruf.c"]
    subprocess.run(["gcc", *strict, f"-I{folder}", *sources, "-o", folder / "walls"], check=True)
    return folder / "walls"


def said(program, dead=-1, heard=b"", free=-1):
    """The messages of 20 s."""
    output = subprocess.run([program, str(dead), str(free)], input=heard, capture_output=True, check=True).stdout
    output = re.sub(rb"(\d+ \d+ \d+\n)+\n$", b"", output)
    assert len(output) < 11520 * SECONDS
    messages = common.MAVLink(None).parse_buffer(output)
    assert all(message.get_type() != "BAD_DATA" for message in messages)
    assert {(message.get_srcSystem(), message.get_srcComponent()) for message in messages} == {(1, 196)}
    return messages


def heartbeat(mode, system=1, autopilot=3, version=2):
    """An autopilot's heartbeat, after some noise of the line."""
    beat = common.MAVLink_heartbeat_message(2, autopilot, mode, 0, 4, 3)
    return b"\xfd\x09\xfe" + beat.pack(common.MAVLink(None, system, 1), force_mavlink1=version == 1)


def clockwise(sensor):
    return -45 * sensor % 360


def kinds(messages):
    return Counter(message.get_type() for message in messages)


def test_autopilots_see_the_wall_of_each_module(program):
    messages = said(program)
    count = kinds(messages)
    assert count["HEARTBEAT"] in (19, 20) and count["SYS_STATUS"] == count["HEARTBEAT"] and not count["STATUSTEXT"]
    # Each at least four times a second.
    assert count["OBSTACLE_DISTANCE"] > 4 * SECONDS and count["DISTANCE_SENSOR"] > 4 * SECONDS * SENSORS
    assert messages[-1].get_seq() == (len(messages) - 1) % 256
    for kind in ("DISTANCE_SENSOR", "OBSTACLE_DISTANCE"):
        ardupilot, px4 = ArduPilot(), Px4()
        for message in messages[len(messages) // 2 :]:
            if message.get_type() == kind:
                ardupilot.hear(message)
                px4.hear(message)
        assert ardupilot.is_healthy() and len(ardupilot.faces) == SENSORS
        for sensor, wall in enumerate(WALLS):
            angle, distance = ardupilot.faces[ardupilot.face(clockwise(sensor))]
            assert abs(distance - wall) <= 0.01, (kind, sensor, distance, wall)
            assert kind == "DISTANCE_SENSOR" or abs(px4.bins[clockwise(sensor) // 10] - wall) <= 0.01
    last = [message for message in messages if message.get_type() == "OBSTACLE_DISTANCE"][-1]
    assert (last.min_distance, last.max_distance, last.increment_f, last.angle_offset, last.frame) == (2, 400, 5, -20, 12)


def test_module_without_power_holds_back_until_armed(program):
    text = [(2, f"eeruf: sensor {DEAD + 1:02} does not answer")]
    armed = heartbeat(128)
    broken = armed[:-1] + bytes([armed[-1] ^ 1])
    for heard in (b"", heartbeat(128, system=2), heartbeat(128, autopilot=8), broken, armed + heartbeat(0)):
        messages = said(program, DEAD, heard)
        # Those before it has failed to answer.
        count = kinds(messages)
        assert count["OBSTACLE_DISTANCE"] <= 8 and count["HEARTBEAT"] >= 19, (heard, count)
        failed = [message for message in messages if message.get_type() == "SYS_STATUS"][-1]
        assert failed.onboard_control_sensors_health == 0
        assert [(message.severity, message.text) for message in messages if message.get_type() == "STATUSTEXT"] == text
    for version in (1, 2):
        messages = said(program, DEAD, heartbeat(128, version=version))
        last = [message for message in messages if message.get_type() == "OBSTACLE_DISTANCE"][-1]
        assert kinds(messages)["OBSTACLE_DISTANCE"] > 4 * SECONDS
        sector = (clockwise(DEAD) + 20) // 5
        assert last.distances[sector] == 65535 and last.distances[(clockwise(DEAD + 1) + 20) // 5] < 400
        assert [message.get_type() for message in messages].count("STATUSTEXT") == 1
        rotations = {message.orientation for message in messages[40:] if message.get_type() == "DISTANCE_SENSOR"}
        assert rotations == set(range(SENSORS)) - {clockwise(DEAD) // 45}
        beat = [message for message in messages if message.get_type() == "HEARTBEAT"][-1]
        assert (beat.system_status, beat.autopilot) == (5, 8)


def test_overlapping_cones_are_free_only_if_all_are(tmp_path):
    program = built(tmp_path / "ring", 15)
    for dead, expected in ((-1, 115), (DEAD, 65535)):
        messages = said(program, dead, heartbeat(128), free=DEAD + 1)
        distances = [message for message in messages if message.get_type() == "OBSTACLE_DISTANCE"][-1].distances
        # To the left, where the cones of 30 degrees of these two reach and no other.
        assert {distances[(-degrees % 360 + 20) // 5] for degrees in (35, 40)} == {expected}
    # One alone is free.
    messages = said(built(tmp_path / "wide", 45), free=DEAD)
    distances = [message for message in messages if message.get_type() == "OBSTACLE_DISTANCE"][-1].distances
    assert distances[(clockwise(DEAD) + 20) // 5] == 401

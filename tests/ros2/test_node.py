"""A ring whose echo lines play edges, its serial line, the node, and ROS 2 and MAVLink as others implement them.

The ring is `played_ring.rs`: the driver in Rust, in real time. Its frames go through a cable that this test holds into a
pseudo-terminal, from there the node reads them, and Cyclone DDS receives what the node publishes. All on the loopback
interface, in a domain of its own. `cargo xtask ros2` sets the variables.
"""

import csv
import io
import json
import math
import os
import signal
import struct
import subprocess
import threading
import time
import tty
from dataclasses import dataclass, field
from pathlib import Path

import pytest

os.environ["MAVLINK20"] = "1"

from dds import (
    DOMAIN,
    ERROR,
    NODE,
    OK,
    PATIENCE_S,
    WARN,
    DiagnosticArray,
    Range,
    environment,
    reader,
    taken,
    until,
)
from fast_dds import FastDds
from cyclonedds.domain import DomainParticipant
from cyclonedds.topic import Topic
from pymavlink import mavutil

PROGRAM = os.environ["EERUF_PROGRAM"]
PLAYED_RING = os.environ["EERUF_PLAYED_RING"]
SENSORS, FAULTY = 8, 2  # it counts from 0
NEVER = 2**32 - 1
# Edges of a module that hears nothing, and the lines of sensors that face a wall each.
NOTHING = "+450 -38450"
WALLS_US = [4000 + 1500 * sensor for sensor in range(SENSORS)]
WALLS = [f"{sensor} +450 -{450 + us}" for sensor, us in enumerate(WALLS_US)]


def metres(us):
    return us * 343.2e-6 / 2


@pytest.fixture(scope="module")
def participant():
    return DomainParticipant(DOMAIN)


@pytest.fixture
def processes():
    """Processes that a test starts; those that still run at its end are ended."""
    started = []
    yield started
    for process in started:
        if process.poll() is None:
            process.kill()
            process.wait()


def parameters(folder, **given):
    file = folder / "eeruf.yaml"
    file.write_text("eeruf:\n  ros__parameters:\n" + "".join(f"    {key}: {value}\n" for key, value in given.items()))
    return str(file)


class Heard:
    """The ranges of each sensor and the diagnostics that one participant hears."""

    def __init__(self, participant, sensors):
        self.readers = [reader(participant, f"/eeruf/sonar_{sensor + 1}", Range) for sensor in range(sensors)]
        self.diagnostics = reader(participant, "/diagnostics", DiagnosticArray)
        self.ranges = [[] for _ in range(sensors)]
        self.reports = []
        self.stamps = []

    def is_matched(self):
        return all(reader.get_matched_publications() for reader in [*self.readers, self.diagnostics])

    def take(self):
        for heard, reader in zip(self.ranges, self.readers):
            heard += taken(reader, Range)
        for report in taken(self.diagnostics, DiagnosticArray):
            self.stamps.append((report.header.stamp.sec, report.header.stamp.nanosec))
            self.reports.append({status.name.removeprefix("eeruf: "): status for status in report.status})

    def said(self, since):
        """All ranges, and the reports since this stamp, in a form that compares."""
        stamp = lambda message: (message.header.stamp.sec, message.header.stamp.nanosec, message.header.frame_id)
        numbers = lambda m: (m.radiation_type, m.field_of_view, m.min_range, m.max_range, m.range, m.variance)
        values = lambda status: [(value.key, value.value) for value in status.values]
        status = lambda status: (status.level, status.message, status.hardware_id, values(status))
        ranges = [[(*stamp(message), *numbers(message)) for message in heard] for heard in self.ranges]
        reports = [report for stamp, report in zip(self.stamps, self.reports) if stamp >= since]
        return ranges, [{name: status(each) for name, each in report.items()} for report in reports]


class Node:
    """The node as a process. Cyclone DDS hears it, and Fast DDS, where it is installed, must hear the same."""

    def __init__(self, participant, processes, *arguments, sensors=SENSORS):
        self.process = subprocess.Popen([NODE, *arguments], env=environment(), stderr=subprocess.PIPE, text=True)
        processes.append(self.process)
        self.heard = Heard(participant, sensors)
        self.fast_dds = FastDds(os.environ["EERUF_FAST_DDS"], DOMAIN) if "EERUF_FAST_DDS" in os.environ else None
        self.listeners = [self.heard]
        if self.fast_dds:
            processes.append(self.fast_dds.process)
            self.listeners.append(Heard(self.fast_dds, sensors))
        self.until("discovery of the node", lambda: all(each.is_matched() for each in self.listeners))
        # The node matches readers in the order in which they were made: whom a report reaches, ranges reach, too.
        self.until("a report to all", lambda: self.take() or all(each.reports for each in self.listeners))

    @property
    def ranges(self):
        return self.heard.ranges

    @property
    def reports(self):
        return self.heard.reports

    def until(self, what, holds):
        until(what, self.process, holds)

    def take(self):
        for each in self.listeners:
            each.take()

    def end(self):
        # One of the two may have joined some reports before the other, and what was sent last is still on its way.
        since = max(each.stamps[0] for each in self.listeners)
        same = lambda: all(each.said(since) == self.heard.said(since) for each in self.listeners)
        self.until("the same heard by all", lambda: self.take() or same())
        self.process.send_signal(signal.SIGINT)
        said = self.process.communicate(timeout=PATIENCE_S)[1]
        assert self.process.returncode == 0, said
        assert said.endswith("eeruf-ros2: ended\n"), said
        if self.fast_dds:
            self.fast_dds.close()
        self.take()
        ranges, reports = self.heard.said(since)
        assert reports
        for other in self.listeners[1:]:
            other_ranges, other_reports = other.said(since)
            assert other_ranges == ranges
            # A diagnosis that the node sends as it leaves may reach one of the two.
            both = min(len(reports), len(other_reports))
            assert other_reports[:both] == reports[:both] and both >= len(reports) - 1


def unpacked(frame):
    """A frame's content, as COBS has it: each zero is the distance to the next."""
    content = bytearray()
    while frame:
        length = frame[0]
        content += frame[1:length]
        frame = frame[length:]
        if frame:
            content.append(0)
    return bytes(content[:-2])


@dataclass
class Cable:
    """Carries frames from the board to a pseudo-terminal; some it swallows, in some it flips a bit."""

    swallow: frozenset = frozenset()
    flip: frozenset = frozenset()
    carried: list = field(default_factory=list)
    hit: list = field(default_factory=list)

    def carry(self, board, line):
        count, rest = 0, b""
        while more := os.read(board.fileno(), 4096):
            *frames, rest = (rest + more).split(b"\0")
            for frame in frames:
                if count in self.swallow | self.flip:
                    self.hit.append(unpacked(frame))
                    # A flipped bit that makes no zero.
                    frame = b"" if count in self.swallow else frame[:9] + bytes([frame[9] ^ 0xC0 or 0x40]) + frame[10:]
                else:
                    self.carried.append(unpacked(frame))
                if frame:
                    os.write(line, frame + b"\0")
                count += 1


def firings(contents):
    """Sensor and period of the frames that are firings."""
    fields = [struct.unpack("<BHBBBIIIHIB", content) for content in contents if content[0] == 0x21]
    return [(sensor, period) for _, _, sensor, _, _, _, period, *_ in fields]


class Board:
    """The ring at the pace of the clock on the wall, and its readings."""

    def __init__(self, processes, line, lines, periods, stall_after, cable):
        command = [PLAYED_RING, str(periods), str(stall_after), *lines]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        processes.append(self.process)
        self.thread = threading.Thread(target=cable.carry, args=(self.process.stdout, line))
        self.thread.start()

    def readings(self):
        """Readings as the ring said them beside its serial line."""
        self.thread.join()
        said = self.process.stderr.read().decode()
        assert self.process.wait(timeout=PATIENCE_S) == 0, said
        return list(csv.DictReader(io.StringIO(said)))


class Mavlink:
    def __init__(self):
        self.connection = mavutil.mavlink_connection("udpin:127.0.0.1:0", dialect="common")
        self.to = f"udp:127.0.0.1:{self.connection.port.getsockname()[1]}"
        self.messages = []

    def take(self):
        while (message := self.connection.recv_msg()) is not None:
            self.messages.append(message)


def run(tmp_path, participant, processes, lines, periods, cable=None, stall_after=NEVER):
    """A ring with these edges on its lines, for this many periods; the node, the readings, the log, and MAVLink."""
    cable, mavlink = cable or Cable(), Mavlink()
    line, terminal = os.openpty()
    tty.setraw(terminal)
    log = tmp_path / "log.csv"
    # Pictures come with failed sensors too: no autopilot arms here.
    file = parameters(tmp_path, mavlink_unanswered_as="obstacle")
    outputs = ["--log", str(log), "--mavlink", mavlink.to]
    node = Node(participant, processes, "--params-file", file, "--port", os.ttyname(terminal), *outputs)
    board = Board(processes, line, lines, periods, stall_after, cable)
    while board.process.poll() is None:
        node.take()
        mavlink.take()
        time.sleep(0.02)
    readings = board.readings()

    def silent():
        node.take()
        mavlink.take()
        last = node.reports[-1] if node.reports else {}
        silent = ["serial line", *(f"sensor {n + 1}" for n in range(SENSORS))]
        return last and all("silent" in last[name].message for name in silent)

    node.until("silence of line and sensors in the diagnostics", silent)
    node.end()
    mavlink.take()
    os.close(line)
    os.close(terminal)
    return node, readings, log, mavlink


def expected_ranges(readings, hit, clear):
    """Messages that each sensor's topic must have, without the frames that the cable hit."""
    expected = [[] for _ in range(SENSORS)]
    for row in readings:
        sensor, kind = int(row["sensor"]), row["reading"]
        if (sensor, int(row["period"])) in hit:
            continue
        if kind == "accepted":
            distance = metres(int(row["t_echo_us"]))
            expected[sensor].append(distance if distance <= 4.0 else clear)
        elif kind == "clear":
            expected[sensor].append(clear)
        elif kind == "too_early":
            expected[sensor].append(-math.inf)
    return expected


def assert_ranges(node, expected):
    for sensor, (heard, awaited) in enumerate(zip(node.ranges, expected)):
        assert [message.range for message in heard] == pytest.approx(awaited, abs=0.002), f"sensor {sensor + 1}"
        assert {message.header.frame_id for message in heard} <= {f"sonar_{sensor + 1}"}
        assert len({(message.header.stamp.sec, message.header.stamp.nanosec) for message in heard}) == len(heard)


def test_ring_and_its_faults_arrive_as_ros_2(tmp_path, participant, processes):
    cable = Cable(swallow=frozenset(range(400, 460, 10)), flip=frozenset(range(405, 450, 10)))
    lines = list(WALLS)
    # Stuck from the twentieth firing on; nothing; too close; in each phase the sound of the sensor that fires next.
    lines[FAULTY] += f" / {WALLS[FAULTY][2:]}" * 18 + " / +450"
    lines[3:6] = f"3 {NOTHING}", "4 +450 -560", "5 +450 -20450 / +450 -17450"
    node, readings, log, mavlink = run(tmp_path, participant, processes, lines, 120, cable)

    hit = set(firings(cable.hit))
    assert len(cable.hit) == 11 and len(hit) >= 8
    expected = expected_ranges(readings, hit, math.inf)
    for sensor, (ranges, us) in enumerate(zip(expected, WALLS_US)):
        right = {3: math.inf, 4: -math.inf}.get(sensor, metres(us))
        assert all(distance == pytest.approx(right, abs=0.001) for distance in ranges), sensor
        least, most = {FAULTY: (15, 18), 5: (0, 0)}.get(sensor, (110, 120))
        assert least <= len(ranges) <= most, (sensor, len(ranges))
    assert_ranges(node, expected)
    messages = sum(node.ranges, [])
    assert {(round(message.min_range, 6), message.max_range) for message in messages} == {(0.02, 4.0)}

    of = lambda name: [report[name] for report in node.reports]
    # Before the fault, and with the frames of the first second.
    assert any(all(status.level == OK for status in report.values()) for report in node.reports)
    stuck = f"sensor {FAULTY + 1}"
    assert any(status.level == ERROR and "stuck line" in status.message for status in of(stuck))
    for sensor in {f"sensor {n + 1}" for n in range(SENSORS)} - {stuck}:
        assert not any("stuck" in status.message for status in of(sensor)), sensor
    assert any(status.level == WARN and status.message.startswith("blind") for status in of("sensor 6"))
    line = of("serial line")
    assert any(status.level == WARN and status.message.startswith("dropped frames") for status in line)
    values = {value.key: value.value for value in line[-1].values}
    assert values["frames missing, in all"] == str(len(cable.hit))
    assert values["frames damaged, in all"] == str(len(cable.flip))
    assert line[-1].level == ERROR and line[-1].message.startswith("silent")

    rows = list(csv.DictReader(log.read_text().splitlines()[1:]))
    assert [(int(row["sensor"]), int(row["period"])) for row in rows] == firings(cable.carried)
    assert log.read_text().startswith("# clock: played, 32 bits\n")
    diagnosed = subprocess.run([PROGRAM, "diagnose", str(log), "--json"], capture_output=True, text=True)
    assert diagnosed.returncode in (0, 1), diagnosed.stderr
    assert json.loads(diagnosed.stdout)

    assert_mavlink(mavlink, expected)


def assert_mavlink(mavlink, expected):
    assert not any(message.get_type() == "BAD_DATA" for message in mavlink.messages)
    beats = [message for message in mavlink.messages if message.get_type() == "HEARTBEAT"]
    assert len(beats) >= 5
    assert (beats[0].type, beats[0].autopilot, beats[0].mavlink_version) == (18, 8, 3)
    assert (beats[0].get_srcSystem(), beats[0].get_srcComponent()) == (1, 196)
    numbers = [message.get_seq() for message in mavlink.messages]
    assert all((after - before) % 256 == 1 for before, after in zip(numbers, numbers[1:]))
    for sensor, awaited in enumerate(expected):
        heard = [m for m in mavlink.messages if m.get_type() == "DISTANCE_SENSOR" and m.id == sensor]
        centimetres = {math.inf: 401, -math.inf: 2}
        want = [centimetres.get(distance, 100 * distance) for distance in awaited]
        assert [message.current_distance for message in heard] == pytest.approx(want, abs=0.8)
        if not awaited:
            continue
        # Sensors sit every 45 degrees counter-clockwise; MAVLink counts clockwise.
        assert {message.orientation for message in heard} == {-sensor % 8}
        assert {(m.min_distance, m.max_distance, m.type, m.signal_quality) for m in heard} == {(2, 400, 1, 100)}
        assert heard[0].horizontal_fov == pytest.approx(0.52)


@pytest.mark.parametrize(
    ("line", "stall_after", "about", "level", "message"),
    [
        (WALLS[FAULTY], 25, "timing", WARN, "late: a firing came"),
        (str(FAULTY), NEVER, f"sensor {FAULTY + 1}", ERROR, "missing: nothing comes from its line"),
    ],
)
def test_a_late_board_and_a_missing_sensor_are_named(
    tmp_path, participant, processes, line, stall_after, about, level, message
):
    lines = WALLS[:FAULTY] + [line] + WALLS[FAULTY + 1 :]
    node, readings, _, mavlink = run(tmp_path, participant, processes, lines, 50, stall_after=stall_after)
    assert_ranges(node, expected_ranges(readings, set(), math.inf))
    assert any(r[about].level == level and r[about].message.startswith(message) for r in node.reports)
    pictures = [m for m in mavlink.messages if m.get_type() == "OBSTACLE_DISTANCE"]
    assert len(pictures) > 10
    if stall_after == NEVER:
        # The sector that the sensor looks into; what does not answer is an obstacle at the minimum.
        sector = (-45 * FAULTY % 360 + 20) % 360 // 5
        assert pictures[-1].distances[sector] == 2


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["--params-file", "missing.yaml"], "missing.yaml: No such file"),
        (["--mavlink", "tcp:localhost:1"], "mavlink: tcp:localhost:1: not by UDP; expected udp:HOST:PORT"),
        (["--log", "no/such/folder.csv"], "log: no/such/folder.csv: No such file"),
    ],
)
def test_a_bad_argument_is_named_and_ends_the_node(tmp_path: Path, arguments, error):
    ended = subprocess.run([NODE, "--no-ros", *arguments], cwd=tmp_path, capture_output=True, text=True)
    assert ended.returncode == 1
    assert ended.stderr.startswith("eeruf-ros2: ") and error in ended.stderr, ended.stderr

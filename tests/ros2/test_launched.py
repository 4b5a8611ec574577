"""A board that a test plays, and the node as a ROS 2 launch starts it: namespace, names, parameters, places.

Cyclone DDS and Fast DDS must each receive all of it, and a cut wire is free space nowhere.
"""

import math
import os
import signal
import socket
import struct
import subprocess
import time

import pytest

from board import SerialBoard
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl.types import int64, sequence, uint8, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from dds import (
    DOMAIN,
    ERROR,
    LATCHED,
    NODE,
    OK,
    PATIENCE_S,
    RELIABLE,
    DiagnosticArray,
    Log,
    Parameter,
    ParameterValue,
    PointCloud2,
    Range,
    SetParametersResult,
    TFMessage,
    environment,
    message,
    reader,
    taken,
    until,
)

SPANS = "FloatingPointRange", "IntegerRange"
UNKNOWN, OBSTACLE, CLEAR, TOO_CLOSE, UNANSWERED = range(5)
# Places of four sensors: x, y, heading in degrees.
PLACES = [(0.2, 0.1, 30.0), (0.2, -0.1, -30.0), (-0.2, -0.1, -150.0), (-0.2, 0.1, 150.0)]
RING = """sensors = 4
module = "hc-sr04"
jitter_us = 100
min_interval_us = 0
poses = [
""" + "".join(f"    {{ x_m = {x}, y_m = {y}, heading_deg = {heading} }},\n" for x, y, heading in PLACES) + "]\n"


class Launched:
    def __init__(self, listener, folder, *arguments):
        self.board = SerialBoard(len(PLACES))
        ring = folder / "ring.toml"
        ring.write_text(RING)
        # As launch_ros writes what a launch file gives a node.
        parameters = folder / "launch_params"
        parameters.write_text(f"/**:\n  ros__parameters:\n    port: {self.board.port}\n    ring: {ring}\n")
        command = [NODE, "--ros-args", "-r", "__node:=sonars", "-r", "__ns:=/robot_1", "--params-file", str(parameters)]
        self.process = subprocess.Popen([*command, *arguments], env=environment(), stderr=subprocess.PIPE, text=True)
        names = ["front_left", "sonars/sonar_2", "sonars/sonar_3", "sonars/sonar_4"]
        self.ranges = [reader(listener, f"/robot_1/{name}", Range) for name in names]
        self.cloud = reader(listener, "/robot_1/sonars/points", PointCloud2)
        self.diagnostics = reader(listener, "/diagnostics", DiagnosticArray)
        everything = [*self.ranges, self.cloud, self.diagnostics]
        found = lambda: all(each.get_matched_publications() for each in everything)
        until("discovery of the node", self.process, found)
        # A first period, until the node has opened the line and hears the board.
        heard = lambda: self.board.fire(["unanswered"] * 4) or time.sleep(0.05) or taken(self.cloud, PointCloud2)
        until("the first cloud", self.process, heard)
        time.sleep(0.3)
        taken(self.cloud, PointCloud2)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        said = self.process.communicate(timeout=PATIENCE_S)[1]
        assert self.process.returncode == 0, said
        self.board.close()


ARGUMENTS = ["-r", "~/sonar_1:=front_left", "-p", "base_frame:=robot_1/base", "-p", "height_m:=0.15"]


@pytest.fixture
def launched(listener, tmp_path):
    node = Launched(listener, tmp_path, *ARGUMENTS, "-p", "frame_ids:=[fl, fr, rr, rl]")
    yield node
    node.end()


def points(cloud):
    """The points of a cloud: x, y, z, sensor, state, age."""
    assert [(field.name, field.offset, field.datatype) for field in cloud.fields] == [
        ("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("sensor", 12, 2), ("state", 13, 2), ("age", 16, 7)
    ]  # fmt: skip
    assert (cloud.height, cloud.width, cloud.point_step, cloud.row_step) == (1, 4, 20, 80)
    assert not cloud.is_bigendian and not cloud.is_dense
    return list(struct.iter_unpack("<fffBBxxf", bytes(cloud.data)))


def test_everything_is_received_under_the_launchs_names(listener, launched):
    for n in range(30):
        launched.board.fire([1.0 + 0.01 * n, "clear", "too_early", "unanswered" if n >= 10 else 2.0])
        time.sleep(0.05)
    heard = []
    until("30 ranges", launched.process, lambda: heard.extend(taken(launched.ranges[0], Range)) or len(heard) >= 30)
    assert [message.range for message in heard] == pytest.approx([1.0 + 0.01 * n for n in range(30)], abs=0.001)
    assert {message.header.frame_id for message in heard} == {"fl"}
    # Those of the last period may still be on their way.
    time.sleep(0.3)
    rest = [[message.range for message in taken(each, Range)] for each in launched.ranges[1:]]
    assert rest[0] == [math.inf] * 30 and rest[1] == [-math.inf] * 30
    # A cut wire says nothing.
    assert rest[2] == pytest.approx([2.0] * 10, abs=0.001)

    clouds = taken(launched.cloud, PointCloud2)
    # Ten a second, for a second and a half.
    assert 10 <= len(clouds) <= 20
    assert {cloud.header.frame_id for cloud in clouds} == {"robot_1/base"}
    for cloud in clouds:
        assert [point[3] for point in points(cloud)] == [0, 1, 2, 3]
    last = points(clouds[-1])
    assert [point[4] for point in last] == [OBSTACLE, CLEAR, TOO_CLOSE, UNANSWERED]
    # The obstacle ahead of the first, on its axis; what is too close, at the minimum range.
    metres = 1.0 + 0.01 * 29
    turn = math.radians(30)
    at = (0.2 + metres * math.cos(turn), 0.1 + metres * math.sin(turn), 0.15)
    # The last cloud may be a period older than the last range.
    assert last[0][:3] == pytest.approx(at, abs=0.025)
    near = (-0.2 - 0.02 * math.cos(turn), -0.1 - 0.02 * math.sin(turn), 0.15)
    assert last[2][:3] == pytest.approx(near, abs=0.001)
    assert all(math.isnan(number) for point in (last[1], last[3]) for number in point[:3])
    assert last[0][5] < 0.5 and last[3][5] > 0.5

    reports = []
    until("a report", launched.process, lambda: reports.extend(taken(launched.diagnostics, DiagnosticArray)) or reports)
    report = {status.name: status for status in reports[-1].status}
    assert report["sonars: sensor 4"].level == ERROR and "unanswered" in report["sonars: sensor 4"].message
    said = [report[f"sonars: sensor {n}"] for n in (1, 2, 3)]
    assert [status.level for status in said] == [OK] * 3
    assert [status.message.split(",")[0] for status in said] == ["obstacle", "clear", "too close"]


def test_transforms_reach_those_who_come_late(listener, launched):
    time.sleep(0.5)
    late = reader(listener, "/tf_static", TFMessage, LATCHED)
    heard = []
    until("the transforms", launched.process, lambda: heard.extend(taken(late, TFMessage)) or heard)
    (message,) = heard
    frames = [(each.header.frame_id, each.child_frame_id) for each in message.transforms]
    assert frames == [("robot_1/base", frame) for frame in ("fl", "fr", "rr", "rl")]
    for each, (x, y, heading) in zip(message.transforms, PLACES):
        place, turn = each.transform.translation, each.transform.rotation
        assert (place.x, place.y, place.z) == pytest.approx((x, y, 0.15))
        assert (turn.x, turn.y) == (0.0, 0.0)
        assert 2 * math.degrees(math.atan2(turn.z, turn.w)) == pytest.approx(heading)


def service(node, participant, name, request, answer):
    """Calls a service of parameters, on the topics that Fast DDS's mapping of ROS 2 has for it."""
    kind = "rcl_interfaces/srv/" + "".join(word.title() for word in name.split("_"))
    asks, answers = message(f"{kind}_Request", **request), message(f"{kind}_Response", **answer)
    topic = lambda prefix, suffix, kind: Topic(participant, f"{prefix}/robot_1/sonars/{name}{suffix}", kind, qos=RELIABLE)
    ask = DataWriter(participant, topic("rq", "Request", asks), qos=RELIABLE)
    heard = DataReader(participant, topic("rr", "Reply", answers), qos=RELIABLE)
    both = lambda: ask.get_matched_subscriptions() and heard.get_matched_publications()
    until(f"discovery of {name}", node.process, both)

    def call(*fields):
        answer = []
        # Again and again, for the node may know the one who asks sooner than the one who hears.
        asked = lambda: ask.write(asks(*fields)) or time.sleep(0.2) or answer.extend(taken(heard, answers)) or answer
        until(name, node.process, asked)
        return answer[0]

    return call


def test_parameters_are_read_and_rosout_says_what_the_node_says(tmp_path):
    participant = DomainParticipant(DOMAIN)
    rosout = reader(participant, "/rosout", Log)
    node = Launched(participant, tmp_path, *ARGUMENTS)
    names, results = {"names": sequence[str]}, {"results": sequence[SetParametersResult]}
    listed = message("rcl_interfaces/ListParametersResult", **names, prefixes=sequence[str])
    lists = service(node, participant, "list_parameters", {"prefixes": sequence[str], "depth": uint64}, {"result": listed})
    assert {"sensors", "port", "use_sim_time"} <= set(lists([], 0).result.names)
    get = service(node, participant, "get_parameters", names, {"values": sequence[ParameterValue]})
    sensors, view, source, yaws, none = get(["sensors", "field_of_view_rad", "source", "yaws_deg", "senors"]).values
    assert (sensors.type, sensors.integer_value, view.type, view.double_value) == (2, 4, 3, 0.52)
    assert (source.type, source.string_value, yaws.type, yaws.doubles[3], none.type) == (4, "serial", 8, 150.0, 0)
    types = service(node, participant, "get_parameter_types", names, {"types": sequence[uint8]})
    assert list(types(["sensors", "topics", "trigger_lines"]).types) == [2, 9, 7]
    span = {kind: sequence[message(f"rcl_interfaces/{kind}", a=int64, b=int64, step=int64)] for kind in SPANS}
    about = message("rcl_interfaces/ParameterDescriptor", name=str, type=uint8, about=str, more=str, fixed=bool, dyn=bool, **span)
    describe = service(node, participant, "describe_parameters", names, {"values": sequence[about]})
    assert [(it.name, it.type) for it in describe(["port", "baud"]).values] == [("port", 4), ("baud", 2)]
    put = service(node, participant, "set_parameters", {"parameters": sequence[Parameter]}, results)
    more = ParameterValue(2, False, 5, 0.0, "", [], [], [], [], [])
    (refused,) = put([Parameter("sensors", more)]).results
    assert not refused.successful and refused.reason.startswith("sensors: read at the start; restart the node")
    node.board.close()
    said = []
    until("a word of the line", node.process, lambda: said.extend(taken(rosout, Log)) or any("again" in it.msg for it in said))
    assert {(it.name, it.level) for it in said} == {("sonars", 20)}
    node.process.send_signal(signal.SIGINT)
    assert said[-1].msg in node.process.communicate(timeout=PATIENCE_S)[1]


def port_for_acknowledgements():
    """A socket that has the port of the next participant for user traffic, not the one for discovery."""
    for number in range(20):
        discovery, user = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        try:
            discovery.bind(("0.0.0.0", 7400 + 250 * DOMAIN + 10 + 2 * number))
            user.bind(("0.0.0.0", 7400 + 250 * DOMAIN + 11 + 2 * number))
            return user
        except OSError:
            user.close()
        finally:
            discovery.close()
    raise AssertionError("no free number for a participant")


def test_port_that_another_program_has_is_passed_over(listener, tmp_path):
    with port_for_acknowledgements():
        launched = Launched(listener, tmp_path, *ARGUMENTS)
        late = reader(listener, "/tf_static", TFMessage, LATCHED)
        until("the transforms", launched.process, lambda: taken(late, TFMessage))
        launched.end()


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["-p", "senors:=4"], "senors:=4: unknown field"),
        (["-r", "a=b"], "--ros-args: a=b; expected from:=to"),
        (["-p", "ring:=missing.toml"], "ring: missing.toml: No such file"),
    ],
)
def test_wrong_ros_arguments_are_named(arguments, error):
    ended = subprocess.run([NODE, "--ros-args", *arguments], capture_output=True, text=True, timeout=PATIENCE_S)
    assert ended.returncode == 1
    assert ended.stderr.startswith("eeruf-ros2: ") and error in ended.stderr

"""A board that a test plays, the node without ROS, and what autopilots make of its MAVLink: twelve sensors all around."""

import math
import os
import signal
import subprocess
import time

import pytest

os.environ["MAVLINK20"] = "1"

from pymavlink import mavutil

from autopilots import ArduPilot, Px4
from board import SerialBoard

NODE = os.environ["EERUF_ROS2"]
SENSORS = 12
PATIENCE_S = 30


class Ring:
    """The board, the node, and the two autopilots."""

    def __init__(self, folder, **given):
        self.board = SerialBoard(SENSORS)
        self.connection = mavutil.mavlink_connection("udpin:127.0.0.1:0", dialect="common")
        to = f"udp:127.0.0.1:{self.connection.port.getsockname()[1]}"
        given = {"sensors": SENSORS, "port": self.board.port, "mavlink": to} | given
        file = folder / "eeruf.yaml"
        lines = "".join(f"    {key}: {value}\n" for key, value in given.items())
        file.write_text("eeruf:\n  ros__parameters:\n" + lines)
        command = [NODE, "--no-ros", "--params-file", str(file)]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        self.ardupilot, self.px4 = ArduPilot(), Px4()
        self.kinds, self.last, self.texts = [], {}, []
        # What the node says before it has opened the line is lost to it.
        self.until(lambda: self.fire(["clear"] * SENSORS), lambda: "OBSTACLE_DISTANCE" in self.kinds)

    def fire(self, readings):
        self.board.fire(readings)
        time.sleep(0.03)
        while (message := self.connection.recv_msg()) is not None:
            assert message.get_type() != "BAD_DATA"
            self.kinds.append(message.get_type())
            self.last[message.get_type()] = message
            if message.get_type() == "STATUSTEXT":
                self.texts.append((message.severity, message.text))
            if message.get_type() == "OBSTACLE_DISTANCE":
                self.sectors = message
            self.ardupilot.hear(message)
            self.px4.hear(message)

    def health(self):
        """The state of the component, and the health bits that it sends."""
        beat, status = self.last.get("HEARTBEAT"), self.last.get("SYS_STATUS")
        return status and (beat.system_status, status.onboard_control_sensors_health)

    def until(self, step, holds):
        end = time.monotonic() + PATIENCE_S
        while not holds():
            assert self.process.poll() is None, self.process.communicate()[1]
            assert time.monotonic() < end, f"did not happen within {PATIENCE_S} s; heard {set(self.kinds)}"
            step()

    def show(self, readings):
        """The autopilots have forgotten what was, and heard these readings, all of them, twice."""
        self.fire(readings)
        self.ardupilot.forget()
        self.px4.forget()
        self.kinds = []
        self.until(lambda: self.fire(readings), lambda: self.kinds.count("OBSTACLE_DISTANCE") >= 2)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        said = self.process.communicate(timeout=PATIENCE_S)[1]
        assert self.process.returncode == 0, said
        self.board.close()


@pytest.fixture
def ring(tmp_path):
    rings = []

    def started(**given):
        rings.append(Ring(tmp_path, **given))
        return rings[-1]

    yield started
    for started_ring in rings:
        started_ring.end()


def clockwise(sensor):
    return -30 * sensor % 360


def all_but(sensor, reading, others="clear"):
    return [reading if other == sensor else others for other in range(SENSORS)]


def test_autopilots_see_12_of_12_directions(ring):
    ring = ring()
    seen = {"ArduPilot": 0, "PX4": 0}
    for sensor in range(SENSORS):
        at = clockwise(sensor)
        ring.show(all_but(sensor, 1.25))
        angle, distance = ring.ardupilot.faces[ring.ardupilot.face(at)]
        seen["ArduPilot"] += distance == 1.25 and abs((angle - at + 180) % 360 - 180) <= 15
        # Nothing elsewhere, but for the faces that its beam of 30 degrees reaches.
        assert all(abs((45 * face - at + 180) % 360 - 180) <= 37.5 for face in ring.ardupilot.faces)
        seen["PX4"] += ring.px4.bins[at // 10] == 1.25
        others = [ring.px4.bins[clockwise(other) // 10] for other in range(SENSORS) if other != sensor]
        assert others == [math.inf] * 11
        assert (ring.sectors.frame, ring.sectors.sensor_type, ring.sectors.increment) == (12, 1, 5)
        assert (ring.sectors.min_distance, ring.sectors.max_distance) == (2, 400)
    assert seen == {"ArduPilot": 12, "PX4": 12}


def test_four_of_twelve_have_a_rotation_of_their_own(ring):
    ring = ring()
    heard = {}
    hear = ring.ardupilot.hear

    def noting(message):
        if message.get_type() == "DISTANCE_SENSOR":
            heard[message.id] = (message.orientation, message.current_distance)
        hear(message)

    ring.ardupilot.hear = noting
    # On a busy machine the first may begin amid a round, with one of a face's two sensors.
    for _ in range(2):
        ring.show([0.5 + 0.1 * sensor for sensor in range(SENSORS)])
    assert heard == {0: (0, 50), 3: (6, 80), 6: (4, 110), 9: (2, 140)}
    # Of two in a face the nearer: sensors 1 and 2 look into the one at 315 degrees.
    nearest = {0: 0.5, 7: 0.6, 6: 0.8, 5: 0.9, 4: 1.1, 3: 1.2, 2: 1.4, 1: 1.5}
    assert {face: distance for face, (_, distance) in ring.ardupilot.faces.items()} == nearest


@pytest.mark.parametrize("said", ["obstacle", "unknown"])
def test_unanswered_is_never_free(ring, said):
    ring = ring(mavlink_unanswered_as=said)
    for sensor in range(SENSORS):
        at = clockwise(sensor)
        ring.show(all_but(sensor, "unanswered"))
        assert ring.px4.bins[at // 10] == (0.02 if said == "obstacle" else None)
        face = ring.ardupilot.faces.get(ring.ardupilot.face(at))
        # ArduPilot knows nothing between an obstacle and free: docs/how-to/autopilots.md says so.
        assert (face is not None and face[1] == 0.02) == (said == "obstacle")


def test_too_close_is_an_obstacle_and_ambiguous_is_unknown(ring):
    ring = ring()
    ring.show(all_but(4, "too_early"))
    at = clockwise(4)
    assert ring.px4.bins[at // 10] == 0.02 == ring.ardupilot.faces[ring.ardupilot.face(at)][1]
    ring.fire(all_but(4, "ambiguous"))
    ring.show(all_but(4, "ambiguous"))
    assert ring.px4.bins[at // 10] is None and ring.px4.bins[clockwise(3) // 10] == math.inf


def test_silent_sensor_is_an_obstacle_unknown_says_nothing(ring):
    ring = ring(silent_after_s=0.3, mavlink_unanswered_as="obstacle")
    # The board says nothing more of the last sensor.
    begun = time.monotonic()
    ring.until(lambda: ring.fire(["clear"] * 11), lambda: time.monotonic() > begun + 0.4)
    ring.show(["clear"] * 11)
    assert ring.px4.bins[clockwise(11) // 10] == 0.02
    for _ in range(20):
        ring.fire(["unanswered"] * SENSORS)
    ring.kinds = []
    for _ in range(20):
        ring.fire(["unanswered"] * SENSORS)
    assert set(ring.kinds) <= {"HEARTBEAT", "SYS_STATUS", "STATUSTEXT"}


def test_failed_sensor_fails_the_proximity_check_until_armed(ring):
    ring = ring()
    ring.show(["clear"] * SENSORS)
    assert ring.ardupilot.is_healthy()
    silent = all_but(3, "unanswered")
    ring.until(lambda: ring.fire(silent), lambda: not ring.ardupilot.is_healthy())
    ring.until(lambda: ring.fire(silent), lambda: ring.health() == (5, 0))
    assert ring.texts == [(2, "eeruf: sensor 4 (270 deg) does not answer")]

    def armed():
        ring.connection.mav.srcSystem = 1
        ring.connection.mav.heartbeat_send(2, 3, 128, 0, 4)
        ring.fire(silent)

    ring.until(armed, ring.ardupilot.is_healthy)
    # Said once more, since it is in flight now; its sectors are unknown, and the rest is told.
    ring.show(silent)
    assert len(ring.texts) == 2
    assert ring.px4.bins[clockwise(3) // 10] is None and ring.px4.bins[clockwise(5) // 10] == math.inf
    ring.until(lambda: ring.fire(["clear"] * SENSORS), lambda: ring.health() == (4, 1 << 25))

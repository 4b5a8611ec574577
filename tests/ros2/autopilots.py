"""ArduPilot's and PX4's reading of the messages, by the rules that docs/how-to/autopilots.md states with their sources."""

import math
import time

UNKNOWN = 65535


def turned(angle):
    return angle % 360


class ArduPilot:
    """Eight faces of 45 degrees: the angle and the distance of the nearest in each, or nothing, which is free."""

    def __init__(self):
        self.faces = {}
        self.heard_s = -math.inf

    def is_healthy(self):
        """Returns true if the proximity check before arming passes."""
        return time.monotonic() - self.heard_s <= 0.5

    def face(self, angle):
        return int(turned(angle + 22.5) // 45)

    def hear(self, message):
        kind = message.get_type()
        if kind in ("DISTANCE_SENSOR", "OBSTACLE_DISTANCE"):
            self.heard_s = time.monotonic()
        if kind == "DISTANCE_SENSOR" and message.orientation <= 7:
            if message.min_distance <= message.current_distance <= message.max_distance:
                self.faces[message.orientation] = (45 * message.orientation, message.current_distance / 100)
            else:
                self.faces.pop(message.orientation, None)
        elif kind == "OBSTACLE_DISTANCE":
            self.hear_sectors(message)

    def hear_sectors(self, message):
        increment = message.increment_f or message.increment
        run, nearest = None, None
        for sector in range(min(int(360 / increment + 0.5), 72)):
            distance = message.distances[sector]
            # Neither clear nor unknown ends what a face holds; ArduPilot forgets it after a second.
            if not message.min_distance <= distance <= message.max_distance or distance == 0:
                continue
            angle = turned(sector * increment + message.angle_offset)
            if self.face(angle) != run:
                run, nearest = self.face(angle), None
            if nearest is None or distance < nearest:
                nearest = distance
                self.faces[run] = (angle, distance / 100)

    def forget(self):
        """A second without anything."""
        self.faces = {}


class Px4:
    """36 bins of 10 degrees, in metres; infinite where the maximum range is free, None where nothing is known."""

    def __init__(self):
        self.bins = [None] * 36

    def hear(self, message):
        if message.get_type() != "OBSTACLE_DISTANCE":
            return
        assert message.frame == 12, "PX4 takes body FRD, global and local NED"
        for index in range(36):
            at = math.ceil(turned(10 * index - message.angle_offset) / message.increment_f)
            distance = message.distances[at]
            if distance != UNKNOWN:
                self.bins[index] = distance / 100 if distance < message.max_distance else math.inf

    def forget(self):
        """Half a second without anything."""
        self.bins = [None] * 36

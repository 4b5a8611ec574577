"""Shows in Rerun what `eeruf study --mcap` wrote: python docs/show_in_rerun.py study.mcap [study.rrd]

Needs `pip install rerun-sdk mcap`. With a second name it writes a file instead of opening a window.
"""

import json
import struct
import sys

import rerun as rr
from mcap.reader import make_reader


def strips(message: dict) -> tuple[list, list]:
    """The lines of a SceneUpdate, and their colours."""
    lines = [line for entity in message["entities"] for line in entity["lines"]]
    colours = [[int(255 * line["color"][part]) for part in "rgba"] for line in lines]
    return [[[point["x"], point["y"]] for point in line["points"]] for line in lines], colours


rr.init("eeruf", spawn=len(sys.argv) < 3)
if len(sys.argv) > 2:
    rr.save(sys.argv[2])
with open(sys.argv[1], "rb") as file:
    for schema, channel, message in make_reader(file).iter_messages():
        rr.set_time("time", duration=(message.log_time - 946_684_800 * 10**9) * 1e-9)
        if schema.name == "foxglove.SceneUpdate":
            points, colours = strips(json.loads(message.data))
            rr.log("plan" + channel.topic, rr.LineStrips2D(points, colors=colours))
        elif schema.name == "sensor_msgs/msg/Range":  # The last two numbers are range and variance.
            (metres,) = struct.unpack_from("<f", message.data, len(message.data) - 8)
            rr.log("range" + channel.topic, rr.Scalars(metres))

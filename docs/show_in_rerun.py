"""Shows the output of `eeruf study --mcap` in Rerun: python docs/show_in_rerun.py study.mcap [study.rrd]

Needs `pip install rerun-sdk mcap-ros2-support`. With a second name it writes a file instead of opening a window.
"""

import sys

import rerun as rr
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

LINE_STRIP = 4


def strips(markers: list) -> tuple[list, list]:
    """The lines of markers, and their colours."""
    lines, colours = [], []
    for marker in markers:
        points = [[point.x, point.y] for point in marker.points]
        of = [points] if marker.type == LINE_STRIP else [points[k : k + 2] for k in range(0, len(points), 2)]
        lines += of
        colours += [[int(255 * getattr(marker.color, part)) for part in "rgba"]] * len(of)
    return lines, colours


rr.init("eeruf", spawn=len(sys.argv) < 3)
if len(sys.argv) > 2:
    rr.save(sys.argv[2])
with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        rr.set_time("time", duration=(message.log_time - 946_684_800 * 10**9) * 1e-9)
        if schema.name == "visualization_msgs/msg/MarkerArray":
            points, colours = strips(decoded.markers)
            rr.log("plan" + channel.topic, rr.LineStrips2D(points, colors=colours))
        elif schema.name == "sensor_msgs/msg/Range":
            rr.log("range" + channel.topic, rr.Scalars(decoded.range))

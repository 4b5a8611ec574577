"""Faults of echo lines of a ring, as the node publishes them: never free space without evidence.

Each sensor of the board has another fault of tests/data/line-faults.txt. The table is that of
tests/data/line-fault-outcomes.txt.
"""

import math
import os
import sys
from pathlib import Path

import pytest

sys.path.append("c/micropython")

from line_faults import cell, read, with_column
from test_node import NOTHING, SENSORS, expected_ranges, metres, participant, processes, run  # noqa: F401

FAULTS, OUTCOMES = Path("tests/data/line-faults.txt"), Path("tests/data/line-fault-outcomes.txt")
COLUMN = "ROS 2"
PERIODS = 15
# Sensors of the ring between two that fire 20 ms and 1 ms apart, by the partner in the file.
APART = {2: 1, 3: 4}
# Kinds of readings by the state that they leave.
KINDS = {
    "obstacle": {"accepted"},
    "clear": {"clear"},
    "unanswered": {"unanswered", "stuck"},
    "unknown": {"first", "no_echo", "rejected"},
}


def boards():
    """For each run of the ring the line of each sensor, and the faults with their sensor and its partner."""
    waiting = read(FAULTS.read_text())[2]
    while waiting:
        lines, placed, left = {}, [], []
        for fault in waiting:
            apart = APART.get(fault.partner, 0)
            fits = lambda sensor: not {sensor, sensor + apart} & set(lines) and sensor % 4 + apart % 4 < 4
            sensor = next(filter(fits, range(SENSORS - apart)), None)
            if sensor is None:
                left.append(fault)
                continue
            partner = sensor + apart
            # Before each trigger the driver looks at the line; no interrupt hands it the edges of a forgotten one.
            words = [word.rstrip("*") + "*" if fault.forgotten else word for word in fault.words]
            lines[partner] = f"{sensor} {NOTHING}"
            lines[sensor] = " ".join([str(partner), *words])
            placed.append((sensor, partner, fault))
        yield [lines.get(sensor, f"{sensor} {NOTHING}") for sensor in range(SENSORS)], placed
        waiting = left


def outcome(sensor, partner, fault, rows, node, pictures):
    """Numbers of right readings, of readings, and of messages that call the space free without evidence."""
    state = "unanswered" if fault.says[0] == "held" else fault.says[0]
    # A silence counts once its line has fallen, and it takes two.
    until_right = {"hold of 130 ms": 4, "hold of 200 ms": 6}.get(fault.name, 3 if fault.says[0] == "held" else 2)
    after = rows[until_right:]
    right = sum(row["reading"] in KINDS[state] for row in after)
    if state == "obstacle":
        wall = metres(int(fault.says[1]))
        assert all(abs(message.range - wall) < 0.01 for message in node.ranges[sensor]), fault.name
    # What the diagnostics and the picture of all sectors say in the end.
    values = {value.key: value.value for value in node.reports[-1][f"sensor {sensor + 1}"].values}
    assert values["state"].startswith(state), (fault.name, values)
    sector = (-45 * sensor % 360 + 20) % 360 // 5
    shown = [picture.distances[sector] for picture in pictures]
    assert (shown[-1] == 401) == (state == "clear") and (shown[-1] == 2) == (state == "unanswered"), (fault.name, shown)
    free = sum(message.range == math.inf for message in node.ranges[sensor])
    lies = 0 if state == "clear" else free + shown.count(401)
    if partner != sensor:
        lies += sum(message.range == math.inf for message in node.ranges[partner])
    return right, len(after), lies


def test_line_fault_is_published_as_free_space_nowhere(tmp_path, participant, processes):
    cells = {}
    for number, (lines, placed) in enumerate(boards()):
        folder = tmp_path / str(number)
        folder.mkdir()
        node, readings, _, mavlink = run(folder, participant, processes, lines, PERIODS)
        for heard, awaited in zip(node.ranges, expected_ranges(readings, set(), math.inf)):
            assert [message.range for message in heard] == pytest.approx(awaited, abs=0.002)
        pictures = [message for message in mavlink.messages if message.get_type() == "OBSTACLE_DISTANCE"]
        assert pictures
        for sensor, partner, fault in placed:
            rows = [row for row in readings if int(row["sensor"]) == sensor]
            right, count, lies = outcome(sensor, partner, fault, rows, node, pictures)
            cells[fault.name, fault.before] = cell(right, count, lies)
            assert (right, lies) == (count, 0) and count > PERIODS - 8, (fault.name, fault.before, right, count, lies)
    document = OUTCOMES.read_text()
    written = with_column(document, COLUMN, cells)
    if "EERUF_WRITE" in os.environ:
        OUTCOMES.write_text(written)
    else:
        assert written == document, f"{OUTCOMES} is not what the node says; EERUF_WRITE=1 writes it"

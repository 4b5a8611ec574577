"""The Debian package in a clean root, with the unit's own ExecStart, against a board that this test plays.

`cargo xtask deb --test` installs the package into a root that debootstrap made, and sets the variables.
"""

import math
import os
import shlex
import signal
import subprocess
import time
from pathlib import Path

from dds import DOMAIN, PATIENCE_S, Range, environment, reader, taken, until
from cyclonedds.domain import DomainParticipant

from board import SerialBoard

ROOT = Path(os.environ["EERUF_CLEAN_ROOT"])
UNIT = ROOT / "usr/lib/systemd/system/eeruf-ros2.service"
SENSORS = 8


def test_ranges_arrive_from_the_installed_service():
    (start,) = [line for line in UNIT.read_text().splitlines() if line.startswith("ExecStart=")]
    command = shlex.split(start.removeprefix("ExecStart="))
    board = SerialBoard(SENSORS)
    settings = ROOT / "etc/eeruf/eeruf.yaml"
    text = settings.read_text()
    assert "    port: /dev/ttyACM0\n" in text
    settings.write_text(text.replace("/dev/ttyACM0", board.port))
    participant = DomainParticipant(DOMAIN)
    readers = [reader(participant, f"/eeruf/sonar_{n + 1}", Range) for n in range(SENSORS)]
    node = subprocess.Popen(["chroot", str(ROOT), *command], env=environment(), stderr=subprocess.PIPE, text=True)
    try:
        found = lambda: all(each.get_matched_publications() for each in readers)
        until("discovery of the node", node, found)
        readings = [1.0, 2.0, "clear", "unanswered", 0.5, "clear", 3.0, "too_early"]
        heard = [[] for _ in readers]

        def all_heard():
            board.fire(readings)
            time.sleep(0.05)
            for messages, each in zip(heard, readers):
                messages += [message.range for message in taken(each, Range)]
            return all(len(messages) >= 10 for n, messages in enumerate(heard) if n != 3)

        until("ten ranges of each sensor that answers", node, all_heard)
    finally:
        node.send_signal(signal.SIGINT)
        said = node.communicate(timeout=PATIENCE_S)[1]
        board.close()
    assert node.returncode == 0 and said.endswith("eeruf-ros2: ended\n"), said
    numbers = {"clear": math.inf, "too_early": -math.inf}
    for reading, messages in zip(readings, heard):
        expected = numbers.get(reading, reading)
        if reading == "unanswered":
            assert messages == []
        else:
            assert all(said == expected or abs(said - expected) < 0.001 for said in messages), (reading, messages)
    print({reading: len(messages) for reading, messages in zip(map(str, readings), heard)})

"""A board on a pseudo-terminal that says what a test wants, byte by byte as docs/reference/serial.md has it."""

import os
import struct
import tty

READINGS = {"first": 0, "accepted": 1, "rejected": 2, "clear": 5, "too_early": 6, "ambiguous": 10, "unanswered": 11}
NO_ECHO = 0xFFFFFFFF
SOUND_M_S = 343.2


def crc_16(content):
    crc = 0xFFFF
    for byte in content:
        crc ^= byte << 8
        for _ in range(8):
            crc = crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1
    return crc & 0xFFFF


def cobs(content):
    packed = b"".join(bytes([len(part) + 1]) + part for part in content.split(b"\0"))
    return packed + b"\0"


class SerialBoard:
    """Each sensor's reading is a kind, or a distance in metres, which is accepted."""

    def __init__(self, sensors):
        self.sensors = sensors
        self.line, self.terminal = os.openpty()
        tty.setraw(self.terminal)
        self.port = os.ttyname(self.terminal)
        self.number = self.period = 0

    def close(self):
        os.close(self.line)
        os.close(self.terminal)

    def send(self, kind, fields):
        content = bytes([0x20 | kind]) + struct.pack("<H", self.number % 0x10000) + fields
        self.number += 1
        os.write(self.line, cobs(content + struct.pack("<H", crc_16(content))))

    def fire(self, readings):
        """One period: all sensors fire, and the period ends."""
        if self.period % 16 == 0:
            self.send(0, bytes([self.sensors]) + b"test")
        for sensor, reading in enumerate(readings):
            echo = NO_ECHO
            if not isinstance(reading, str):
                reading, echo = "accepted", round(2e6 * reading / SOUND_M_S)
            fired = (100_000 * self.period + 1_000 * sensor) % 2**32
            kind = READINGS[reading]
            firing = struct.pack("<BBBIIIHIB", sensor, self.period % 2, kind, fired, self.period, echo, 0, 40_000, 0xFF)
            self.send(1, firing)
        self.send(2, struct.pack("<IHB", self.period, 0, 0) + bytes(self.sensors))
        self.period += 1

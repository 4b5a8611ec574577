"""Tests of settings. The corpus tests rings, the line faults test modules."""

import sys

from eeruf import Flow

WINDOW_US = 25000


def settings():
    """Check that invalid settings are refused by name, and that the chip's number is the seed."""
    for wrong, said in (
        ({"sensors": 65, "seed": 1}, "sensors = 65: 1 to 64 expected"),
        ({"sensors": 6, "seed": 0}, "seed = 0: 1 to 4294967295 expected"),
        ({"sensors": 6, "seed": 1, "least_us": 40000}, "least_us = 40000: 100 to 30554 expected"),
        ({"sensors": 6, "seed": 1, "t_delta_us": 25000}, "t_delta_us = 25000: 0 to 10000 expected"),
        ({"sensors": 6, "seed": 1, "rest_us": 60}, "rest_us = 60: 1000 to 4000000 expected, likely given in milliseconds"),
        ({"sensors": 6, "seed": 1, "top_speed_mm_s": 2}, "top_speed_mm_s = 2: 10 to 65535 expected, likely given in m/s"),
    ):
        try:
            found = Flow(window_us=WINDOW_US, **wrong)
        except ValueError as error:
            found = str(error)
        if found != said:
            raise AssertionError("%r: %r" % (wrong, found))

    seeds = []
    for number in (b"\xe6\x61\x01", b"\xe6\x61\x02"):
        sys.modules["machine"] = type("Chip", (), {"unique_id": staticmethod(lambda: number)})
        seeds.append(Flow(8, WINDOW_US).seed)
    del sys.modules["machine"]
    if seeds[0] == seeds[1] or min(seeds) < 1 << 20:
        raise AssertionError("seeds: %r" % seeds)


if __name__ == "__main__":
    settings()

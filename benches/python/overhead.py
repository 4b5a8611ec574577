#!/usr/bin/env python3
"""Times the Python package against the same calls in Rust, in one run, and prints a table.

    cargo xtask python                          # makes target/python, with the wheel in it
    cargo build --profile wheel -p eeruf-lab    # the same calls in Rust, built as the wheel is
    target/python/bin/python benches/python/overhead.py

The time of a call is the best of many runs; Python's share is the difference. Then come the extra time of a process that
imports eeruf compared with `pass`, the steps and resets of a batch on one core, and the time until Ctrl-C ends long work.
Nothing else should run meanwhile.
"""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Callable

import eeruf
import numpy as np
from eeruf import experiments, sim

ROOT = Path(__file__).resolve().parents[2]
NEEDS: dict[str, Any] = {"t_delta_us": 999, "min_interval_us": 15_000, "window_us": 36_000}
# Calls for Ctrl-C to interrupt; each tells when it is under way, and would take minutes.
LONG = {
    "design": """
import random
chance = random.Random(3)
pairs = [(x, y) for x in range(64) for y in range(x) if chance.random() < 0.3]
eeruf.design(64, 499, 9_000, 36_000, layout=pairs, budget=2**60, progress=tell)
""",
    "simulate": """
robots = [eeruf.sim.Robot((x, 0, 1.57), 12, 0.26, 0.3) for x in range(4)]
walls = [[8, 3, -4, 3], [-4, 3, -4, -3], [-4, -3, 8, -3], [8, -3, 8, 3]]
eeruf.sim.simulate(eeruf.sim.Scene(walls, robots=robots), periods=1_000_000, progress=tell)
""",
    "set_one": "eeruf.experiments.set_one(100_000, progress=tell)",
    "set_two": "eeruf.experiments.set_two(100_000, second_robot='ahead', progress=tell)",
}


def best(call: Callable[[], Any], clock: Callable[[], float] = time.perf_counter) -> float:
    """Return the shortest time of many calls over half a second, in seconds."""
    shortest, begin = float("inf"), clock()
    while clock() - begin < 0.5:
        start = clock()
        call()
        shortest = min(shortest, clock() - start)
    return shortest


def calls() -> dict[str, Callable[[], Any]]:
    """Return the cases of `rust_side.rs`, to the number."""
    wall = sim.Scene([[5, 2, -5, 2]], physics="plain")
    walls = [[0.85, 0, 0.85, 1.39], [0.85, 1.39, -0.85, 1.39], [-0.85, 1.39, -0.85, 0]]
    alcove = sim.Scene(walls, physics="plain")
    eight = np.array([[0.05 * k, 0.3] for k in range(8)])
    echoes = (9_000.0 + np.arange(1_000_000) * 7 % 600).reshape(-1, 8)
    return {
        "design, 2 sensors": lambda: eeruf.design(2, **NEEDS),
        "design, 4 sensors": lambda: eeruf.design(4, **NEEDS),
        "paths, wall": lambda: wall.paths((0.0, 0.2), eight[:1], 1),
        "paths, alcove": lambda: alcove.paths((0.0, 0.2), eight, 3),
        "push_many, 1,000,000": lambda: eeruf.EchoFilter(8, 500).push_many(echoes),
    }


def step(**own: Any) -> float:
    """Return the time of one step that yields a reading, on average over 10,000, in seconds."""
    robot = sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)
    scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])

    def many() -> None:
        to_reading = sim.Simulation(scene, "eeruf", **own).step_to_reading
        for _ in range(10_000):
            to_reading(1.0)

    return best(many) / 10_000


def batch(order: int) -> tuple[float, float]:
    """Return the steps of 60 ms and the resets of a batch in a second of processor time, among eight poles."""
    scenes = [scene.replace(poles=scene.poles[:8], max_order=order) for scene in experiments.courses(0, 16)]
    many = sim.Batch(scenes, threads=1)

    def steps() -> None:
        many.reset()
        for _ in range(20):
            many.step(0.06, v_m_s=0.3, w_rad_s=0.1)

    reset_s = best(many.reset, time.process_time)
    return 20 * len(scenes) / (best(steps, time.process_time) - reset_s), len(scenes) / reset_s


def beyond_pass_ms(what: str) -> float:
    """Return the extra time of a fresh interpreter that imports something, compared with one that does nothing, in milliseconds.

    Wall-clock time, from start to end of the process: the median of 25 differences, one run of each kind in turn.
    """

    def process_s(program: str) -> float:
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", program], check=True)
        return time.perf_counter() - start

    return 1e3 * float(np.median([process_s(what) - process_s("pass") for _ in range(25)]))


def interrupted_ms(work: str) -> float:
    """Return how long work goes on after Ctrl-C, in milliseconds: the worst of 10, to where the exception is caught."""
    program = f"""
import eeruf, sys, time
def tell(share, text):
    print("under way", flush=True)
try:
{chr(10).join("    " + line for line in work.strip().splitlines())}
except KeyboardInterrupt:
    print("ended", time.monotonic(), flush=True)
"""
    worst = 0.0
    for round in range(10):
        child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
        assert child.stdout is not None
        child.stdout.readline()
        time.sleep(0.3 + 0.007 * round)
        began = time.monotonic()
        child.send_signal(signal.SIGINT)
        out, _ = child.communicate(timeout=60)
        ended = float(out.split("ended")[1])
        worst = max(worst, 1e3 * (ended - began))
    return worst


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rust", default=ROOT / "target/wheel/eeruf-lab", help="the built lab")
    options = parser.parse_args()
    times_of_rust = subprocess.run([options.rust, "rust-side", "times"], check=True, capture_output=True, text=True)
    rust = json.loads(times_of_rust.stdout)
    print("| call | Rust | Python | ratio | Python adds |\n|---|---|---|---|---|")
    times = {name: best(call) for name, call in calls().items()}
    times |= {"step, one reading": step(), "step, own filter": step(filter=lambda firing: firing.reading)}
    for name, here in times.items():
        there = rust[name]
        added, ratio = 1e6 * (here - there), here / there
        print(f"| {name} | {1e6 * there:.1f} us | {1e6 * here:.1f} us | {ratio:.2f} | {added:.1f} us |")
    print("\n| a batch of 16, order | steps of 60 ms a second of a processor | resets |\n|---|---|---|")
    for order in (2, 6):
        steps_per_s, resets_per_s = batch(order)
        print(f"| {order} | {steps_per_s:.0f} | {resets_per_s:.0f} |")
    names = ("eeruf", "numpy", "numpy, eeruf")
    alone_ms, numpy_ms, both_ms = (beyond_pass_ms(f"import {name}") for name in names)
    print(
        f"\nA process that imports eeruf runs {alone_ms:.0f} ms longer than `pass`; numpy {numpy_ms:.0f}, both {both_ms:.0f} ms"
    )
    print("\n| Ctrl-C in the middle of | ends within |\n|---|---|")
    for name, work in LONG.items():
        print(f"| {name} | {interrupted_ms(work):.0f} ms |")


if __name__ == "__main__":
    main()

"""Ctrl-C ends what takes long, wherever it is, with KeyboardInterrupt."""

import os
import signal
import subprocess
import sys
import time

import eeruf
import pytest

# Each would take hours, and reports that it runs from within, or just before if it has no progress to report.
LONG = {
    "design": "eeruf.design(64, 499, 9_000, 36_000, layout=pairs, budget=2**60, progress=tell)",
    "simulate": "eeruf.sim.simulate(scene, periods=3_000_000, progress=tell)",
    "simulate_blocks": "[None for _ in eeruf.sim.simulate_blocks(scene, periods=2**32 - 1, progress=tell)]",
    "step": "tell(); world.step(1e9)",
    "paths": "poles.paths((-1.9, -1.9), [(1.9, 0.01 * y) for y in range(100)], 8, progress=tell)",
    "set_one": "eeruf.experiments.set_one(100_000, progress=tell)",
    "set_two": "eeruf.experiments.set_two(100_000, progress=tell)",
    "set_three": "eeruf.experiments.set_three(100_000, progress=tell)",
    "speed_sweep": "eeruf.experiments.speed_sweep(seeds=100_000, progress=tell)",
    "count": "tell(); waits.count()",
    "all": "tell(); [None for table in waits.all()]",
    "log": "tell(); eeruf.read_log(Endless())",
    "blocks": "tell(); [None for _ in eeruf.logs.blocks(Endless(), judge=eeruf.logs.Agree(500))]",
    "check": "tell(); eeruf.check(Endless())",
    "diagnose": "log = firings(200_000); tell(); eeruf.logs.diagnose(log)",
    "survey": "log = firings(1_000_000); tell(); eeruf.logs.survey(log)",
    "push_many": "many = numpy.full((30_000_000, 1), 9_000.0); tell(); eeruf.EchoFilter(1, 500).push_many(many)",
}
BEFORE = """
import eeruf, functools, numpy, random, time
class Endless:
    def read(self, size):
        return b"left: 40 cm" + bytes([10])
def tell(*_):
    print("under way", flush=True)
def firings(n):
    k, of = numpy.arange(n), numpy.random.default_rng(1).uniform(2_000, 20_000, n)
    at = {"fired_us": 10_000 * k + of.astype(int) // 4, "t_echo_us": of}
    return eeruf.logs.Firings.of(sensor=k % 8, period=k // 8, phase=k // 8 % 2, **at)
chance = random.Random(3)
pairs = [(x, y) for x in range(64) for y in range(x) if chance.random() < 0.3]
scene = eeruf.sim.Scene([[5, 2, -5, 2]], robots=[eeruf.sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)])
room = [[-2, -2, 2, -2], [2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2]]
poles = eeruf.sim.Scene(room, poles=[[k % 50 * 0.07 - 1.7, k // 50 * 0.07 - 1.7, 0.004] for k in range(2500)])
world = eeruf.sim.Simulation(scene)
waits = eeruf.WaitSearch(24, 200_000, 49_000, 1000, t_delta_us=999, min_interval_us=15_000, criterion="exact")
"""


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_long_work(name: str) -> None:
    program = f"{BEFORE}\n{LONG[name]}\nprint('completed')"
    # A session of its own, since a terminal sends Ctrl-C to all its processes.
    child = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "under way\n"
    if name in ("count", "all", "step", "log", "blocks", "check"):
        time.sleep(0.5)
    os.killpg(child.pid, signal.SIGINT)
    try:
        out, err = child.communicate(timeout=100)
    finally:
        # Nothing is left behind, whatever went wrong.
        if child.poll() is None:
            os.killpg(child.pid, signal.SIGKILL)
    assert "completed" not in out
    assert "KeyboardInterrupt" in err.splitlines()[-1], err
    assert child.returncode != 0


class Interrupted:
    def __array__(self, dtype: object = None, copy: object = None) -> object:
        raise KeyboardInterrupt


def test_ctrl_c_while_an_argument_is_converted_is_no_wrong_argument() -> None:
    with pytest.raises(KeyboardInterrupt):
        eeruf.EchoFilter(1, 500).push_many(Interrupted())  # type: ignore[arg-type]

"""Processes, threads and memory: nothing waits for ever, runs on, or ends the interpreter."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import sim

ROBOT = sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)
ROOM = sim.Scene([[5, 2, -5, 2]], robots=[ROBOT])


def run(program: str, tmp_path: Path, *, seconds: float = 60) -> subprocess.CompletedProcess[str]:
    """Run a program as a script: a file of its own."""
    script = tmp_path / "script.py"
    script.write_text(program)
    return subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=seconds)


def test_a_forked_child_runs_the_experiments_that_its_parent_ran(tmp_path: Path) -> None:
    done = run(
        """
import os, eeruf
def both():
    eeruf.experiments.set_one(1, readings=8, methods=["eeruf"])
    eeruf.experiments.set_two(1, methods=["eeruf"])
both()
child = os.fork()
both()
if child:
    print("child", os.waitpid(child, 0)[1])
""",
        tmp_path,
    )
    assert done.stdout == "child 0\n", done.stderr


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_a_pool_of_any_kind_finishes_after_experiments(method: str, tmp_path: Path) -> None:
    done = run(
        f"""
import functools, multiprocessing, eeruf
from concurrent.futures import ProcessPoolExecutor
if __name__ == "__main__":
    run = functools.partial(eeruf.experiments.set_one, readings=8, methods=["eeruf"])
    here = [run(1), run(2)]
    context = multiprocessing.get_context({method!r})
    with ProcessPoolExecutor(2, mp_context=context) as processes:
        print(list(processes.map(run, [1, 2])) == here)
""",
        tmp_path,
    )
    assert done.stdout == "True\n", done.stderr


def test_nothing_that_was_ended_runs_on() -> None:
    before = threads_of_the_process()

    def enough(share: float | None, text: str) -> None:
        raise KeyboardInterrupt

    long: list[Callable[[], Any]] = [
        lambda: sim.simulate(ROOM, periods=1_000_000, progress=enough),
        lambda: eeruf.experiments.set_one(10_000, progress=enough),
        lambda: eeruf.design(40, 999, 9_000, 36_000, budget=10**9, progress=enough),
    ]
    for call in long:
        with pytest.raises(KeyboardInterrupt):
            call()
    assert ends_with_threads(before)


@pytest.fixture
def interrupt_soon() -> Iterator[Callable[[], object]]:
    """Make a call that sends Ctrl-C half a second later."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    yield partial(signal.setitimer, signal.ITIMER_REAL, 0.5)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("ask", [eeruf.logs.diagnose, eeruf.logs.survey])
def test_a_question_about_a_log_that_was_ended_runs_on_nowhere(ask: Any, interrupt_soon: Callable[[], object]) -> None:
    # Some seconds of work.
    sensors, periods, chance = 64, 20_000, np.random.default_rng(1)
    sensor, period = np.tile(np.arange(sensors), periods), np.repeat(np.arange(periods), sensors)
    log = eeruf.logs.Firings.of(
        sensor=sensor,
        fired_us=period * 200_000 + sensor * 3_000 + chance.integers(0, 2_000, sensors * periods),
        period=period,
        phase=period % 2,
        t_echo_us=chance.integers(3_000, 30_000, sensors * periods).astype(float),
    )
    before = threads_of_the_process()
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        ask(log)
    assert ends_with_threads(before)


def test_a_filter_that_was_ended_halfway_has_taken_in_nothing(interrupt_soon: Callable[[], object]) -> None:
    echoes = eeruf.EchoFilter(1, 500, 8, echoes=8)
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        # Far more than half a second.
        echoes.push_many(np.full((40_000_000, 1), 9_000.0))
    assert echoes.push(0, 9_000).kind == "first"


def threads_of_the_process() -> int:
    return len(os.listdir("/proc/self/task"))


def ends_with_threads(most: int) -> bool:
    """Wait for threads that have ended, which the system takes down a little later."""
    for _ in range(60):
        if threads_of_the_process() <= most:
            return True
        time.sleep(0.05)
    return False


def test_a_simulation_too_large_for_memory_is_a_memory_error(tmp_path: Path) -> None:
    done = run(
        """
import resource, eeruf
from eeruf import sim
scene = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)])
few = sim.simulate(scene, periods=10)
few.summary(), few.columns()
resource.setrlimit(resource.RLIMIT_AS, (3_000_000_000, 3_000_000_000))
for call in (
    lambda: sim.simulate(scene, periods=10**8),
    lambda: sim.simulate(scene, periods=2**32 - 1),
    lambda: sim.simulate_blocks(scene, periods=2**32 - 1, block_periods=2**32 - 1),
):
    try:
        call()
    except MemoryError as error:
        print(error)
print(sum(len(block) for block in sim.simulate_blocks(scene, periods=1000, block_periods=100)))
""",
        tmp_path,
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 4, lines
    assert all("readings take" in line and "MB; expected" in line for line in lines[:3])
    assert lines[3] == "8000"


def test_blocks_are_the_simulation_in_level_memory() -> None:
    whole = sim.simulate(ROOM, "conventional", periods=30, seed=4).columns()
    blocks = [
        block.columns() for block in sim.simulate_blocks(ROOM, "conventional", periods=30, seed=4, block_periods=7)
    ]
    assert len(blocks) == 5
    for name, column in whole.items():
        if name != "path":
            assert b"".join(block[name].tobytes() for block in blocks) == column.tobytes()

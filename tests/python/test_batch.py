"""Many simulations at once, and the environments that are made of them."""

from __future__ import annotations

import math
from typing import Any

import eeruf
import eeruf.envs
import gymnasium
import numpy as np
import pytest
from eeruf import sim
from gymnasium.utils.env_checker import check_env

ROBOT = sim.Robot((0, 0, math.pi / 2), sensors=8, spacing_rad=0.26, radius_m=0.3)
WALLS = [sim.Scene([[5, y, -5, y]], robots=[ROBOT], seed=k) for k, y in enumerate((1.5, 2.0, 2.5))]


@pytest.mark.parametrize("threads", [1, 2, None])
def test_batch_steps_as_simulations_do_bit_for_bit(threads: int | None) -> None:
    batch = sim.Batch(WALLS, "flow", threads=threads)
    alone = [sim.Simulation(scene, "flow") for scene in WALLS]
    speeds = [0.0, 0.1, 0.2]
    known = np.full((3, 8), np.nan)
    for turn in (0.3, -0.3, 0.0, 0.1):
        state = batch.step(0.25, speeds, turn)
        for k, world in enumerate(alone):
            world.set_velocity(0, speeds[k], turn)
            readings = world.step(0.25)
            for sensor, echo in zip(readings.sensor[readings.is_accepted], readings.t_echo_us[readings.is_accepted]):
                known[k, sensor] = echo
            assert state.readings[k].sum() == len(readings)
            assert state.accepted[k].sum() == readings.is_accepted.sum()
            assert tuple(state.pose[k]) == world.robots[0].pose
        np.testing.assert_array_equal(state.t_echo_us, known)
    assert np.isfinite(known).any(axis=1).all()
    assert (state.age_s[np.isfinite(known)] < 1.0).all()


def test_world_in_which_a_sensor_crashes_stops_until_its_reset() -> None:
    pillar = sim.Scene([[5, 9, -5, 9]], poles=[(0, 1.5, 0.2)], robots=[ROBOT])
    batch = sim.Batch([pillar, WALLS[2]])
    for _ in range(30):
        state = batch.step(0.06, [1.0, 0.0], 0.0)
    assert state.touches.tolist() == [True, False]
    stopped, far = state.time_s[0], state.pose[0, 1]
    assert (stopped < 30 * 0.06, 0.94 < far < 1.31) == (True, True)
    assert batch.step(0.06, 0.0, 0.0).time_s[0] == stopped
    begun = batch.reset([0], poses=[[0, 0.2, math.pi / 2]])
    assert begun.pose[0].tolist() == [0, 0.2, math.pi / 2]
    assert (begun.time_s[0], begun.touches[0]) == (0.0, False)
    assert np.isinf(begun.age_s[0]).all()


def test_reset_by_mask_and_by_number_with_other_scenes_and_seeds() -> None:
    batch = sim.Batch(WALLS, seeds=[1, 1, 1])
    first = batch.step(0.5).t_echo_us
    batch.reset([False, True, True], seeds=[1, 2])
    again = batch.step(0.5)
    assert again.time_s.tolist() == pytest.approx([1.0, 0.5, 0.5])
    np.testing.assert_array_equal(again.t_echo_us[1], first[1])
    assert (again.t_echo_us[2] != first[2]).any()
    batch.reset([2], scenes=[WALLS[1]], seeds=[1])
    np.testing.assert_array_equal(batch.step(0.5).t_echo_us[2], first[1])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sim.Batch([]), r"scenes = \[\]; expected one eeruf.sim.Scene or more"),
        (lambda: sim.Batch(WALLS, seeds=[1]), r"len\(seeds\) = 1; expected 3"),
        (lambda: sim.Batch(WALLS, threads=0), "threads = 0; expected a whole number from 1 to 1024"),
        (lambda: sim.Batch(WALLS).step(0.1, 1.0), "w_rad_s = None; expected a rate of turn beside v_m_s"),
        (
            lambda: sim.Batch(WALLS).step(0.1, [1, 2], 0),
            r"v_m_s = \[1, 2\]; expected a number, or one for each of the 3",
        ),
        (lambda: sim.Batch(WALLS).step(0.1, math.nan, 0), "v_m_s = nan; expected a number"),
        (lambda: sim.Batch(WALLS).reset([3]), r"worlds = \[3\]; expected a mask of 3 truth values, or numbers"),
        (lambda: sim.Batch(WALLS).reset([0, 0]), "numbers of worlds, each once"),
        (lambda: sim.Batch(WALLS).reset([True]), "a mask of 3 truth values"),
        (lambda: sim.Batch(WALLS).reset([1], scenes=WALLS), r"len\(scenes\) = 3; expected 1"),
        (lambda: sim.Batch(WALLS).reset([1], poses=[[math.nan, 0, 0]]), r"poses\[0\] = "),
        (
            lambda: sim.Batch([WALLS[0], sim.Scene([[5, 2, -5, 2]], robots=[ROBOT.replace(sensors=6)])]),
            r"sensors of the first robot of scenes\[1\] = 6; expected 8",
        ),
    ],
)
def test_wrong_arguments_of_a_batch_are_named(call: Any, message: str) -> None:
    with pytest.raises(eeruf.EerufError, match=message):
        call()


def test_batch_takes_no_callables_that_hold_the_lock() -> None:
    own = sim.Method("eeruf", label="mine", make_filter=lambda _: lambda _: ("clear", None))
    with pytest.raises(eeruf.EerufError, match="expected one without callables"):
        sim.Batch(WALLS, own)


def test_memory_stays_flat_over_resets() -> None:
    # Windows has none.
    resource = pytest.importorskip("resource")
    batch = sim.Batch(WALLS)
    for _ in range(50):
        batch.reset()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(500):
        batch.reset()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 8_000


def test_environment_passes_the_checker_of_gymnasium() -> None:
    check_env(gymnasium.make("eeruf/Course-v0", numbers=range(5)).unwrapped, skip_render_check=True)
    # As the module's text says.
    poses = eeruf.experiments.courses(0, 1)[0].robots[0].sensor_poses
    assert [round(math.degrees(of[2]), 1) for of in poses[:4]] == [-52.5, -37.5, -22.5, -7.5]


def test_vector_environment_repeats_and_begins_anew() -> None:
    def drive() -> tuple[list[np.ndarray], int]:
        many = gymnasium.make_vec(
            "eeruf/Course-v0", num_envs=4, vectorization_mode="vector_entry_point", numbers=range(3)
        )
        seen, ends = [many.reset(seed=5)[0]], 0
        for _ in range(150):
            observed, reward, terminated, truncated, info = many.step(np.array([[1.0, 0.02]] * 4, np.float32))
            over = terminated | truncated
            assert many.observation_space.contains(observed)
            assert ((reward[terminated] < -8) | (reward[terminated] > 9)).all()
            if over.any():
                ends += int(over.sum())
                assert all((final is not None) == ended for final, ended in zip(info["final_obs"], over))
                # The next course begins at the start, with nothing known.
                assert observed[over, 16] == pytest.approx(7.2, abs=1e-3)
                assert (observed[over, 8:16] == 10.0).all()
            seen.append(observed)
        return seen, ends

    (first, ends), (second, _) = drive(), drive()
    assert ends >= 4
    assert all((one == other).all() for one, other in zip(first, second))


def test_single_environment_is_the_vector_environment_of_one() -> None:
    env = gymnasium.make("eeruf/Course-v0", method="eeruf", numbers=range(20_000, 20_000 + 4))
    observed, _ = env.reset(seed=2)
    total = 0.0
    for _ in range(700):
        observed, reward, terminated, truncated, info = env.step(np.zeros(2, np.float32))
        total += float(reward)
        assert 0.0 <= info["wrong"] <= 1.0
        if terminated or truncated:
            break
    assert (bool(terminated), bool(truncated), total) == (False, True, 0.0)
    # It has stood and listened: most of its sensors know something young.
    assert (observed[8:16] < 1.0).sum() >= 4

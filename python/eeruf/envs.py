"""The courses of Set II as environments of Gymnasium: learn to drive by the readings that a ring accepts.

Needs Gymnasium 1.1 or later (``pip install eeruf[gymnasium]``). Importing this module registers ``eeruf/Course-v0``. The robot
starts at the near end of a lab with poles, heads for the line 7.2 m ahead, and is to reach it within 40 s.

An observation has, for a ring of K sensors, K ranges in metres (those of the latest accepted readings; 10 m where nothing
was in range or nothing is known), K ages of these in seconds (at most 10 s), the distance to the finishing line in metres,
the place across in metres from the lab's middle, positive to the left, and the heading in radians, counter-clockwise from straight
ahead. Sensors count from the right: the eight look 52.5, 37.5, 22.5 and 7.5 degrees to the right, then to the left. An action is a speed from 0 to 1 m/s and a rate of turn
from -1 to 1, of 1.5 rad/s. The reward is the way gained towards the line in metres, 10 for reaching it, and -10 for a contact.
``info["wrong"]`` is the share of sensors whose latest accepted reading is wrong, which only a simulator knows.

Courses below 2,000 are for learning; report on those from 20,000 on.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from eeruf import _eeruf
from eeruf.experiments import courses

if TYPE_CHECKING:
    from eeruf._eeruf import _Method as Method, _Physics

__all__ = ["CourseEnv", "CourseVectorEnv"]

# The range of a sensor that sees nothing, and the greatest age in an observation.
_FARTHEST_M, _OLDEST_S = 10.0, 10.0
# The rate of turn of the action 1, and the time that a step takes.
_TURN_RAD_S, _STEP_S = 1.5, 0.06
_FINISH_X_M, _MIDDLE_Y_M, _MOST_S = 8.2, 3.0, 40.0
_START_X_M = 1.0
_SPEED_OF_SOUND_M_S = 343.2


def _spaces(sensors: int) -> tuple[gymnasium.spaces.Box, gymnasium.spaces.Box]:
    low = [0.0] * (2 * sensors) + [-_FARTHEST_M, -_FARTHEST_M, -np.pi]
    high = [_FARTHEST_M] * sensors + [_OLDEST_S] * sensors + [_FARTHEST_M, _FARTHEST_M, np.pi]
    observed = gymnasium.spaces.Box(np.array(low, np.float32), np.array(high, np.float32))
    return observed, gymnasium.spaces.Box(np.array([0.0, -1.0], np.float32), np.array([1.0, 1.0], np.float32))


def _observed(state: _eeruf.BatchState) -> NDArray[np.float32]:
    range_m = np.nan_to_num(state.t_echo_us * 1e-6 * _SPEED_OF_SOUND_M_S / 2, nan=_FARTHEST_M)
    x, y, heading = state.pose.T
    place = np.stack([_FINISH_X_M - x, y - _MIDDLE_Y_M, (heading + np.pi) % (2 * np.pi) - np.pi], axis=1)
    observed = np.concatenate([range_m.clip(0, _FARTHEST_M), state.age_s.clip(0, _OLDEST_S), place], axis=1)
    return observed.astype(np.float32)


class CourseVectorEnv(VectorEnv[NDArray[np.float32], NDArray[np.float32], NDArray[Any]]):
    """Many courses at once, stepped on all cores. A finished course is replaced by another one in the same step.

    Args:
        num_envs: how many courses to drive at once, 1 or more.
        method: as for ``eeruf.sim.Batch``.
        numbers: the courses to draw from.
        step_s: the time that a step takes, in seconds.
        physics: as for ``eeruf.sim.Scene``.
        threads: as for ``eeruf.sim.Batch``.

    Example:
        >>> import gymnasium
        >>> import eeruf.envs
        >>> many = gymnasium.make_vec("eeruf/Course-v0", num_envs=4, vectorization_mode="vector_entry_point")
        >>> observed, _ = many.reset(seed=1)
        >>> observed.shape
        (4, 19)

    """

    metadata = {"autoreset_mode": AutoresetMode.SAME_STEP}  # noqa: RUF012 - as Gymnasium requires

    def __init__(
        self,
        num_envs: int = 1,
        *,
        method: Method = "eeruf",
        numbers: range = range(2_000),
        step_s: float = _STEP_S,
        physics: _Physics = "default",
        threads: int | None = None,
    ) -> None:
        """Make the worlds; ``reset`` draws their courses."""
        super().__init__()
        if not len(numbers):
            raise _eeruf.EerufError(f"numbers = {numbers!r}; expected a range of at least one course")
        self._courses = courses(numbers[0], 0, physics=physics)
        self._courses.numbers = numbers
        self._batch = _eeruf.Batch([self._courses[0]] * num_envs, method, threads=threads)
        self._step_s = step_s
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = _spaces(self._batch.sensors)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._x_m = np.full(num_envs, _START_X_M)

    def _begin(self, worlds: NDArray[np.bool_]) -> _eeruf.BatchState:
        """Start over in these worlds, in newly drawn courses."""
        drawn = self.np_random.integers(len(self._courses), size=int(worlds.sum()))
        seeds = self.np_random.integers(2**63, size=len(drawn)).tolist()
        self._x_m[worlds] = _START_X_M
        return self._batch.reset(worlds, seeds=seeds, scenes=[self._courses[int(number)] for number in drawn])

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Start over in all worlds."""
        super().reset(seed=seed, options=options)
        state = self._begin(np.ones(self.num_envs, bool))
        return _observed(state), self._info(state)

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Drive on for one step in all worlds."""
        speed, turn = np.clip(np.asarray(actions, float), [0.0, -1.0], [1.0, 1.0]).T
        state = self._batch.step(self._step_s, speed, turn * _TURN_RAD_S)
        x_m = state.pose[:, 0]
        finished = x_m >= _FINISH_X_M
        contact = state.touches & ~finished
        reward = x_m - self._x_m + 10.0 * finished - 10.0 * contact
        self._x_m = x_m.copy()
        terminated = finished | contact
        truncated = (state.time_s >= _MOST_S - 1e-9) & ~terminated
        observed, info = _observed(state), self._info(state)
        over = terminated | truncated
        if over.any():
            final = np.empty(self.num_envs, object)
            for world in np.flatnonzero(over):
                final[world] = observed[world]
            info.update(final_obs=final, _final_obs=over, final_info=dict(info), _final_info=over)
            begun = self._begin(over)
            observed = _observed(begun)
            info.update(self._info(begun))
        return observed, reward, terminated, truncated, info

    def _info(self, state: _eeruf.BatchState) -> dict[str, Any]:
        return {"wrong": state.is_wrong.mean(axis=1), "_wrong": np.ones(self.num_envs, bool)}


class CourseEnv(gymnasium.Env[NDArray[np.float32], NDArray[np.float32]]):
    """One course at a time: a :class:`CourseVectorEnv` with a single world.

    Args:
        method: as for ``eeruf.sim.Batch``.
        numbers: the courses to draw from.
        step_s: the time that a step takes, in seconds.
        physics: as for ``eeruf.sim.Scene``.

    Example:
        >>> import gymnasium
        >>> import eeruf.envs
        >>> env = gymnasium.make("eeruf/Course-v0", method="flow", numbers=range(3))
        >>> observed, _ = env.reset(seed=1)
        >>> observed, reward, terminated, truncated, info = env.step(env.action_space.sample())
        >>> observed.shape, terminated
        ((19,), False)

    """

    def __init__(
        self,
        *,
        method: Method = "eeruf",
        numbers: range = range(2_000),
        step_s: float = _STEP_S,
        physics: _Physics = "default",
    ) -> None:
        """Make the world; ``reset`` draws its course."""
        self._one = CourseVectorEnv(1, method=method, numbers=numbers, step_s=step_s, physics=physics, threads=1)
        self.observation_space, self.action_space = self._one.single_observation_space, self._one.single_action_space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        """Start over, in another course."""
        super().reset(seed=seed)
        # The inner environment is seeded from this one's generator.
        observed, info = self._one.reset(seed=int(self.np_random.integers(2**31)))
        return observed[0], {"wrong": float(info["wrong"][0])}

    def step(self, action: NDArray[np.float32]) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Drive on for one step."""
        observed, reward, terminated, truncated, info = self._one.step(np.asarray(action)[None])
        over = bool(terminated[0] or truncated[0])
        observed, info = (info["final_obs"], info["final_info"]) if over else (observed, info)
        return (
            observed[0],
            float(reward[0]),
            bool(terminated[0]),
            bool(truncated[0]),
            {"wrong": float(info["wrong"][0])},
        )


gymnasium.register(
    "eeruf/Course-v0", entry_point="eeruf.envs:CourseEnv", vector_entry_point="eeruf.envs:CourseVectorEnv"
)

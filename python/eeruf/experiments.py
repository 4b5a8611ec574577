"""The paper's experiments (Sec. 4), robots in front of walls and a robot among poles; and several robots of the same make.

``docs/log/experiments.md`` explains the tables, and where the paper promises too much; ``eeruf lab experiment``
prints the same tables. A method is a name or a ``eeruf.sim.Method``, which may have a filter or a firing
of your own. Parameters are tuned on seeds below 2,000; reports use seeds from 20,000 on.
"""

from __future__ import annotations

import json
import operator
from typing import TYPE_CHECKING, Any, Literal, overload

from eeruf import _eeruf, _making
from eeruf._making import compare, concat

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from os import PathLike

    _Progress = bool | Callable[[float | None, str], object] | None
    from eeruf._eeruf import _Height, _Method as Method, _Physics
    from eeruf._results import SetOne, SetThree, SetTwo, SpeedSweep

    _Corner = Literal["behind", "ahead"] | tuple[float, float] | None
    _RoomKind = Literal["corridor", "office", "hall", "clutter", "alcove", "garage", "aisle", "meeting"]
    _Pilot = Literal["own", "shared", "published", "published-gro"]

__all__ = [
    "alcoves",
    "compare",
    "concat",
    "courses",
    "recommend",
    "rooms",
    "set_one",
    "set_three",
    "set_two",
    "speed_sweep",
]

# Parameters were tuned on numbers below 2,000.
_FIRST = 20_000
_SPEEDS_M_S = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)


class Scenes:
    """A sequence of numbered scenes of an experiment, each made on demand; its slices are such sequences too.

    A scene's ``seed`` is its number. Sequences compare and pickle.

    Args:
        kind: ``"alcove"`` or ``"course"``.
        numbers: the scenes' numbers.
        physics: as for ``eeruf.sim.Scene``.

    Example:
        >>> from eeruf import experiments
        >>> scenes = experiments.Scenes("alcove", range(3, 9, 2))
        >>> [scene.seed for scene in scenes[1:]]
        [5, 7]

    """

    def __init__(self, kind: Literal["alcove", "course"], numbers: range, physics: _Physics = "default") -> None:
        """Make the scenes of these numbers."""
        if not isinstance(kind, str) or kind not in ("alcove", "course"):
            raise _eeruf.EerufError(f'kind = {kind!r}; expected "alcove" or "course"')
        # A range longer than 2**63 has no length.
        ends = (numbers[0], numbers[-1]) if isinstance(numbers, range) and numbers else (0,)
        if not isinstance(numbers, range) or not 0 <= min(ends) <= max(ends) < 2**62:
            raise _eeruf.EerufError(f"numbers = {numbers!r:.60}; expected a range of numbers from 0 to 2**62 - 1")
        # Invalid effects raise an error at once.
        _eeruf._alcove(0, physics)
        self.kind, self.numbers, self.physics = kind, numbers, physics

    def __len__(self) -> int:
        """Return the number of scenes."""
        return len(self.numbers)

    @overload
    def __getitem__(self, index: int) -> _eeruf.Scene: ...
    @overload
    def __getitem__(self, index: slice) -> Scenes: ...
    def __getitem__(self, index: int | slice) -> _eeruf.Scene | Scenes:
        """Make a scene, or a sequence of some of them."""
        if isinstance(index, slice):
            return Scenes(self.kind, self.numbers[index], self.physics)
        make = _eeruf._alcove if self.kind == "alcove" else _eeruf._course
        return make(self.numbers[index], self.physics)

    def __iter__(self) -> Iterator[_eeruf.Scene]:
        """Make the scenes one after the other."""
        return (self[index] for index in range(len(self)))

    def __eq__(self, other: object) -> bool:
        """Return true if both have the same scenes."""
        if not isinstance(other, Scenes):
            return NotImplemented
        return (self.kind, self.numbers, self.physics) == (other.kind, other.numbers, other.physics)

    def __hash__(self) -> int:
        """Return a hash of the kind and the numbers."""
        return hash((self.kind, self.numbers))

    def __repr__(self) -> str:
        """Return a call that makes the same scenes."""
        return f"Scenes({self.kind!r}, {self.numbers!r}, {self.physics!r})"


def alcoves(first: int = _FIRST, n: int = 200, *, physics: _Physics = "default") -> Scenes:
    """Return the alcoves of Set I as scenes with the robot in place; a scene's ``seed`` is its number.

    In each, ``eeruf.sim.simulate`` gives exactly the readings of :func:`set_one` with the same method, except ``multi_echo``, for
    which :func:`set_one` sets ``t_delta_us`` to 200.

    Args:
        first: the first alcove's number.
        n: how many alcoves.
        physics: as for ``eeruf.sim.Scene``.

    Raises:
        EerufError: a number is below 0, or the effects are invalid.

    Example:
        >>> from eeruf import experiments, sim
        >>> [scene.seed for scene in experiments.alcoves(20_000, 3)]
        [20000, 20001, 20002]
        >>> run = experiments.set_one(1, readings=400, methods=["eeruf"]).runs["eeruf"][0]
        >>> run.summary == sim.simulate(experiments.alcoves()[0], "eeruf", 50).summary()
        True

    """
    return Scenes("alcove", _numbers(first, n), physics)


def courses(first: int = _FIRST, n: int = 100, *, physics: _Physics = "default") -> Scenes:
    """Return the courses of Set II as scenes with the robot at the start; a scene's ``seed`` is its number.

    Drive through one with ``eeruf.sim.Simulation``. Sound is followed for two bounces at walls and poles; for speed,
    :func:`set_two` follows sound that meets a pole for one bounce only.

    Args:
        first: the first course's number.
        n: how many courses.
        physics: as for ``eeruf.sim.Scene``.

    Raises:
        EerufError: a number is below 0, or the effects are invalid.

    Example:
        >>> from eeruf import experiments
        >>> [len(scene.poles) for scene in experiments.courses(n=3)]
        [14, 14, 14]

    """
    return Scenes("course", _numbers(first, n), physics)


def rooms(
    ring: str | PathLike[str],
    first: int = _FIRST,
    n: int = 6,
    *,
    kind: _RoomKind = "office",
    driving: bool = False,
    physics: _Physics = "default",
    height: _Height = "room",
) -> list[_eeruf.Scene]:
    r"""Return rooms of one kind as scenes with the robot of a ring file in place; a scene's ``seed`` is its number.

    These are the rooms in which ``eeruf design`` judges ways of firing (``docs/how-to/design.md``).

    Args:
        ring: the path of a ring file. Without ``poses``, a ring's sensors are spread evenly, and a line's stand 15 degrees apart.
        first: the first room's number.
        n: how many rooms.
        kind: the kind of rooms; in ``"meeting"`` a second robot of the same make stands nearby.
        driving: whether the robot drives, at the file's ``speed_m_s`` or 0.3 m/s.
        physics: as for ``eeruf.sim.Scene``.
        height: as for ``eeruf.sim.Scene``.

    Raises:
        EerufError: a number is below 0, the file cannot be read, or the kind or the effects are invalid.

    Example:
        >>> import pathlib, tempfile
        >>> from eeruf import experiments
        >>> ring = pathlib.Path(tempfile.mkdtemp(), "ring.toml")
        >>> _ = ring.write_text("sensors = 8\nmodule = 'hc-sr04'\nlayout = 'ring'")
        >>> [len(scene.robots) for scene in experiments.rooms(ring, n=2, kind="meeting")]
        [2, 2]

    """
    return [_eeruf._room(kind, number, ring, driving, physics, height) for number in _numbers(first, n)]


def recommend(
    ring: str | PathLike[str],
    *,
    rooms: dict[str, _eeruf.Scene] | None = None,
    places: int = 6,
    first: int = 0,
    all_ways: bool = False,
    progress: _Progress = None,
) -> dict[str, Any]:
    r"""Judge the ways of firing a ring in rooms, and recommend one, as ``eeruf study RING.toml --json`` does.

    Args:
        ring: the path of a ring file.
        rooms: scenes of your own by name, in each of which the ring takes the place of the first robot; by default rooms of
            eight kinds.
        places: rooms of each kind, 1 to 1,000.
        first: the number of the first room of each kind; ways are chosen on numbers below 2,000, and reported from :data:`FIRST` on.
        all_ways: whether to measure every way, and to say what the answer is beside others and with the other gain; takes minutes.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        ``recommended``, the name of the way; ``keeps``, whether it has at most one false stop a minute under each condition in which
        the file says that the ring is used; ``draw``, a kind of way that may be better; ``assumed``, where the file is silent;
        ``kinds``, each with its ``cost`` (how soon it sees what appears; the best one by one is 1), ``is_candidate`` (whether it can be
        recommended) and the ``best`` way under each condition with its figures; ``elsewhere``, the kind to recommend under each
        condition by itself; ``ways``, every way, if asked for.

    Raises:
        EerufError: a number is out of range, or the file cannot be read or does not say where its sensors are.

    Example:
        >>> import pathlib, tempfile
        >>> import eeruf
        >>> ring = pathlib.Path(tempfile.mkdtemp(), "ring.toml")
        >>> _ = ring.write_text("sensors = 4\nmodule = 'hc-sr04'\nlayout = 'ring'")
        >>> answer = eeruf.experiments.recommend(ring, places=1)
        >>> answer["kinds"][0]["kind"], [way["condition"] for way in answer["kinds"][0]["best"]]
        ('one by one', ['standing', 'driving', 'turning'])
        >>> walls = [[-2, -2, 2, -2], [2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2]]
        >>> box = eeruf.sim.Scene(walls, robots=[eeruf.sim.Robot((0, 0, 0), sensors=[(0.2, 0, 0)])])
        >>> list(eeruf.experiments.recommend(ring, rooms={"box": box}, places=1)["kinds"][0]["best"][0]["rooms"])
        ['box']

    """
    asked: dict[str, object] = {
        "rooms": rooms,
        "places": places,
        "first": first,
        "all_ways": all_ways,
    }
    answer: dict[str, Any] = json.loads(_eeruf._recommend(ring, asked, progress))
    return answer


def _numbers(first: int, n: int) -> range:
    for name, value in (("first", first), ("n", n)):
        if not _is_whole(value) or value < 0:
            raise _eeruf.EerufError(f"{name} = {value!r:.60}; expected a whole number from 0 on")
    return range(operator.index(first), operator.index(first) + operator.index(n))


def _is_whole(value: object) -> bool:
    try:
        operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        return False
    return not isinstance(value, bool)


def _checked(first: int, seeds: int, tune: bool) -> None:
    """Refuse to tune on seeds for reporting."""
    # A non-number is refused elsewhere.
    if tune and _is_whole(first) and _is_whole(seeds) and operator.index(first) + operator.index(seeds) > _FIRST:
        raise _eeruf.EerufError(
            f"seeds up to {first + seeds - 1} with tune=True; expected seeds below {_FIRST}, such as first=0: "
            "figures are reported on those from there on"
        )


def set_one(
    seeds: int = 200,
    *,
    readings: int = 8000,
    methods: Sequence[Method] | None = None,
    first: int = _FIRST,
    physics: _Physics = "default",
    tune: bool = False,
    progress: _Progress = None,
) -> SetOne:
    """Run Set I: eight sensors in front of three walls at right angles, by every method, in many random alcoves.

    Runs on all cores; Ctrl-C ends it.

    Args:
        seeds: how many alcoves, 1 to 100,000.
        readings: the approximate number of readings for each alcove and method, 1 or more.
        methods: names of ``eeruf.sim.METHODS`` and ``eeruf.sim.Method``; by default all but those that fire like sketches and modules.
        first: the first alcove's number.
        physics: as for ``eeruf.sim.Scene``.
        tune: whether parameters are chosen by the result. Seeds from 20,000 on are then refused: they are for reports.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        The figures of each method, which do not depend on the number of threads.

    Raises:
        EerufError: a number is out of range, or a method is unknown; there are no methods, or two with the same label; or ``tune``
            with a seed for reports.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=800, methods=["conventional", "eeruf"])
        >>> wrong = {name: figures.wrong_of_all.median for name, figures in table.methods.items()}
        >>> wrong["eeruf"] < 0.1 < wrong["conventional"]
        True

    """
    _checked(first, seeds, tune)
    return _making.set_one(*_eeruf._set_one(seeds, first, readings, methods, progress, physics))


def set_two(
    seeds: int = 100,
    *,
    methods: Sequence[Method] | None = None,
    second_robot: _Corner = None,
    speed_m_s: float = 1.0,
    odometry: bool = True,
    t_delta_us: int | None = None,
    first: int = _FIRST,
    pilot: _Pilot = "own",
    odometry_noise: bool = True,
    bodies: bool = False,
    physics: _Physics = "default",
    tune: bool = False,
    progress: _Progress = None,
) -> SetTwo:
    """Run Set II: a LabMate drives through random courses of 8 mm poles about 1.6 m apart, steered by its ring's readings.

    Accepted readings fill a histogram grid (HIMM), and the vector field histogram steers. Every method drives the same courses,
    for at most 40 s each. Runs on all cores; Ctrl-C ends it.

    Args:
        seeds: how many courses, 1 to 100,000.
        methods: names of ``eeruf.sim.METHODS`` and ``eeruf.sim.Method``; by default sequential, far_groups, conventional, comparison, eeruf,
            eeruf_best, adaptive and multi_echo.
        second_robot: the place of another robot, which fires 24 times in 80 ms: ``"behind"`` the start, ``"ahead"`` in the
            reflective corner that all sensors face, or a point (x, y) in metres of the lab, which is 10 m by 6 m.
        speed_m_s: the platform's highest speed, 0.1 to 5 m/s.
        odometry: whether the robot tells its ring the changes of readings to expect from its own motion.
        t_delta_us: readings that differ by no more are near-identical; by default 150 with odometry and 500 without.
        first: the first course's number.
        pilot: the pilot that steers: ``"own"``, one for each method, found by the same search; ``"shared"``, one for all methods,
            which an earlier search found by the score of eeruf; ``"published"`` and ``"published-gro"``, the published settings
            without and with the growth rate operator.
        odometry_noise: whether wheels slip and are measured with errors, so that the estimated place is off by a decimetre or so
            at the end; otherwise it is exact.
        bodies: whether robots have bodies: a square for the platform, with the ring on its edge, and a disc for the second robot,
            an obstacle to sound and to the platform. The pilots were tuned without bodies.
        physics: as for ``eeruf.sim.Scene``.
        tune: whether parameters are chosen by the result. Seeds from 20,000 on are then refused: they are for reports.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        The figures of each method, and its runs, which :func:`eeruf.plot.course` draws. The result does not depend on the number
        of threads.

    Raises:
        EerufError: a number is out of range, or a method is unknown; there are no methods, or two with the same label; ``tune``
            with a seed for reports; or an invalid place for the second robot.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=2, methods=["conventional", "eeruf"])
        >>> {name: figures.finished for name, figures in found.methods.items()}
        {'conventional': 2, 'eeruf': 1}

    """
    _checked(first, seeds, tune)
    asked = _asked(
        seeds, methods, second_robot, speed_m_s, odometry, t_delta_us, first, pilot, odometry_noise, physics, bodies
    )
    return _making.set_two(*_eeruf._set_two(asked, progress))


def set_three(
    seeds: int = 200,
    *,
    methods: Sequence[Method] | None = None,
    periods: int = 40,
    first: int = _FIRST,
    physics: _Physics = "default",
    height: Literal["flat", "room"] | dict[str, object] = "flat",
    tune: bool = False,
    progress: _Progress = None,
) -> SetThree:
    """Run Set III: two to six robots with the same ring stand, meet or follow each other in a corridor or a hall.

    They differ only in the phases and drifts of their clocks. The methods of today's rings (``in_turn``, ``arrays``, ``groups``,
    ``sync_line``, ``free_running``, ``table``) use two arrays of six, four groups of three, and modules that rest for 65 ms.
    Runs on all cores; Ctrl-C ends it.

    Args:
        seeds: how many placings, 1 to 100,000.
        methods: names of ``eeruf.sim.METHODS`` and ``eeruf.sim.Method``; by default simultaneous, sequential, sequential_votes, dither, eeruf and flow.
        periods: the number of periods of 100 ms for which each placing is simulated, 10 to 100,000.
        first: the first placing's number.
        physics: as for ``eeruf.sim.Scene``.
        height: as for ``eeruf.sim.Scene``.
        tune: whether parameters are chosen by the result. Seeds from 20,000 on are then refused: they are for reports.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        The figures of each method, which do not depend on the number of threads.

    Raises:
        EerufError: a number is out of range, or a method is unknown; there are no methods, or two with the same label; or ``tune``
            with a seed for reports.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=3, periods=20, methods=["simultaneous", "flow"])
        >>> found.methods["flow"].right_echoes_per_s.median > 0
        True

    """
    _checked(first, seeds, tune)
    return _making.set_three(*_eeruf._set_three(seeds, first, periods, methods, progress, physics, height))


def speed_sweep(
    speeds_m_s: Sequence[float] = _SPEEDS_M_S,
    *,
    seeds: int = 100,
    methods: Sequence[Method] | None = None,
    second_robot: _Corner = None,
    odometry: bool = True,
    t_delta_us: int | None = None,
    first: int = _FIRST,
    pilot: _Pilot = "own",
    odometry_noise: bool = True,
    bodies: bool = False,
    physics: _Physics = "default",
    tune: bool = False,
    progress: _Progress = None,
) -> SpeedSweep:
    """Run Set II at several top speeds, to find the speed that each method sustains. Ctrl-C ends it.

    Args:
        speeds_m_s: the platform's highest speeds, each 0.1 to 5 m/s.
        seeds: as in :func:`set_two`.
        methods: as in :func:`set_two`.
        second_robot: as in :func:`set_two`.
        odometry: as in :func:`set_two`.
        t_delta_us: as in :func:`set_two`.
        first: as in :func:`set_two`.
        pilot: as in :func:`set_two`.
        odometry_noise: as in :func:`set_two`.
        bodies: as in :func:`set_two`.
        physics: as in :func:`set_two`.
        tune: as in :func:`set_two`.
        progress: as in :func:`set_two`.

    Returns:
        The outcome at each speed, and for each method the highest speed at which 95 % of the courses are finished.

    Raises:
        EerufError: a number is out of range, or a method is unknown; there are no methods, or two with the same label; ``tune``
            with a seed for reports; or an invalid place for the second robot.

    Example:
        >>> import eeruf
        >>> sweep = eeruf.experiments.speed_sweep([0.75, 1.0], seeds=2, methods=["eeruf"])
        >>> [step.finished_of_all["eeruf"] for step in sweep.steps], sweep.borne_m_s
        ([1.0, 0.5], {'eeruf': 0.75})

    """
    _checked(first, seeds, tune)
    asked = _asked(
        seeds, methods, second_robot, 1.0, odometry, t_delta_us, first, pilot, odometry_noise, physics, bodies
    )
    return _making.speed_sweep(_eeruf._speed_sweep(speeds_m_s, asked, progress))


def _asked(*values: object) -> dict[str, object]:
    names = (
        "seeds",
        "methods",
        "second_robot",
        "speed_m_s",
        "odometry",
        "t_delta_us",
        "first",
        "pilot",
        "odometry_noise",
        "physics",
        "bodies",
    )
    return dict(zip(names, values))

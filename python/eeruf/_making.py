"""Results made, joined and compared from Rust's JSON."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from typing import TYPE_CHECKING, TypeVar, cast

from eeruf._eeruf import EerufError, _difference, _figures
from eeruf._results import (
    AlcoveRun,
    Difference,
    Latency,
    NewStep,
    PlacingRun,
    Run,
    SetOne,
    SetOneFigures,
    SetThree,
    SetThreeBrief,
    SetThreeFigures,
    SetThreeGroup,
    SetTwo,
    SetTwoFigures,
    SpeedStep,
    SpeedSweep,
    Spread,
)
from eeruf._summary import Result, Summary

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

# A method sustains a speed at which this share of the courses is finished.
_BORNE = 0.95

_Fields = dict[str, object]


def _fields(text: str) -> _Fields:
    return cast("_Fields", json.loads(text))


def _pair(value: object) -> tuple[float, float] | None:
    return None if value is None else cast("tuple[float, float]", tuple(cast("list[float]", value)))


def _with_pairs(of: _Fields) -> _Fields:
    """Convert confidence bounds to tuples."""
    return {name: _pair(value) if name.endswith("_95") else value for name, value in of.items()}


def summary(text: str) -> Summary:
    """Make a summary from Rust's JSON."""
    return Summary(**_fields(text))  # type: ignore[arg-type]


def _spreads(of: _Fields) -> _Fields:
    """Convert the figures of a method, with spreads for dicts."""
    made: _Fields = {}
    for name, value in _with_pairs(of).items():
        kind = {"nearer": Latency, "farther": Latency, "new_step": NewStep}.get(name, Spread)
        made[name] = kind(**_with_pairs(value)) if isinstance(value, dict) else value
    return made


def _alcove_run(of: _Fields) -> AlcoveRun:
    steps = {name: tuple(cast("list[None]", of[name])) for name in ("nearer", "farther", "new_ms")}
    summary = Summary(**cast("_Fields", of["summary"]))  # type: ignore[arg-type]
    return AlcoveRun(seed=cast("int", of["seed"]), summary=summary, **steps)


def _groups(of: object) -> tuple[SetThreeGroup, ...]:
    def group(of: _Fields) -> SetThreeGroup:
        methods = cast("dict[str, _Fields]", of["methods"])
        of["methods"] = {name: SetThreeBrief(**_spreads(brief)) for name, brief in methods.items()}  # type: ignore[arg-type]
        return SetThreeGroup(**of)  # type: ignore[arg-type]

    return tuple(group(of) for of in cast("list[_Fields]", of))


def _by_method(table: _Fields, runs: str) -> dict[str, list[_Fields]]:
    return dict(zip(cast("_Fields", table["methods"]), cast("list[list[_Fields]]", json.loads(runs))))


def set_one(text: str, runs: str) -> SetOne:
    """Make the result of Set I from its JSON and that of its runs."""
    table = _fields(text)
    table["runs"] = {name: [_alcove_run(of) for of in each] for name, each in _by_method(table, runs).items()}
    methods = cast("dict[str, _Fields]", table["methods"])
    table["methods"] = {name: SetOneFigures(**_spreads(of)) for name, of in methods.items()}  # type: ignore[arg-type]
    return SetOne(**table)  # type: ignore[arg-type]


def set_three(text: str, runs: str) -> SetThree:
    """Make the result of Set III from its JSON and that of its runs."""
    table = _fields(text)
    made = {name: [PlacingRun(**of) for of in each] for name, each in _by_method(table, runs).items()}  # type: ignore[arg-type]
    methods = cast("dict[str, _Fields]", table["methods"])
    table["methods"] = {name: SetThreeFigures(**_spreads(of)) for name, of in methods.items()}  # type: ignore[arg-type]
    table.update(groups=_groups(table["groups"]), runs=made)
    return SetThree(**table)  # type: ignore[arg-type]


def set_two(text: str, runs: Mapping[str, list[_Fields]]) -> SetTwo:
    """Make the result of Set II from its JSON and the fields of its runs."""
    table = _fields(text)
    figures = cast("dict[str, _Fields]", table["methods"])
    table["methods"] = {name: SetTwoFigures(**_with_pairs(of)) for name, of in figures.items()}  # type: ignore[arg-type]
    table["second_robot_m"] = _pair(table["second_robot_m"])
    table["runs"] = {name: [Run(**run) for run in of] for name, of in runs.items()}  # type: ignore[arg-type]
    return SetTwo(**table)  # type: ignore[arg-type]


# The fields of a run of Set II that its figures need, with Rust's names.
_OF_COURSES = {
    "rejected_readings": "rejected",
    "wrong_readings": "wrong",
    "poles_unseen": "poles_missed",
    **{
        name: name
        for name in (
            "course",
            "ending",
            "time_s",
            "way_m",
            "top_speed_m_s",
            "nearest_m",
            "readings",
            "phantom_echoes",
            "phantom_cells",
            "poles_passed",
        )
    },
}


def _of_course(run: Run) -> _Fields:
    made = {theirs: getattr(run, ours) for ours, theirs in _OF_COURSES.items()}
    # JSON has no infinity.
    return {**made, "nearest_m": run.figures()["nearest_m"]}


Table = TypeVar("Table", SetOne, SetTwo, SetThree)


def concat(tables: Iterable[Table]) -> Table:
    """Join parts of one experiment; the table equals that of the undivided run, to the last bit.

    Args:
        tables: results of :func:`set_one`, :func:`set_two` or :func:`set_three` for successive seeds, in any order.

    Raises:
        EerufError: tables of different kinds, settings or methods, or a seed that is missing or occurs twice.

    Example:
        >>> from eeruf import experiments
        >>> parts = [experiments.set_one(2, first=first, readings=400, methods=["eeruf"]) for first in (20_002, 20_000)]
        >>> experiments.concat(parts) == experiments.set_one(4, readings=400, methods=["eeruf"])
        True

    """
    try:
        parts = list(tables)
    except TypeError:
        parts = []
    expected = "tables of one of set_one, set_two and set_three"
    if not parts or not isinstance(parts[0], (SetOne, SetTwo, SetThree)):
        raise EerufError(f"tables = {tables!r:.60}; expected {expected}")
    for part in parts[1:]:
        if type(part) is not type(parts[0]):
            raise EerufError(f"tables: a {type(parts[0]).__name__} and a {type(part).__name__}; expected {expected}")
    parts.sort(key=lambda part: part.first)
    whole = parts[0]
    merged = {"first", "seeds", "methods", "runs", "groups"}
    for part, before in zip(parts[1:], parts):
        for name in (name.name for name in fields(part) if name.name not in merged):
            one, other = getattr(whole, name), getattr(part, name)
            if one != other:
                raise EerufError(f"tables: {name} = {one!r} and {other!r}; expected parts of one experiment")
        if list(part.runs) != list(whole.runs):
            raise EerufError(f"tables: methods {list(whole.runs)} and {list(part.runs)}; expected the same")
        if part.first != before.first + before.seeds:
            last, expected = before.first + before.seeds - 1, "each seed once, without a gap"
            raise EerufError(f"tables: seeds up to {last} and from {part.first} on; expected {expected}")
    runs = {name: [run for part in parts for run in part.runs[name]] for name in whole.runs}
    of = {SetOne: (1, Result.to_dict), SetTwo: (2, _of_course), SetThree: (3, Result.to_dict)}
    number, plain = of[type(whole)]
    pairs = [(name, [plain(run) for run in each]) for name, each in runs.items()]  # type: ignore[arg-type]
    found = _fields(_figures(number, json.dumps(pairs)))
    kind = {SetOne: SetOneFigures, SetTwo: SetTwoFigures, SetThree: SetThreeFigures}[type(whole)]
    methods = {name: kind(**_spreads(figures)) for name, figures in cast("list[tuple[str, _Fields]]", found["methods"])}
    changes: _Fields = {"seeds": sum(part.seeds for part in parts), "methods": methods, "runs": runs}
    if isinstance(whole, SetThree):
        changes["groups"] = _groups(found["groups"])
    return replace(whole, **changes)  # type: ignore[arg-type]


def compare(
    one: Iterable[AlcoveRun | Run | PlacingRun], other: Iterable[AlcoveRun | Run | PlacingRun]
) -> dict[str, Difference]:
    """Compare two methods scene by scene: each figure of ``one`` minus that of ``other``, paired by seed.

    Scenes in which one of the two lacks a figure are left out of that figure.

    Args:
        one: runs of one method, such as ``table.runs["mine"]``.
        other: runs of the other on the same seeds.

    Returns:
        The :class:`Difference` of each figure: the mean with the bootstrap's interval, the median with the sign test's.

    Raises:
        EerufError: no runs, runs of different experiments, or different seeds.

    Example:
        >>> from eeruf import experiments
        >>> runs = experiments.set_one(4, readings=400, methods=["eeruf", "conventional"]).runs
        >>> experiments.compare(runs["eeruf"], runs["conventional"])["wrong_of_all"].mean < -0.2
        True

    """

    def by_seed(name: str, runs: Iterable[AlcoveRun | Run | PlacingRun]) -> dict[int, AlcoveRun | Run | PlacingRun]:
        given = list(runs) if isinstance(runs, (list, tuple)) else []
        if not given or not all(isinstance(run, (AlcoveRun, Run, PlacingRun)) for run in given):
            raise EerufError(f'{name} = {runs!r:.60}; expected runs of one method, such as table.runs["eeruf"]')
        return {run.seed: run for run in given}

    ours, theirs = by_seed("one", one), by_seed("other", other)
    if ours.keys() != theirs.keys():
        alone = sorted(ours.keys() ^ theirs.keys())
        raise EerufError(f"seed {alone[0]} and {len(alone) - 1} others are of one method only; expected equal seeds")
    pairs = [(ours[seed].figures(), theirs[seed].figures()) for seed in sorted(ours)]
    if pairs[0][0].keys() != pairs[0][1].keys():
        raise EerufError("runs of two experiments; expected those of one")
    found = {}
    for name in pairs[0][0]:
        values = [(first[name], second[name]) for first, second in pairs]
        text = _difference([first - second for first, second in values if first is not None and second is not None])
        if text is not None:
            found[name] = Difference(**_with_pairs(_fields(text)))  # type: ignore[arg-type]
    return found


def speed_sweep(text: str) -> SpeedSweep:
    """Make the result of a sweep over speeds from its JSON."""
    table = _fields(text)

    def made(step: _Fields) -> SpeedStep:
        bounds = cast("dict[str, list[float]]", step["finished_95"])
        pairs = {method: _pair(pair) for method, pair in bounds.items()}
        return SpeedStep(**{**step, "finished_95": pairs})  # type: ignore[arg-type]

    steps = tuple(made(step) for step in cast("list[_Fields]", table["steps"]))

    def borne_m_s(method: str) -> float | None:
        return max((step.speed_m_s for step in steps if step.finished_of_all[method] >= _BORNE), default=None)

    table.update(steps=steps, borne_m_s={method: borne_m_s(method) for method in steps[0].finished_of_all})
    table["second_robot_m"] = _pair(table["second_robot_m"])
    return SpeedSweep(**table)  # type: ignore[arg-type]

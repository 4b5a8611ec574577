"""The ring benchmark: every method, and yours, on the same unseen scenes, as one table.

    python benches/leaderboard/leaderboard.py                       # built-in methods, 200 scenes an experiment (an hour)
    python benches/leaderboard/leaderboard.py --scenes 8 entries/median.py

An entry is a Python file of at most 15 lines that makes `METHOD`, an `eeruf.sim.Method`. Scenes are numbered from 20,000 on; whoever tunes
does so on numbers below 2,000. With `--folder` parts are kept there, so that a run that was ended goes on.
"""

from __future__ import annotations

import argparse
import os
import runpy
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any

import eeruf
from eeruf import experiments, sim

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from eeruf.experiments import _RoomKind

ROOT = Path(__file__).parents[2]
BUILT_IN = (
    "sequential",
    "sequential_votes",
    "simultaneous",
    "conventional",
    "eeruf",
    "flow",
)
"""The methods that stand in each table; `sequential`, one by one, is what a method has to beat."""
RING = ROOT / "rings" / "hc-sr04-8.toml"
KINDS: tuple[_RoomKind, ...] = ("corridor", "office", "hall", "clutter", "alcove", "garage", "aisle", "meeting")
MOST_LINES = 15
PART = 10
"""Scenes a part."""
M0 = {"instructions": "eeruf", "flow instructions": "flow"}
"""Tables of tests/data/boards.txt, and the methods whose rings they measure."""


def entry(file: Path) -> sim.Method:
    """Read an entry."""
    lines = [line for line in file.read_text().splitlines() if line.strip()]
    if len(lines) > MOST_LINES:
        raise SystemExit(f"{file}: {len(lines)} lines; expected at most {MOST_LINES}")
    method = runpy.run_path(str(file)).get("METHOD")
    if not isinstance(method, sim.Method):
        raise SystemExit(f"{file}: METHOD = {method!r:.60}; expected an eeruf.sim.Method")
    return method


def cost_on_m0() -> dict[str, int]:
    """Most instructions of a reading on a Cortex-M0, by method, where they have been measured."""
    document, found = ROOT / "tests" / "data" / "boards.txt", {}
    tables = document.read_text().split("<!-- measured: ")[1:] if document.exists() else []
    for table in tables:
        title, _, rest = table.partition(" -->")
        for row in rest.partition("<!-- end -->")[0].splitlines():
            cells = [cell.strip() for cell in row.split("|")]
            if title in M0 and cells[1:3] == ["microbit", "reading"]:
                found[M0[title]] = int(cells[4])
    return found


def in_parts(run: Callable[[int, int], Any], scenes: int, folder: Path | None) -> Any:
    """Run an experiment in parts, kept in a folder if there is one, and put them together."""
    firsts = [experiments.FIRST + done for done in range(0, scenes, PART)]

    def part(first: int) -> Any:
        return run(first, min(PART, experiments.FIRST + scenes - first))

    # An experiment keeps all cores busy by itself.
    with ThreadPoolExecutor(1) as one:
        return experiments.concat(eeruf.sweep(part, firsts, executor=one, folder=folder))


def in_rooms(methods: Sequence[Any], places: int, physics: Any) -> dict[str, dict[str, float]]:
    """Share of time in which sensors are right, in each kind of room, by method: the mean over places and sensors."""
    scenes = [
        (kind, scene) for kind in KINDS for scene in experiments.rooms(RING, n=places, kind=kind, physics=physics)
    ]

    def right(job: tuple[Any, tuple[str, sim.Scene]]) -> tuple[str, str, float]:
        method, (kind, scene) = job
        return label(method), kind, sim.simulate(scene, method, 200).summary().belief_right

    found: dict[str, dict[str, list[float]]] = {label(method): {kind: [] for kind in KINDS} for method in methods}
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        for name, kind, share in threads.map(right, [(method, scene) for method in methods for scene in scenes]):
            found[name][kind].append(share)
    return {name: {kind: sum(of) / len(of) for kind, of in kinds.items()} for name, kinds in found.items()}


def label(method: Any) -> str:
    """Return the name in the table."""
    return method if isinstance(method, str) else method.label


def percent(value: float | None) -> str:
    """Return a share in percent."""
    return "-" if value is None else f"{100 * value:.1f}"


def paired(one: Sequence[Any], other: Sequence[Any]) -> str:
    """Return the median difference of the shares of right belief, in points, with its interval."""
    found = experiments.compare(one, other)["belief_right"]
    # Fewer than six scenes have no interval.
    interval = found.median_95 and " ({:+.1f} to {:+.1f})".format(*(100 * end for end in found.median_95))
    return f"{100 * found.median:+.1f}{interval or ''}"


def table(arguments: argparse.Namespace, physics: Any, methods: Sequence[Any]) -> str:
    """Run all experiments under one physics, and lay them out."""
    against, scenes = arguments.against, arguments.scenes

    def found(name: str, run: Callable[..., Any]) -> Any:
        folder = arguments.folder and arguments.folder / f"{name}-{physics}"
        return in_parts(lambda first, n: run(n, first=first, methods=methods, physics=physics), scenes, folder)

    one, two, three = (
        found("one", experiments.set_one),
        found("two", experiments.set_two),
        found("three", experiments.set_three),
    )
    rooms, cost = in_rooms(methods, max(1, scenes // 20), physics), cost_on_m0()
    lines = [
        f"**Physics {physics}**, {scenes} scenes from {experiments.FIRST} on.",
        "",
        f"| method | alcoves: right % | less {against}, points | phantom % | echoes/s | courses | others' sound, % | rooms: right % "
        "| worst kind | M0 |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for name in sorted(rooms, key=lambda name: -one.methods[name].belief_right.median):
        alcoves, courses, placings = one.methods[name], two.methods[name], three.methods[name]
        foreign = placings.others_of_accepted
        kinds = rooms[name]
        worst = min(kinds, key=lambda kind: kinds[kind])
        cells = [
            name,
            percent(alcoves.belief_right.median),
            "" if name == against else paired(one.runs[name], one.runs[against]),
            percent(alcoves.phantom.median),
            f"{alcoves.right_echoes_per_s.median:.1f}",
            f"{courses.finished} of {courses.courses}",
            percent(foreign and foreign.median),
            percent(sum(kinds.values()) / len(kinds)),
            f"{worst} {percent(kinds[worst])}",
            str(cost.get(name, "")),
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def main() -> None:
    """Read the arguments and print a table for each physics."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("entries", nargs="*", type=Path, metavar="ENTRY.py", help="methods of your own")
    parser.add_argument("--scenes", type=int, default=200, help="of each experiment (200)")
    parser.add_argument("--physics", nargs="+", default=["default"], choices=["plain", "default"], help="one or both")
    parser.add_argument("--against", default="sequential", help="the method that others are paired with (sequential)")
    parser.add_argument("--folder", type=Path, help="keeps parts, so that a run that was ended goes on")
    arguments = parser.parse_args()
    methods = [*BUILT_IN, *map(entry, arguments.entries)]
    if arguments.against not in map(label, methods):
        parser.error(f"--against {arguments.against}; expected one of {', '.join(map(label, methods))}")
    if arguments.scenes < 1:
        parser.error(f"--scenes {arguments.scenes}; expected 1 or more")
    for physics in arguments.physics:
        print(table(arguments, physics, methods), end="\n\n", flush=True)
    print(
        "Right: what a sensor last said, at most 0.6 s ago, is within 8.6 cm; medians over scenes, and of the difference",
        end=" ",
    )
    print(
        "the sign test's 95 % interval. Courses finished by each method's own pilot. Others' sound: share of what is",
        end=" ",
    )
    print("accepted by robots of one make. M0: most instructions of a reading, tests/data/boards.txt.")


if __name__ == "__main__":
    main()

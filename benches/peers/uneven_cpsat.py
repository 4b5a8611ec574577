"""The shortest period of random small rings whose sensors are not all alike, by OR-tools CP-SAT, and by `eeruf design`: do they agree?

    cargo build --release -p eeruf
    python benches/peers/uneven_cpsat.py target/release/eeruf [--rings 300] [--seed 20000]

Each ring is drawn from its seed: two to six sensors with windows, retrigger times and tolerances of their own, intervals of pairs, shared
echo lines, sensors that fire together, stale echoes. It is written as a ring file, so what is compared begins with the file. The model is the
definition (docs/reference/certificate.md, "The problem"), written down for all firings of two periods and the first of
the third. Ends at the first difference, and prints how many rings of each kind there were.
"""

import argparse
import collections
import json
import pathlib
import random
import subprocess
import tempfile

from ortools.sat.python import cp_model

TICK_US = 1000


def draw(dice: random.Random) -> dict:
    """A ring file's keys, times in ticks."""
    sensors = dice.randint(2, 6)
    pairs = [(x, y) for x in range(sensors) for y in range(x + 1, sensors)]

    def maybe(share: float, value):
        return value if dice.random() < share else []

    groups = maybe(0.4, [sorted(dice.sample(range(sensors), dice.randint(2, min(3, sensors))))])
    if groups and sensors >= 5 and dice.random() < 0.3:
        groups.append(sorted(dice.sample([x for x in range(sensors) if x not in groups[0]], 2)))
    joined = [pair for pair in pairs if any(set(pair) <= set(group) for group in groups)]
    lines = maybe(0.5, [sorted(dice.sample(range(sensors), dice.randint(2, sensors)))])
    lines += maybe(0.2, [sorted(dice.sample(range(sensors), 2))])
    lines = [line for line in lines if not any(set(pair) <= set(line) for pair in joined)]
    own = dict.fromkeys(joined, 0)
    own |= {pair: dice.randint(0, 8) for pair in maybe(0.5, dice.sample(pairs, min(len(pairs), 3))) if pair not in own}
    return {
        "sensors": sensors,
        "neighbours": dice.randint(1, 4),
        "layout": dice.choice(["line", "ring"]),
        "interval": dice.randint(0, 7),
        "t_delta": [dice.randint(0, 2) for _ in range(sensors)],
        "window": [dice.randint(1, 12) for _ in range(sensors)],
        "own": own,
        "lines": lines,
        "together": groups,
        "stale_echo": dice.random() < 0.3,
    }


def ring_file(ring: dict) -> str:
    # A tolerance of t ticks less a microsecond: 2 t ticks are the smallest number above twice of it; of none, one tick is.
    t_delta = [max(t * TICK_US - 1, 0) for t in ring["t_delta"]]
    own = [[x, y, interval * TICK_US] for (x, y), interval in ring["own"].items()]
    return "\n".join(
        [
            f"sensors = {ring['sensors']}",
            f"neighbours = {ring['neighbours']}",
            f'layout = "{ring["layout"]}"',
            f"min_interval_us = {ring['interval'] * TICK_US}",
            f"t_delta_us = {t_delta}",
            f"window_us = {[window * TICK_US for window in ring['window']]}",
            f"intervals_us = {own}",
            f"shared_lines = {ring['lines']}",
            f"together = {ring['together']}",
            f"stale_echo = {str(ring['stale_echo']).lower()}",
            f"tick_us = {TICK_US}",
        ]
    )


def gap(ring: dict, x: int, y: int) -> int:
    """Return the time after x in which sensor y must not fire."""
    apart = abs(x - y)
    if ring["layout"] == "ring":
        apart = min(apart, ring["sensors"] - apart)
    interval = ring["interval"] if apart < ring["neighbours"] else 0
    interval = ring["own"].get((min(x, y), max(x, y)), interval)
    shared = any(x in line and y in line for line in ring["lines"])
    return max(interval, ring["window"][x]) if shared else interval


def shortest(ring: dict, most: int, limit: float) -> int | None:
    """The shortest period of at most `most` ticks; 0 if there is none, None if the time does not suffice."""
    sensors = range(ring["sensors"])
    m = cp_model.CpModel()
    period = m.new_int_var(1, most, "period")
    fire = [[m.new_int_var(0, most - 1, f"{phase}{x}") for x in sensors] for phase in "ab"]
    size = [m.new_int_var(0, most, f"size{x}") for x in sensors]
    separation = [max(2 * t, 1) for t in ring["t_delta"]]
    for x in sensors:
        m.add(fire[0][x] < period)
        m.add(fire[1][x] < period)
        m.add_abs_equality(size[x], fire[0][x] - fire[1][x])
        m.add(period - size[x] >= ring["window"][x])
        if ring["stale_echo"]:
            m.add(2 * size[x] >= separation[x])

    def before(one, other, least: int):
        """One of the two: `other` is `least` after `one`, or it comes before it."""
        after, sooner = m.new_bool_var(""), m.new_bool_var("")
        m.add_bool_or(after, sooner)
        m.add(other - one >= least).only_enforce_if(after)
        m.add(other - one <= -1).only_enforce_if(sooner)

    for x in sensors:
        for y in sensors:
            if x == y:
                continue
            together = any(x in group and y in group for group in ring["together"])
            if x < y and together:
                m.add(fire[0][x] == fire[0][y])
                m.add(fire[1][x] == fire[1][y])
            elif x < y:
                apart = max(separation[x], separation[y])
                larger = m.new_bool_var("")
                m.add(size[x] - size[y] >= apart).only_enforce_if(larger)
                m.add(size[y] - size[x] >= apart).only_enforce_if(~larger)
            if (least := gap(ring, x, y)) > 0:
                line_x, line_y = ([fire[0][z], period + fire[1][z], 2 * period + fire[0][z]] for z in (x, y))
                for i in range(3):
                    for j in range(i, 3):
                        before(line_x[i], line_y[j], least)
    m.minimize(period)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 2
    solver.parameters.max_time_in_seconds = limit
    status = solver.solve(m)
    if status == cp_model.INFEASIBLE:
        return 0
    return round(solver.objective_value) if status == cp_model.OPTIMAL else None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the built program eeruf")
    parser.add_argument("--rings", type=int, default=300)
    parser.add_argument("--seed", type=int, default=20_000)
    parser.add_argument("--limit", type=float, default=120.0, help="seconds per ring for CP-SAT")
    args = parser.parse_args()
    seen = collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ring.toml"
        for seed in range(args.seed, args.seed + args.rings):
            ring = draw(random.Random(seed))
            file.write_text(ring_file(ring))
            run = subprocess.run([args.program, "design", "--json", file], capture_output=True, text=True)
            if run.returncode != 0:
                raise SystemExit(f"seed {seed}: {run.stdout}{run.stderr}\n{ring_file(ring)}")
            found = json.loads(run.stdout)
            proven = shortest(ring, found["value_us"] // TICK_US, args.limit)
            if proven is None:
                print(f"seed {seed}: CP-SAT ran out of time", flush=True)
                seen["CP-SAT ran out of time"] += 1
                continue
            if not found["proven"] or found["value_us"] != proven * TICK_US:
                raise SystemExit(f"seed {seed}: CP-SAT proves {proven} ticks, eeruf says {found}\n{ring_file(ring)}")
            seen["agree"] += 1
            for key in ("own", "lines", "together", "stale_echo"):
                seen[f"with {key}"] += bool(ring[key])
            seen[f"{ring['sensors']} sensors"] += 1
    print(", ".join(f"{what}: {times}" for what, times in sorted(seen.items())))


if __name__ == "__main__":
    main()

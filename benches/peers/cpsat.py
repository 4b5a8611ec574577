"""The shortest period by OR-tools CP-SAT and by eeruf: do they agree, and how long does each take?

    cargo lab uneven-rings 20 60 > target/rings.jsonl
    cargo lab shortest-periods 1 2 8,12,16,24 >> target/rings.jsonl
    python benches/peers/cpsat.py race target/rings.jsonl [--limit 60]
    python benches/peers/cpsat.py small target/release/eeruf [--rings 300] [--seed 20000]

`race` prints for each ring the period, the bound, and the seconds of one core until that period was found or proven. Then it prints two
geometric means of ratios, with 95 % intervals: for the time until the peer's last period or a shorter one was found, and for the time until
the answer was proven. An expired limit counts as the time spent, and less than 5 ms as 5 ms. `small` draws rings of two to six sensors with
needs of their own from seeds, writes them as ring files, and ends at the first difference. The model is the definition (docs/reference/certificate.md, "The problem").
"""

import argparse
import itertools
import json
import math
import pathlib
import random
import statistics
import subprocess
import tempfile
import threading
import time

from ortools.sat.python import cp_model

TICK_US = 1000
Steps = list[tuple[float, int]]


class Watch(cp_model.CpSolverSolutionCallback):
    """The periods found, each with the time until it was found, in seconds."""

    def __init__(self) -> None:
        super().__init__()
        self.begin, self.steps = time.process_time(), []

    def seconds(self) -> float:
        return time.process_time() - self.begin

    def on_solution_callback(self) -> None:
        self.steps.append((self.seconds(), round(self.objective_value)))


def cp_sat(ring: dict, limit: float) -> tuple[int, float, Steps]:
    """Solve by CP-SAT. Return bound, seconds and steps; a bound of 0 means that no schedule exists."""
    m, count = cp_model.CpModel(), len(ring["window"])
    most = 2 * sum(max(gap[2:]) for gap in ring["gaps"]) + max(ring["window"]) + 3 * sum(ring["separation"])
    period = m.new_int_var(1, most, "")
    a, b, size = ([m.new_int_var(0, most, "") for _ in range(count)] for _ in range(3))
    together = [set(group) for group in ring.get("together", [])]
    for x in range(count):
        m.add(a[x] < period)
        m.add(b[x] < period)
        m.add_abs_equality(size[x], a[x] - b[x])
        m.add(period - size[x] >= ring["window"][x])
        if ring.get("stale_echo"):
            m.add(2 * size[x] >= ring["separation"][x])
        for y in range(x):
            if any({x, y} <= group for group in together):
                m.add(a[x] == a[y])
                m.add(b[x] == b[y])
                continue
            larger, apart = m.new_bool_var(""), max(ring["separation"][x], ring["separation"][y])
            m.add(size[x] - size[y] >= apart).only_enforce_if(larger)
            m.add(size[y] - size[x] >= apart).only_enforce_if(~larger)
    for x, y, to, back in ring["gaps"]:
        for t, u in ((a, b), (b, a)):
            first = m.new_bool_var("")
            m.add(t[y] - t[x] >= to).only_enforce_if(first)
            m.add(t[x] - t[y] >= back).only_enforce_if(~first)
            m.add(period + u[y] - t[x] >= to)
            m.add(period + u[x] - t[y] >= back)
    m.minimize(period)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    watch, done = Watch(), threading.Event()

    def stop_at_limit() -> None:
        while not done.wait(0.05):
            if watch.seconds() > limit:
                solver.stop_search()

    thread = threading.Thread(target=stop_at_limit)
    thread.start()
    status = solver.solve(m, watch)
    done.set()
    thread.join()
    bound = 0 if status == cp_model.INFEASIBLE else math.ceil(solver.best_objective_bound - 1e-6)
    return bound, watch.seconds(), watch.steps


def even(line: str) -> dict:
    """Return a ring of `cargo lab shortest-periods` in the form of `uneven-rings`."""
    layout, sensors, window, period, bound, _nodes, ms, _reason = line.split(" ", 7)
    count, gaps = int(sensors), []
    for x, y in itertools.combinations(range(count), 2):
        apart = min(y - x, count - (y - x)) if layout == "ring" else y - x
        gaps += [[x, y, 15, 15]] if apart < 4 else []
    needs = {"separation": [2] * count, "window": [int(window)] * count, "gaps": gaps}
    seconds = float(ms) / 1e3
    return needs | {"period": int(period), "bound": int(bound), "seconds": seconds, "steps": [[seconds, int(period)]]}


def race(rings: pathlib.Path, limit: float) -> None:
    """Let both solve each ring of a file."""
    logarithms = []
    for line in rings.read_text().splitlines():
        if line.startswith("#") or not (line.startswith("{") or line.split(" ")[1].isdecimal()):
            continue
        ring = json.loads(line) if line.startswith("{") else even(line)
        own, bound, spent = ring["steps"], ring["bound"], ring["seconds"]
        its_bound, its_spent, steps = cp_sat(ring, limit)
        assert its_bound <= ring["period"] and all(bound <= found for _, found in steps), (ring, steps)
        last, found = steps[-1] if steps else (its_spent, math.inf)
        soon = next((seconds for seconds, period in own if period <= found), spent)
        ratios = [max(its, 0.005) / max(ours, 0.005) for its, ours in ((last, soon), (its_spent, spent))]
        logarithms.append([math.log(ratio) for ratio in ratios])
        print(f"{len(ring['window'])} sensors:  {told(own, bound, spent)}  CP-SAT {told(steps, its_bound, its_spent)}", flush=True)
    for what, each in zip(("found", "proven or given up"), zip(*logarithms)):
        half = 1.96 * statistics.stdev(each) / math.sqrt(len(each)) if len(each) > 1 else math.inf
        low, mean, high = (math.exp(statistics.fmean(each) + by) for by in (-half, 0, half))
        print(f"CP-SAT, {what}: {mean:.1f} times as long ({low:.1f} to {high:.1f}), mean of {len(each)} rings")


def told(steps: Steps, bound: int, spent: float) -> str:
    seconds, period = steps[-1] if steps else (spent, 0)
    return f"{period} [{bound}] {spent if period == bound else seconds:.2f} s"


def draw(dice: random.Random) -> dict:
    """Draw a small ring's needs, with times in ticks."""
    sensors = dice.randint(2, 6)
    pairs = list(itertools.combinations(range(sensors), 2))

    def maybe(share: float, value):
        return value if dice.random() < share else []

    groups = maybe(0.4, [sorted(dice.sample(range(sensors), dice.randint(2, min(3, sensors))))])
    joined = [pair for pair in pairs if any(set(pair) <= set(group) for group in groups)]
    lines = maybe(0.5, [sorted(dice.sample(range(sensors), dice.randint(2, sensors)))])
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
    # A tolerance of t ticks less a microsecond: 2 t ticks are the smallest number above twice that; without one, one tick is.
    keys = {
        "sensors": ring["sensors"],
        "neighbours": ring["neighbours"],
        "layout": ring["layout"],
        "min_interval_us": ring["interval"] * TICK_US,
        "t_delta_us": [max(t * TICK_US - 1, 0) for t in ring["t_delta"]],
        "window_us": [window * TICK_US for window in ring["window"]],
        "intervals_us": [[x, y, interval * TICK_US] for (x, y), interval in ring["own"].items()],
        "shared_lines": ring["lines"],
        "together": ring["together"],
        "stale_echo": ring["stale_echo"],
        "tick_us": TICK_US,
    }
    return "\n".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())


def problem(ring: dict) -> dict:
    """Return the needs pair by pair."""
    gaps = []
    for x, y in itertools.combinations(range(ring["sensors"]), 2):
        apart = min(y - x, ring["sensors"] - (y - x)) if ring["layout"] == "ring" else y - x
        interval = ring["own"].get((x, y), ring["interval"] if apart < ring["neighbours"] else 0)
        shared = any(x in line and y in line for line in ring["lines"])
        to, back = (max(interval, ring["window"][z]) if shared else interval for z in (x, y))
        gaps += [[x, y, to, back]] if to or back else []
    separation = [max(2 * t, 1) for t in ring["t_delta"]]
    return {key: ring[key] for key in ("window", "together", "stale_echo")} | {"separation": separation, "gaps": gaps}


def small(program: str, rings: int, first: int, limit: float) -> None:
    """Compare the answers of `eeruf design` for random small rings with the peer's."""
    unknown = 0
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ring.toml"
        for seed in range(first, first + rings):
            ring = draw(random.Random(seed))
            file.write_text(ring_file(ring))
            design = [program, "design", "--period-only", "--json", str(file)]
            run = subprocess.run(design, capture_output=True, text=True, check=False)
            if run.returncode != 0:
                raise SystemExit(f"seed {seed}: {run.stdout}{run.stderr}\n{ring_file(ring)}")
            found = json.loads(run.stdout)
            bound, _, steps = cp_sat(problem(ring), limit)
            proven = bool(steps) and steps[-1][1] == bound
            unknown += not proven
            if proven and (not found["proven"] or found["value_us"] != bound * TICK_US):
                raise SystemExit(f"seed {seed}: CP-SAT proves {bound} ticks, eeruf says {found}\n{ring_file(ring)}")
    print(f"{rings - unknown} agree, {unknown} not proven by CP-SAT")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["race", "small"])
    parser.add_argument("of", help="the file of rings, or the built program eeruf")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a ring")
    parser.add_argument("--rings", type=int, default=300)
    parser.add_argument("--seed", type=int, default=20_000)
    args = parser.parse_args()
    if args.what == "race":
        race(pathlib.Path(args.of), args.limit)
    else:
        small(args.of, args.rings, args.seed, args.limit)


if __name__ == "__main__":
    main()

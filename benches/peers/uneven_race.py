"""The shortest period of rings of 16 to 32 sensors that differ: `eeruf-design`, OR-tools CP-SAT and Z3, a thread each.

    cargo lab uneven-rings 20 60 > target/uneven.jsonl
    python benches/peers/uneven_race.py target/uneven.jsonl [--limit 60] [--z3 4]

Both models are the definition (docs/reference/certificate.md, "The problem"). Seconds are those of a core. Prints a
line a ring: period, bound, and the seconds until that period was found, or until it was proven; then two geometric
means of ratios: of the times until the peer's last period or a shorter one was found, and of the times until the answer
was proven, a limit counting as the seconds spent; less than 5 ms counts as 5. Ends where two answers contradict each
other.
"""

import argparse
import json
import math
import pathlib
import threading
import time

import z3
from ortools.sat.python import cp_model


Steps = list[tuple[float, int]]


class Watch(cp_model.CpSolverSolutionCallback):
    """The periods found, each with the seconds until then."""

    def __init__(self) -> None:
        super().__init__()
        self.begin, self.steps = time.process_time(), []

    def seconds(self) -> float:
        return time.process_time() - self.begin

    def on_solution_callback(self) -> None:
        self.steps.append((self.seconds(), round(self.objective_value)))


def cp_sat(ring: dict, limit: float) -> tuple[int, float, Steps]:
    """Bound, seconds and steps of CP-SAT."""
    m, count = cp_model.CpModel(), len(ring["window"])
    most = 2 * sum(max(gap[2:]) for gap in ring["gaps"]) + max(ring["window"])
    period = m.new_int_var(1, most, "")
    a, b, size = ([m.new_int_var(0, most, "") for _ in range(count)] for _ in range(3))
    for x in range(count):
        m.add(a[x] < period)
        m.add(b[x] < period)
        m.add_abs_equality(size[x], a[x] - b[x])
        m.add(period - size[x] >= ring["window"][x])
        for y in range(x):
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
    solver.solve(m, watch)
    done.set()
    thread.join()
    return math.ceil(solver.best_objective_bound - 1e-6), watch.seconds(), watch.steps


def z3_opt(ring: dict, limit: float) -> tuple[int, float, Steps]:
    """Bound, seconds and steps of Z3, by a period below the last found until there is none."""
    solver, count = z3.Solver(), len(ring["window"])
    period = z3.Int("period")
    a, b = ([z3.Int(f"{phase}{x}") for x in range(count)] for phase in "ab")
    size = [z3.If(a[x] > b[x], a[x] - b[x], b[x] - a[x]) for x in range(count)]
    for x in range(count):
        solver.add(a[x] >= 0, b[x] >= 0, a[x] < period, b[x] < period, period - size[x] >= ring["window"][x])
        for y in range(x):
            apart = max(ring["separation"][x], ring["separation"][y])
            solver.add(z3.Or(size[x] - size[y] >= apart, size[y] - size[x] >= apart))
    for x, y, to, back in ring["gaps"]:
        for t, u in ((a, b), (b, a)):
            solver.add(z3.Or(t[y] - t[x] >= to, t[x] - t[y] >= back))
            solver.add(period + u[y] - t[x] >= to, period + u[x] - t[y] >= back)
    begin, steps = time.process_time(), []
    while (left := begin + limit - time.process_time()) > 0:
        solver.set("timeout", max(1, int(1000 * left)))
        status = solver.check()
        if status == z3.unsat:
            return steps[-1][1], time.process_time() - begin, steps
        if status == z3.sat:
            found = solver.model()[period].as_long()
            steps.append((time.process_time() - begin, found))
            solver.add(period < found)
    return 0, time.process_time() - begin, steps


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rings", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for each ring and solver")
    parser.add_argument("--z3", type=int, default=0, help="number of rings that Z3 gets too")
    args = parser.parse_args()
    rings = [json.loads(line) for line in args.rings.read_text().splitlines()]
    logarithms: dict[str, list[tuple[float, float]]] = {"CP-SAT": [], "Z3": []}
    for at, ring in enumerate(rings):
        own, bound, spent = ring["steps"], ring["bound"], ring["seconds"]
        print(f"{len(ring['window'])} sensors:  {told(own, bound, spent)}", end="", flush=True)
        for name, solve in [("CP-SAT", cp_sat), ("Z3", z3_opt)][: 2 if at < args.z3 else 1]:
            its_bound, its_spent, steps = solve(ring, args.limit)
            assert its_bound <= ring["period"] and all(bound <= found for _, found in steps), (ring, name, steps)
            last, found = steps[-1] if steps else (its_spent, math.inf)
            soon = next((seconds for seconds, period in own if period <= found), spent)
            ratios = [max(its, 0.005) / max(ours, 0.005) for its, ours in ((last, soon), (its_spent, spent))]
            logarithms[name].append((math.log(ratios[0]), math.log(ratios[1])))
            print(f"  {name} {told(steps, its_bound, its_spent)}, as short after {soon:.3f} s", end="", flush=True)
        print()
    for name, ratios in logarithms.items():
        for what, each in zip(("found", "proven or given up"), zip(*ratios)):
            print(f"{name}, {what}: {math.exp(sum(each) / len(each)):.1f} times as long, mean of {len(each)} rings")


def told(steps: Steps, bound: int, spent: float) -> str:
    seconds, period = steps[-1] if steps else (spent, 0)
    return f"{period} [{bound}] {spent if period == bound else seconds:.2f} s"


if __name__ == "__main__":
    main()

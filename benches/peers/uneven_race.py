"""The shortest period of rings of 16 to 32 sensors that differ: `eeruf-design`, OR-tools CP-SAT and Z3, a thread each.

    cargo lab uneven-rings 20 60 > target/uneven.jsonl
    python benches/peers/uneven_race.py target/uneven.jsonl [--limit 60]

Both models are the definition (docs/reference/certificate.md, "The problem"). Seconds are those of a core; who has not
proven an answer at the limit counts with the seconds that it had. Prints a line a ring and the geometric means of the
ratios. Ends where two answers contradict each other.
"""

import argparse
import json
import math
import pathlib
import time

import z3
from ortools.sat.python import cp_model


def cp_sat(ring: dict, limit: float) -> tuple[int, int, float]:
    """Period, bound and seconds of CP-SAT; a period of 0 where it has none."""
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
    solver.parameters.max_time_in_seconds = limit
    begin = time.process_time()
    status = solver.solve(m)
    found = round(solver.objective_value) if status in (cp_model.OPTIMAL, cp_model.FEASIBLE) else 0
    return found, math.ceil(solver.best_objective_bound - 1e-6), time.process_time() - begin


def z3_opt(ring: dict, limit: float) -> tuple[int, int, float]:
    """Period, bound and seconds of Z3, by a period below the last found until there is none."""
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
    begin, end, found = time.process_time(), time.monotonic() + limit, 0
    while (left := end - time.monotonic()) > 0:
        solver.set("timeout", max(1, int(1000 * left)))
        status = solver.check()
        if status == z3.unsat:
            return found, found, time.process_time() - begin
        if status != z3.sat:
            break
        found = solver.model()[period].as_long()
        solver.add(period < found)
    return found, 0, time.process_time() - begin


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rings", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for each ring and solver")
    args = parser.parse_args()
    peers = {"CP-SAT": cp_sat, "Z3": z3_opt}
    logarithms, proven = dict.fromkeys(peers, 0.0), dict.fromkeys(["eeruf", *peers], 0)
    rings = [json.loads(line) for line in args.rings.read_text().splitlines()]
    for ring in rings:
        own = [(ring["period"], ring["bound"], ring["seconds"])]
        proven["eeruf"] += ring["period"] == ring["bound"]
        for name, solve in peers.items():
            found, bound, seconds = solve(ring, args.limit)
            own.append((found, bound, seconds))
            proven[name] += found == bound > 0
            logarithms[name] += math.log(max(seconds, 0.001) / max(ring["seconds"], 0.001))
            assert bound <= ring["period"] and (found == 0 or ring["bound"] <= found), (ring, name, found, bound)
        print(f"{len(ring['window'])} sensors:", *(f"{f} [{b}] {s:.2f} s" for f, b, s in own), sep="  ", flush=True)
    for name, total in logarithms.items():
        print(f"{name}: {math.exp(total / len(rings)):.1f} times as long, geometric mean of {len(rings)}")
    print("proven:", proven)


if __name__ == "__main__":
    main()

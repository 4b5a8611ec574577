"""Counts of small wait-time problems by OR-tools CP-SAT, enumerating all solutions, next to eeruf's counting search.

    python -m venv VENV && VENV/bin/pip install ortools
    cargo build --release -p eeruf-core --example wait_count
    VENV/bin/python benches/peers/wait_cpsat.py [--largest COUNT] [--limit SECONDS]

Every case of tests/data/wait-tables.json up to `--largest` tables is solved by both in one run. The model is the strongest we know:
|d| and s are variables of their own, separated by intervals that may not overlap, and an enumeration runs on one worker (CP-SAT allows
no more). A run that reaches the limit counts as the limit, and the line says how many tables it had found.
"""

import argparse
import json
import pathlib
import subprocess
import time

from ortools.sat.python import cp_model

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Counter(cp_model.CpSolverSolutionCallback):
    """Counts solutions without reading them."""

    def __init__(self):
        super().__init__()
        self.count = 0

    def on_solution_callback(self):
        self.count += 1


def conflict(case, x, y):
    apart, n = abs(x - y), case["neighbours"]
    if case["layout"] == "blocks":
        return x // n == y // n
    if case["layout"] == "ring":
        apart = min(apart, case["sensors"] - apart)
    return apart < n


def build(case):
    """The model: waits a and b, |d|, s; a table is determined by a and b, so each is enumerated once."""
    model = cp_model.CpModel()
    sensors, period, wait_max = case["sensors"], case["period"], case["wait_max"]
    separation, interval = case["separation"], case["min_interval"]
    lag = [(i % case["group"]) * period // case["group"] for i in range(sensors)]
    a = [model.new_int_var(0, wait_max, f"a{i}") for i in range(sensors)]
    b = [model.new_int_var(0, wait_max, f"b{i}") for i in range(sensors)]
    size = [model.new_int_var(0, wait_max, f"d{i}") for i in range(sensors)]
    for i in range(sensors):
        model.add_abs_equality(size[i], a[i] - b[i])
    model.add_no_overlap([model.new_fixed_size_interval_var(size[i], separation, f"di{i}") for i in range(sensors)])
    if case["criterion"] == "paper":
        total = [model.new_int_var(0, 2 * wait_max, f"s{i}") for i in range(sensors)]
        for i in range(sensors):
            model.add(total[i] == a[i] + b[i])
        model.add_no_overlap(
            [model.new_fixed_size_interval_var(total[i], separation, f"si{i}") for i in range(sensors)]
        )
    for i in range(sensors):
        for j in range(i):
            if not conflict(case, i, j) or interval == 0:
                continue
            for phase, wait in enumerate((a, b)):
                difference = wait[i] + lag[i] - wait[j] - lag[j]
                least, most = lag[i] - lag[j] - wait_max, lag[i] - lag[j] + wait_max
                if least >= interval or most <= -interval:
                    continue
                model.add_linear_expression_in_domain(
                    difference,
                    cp_model.Domain.from_intervals([[least, -interval], [interval, most]])
                    if least <= -interval and most >= interval
                    else cp_model.Domain(interval, most)
                    if most >= interval
                    else cp_model.Domain(least, -interval)
                    if least <= -interval
                    else cp_model.Domain.from_values([]),
                )
            for x, y in ((i, j), (j, i)):
                model.add(period + b[y] + lag[y] - a[x] - lag[x] >= interval)
                model.add(period + a[y] + lag[y] - b[x] - lag[x] >= interval)
    return model


def enumerate_all(case, limit):
    solver = cp_model.CpSolver()
    solver.parameters.enumerate_all_solutions = True
    solver.parameters.num_workers = 1
    solver.parameters.max_time_in_seconds = limit
    counter = Counter()
    start = time.perf_counter()
    status = solver.solve(build(case), counter)
    return time.perf_counter() - start, counter.count, status in (cp_model.OPTIMAL, cp_model.INFEASIBLE)


def eeruf(case):
    """Seconds and count of eeruf's search, the least of its own repeated runs."""
    words = [
        case[key]
        for key in (
            "sensors",
            "period",
            "wait_max",
            "group",
            "separation",
            "min_interval",
            "neighbours",
            "criterion",
            "layout",
        )
    ]
    out = subprocess.run(
        [ROOT / "target/release/examples/wait_count", *map(str, words)], check=True, capture_output=True, text=True
    ).stdout.split()
    return float(out[1]), int(out[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--largest", type=int, default=2_000_000, help="leave out cases with more tables")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds for CP-SAT per case")
    options = parser.parse_args()
    for case in json.loads((ROOT / "tests/data/wait-tables.json").read_text())["cases"]:
        if case["count"] > options.largest:
            continue
        ours, count = eeruf(case)
        theirs, found, complete = enumerate_all(case, options.limit)
        assert count == case["count"], (count, case)
        assert not complete or found == count, (found, case)
        kind = "" if complete else f", stopped after {found} tables"
        print(
            f"{count:>9} tables: eeruf {ours * 1e3:8.3f} ms, CP-SAT {theirs:8.3f} s{kind}, ratio {theirs / ours:,.0f}",
            flush=True,
        )


if __name__ == "__main__":
    main()

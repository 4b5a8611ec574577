"""The shortest period by OR-tools CP-SAT, against `eeruf-core` in the same run.

    cargo build --release -p eeruf-core --example shortest_periods
    python benches/peers/design_cpsat.py target/release/examples/shortest_periods [--sensors 8,12] [--limit 300]

Prints one line per instance: both answers, both times and the ratio. A time-out counts as the limit. The model is the strongest we could write:
|d| and the sum of both times as variables of their own, an ordered chain of |d| by an assignment of ranks (channelled by `AddInverse` and
`AddElement`), the separation as disjoint intervals of length D, the firings as disjoint intervals of length I in each clique, time reversal
and ring rotation broken.
"""

import argparse
import subprocess
import time

from ortools.sat.python import cp_model


def conflict(layout: str, sensors: int, x: int, y: int, neighbours: int) -> bool:
    gap = abs(x - y)
    if layout == "ring":
        gap = min(gap, sensors - gap)
    return 0 < gap < neighbours


def model(layout: str, sensors: int, window: int, *, neighbours: int = 4, interval: int = 15, separation: int = 2):
    m = cp_model.CpModel()
    least = max(neighbours * interval if sensors >= neighbours else 1, window + separation * (sensors - 1))
    most = sensors * (interval + separation) + window
    period = m.new_int_var(least, most, "period")
    a = [m.new_int_var(0, most - 1, f"a{i}") for i in range(sensors)]
    b = [m.new_int_var(0, most - 1, f"b{i}") for i in range(sensors)]
    size = [m.new_int_var(0, most, f"size{i}") for i in range(sensors)]
    total = [m.new_int_var(0, 2 * most, f"s{i}") for i in range(sensors)]
    for i in range(sensors):
        m.add(a[i] < period)
        m.add(b[i] < period)
        m.add_abs_equality(size[i], a[i] - b[i])
        m.add(size[i] + window <= period)
        # |d| and s bound each other: both times lie within the period.
        m.add(total[i] == a[i] + b[i])
        m.add(total[i] >= size[i])
        m.add(total[i] + size[i] <= 2 * period - 2)
    # All |d| at least the separation apart: disjoint intervals of that length, and ranks.
    m.add_no_overlap([m.new_fixed_size_interval_var(size[i], separation, f"size interval {i}") for i in range(sensors)])
    rank = [m.new_int_var(0, sensors - 1, f"rank{i}") for i in range(sensors)]
    holder = [m.new_int_var(0, sensors - 1, f"holder{r}") for r in range(sensors)]
    ordered = [m.new_int_var(separation * r, most, f"ordered{r}") for r in range(sensors)]
    m.add_inverse(rank, holder)
    for r in range(sensors):
        m.add_element(holder[r], size, ordered[r])
        m.add(ordered[r] + window + separation * (sensors - 1 - r) <= period)
        if r:
            m.add(ordered[r] >= ordered[r - 1] + separation)
    for i in range(sensors):
        m.add(size[i] >= separation * rank[i])
        m.add_element(rank[i], ordered, size[i])
    # Firings in each maximal clique, and across the ends of the phases.
    firing = {
        (phase, i): m.new_fixed_size_interval_var(times[i], interval, f"{phase}{i} interval")
        for phase, times in (("a", a), ("b", b))
        for i in range(sensors)
    }
    starts = range(sensors) if layout == "ring" else range(max(1, sensors - neighbours + 1))
    for first in starts:
        clique = sorted({(first + j) % sensors for j in range(min(neighbours, sensors))})
        for phase in "ab":
            m.add_no_overlap([firing[phase, i] for i in clique])
    for x in range(sensors):
        for y in range(sensors):
            if conflict(layout, sensors, x, y, neighbours):
                m.add(period + b[y] - a[x] >= interval)
                m.add(period + a[y] - b[x] >= interval)
    # Symmetry: exchanging the phases negates d; a ring may be turned.
    m.add(a[0] >= b[0])
    if layout == "ring":
        m.add(rank[0] == sensors - 1)
    m.minimize(period)
    return m


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the built example shortest_periods")
    parser.add_argument("--sensors", default="8,12,16,24")
    parser.add_argument("--layouts", default="line,ring")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds per instance")
    parser.add_argument("--workers", type=int, default=2)
    args = parser.parse_args()
    output = subprocess.run(
        [args.program, "1", "2", args.sensors, "4", args.layouts], check=True, capture_output=True, text=True
    ).stdout
    product, count = 1.0, 0
    print("layout sensors window | eeruf period bound ms | CP-SAT period bound s status | times faster")
    for line in output.splitlines()[1:]:
        if line.startswith("#"):
            continue
        layout, sensors, window, period, bound, _nodes, ms, _reason = line.split(" ", 7)
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = args.workers
        solver.parameters.max_time_in_seconds = args.limit
        begin = time.perf_counter()
        status = solver.solve(model(layout, int(sensors), int(window)))
        seconds = args.limit if status != cp_model.OPTIMAL else time.perf_counter() - begin
        found = solver.objective_value if status in (cp_model.OPTIMAL, cp_model.FEASIBLE) else float("nan")
        if status == cp_model.OPTIMAL and int(found) != int(period):
            raise SystemExit(f"{line}: CP-SAT proves {found:.0f}")
        ratio = 1e3 * seconds / float(ms)
        product, count = product * ratio, count + 1
        print(
            f"{layout} {sensors} {window} | {period} {bound} {ms} | {found:.0f} {solver.best_objective_bound:.0f} {seconds:.2f}"
            f" {solver.status_name(status)} | {ratio:.0f}",
            flush=True,
        )
    if count:
        print(f"geometric mean of {count}: {product ** (1 / count):.0f} times faster")


if __name__ == "__main__":
    main()

"""Replay bags of `write_bags.py`, and print speed and memory: a row for each kind of bag.

    python replay_bags.py EERUF SMALL LARGE MESSAGES

SMALL and LARGE are folders of bags; MESSAGES is the number of ranges in each bag of LARGE. Processor time is that of
the whole run of the program; memory is its peak, for a bag of SMALL and one of LARGE. The exit code is 1 if the count
is wrong, fewer than 500,000 messages a second are read, or the larger bag needs 4 MB more.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

LEAST_PER_S = 500_000
MOST_MORE_MB = 4.0


def replay(program: str, bag: Path) -> tuple[int, float, float]:
    """Return the program's count of messages, its processor time in s, and its memory in MB."""
    with tempfile.TemporaryFile() as said:
        command = [program, "replay", str(bag), "--t-delta-us", "500", "--json"]
        process = subprocess.Popen(command, stdout=said, stderr=subprocess.PIPE, text=True)
        errors = process.stderr.read()
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        assert process.returncode == 0, f"{bag}: {errors}"
        said.seek(0)
        total = json.load(said)["total"]
    kinds = ["accepted", "rejected", "repeated", "first", "no_echo", "clear", "too_early", "invalid"]
    return sum(total.get(kind, 0) for kind in kinds), used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def main() -> int:
    program, small, large, messages = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), int(sys.argv[4])
    print("| bag | messages | messages a second, millions | MB | MB, a tenth of the messages |\n|---|---:|---:|---:|---:|")
    wrong = []
    for bag in sorted(large.iterdir()):
        _, _, less_mb = replay(program, small / bag.name)
        # From the second time on, the file is in the machine's memory.
        replay(program, bag)
        counted, seconds, mb = replay(program, bag)
        print(f"| {bag.name} | {counted} | {counted / seconds / 1e6:.1f} | {mb:.1f} | {less_mb:.1f} |", flush=True)
        if counted < messages or counted > messages + 8:
            wrong.append(f"{bag.name}: {counted} messages; expected {messages}")
        if counted / seconds < LEAST_PER_S:
            wrong.append(f"{bag.name}: {counted / seconds:.0f} messages a second; expected {LEAST_PER_S} or more")
        if mb > less_mb + MOST_MORE_MB:
            wrong.append(f"{bag.name}: {mb:.1f} MB, and {less_mb:.1f} for a tenth; expected no growth")
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

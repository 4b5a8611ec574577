"""Replays bags that `write_bags.py` wrote, and prints how fast and in how much memory: a row for each kind of bag.

    python replay_bags.py EERUF SMALL LARGE MESSAGES

SMALL and LARGE are folders of bags; MESSAGES is how many ranges each of LARGE holds. Processor time is that of the
program, from its start to its end; memory is the most that it had, for a bag of SMALL and one of LARGE. Ends with 1
if the program counts otherwise, reads fewer than 500,000 messages a second, or needs 4 MB more for the larger bag.
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
    """Return its count of messages, processor time in s, and memory in MB."""
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
        # The second time it is in the memory of the machine.
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

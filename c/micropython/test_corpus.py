"""Compares eeruf.py over the corpus with what the Rust crate eeruf-core says: python3 test_corpus.py [corpus.txt].

Without a file it takes the lines that the repository keeps. It runs under MicroPython too. What the lines mean stands in
crates/eeruf-core/tests/all/corpus.rs."""

import sys

from eeruf import HISTORY, READING, Ring
from eeruf_flow import Flow, FlowRing
from eeruf_schedule import Schedule

NONE = 0xFFFFFFFF
LAYOUTS = ("line", "ring", "blocks")
KINDS = ("unknown", "obstacle", "clear", "too_close", "unanswered")
WHYS = ("no_firing", "unsure", "rejected", "ambiguous", "no_witness")


def flat(event):
    """An event as the corpus has it."""
    if event is None:
        return []
    if event[0] == READING:
        explained_by = 255 if event[8] is None else 254 if event[8] == HISTORY else event[8]
        return [NONE if number is None else number for number in event[:8]] + [explained_by]
    if event[0] == 0:
        return list(event)
    return list(event[:5]) + event[5]


def check(lines):
    """Number of events that were compared."""
    count = rings = 0
    change = None
    for number, line in enumerate(lines, 1):
        words = line.split()
        what = words[0]
        if what == "#":
            continue
        n = [int(word) for word in words[1:]]
        if what == "P":
            event = flat(ring.poll(n[0], change))  # noqa: F821
            said = [ring.deadline()] + event  # noqa: F821
            if said != n[1:]:
                raise AssertionError("line %d: %r, not %r" % (number, said, n[1:]))
            count += len(event) > 0
        elif what == "O":
            kind, t_echo, age, why, by = ring.state(n[0], n[1])  # noqa: F821
            said = [KINDS.index(kind), NONE if t_echo is None else t_echo, age, 0 if why is None else WHYS.index(why)]
            said.append(255 if by is None else 254 if by == HISTORY else by)
            if said != n[2:]:
                raise AssertionError("line %d: %r, not %r" % (number, said, n[2:]))
        elif what == "E":
            ring.echo(n[0], n[1])  # noqa: F821
        elif what == "K":
            ring.stuck(n[0])  # noqa: F821
        elif what == "F":
            ring.fired(n[0], n[1])  # noqa: F821
        elif what == "N":
            ring.enable(n[0], n[1] == 1)  # noqa: F821
        elif what == "C":
            ring.set_path_change(n[0])  # noqa: F821
        elif what == "A":
            ring.set_audible(n[0])  # noqa: F821
        elif what == "R":
            ring.restart(n[0])  # noqa: F821
        elif what == "M":
            change = n
        elif what == "Z":
            ring.pause(n[0] == 1)  # noqa: F821
        elif what == "B":
            ring.forget(n[0])  # noqa: F821
        elif what == "G":
            ring.silence = n[0]  # noqa: F821
        elif what == "Y":
            ring.answered(n[0], n[1] == 1)  # noqa: F821
        elif what == "Q":
            said = ring.quiet_us(n[0])  # noqa: F821
            if list(said) != n[1:]:
                raise AssertionError("line %d: quiet %r, not %r" % (number, said, n[1:]))
        elif what == "U":
            said = [number for firing in ring.upcoming() for number in firing]  # noqa: F821
            if said != n:
                raise AssertionError("line %d: upcoming %r, not %r" % (number, said, n))
        elif what == "W":
            ring = FlowRing(Flow(*n[:-1]), n[-1])
            change = None
            rings += 1
        elif what == "S":
            sensors = (len(n) - 2) // n[1]
            schedule = Schedule(n[0], [n[2 + m * sensors : 2 + (m + 1) * sensors] for m in range(n[1])])
        elif what == "V":
            try:
                schedule.verify(n[0], n[1], n[2], n[3], LAYOUTS[n[4]], n[5] == 1)
                verified = [schedule.separation_us, schedule.window_us]
            except ValueError:
                verified = [0, 0]
            if verified != n[6:]:
                raise AssertionError("line %d: verified %r, not %r" % (number, verified, n[6:]))
        elif what == "L":
            path_change, audible = [None if number == NONE else number for number in n[4:6]]
            ring = Ring(
                schedule, n[6], n[0], n[1], n[2], n[3],
                unverified=True, path_change_us=path_change, audible_us=audible,
            )  # fmt: skip
            rings += 1
        else:
            raise AssertionError("line %d: %r" % (number, line))
    return rings, count


def main(text):
    lines = text.strip().split("\n")
    rings, count = check(lines)
    if count < len(lines) // 5:
        raise AssertionError("only %d events in %d lines" % (count, len(lines)))
    print("%d rings, %d events without a difference" % (rings, count))


if __name__ == "__main__":
    with open(sys.argv[1] if len(sys.argv) > 1 else "../../tests/data/ring-golden.txt") as corpus:
        main(corpus.read())

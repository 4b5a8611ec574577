"""Compare eeruf.py with the Rust crate eeruf-core over the corpus: python3 test_corpus.py [corpus.txt].

Without a file it uses the lines that the repository keeps. It runs under MicroPython too. The lines are described in
crates/eeruf-core/tests/all/corpus.rs, for flow rings in corpus/flow.rs; rings that fire by a table are left out."""

import sys

from eeruf import HISTORY, READING, Flow, FlowRing

NONE = 0xFFFFFFFF
KINDS = ("unknown", "obstacle", "clear", "too_close", "unanswered")
WHYS = ("no_firing", "unsure", "rejected", "ambiguous", "no_witness")


def number(it):
    return NONE if it is None else it


def explanation(by):
    return 255 if by is None else 254 if by == HISTORY else by


def flat(event):
    """Return an event in the form of the corpus."""
    if event is None:
        return []
    if event[0] == READING:
        return [number(it) for it in event[:8]] + [explanation(event[8])]
    return list(event)


def play(ring, what, n):
    """Perform a line of the corpus on a ring; return (actual result, expected result)."""
    if what == "P":
        event = flat(ring.poll(n[0]))
        # At the end of a round it does not report lateness.
        return [ring.deadline()] + event, n[1:5] if event[:1] == [2] else n[1:]
    if what == "O":
        kind, t_echo, age, why, by = ring.state(n[0], n[1])
        return [KINDS.index(kind), number(t_echo), age, WHYS.index(why or "no_firing"), explanation(by)], n[2:]
    if what == "Q":
        return [ring.quiet_us(n[0]), number(ring.believed_us(n[0]))], n[1:]
    if what == "U":
        return [it for firing in ring.upcoming() for it in firing], n
    if what == "H":
        ring.measured(n[0], None if n[1] == NONE else n[1])
    elif what == "G":
        ring.silence = n[0]
    else:
        calls = {"E": "echo", "K": "stuck", "F": "fired", "R": "restart", "D": "moving", "B": "forget", "N": "enable"}
        calls.update({"I": "echo", "M": "measured", "Y": "answered", "Z": "pause"})
        getattr(ring, calls[what])(*n)
    return None, None


def check(lines):
    """Return the numbers of rings and events compared."""
    rings = count = 0
    ring = None
    for at, line in enumerate(lines, 1):
        words = line.split()
        n = [int(word) for word in words[1:]] if words[0] != "#" else words[1:]
        if words[0] == "#":
            ring = None
        elif words[0] == "W":
            ring = FlowRing(Flow(*n[:-1]), n[-1])
            rings += 1
        elif ring is not None:
            said, expected = play(ring, words[0], n)
            if said != expected:
                raise AssertionError("line %d: %r: %r" % (at, line, said))
            count += words[0] == "P" and len(n) > 2
    return rings, count


def main(text):
    rings, count = check(text.strip().split("\n"))
    if rings < 2 or count < 2 * rings:
        raise AssertionError("only %d events of %d rings" % (count, rings))
    print("%d rings, %d events without a difference" % (rings, count))


if __name__ == "__main__":
    with open(sys.argv[1] if len(sys.argv) > 1 else "../../tests/data/ring-golden.txt") as corpus:
        main(corpus.read())

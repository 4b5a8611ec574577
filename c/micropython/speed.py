"""Speed and memory of eeruf.py on the board that runs this: copy it there with eeruf.py, then `import speed; speed.main()`.

No module needs to be connected: the ring is told of each echo when it fires. README.md has what it prints.
"""

import gc
import time

gc.collect()
_before = gc.mem_alloc()
import eeruf  # noqa: E402

gc.collect()
MODULE = gc.mem_alloc() - _before

CLOCK_BITS = 30
MASK = (1 << CLOCK_BITS) - 1  # a larger number would be allocated
FIRINGS = 60  # of each sensor


def ring(sensors):
    """Prints the bytes of a ring, then time and allocation of its polls by what they return."""
    gc.collect()
    before = gc.mem_alloc()
    ring = eeruf.FlowRing(eeruf.Flow(sensors, 25000, seed=1), time.ticks_us(), CLOCK_BITS)
    gc.collect()
    print("%d sensors: %d bytes" % (sensors, gc.mem_alloc() - before))
    polls, kinds, fired = {}, [0] * len(eeruf.READING_NAMES), 0
    while fired < FIRINGS * sensors:
        gc.collect()
        before, now = gc.mem_alloc(), time.ticks_us()
        event = ring.poll(now)
        took, size = time.ticks_diff(time.ticks_us(), now), gc.mem_alloc() - before
        what = -1 if event is None else event[0]
        count, total, longest, largest = polls.get(what, (0, 0, 0, 0))
        polls[what] = count + 1, total + took, max(longest, took), max(largest, size)
        if what == eeruf.FIRE:
            fired += 1
            ring.echo(event[1], now + 3000 + 1500 * event[1] & MASK)
        elif what == eeruf.READING:
            kinds[event[eeruf.KIND]] += 1
    for what in sorted(polls):
        name = ("nothing", "a firing", "a reading", "a round")[what + 1]
        count, total, longest, largest = polls[what]
        print("  poll with %s: %d us, at most %d us and %d bytes" % (name, total // count, longest, largest))
    print("  %d of %d accepted" % (kinds[eeruf.ACCEPTED], sum(kinds)))


def main():
    """Measures rings of 3, 8 and 12 modules."""
    print("eeruf.py: %d bytes" % MODULE)
    for sensors in (3, 8, 12):
        ring(sensors)


if __name__ == "__main__":
    main()

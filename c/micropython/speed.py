"""Speed of eeruf.py on the board that runs this: copy it there with eeruf.py and eeruf_schedule.py, then
`import speed; speed.main()`.

Rings of 3, 8 and 12 modules by the ready tables of the Arduino library, each module before its own wall. No module needs
to be connected: simulated ones answer, in Python. README.md has a table of what it prints.
"""

import gc
import time

from eeruf import ACCEPTED, FIRE, FIRST, KIND, PERIOD, READING_NAMES, SENSOR, HcSr04Ring, Ring
from eeruf_schedule import Schedule

# T_p, phases a and b, T_delta, the number of adjacent modules that are kept apart.
TABLES = (
    (62000, ((2000, 22000, 42000), (0, 22000, 43000)), 387, 3),
    (67000, ((0, 17000, 34000, 51000, 1000, 18000, 35000, 52000), (0, 15000, 30000, 45000) * 2), 416, 4),
    (
        71000,
        ((0, 18000, 36000, 54000, 1000, 19000, 37000, 55000, 2000, 20000, 38000, 56000), (0, 15000, 30000, 45000) * 3),
        439,
        4,
    ),
)
PERIODS, LEFT_OUT = 30, 2  # the first two have nothing to compare with
CLOCK_BITS = 30
MASK = (1 << CLOCK_BITS) - 1  # a larger number would be allocated


def verified(table):
    """Returns the schedule of a table."""
    period_us, t_fire_us, t_delta_us, neighbours = table
    return Schedule(period_us, t_fire_us).verify(t_delta_us, 14569, 60000, neighbours)


def wall_us(x):
    """Returns the echo time of a module's wall."""
    return 3000 + 1500 * x


class Times:
    """Number, mean and extremes of times."""

    def __init__(self):
        self.count, self.total, self.least, self.most = 0, 0, 1 << 30, 0

    def add(self, us):
        """Adds one."""
        self.count, self.total = self.count + 1, self.total + us
        self.least, self.most = min(self.least, us), max(self.most, us)

    def __str__(self):
        return "%d of %d to %d us, mean %d" % (self.count, self.least, self.most, self.total // max(self.count, 1))


class Pin:
    """`machine.Pin`: a module that answers after 450 us with a pulse as long as its echo took."""

    IN, OUT = 0, 1
    fired = None  # the module that fired last

    def __init__(self, number):
        self.number, self.level, self.fired_us = number, 0, None

    def init(self, mode, value=None):
        """Sets the direction."""
        if value is not None:
            self.level = value

    def value(self, level=None):
        """Returns the level of an input, or sets that of an output."""
        if level is None:
            if self.fired_us is None:
                return 0
            return int(450 <= time.ticks_diff(time.ticks_us(), self.fired_us) < 450 + wall_us(self.number))
        if self.level and not level:
            self.fired_us, Pin.fired = time.ticks_us(), self
        self.level = level


class Machine:
    """`machine`."""

    Pin = Pin


def tell(name, kinds):
    """Prints the number of readings of each kind."""
    named = ["%d %s" % (count, kind) for count, kind in zip(kinds, READING_NAMES) if count]
    print("  %s: %d of %d accepted (%s)" % (name, kinds[ACCEPTED], sum(kinds), ", ".join(named)))


def ring(table, searched, first, **config):
    """A ring that is told of each echo when it fires."""
    ticks_us, ticks_diff = time.ticks_us, time.ticks_diff
    gc.collect()
    ring = Ring(verified(table), ticks_us(), clock_bits=CLOCK_BITS, **config)
    kinds, periods = [0] * len(READING_NAMES), 0
    while periods < PERIODS:
        searches = ring._watched
        now = ticks_us()
        event = ring.poll(now)
        took = ticks_diff(ticks_us(), now)
        if event is None:
            continue
        if event[0] == FIRE:
            ring.echo(event[1], now + wall_us(event[1]) & MASK)
        elif event[0] == PERIOD:
            periods += 1
        else:
            if periods >= LEFT_OUT:
                kinds[event[KIND]] += 1
            if event[KIND] == ACCEPTED and searches:
                searched.add(took)
            elif event[KIND] == FIRST:
                first.add(took)
    tell("Ring(%r)" % config, kinds)


def modules(table, delays=None, **config):
    """A ring that samples the lines of its modules; if asked, how long after a firing's instant its trigger comes."""
    gc.collect()
    sensors = len(table[1][0])
    ring = HcSr04Ring(verified(table), list(range(sensors)), machine=Machine, **config)
    kinds, seen, loops = [0] * len(READING_NAMES), [0] * sensors, 0
    start = time.ticks_us()
    while min(seen) < PERIODS:
        reading = ring.read()
        loops += 1
        if delays is not None and Pin.fired is not None:
            pin, Pin.fired = Pin.fired, None
            delays.add(time.ticks_diff(pin.fired_us, ring.ring._sensors[pin.number].firings[0]))
        if reading is not None:
            x = reading[SENSOR]
            seen[x] += 1
            if seen[x] > LEFT_OUT:
                kinds[reading[KIND]] += 1
    took = time.ticks_diff(time.ticks_us(), start)
    if delays is None:
        tell("HcSr04Ring(%r), %d us a loop" % (config, took // loops), kinds)


def allocated(table):
    """Returns the bytes that the calls of a period allocate."""
    ring = Ring(verified(table), 0, clock_bits=CLOCK_BITS)
    gc.collect()
    gc.disable()
    periods = before = 0
    while periods < 8:
        now = ring.deadline()
        event = ring.poll(now)
        if event is not None and event[0] == FIRE:
            ring.echo(event[1], now + wall_us(event[1]) & MASK)
        elif event is not None and event[0] == PERIOD:
            periods += 1
            if periods == 4:
                before = gc.mem_alloc()
    took = (gc.mem_alloc() - before) // 4
    gc.enable()
    return took


def main():
    """Measures all tables."""
    for table in TABLES:
        print("%d sensors: %d bytes a period" % (len(table[1][0]), allocated(table)))
        searched, first = Times(), Times()
        ring(table, searched, first)
        ring(table, searched, first, path_change_us=100)
        print("    poll with a reading: searched and accepted %s; first %s" % (searched, first))
        modules(table)
        modules(table, path_change_us=100)
        delays = Times()
        modules(table, delays)
        print("    triggers come after their firings' instants: %s" % delays)


if __name__ == "__main__":
    main()

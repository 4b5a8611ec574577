"""HcSr04Ring on simulated modules, whose clock has 30 bits and wraps, as on most boards."""

from eeruf import ACCEPTED, FIRST, KIND, REJECTED, SENSOR, STUCK, T_ECHO, HcSr04Ring, Ring, Schedule

PERIOD = 1 << 30


class Clock:
    """`time`, which goes on by some microseconds each time it is asked."""

    def __init__(self, start):
        self.now = start

    def ticks_us(self):
        self.now += 7
        return self.now % PERIOD

    def ticks_diff(self, one, other):
        return (one - other + PERIOD // 2) % PERIOD - PERIOD // 2

    def ticks_add(self, ticks, more):
        return (ticks + more) % PERIOD

    def sleep_us(self, us):
        self.now += us


class Machine:
    """`machine`: each pin a module that answers after 450 us with a pulse as long as its echo took."""

    def __init__(self, clock, echo_us, high):
        machine = self

        class Pin:
            IN, OUT = 0, 1

            def __init__(self, number):
                self.number, self.mode, self.level, self.fired = number, 0, 0, None

            def init(self, mode, value=None):
                self.mode = mode
                if value is not None:
                    self.level = value

            def value(self, level=None):
                if level is None:
                    if self.number in high:
                        return 1
                    if self.fired is None:
                        return 0
                    return int(450 <= clock.now - self.fired < 450 + echo_us[self.number])
                if self.mode != self.OUT:
                    raise AssertionError("pin %d is written as an input" % self.number)
                if self.level and not level:
                    self.fired = clock.now
                    machine.firings[self.number] = machine.firings.get(self.number, 0) + 1
                self.level = level

        self.Pin = Pin
        self.firings = {}


def run(start, high):
    clock, echo_us = Clock(start), {4: 1200, 5: 5800, 6: 23000}
    machine = Machine(clock, echo_us, high)
    schedule = Schedule(62000, [[2000, 22000, 42000], [0, 22000, 43000]]).verify(387, 14569, 60000, 3)
    ring = HcSr04Ring(schedule, [4, 5, 6], machine=machine, time=clock)
    accepted, stuck = [0, 0, 0], [0, 0, 0]
    while clock.now - start < 2000000:
        reading = ring.read()
        if reading is None:
            continue
        x = reading[SENSOR]
        if reading[KIND] == ACCEPTED:
            accepted[x] += 1
            off = abs(reading[T_ECHO] - echo_us[4 + x])
            if off > 60:
                raise AssertionError("sensor %d reads %d us too far or too near" % (x, off))
        stuck[x] += reading[KIND] == STUCK
    return machine.firings, accepted, stuck


def border():
    """Two readings agree up to t_delta, and not beyond (Eq. 11)."""
    ring = Ring(Schedule(62000, [[2000], [0]]).verify(387), 0)
    kinds, echoes = [], [5000, 5387, 5775, 5388]
    while len(kinds) < len(echoes):
        now = ring.deadline()
        event = ring.poll(now)
        if event and event[0] == 0:
            ring.echo(0, now + echoes[len(kinds)])
        elif event and event[0] == 1:
            kinds.append(event[KIND])
    if kinds != [FIRST, ACCEPTED, REJECTED, ACCEPTED]:
        raise AssertionError("t_delta: %r" % kinds)


def main():
    border()
    for start in (0, PERIOD - 1000000):
        firings, accepted, stuck = run(start, ())
        # 32 periods in two seconds; the first echo has nothing to agree with.
        if min(firings.values()) < 31 or min(accepted) < 29 or max(stuck) > 0:
            raise AssertionError("%r fired, %r accepted, %r stuck" % (firings, accepted, stuck))
        firings, accepted, stuck = run(start, (5,))
        if 5 in firings or stuck[1] < 30 or accepted[1] > 0 or accepted[0] < 29:
            raise AssertionError("%r fired, %r accepted, %r stuck" % (firings, accepted, stuck))
    print("modules: echoes within 60 us, a stuck line is left alone")


if __name__ == "__main__":
    main()

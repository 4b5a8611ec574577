"""HcSr04Ring on simulated modules, whose clock has 30 bits and wraps, as on most boards."""

from eeruf import (
    ACCEPTED, AGE, AMBIGUOUS, CLEAR, EXPLAINED_BY, FIRST, HISTORY, KIND, NEEDS_ANSWER, REJECTED, SENSOR, STUCK, T_ECHO, UNANSWERED,
    HcSr04Ring, Ring,
)  # fmt: skip
from eeruf_flow import Flow, FlowRing, HcSr04FlowRing
from eeruf_schedule import Schedule

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

    def __init__(self, clock, echo_us, high, cut=()):
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
                    if self.fired is None or self.number in cut:
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


def silence():
    """A cut wire is no free space; a module that holds its line for 38 ms has nothing in range."""
    clock = Clock(0)
    machine = Machine(clock, {4: 1200, 5: 1200, 6: 38000}, (), cut=(5,))
    schedule = Schedule(62000, [[2000, 22000, 42000], [0, 22000, 43000]]).verify(387, 14569, 60000, 3)
    ring = HcSr04Ring(schedule, [4, 5, 6], machine=machine, time=clock)
    kinds = [[], [], []]
    while clock.now < 2000000:
        reading = ring.read()
        if reading is not None:
            kinds[reading[SENSOR]].append(reading[KIND])
    if set(kinds[1]) != {UNANSWERED} or set(kinds[2][1:]) != {CLEAR} or set(kinds[0][1:]) != {ACCEPTED}:
        raise AssertionError("silence: %r" % kinds)


def triggers():
    """A firing counts from its trigger, however long the lines took to ask before it."""
    clock = Clock(0)
    machine = Machine(clock, {4: 1200, 5: 5800, 6: 23000}, ())
    value = machine.Pin.value

    def slowly(pin, level=None):
        clock.now += 100
        return value(pin, level)

    machine.Pin.value = slowly
    schedule = Schedule(62000, [[2000, 22000, 42000], [0, 22000, 43000]]).verify(387, 14569, 60000, 3)
    ring = HcSr04Ring(schedule, [4, 5, 6], machine=machine, time=clock)
    triggered = [None, None, None]
    while clock.now < 2000000:
        ring.read()
        for x, pin in enumerate(ring._triggers):
            if pin.fired != triggered[x]:
                triggered[x] = pin.fired
                off = clock.ticks_diff(ring.ring._sensors[x].firings[0], pin.fired % PERIOD)
                if not 0 <= off <= 20:
                    raise AssertionError("module %d: its firing counts from %d us after its trigger" % (x, off))
    if None in triggered:
        raise AssertionError("triggers: %r" % triggered)


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


def readings(ring, count, correct_us=0):
    """The next readings, where each sensor sees a wall after 9 ms and fires this much later than it is polled for."""
    found = []
    while len(found) < count:
        now = ring.deadline()
        event = ring.poll(now)
        if event and event[0] == 0:
            fired = (now + correct_us) % PERIOD
            ring.fired(event[1], fired)
            ring.echo(event[1], (fired + 9000) % PERIOD)
        elif event and event[0] == 1:
            found.append(event)
    return found


def ambiguous():
    """Readings that other sound explains do not count; a ring that restarts knows no firings from before."""
    lags = [0, 20000, 40000]
    constant = Schedule(62000, [lags, lags])
    ring = Ring(constant, PERIOD - 500000, 387, 60000, clock_bits=30, unverified=True)
    for reading in readings(ring, 30)[9:]:
        if (reading[KIND], reading[EXPLAINED_BY]) != (AMBIGUOUS, 1 if reading[SENSOR] == 0 else 0):
            raise AssertionError("constant waits: %r" % (reading,))
    varied = Schedule(62000, [[2000, 22000, 42000], [0, 22000, 43000]]).verify(387)
    for correct_us in (-300, 0, 300):
        ring = Ring(varied, PERIOD - 500000, clock_bits=30, path_change_us=100, audible_us=55000)
        for reading in readings(ring, 30, correct_us)[6:]:
            if reading[KIND:AGE] != (ACCEPTED, 9000, 9000):
                raise AssertionError("fired %d us later: %r" % (correct_us, reading))
    ring = Ring(varied, 0, clock_bits=30, audible_us=120000)
    readings(ring, 12)
    ring.restart(ring.deadline())
    for reading in readings(ring, 6)[3:]:
        if (reading[KIND], reading[EXPLAINED_BY]) != (AMBIGUOUS, HISTORY):
            raise AssertionError("after a restart: %r" % (reading,))


def odometry():
    """On time too, crosstalk that changes as odometry expects is not accepted, and a wall that does is."""
    fires = [[2000, 22000, 42000], [0, 22000, 43000]]
    for path_us, emitter in ((45000, 1), (9000, 2)):
        ring, period, echo_us, change_us, kinds = Ring(Schedule(62000, fires).verify(387), 0), 0, None, [0, 0, 0], []
        while len(kinds) < 30:
            now = ring.deadline()
            event = ring.poll(now, change_us)
            if event and event[0] == 0 and event[1] == 2:
                # The wall moves by 250 us a period.
                own = 62000 * period + fires[period % 2][emitter] + path_us - (250 * period if emitter == 2 else 0) - now
                change_us[2] = 0 if echo_us is None else own - echo_us
                echo_us = own
                ring.echo(2, now + own)
            elif event and event[0] == 1 and event[SENSOR] == 2:
                kinds.append(event[KIND])
            period += event is not None and event[0] == 2
        if set(kinds[1:]) != {AMBIGUOUS if emitter == 1 else ACCEPTED}:
            raise AssertionError("odometry, sound of sensor %d: %r" % (emitter, kinds))


def timed():
    """Hardware fires eight modules at the instants of `upcoming` and reports pulses, while the loop takes up to 5 ms, and
    longer where it has a reading: at least 95 % of own walls are accepted, one cut wire and one free space aside."""
    a = [0, 17000, 34000, 51000, 1000, 18000, 35000, 52000]
    b = [0, 15000, 30000, 45000, 0, 15000, 30000, 45000]
    seed, now, end = 20000, PERIOD - 3000000, 20000000
    ring = Ring(Schedule(67000, [a, b]).verify(416, 14569, 60000, 4), now, clock_bits=30, window_us=45000)
    ring.silence, ring.report_after_us = NEEDS_ANSWER, 60000
    reports, kinds, spent = [], [[] for _ in a], 0
    while spent < end:
        seed = (1103515245 * seed + 12345) % (1 << 31)
        step = (seed >> 8) % 5000
        spent += step
        now = (now + step) % PERIOD
        while True:
            fires = None
            for fires in ring.upcoming():
                break
            if fires and (now - fires[1]) % PERIOD >= PERIOD // 2:
                fires = None
            at = fires[1] if fires else now
            for report in [report for report in reports if (at - report[0]) % PERIOD < PERIOD // 2]:
                reports.remove(report)
                ring.measured(report[1], report[2])
            while True:
                event = ring.poll(at)
                if event is None:
                    break
                if event[0] == 0:
                    x, t_echo = event[1], 3000 + 3500 * event[1] + (seed >> 9) % 30
                    if x == 6:
                        t_echo = None
                    if x != 7:
                        reports.append(((at + 1000 + (t_echo or 38000)) % PERIOD, x, t_echo))
                elif event[0] == 1:
                    kinds[event[SENSOR]].append(event[KIND])
                    spent += 1500
                    now = (now + 1500) % PERIOD
            if not fires:
                break
    for x, kind in enumerate((ACCEPTED,) * 6 + (CLEAR, UNANSWERED)):
        if len(kinds[x]) < 200 or kinds[x].count(kind) < 0.95 * len(kinds[x]):
            raise AssertionError("timed: sensor %d: %d of %d" % (x, kinds[x].count(kind), len(kinds[x])))
    return kinds


def flow():
    """Modules that fire by flow: a wall, nothing in range, a cut wire; the clock wraps."""
    start = PERIOD - 2000000
    clock = Clock(start)
    machine = Machine(clock, {4: 5200, 5: 38000, 6: 9000}, (), cut=(6,))
    ring = HcSr04FlowRing(Flow(3, 37000, rest_us=60000), [4, 5, 6], machine=machine, time=clock)
    kinds = [[], [], []]
    while clock.now - start < 4000000:
        reading = ring.read()
        if reading is not None:
            kinds[reading[SENSOR]].append(reading[KIND])
    for x, kind in enumerate((ACCEPTED, CLEAR, UNANSWERED)):
        # 64 cycles of 61 ms; five firings confirm.
        if len(kinds[x]) < 60 or kinds[x].count(kind) < len(kinds[x]) - 5:
            raise AssertionError("flow: sensor %d: %r" % (x, kinds[x]))


class SlowClock(Clock):
    """Each look at it takes 0.05 to 0.15 ms."""

    def ticks_us(self):
        self.now += 50 + self.now * 7919 % 101
        return self.now % PERIOD


def slow(step_us):
    """Share of accepted readings, in %, of eight modules that a slow loop fires by flow."""
    clock = SlowClock(0)
    machine = Machine(clock, {pin: 4000 + 1500 * pin for pin in range(4, 12)}, ())
    flow = Flow(8, 37000, rest_us=60000, lead_us=20000, step_us=step_us)
    ring = HcSr04FlowRing(flow, list(range(4, 12)), machine=machine, time=clock)
    kinds = []
    while clock.now < 8000000:
        reading = ring.read()
        if reading is not None:
            kinds.append(reading[KIND])
    return 100 * kinds.count(ACCEPTED) // len(kinds)


def crosstalk():
    """The sound of others that a sensor hears before its own is never accepted; its quiet grows until it hears its own."""
    ring, now = FlowRing(Flow(6, 30000), PERIOD - 5000000, clock_bits=30), PERIOD - 5000000
    path, own, accepted, total, heard = 4000, 25000, [0, 0], 0, []
    while total < 400:
        now = ring.deadline()
        for at, x in [sound for sound in heard if (now - sound[0]) % PERIOD < PERIOD // 2]:
            heard.remove((at, x))
            ring.echo(x, at)
        event = ring.poll(now)
        if event is None or event[0] == 2:
            continue
        if event[0] == 0:
            heard.append(((now + own) % PERIOD, event[1]))
            if event[1] != 2:
                heard.append(((now + path) % PERIOD, 2))
        elif event[SENSOR] == 2:
            total += 1
            if event[KIND] == ACCEPTED:
                accepted[abs(event[T_ECHO] - own) > 400] += 1
    if accepted[1] or accepted[0] < 100 or ring.quiet_us(2)[0] < 2 * ring.quiet_us(0)[0]:
        raise AssertionError("crosstalk: %d own and %d foreign of %d" % (accepted[0], accepted[1], total))
    for settings, said in (
        ({"t_delta_us": 0}, "t_delta_us = 0: 1 to 65535 expected"),
        ({"step_us": 150}, "step_us = 150: 151 to 65535 expected"),
        ({"tentative_votes": 1}, "tentative_votes = 1: 0, or 2 to 15 expected"),
        (
            {"shortest_cycle_us": 30000},
            "shortest_cycle_us = 30000: at least the window and the code, 32160 us, expected",
        ),
    ):
        try:
            found = Flow(6, 30000, **settings)
        except ValueError as error:
            found = str(error)
        if found != said:
            raise AssertionError("%r: %r" % (settings, found))


def room():
    """A schedule has 1 to 64 sensors, as in Rust and in C."""
    for sensors, refused in ((64, False), (65, True), (256, True)):
        try:
            Schedule(62000, [list(range(sensors))] * 2)
            said = None
        except ValueError as error:
            said = str(error)
        if said != ("%d sensors: 1 to 64 expected" % sensors if refused else None):
            raise AssertionError("%d sensors: %r" % (sensors, said))


def main():
    border()
    triggers()
    silence()
    ambiguous()
    odometry()
    timed()
    flow()
    if slow(240) > 5 or slow(1200) < 85:
        raise AssertionError("slow: %d %% and %d %% accepted" % (slow(240), slow(1200)))
    crosstalk()
    room()
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

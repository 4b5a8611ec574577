"""Test HcSr04FlowRing, which samples lines, with faults of one of them: python3 test_line_faults.py.

Free space is never reported without evidence, and each state is right after two readings. It runs under MicroPython
too."""

from eeruf import ACCEPTED, CLEAR, KIND, SENSOR, STUCK, T_ECHO, Flow, HcSr04FlowRing
from line_faults import FAULTY, cell, read, with_column

READINGS = 40
COLUMN = "MicroPython"
TURN = 1 << 30  # of a board's clock
STEP_US = 20  # between two looks at the clock
TOLERANCE_US = 120  # of a sampled width
WALL = [(450, True, False), (6280, False, False)]
NOTHING = [(450, True, False), (38450, False, False)]


class Board:
    """`time` and `machine`: pin x triggers module x, whose line is there or at pin 10 + x, and plays these edges, from `onset_us`
    on. The clock wraps, and goes on by `step_us` with each look at it."""

    def __init__(self, fault, step_us=STEP_US, onset_us=0):
        board = self
        self.now = self.changed = TURN - 1000000
        self.onset = self.now + onset_us
        self.fault, self.step_us, self.levels, self.ahead, self.fired = fault, step_us, [False] * 4, [], [None] * 4
        self.driven, self.pulled = set(), 0

        class Pin:
            IN, OUT = 0, 1

            def __init__(self, number, mode, value=None):
                self.number, self.level, self.mode = number, 0, mode

            def init(self, mode, value=None):
                self.mode = mode
                if self.number >= 10 and mode == Pin.OUT:
                    board.driven.add(self.number - 10)
                    board.pulled += 1
                else:
                    board.driven.discard(self.number - 10)

            def value(self, level=None):
                if level is None:
                    return int(board.look(self.number % 10))
                if self.mode != Pin.OUT:
                    raise AssertionError("pin %d is written as an input" % self.number)
                if self.level and not level:
                    board.triggered(self.number)
                self.level = level

        self.Pin = Pin

    def ticks_us(self):
        self.now += self.step_us
        return self.now % TURN

    def ticks_diff(self, one, other):
        return (one - other + TURN // 2) % TURN - TURN // 2

    def sleep_us(self, us):
        self.now += us
        # A line driven low stays low once its module lets go.
        for line in self.driven:
            self.levels[line] = False

    def look(self, line):
        """Return a line's level. If two edges have just come, only the first counts, so that samples hit every gap."""
        due = [edge for edge in self.ahead if edge[1] == line and edge[0] <= self.now]
        for edge in due:
            self.ahead.remove(edge)
            self.levels[line], self.changed = edge[2], self.now
            if self.now - edge[0] < 3 * STEP_US:
                break
        return self.levels[line]

    def triggered(self, x):
        fault, line, edges = self.fault, x, WALL
        self.fired[x] = self.now
        if x == FAULTY:
            # Once its line was pulled low, the module hears again.
            edges = WALL if self.pulled or self.now < self.onset else fault.edges
        elif x == fault.partner:
            edges = NOTHING
        if fault.partner is not None and x in (FAULTY, fault.partner):
            line = FAULTY + fault.partner - x
        # A module whose line is high does not hear its trigger.
        if not self.look(line):
            self.ahead += [(self.now + us, line, high) for us, high, _ in edges]
            self.ahead.sort()

    def skip(self, deadline):
        """Skip time in which nothing happens, once all lines were sampled."""
        if self.now - self.changed < 10 * STEP_US:
            return
        to = self.now + self.ticks_diff(deadline, self.now % TURN) - 5 * STEP_US
        ahead = [at for at, _, _ in self.ahead if at > self.now - 3 * STEP_US]
        if ahead:
            to = min(to, ahead[0] - 4 * STEP_US - self.now % 7)
        self.now = max(self.now, to)


class Forgetful(HcSr04FlowRing):
    """A program that triggers the faulty sensor by itself and never reports it."""

    def _trigger(self, x):
        if x == FAULTY:
            self._triggers[x].value(1)
            self._triggers[x].value(0)
        else:
            super()._trigger(x)


Recovering = type("Recovering", (HcSr04FlowRing,), {"RECOVERY_US": 200})


def run(fault, kind=HcSr04FlowRing, onset_us=0):
    """Return the readings, as (kind, state), of the faulty sensor and of the one with which its wire is exchanged."""
    board = Board(fault, STEP_US, onset_us)
    flow = Flow(4, 40000, rest_us=100000, seed=1)
    ring = (Forgetful if fault.forgotten else kind)(flow, [0, 1, 2, 3], [10, 11, 12, 13], machine=board, time=board)
    said = {FAULTY: [], fault.partner: []}
    while len(said[FAULTY]) < READINGS:
        reading = ring.read()
        if reading is None:
            board.skip(ring.ring.deadline())
        elif reading[SENSOR] in said:
            x = reading[SENSOR]
            said[x].append((reading[KIND], ring.state(x)))
    return said[FAULTY], said[fault.partner]


def check_walls(fault, step_us, **settings):
    """Check modules with one pin each that face walls: 97 % accepted, with samples this far apart, timed from the
    trigger."""
    board, readings = Board(fault, step_us), []
    ring = HcSr04FlowRing(Flow(4, 25000, seed=1, **settings), [0, 1, 2, 3], machine=board, time=board)
    while len(readings) < 200:
        reading = ring.read()
        if reading is not None:
            readings.append(reading)
        for x in range(4):
            off = board.ticks_diff(ring.ring._sensors[x].firings[0], (board.fired[x] or 0) % TURN)
            if board.fired[x] and not 0 <= off <= step_us:
                raise AssertionError("module %d: its firing counts from %d us after its trigger" % (x, off))
    accepted = [reading[T_ECHO] for reading in readings if reading[KIND] == ACCEPTED]
    off = max([abs(echo - 5830) for echo in accepted])
    if len(accepted) < 0.97 * len(readings) or off > 6 * step_us:
        raise AssertionError("looks of %d us: %d accepted, %d us off" % (step_us, len(accepted), off))


def is_clear(said):
    return said[0] == CLEAR or said[1][0] == "clear"


def is_right(said, says):
    kind, state = said
    if says[0] == "obstacle":
        return kind == ACCEPTED and state[0] == "obstacle" and abs(state[1] - int(says[1])) <= TOLERANCE_US
    if says[0] == "clear":
        return kind == CLEAR and state[0] == "clear"
    return not is_clear(said) and state[0] == {"held": "unanswered"}.get(says[0], says[0])


def check(text):
    """Check the table's cells, by name and surroundings."""
    faults, cells = read(text)[2], {}
    check_walls(faults[0], 10)
    check_walls(faults[0], 100, t_delta_us=600, near_us=700)
    for fault in faults:
        name, says = fault.name + ", before " + fault.before, fault.samples
        faulty, partner = run(fault)
        # For 250 ms it may be a clone without an echo. A silence counts once its line has fallen, and it takes two: a module fires
        # every 100 ms.
        until_right = {"hold of 130 ms": 3, "hold of 200 ms": 4}.get(fault.name, 3 if says[0] == "held" else 2)
        lies = sum([is_clear(said) for said in ([] if says[0] == "clear" else faulty) + partner])
        if lies:
            raise AssertionError("%s: clear without evidence in %d of %d readings" % (name, lies, len(faulty)))
        wrong = [said for said in faulty[until_right:] if not is_right(said, says)]
        if wrong:
            raise AssertionError("%s: not %r %d times, such as %r" % (name, says, len(wrong), wrong[0]))
        count = len(faulty) - until_right
        said = cell(count - len(wrong), count, lies)
        cells[fault.name, fault.before] = said if fault.says == says else says[0] + ": " + said
    return cells


def check_held(text):
    """Check a line that sticks high at any time in front of a wall (never clear), and one that is held until pulled
    low (stuck once, then a wall).
    """
    held = [fault for fault in read(text)[2] if fault.name == "held for ever"][0]
    for onset_us in range(500000, 2500000, 95239):  # spread over the 100 ms between two firings
        readings, _ = run(held, onset_us=onset_us)
        if not is_right(readings[3], ["obstacle", "5830"]) or readings[-1][0] != STUCK or any([is_clear(said) for said in readings]):
            raise AssertionError("stuck from %d us on: %r" % (onset_us, readings))
    readings, _ = run(held, Recovering)
    kinds = [kind for kind, _ in readings]
    stuck = kinds.index(STUCK)
    wrong = [said for said in readings[stuck + 3 :] if not is_right(said, ["obstacle", "5830"])]
    if stuck > 3 or kinds.count(STUCK) != 1 or wrong or any([is_clear(said) for said in readings[stuck:]]):
        raise AssertionError("a line that is pulled low: %r" % kinds)


def main(text, document):
    """Return the document with the results in its table."""
    cells = check(text)
    check_held(text)
    print("%d faults of a line: never clear without evidence" % len(cells))
    return with_column(document, COLUMN, cells)


if __name__ == "__main__":
    import os

    outcomes = "../../tests/data/line-fault-outcomes.txt"
    with open("../../tests/data/line-faults.txt") as faults, open(outcomes) as table:
        document = table.read()
        written = main(faults.read(), document)
    if "EERUF_WRITE" in os.environ:
        with open(outcomes, "w") as table:
            table.write(written)
    elif written != document:
        raise SystemExit("%s is not what MicroPython says; EERUF_WRITE=1 writes it" % outcomes)

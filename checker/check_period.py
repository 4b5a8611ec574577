#!/usr/bin/env python3
"""Checks a certificate that a firing schedule's period is the shortest one: python3 check_period.py FILE

Python's standard library alone. Shares nothing with the search that found the schedule, nor with crates/eeruf-check.
docs/certificate.md has the format, and the proofs at more length.

Sensor x fires at a[x] in phase a and at b[x] in phase b, both in [0, T); the phases follow each other, each T long.
d[x] = a[x] - b[x]. Required: |d| of two sensors differ by the larger of their separations D; 2 |d[x]| >= D[x] if
stale_echo; T - |d[x]| >= window[x]; after x fires, y fires no sooner than gap[x][y]. A schedule for T is one for every
longer period: times within a phase stay, those across phases grow. So refuting one period refutes all below it.
"""
import copy
import sys
from fractions import Fraction
from itertools import accumulate

LARGEST, SENSORS, DEPTH = 1 << 20, 64, 1000
Refused = type("Refused", (Exception,), {})  # the certificate is not as it must be
Refuted = type("Refuted", (Exception,), {})  # no schedule is in this part of the tree


class Lines:
    """The lines of a certificate: a word, then numbers, with one space between."""

    def __init__(self, text):
        self.lines, self.read = text.split("\n"), 0

    def require(self, condition, what):
        if not condition:
            raise Refused(f"line {max(self.read, 1)}: {what}")

    def is_next(self, word):
        return self.read < len(self.lines) and self.lines[self.read].split(" ")[0] == word

    def next(self, expected, count=None, least=0, most=LARGEST):
        line = self.lines[self.read] if self.read < len(self.lines) else ""
        word, *numbers = line.split(" ")
        self.read += 1
        self.require(word == expected, f"found {line[:40]!r}, expected a line {expected}")
        for number in numbers:
            plain = number.isascii() and number.isdigit() and len(number) < 8 and str(int(number)) == number
            self.require(plain and least <= int(number) <= most, f"found {number[:9]!r}, expected {least} to {most}")
        self.require(count in (None, len(numbers)), f"found {len(numbers)} numbers, expected {count}")
        return [int(number) for number in numbers]


class Problem:
    """The problem, the schedule, which is checked longhand, and the claim."""

    def __init__(self, lines):
        lines.next("eeruf-certificate", 1, 1, 1)
        self.tick = Fraction(*lines.next("tick_us", 2, 1))
        self.sensors = count = lines.next("sensors", 1, 1, SENSORS)[0]
        self.separation, self.window = lines.next("separation", count, 1), lines.next("window", count, 1)
        self.stale_echo, self.over_reals = lines.next("stale_echo", 1, 0, 1)[0], lines.next("over_reals", 1, 0, 1)[0]
        half = self.over_reals and self.stale_echo and any(D % 2 for D in self.separation)
        lines.require(not half, "stale_echo over_reals needs even separations")
        self.together, self.gap, last = [], [[0] * count for _ in range(count)], [-1, -1]
        while lines.is_next("together"):
            group, used = lines.next("together", None, 0, count - 1), set(sum(self.together, []))
            fine = len(group) > 1 and group == sorted(set(group) - used)
            lines.require(fine, "expected two or more, in ascending order, in no other group")
            self.together.append(group)
        while lines.is_next("gap"):
            x, y, after_x, after_y = lines.next("gap", 4)
            fine = x < y < count and [x, y] > last and after_x and after_y
            lines.require(fine, "expected pairs x < y in ascending order, with gaps of 1 or more")
            self.gap[x][y], self.gap[y][x], last = after_x, after_y, [x, y]
        self.period = lines.next("period", 1, 1)[0]
        self.a, self.b = (lines.next(word, count, 0, self.period - 1) for word in ("fire_a", "fire_b"))
        self.check_schedule(lines.require)
        self.bound = lines.next("no_period_below", 1, 1, self.period)[0]
        # Sensors that fire together have the same times, so they are one sensor with their strictest requirements.
        ones = sorted(self.together + [[x] for x in range(count) if x not in sum(self.together, [])])
        self.one = [next(one for one, group in enumerate(ones) if x in group) for x in range(count)]
        self.D, self.R = ([max(row[x] for x in group) for group in ones] for row in (self.separation, self.window))
        self.G = G = [[max(self.gap[x][y] for x in group for y in other) for other in ones] for group in ones]
        self.ends = [(1 + 2 * x, 2 + 2 * x) for x in range(len(ones))]  # the events of x in phases a and b
        # Two events, the least time from first to second, the bound if that order is impossible.
        self.orders = [(self.ends[x][phase], self.ends[y][phase], 2 * G[x][y], -2 * G[y][x])
                       for x in range(len(ones)) for y in range(len(ones)) if G[x][y] for phase in (0, 1)]

    def check_schedule(self, require):
        fire = [(a, self.period + b, 2 * self.period + a) for a, b in zip(self.a, self.b)]  # then it repeats
        change = [abs(a - b) for a, b in zip(self.a, self.b)]
        for x, (first, second, third) in enumerate(fire):
            require(min(second - first, third - second) >= self.window[x], f"sensor {x} fires within its window")
            require(not self.stale_echo or 2 * change[x] >= self.separation[x], f"sensor {x} would take a stale echo")
            for y in range(self.sensors):
                if any(x in group and y in group for group in self.together):
                    require(fire[x] == fire[y], f"sensors {x} and {y} must fire together and do not")
                elif x != y:
                    apart = max(self.separation[x], self.separation[y])
                    require(abs(change[x] - change[y]) >= apart, f"|d| of sensors {x} and {y} differ by too little")
                if gap := self.gap[x][y]:  # at the same instant each is after the other
                    waits = [later - earlier for earlier in fire[x] for later in fire[y] if later >= earlier]
                    require(min(waits) >= gap, f"sensor {y} fires too soon after sensor {x}")


class Node:
    """What is known at a node. M[i][j] bounds t[j] - t[i]: 2 v says "at most v", 2 v - 1 "less than v"; event 0 is the
    start of a phase, 1 + 2 x is x in phase a, 2 + 2 x in phase b. low[x] bounds |d[x]|: 2 v says "at least v", 2 v + 1
    "more than v". below[y] are those with a smaller |d|, as bits. In whole ticks no bound is odd. Each rule only
    tightens, and more if it is given more, so all orders of applying them end in the same state: the fixpoint."""

    def __init__(self, problem):
        # Every period below the bound. In whole ticks T <= bound - 1, and firing times are <= T - 1.
        self.problem, self.step, self.reverse, self.seen = problem, 2 - problem.over_reals, [], None
        latest, size = 2 * problem.bound - (1 if problem.over_reals else 4), 1 + 2 * len(problem.D)
        if latest < 0:
            raise Refuted
        self.M = [[latest * (i != j) for j in range(size)] for i in range(size)]
        # 2 |d| >= D: the bound 2 (D / 2) = D, in whole ticks rounded up to an even one.
        self.low = [(D + D % 2 * (self.step - 1)) * problem.stale_echo for D in problem.D]
        self.below = [0] * len(problem.D)
        for x, (a, b) in enumerate(problem.ends):
            self.M[a][0] = self.M[b][0] = 0
            self.learn_high(x, 2 * (problem.bound - problem.R[x]) - self.step)
            for gap, (next_a, next_b) in zip(problem.G[x], problem.ends):
                if gap:  # after x in a phase, y in the next one
                    self.learn(next_b, a, 2 * (problem.bound - gap) - self.step)
                    self.learn(next_a, b, 2 * (problem.bound - gap) - self.step)

    def learn(self, i, j, bound):
        """Rule 1, closure: t[j] - t[h] = (t[i] - t[h]) + (t[j] - t[i]), so bounds add along every way; a way round that
        adds to less than 0 is impossible. After a new bound only ways through it need a look. "< v" and "< w" add to
        "< v + w": of two odd numbers one -1 goes, so to an odd number even ones are added."""
        M = self.M
        if bound >= M[i][j]:
            return False
        if bound + M[j][i] + (bound & M[j][i] & 1) < 0:
            raise Refuted
        even = M[j]
        odd = [onward + (onward & 1) for onward in even] if self.step == 1 else even
        for h, row in enumerate(M):
            through = row[i] + bound + (row[i] & bound & 1)
            if through < row[j]:
                onward = odd if through & 1 else even
                M[h] = [old if old <= through + new else through + new for old, new in zip(row, onward)]
        return True

    def high(self, x):  # the upper bound on |d[x]|
        return max(self.M[1 + 2 * x][2 + 2 * x], self.M[2 + 2 * x][1 + 2 * x])

    def learn_high(self, x, bound):
        return self.learn(2 + 2 * x, 1 + 2 * x, bound) | self.learn(1 + 2 * x, 2 + 2 * x, bound)

    def learn_low(self, x, bound):
        news, self.low[x] = bound > self.low[x], max(bound, self.low[x])
        if self.low[x] > self.high(x):
            raise Refuted
        return news

    def learn_below(self, x, y):
        self.below[y] |= 1 << x

    def propagate(self):
        while self.orders() | self.signs() | self.ranks() or self.precedence():
            pass
        return self

    def orders(self):
        """Rule 2: if y cannot come its gap after x, then y comes first, as one of two firings does."""
        news, M = False, self.M
        for i, j, least, other in self.problem.orders:
            if other < M[i][j] < least:
                news |= self.learn(i, j, other)
        for i, j, then_j, then_i, gap in self.reverse:  # assumed at the root
            news |= M[i][j] <= -gap and self.learn(then_j, then_i, -gap)
        return news

    def signs(self):
        """Rule 3: d <= v < 0 gives |d| >= -v; and if |d| >= v and d < v, then d <= -v. The same for -d."""
        news, M, low = False, self.M, self.low
        for x, (a, b) in enumerate(self.problem.ends):
            for i, j in ((b, a), (a, b)):
                news |= -M[i][j] > low[x] and self.learn_low(x, -M[i][j])
                news |= M[i][j] < low[x] and self.learn(i, j, -low[x])
        return news

    def ranks(self):
        """Rule 4: if |d[x]| cannot be D above |d[y]|, it is below; below is transitive and not circular. Values each
        max(D, D') apart span the sum of their D but the smallest or more: from the smallest outwards, each step is at
        least the D it leads to. So |d[y]| is as far above the lowest of any set below it as the set with y spans; the
        same upside down. Rule 5 (Hall): those whose |d| lies in an interval span no more than its width."""
        low, below, D, every = self.low, self.below, self.problem.D, range(len(self.low))
        high = [self.high(x) for x in every]
        seen, news = (high, low[:], below[:]), False
        if self.seen == seen:
            return False
        for y in every:
            known = below[y]
            for x in every:
                if high[x] - low[y] < 2 * max(D[x], D[y]) and x != y or known >> x & 1:
                    known |= 1 << x | below[x]
            below[y] = known
            if known >> y & 1:
                raise Refuted
        for y in every:
            under = [(-low[x], D[x]) for x in every if below[y] >> x & 1]
            over = [(high[x], D[x]) for x in every if below[x] >> y & 1]
            news |= bool(under) and self.learn_low(y, -beyond(under, (D[y],)))
            news |= bool(over) and self.learn_high(y, beyond(over, (D[y],)))
        for start in set(low):
            if beyond([(high[x], D[x]) for x in every if low[x] >= start]) < start:
                raise Refuted
        self.seen = seen
        return news or below != seen[2]

    def precedence(self):
        """Rule 6: the orders of x and y may force d[x] - d[y] <= lead < 0. Of a set of such x, the last is as far above
        the lowest as the set spans, and y at least the smallest -lead beyond it. The same for -d."""
        news, M, D = False, self.M, self.problem.D
        for y, ends in enumerate(self.problem.ends):
            others = [(end, D[x]) for x, end in enumerate(self.problem.ends) if self.problem.G[x][y]]
            for one in (0, 1):
                end, start = ends[one], ends[1 - one]  # their difference is d[y], or -d[y]
                found = [(M[x[one]][x[1 - one]], M[end][x[one]], M[x[1 - one]][start], D) for x, D in others]
                found = [(most, v + w + (v & w & 1), D) for most, v, w, D in found if v + w < 0]
                for lead in {lead for _, lead, _ in found}:
                    most = beyond([(most, D) for most, other, D in found if other <= lead])
                    news |= self.learn(end, start, most + lead + (most & lead & 1))
        return news


def beyond(values, own=()):
    """A bound on what is below all values, given as upper bounds and separations: see rule 4."""
    bounds, separations = zip(*sorted(values))
    spans, narrowest = list(accumulate(own + separations)), list(accumulate(own + separations, min))
    return min(bound - 2 * (span - D) for bound, span, D in zip(bounds, spans[len(own):], narrowest[len(own):]))


def root(lines, problem):
    """What may be assumed since each schedule has others like it. Permutations that take the problem to itself take
    schedules to schedules: one brings the least |d| of an orbit to any sensor in it, and if it leaves earlier orbits
    and their least as they are, it leaves what was assumed of them. Exchanging the phases turns all d to -d: one d is
    not negative. Reversing time and exchanging the phases keeps all d; if y fires before x in both phases, then
    x before y in both: assume that it is not y before x in both. That needs gaps alike both ways."""
    every, one, gap, earlier, below = range(problem.sensors), problem.one, problem.gap, [], []
    while lines.is_next("permutation"):
        images, orbit = [], set()
        while lines.is_next("permutation"):
            images.append(image := lines.next("permutation", len(every), 0, len(every) - 1))
            lines.require(sorted(image) == list(every), "expected a permutation")
            for x, y in enumerate(image):
                same = problem.separation[x] == problem.separation[y] and problem.window[x] == problem.window[y]
                same = same and all(gap[x][z] == gap[y][image[z]] for z in every)
                lines.require(same, f"sensor {x} is taken to sensor {y}, which differs")
            groups = all(sorted(image[x] for x in group) in problem.together for group in problem.together)
            stays = all(image[x] == x and {image[y] for y in others} == others for x, others in earlier)
            lines.require(groups and stays, "expected groups to be taken to groups, and earlier orbits to stay")
        (least,) = new = lines.next("least", 1, 0, len(every) - 1)
        while new:
            orbit |= set(new)
            new = {image[x] for image in images for x in new} - orbit
        earlier.append((least, orbit))
        below += [(one[least], one[x]) for x in orbit if one[x] != one[least]]
    positive = lines.next("exchange", 1, 0, len(every) - 1) if lines.is_next("exchange") else []
    reverse = []
    if lines.is_next("reverse"):
        x, y = (one[x] for x in lines.next("reverse", 2, 0, len(every) - 1))
        (i, k), (j, l), fine = problem.ends[x], problem.ends[y], gap == [list(column) for column in zip(*gap)]
        lines.require(problem.G[x][y] and fine, "expected two sensors with a gap, and all gaps alike both ways")
        reverse = [(i, j, l, k, 2 * problem.G[x][y]), (k, l, j, i, 2 * problem.G[x][y])]
    try:
        node = Node(problem)
        node.reverse = reverse
        for x, y in below:
            node.learn_below(x, y)
        for x in positive:
            node.learn(*problem.ends[one[x]], 0)
        return node.propagate()
    except Refuted:
        return None


def branching(lines, node):
    """The two cases of the next line, one of which holds in every schedule: each a function that assumes it."""
    problem, step, every = node.problem, node.step, node.problem.sensors - 1
    word = next((word for word in ("split", "sign", "rank", "b") if lines.is_next(word)), "a")
    numbers = lines.next(word, 1 if word == "sign" else 2, 0, LARGEST if word == "split" else every)
    lines.require(numbers[0] <= every, f"found sensor {numbers[0]}, expected 0 to {every}")
    x, y = problem.one[numbers[0]], None if word in ("sign", "split") else problem.one[numbers[1]]
    if word == "split":
        value = 2 * numbers[1]
        decided = node.low[x] > value or node.high(x) <= value
        cases = [lambda node: node.learn_high(x, value), lambda node: node.learn_low(x, value + step)]
    elif word == "rank":
        lines.require(x != y, "expected two sensors that do not fire together")
        decided = (node.below[y] >> x | node.below[x] >> y) & 1
        cases = [lambda node: node.learn_below(x, y), lambda node: node.learn_below(y, x)]
    else:
        (i, j), bounds = problem.ends[x], (0, -step)  # d[x] >= 0, or d[x] < 0
        if word != "sign":
            lines.require(problem.G[x][y], "expected two sensors with a gap")
            (j, i), G = (problem.ends[one][word == "b"] for one in (x, y)), problem.G
            bounds = -2 * G[x][y], -2 * G[y][x]  # x first, or y
        decided = node.M[i][j] <= bounds[0] or node.M[j][i] <= bounds[1]
        cases = [lambda node: node.learn(i, j, bounds[0]), lambda node: node.learn(j, i, bounds[1])]
    lines.require(not decided, "here it is known which case holds, expected an open branching")
    return cases


def check(text):
    """What the certificate proves, in words; raises Refused."""
    lines = Lines(text)
    problem = Problem(lines)
    node, waiting = root(lines, problem), []  # open nodes with the cases still to come; the tree is in preorder
    while node or waiting:
        if node:  # not refuted, so it must branch
            lines.require(len(waiting) < DEPTH, f"the tree is deeper than {DEPTH}")
            waiting.append((node, branching(lines, node)))
        node, (case, *later) = waiting.pop()
        if later:
            waiting.append((node, later))
        node = copy.copy(node)
        node.M, node.low, node.below = node.M[:], node.low[:], node.below[:]  # rows of M are only ever replaced
        try:
            case(node)
            node.propagate()
        except Refuted:
            node = None
    lines.next("end", 0)
    lines.require(lines.lines[lines.read:] == [""], "expected nothing after the line end")
    reals = " over the reals" if problem.over_reals else ""
    period, bound = problem.period * problem.tick, problem.bound * problem.tick
    if period == bound:
        return f"{period} us is the shortest period{reals} (tick {problem.tick} us)"
    return f"no period below {bound} us{reals}; schedule of {period} us (tick {problem.tick} us)"


def main(arguments):
    try:
        (path,) = arguments
        with open(path, "rb") as file:
            text = file.read().decode()
        print(check(text))
        return 0
    except Refused as error:
        print(f"refused: {path}: {error}")
        return 1
    except (ValueError, OSError) as error:
        print(f"usage: check_period.py FILE: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

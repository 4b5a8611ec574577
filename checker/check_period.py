#!/usr/bin/env python3
"""Checks a certificate that a firing schedule's period is the shortest one: python3 check_period.py FILE

Python's standard library alone; shares nothing with the search that found the schedule, nor with crates/eeruf-check.
docs/reference/certificate.md has problem and format; its sections "The rules" and "What the root may assume" have the
proofs. Sensor x fires at a[x] in phase a, at b[x] in phase b, both in [0, T); d[x] = a[x] - b[x]. Required: |d| differ
by the larger of two separations D; 2 |d[x]| >= D[x] if stale_echo; T - |d[x]| >= window[x]; after x, y fires no sooner
than gap[x][y]. A schedule for T is one for longer periods: times within a phase stay, those across phases grow. So
refuting one period refutes all below it."""
import copy
import sys
from fractions import Fraction
from itertools import accumulate

LARGEST, SENSORS, DEPTH = 1 << 20, 64, 1000
Refused = type("Refused", (Exception,), {})  # the certificate is not as it must be
Refuted = type("Refuted", (Exception,), {})  # no schedule is in this part of the tree

class Lines:
    """The lines of a certificate: a word, then numbers, with one space between."""
    def __init__(self, text):  # one more at the end, so that there is always a next one
        self.lines, self.read = [line.split(" ") for line in text.split("\n")] + [[""]], 0

    def require(self, condition, what):
        if not condition:
            raise Refused(f"line {max(self.read, 1)}: {what}")

    def is_next(self, word):
        return self.lines[self.read][0] == word

    def next(self, expected, count=None, least=0, most=LARGEST):
        word, *numbers = self.lines[self.read]
        self.read += 1
        self.require(word == expected, f"found {word[:40]!r}, expected a line {expected}")
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
        is_even = not any(D % 2 for D in self.separation)
        lines.require(is_even or not self.over_reals * self.stale_echo, "stale_echo over_reals needs even separations")
        self.together, self.gap, last = [], [[0] * count for _ in range(count)], [-1, -1]
        while lines.is_next("together"):
            group, used = lines.next("together", None, 0, count - 1), set(sum(self.together, []))
            lines.require(group[1:] and group == sorted(set(group) - used), "expected two or more in ascending order")
            self.together.append(group)
        while lines.is_next("gap"):
            x, y, after_x, after_y = lines.next("gap", 4)
            lines.require(last < [x, y] and x < y < count and after_x and after_y, "expected pairs in ascending order")
            self.gap[x][y], self.gap[y][x], last = after_x, after_y, [x, y]
        (self.period,) = lines.next("period", 1, 1)
        self.a, self.b = (lines.next(word, count, 0, self.period - 1) for word in ("fire_a", "fire_b"))
        self.check_schedule(lines.require)
        (self.bound,) = lines.next("no_period_below", 1, 1, self.period)
        # Sensors that fire together have the same times, so they are one sensor with their strictest requirements.
        ones = sorted(self.together + [[x] for x in range(count) if x not in sum(self.together, [])])
        self.one = [next(one for one, group in enumerate(ones) if x in group) for x in range(count)]
        self.D, self.R = ([max(row[x] for x in group) for group in ones] for row in (self.separation, self.window))
        self.G = G = [[max(self.gap[x][y] for x in group for y in other) for other in ones] for group in ones]
        self.ends = [(1 + 2 * x, 2 + 2 * x) for x in range(len(ones))]  # the events of x in phases a and b
        # Two events, the least time from first to second, the bound if that order is impossible.
        self.orders = [(self.ends[x][phase], self.ends[y][phase], 2 * gap, -2 * G[y][x])
                       for x, row in enumerate(G) for y, gap in enumerate(row) if gap for phase in (0, 1)]

    def check_schedule(self, require):
        fire = [(a, self.period + b, 2 * self.period + a) for a, b in zip(self.a, self.b)]  # then it repeats
        change, D = [abs(a - b) for a, b in zip(self.a, self.b)], self.separation
        for x, (first, second, third) in enumerate(fire):
            require(min(second - first, third - second) >= self.window[x], f"sensor {x} fires within its window")
            require(not self.stale_echo or 2 * change[x] >= D[x], f"sensor {x} would take a stale echo")
            for y in range(self.sensors):
                if any(x in group and y in group for group in self.together):
                    require(fire[x] == fire[y], f"sensors {x} and {y} must fire together and do not")
                elif x != y:
                    require(abs(change[x] - change[y]) >= max(D[x], D[y]), f"|d| of sensors {x} and {y} are too near")
                if gap := self.gap[x][y]:  # at the same instant each is after the other
                    waits = [later - earlier for earlier in fire[x] for later in fire[y] if later >= earlier]
                    require(min(waits) >= gap, f"sensor {y} fires too soon after sensor {x}")

class Node:
    """Knowledge at a node. M[i][j] bounds t[j] - t[i]: 2 v says "at most v", 2 v - 1 "less than v" (not in whole
    ticks); event 0 is the start of a phase, 1 + 2 x is x in phase a, 2 + 2 x in phase b. low[x] bounds |d[x]|: 2 v says
    "at least v", 2 v + 1 "more than v". below[y] are those with a smaller |d|, as bits. Rules only tighten, and more if
    given more, so all orders of applying them end in the same state: the fixpoint."""

    def __init__(self, problem, reverse):
        self.problem, self.step, self.reverse, self.seen = problem, 2 - problem.over_reals, reverse, None
        # Firing times are below T, and T below the bound; in whole ticks each by 1.
        latest, size = 2 * problem.bound - (1 if problem.over_reals else 4), 1 + 2 * len(problem.D)
        self.M = [[latest * (i != j and j > 0) for j in range(size)] for i in range(size)]
        self.low = [(D + D % 2 * (self.step - 1)) * problem.stale_echo for D in problem.D]  # 2 |d| >= D, rounded up
        self.below = [0] * len(problem.D)

    def assuming(self, *facts):
        """The node with these facts and all that follows from them; None if it is refuted."""
        node = copy.copy(self)
        node.M, node.low, node.below = self.M[:], self.low[:], self.below[:]  # rows of M are only ever replaced
        try:
            for learn, *what in facts:
                learn(node, *what)
            while node.orders() | node.signs() | node.ranks() or node.precedence():
                pass
        except Refuted:
            return None
        return node

    def learn(self, i, j, bound):
        """Rule 1, closure: t[j] - t[h] = (t[i] - t[h]) + (t[j] - t[i]): bounds add along ways; a way round is 0. And
        "< v" and "< w" add to "< v + w": of two odd numbers one -1 goes, so to an odd number even ones are added."""
        M, even = self.M, self.M[j]
        if bound >= M[i][j]:
            return False
        if bound + M[j][i] + (bound & M[j][i] & 1) < 0:
            raise Refuted
        odd = [onward + (onward & 1) for onward in even] if self.step == 1 else even
        for h, row in enumerate(M):
            if (through := row[i] + bound + (row[i] & bound & 1)) < row[j]:
                onward = zip(row, odd if through & 1 else even)
                M[h] = [old if old <= through + new else through + new for old, new in onward]
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
        """Rule 4: if |d[x]| cannot be D above |d[y]|, it is below; below is transitive, not circular. Values max(D, D')
        apart span the sum of their D but the smallest: outwards from there, each step is the D it leads to or more. So
        |d[y]| is above the lowest of any set below it by the span of the set with y; the same upside down.
        Rule 5 (Hall): those whose |d| lies in an interval span no more than its width."""
        low, below, D, every = self.low, self.below, self.problem.D, range(len(self.low))
        seen, news = (high := [self.high(x) for x in every], low[:], below[:]), False
        if self.seen == seen:
            return False
        for y in every:
            for x in every:
                if high[x] - low[y] < 2 * max(D[x], D[y]) and x != y or below[y] >> x & 1:
                    below[y] |= 1 << x | below[x]
            if below[y] >> y & 1:
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
    """Knowledge at the root. A permutation that keeps the problem takes schedules to schedules; if it keeps earlier
    orbits and their greatest, it keeps what was assumed of them. So any of an orbit may have its greatest |d|. To
    exchange the phases turns all d to -d: one d is not negative. To reverse time as well keeps all d, and y before x in
    both phases becomes x before y: assume that it is not so. That needs gaps alike both ways."""
    every, one, gap, groups = range(problem.sensors), problem.one, problem.gap, problem.together
    earlier, facts, reverse = [], [], []
    period = 2 * (problem.bound - 1) + problem.over_reals  # below the bound, as a bound of M
    for x, (a, b) in enumerate(problem.ends):
        facts.append((Node.learn_high, x, period - 2 * problem.R[x]))
        for wait, (next_a, next_b) in zip(problem.G[x], problem.ends):
            if wait:  # after x in a phase, y in the next one
                facts += [(Node.learn, next_b, a, period - 2 * wait), (Node.learn, next_a, b, period - 2 * wait)]
    while lines.is_next("permutation"):
        images, orbit = [], set()
        while lines.is_next("permutation"):
            images.append(image := lines.next("permutation", len(every), 0, len(every) - 1))
            kept = sorted(image) == [*every] and all(sorted(image[x] for x in group) in groups for group in groups)
            kept = kept and all(row[x] == row[image[x]] for row in (problem.separation, problem.window) for x in every)
            kept = kept and all(gap[x][y] == gap[image[x]][image[y]] for x in every for y in every)
            kept = kept and all(image[x] == x and {image[y] for y in others} == others for x, others in earlier)
            lines.require(kept, "expected a permutation that keeps the problem, and earlier orbits with their greatest")
        (greatest,) = new = lines.next("greatest", 1, 0, len(every) - 1)
        while new:
            orbit |= set(new)
            new = {image[x] for image in images for x in new} - orbit
        earlier.append((greatest, orbit))
        facts += [(Node.learn_below, one[x], one[greatest]) for x in orbit if one[x] != one[greatest]]
    if lines.is_next("exchange"):
        facts.append((Node.learn, *problem.ends[one[lines.next("exchange", 1, 0, len(every) - 1)[0]]], 0))
    if lines.is_next("reverse"):
        x, y = (one[x] for x in lines.next("reverse", 2, 0, len(every) - 1))
        (i, k), (j, m), fine = problem.ends[x], problem.ends[y], gap == [list(column) for column in zip(*gap)]
        lines.require(problem.G[x][y] and fine, "expected two sensors with a gap, and all gaps alike both ways")
        reverse = [(i, j, m, k, 2 * problem.G[x][y]), (k, m, j, i, 2 * problem.G[x][y])]
    return Node(problem, reverse).assuming(*facts)

def branching(lines, node):
    """The two cases of the next line, one of which holds in every schedule: each what to learn."""
    problem, step, every = node.problem, node.step, node.problem.sensors - 1
    word = next((word for word in ("split", "sign", "rank", "b") if lines.is_next(word)), "a")
    sensors = lines.next(word, 1 if word == "sign" else 2, 0, LARGEST if word == "split" else every)
    lines.require(sensors[0] <= every, f"found sensor {sensors[0]}, expected 0 to {every}")
    x, y = problem.one[sensors[0]], None if word in ("sign", "split") else problem.one[sensors[1]]
    if word == "split":
        value = 2 * sensors[1]
        decided = node.low[x] > value or node.high(x) <= value
        cases = (Node.learn_high, x, value), (Node.learn_low, x, value + step)
    elif word == "rank":
        lines.require(x != y, "expected two sensors that do not fire together")
        decided = (node.below[y] >> x | node.below[x] >> y) & 1
        cases = (Node.learn_below, x, y), (Node.learn_below, y, x)
    else:
        (i, j), bounds = problem.ends[x], (0, -step)  # d[x] >= 0, or d[x] < 0
        if word != "sign":
            lines.require(problem.G[x][y], "expected two sensors with a gap")
            (j, i), G = (problem.ends[one][word == "b"] for one in (x, y)), problem.G
            bounds = -2 * G[x][y], -2 * G[y][x]  # x first, or y
        decided = node.M[i][j] <= bounds[0] or node.M[j][i] <= bounds[1]
        cases = (Node.learn, i, j, bounds[0]), (Node.learn, j, i, bounds[1])
    lines.require(not decided, "here it is known which case holds, expected an open branching")
    return cases

def check(text):
    """Returns the certificate's claim in words; raises Refused."""
    problem = Problem(lines := Lines(text))
    node, waiting = root(lines, problem), []  # open nodes with the cases still to come; the tree is in preorder
    while node or waiting:
        if node:  # not refuted, so it must branch
            lines.require(len(waiting) < DEPTH, f"the tree is deeper than {DEPTH}")
            waiting += [(node, case) for case in reversed(branching(lines, node))]
        node, case = waiting.pop()
        node = node.assuming(case)
    lines.next("end", 0)
    lines.require(lines.lines[lines.read:] == [[""], [""]], "expected nothing after the line end")
    reals, tick = " over the reals" if problem.over_reals else "", f"(tick {problem.tick} us)"
    period, bound = problem.period * problem.tick, problem.bound * problem.tick
    if period == bound:
        return f"{period} us is the shortest period{reals} {tick}"
    return f"no period below {bound} us{reals}; schedule of {period} us {tick}"

if __name__ == "__main__":
    try:
        (path,) = sys.argv[1:]
        with open(path, "rb") as file:
            print(check(file.read().decode()))
    except Refused as error:
        print(f"refused: {path}: {error}")
        sys.exit(1)
    except (ValueError, OSError) as error:
        print(f"usage: check_period.py FILE: {error}", file=sys.stderr)
        sys.exit(2)

#!/usr/bin/env python3
"""Checks certificates that a firing schedule's period is the shortest one: python3 check_period.py FILE ...

It needs only Python's standard library, and shares nothing with the search that found the schedule.
docs/reference/certificate.md has the problem and the format; its sections "The rules" and "What the root may assume" have the
proofs. All times are whole ticks. Sensor x fires at a[x] in phase a, at b[x] in phase b, both in [0, T); d[x] = a[x] - b[x]. Required: |d| differ
by the larger of two separations D; 2 |d[x]| >= D[x] if stale_echo; T - |d[x]| >= window[x]; after x, y fires no sooner
than gap[x][y]. A schedule for T is one for longer periods: times within a phase stay, those across phases grow. So
refuting one period refutes all below it."""
import copy
import sys
from array import array
from collections import Counter
from fractions import Fraction
from functools import cache
from itertools import accumulate, permutations
from math import gcd

LARGEST, SENSORS, DEPTH = 1 << 20, 64, 1 << 13
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
        lines.next("eeruf-certificate", 1, 2, 2)
        self.tick = Fraction(*lines.next("tick_us", 2, 1))
        self.sensors = count = lines.next("sensors", 1, 1, SENSORS)[0]
        self.separation, self.window = lines.next("separation", count, 1), lines.next("window", count, 1)
        (self.stale_echo,) = lines.next("stale_echo", 1, 0, 1)
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
        self.orders = [(self.ends[x][phase], self.ends[y][phase], gap, -G[y][x])
                       for x, row in enumerate(G) for y, gap in enumerate(row) if gap for phase in (0, 1)]
        self.is_refuted = Counting(lines, self).refutes()

    def claim(self):
        period, bound, tick = self.period * self.tick, self.bound * self.tick, f"(tick {self.tick} us)"
        if period == bound:
            return f"{period} us is the shortest period {tick}"
        return f"no period below {bound} us; schedule of {period} us {tick}"

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

class Counting:
    """A line of a certificate that refutes by counting all periods below the bound, the longest of which is T."""
    def __init__(self, lines, problem):
        self.problem, self.T, self.lines, G = problem, problem.bound - 1, lines, problem.G
        self.every, self.R, self.refuted = range(len(G)), min(problem.R), False
        self.D, self.least = sorted(problem.D)[:2][-1], (min(problem.D) + 1) // 2 * problem.stale_echo
        if lines.is_next("sequence"):
            lines.next("sequence", 0)
            self.refuted |= self.sequence() > self.T
        for is_ring, word in enumerate(("line", "ring")):
            if lines.is_next(word):
                self.neighbours(lines.next(word, 1, 2, len(G))[0], is_ring)
        cliques = []
        while lines.is_next("clique"):
            cliques.append(set(lines.next("clique", None, 0, problem.sensors - 1)))
        problem.sets = self.cliques([{problem.one[x] for x in clique} for clique in cliques]) if cliques else []

    def refutes(self):
        return self.refuted

    def sequence(self):
        """Each |d| is the larger of two D above the one before: the least T over all sequences. Of equal D the longest
        window comes first, as exchanging two changes no distance."""
        kinds, problem = sorted(set(self.problem.D)), self.problem
        windows = [sorted(R for R, D in zip(problem.R, problem.D) if D == kind)[::-1] for kind in kinds]

        @cache
        def rest(taken, last):  # the least T less the last |d|
            periods = []
            for kind, D in enumerate(kinds):
                if taken[kind] < len(windows[kind]):
                    after = *taken[:kind], taken[kind] + 1, *taken[kind + 1:]
                    apart = max(D, last) if any(taken) else (D + 1) // 2 * problem.stale_echo
                    periods.append(apart + max(windows[kind][taken[kind]], rest(after, D)))
            return min(periods, default=0)
        return rest((0,) * len(kinds), 0)

    def rooms(self, n, gap, passed=0):
        """Return how many |d| fit into each class of n places."""
        spare, room = self.T - n * gap, lambda low, high: max(0, (high - max(low, self.least)) // self.D + 1)
        return [room(c * gap - spare + (passed if c else 0), min(c * gap + spare, self.T - self.R)) for c in range(n)]

    def neighbours(self, n, is_ring):
        count, G = len(self.every), self.problem.G
        near = [G[x][y] for x, y in permutations(self.every, 2)
                if abs(x - y) < n or is_ring and count - abs(x - y) < n]
        gap = min(near, default=0)
        self.lines.require(0 < gap <= self.R and count >= n * (1 + is_ring), "expected neighbours with a gap")
        spare, alike = self.T - n * gap, n // gcd(n, count) if is_ring else 1
        if 2 * spare < gap or n == count and spare < gap:
            rooms = self.rooms(n, gap, self.D * is_ring)
            each, more = (count * alike // n, 0) if is_ring else divmod(count, n)
            self.refuted |= spare < 0 or not permute(rooms, each, more, alike)
            self.refuted |= is_ring and count == 2 * n and 2 * spare < n * self.D
        elif spare < gap:
            self.share(self.rooms(n, gap), count // n * n)

    def share(self, rooms, sensors):
        self.refuted |= sum(min(room, sensors) for room in rooms) < sensors

    def cliques(self, cliques):
        """Returns sets of sensors of which few can fire within a time: their members, and the least time between two of
        their firings, by the number of steps from one to the other."""
        problem, T, sets, gaps = self.problem, self.T, [], {}
        for clique in cliques:
            gap = {x: min(problem.G[x][y] for y in clique if y != x) for x in clique if len(clique) > 1}
            self.lines.require(all(gap.values()), "expected cliques: sensors of which each has a gap to each other")
            if gap:
                again = max(max(0, gap[x] - problem.R[x]) for x in clique)
                self.refuted |= sum(gap.values()) - again > T
                gaps[frozenset(clique)] = min(gap.values())
        if not gaps:
            return []
        members = set().union(*cliques)
        gap, at_once = min(gaps.values()), len(cliques) // min(Counter(x for clique in cliques for x in clique).values())
        self.refuted |= 2 * at_once * T < sum(gap + min(gap, problem.R[x]) for x in members)
        least = self.pace(members, at_once, gap)
        count, size, low = len(members), len(cliques[0]), self.least
        places = [(least[count + e] - T, T - max(self.R, least[count - e])) for e in range(count)]
        found = 0
        while fits := [max(first, low) for first, last in places if max(first, low) <= last]:
            found, low = found + 1, min(fits) + self.D
        self.refuted |= found < count
        gap = min(gap, self.R)
        if 0 <= T - size * gap < gap and {len(clique) for clique in cliques} == {size} and count == size * len(cliques):
            rooms = self.rooms(size, gap)
            self.share(rooms, count)
            self.refuted |= len(cliques) == 1 and not permute(rooms, 1, 0, 1)
        whole = [clique for clique in gaps if clique != members and not any(clique < other for other in gaps)]
        return [(members, least)] + [(clique, self.pace(clique, 1, gaps[clique])) for clique in whole]

    def pace(self, members, at_once, gap):
        """At most this many firings in a row lie within a gap: this many steps take a gap, also over several 2 T."""
        size, gap = len(members), min(gap, *(self.problem.R[x] for x in members))
        return [max(gap * ((steps + 2 * size * turns) // at_once) - 2 * self.T * turns for turns in range(at_once))
                for steps in range(2 * size + 1)]

def permute(rooms, each, more, alike, moved=()):
    """True if some permutation of places moves no more sensors by each distance than there is room for: `each` sensors
    with each place, one more with `more` of the places, and `alike` places by the same distance and direction."""
    n, moves = len(rooms), Counter(moved)
    places = [moves[c] + moves[-c] * (c > 0) for c in range(n)]
    if any(count > room // each * alike for count, room in zip(places, rooms)):
        return False
    if len(moved) == n:
        spare = sum(min(count, room - count // alike * each) for count, room in zip(places, rooms))
        return spare >= more and not any(count % alike for count in moves.values())
    taken = {place + by for place, by in enumerate(moved)}
    return any(permute(rooms, each, more, alike, (*moved, to - len(moved))) for to in range(n) if to not in taken)

class Lanes:
    """Numbers side by side in one integer: number x has the bits from x * width on, the highest of them 0. So to add or
    compare all of two rows takes a few operations on integers, however many numbers they have."""
    def __init__(self, width, count):
        self.width, self.size, self.code = width, count * width // 8, "H" if width == 16 else "I"
        self.ones = repeated(width, count)  # v times this is v in each lane
        self.top = self.ones << width - 1  # the highest bits: those of some lanes stand for a set of them
        self.most = self.top - self.ones  # all other bits

    def not_less(self, p, q):
        """The lanes in which p >= q, as a set: a lane that is not less than q keeps the bit that is put on top of it."""
        return (p | self.top) - q & self.top

    def least(self, p, q):
        tops = (p | self.top) - q & self.top
        return p ^ (p ^ q) & tops - (tops >> self.width - 1)

    def members(self, tops):
        while tops:  # from the highest down
            bits = tops.bit_length()
            tops ^= 1 << bits - 1
            yield bits // self.width - 1

    def pack(self, numbers):
        return sum(number << self.width * x for x, number in enumerate(numbers))

    def unpack(self, row):
        numbers = array(self.code, row.to_bytes(self.size, "little"))
        if sys.byteorder == "big":
            numbers.byteswap()
        return numbers

class Node:
    """Knowledge at a node. M holds upper bounds on all t[j] - t[i], row by row, each plus zero; event 0 is the start of
    a phase, 1 + 2 x is x in phase a, 2 + 2 x in phase b. |d[x]| is at least low[x]. below[y] is the set of those with a
    smaller |d|, above[x] of those with a larger one. fired are those that fire first, phase a before phase b. Rules
    only tighten, and more if given more, so all orders of applying them end in the same state: the fixpoint."""

    def __init__(self, problem, reverse):
        self.problem, self.reverse, self.seen, self.fired = problem, reverse, None, ()
        D, G, count = problem.D, problem.G, len(problem.D)
        self.size = size = 1 + 2 * count
        # A bound is at most latest, and at least -latest, as it adds to 0 or more with the one the other way. So bounds
        # plus zero are not negative, even less the span of a set, and sums of three are below four times zero.
        self.zero = zero = problem.bound + sum(D)
        width = 16 if 4 * zero < 1 << 15 else 32
        self.lanes, self.all = Lanes(width, count), Lanes(width, size * size)
        self.at = at = [[width * (size * i + j) for j in range(size)] for i in range(size)]
        self.lane, self.row, self.zeros = (1 << width) - 1, (1 << width * size) - 1, zero * self.all.ones
        self.first = repeated(width * size, size)  # 1 in the first lane of each row
        self.column = self.first * self.lane
        # A lane at the start of a row, or the first row, is repeated by doubling.
        self.doublings = [width * min(1 << n, size - (1 << n)) for n in range((size - 1).bit_length())]
        latest = problem.bound - 2  # firing times are below T, and T below the bound
        diagonal = repeated(width * (size + 1), size)
        self.M = self.zeros + latest * (self.all.ones - self.first - diagonal + 1)
        self.least = sum(min(least, zero) + zero << at[i][j] for i, j, least, _ in problem.orders)
        self.other = sum(max(other, -zero) + zero << at[i][j] for i, j, _, other in problem.orders)
        self.order = {size * i + j: (i, j, other) for i, j, _, other in problem.orders}
        self.low = [(D + 1) // 2 * problem.stale_echo for D in D]
        self.one = [1 << width * x + width - 1 for x in range(count)]
        self.below, self.above = [0] * count, [0] * count
        self.apart = [self.lanes.pack([max(mine, own) for own in D]) for mine in D]
        self.width, self.widths = [own * self.lanes.ones for own in D], self.lanes.pack(D)
        # For rule 6: two sensors, and where M has the bounds on a[x] - a[y] and b[y] - b[x].
        (a, b), every = zip(*problem.ends), range(count)
        self.pairs = [(x, y, size * a[y] + a[x], size * b[x] + b[y]) for x in every for y in every if G[x][y]]
        self.groups = {}

    def assuming(self, *facts):
        """The node with these facts and all that follows from them; None if it is refuted."""
        node = copy.copy(self)
        node.low, node.below, node.above = self.low[:], self.below[:], self.above[:]
        try:
            for learn, *what in facts:
                learn(node, *what)
            while node.orders() or node.sizes() or node.precedence():
                pass
        except Refuted:
            return None
        return node

    def bound(self, i, j):
        return (self.M >> self.at[i][j] & self.lane) - self.zero

    def learn(self, i, j, bound):
        """Rule 1, closure: t[k] - t[h] = (t[i] - t[h]) + (t[j] - t[i]) + (t[k] - t[j]): bounds add along paths, and a
        closed path is 0."""
        M, at = self.M, self.at
        if bound + self.zero >= M >> at[i][j] & self.lane:
            return False
        if bound + self.bound(j, i) < 0:
            raise Refuted
        to = M >> at[0][i] & self.column  # from h to i, for all h
        to += bound * self.first
        on = M >> at[j][0] & self.row  # from j to k, for all k
        for shift in self.doublings:
            to |= to << shift
            on |= on << shift * self.size
        self.M = self.all.least(M, to + on - self.zeros)
        return True

    def learn_high(self, x, bound):  # on |d[x]|
        return self.learn(2 + 2 * x, 1 + 2 * x, bound) | self.learn(1 + 2 * x, 2 + 2 * x, bound)
    def high(self, x):
        return max(self.bound(2 + 2 * x, 1 + 2 * x), self.bound(1 + 2 * x, 2 + 2 * x))
    def learn_low(self, x, bound):
        self.low[x] = max(bound, self.low[x])

    def is_below(self, x, y):
        return self.below[y] & self.one[x]

    def learn_below(self, x, y):
        self.learn_all_below(self.one[x], y)
    def learn_all_below(self, some, y):
        """The relation "below" is transitive and has no cycles."""
        if some := some & ~self.below[y]:
            down, up = some, self.above[y] | self.one[y]
            for x in self.lanes.members(some):
                down |= self.below[x]
            if down & up:
                raise Refuted
            for z in self.lanes.members(up):
                self.below[z] |= down
            for z in self.lanes.members(down):
                self.above[z] |= up

    def orders(self):
        """Rule 2: if y cannot come its gap after x, then y comes first, as one of two firings does."""
        news, M, lanes = False, self.M, self.all
        for order in lanes.members(lanes.top ^ (lanes.not_less(M, self.least) | lanes.not_less(self.other, M))):
            news |= self.learn(*self.order[order])
        for i, j, then_j, then_i, gap in self.reverse:  # assumed at the root
            news |= self.bound(i, j) <= -gap and self.learn(then_j, then_i, -gap)
        return news

    def sizes(self):
        """Rule 3: d <= v < 0 gives |d| >= -v; and if |d| >= v and d < v, then d <= -v. The same for -d.
        Rule 4: if |d[x]| cannot be D above |d[y]|, it is below. Then |d[y]| is above the lowest of any set below it by
        the width of the set with y; the same upside down.
        Rule 5 (Hall): those whose |d| lies in an interval span no more than its width."""
        lanes, zero, news, low, size = self.lanes, self.zero, False, self.low, self.size
        self.bounds = bounds = self.all.unpack(self.M)
        highs, every = [], range(len(low))
        self.mosts = [[bound - zero for bound in bounds[first::2 * size + 2]] for first in (2 * size + 1, size + 2)]
        for x, positive, negative in zip(every, *self.mosts):
            least = low[x] = max(low[x], -positive, -negative)
            if least > positive:
                if least > negative:
                    raise Refuted
                news |= self.learn(2 + 2 * x, 1 + 2 * x, -least)
            elif least > negative:
                news |= self.learn(1 + 2 * x, 2 + 2 * x, -least)
            highs.append(max(positive, negative))
        if news:
            return True
        seen = highs, low[:], self.below[:]
        if seen == self.seen:
            return False
        high, ones = lanes.pack(highs), lanes.ones
        highs_then, low_then, below_then = self.seen or (None, None, None)  # nothing is new that follows from these
        for y in every:
            if highs != highs_then or low[y] != low_then[y]:
                less = lanes.top ^ lanes.not_less(high, self.apart[y] + low[y] * ones)
                self.learn_all_below(less & ~self.one[y], y)
        if low != low_then or self.below != below_then:
            # Upside down, so that the lowest |d| below another has the least bound.
            for y, bound in enumerate(lanes.unpack(self.beyond([-bound for bound in low], self.above, self.widths))):
                if zero - bound > low[y]:
                    low[y], news = zero - bound, True
                    if low[y] > highs[y]:
                        raise Refuted
        within, above = {}, 0
        for x in sorted(every, key=low.__getitem__):
            above |= self.one[x]
            within[low[x]] = above
        end = self.beyond(highs, [within[bound] for bound in low], 0)
        if lanes.not_less(end, lanes.pack(low) + zero * ones) != lanes.top:
            raise Refuted
        for y, bound in enumerate(lanes.unpack(self.beyond(highs, self.below, self.widths))):
            if bound - zero < highs[y]:
                news |= self.learn_high(y, bound - zero)
        if not news and seen[2] == self.below:
            self.seen = seen
            return False
        return True

    def beyond(self, bounds, sets, own):
        """For each lane y a bound on what is below all of a set, plus zero, given upper bounds of its members: x is in
        it if y is in sets[x]. own holds what y itself adds to the span. Values max(D, D') apart span the sum of their D
        but the smallest: outwards from there, each step is the D it leads to or more."""
        lanes, D = self.lanes, self.problem.D
        widest, most, least, high, zero = max(D), lanes.most, lanes.least, lanes.width - 1, self.zero
        narrowest, span, best = own or widest * lanes.ones, own, most
        for x in sorted(range(len(D)), key=bounds.__getitem__):
            if ys := sets[x]:
                inside = ys - (ys >> high)
                span += self.width[x] & inside
                if D[x] < widest:
                    narrowest = least(narrowest, self.width[x] & inside | most ^ inside)
                best = least(best, (bounds[x] + zero) * lanes.ones + narrowest - span & inside | most ^ inside)
        return best

    def left(self, _=None):
        """Return the sensors that may fire next, in ascending order."""
        count = len(self.low)
        begun = self.fired[len(self.fired) // count * count:]
        return [x for x in range(count) if x not in begun and len(self.fired) < 2 * count]

    def place(self, x):
        """Rule 7: x is the next to fire; of those at the same instant the one with the lowest number. Of each set the
        others of this phase are still to come, and there is a least time from each firing to this, and on to it."""
        problem, period, count = self.problem, self.problem.bound - 1, len(self.low)
        phase, ends = len(self.fired) // count, problem.ends
        own = ends[x][phase]
        for y in self.left():
            if y != x:
                self.learn(ends[y][phase], own, -(y < x))
        for members, least in problem.sets:
            if x in members:
                size = len(members)
                before = [(ends[y][at // count], at // count) for at, y in enumerate(self.fired) if y in members]
                self.learn(0, own, period - 1 - least[size * (1 + phase) - 1 - len(before)])
                self.learn(own, 0, period - least[len(before) + size * (1 - phase)])
                for steps, (event, then) in zip(range(len(before), 0, -1), before):
                    since = period * (phase - then)
                    self.learn(own, event, since - least[steps])
                    self.learn(event, own, 2 * period - least[2 * size - steps] - since)
        self.fired += (x,)

    def precedence(self):
        """Rule 6: the orders of x and y may force d[x] - d[y] <= lead < 0. Of a set of such x, the last is as far above
        the lowest as the set spans, and y at least the smallest -lead beyond it. The same for -d."""
        news, M, D, zeros, (positive, negative) = False, self.bounds, self.problem.D, 2 * self.zero, self.mosts
        groups = {}
        for x, y, in_a, in_b in self.pairs:
            if (lead := M[in_a] + M[in_b] - zeros) < 0:
                groups.setdefault((1 + 2 * y, 2 + 2 * y), []).append((lead, negative[x], D[x]))
                groups.setdefault((2 + 2 * x, 1 + 2 * x), []).append((lead, positive[y], D[y]))
        for ends, group in groups.items():
            if len(group) > 1 and group != self.groups.get(ends):  # of one x alone it follows by rule 1
                for lead in {lead for lead, _, _ in group}:
                    most = beyond([(most, D) for other, most, D in group if other <= lead])
                    news |= self.learn(*ends, most + lead)
        self.groups = groups
        return news

def repeated(distance, count):
    return ((1 << distance * count) - 1) // ((1 << distance) - 1)  # bits at this distance, from the lowest on

def beyond(values):
    """A bound on what is below all values, given as upper bounds and separations: as in Node.beyond, for one set."""
    bounds, separations = zip(*sorted(values))
    spans, narrowest = accumulate(separations), accumulate(separations, min)
    return min(bound - (span - D) for bound, span, D in zip(bounds, spans, narrowest))

def root(lines, problem):
    """Knowledge at the root. A permutation that keeps the problem takes schedules to schedules; if it keeps earlier
    orbits and their greatest, it keeps what was assumed of them. So any of an orbit may have its greatest |d|. To
    exchange the phases turns all d to -d: one d is not negative. To reverse time as well keeps all d, and y before x in
    both phases becomes x before y: assume that it is not so. That needs gaps alike both ways."""
    every, one, gap, groups = range(problem.sensors), problem.one, problem.gap, problem.together
    earlier, facts, reverse, has_first = [], [], [], False
    period = problem.bound - 1
    for x, (a, b) in enumerate(problem.ends):
        facts.append((Node.learn_high, x, period - problem.R[x]))
        for wait, (next_a, next_b) in zip(problem.G[x], problem.ends):
            if wait:  # after x in a phase, y in the next one
                facts += [(Node.learn, next_b, a, period - wait), (Node.learn, next_a, b, period - wait)]
    while lines.is_next("permutation"):
        images, orbit = [], set()
        while lines.is_next("permutation"):
            images.append(image := lines.next("permutation", len(every), 0, len(every) - 1))
            kept = sorted(image) == [*every] and all(sorted(image[x] for x in group) in groups for group in groups)
            kept = kept and all(row[x] == row[image[x]] for row in (problem.separation, problem.window) for x in every)
            kept = kept and all(gap[x][y] == gap[image[x]][image[y]] for x in every for y in every)
            kept = kept and all(image[x] == x and {image[y] for y in others} == others for x, others in earlier)
            lines.require(kept, "expected a permutation that keeps the problem, and earlier orbits with their greatest")
        word = "first" if lines.is_next("first") else "greatest"
        (greatest,) = new = lines.next(word, 1, 0, len(every) - 1)
        while new:
            orbit |= set(new)
            new = {image[x] for image in images for x in new} - orbit
        if word == "greatest":
            facts += [(Node.learn_below, one[x], one[greatest]) for x in orbit if one[x] != one[greatest]]
        else:
            later = [problem.ends[one[x]][phase] for x in orbit for phase in range(1 + (not earlier))]
            facts += [(Node.learn, event, problem.ends[one[greatest]][0], 0) for event in later]
            has_first = True
        earlier.append((greatest, orbit))
    lines.require(not has_first or not (lines.is_next("exchange") or lines.is_next("reverse")), "found what first excludes")
    if lines.is_next("exchange"):
        facts.append((Node.learn, *problem.ends[one[lines.next("exchange", 1, 0, len(every) - 1)[0]]], 0))
    if lines.is_next("reverse"):
        x, y = (one[x] for x in lines.next("reverse", 2, 0, len(every) - 1))
        (i, k), (j, m), fine = problem.ends[x], problem.ends[y], gap == [list(column) for column in zip(*gap)]
        lines.require(problem.G[x][y] and fine, "expected two sensors with a gap, and all gaps alike both ways")
        reverse = [(i, j, m, k, problem.G[x][y]), (k, m, j, i, problem.G[x][y])]
    return Node(problem, reverse).assuming(*facts)

def branching(lines, node):
    """The cases of the next line, one of which holds in every schedule: each what to learn."""
    problem, every = node.problem, node.problem.sensors - 1
    if lines.is_next("next"):
        left = node.left(lines.next("next", 0))
        lines.require(left, "here all have fired twice")
        return [(Node.place, x) for x in left]
    word = next((word for word in ("split", "sign", "rank", "b") if lines.is_next(word)), "a")
    sensors = lines.next(word, 1 if word == "sign" else 2, 0, LARGEST if word == "split" else every)
    lines.require(sensors[0] <= every, f"found sensor {sensors[0]}, expected 0 to {every}")
    x, y = problem.one[sensors[0]], None if word in ("sign", "split") else problem.one[sensors[1]]
    if word == "split":
        value = sensors[1]
        decided = node.low[x] > value or node.high(x) <= value
        cases = (Node.learn_high, x, value), (Node.learn_low, x, value + 1)
    elif word == "rank":
        lines.require(x != y, "expected two sensors that do not fire together")
        decided = node.is_below(x, y) or node.is_below(y, x)
        cases = (Node.learn_below, x, y), (Node.learn_below, y, x)
    else:
        (i, j), bounds = problem.ends[x], (0, -1)  # d[x] >= 0, or d[x] < 0
        if word != "sign":
            lines.require(problem.G[x][y], "expected two sensors with a gap")
            (j, i), G = (problem.ends[one][word == "b"] for one in (x, y)), problem.G
            bounds = -G[x][y], -G[y][x]  # x first, or y
        decided = node.bound(i, j) <= bounds[0] or node.bound(j, i) <= bounds[1]
        cases = (Node.learn, i, j, bounds[0]), (Node.learn, j, i, bounds[1])
    lines.require(not decided, "here it is known which case holds, expected an open branching")
    return cases

def check(text):
    """Returns the problem, whose claim is true; raises Refused."""
    problem = Problem(lines := Lines(text))
    node, waiting = None if problem.is_refuted else root(lines, problem), []  # open nodes with the cases still to come; the tree is in preorder
    while node or waiting:
        if node:  # not refuted, so it must branch
            lines.require(len(waiting) < DEPTH, f"the tree is deeper than {DEPTH}")
            waiting += [(node, case) for case in reversed(branching(lines, node))]
        node, case = waiting.pop()
        node = node.assuming(case)
    lines.next("end", 0)
    lines.require(lines.lines[lines.read:] == [[""], [""]], "expected nothing after the line end")
    return problem

def main(paths):
    """Prints a line for each file. Returns 0 if all claims are true, 1 if one is refused, 2 if one cannot be read."""
    code = 0 if paths else 2
    if not paths:
        print("usage: check_period.py FILE ..., or - for the files' names as lines of the input", file=sys.stderr)
    for path in paths:
        try:
            with open(path, "rb") as file:
                text = file.read().decode()
            print(f"{path}: " * (len(paths) > 1) + check(text).claim())
        except Refused as error:
            print(f"refused: {path}: {error}")
            code = max(code, 1)
        except (ValueError, OSError) as error:
            print(f"{path}: {error}", file=sys.stderr)
            code = 2
    return code

if __name__ == "__main__":
    sys.exit(main(sys.stdin.read().splitlines() if sys.argv[1:] == ["-"] else sys.argv[1:]))

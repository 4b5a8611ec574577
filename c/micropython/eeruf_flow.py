"""Flow in MicroPython: one sensor after the other, each with as much quiet around its firing as it has needed. Beside
eeruf.py.

    from eeruf import ACCEPTED, KIND, SENSOR, T_ECHO
    from eeruf_flow import Flow, HcSr04FlowRing

    # Eight modules with a longest echo of 36 ms that rest for 60 ms. A loop in MicroPython fires late by up to half of
    # the step of the code: no table is designed.
    flow = Flow(8, 37000, rest_us=60000, lead_us=20000, step_us=1200)
    ring = HcSr04FlowRing(flow, pins=[2, 3, 4, 5, 6, 7, 8, 9])
    while True:
        reading = ring.read()
        if reading and reading[KIND] == ACCEPTED:
            print(reading[SENSOR], reading[T_ECHO] * 1716 // 10000, "mm")

`FlowRing` does, event by event, what the Rust crate eeruf-core does with a flow ring. Rules: docs/explanation/flow.md.

Licence: MIT OR Apache-2.0.
"""

from eeruf import (
    ACCEPTED, CLEAR, FIRST, NEEDS_ANSWER, NEVER, NO_ECHO, NOBODY, REJECTED, STUCK, TENTATIVE, TOO_EARLY, UNANSWERED, HcSr04Ring,
    Ring, _Sensor,
)  # fmt: skip

MAX_WINDOW_US = 16711679  # echo times are told apart up to it
_SILENCE = (1 << 30) - 1  # the echo time of a sensor with nothing in range: later than all, near none
_QUIET_US = 256  # the unit of quiet
_CATCHES_UP_US = 1000  # a firing that is later moves all that follow
_HYPOTHESES = 4
_LEAST_CHANGE_US, _MOST_CHANGE_US = 40, 32767  # an expected change outside says nothing of how much of it there is
_WHOLE, _MOST_SURPLUS = 64, 80  # as much more as is expected; more is not of one echo
_MOVING_VOTES = 3  # for a tentative echo while odometry moves: any two readings are those of some wall
_MOVING_MEMORY = 3  # and confirmed echoes are remembered for three times as long
_REGAINED = 2  # the least score of a track that is confirmed again
# Places in a track, a hypothesis about a sensor's echo, and its flags.
_AT, _PHASES, _SCORE, _CLOSE, _FLAGS, _AGE = range(6)
_CONFIRMED, _CONTRADICTED, _REMEMBERED = 1, 2, 4


def _quiet(time_us):
    return min(time_us // _QUIET_US, 255)


def _in_units(time_us, unit_us):
    return (time_us + unit_us - 1) // unit_us


def _share(number, of):
    """A quotient, rounded towards zero."""
    quotient = abs(number) // abs(of)
    return quotient if (number < 0) == (of < 0) else -quotient


def _is_prime(number):
    divisor = 2
    while divisor * divisor <= number:
        if number % divisor == 0:
            return False
        divisor += 1
    return True


def _primitive_root(prime):
    root = 2
    while True:
        power, order = root, 1
        while power != 1:
            power, order = power * root % prime, order + 1
        if order == prime - 1:
            return root
        root += 1


def _stride(sensors):
    """The distance in the ring from one firing to the next: neighbours hear each other loudest."""
    stride = sensors // 3 + 1 if sensors > 6 else 1
    while True:
        a, b = stride, sensors
        while b:
            a, b = b, a % b
        if a == 1:
            return stride
        stride += 1


class Flow:
    """Settings of a flow ring of this many sensors that listen for `window_us`, named as in C's `EerufFlowConfig`. A sensor
    fires no sooner than `rest_us` after its last firing. `lead_us` is the time before a cycle begins at which it is
    planned, for boards that take long for it."""

    def __init__(
        self, sensors, window_us, blanking_us=0, reach_us=None, step_us=240, shortest_gap_us=7500, masked_adds_us=4000,
        believed_takes_us=1500, unserved_adds_us=6000, unserved_after=3, shortest_cycle_us=60000, rest_us=0, lead_us=0,
        longest_cycle_us=400000, travel_us=260, t_delta_us=150, near_us=400, tentative_within_us=60, votes=5,
        score_limit=6, contradiction=2, tentative_votes=2, memory=5,
    ):  # fmt: skip
        for name, value, least, most in (
            ("sensors", sensors, 1, 64),
            ("window_us", window_us, 1, MAX_WINDOW_US),
            ("t_delta_us", t_delta_us, 1, 65535),
            ("step_us", step_us, t_delta_us + 1, 65535),
            ("near_us", near_us, t_delta_us, 65535),
            ("tentative_within_us", tentative_within_us, 0, t_delta_us),
            ("votes", votes, 2, 15),
            ("score_limit", score_limit, votes, 15),
            ("contradiction", contradiction, 1, 15),
            ("tentative_votes", tentative_votes, 0, 15),
            ("memory", memory, 0, 255),
        ):
            if not least <= value <= most:
                raise ValueError("%s = %d: %d to %d expected" % (name, value, least, most))
        if tentative_votes == 1:
            raise ValueError("tentative_votes = 1: 0, or 2 to 15 expected")
        # Welch's sequence: places on the grid, by the powers of a primitive root of a prime.
        prime = max(votes, sensors + 1)
        if prime < 67:
            prime += 1
        prime = max(prime, 5)
        while not _is_prime(prime):
            prime += 1
        self.cycle, self.root, self.step_us = prime - 1, _primitive_root(prime), step_us
        width_us = (prime - 2) * step_us
        if not window_us + width_us <= shortest_cycle_us <= 1 << 28:
            needs = shortest_cycle_us, window_us + width_us
            raise ValueError("shortest_cycle_us = %d: at least the window and the code, %d us, expected" % needs)
        self.sensors, self.window_us, self.blanking_us, self.t_delta_us = sensors, window_us, blanking_us, t_delta_us
        self.near_us, self.tentative_within_us, self.votes, self.score_limit = (
            near_us, tentative_within_us, votes, score_limit,
        )  # fmt: skip
        self.contradiction, self.tentative_votes, self.memory = contradiction, tentative_votes, memory
        # The difference in lateness with which crosstalk still moves: a track may be off by as much as its readings.
        self.tolerated = (step_us - t_delta_us - 1) // 2
        unit_us = self.unit_us = width_us + 2 * step_us
        # Nothing of a firing is heard in a window that opens so much later.
        dies_us = max((window_us if reach_us is None else reach_us) - blanking_us, window_us) + 1
        self.least = _quiet(shortest_gap_us)
        self.most = max(_quiet(dies_us + width_us), self.least)
        self.masked_adds, self.believed_takes = _quiet(masked_adds_us), _quiet(believed_takes_us)
        self.unserved_adds, self.unserved_after = _quiet(unserved_adds_us), max(unserved_after, 1)
        self.least_gap = min(max(_in_units(self.least * _QUIET_US, unit_us), 1), 255)
        self.shortest = _in_units(shortest_cycle_us, unit_us)
        self.rounded_up = self.shortest * unit_us != shortest_cycle_us
        self.longest = max(min(longest_cycle_us, 1 << 28), shortest_cycle_us) // unit_us
        self.travel_us = min(travel_us, 65535)
        self.lead_us = _quiet(min(lead_us, shortest_cycle_us)) * _QUIET_US
        self.min_refire_us = max(min(rest_us, MAX_WINDOW_US), window_us)
        self.stride = _stride(sensors)
        # A cycle of least gaps may be longer than the longest that is asked for.
        cycle_us = max(sensors * self.least_gap, self.longest + 1) * unit_us
        self.horizon_us = 2 * cycle_us + self.min_refire_us


class _FlowSensor(_Sensor):
    def __init__(self, long_ago_us, quiet):
        _Sensor.__init__(self, long_ago_us, 1)
        self.before = self.after = quiet
        self.lag_us = self.place = self.late_us = self.unserved = 0
        self.has_fired = False
        self.forget_tracks()

    def forget_tracks(self):
        # The change of readings that is not expected, in 1/64 of what is: known so far, and of the last two.
        self.surplus, self.observed, self.last_us = 0, None, _SILENCE
        self.tracks = [[_SILENCE, 0, 0, 0, 0, 255] for _ in range(_HYPOTHESES)]

    def believed(self):
        """The earliest confirmed echo time, silence being the latest; None if none is confirmed."""
        earliest = None
        for track in self.tracks:
            if track[_FLAGS] & _CONFIRMED and (earliest is None or track[_AT] < earliest):
                earliest = track[_AT]
        return earliest

    def firing_changed(self):
        """Unconfirmed echoes cannot be compared with later ones."""
        for track in self.tracks:
            if not track[_FLAGS] & _CONFIRMED:
                track[_PHASES] = track[_CLOSE] = 0
                track[_FLAGS] &= _CONTRADICTED
                track[_SCORE] = min(track[_SCORE], 1)

    def move(self, change_us):
        """The tracks move with the robot."""
        change_us = min(max(change_us, -32768), 32767)
        change_us += _share(change_us * self.surplus, _WHOLE)
        for track in self.tracks:
            moved_us = track[_AT] + change_us
            if track[_AT] != _SILENCE and 0 <= moved_us <= MAX_WINDOW_US:
                track[_AT] = moved_us

    def learn(self, at_us, change_us, t_delta_us):
        """Two pairs of consecutive readings that change alike tell how much of the expected change there really is."""
        last_us, self.last_us = self.last_us, at_us
        if not _LEAST_CHANGE_US <= abs(change_us) <= _MOST_CHANGE_US or _SILENCE in (at_us, last_us):
            return
        observed = _share(_WHOLE * (at_us - last_us), change_us) - _WHOLE
        if abs(observed) > _MOST_SURPLUS:
            return
        before, self.observed = self.observed, observed
        if before is not None and abs(observed - before) * abs(change_us) <= _WHOLE * t_delta_us:
            known = self.surplus + _share(observed - self.surplus, 2)
            self.surplus = min(max(known, -_WHOLE), _WHOLE)

    def begin_track(self, at_us, phase):
        weakest = None
        for track in self.tracks:
            flags = track[_FLAGS]
            rank = (flags & _CONFIRMED, flags & _REMEMBERED, track[_SCORE], -track[_AGE])
            if weakest is None or rank < lowest:  # noqa: F821
                weakest, lowest = track, rank
        weakest[:] = at_us, phase, 1, 1, 0, 0


def _votes(track):
    phases, votes = track[_PHASES], 0
    while phases:
        phases &= phases - 1
        votes += 1
    return votes


def _grow_older(track):
    if track[_AGE] < 255:
        track[_AGE] += 1


def _miss(track, phase, how):
    """Its last firing in this phase did not support a confirmed track. One phase alone keeps none confirmed."""
    track[_PHASES] &= ~phase
    if track[_FLAGS] & _CONFIRMED and _votes(track) < 2:
        track[_FLAGS] ^= _CONFIRMED
        if how.memory:
            track[_FLAGS] |= _REMEMBERED


def _support(track, at_us, phase, how, memory):
    is_new = not track[_PHASES] & phase
    way_us = at_us - track[_AT]
    if is_new and abs(way_us) <= how.tentative_within_us and track[_CLOSE] < 255:
        track[_CLOSE] += 1
    track[_PHASES] |= phase
    # A path repeats itself in its own phase for ever, so that says nothing new of a track yet to be confirmed.
    if is_new or track[_FLAGS] & _CONFIRMED:
        track[_SCORE] = min(track[_SCORE] + 1, how.score_limit)
    if track[_FLAGS] & _REMEMBERED and track[_AGE] <= memory:
        track[_FLAGS] |= _CONFIRMED
        track[_SCORE] = max(track[_SCORE], _REGAINED)
    track[_FLAGS] &= ~_REMEMBERED
    track[_AGE] = 0
    if track[_AT] != _SILENCE:
        # A quarter of the way, so that one early or late edge does not move it far.
        track[_AT] += _share(way_us, 4)
    if track[_SCORE] >= how.votes and _votes(track) >= how.votes:
        track[_FLAGS] |= _CONFIRMED


def _contradict(track, phase, how, memory):
    """A later reading, or silence: its echo would have come first."""
    weight = how.contradiction if track[_FLAGS] & _CONFIRMED else 1
    if track[_SCORE] > weight:
        track[_SCORE] -= weight
        track[_FLAGS] |= _CONTRADICTED
        _grow_older(track)
        _miss(track, phase, how)
    elif track[_FLAGS] & (_CONFIRMED | _REMEMBERED) and track[_AGE] < memory:
        _grow_older(track)
        track[_PHASES], track[_SCORE], track[_CLOSE], track[_FLAGS] = 0, 1, 0, _CONTRADICTED | _REMEMBERED
    else:
        # Were it confirmed still, it would keep its place from all that come.
        track[:] = _SILENCE, 0, 0, 0, 0, 255


class FlowRing(Ring):
    """A ring that fires by flow, polled as a `Ring`. It never accepts a single path of foreign sound that is heard within
    `reach_us`, the window if not said, of its firing. TENTATIVE readings have little support so far, and none against them."""

    def __init__(self, flow, now_us, clock_bits=32):
        self._listen(flow.t_delta_us, flow.window_us, flow.blanking_us, clock_bits)
        if flow.horizon_us >= self._half:
            cycle_us = flow.horizon_us // 2
            raise ValueError("cycles of up to %d us: too long for a clock of %d bits" % (cycle_us, clock_bits))
        self.flow = flow
        self._proven = False
        long_ago_us = self._known_at(now_us)
        self._begin([_FlowSensor(long_ago_us, flow.least) for _ in range(flow.sensors)], now_us)
        self._phase, self._changed, self._paused, self.changes = 0, False, False, 0
        self._start, self._length, self._fastest_us = now_us, flow.shortest, 0
        # The least and the most by which firings of this cycle and of the two before were late.
        self._least_late, self._most_late = [0xFFFF] * 3, [0] * 3
        # The sensors in the order of firing, and the gap after each firing of the cycle, in units of the grid.
        self._order, self._gaps = bytearray(flow.sensors), bytearray(flow.sensors)
        # Each is a phase behind the one that fires before it.
        x = 0
        for turn in range(flow.sensors):
            place = 0
            for _ in range(flow.cycle - turn):
                place = self._next_place(place)
            self._sensors[x].place = place
            x = (x + flow.stride) % flow.sensors
        self._plan()

    def _next_place(self, place):
        return (place + 1) * self.flow.root % (self.flow.cycle + 1) - 1

    def quiet_us(self, x):
        """The quiet that a sensor gets before its firing and after it."""
        sensor = self._sensors[x]
        return sensor.before * _QUIET_US, sensor.after * _QUIET_US

    # -- Firing: the gaps of the cycle that begins, on a grid --

    def _gap_for(self, quiet):
        return max(min(_in_units(quiet * _QUIET_US, self.flow.unit_us), 255), self.flow.least_gap)

    def _plan(self):
        flow, order, sensors = self.flow, self._order, self._sensors
        most = flow.longest
        if self._fastest_us:
            # The shorter the faster the robot moved in the last.
            most = min(most, min(self._length, 0xFFFF) * flow.travel_us // self._fastest_us)
        most = max(most, flow.shortest - flow.rounded_up)
        self._fastest_us = self._place = planned = x = 0
        for _ in sensors:
            if sensors[x].enabled:
                order[planned] = x
                planned += 1
            x = (x + flow.stride) % flow.sensors
        self._planned = planned
        self._give_gaps(planned, most)
        at = 0
        for place in range(planned):
            sensor = sensors[order[place]]
            sensor.lag_us = at * flow.unit_us
            short_us = self._rests_for(sensor) - self._offset(sensor)
            if short_us > 0:
                at += _in_units(short_us, flow.unit_us)
                sensor.lag_us = at * flow.unit_us
            at += self._gaps[place]
        self._length = max(at, flow.shortest)
        if self._paused:
            self._planned = 0
        self._look_ahead()

    def _give_gaps(self, planned, most):
        """Gives each firing the gap to the next that the sensors on both sides need, within `most` units in all."""
        sensors, order, gaps = self._sensors, self._order, self._gaps
        total = 0
        for place in range(planned):
            previous = (place or planned) - 1
            quiet = max(sensors[order[previous]].after, sensors[order[place]].before)
            gaps[previous] = self._gap_for(quiet)
            total += gaps[previous]
        if total <= most:
            return
        # All get the least, and what is left whoever has been unserved for longest.
        least = self.flow.least_gap
        for place in range(planned):
            gaps[place] = least
        left = max(most - least * planned, 0)
        for place in sorted(range(planned), key=lambda place: (-sensors[order[place]].unserved, place)):
            sensor = sensors[order[place]]
            for at, quiet in (((place or planned) - 1, sensor.before), (place, sensor.after)):
                more = min(max(self._gap_for(quiet) - gaps[at], 0), left)
                gaps[at] += more
                left -= more
            if not left:
                return

    def _offset(self, sensor):
        return sensor.lag_us + sensor.place * self.flow.step_us

    def _rests_for(self, sensor):
        """Time after the start of the cycle before which a sensor must not fire, since it still listens, or rests."""
        if not sensor.has_fired:
            return 0
        rest_us = self.flow.min_refire_us
        waits_us = (sensor.firings[0] + rest_us - self._start) & self._mask
        # A clock that has jumped says nothing about when that was.
        return 0 if waits_us > rest_us + _CATCHES_UP_US else waits_us

    def _look_ahead(self):
        self._next, after_us = NOBODY, self._length * self.flow.unit_us - self.flow.lead_us
        if self._place < self._planned:
            self._next = self._order[self._place]
            after_us = self._offset(self._sensors[self._next])
        self._due = (self._start + after_us) & self._mask

    def upcoming(self):
        """The firings to come up to the end of this cycle, as (sensor, instant): see `Ring.upcoming`."""
        for place in range(self._place, self._planned):
            x = self._order[place]
            yield x, self._due if place == self._place else (self._start + self._offset(self._sensors[x])) & self._mask

    def _horizon(self):
        return self.flow.horizon_us

    def _end_schedule_period(self, now_us):
        flow = self.flow
        left_out = (now_us - self._due) & self._mask > self._length * flow.unit_us
        self._start = now_us if left_out else (self._due + flow.lead_us) & self._mask
        self._least_late = [0xFFFF] + self._least_late[:2]
        self._most_late = [0] + self._most_late[:2]
        if left_out:
            self._break_off()
        self._phase = (self._phase + 1) % flow.cycle
        for sensor in self._sensors:
            sensor.place = self._next_place(sensor.place)
        self._plan()
        return False

    # -- Lateness: crosstalk moves as the code says while firings are late alike --

    def _break_off(self):
        self._least_late[0], self._most_late[0], self._changed = 0, 0xFFFF, True

    def _take_change(self):
        if self._changed:
            self._changed = False
            self.changes = (self.changes + 1) & 255
            for sensor in self._sensors:
                sensor.firing_changed()

    def _note(self, late_us):
        self._least_late[0] = min(self._least_late[0], late_us)
        self._most_late[0] = max(self._most_late[0], late_us)

    def _is_steady(self, sensor):
        least, most = min(self._least_late), max(self._most_late)
        tolerated = self.flow.tolerated
        return sensor.late_us - least <= tolerated and most - sensor.late_us <= tolerated

    def _fired_late(self, late_us):
        self._latest = max(self._latest, late_us)
        self._total = min(self._total + late_us, 0xFFFF)

    def _has_fired(self, sensor, now_us):
        self._place += 1
        sensor.has_fired = True
        late_us = (now_us - self._due) & self._mask
        self._is_late(sensor, late_us, late_us)

    def _is_late(self, sensor, late_us, by_us):
        sensor.late_us = min(late_us, 0xFFFF)
        self._note(sensor.late_us)
        if late_us > _CATCHES_UP_US:
            self._break_off()
            self._start = (self._start + by_us) & self._mask
        self._look_ahead()

    def fired(self, x, at_us):
        """Corrects when a sensor last fired: later than its poll. Call it before you poll for readings with its sound."""
        sensor = self._sensors[x]
        later_us = (at_us - sensor.firings[0]) & self._mask
        if later_us == 0 or later_us >= self._half:
            return
        polled = sensor.firings[0]
        sensor.firings[0] = at_us
        if sensor.echo_us is not None:
            sensor.echo_us -= later_us
            if sensor.echo_us < 0:
                # The first edge came before it fired, and may have kept out the echo.
                sensor.echo_us, sensor.outside = 0, True
        if not sensor.listening:
            return
        late_us = sensor.late_us + later_us
        # It was noted to be less late: those of this cycle are noted again, unless the timetable has moved.
        sensor.late_us = min(late_us, 0xFFFF)
        if self._most_late[0] != 0xFFFF:
            self._least_late[0], self._most_late[0] = 0xFFFF, 0
        for place in range(self._place):
            self._note(self._sensors[self._order[place]].late_us)
        self._is_late(sensor, late_us, later_us)
        self._fired_late(min(later_us, 0xFFFF))
        if self._oldest == x:
            self._find_oldest(polled)
            self._emit_when_oldest_ends()

    # -- Judging: which echo of a sensor is its own (docs/explanation/hopping.md) --

    def poll(self, now_us, change_us=None):
        """As `Ring.poll`."""
        event = Ring.poll(self, now_us, change_us)
        if event is not None:
            self._take_change()
        return event

    def _compare(self, x, change_us):
        self._take_change()
        sensor = self._sensors[x]
        echo, previous = sensor.echo_us, None
        if sensor.stuck:
            kind, echo = STUCK, None
        elif sensor.unanswered and echo is None and self.silence == NEEDS_ANSWER:
            kind = UNANSWERED
        elif sensor.outside:
            kind = TOO_EARLY
        else:
            at_us = _SILENCE if echo is None else echo
            sensor.learn(at_us, change_us, self.t_delta_us)
            sensor.move(change_us)
            kind, previous = self._weigh(sensor, at_us, change_us)
        if kind in (STUCK, UNANSWERED, TOO_EARLY):
            sensor.last_us = _SILENCE
            sensor.move(change_us)
        if kind in (ACCEPTED, TENTATIVE):
            sensor.age = 0
        elif sensor.age < NEVER - 1:
            sensor.age += 1
        self._learn(sensor, x, kind, _SILENCE if echo is None else echo, change_us)
        if kind == CLEAR and sensor.unanswered:
            kind = NO_ECHO  # without a witness it is not reported as free space
        sensor.listening = sensor.can_emit = sensor.outside = sensor.stuck = False
        sensor.echo_us = None
        return kind, echo, previous, None

    def _weigh(self, sensor, at_us, change_us):
        """Kind and what it was compared with."""
        how, phase = self.flow, 1 << (sensor.phase & 15)
        votes = how.tentative_votes
        if votes and change_us:
            votes = max(votes, _MOVING_VOTES)
        memory = min(_MOVING_MEMORY * how.memory, 255) if change_us else how.memory
        nearest, within_us = None, self.t_delta_us + 1
        for track in sensor.tracks:
            if track[_SCORE] and abs(track[_AT] - at_us) < within_us:
                nearest, within_us = track, abs(track[_AT] - at_us)
        held_us = sensor.believed()
        is_near = held_us is not None and abs(held_us - at_us) <= how.near_us
        previous = held_us if nearest is None else nearest[_AT]
        tentative = False
        if self._is_steady(sensor):
            for track in sensor.tracks:
                if not track[_SCORE]:
                    continue
                if track is nearest:
                    _support(track, at_us, phase, how, memory)
                    close = 0 if track[_FLAGS] & _CONTRADICTED else track[_CLOSE]
                    earlier = (held_us is None or track[_AT] < held_us) and track[_AT] != _SILENCE
                    tentative = earlier and votes > 0 and close >= votes
                elif is_near and track[_AT] == held_us:
                    # It follows an echo that moves faster than its support: three tenths of the way.
                    _grow_older(track)
                    track[_AT] += _share(3 * (at_us - held_us), 10)
                elif at_us > track[_AT]:
                    _contradict(track, phase, how, memory)
                else:
                    _grow_older(track)
                    if track[_FLAGS] & _CONFIRMED:
                        _miss(track, phase, how)
            if nearest is None and not is_near:
                sensor.begin_track(at_us, phase)
        believed_us = sensor.believed()
        confirmed = believed_us is not None and abs(believed_us - at_us) <= how.near_us
        if at_us == _SILENCE:
            kind = CLEAR if confirmed else NO_ECHO
        elif confirmed:
            kind = ACCEPTED
        elif tentative:
            kind = TENTATIVE
        else:
            kind = FIRST if previous is None else REJECTED
        return kind, None if previous == _SILENCE else previous

    def _learn(self, sensor, x, kind, at_us, change_us):
        """Raises a sensor's quiet if others fooled it or nothing of it is believed, lowers it if its reading is."""
        flow = self.flow
        self._fastest_us = max(self._fastest_us, min(abs(change_us), 0xFFFF))
        if kind in (STUCK, UNANSWERED):
            return  # quiet does not help a sensor that is not heard
        if kind in (ACCEPTED, CLEAR, TENTATIVE):
            sensor.unserved = 0
            if kind != TENTATIVE:
                sensor.before = max(sensor.before - flow.believed_takes, flow.least)
                sensor.after = max(sensor.after - flow.believed_takes, flow.least)
            return
        before = after = 0
        sensor.unserved = min(sensor.unserved + 1, 255)
        if sensor.unserved % flow.unserved_after == 0:
            before = after = flow.unserved_adds
        believed_us = sensor.believed()
        if believed_us is not None and at_us < believed_us:
            before += flow.masked_adds
            for place in range(self._planned):
                if self._order[place] == x:
                    if at_us > self._gaps[place] * flow.unit_us:
                        after += flow.masked_adds
                    break
            else:
                after += flow.masked_adds
        sensor.before = min(sensor.before + before, flow.most)
        sensor.after = min(sensor.after + after, flow.most)

    def confirmed_us(self, x):
        """The echo time of a sensor that is confirmed; None if none is, or nothing is in range."""
        believed_us = self._sensors[x].believed()
        return None if believed_us == _SILENCE else believed_us

    # -- What happens to it --

    def forget(self, x):
        """Forgets a sensor's echo, which is not what it seemed."""
        self._sensors[x].forget_tracks()

    def enable(self, x, enabled=True):
        """Lets a sensor fire, from the next cycle on, or not."""
        sensor = self._sensors[x]
        if enabled and not sensor.enabled:
            sensor.forget_tracks()
        sensor.enabled = enabled
        if not enabled:
            for place in range(self._place, self._planned):
                if self._order[place] == x:
                    self._planned -= 1
                    for at in range(place, self._planned):
                        self._order[at] = self._order[at + 1]
                    self._look_ahead()
                    return

    def pause(self, paused=True):
        """Lets no sensor fire until it is unset, and then as of the next cycle. Then all that was heard is forgotten."""
        self._paused = paused
        if paused:
            self._planned = self._place
        else:
            for sensor in self._sensors:
                sensor.forget_tracks()
        self._look_ahead()

    def _restart(self, now_us):
        self._known_from = now_us
        for sensor in self._sensors:
            sensor.drop(self._known_at(now_us))
        self._start = now_us
        self._break_off()
        self._plan()
        self._oldest, self._pending = NOBODY, 0


class HcSr04FlowRing(HcSr04Ring):
    """A ring of HC-SR04 modules that fires by flow, on pins as `HcSr04Ring`; `rest_us` is the time between two triggers.
    While the robot moves, set `change_us` to the list that `Ring.poll` takes."""

    RING = FlowRing

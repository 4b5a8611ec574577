"""eeruf in MicroPython: rings of ultrasonic sensors that reject each other's sound (Borenstein and Koren, 1995). README.md shows how.

Times are microseconds, sensors are counted from 0. `FlowRing` has, event by event, the behaviour of a flow ring in the Rust crate
eeruf-core; it needs no hardware. Rules: docs/explanation/flow.md. Licence: MIT OR Apache-2.0."""

NOBODY, NEVER = 255, 0xFFFF  # NEVER: the age of a sensor that has never had a reading accepted
FIRST, ACCEPTED, REJECTED, REPEATED, NO_ECHO, CLEAR, TOO_EARLY, LATE, STUCK, _, AMBIGUOUS, UNANSWERED = range(12)
NEVER_FREE, NEEDS_ANSWER, TRUSTED = range(3)  # silence is: neither free space nor a fault; a fault, UNANSWERED; free space if repeated
HISTORY = "history"  # explains an ambiguous reading that a forgotten firing could explain
BY_MOTION, EVERY_ECHO, TWO_IN_A_ROW = range(3)  # BY_MOTION: every echo while the robot moves alone, else two in a row
FIRE, READING, PERIOD = range(3)  # kinds of events; then come the sensor (of a firing or reading) and the phase, always 0
# Indices of a reading; a time without echo is None. `explained_by`: the sensor whose sound could be both echoes, or HISTORY.
SENSOR, PHASE, KIND, T_ECHO, PREVIOUS, AGE, EXPLAINED_BY = 1, 2, 4, 5, 6, 7, 8
_SHOWS = "unsure obstacle rejected unsure unsure clear too_close unsure unanswered - ambiguous unanswered".split()
_WHYS = ("no_firing", "unsure", "rejected", "ambiguous", "no_witness")
# The unit of quiet; the most that a belief that missed readings may change; how long a reported speed holds; the longest quiet.
_UNIT_US, _TOO_FAR_US, _TOLD_US, _HEARD_US = 4, 1000, 500000, 250000
# It has shown of its firing that it listened; nothing; that its line is high, whose fall makes silence count; that it was before.
_LISTENED, _NOTHING, _HELD, _STUCK = range(4)
_MOST_OFF_US, _WIDE, _SILENCE = 300, 510, 1 << 29  # the most that an echo may be off; what stands for more; for silence with a witness
HC_SR04 = {"window_us": 24310, "blanking_us": 117, "most_us": 33159, "rest_us": 60000}  # a ring of these: Flow(8, **HC_SR04)


def _check(name, value, least, most):
    if not least <= value <= most:
        unit = "m/s" if name.endswith("mm_s") else "milliseconds"
        likely = ", likely given in " + unit if value < least <= 1000 * value <= most else ""
        raise ValueError("%s = %d: %d to %d expected%s" % (name, value, least, most, likely))


def _seed_of_chip():
    seed = 0x811C9DC5  # FNV-1a
    for byte in __import__("machine").unique_id():
        seed = (seed ^ byte) * 0x01000193 & 0xFFFFFFFF
    return max(seed, 1)


def _rate(speed_mm_s):  # the most that a good reading changes, in 1/16 us per 1,024 us: 2 v / c at 331 m/s plus 6 %
    return (min(speed_mm_s, 39000) * 6881 + 65535) >> 16


def _in_order(sensors):  # alternates distant sensors: neighbours hear each other loudest
    if sensors == 6:
        return b"\x00\x02\x04\x01\x05\x03"
    stride = 3 if sensors > 4 else 1
    while stride > 1 and (stride == sensors - 1 or 0 in [stride * n % sensors for n in range(1, sensors)]):
        stride += 1
    return bytes([place * stride % sensors for place in range(sensors)])


class Flow:
    """Settings of a ring of sensors that listen for `window_us` after their firing; README.md has a table of all."""

    def __init__(
        self, sensors, window_us, blanking_us=0, least_us=None, most_us=None, rest_us=60000, dice_us=2000, seed=None, t_delta_us=80,
        near_us=150, path_change_us=150, memory=8, hold=4, top_speed_mm_s=0, alone=False, votes=BY_MOTION,
    ):  # fmt: skip
        seed = _seed_of_chip() if seed is None else seed
        self.min_refire_us = max(rest_us, window_us)
        if most_us is None:  # two ninths of the window for the tail, but never so long that own stale echoes count as foreign
            most_us = min(window_us + window_us // 9 * 2, self.min_refire_us + blanking_us - 1)
        least_us = most_us // 11 * 2 if least_us is None else least_us
        narrow = min(window_us, 1 << 16) - 1
        for setting in (
            ("sensors", sensors, 1, 64), ("window_us", window_us, 1000, 4000000), ("blanking_us", blanking_us, 0, narrow),
            ("most_us", most_us, 1000, 250000), ("least_us", least_us, 100, most_us), ("rest_us", rest_us, 1000, 4000000),
            ("dice_us", dice_us, dice_us and 8, 250000), ("seed", seed, 1, 0xFFFFFFFF), ("memory", memory, 0, 255),
            ("t_delta_us", t_delta_us, 0, min(narrow, 10000)), ("near_us", near_us, 0, 10000), ("hold", hold, 1, 100),
            ("path_change_us", path_change_us, 0, 10000), ("top_speed_mm_s", top_speed_mm_s, top_speed_mm_s and 10, 0xFFFF),
            ("alone", alone, 0, 1), ("votes", votes, 0, 2),
        ):  # fmt: skip
            _check(*setting)
            setattr(self, setting[0], setting[1])


class _Sensor:
    def __init__(self, now_us, long_ago_us, doubt):
        self.period, self.age, self.enabled = 0, NEVER, True
        # The quiet that it needs, in units; when and whether it has fired; whether it has fired in this round before its turn.
        self.doubt, self.fired_us, self.has_fired, self.ahead = doubt, now_us, False, False
        self.seen_us = self.by = None
        self.unsee(now_us)
        self.drop(long_ago_us)

    def unsee(self, now_us):
        self.shows, self.seen_at, self.doubted, self.no_echo = "no_firing", now_us, False, False

    def see(self, kind, echo_us, explained_by, now_us):
        if kind == LATE and echo_us is not None:
            return  # the firing has already had its reading
        shows, known = "no_witness" if kind == NO_ECHO and self.no_echo else _SHOWS[kind], self.shows
        self.no_echo = kind == NO_ECHO
        if shows in _WHYS and known == "obstacle" and not self.doubted:
            self.doubted = True  # one echo may be missed, or a foreign one heard
            return
        self.shows, self.by, self.doubted = shows, explained_by, False
        if not (shows == known == "unanswered" or shows in _WHYS and known in _WHYS):  # else the state has not changed
            self.seen_us, self.seen_at = echo_us, now_us

    def forget(self):
        # The last reading; the belief; firings and possible change since; the greatest rate; contradictions that the belief outlasts.
        self.last_us, self.believed_us, self.missed, self.grown, self.rate, self.conf = None, None, 0, 0, 0, 0

    def drop(self, long_ago_us):
        self.firings = [long_ago_us] * 3  # the latest first: fewer explain nothing, more add nothing
        # `outside`: its only edges so far came outside the window; `off`: the uncertainty of its echo.
        self.echo_us, self.listening, self.can_emit, self.outside = None, False, False, True
        self.evidence = self.off = self.off_before = 0
        self.forget()

    def miss(self):
        self.missed = min(self.missed + 1, 255)
        if self.age < NEVER - 1:
            self.age += 1


class FlowRing:
    """A ring whose clock has `clock_bits` bits and may wrap, like `time.ticks_us`. Poll it at its deadline; report echoes as they come."""

    def __init__(self, flow, now_us, clock_bits=32):
        _check("clock_bits", clock_bits, 28, 64)
        self.flow, self._mask, self._half = flow, (1 << clock_bits) - 1, 1 << (clock_bits - 1)
        # Longer ago than sound is heard; the most that a clock may step back; a round of the longest gaps.
        self._long_ago, self._step_back = 1 << (clock_bits - 2), 1 << min(20, clock_bits - 4)
        self._horizon = (flow.sensors + 1) * (flow.most_us + 2 * flow.dice_us) + flow.min_refire_us
        self.report_after_us, self.silence = 0, NEVER_FREE  # earliest reading without an echo; meaning of silence without evidence
        self._known_from = (now_us - self._long_ago) & self._mask  # earlier firings are unknown
        more_us = flow.most_us - flow.least_us
        self._first = (flow.least_us + more_us // 5) // _UNIT_US
        self._up, self._down = more_us // 4 // _UNIT_US, more_us // 10 // _UNIT_US
        self._sensors = [_Sensor(now_us, self._known_from, self._first) for _ in range(flow.sensors)]
        self._oldest, self._pending, self._emit_at, self._seen = NOBODY, 0, now_us, now_us
        self._period = 0
        self._top = self._rate = _rate(flow.top_speed_mm_s)
        self._told, self._before, self._greatest, self._since = None, self._top, self._top, 0  # last report; greatest rates
        # The place in the order that has the turn; how many sensors have fired ahead of theirs; when any sensor last fired.
        self._order, self._place, self._ahead, self._last_fired = _in_order(flow.sensors), 0, 0, now_us
        self._high, self._low = flow.seed >> 16, flow.seed & 0xFFFF
        self._moves = self._every_echo = self._paused = False
        self._set_moves()
        self._throw()
        self._decide()

    def _signed(self, us):
        return (us + self._half & self._mask) - self._half

    def _reached(self, now_us, deadline_us):
        return (now_us - deadline_us) & self._mask < self._half

    def _throw(self):  # xorshift by 13, 17 and 5 (Marsaglia, 2003), in halves, since a small integer has 31 bits
        high, low = self._high, self._low
        high, low = high ^ (high << 13 | low >> 3) & 0xFFFF, low ^ low << 13 & 0xFFFF
        low ^= high >> 1
        self._high, self._low = high ^ (high << 5 | low >> 11) & 0xFFFF, low ^ low << 5 & 0xFFFF
        dice = (self.flow.dice_us << self._moves) + 1
        self._thrown = self._high * dice + (self._low * dice >> 16) >> 16

    def _least(self):
        return min(self.flow.least_us << self._every_echo, self.flow.most_us)

    def quiet_us(self, x):
        """The quiet that a sensor needs before and after its firing."""
        return max(self._sensors[x].doubt * _UNIT_US, self._least())

    def _since_last(self, at_us):  # the time from the last firing of any sensor until an instant, or 0
        us = (at_us - self._last_fired) & self._mask
        return us if us <= self._half else 0

    def _first_from(self, place):
        order, sensors = self._order, self._sensors
        while place < len(order) and (sensors[order[place]].ahead or not sensors[order[place]].enabled):
            place += 1
        return place

    def _decide(self):
        flow, order, least = self.flow, self._order, self._least()
        self._next, idle = NOBODY, True
        # The quiet that listening sensors still need, capped at their windows: the longest, whose it is, and the second longest.
        longest, second, whose = 0, 0, None
        for sensor in self._sensors:
            idle = idle and not sensor.enabled
            if sensor.listening and sensor.has_fired:
                quiet = self._since_last(sensor.fired_us + min(max(sensor.doubt * _UNIT_US, least), flow.window_us))
                if quiet > longest:
                    longest, quiet, whose = quiet, longest, sensor
                second = max(second, quiet)
        place = len(order) if self._paused else self._first_from(self._place)
        # A round ends at once or, if no sensor can fire, after the rest time.
        self._due = (self._last_fired + (flow.rest_us if self._paused or idle else 0)) & self._mask
        while place < len(order):
            sensor = self._sensors[order[place]]
            quiet, rested = max(sensor.doubt * _UNIT_US, least, second if sensor is whose else longest), 0
            if sensor.has_fired:
                rested = self._since_last(sensor.fired_us + (flow.min_refire_us if sensor.listening else flow.rest_us))
            if rested <= quiet or self._next == NOBODY:
                self._next, self._due = order[place], (self._last_fired + max(quiet, rested) + self._thrown) & self._mask
            if rested <= quiet or self._ahead:  # no sensor is passed over twice
                break
            place = self._first_from(place + 1)

    def _decide_from(self, now_us):  # on news that came only now: nothing becomes due before `now_us`, unless it was already
        due = self._due
        self._decide()
        due = due if self._reached(now_us, due) else now_us
        if self._reached(due, self._due):
            self._due = due

    def upcoming(self):
        """Return a list of the next (sensor, instant), for hardware that fires by itself; empty if the round ends first."""
        return [] if self._next == NOBODY else [(self._next, self._due)]

    def _set_moves(self):  # applies the current rate
        flow, moves = self.flow, self._rate > 0
        if self._moves != moves:
            self._moves = moves
            for sensor in self._sensors:
                sensor.conf = min(sensor.conf, 1)
        self._every_echo = flow.votes == EVERY_ECHO or flow.votes == BY_MOTION and flow.alone and moves

    def _recent(self, now_us):  # the greatest rate while sound heard now could have been sent
        if self._told is not None and _TOLD_US < (now_us - self._told) & self._mask < self._half:
            self._told, self._rate = None, self._top
        if _HEARD_US < (now_us - self._since) & self._mask < self._half:
            self._since, self._before, self._greatest = now_us, self._greatest, self._rate
        self._greatest = max(self._greatest, self._rate)
        return max(self._before, self._greatest)

    def moving(self, speed_mm_s, turn_mrad_s, now_us):
        """Report how fast the robot moves and turns, once a control cycle. After half a second without a call, the top speed is assumed."""
        if not self._reached(now_us, self._since):  # the first report of a clock in its upper half, or one that has jumped
            self._since, self._before, self._greatest = now_us, max(self._before, self._greatest), 0
        recent = self._recent(now_us)
        self._rate, self._told = _rate(abs(speed_mm_s) + abs(turn_mrad_s) // 2), now_us
        self._greatest = max(self._greatest, self._rate)
        for sensor in self._sensors:
            sensor.rate = max(sensor.rate, recent, self._rate)
        self._set_moves()
        self._decide_from(now_us)

    def _grow(self, sensor, since_us):  # the most that a good reading may have changed since an instant
        recent = self._recent(sensor.firings[0])
        self._set_moves()
        span = max(sensor.rate, recent) * min((sensor.firings[0] - since_us) & self._mask, 0xFFFFF) >> 14
        sensor.rate, sensor.grown = recent, min(sensor.grown + span, 0xFFFF)
        return span

    def _judge(self, x, sensor, echo, since_us):  # judges an echo, or silence with a witness: (kind, age, explained_by)
        flow, explained_by, span = self.flow, None, self._grow(sensor, since_us)
        believed_us, last_us, at_us = sensor.believed_us, sensor.last_us, _SILENCE if echo is None else echo
        believes, fits, held_back = believed_us is not None, False, False
        if believes and sensor.missed <= flow.memory and (not sensor.missed or sensor.grown <= _TOO_FAR_US):
            fits = abs(at_us - believed_us) <= flow.near_us + sensor.grown
        ok = fits or echo is None
        if not ok and last_us is not None and abs(echo - last_us) <= flow.t_delta_us + span:
            explained_by = self._explanation(x, last_us, echo, flow.path_change_us + span)
            ok = explained_by is None
        far = believes and not fits and (echo is None or echo > believed_us)
        if believes and not self._moves:  # farther echoes and silence must outlast the belief
            if fits:
                sensor.conf = min(sensor.conf + 1, flow.hold)
            elif far:
                sensor.conf = max(sensor.conf - 1, 0)
                held_back = ok and sensor.conf > 0
                ok = ok and not held_back
        # A first silence is not a belief yet, but a moving robot has left the old obstacle behind.
        clears, age = last_us == _SILENCE or fits or self._moves, sensor.age
        kind = FIRST if last_us in (None, _SILENCE) and not believes else REJECTED
        if echo is None:
            kind = CLEAR if ok and clears else NO_ECHO
        elif ok or self._every_echo:
            kind, explained_by = ACCEPTED, None
        elif explained_by is not None or held_back:
            kind = REPEATED if explained_by is None else AMBIGUOUS
        # Readings of a moving robot differ anyway: quiet that did not help is dropped. Nor does it help against sound from elsewhere.
        lets_go = self._moves and not self._every_echo and sensor.missed & 2
        masked = not ok and echo is not None and not far and self._is_masked(x, sensor.firings[0] + echo)
        if masked and not lets_go:
            sensor.doubt = min(sensor.doubt + self._up, flow.most_us // _UNIT_US)
        elif ok or echo is not None and not far:
            sensor.doubt = max(sensor.doubt - self._down, self._least() // _UNIT_US)
        if not ok:
            sensor.miss()
        elif echo is not None or clears:
            sensor.conf = sensor.conf if fits else 1
            sensor.believed_us, sensor.grown, sensor.missed = at_us, 0, 0
        if kind == ACCEPTED:
            age = sensor.age = 0
        sensor.last_us = at_us
        return kind, age, explained_by

    def _explanation(self, receiver, first, second, change):  # the sensor whose sound explains both echoes; HISTORY for a forgotten firing
        mask, own = self._mask, self._sensors[receiver]
        off = max(own.off, own.off_before)  # echoes may be this much later, and audible for twice this longer
        first, second = (own.firings[1] + first + off) & mask, (own.firings[0] + second + off) & mask
        audible = self.flow.most_us + 2 * off
        change += own.off + own.off_before
        most = second - first + change  # apart from this, the time between the sounds is that between their firings
        # All forgotten firings came before the known ones; if that is after the first sound, one may explain it.
        forgotten = (first - self._known_from + self._half) & mask < self._half + audible
        for x in range(self.flow.sensors):
            firings = self._sensors[x].firings
            latest, left_out = (1, 1) if x == receiver else (0, -1)  # its own two echoes are meant to be heard
            for i in range(3):
                age = (first - firings[i]) & mask
                for j in range(latest, i + 1 if age <= audible and i != left_out else 0):
                    between = firings[j] - firings[i]
                    if (most - between) & mask <= 2 * change and (second - firings[j]) & mask <= audible:
                        return x
            forgotten = forgotten or (age + self._half) & mask < self._half + audible
        return HISTORY if forgotten else None

    def _is_masked(self, receiver, heard):  # true if the sound of any firing but the receiver's last could be what it heard
        ages = ((heard - self._sensors[x // 3].firings[x % 3]) & self._mask for x in range(3 * self.flow.sensors) if x != 3 * receiver)
        return any(age <= self.flow.most_us for age in ages)

    def believed_us(self, x):
        """Return the believed echo time of a sensor; None without a belief, or if nothing is in range."""
        sensor = self._sensors[x]
        return sensor.believed_us if sensor.missed <= self.flow.memory and sensor.believed_us != _SILENCE else None

    def _pends(self):
        return self._pending > 0 or self._oldest != NOBODY

    def poll(self, now_us):
        """Return the next event, or None: then sleep until the deadline. Report the echoes you know of first."""
        is_due = self._reached(now_us, self._due)
        if not is_due and not (self._pends() and self._reached(now_us, self._emit_at)):
            if (self._due - now_us) & self._mask > self._horizon:
                self._restart(now_us)  # the clock has jumped
            return None
        return self._advance(now_us, is_due)  # split off: variables of larger functions live in the heap, which is slow

    def _advance(self, now_us, is_due):
        if not self._reached(now_us + self._step_back, self._seen):
            for sensor in self._sensors:
                sensor.unsee(now_us)
        self._seen = now_us
        x, fires = self._next, is_due and self._next != NOBODY
        if fires and not self._sensors[x].listening and not self._sensors[x].can_emit:
            event = (FIRE, x, 0, self._due)
            self._fire(x, now_us)
            return event
        if not fires:
            x = self._oldest
            if self._pending == 0:
                x = x if self._reached(now_us, self._emit_at) else NOBODY
            elif x == NOBODY or not self._sensors[x].can_emit:
                x = [sensor.can_emit for sensor in self._sensors].index(True)
        if x != NOBODY:
            event = self._emit(x, now_us)
            self._sensors[x].see(event[KIND], event[T_ECHO], event[EXPLAINED_BY], now_us)
            return event
        return self._end_period(now_us) if is_due else None

    def deadline(self):
        """The time of the next poll."""
        return self._emit_at if self._pends() and not self._reached(self._emit_at, self._due) else self._due

    def state(self, x, now_us):
        """Return the state in front of a sensor, with its age: (kind, t_echo_us, age_us, why, explained_by)."""
        sensor = self._sensors[x]
        age_us = min((now_us - sensor.seen_at) & self._mask, self._half)
        if sensor.shows in _WHYS:
            return "unknown", None, age_us, sensor.shows, sensor.by
        return sensor.shows, sensor.seen_us if sensor.shows == "obstacle" else None, age_us, None, None

    def _end_oldest(self, x, before):  # after a firing of `before` has ended: finds the oldest now, and when its window closes
        if self._oldest == x:
            self._oldest, soonest = NOBODY, self._mask
            for other in range(self.flow.sensors):
                age = (self._sensors[other].firings[0] - before + self._step_back) & self._mask
                if age < soonest and self._sensors[other].listening:
                    self._oldest, soonest = other, age
        if self._pending == 0 and self._oldest != NOBODY:
            fired_us, listens_us = self._sensors[self._oldest].firings[0], max(self.flow.window_us, self.report_after_us)
            self._emit_at = (fired_us + listens_us) & self._mask

    def _fire(self, x, now_us):
        sensor = self._sensors[x]
        sensor.listening, sensor.period, sensor.can_emit, sensor.outside = True, self._period, False, False
        sensor.evidence = _LISTENED if self.silence == TRUSTED else _NOTHING
        sensor.firings.insert(0, now_us)
        sensor.firings.pop()
        if self._oldest == NOBODY:
            self._oldest = x
            self._end_oldest(NOBODY, now_us)
        place = self._first_from(self._place)
        if self._order[place] == x:
            self._place = place + 1
        else:
            sensor.ahead, self._ahead = True, True
        sensor.has_fired, sensor.fired_us, self._last_fired = True, now_us, now_us
        self._throw()
        self._decide()

    def _emit(self, x, now_us):
        sensor = self._sensors[x]
        echo, evidence, fired, before = sensor.echo_us, sensor.evidence, sensor.firings[0], sensor.firings[1]
        self._pending -= sensor.can_emit
        sensor.can_emit, sensor.echo_us, sensor.evidence = False, None, 0
        previous = explained_by = kind = None
        if not sensor.listening:
            if evidence == _HELD:
                self._judge(x, sensor, None, fired)
            age, kind = sensor.age, LATE
        else:
            previous, age = None if sensor.last_us == _SILENCE else sensor.last_us, sensor.age
            if evidence == _STUCK:
                kind, echo = STUCK, None
            elif sensor.off == _WIDE:
                kind, echo = LATE, None
            elif sensor.outside:
                kind = TOO_EARLY
            elif evidence == _NOTHING and echo is None:
                kind = UNANSWERED if self.silence == NEEDS_ANSWER else NO_ECHO
            if kind is not None:  # it says nothing about an echo
                self._grow(sensor, before)
                sensor.miss()
                sensor.last_us = None
            elif evidence == _HELD and echo is None:  # neither silence yet, nor the end of a run of silences
                self._grow(sensor, before)
                previous, kind = None, CLEAR if sensor.believed_us == _SILENCE and not sensor.missed else NO_ECHO
                sensor.last_us = _SILENCE if sensor.last_us == _SILENCE else None
                sensor.evidence = _HELD
            else:
                kind, age, explained_by = self._judge(x, sensor, echo, before)
            sensor.off_before, sensor.off = sensor.off, 0
            sensor.listening = sensor.outside = False
            self._decide_from(now_us)
        self._end_oldest(x, fired)
        period = (self._period - (self._period - sensor.period & 7)) & 0xFFFFFFFF  # three bits are kept, as in Rust and C
        return (READING, x, 0, period, kind, echo, previous, age, explained_by)

    def _end_period(self, now_us):
        event, long_before = (PERIOD, 0, self._period), (now_us - self._long_ago) & self._mask
        self._place, self._ahead, self._period = 0, 0, (self._period + 1) & 0xFFFFFFFF
        for sensor in self._sensors:  # sensors that fired ahead have had their turn; old firings must not look recent
            sensor.ahead = False
            sensor.has_fired = sensor.has_fired and (now_us - sensor.fired_us) & self._mask <= self._half >> 2
            if self._is_long_ago(sensor.firings[0], now_us):
                sensor.firings = [long_before] * 3
                sensor.forget()  # the instant from which its next reading would be compared is no longer known
                if not sensor.listening:
                    sensor.outside, sensor.evidence = True, 0  # no edge can be their echo
            if (now_us - sensor.seen_at) & self._mask > self._half:
                sensor.seen_at = (now_us - self._half) & self._mask
        if self._is_long_ago(self._known_from, now_us):
            self._known_from = long_before
        if self._next == NOBODY and (now_us - self._last_fired) & self._mask >= self.flow.rest_us:
            self._last_fired = now_us  # no sensor fires, but rounds go on
        self._decide_from(self._due)
        return event

    def _is_long_ago(self, at_us, now_us):  # not so just ahead of now, from before the clock stepped back
        return self._long_ago < (now_us - at_us) & self._mask <= self._mask - self._step_back

    def echo(self, x, earliest_us, latest_us=None):
        """Report an echo at an instant, or between two: the middle counts. If it may be off by more than 300 us (5 cm), it is LATE."""
        sensor, flow, latest_us = self._sensors[x], self.flow, earliest_us if latest_us is None else latest_us
        width = (latest_us - earliest_us) & self._mask
        if width >= self._half:
            raise ValueError("an echo between %d and %d us: latest before earliest, likely swapped" % (earliest_us, latest_us))
        off = width - width // 2
        t_echo = self._signed(earliest_us + width // 2 - sensor.firings[0])
        wide = off > _MOST_OFF_US and t_echo + off >= flow.blanking_us
        if t_echo < 0 and not wide:
            return
        if not sensor.listening:
            if wide or t_echo <= flow.window_us or sensor.outside:
                return
            sensor.outside, sensor.echo_us = True, t_echo
        elif t_echo - (off if wide else 0) > flow.window_us:
            if sensor.evidence == _HELD:
                sensor.evidence = _LISTENED
            return
        elif wide:
            if not sensor.outside and sensor.echo_us is not None and sensor.echo_us <= t_echo - off:
                return
            sensor.off = _WIDE
        elif t_echo < flow.blanking_us:
            if sensor.echo_us is None:
                sensor.outside, sensor.echo_us = True, t_echo
            return
        else:
            if sensor.outside or sensor.echo_us is None or t_echo < sensor.echo_us:
                sensor.echo_us = t_echo
            sensor.outside, sensor.off = False, max(sensor.off, off + 1 & ~1)
        if not sensor.can_emit:
            if not self._pends() or not self._reached(latest_us, self._emit_at):
                self._emit_at = latest_us
            sensor.can_emit = True
            self._pending += 1

    def fired(self, x, at_us):
        """Correct the instant of a sensor's last firing, before you poll for readings that may contain its sound."""
        sensor = self._sensors[x]
        firings, polled = sensor.firings, sensor.firings[0]
        if at_us == polled or at_us == firings[1] or not self._reached(at_us, firings[1]):
            return
        firings[0], later = at_us, self._signed(at_us - polled)
        if sensor.echo_us is not None:
            sensor.echo_us -= later
            if sensor.echo_us < 0:  # the first edge came before it fired, and may have kept out the echo
                sensor.echo_us, sensor.outside = 0, True
        if not sensor.listening and sensor.last_us is not None and sensor.last_us < _SILENCE:  # its reading was already judged
            sensor.last_us = max(sensor.last_us - later, 0)
            if not sensor.missed:
                sensor.believed_us = max(sensor.believed_us - later, 0)
        waits = sensor.listening and sensor.has_fired
        if later > 0 and sensor.listening or not waits or self._reached(sensor.fired_us, at_us):
            if self._last_fired == sensor.fired_us or self._reached(at_us, self._last_fired):
                self._last_fired = at_us
            sensor.fired_us = at_us
            self._decide_from(self._due)
        if self._oldest == x:
            self._end_oldest(x, polled)

    def _show(self, x, evidence):
        sensor = self._sensors[x]
        if sensor.listening and sensor.evidence != _STUCK:
            sensor.evidence = evidence

    def stuck(self, x):
        """Report that a sensor's echo line was high when it was to fire."""
        self._show(x, _STUCK)

    def holds(self, x):
        """Report that a line rose after the trigger, or is still high. Silence counts once `answered` reports its fall."""
        self._show(x, _HELD)

    def answered(self, x, answered=True):
        """Report that a sensor has shown that it listened, or with `answered=False` that this was noise; see `silence`."""
        sensor, evidence = self._sensors[x], self._sensors[x].evidence
        if not answered:
            self._show(x, _NOTHING)
        elif evidence != _STUCK:
            sensor.evidence = _LISTENED
            if evidence == _HELD and not sensor.listening:
                self._judge(x, sensor, None, sensor.firings[0])  # its reading was already emitted

    def measured(self, x, least_us, most_us=None):
        """Report a result that hardware measured for the last firing: the echo time, two limits of it, or None for silence."""
        if least_us is None:
            self.answered(x)
        else:
            fired_us, most_us = self._sensors[x].firings[0], least_us if most_us is None else most_us
            self.echo(x, (fired_us + least_us) & self._mask, (fired_us + most_us) & self._mask)

    def forget(self, x):
        """Forget a sensor's last echo, if it was false: its next reading is compared with nothing."""
        self._sensors[x].forget()
        self._sensors[x].doubt = self._first
        self._decide_from(self._due)

    def enable(self, x, enabled=True):
        """Enable or disable a sensor from its next turn on."""
        was_enabled, self._sensors[x].enabled = self._sensors[x].enabled, enabled
        if enabled and not was_enabled:
            self.forget(x)
        self._decide_from(self._due)

    def pause(self, paused=True):
        """Pause all sensors, or resume them. Beliefs stay, but each next reading is compared with no other."""
        self._paused = paused
        for sensor in [] if paused else self._sensors:
            sensor.last_us, sensor.missed = None, max(sensor.missed, 1)
        self._decide_from(self._due)

    def restart(self, now_us):
        """Start again from the first sensor after a long sleep, with nothing known."""
        self._restart(now_us)
        self._seen = now_us
        for sensor in self._sensors:
            sensor.unsee(now_us)

    def _restart(self, now_us):
        self._known_from = now_us
        for sensor in self._sensors:  # earlier sound may still be heard; firings corrected to just ahead stay known
            if (sensor.firings[0] - self._known_from - 1) & self._mask < self._step_back:
                self._known_from = sensor.firings[0]
            sensor.drop((now_us - self._long_ago) & self._mask)
            sensor.has_fired = sensor.has_fired and (now_us - sensor.fired_us) & self._mask <= self.flow.rest_us  # else the clock jumped
            sensor.ahead, sensor.doubt = False, self._first
        self._oldest, self._pending, self._place, self._ahead = NOBODY, 0, 0, 0
        self._last_fired = (now_us + self.flow.most_us) & self._mask  # earlier sound dies away first
        self._decide()


class HcSr04FlowRing:
    """A ring of HC-SR04 modules, on one pin each or with the echo lines on other pins. `read` samples the lines: call it often."""

    # Times of an HC-SR04; subclass it for other modules. A line that rises later was not raised by its trigger; a line that is
    # high no longer than the hold still listens. RECOVERY_US, if not 0, pulls a stuck line low, for 200 us say: it needs 1 kOhm.
    DEAF_US, SHORTEST_US, LONGEST_US, MIN_RETRIGGER_US, TRIGGER_US = 100, 100, 36000, 60000, 10
    LATEST_RISE_US, LONGEST_HOLD_US, RECOVERY_US = 1400, 250000, 0

    def __init__(self, flow, pins, echoes=None, machine=None, time=None):
        _check("rest_us", flow.rest_us, self.MIN_RETRIGGER_US, 4000000)
        if len(pins) != flow.sensors or (echoes is not None and len(echoes) != len(pins)):
            raise ValueError("%d pins for %d sensors" % (len(pins), flow.sensors))
        machine, time = machine or __import__("machine"), time or __import__("time")
        self._pin, self._time, self._one_pin = machine.Pin, time, echoes is None
        self._echoes = [machine.Pin(pin, machine.Pin.IN) for pin in echoes or pins]
        self._triggers = [machine.Pin(pin, machine.Pin.OUT, value=0) for pin in pins] if echoes else self._echoes
        bits = 1  # the period of ticks_us is a power of two: from half a turn on, differences are negative
        while time.ticks_diff(1 << bits - 1, 0) > 0:
            bits += 1
        self.ring = FlowRing(flow, time.ticks_us(), bits)
        self.ring.silence = NEEDS_ANSWER  # a line that does not rise is not free space
        # When a line rose, and how much sooner it may have; when its level was last seen unchanged.
        self._rose, self._early, self._seen = [None] * len(pins), [0] * len(pins), [0] * len(pins)
        self._awaits = [False] * len(pins)
        # The beginning of a second, and a bit for each module with a punctual reading in it, and with two in a row.
        self._since, self._heard, self._twice = time.ticks_us(), 0, 0

    def _since_firing(self, x, now):
        return self._time.ticks_diff(now, self.ring._sensors[x].firings[0])

    def _sample(self, before):  # small and without allocation, like `FlowRing.poll`
        for x in range(len(self._awaits)):
            if self._awaits[x]:
                high = self._echoes[x].value()
                if (high == 1) == (self._rose[x] is None):
                    self._edge(x, high, self._time.ticks_us())
                elif high or self._since_firing(x, before) <= self.LATEST_RISE_US:
                    self._seen[x] = before
                else:
                    self._awaits[x] = False

    def _edge(self, x, high, now):
        if self._echoes[x].value() != high:
            return  # a spike or a gap
        rose, early = self._rose[x], self._time.ticks_diff(now, self._seen[x])
        if rose is None:
            if self._since_firing(x, now) >= self.DEAF_US:
                self._rose[x], self._early[x], self._seen[x] = now, early, now
                self.ring.holds(x)
            return
        width = self._time.ticks_diff(now, rose)
        least, most = max(width - early, 0), width + self._early[x]
        self._rose[x], self._seen[x], self._awaits[x] = None, now, most < self.SHORTEST_US
        if self._awaits[x] or least >= self.LONGEST_US:
            self.ring.answered(x, not self._awaits[x])
        else:
            self.ring.measured(x, least, most)

    def _trigger(self, x):
        pin, rose, high = self._triggers[x], self._rose[x], self._echoes[x].value()
        if rose is not None:
            if high and -self._since_firing(x, rose) <= self.LONGEST_HOLD_US:
                self.ring.holds(x)  # it still listens after an earlier trigger
                return
            if not high:
                self.ring.forget(x)  # its pulse never ended: the apparent silence may have been an echo
        self._rose[x], self._awaits[x] = None, not high
        if high:
            self.ring.stuck(x)
            if self.RECOVERY_US:
                self._echoes[x].init(self._pin.OUT, value=0)
                self._time.sleep_us(self.RECOVERY_US)
                self._echoes[x].init(self._pin.IN)
            return
        pin.init(self._pin.OUT, value=0)
        pin.value(1)
        self._time.sleep_us(self.TRIGGER_US)
        pin.value(0)
        self._seen[x] = self._time.ticks_us()  # readings are judged by actual firings
        self.ring.fired(x, self._seen[x])
        if self._one_pin:
            pin.init(self._pin.IN)

    def state(self, x):
        """Return `FlowRing.state` at the current time."""
        return self.ring.state(x, self._time.ticks_us())

    def moving(self, speed_mm_s, turn_mrad_s):
        """Call `FlowRing.moving` with the current time."""
        self.ring.moving(speed_mm_s, turn_mrad_s, self._time.ticks_us())

    def read(self):
        """Take one step; return a reading if there is one, else None."""
        now = self._time.ticks_us()  # before the lines, so that no window closes on an edge that came in time
        self._sample(now)
        event = self.ring.poll(now)
        if event and event[0] == FIRE:
            self._trigger(event[1])
        if not event or event[0] != READING:
            return None
        heard, bit, late = self._heard, 1 << event[SENSOR], event[KIND] == LATE and event[T_ECHO] is None
        self._twice |= 0 if late else heard & bit
        self._heard = heard & ~bit if late else heard | bit
        return event

    def too_slow(self):
        """Return true about once a second if `read` is called too rarely: a module had no two punctual readings in a row."""
        now, twice = self._time.ticks_us(), self._twice
        if self._time.ticks_diff(now, self._since) < max(950000, 100000 * self.ring.flow.sensors):  # two rounds one by one
            return False
        self._since, self._heard, self._twice = now, 0, 0
        return not self.ring._paused and any(s.enabled and not twice >> x & 1 for x, s in enumerate(self.ring._sensors))

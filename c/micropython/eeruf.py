"""eeruf in MicroPython: rings of ultrasonic sensors that reject each other's sound (Borenstein and Koren, 1995).

    from eeruf import ACCEPTED, KIND, SENSOR, T_ECHO, HcSr04Ring
    from eeruf_schedule import Schedule

    #                  T_p     phase a        phase b         sensors 0, 1 and 2 fire then, in microseconds
    ring = HcSr04Ring(Schedule(62000, [[2000, 22000, 42000], [0, 22000, 43000]]).verify(387), pins=[2, 3, 4])
    while True:
        reading = ring.read()
        if reading and reading[KIND] == ACCEPTED:
            print(reading[SENSOR], reading[T_ECHO] * 1716 // 10000, "mm")

Times are microseconds. `Ring` does, event by event, what the Rust crate eeruf-core does with a ring by a table; it needs no
hardware and runs under CPython too. Sensors are counted from 0. A ring fires by a table of eeruf_schedule.py, or by flow
(eeruf_flow.py).

Licence: MIT OR Apache-2.0.
"""

NOBODY = 255
NEVER = 0xFFFF  # the age of a sensor none of whose readings was ever accepted
READING_NAMES = (
    "first", "accepted", "rejected", "repeated", "no_echo", "clear", "too_early", "late", "stuck", "tentative",
    "ambiguous", "unanswered",
)  # fmt: skip
FIRST, ACCEPTED, REJECTED, REPEATED, NO_ECHO, CLEAR, TOO_EARLY, LATE, STUCK, TENTATIVE = range(10)
AMBIGUOUS, UNANSWERED = 10, 11
# What silence means: neither free space nor a fault, NO_ECHO however often; a fault, UNANSWERED; free space once repeated.
NEVER_FREE, NEEDS_ANSWER, TRUSTED = range(3)
HISTORY = "history"  # explains an ambiguous reading if a firing that could have been heard is forgotten
# Of events: what they are, then of a firing and a reading the sensor and the phase in which it fires.
FIRE, READING, PERIOD = range(3)
_REMEMBERED = 4  # firings of each sensor: enough if sound is heard for no longer than a period
_WATCHED = 6  # ends of periods for which an irregular firing may explain a reading
_ALWAYS = 255  # the schedule is not proven, so the ring searches at each reading
# Places in a reading, (READING, sensor, phase, period, kind, t_echo_us, previous_us, age, explained_by). Without echo a
# time is None. `explained_by`: the sensor whose sound could be both echoes, or HISTORY; None unless ambiguous.
SENSOR, PHASE, KIND, T_ECHO, PREVIOUS, AGE, EXPLAINED_BY = 1, 2, 4, 5, 6, 7, 8
# The state that each kind of reading shows, or why nothing is known; None for an echo after the reading of its firing.
_SHOWS = (
    "unsure", "obstacle", "rejected", "unsure", "unsure", "clear", "too_close", None, "unanswered", "obstacle",
    "ambiguous", "unanswered",
)  # fmt: skip
_WHYS = ("no_firing", "unsure", "rejected", "ambiguous", "no_witness")


class _Sensor:
    def __init__(self, long_ago_us, remembered=_REMEMBERED):
        self.firings = [long_ago_us] * remembered  # the latest first
        self.phase = self.period = self.score = 0
        self.age = NEVER
        self.enabled = True
        self.shows, self.seen_us, self.seen_at, self.doubted, self.by = "no_firing", None, 0, False, None
        self.silent = False  # its last reading was NO_ECHO
        self.drop(long_ago_us)

    def see(self, kind, echo_us, explained_by, now_us):
        shows, known = _SHOWS[kind], self.shows
        if shows is None:
            return
        if kind == NO_ECHO and self.silent:
            shows = "no_witness"  # nothing confirms silence, again
        self.silent = kind == NO_ECHO
        if shows in _WHYS and known == "obstacle" and not self.doubted:
            self.doubted = True  # one echo may be missed, or another's heard
            return
        self.shows, self.by, self.doubted = shows, explained_by, False
        # For how long nothing is known or answered goes on.
        if not (shows == known == "unanswered" or shows in _WHYS and known in _WHYS):
            self.seen_us, self.seen_at = echo_us, now_us

    def forget(self):
        self.known_us, self.score, self.confirmed = None, 0, False

    def forget_firings(self, long_ago_us):
        for i in range(len(self.firings)):
            self.firings[i] = long_ago_us

    def drop(self, long_ago_us):
        self.forget_firings(long_ago_us)
        self.echo_us = None
        self.outside = True  # its only edges so far came outside the window
        self.listening = self.can_emit = self.stuck = self.unanswered = False
        self.forget()


class Ring:
    """A ring that fires by a verified schedule. `now_us` is a reading of a clock of `clock_bits` bits, which may wrap: 32,
    or on a board those of `time.ticks_us`, mostly 30. Poll it at its deadline, hand in echoes as they come.

    It never accepts a single path of foreign sound that is heard for at most `audible_us` (None: as verified) and changes
    from one reading to the next by at most `path_change_us` (None: `t_delta_us`)."""

    def __init__(
        self, schedule, now_us, t_delta_us=None, window_us=None, blanking_us=0, consecutive=2, clock_bits=32,
        unverified=False, path_change_us=None, audible_us=None,
    ):  # fmt: skip
        if not schedule.verified and (not unverified or t_delta_us is None or window_us is None):
            raise ValueError("the schedule was not verified")
        if t_delta_us is None:
            t_delta_us = schedule.t_delta_us
        if window_us is None:
            window_us = schedule.window_us
        if schedule.verified and t_delta_us > schedule.t_delta_us:
            raise ValueError("t_delta_us = %d: verified for %d" % (t_delta_us, schedule.t_delta_us))
        longest = schedule.window_us if schedule.verified else schedule.min_refire_us
        if window_us > longest:
            raise ValueError("window_us = %d: at most %d" % (window_us, longest))
        if not 2 <= consecutive <= 8:
            raise ValueError("consecutive = %d: 2 to 8 expected" % consecutive)
        self._listen(t_delta_us, window_us, blanking_us, clock_bits)
        self._max_audible = 1 << min(26, clock_bits - 4)
        if 6 * schedule.period_us > self._half:
            raise ValueError("period_us = %d: too long for a clock of %d bits" % (schedule.period_us, clock_bits))
        self.schedule = schedule
        self.consecutive = consecutive
        self._begin([_Sensor(self._known_at(now_us)) for _ in range(schedule.sensors)], now_us)
        self.path_change_us = None
        self.set_audible(min(schedule.audible_us, self._max_audible) if audible_us is None else audible_us)
        self.set_path_change(path_change_us)
        if self._proven:
            self._watched = 0
        self._last_fired = (now_us - schedule._settling_us()) & self._mask
        self._due = now_us
        self._begin_period(0)

    def _listen(self, t_delta_us, window_us, blanking_us, clock_bits):
        if not 0 <= blanking_us < min(window_us, 1 << 16):
            raise ValueError("blanking_us = %d: less than the window of %d us expected" % (blanking_us, window_us))
        if not 0 <= t_delta_us < min(window_us, 1 << 16):
            raise ValueError("t_delta_us = %d: less than the window of %d us expected" % (t_delta_us, window_us))
        self.t_delta_us, self.window_us, self.blanking_us = t_delta_us, window_us, blanking_us
        self._mask, self._half = (1 << clock_bits) - 1, 1 << (clock_bits - 1)
        # Longer ago than any sound is heard; by how much a clock may step back.
        self._long_ago, self._step_back = 1 << (clock_bits - 2), 1 << min(20, clock_bits - 4)

    def _known_at(self, now_us):
        return (now_us - self._long_ago) & self._mask

    def _begin(self, sensors, now_us):
        # How long after its firing a reading without an echo is emitted at the soonest, for modules that report after their
        # window has closed: by a bus, or a pulse that hardware measures.
        self.report_after_us = 0
        self.silence = NEVER_FREE  # of a firing whose sensor has not shown by `answered` or `measured` that it listened
        self._known_from = self._known_at(now_us)  # firings before are not known
        self._sensors = sensors
        for sensor in sensors:
            sensor.seen_at = now_us
        self._oldest, self._pending, self._emit_at = NOBODY, 0, now_us
        self._period = 0
        self._tally = [0] * len(READING_NAMES)
        # At how many more ends of periods an irregular firing can be heard; this period's lateness.
        self._watched = self._latest = self._total = 0

    def _reached(self, now_us, deadline_us):
        return (now_us - deadline_us) & self._mask < self._half

    # -- The scheduler: a firing that is polled late moves all that follow by as much (Sec. 3.1, Fig. 3). --

    def _begin_period(self, phase):
        self._phase, self._following = phase, 0
        self._turn()

    def _turn_once(self):
        order, place = self.schedule.order[self._phase], self._following
        self._next = order[place] if place < len(order) else NOBODY
        self._due = (self._due + self.schedule.gap_us[self._phase][place]) & self._mask
        self._following = place + 1

    def _turn(self):
        self._turn_once()
        self._skip()

    def _skip(self):
        while self._next != NOBODY and not self._sensors[self._next].enabled:
            self._turn_once()

    def _horizon(self):
        return max(3 * self.schedule.period_us, (self._due - self._last_fired) & self._mask)

    def _end_schedule_period(self, now_us):
        settling = self.schedule._settling_us()
        left_out = (now_us - self._due) & self._mask > self.schedule.period_us
        if left_out:
            self._due = now_us
        if (self._due - self._last_fired) & self._mask > settling:
            self._last_fired = (self._due - settling) & self._mask
        self._begin_period((self._phase + 1) % self.schedule.phases)
        return left_out

    # -- Near-identical readings are ambiguous if sound of one sensor explains both. While firings keep a verified
    #    timetable there is none, and the ring does not search (docs/explanation/theory.md, section 2.1). --

    def set_path_change(self, path_change_us):
        """Sets the largest change of a foreign sound's path from one reading to the next, None for `t_delta_us`."""
        if path_change_us is not None and not 0 <= path_change_us < 0xFFFF:
            raise ValueError("path_change_us = %d: 0 to 65534 expected" % path_change_us)
        self.path_change_us = path_change_us
        self._prove()

    def set_audible(self, audible_us):
        """Sets for how long sound is heard after it was sent."""
        if not 0 <= audible_us <= self._max_audible:
            raise ValueError("audible_us = %d: 0 to %d expected" % (audible_us, self._max_audible))
        self.audible_us = audible_us
        self._prove()

    def _prove(self):
        """Updates `_proven`, true if the schedule was verified for what the ring asks, and `_spare`, the lateness of a
        period's firings together that crosstalk still stands."""
        schedule, asked = self.schedule, self.path_change_us
        self._change_us = self.t_delta_us if asked is None else asked
        twice = self.t_delta_us + self._change_us
        self._proven = (
            schedule.verified
            and (asked or 0) <= schedule.t_delta_us
            and self.audible_us <= schedule.audible_us
            and twice < schedule.min_refire_us
        )
        self._spare = min(max(schedule.separation_us - twice - 1, 0) // 4, 0xFFFF)
        self._disturb()

    def _disturb(self):
        self._watched = _WATCHED if self._proven else _ALWAYS

    def _fired_late(self, late_us):
        self._latest = max(self._latest, late_us)
        self._total = min(self._total + late_us, 0xFFFF)
        if self._total > self._spare:
            self._disturb()

    def _end_late_period(self, now_us):
        latest, total = self._latest, self._total
        self._latest = self._total = 0
        if 0 < self._watched < _ALWAYS:
            self._watched -= 1
        # Before the clock comes round to them.
        long_ago = (now_us - self._long_ago) & self._mask
        for x, sensor in enumerate(self._sensors):
            if self._is_long_ago(sensor.firings[0], now_us):
                sensor.forget_firings(long_ago)
                self.forget(x)  # the instant that its next reading would be compared from is no longer known
                if not sensor.listening:
                    sensor.outside = True  # no edge is an echo of them
            if (now_us - sensor.seen_at) & self._mask > self._half:
                sensor.seen_at = (now_us - self._half) & self._mask
        if self._is_long_ago(self._known_from, now_us):
            self._known_from = long_ago
        return latest, total

    def _is_long_ago(self, at_us, now_us):
        # What lies just ahead of now is from before the clock stepped back.
        return self._long_ago < (now_us - at_us) & self._mask <= self._mask - self._step_back

    def _explanation(self, receiver, first, second):
        """The sensor whose sound could be both echoes, `first` after the receiver's firing before its last and `second`
        after the last; HISTORY if a forgotten firing's could, else None."""
        mask, half, audible = self._mask, self._half, self.audible_us
        own = self._sensors[receiver].firings
        first, second = (own[1] + first) & mask, (own[0] + second) & mask
        # The time between the two sounds is that between their firings, but for the change of the path.
        apart = (second - first) & mask
        least, most = apart - self._change_us, apart + self._change_us
        age = (first - self._known_from) & mask
        forgotten = age < audible or age >= half
        x = 0
        for sensor in self._sensors:
            firings = sensor.firings
            # The receiver's own two firings are those whose echoes it is meant to hear.
            latest = 1 if x == receiver else 0
            left_out = 1 if x == receiver else -1
            for i in range(_REMEMBERED):
                a = firings[i]
                age = (first - a) & mask
                if age <= audible and i != left_out:
                    for j in range(latest, i + 1):
                        b = firings[j]
                        if least <= (b - a) & mask <= most and (second - b) & mask <= audible:
                            return x
            # Whatever is forgotten came before the last of them.
            if age < audible or age >= half:
                forgotten = True
            x += 1
        return HISTORY if forgotten else None

    # -- Events --

    def poll(self, now_us, change_us=None):
        """The next event, or None: then sleep until the deadline. Hand in the echoes you know of before. `change_us`: what
        a good reading of each sensor should have changed by since its firing before, where the robot moves."""
        is_due = self._reached(now_us, self._due)
        pends = self._pending > 0 or self._oldest != NOBODY
        if not is_due and not (pends and self._reached(now_us, self._emit_at)):
            if (self._due - now_us) & self._mask > self._horizon():
                self._restart(now_us)  # the clock has jumped
            return None
        return self._advance(now_us, change_us, is_due)

    def _advance(self, now_us, change_us, is_due):
        # Apart from `poll`, which mostly finds nothing due: MicroPython keeps the variables of larger functions in the
        # heap, and finding room there takes longer the fuller it is.
        x = self._next
        fires = is_due and x != NOBODY
        if not fires:
            x = self._next_pending(now_us)
        if fires and not self._sensors[x].listening and not self._sensors[x].can_emit:
            event = (FIRE, x, self._phase, self._due)
            self._fire(x, now_us)
            return event
        if x != NOBODY:
            event = self._emit(x, 0 if change_us is None else change_us[x])
            self._sensors[x].see(event[KIND], event[T_ECHO], event[EXPLAINED_BY], now_us)
            return event
        return self._end_period(now_us) if is_due else None

    def deadline(self):
        """When to poll next."""
        pends = self._pending > 0 or self._oldest != NOBODY
        return self._emit_at if pends and not self._reached(self._emit_at, self._due) else self._due

    def state(self, x, now_us):
        """Returns what is before a sensor: (kind, t_echo_us, age_us, why, explained_by). The kind is "obstacle", with its echo time;
        "clear"; "too_close"; "unanswered"; or "unknown" with why: "no_firing", "unsure", "rejected", "no_witness" or "ambiguous". The age
        is the time since that was last confirmed, or for which nothing is known, up to half a turn of the clock. One reading
        that does not confirm an obstacle leaves it, two in a row do not; any echo ends "clear"."""
        sensor = self._sensors[x]
        age_us = min((now_us - sensor.seen_at) & self._mask, self._half)
        if sensor.shows in _WHYS:
            return "unknown", None, age_us, sensor.shows, sensor.by
        return sensor.shows, sensor.seen_us if sensor.shows == "obstacle" else None, age_us, None, None

    def upcoming(self):
        """The firings to come up to the end of the next period, as (sensor, instant), for PIO, RMT or a timer that fires by
        itself. They hold until one is late. The loop may then come late: for each firing poll at its instant until there is
        no event, so that FIRE says what is done already; hand in echoes; last poll at the present."""
        schedule, phase, place, x, at = self.schedule, self._phase, self._following, self._next, self._due
        is_last = False
        while x != NOBODY or not is_last:
            if x == NOBODY:
                phase, place, is_last = (phase + 1) % schedule.phases, 0, True
            elif self._sensors[x].enabled:
                yield x, at
            x = schedule.order[phase][place] if place < schedule.sensors else NOBODY
            at = (at + schedule.gap_us[phase][place]) & self._mask
            place += 1

    def _next_pending(self, now_us):
        if self._pending == 0:
            return self._oldest if self._oldest != NOBODY and self._reached(now_us, self._emit_at) else NOBODY
        if self._oldest != NOBODY and self._sensors[self._oldest].can_emit:
            return self._oldest
        for x, sensor in enumerate(self._sensors):
            if sensor.can_emit:
                return x
        return NOBODY

    def _emit_when_oldest_ends(self):
        if self._pending == 0 and self._oldest != NOBODY:
            listens_us = max(self.window_us, self.report_after_us)
            self._emit_at = (self._sensors[self._oldest].firings[0] + listens_us) & self._mask

    def _find_oldest(self, before):
        before -= self._step_back  # 1 us before is not a turn of the clock after
        self._oldest, soonest = NOBODY, self._mask
        for x, sensor in enumerate(self._sensors):
            if sensor.listening and (sensor.firings[0] - before) & self._mask < soonest:
                self._oldest, soonest = x, (sensor.firings[0] - before) & self._mask

    def _fire(self, x, now_us):
        sensor = self._sensors[x]
        late_us = min((now_us - self._due) & self._mask, 0xFFFF)
        sensor.listening, sensor.phase, sensor.period = True, self._phase, self._period
        sensor.can_emit = sensor.outside = sensor.stuck = False
        sensor.unanswered = self.silence != TRUSTED
        firings = sensor.firings
        for i in range(len(firings) - 1, 0, -1):
            firings[i] = firings[i - 1]
        firings[0] = now_us
        if late_us:
            self._fired_late(late_us)
        if self._oldest == NOBODY:
            self._oldest = x
            self._emit_when_oldest_ends()
        self._has_fired(sensor, now_us)

    def _has_fired(self, sensor, now_us):
        self._last_fired = self._due = now_us
        self._turn()

    def _compare(self, x, change_us):
        """Ends a firing and compares its reading with the one before (Eq. 11): (kind, echo, previous, explained_by)."""
        sensor = self._sensors[x]
        echo, explained_by = sensor.echo_us, None
        if sensor.stuck or sensor.outside:
            sensor.forget()
        previous = sensor.known_us
        if sensor.stuck:
            kind, echo = STUCK, None
        elif sensor.outside:
            kind = TOO_EARLY
        elif sensor.unanswered and echo is None:
            sensor.forget()
            kind, previous = UNANSWERED if self.silence == NEEDS_ANSWER else NO_ECHO, None
        else:
            if echo is None or previous is None:
                near = echo is None and previous is None
            else:
                near = abs(echo - previous - change_us) <= self.t_delta_us
                # The proof is about readings that differ by no more than t_delta_us.
                if near and (self._watched or change_us):
                    explained_by = self._explanation(x, previous, echo)
            if sensor.score and near and explained_by is None:
                sensor.score = min(sensor.score + 1, self.consecutive)
                sensor.confirmed = sensor.score >= self.consecutive
            else:
                sensor.score, sensor.confirmed = 1, False
            sensor.known_us = echo
            if sensor.confirmed:
                kind = CLEAR if echo is None else ACCEPTED
            elif echo is None:
                kind = NO_ECHO
            elif explained_by is not None:
                kind = AMBIGUOUS
            elif previous is None:
                kind = FIRST
            else:
                kind = REJECTED if sensor.score == 1 else REPEATED
        sensor.age = 0 if kind == ACCEPTED else min(sensor.age + 1, max(NEVER - 1, sensor.age))
        sensor.listening = sensor.can_emit = sensor.outside = sensor.stuck = False
        sensor.echo_us = None
        return kind, echo, previous, explained_by

    def _emit(self, x, change_us):
        sensor = self._sensors[x]
        if sensor.can_emit:
            self._pending -= 1
        if sensor.listening:
            kind, echo, previous, explained_by = self._compare(x, change_us)
            if self._oldest == x:
                self._find_oldest(sensor.firings[0])
        else:
            kind, echo, previous, explained_by = LATE, sensor.echo_us, None, None
            sensor.can_emit, sensor.echo_us = False, None
        self._emit_when_oldest_ends()
        self._count(kind)
        # Rust and C keep the lowest three bits of the period; of an edge that is later they say a later one.
        period = (self._period - (self._period - sensor.period & 7)) & 0xFFFFFFFF
        return (READING, x, sensor.phase, period, kind, echo, previous, sensor.age, explained_by)

    def _count(self, kind):
        self._tally[kind] = min(self._tally[kind] + 1, 255)

    def _end_period(self, now_us):
        self._latest = max(self._latest, min((now_us - self._due) & self._mask, 0xFFFF))
        phase, period = self._phase, self._period
        self._period = (self._period + 1) & 0xFFFFFFFF
        changed = self._end_schedule_period(now_us)
        late = self._end_late_period(now_us)
        if changed:
            self._disturb()
        tally, self._tally = self._tally, [0] * len(READING_NAMES)
        return (PERIOD, phase, period) + late + (tally,)

    # -- What happens to it --

    def echo(self, x, at_us):
        """An echo, at this instant; of a module that answers with a pulse, the firing's instant plus the pulse's width."""
        sensor = self._sensors[x]
        t_echo = (at_us - sensor.firings[0]) & self._mask
        if t_echo >= self._half:
            return
        if sensor.listening:
            if t_echo > self.window_us:
                self._count(LATE)
                return
            if t_echo < self.blanking_us:
                if sensor.echo_us is None:
                    sensor.outside, sensor.echo_us = True, t_echo
                return
            if sensor.outside or sensor.echo_us is None or t_echo < sensor.echo_us:
                sensor.echo_us = t_echo
            sensor.outside = False
            if sensor.can_emit:
                return
        else:
            if t_echo <= self.window_us or sensor.outside:
                return
            sensor.outside, sensor.echo_us = True, t_echo
        sensor.can_emit = True
        pends = self._pending > 0 or self._oldest != NOBODY
        if not pends or not self._reached(at_us, self._emit_at):
            self._emit_at = at_us
        self._pending += 1

    def fired(self, x, at_us):
        """Corrects when a sensor last fired, before or after its poll. Call it before you poll for readings that may hold
        its sound. An instant that is not after the firing before is ignored."""
        sensor = self._sensors[x]
        firings = sensor.firings
        polled = firings[0]
        if at_us == polled or at_us == firings[1] or not self._reached(at_us, firings[1]):
            return
        firings[0] = at_us
        later = (at_us - polled) & self._mask
        earlier = later >= self._half
        if earlier:
            later -= self._mask + 1
        if not sensor.listening and sensor.known_us is not None:
            sensor.known_us -= later
            if sensor.known_us < 0:
                sensor.forget()
        if sensor.echo_us is not None:
            sensor.echo_us -= later
            if sensor.echo_us < 0:
                # The first edge came before it fired, and may have kept out the echo.
                sensor.echo_us, sensor.outside = 0, True
        if sensor.listening:
            if not earlier:
                self._last_fired = (self._last_fired + later) & self._mask
                self._due = (self._due + later) & self._mask
                later = min(later, 0xFFFF)
                self._latest = max(self._latest, later)
                self._total = min(self._total + later, 0xFFFF)
            if self._oldest == x:
                self._find_oldest(polled)
                self._emit_when_oldest_ends()
        self._disturb()

    def stuck(self, x):
        """The echo line of a sensor was high when it was to be fired."""
        if self._sensors[x].listening:
            self._sensors[x].stuck = True

    def answered(self, x, answered=True):
        """A sensor has shown that it listens, or what looked like that was a disturbance. Otherwise `silence` says what a
        firing without an echo is."""
        if self._sensors[x].listening:
            self._sensors[x].unanswered = not answered

    def measured(self, x, t_echo_us):
        """Takes what hardware or a protocol measured of a sensor's last firing, before its reading is emitted: the echo time, or None
        if it listened and heard nothing."""
        if t_echo_us is None:
            self.answered(x)
        else:
            self.echo(x, (self._sensors[x].firings[0] + t_echo_us) & self._mask)

    def forget(self, x):
        """Forgets a sensor's echo, which is not what it seemed: its next reading is compared with nothing."""
        self._sensors[x].forget()

    def enable(self, x, enabled=True):
        """Lets a sensor fire, or not, from its next turn on."""
        sensor = self._sensors[x]
        if enabled and not sensor.enabled:
            sensor.forget()
            self._disturb()
        sensor.enabled = enabled
        self._skip()

    def restart(self, now_us):
        """Again with the first phase, after a long sleep. Nothing is known then."""
        self._restart(now_us)
        for sensor in self._sensors:
            sensor.shows, sensor.seen_at, sensor.doubted, sensor.silent = "no_firing", now_us, False, False

    def _restart(self, now_us):
        settling = self.schedule._settling_us()
        waits = (self._last_fired + settling - now_us) & self._mask
        if 0 < waits <= self._horizon():
            self._due = (now_us + waits) & self._mask
        else:
            self._last_fired, self._due = (now_us - settling) & self._mask, now_us
        self._begin_period(0)
        # Sound from before may still be heard. A sensor that was said to fire a little later still does.
        self._known_from = now_us
        for sensor in self._sensors:
            fired_us = sensor.firings[0]
            if (fired_us - self._known_from - 1) & self._mask < self._step_back:
                self._known_from = fired_us
            sensor.drop(self._known_at(now_us))
        self._oldest, self._pending = NOBODY, 0
        self._disturb()


class HcSr04Ring:
    """A ring of HC-SR04 modules, on one pin each or with the echo lines on other pins. Needs `machine` and `time`; both may
    be handed in. A reading is what `Ring.poll` says; `read` samples the lines, so call it often."""

    # Of an HC-SR04; a subclass for another module has its own.
    DEAF_US, SHORTEST_US, LONGEST_US = 100, 100, 36000
    MIN_RETRIGGER_US, TRIGGER_US = 60000, 10
    LATEST_RISE_US = 1400  # a line that is still low then is not raised by its trigger: exchanged wires, or a disturbance
    LONGEST_HOLD_US = 250000  # a line that rose and is high no longer than this listens still: clones hold 200 ms
    # A stuck line is pulled low for so long, such as 200 us, if this is not 0: some modules hold it for ever after a lost
    # echo. It needs a resistor of 1 kOhm, since module and pin drive against each other.
    RECOVERY_US = 0
    RING = Ring
    SOON_US = 1000  # what is due so soon is waited for: modules that fire late by differing times compare less

    def __init__(self, schedule, pins, echoes=None, machine=None, time=None, **ring):
        if schedule.min_refire_us < self.MIN_RETRIGGER_US:
            needs = schedule.min_refire_us, self.MIN_RETRIGGER_US
            raise ValueError("a module would fire again after %d us: %d expected" % needs)
        if len(pins) != schedule.sensors or (echoes is not None and len(echoes) != len(pins)):
            raise ValueError("%d pins for %d sensors" % (len(pins), schedule.sensors))
        if machine is None:
            import machine
        if time is None:
            import time
        self._pin, self._time = machine.Pin, time
        self._one_pin = echoes is None
        self._triggers = [machine.Pin(pin) for pin in pins]
        self._echoes = self._triggers if echoes is None else [machine.Pin(pin) for pin in echoes]
        for pin in self._echoes:
            pin.init(machine.Pin.IN)
        if not self._one_pin:
            for pin in self._triggers:
                pin.init(machine.Pin.OUT, value=0)
        # The period of ticks_us is a power of two: from half a turn on, differences are negative.
        bits = 1
        while time.ticks_diff(1 << bits - 1, 0) > 0:
            bits += 1
        ring.setdefault("clock_bits", bits)
        self.ring = self.RING(schedule, time.ticks_us(), **ring)
        # A line that does not rise is no free space.
        self.ring.silence = NEEDS_ANSWER
        self.change_us = None  # as of `Ring.poll`, for a robot that moves
        self._rose = [None] * len(pins)
        self._awaits = [False] * len(pins)

    def _since_firing(self, x, now):
        return self._time.ticks_diff(now, self.ring._sensors[x].firings[0])

    def _sample(self):
        # Small and without objects of its own, for the same reason as `Ring.poll`.
        for x in range(len(self._awaits)):
            if self._awaits[x]:
                high = self._echoes[x].value()
                now = self._time.ticks_us()
                if (high == 1) == (self._rose[x] is None):
                    self._edge(x, high, now)
                elif not high and self._since_firing(x, now) > self.LATEST_RISE_US:
                    self._awaits[x] = False

    def _edge(self, x, high, now):
        if self._echoes[x].value() != high:
            return  # a spike or a gap
        rose = self._rose[x]
        if rose is None:
            if self._since_firing(x, now) >= self.DEAF_US:
                self._rose[x] = now
                self.ring.answered(x)
        else:
            width = self._time.ticks_diff(now, rose)
            self._rose[x] = None
            if width >= self.SHORTEST_US:
                self._awaits[x] = False
                if width < self.LONGEST_US:
                    self.ring.measured(x, width)
            else:
                self.ring.answered(x, False)

    def _trigger(self, x):
        pin, rose, high = self._triggers[x], self._rose[x], self._echoes[x].value()
        if high and rose is not None:
            if self._time.ticks_diff(self.ring._sensors[x].firings[0], rose) <= self.LONGEST_HOLD_US:
                # It has heard nothing of an earlier trigger yet: nothing is in range.
                self.ring.answered(x)
                return
        elif rose is not None:
            # Its pulse never ended: what counted as silence may have been an echo.
            self.ring.forget(x)
        self._rose[x], self._awaits[x] = None, False
        if high:
            self.ring.stuck(x)
            if self.RECOVERY_US:
                self._echoes[x].init(self._pin.OUT, value=0)
                self._time.sleep_us(self.RECOVERY_US)
                self._echoes[x].init(self._pin.IN)
            return
        if self._one_pin:
            pin.init(self._pin.OUT, value=0)
        self._awaits[x] = True
        pin.value(1)
        self._time.sleep_us(self.TRIGGER_US)
        pin.value(0)
        # What is compared is what was fired, and since the poll some time has passed.
        self.ring.fired(x, self._time.ticks_us())
        if self._one_pin:
            pin.init(self._pin.IN)

    def state(self, x):
        """As `Ring.state`, now."""
        return self.ring.state(x, self._time.ticks_us())

    def read(self):
        """One step; a reading if there is one, else None."""
        ticks, diff = self._time.ticks_us, self._time.ticks_diff
        # The clock is read before the lines, so that no window closes on an edge that came in time.
        now = ticks()
        self._sample()
        while 0 < diff(self.ring.deadline(), now) <= self.SOON_US:
            now = ticks()
            self._sample()
        event = self.ring.poll(now, self.change_us)
        if event is None:
            return None
        if event[0] == FIRE:
            self._trigger(event[1])
        return event if event[0] == READING else None

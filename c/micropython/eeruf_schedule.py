"""Tables of firing times, verified. Beside eeruf.py; a ring that fires by flow needs none.

`eeruf design RING.toml` finds the firing times. Times are microseconds.

Licence: MIT OR Apache-2.0.
"""


class Schedule:
    """When each sensor fires: for each phase a list of times after the start of the period, one for each sensor."""

    def __init__(self, period_us, t_fire_us):
        sensors = len(t_fire_us[0]) if t_fire_us else 0
        if not 1 <= len(t_fire_us) <= 8:
            raise ValueError("%d phases: 1 to 8 expected" % len(t_fire_us))
        if not 1 <= sensors <= 64:
            raise ValueError("%d sensors: 1 to 64 expected" % sensors)
        if not 1 <= period_us <= 1 << 28:
            raise ValueError("period_us = %d: 1 to 268435456 expected" % period_us)
        self.period_us, self.sensors, self.phases = period_us, sensors, len(t_fire_us)
        self.t_fire_us = t_fire_us
        self.order, self.gap_us = [], []
        for phase, times in enumerate(t_fire_us):
            if len(times) != sensors:
                raise ValueError("phase %d has %d firing times, phase 0 has %d" % (phase, len(times), sensors))
            if min(times) < 0 or max(times) >= period_us:
                raise ValueError("phase %d: a sensor fires outside the period of %d us" % (phase, period_us))
            order = sorted(range(sensors), key=lambda x: (times[x], x))
            at = [times[x] for x in order] + [period_us]
            self.order.append(order)
            self.gap_us.append([at[i] - (at[i - 1] if i else 0) for i in range(sensors + 1)])
        self.min_refire_us = min(
            t_fire_us[(m + 1) % self.phases][x] + period_us - t_fire_us[m][x]
            for m in range(self.phases)
            for x in range(sensors)
        )
        # What it was verified for.
        self.verified = False
        self.t_delta_us = self.min_interval_us = self.window_us = self.separation_us = 0
        self.audible_us = period_us  # how long sound may be heard

    def verify(self, t_delta_us, min_interval_us=0, window_us=0, neighbours=0, layout="ring", stale_echo=False):
        """Returns the schedule if (13a) and (13b) hold for `t_delta_us` and two of this many neighbours never fire sooner
        one after the other than `min_interval_us`; else a ValueError says what does not. No window: the longest."""
        if self.phases != 2:
            raise ValueError("%d phases: two can be verified" % self.phases)
        a, b = self.t_fire_us
        n, needed = self.sensors, 2 * t_delta_us + 1
        d = [a[x] - b[x] for x in range(n)]
        separation = 0xFFFFFFFF
        for x in range(n):
            for y in range(x + 1 if stale_echo else x):
                moves = abs(d[x] + d[y]) if x == y else min(abs(d[x] - d[y]), abs(d[x] + d[y]))
                separation = min(separation, moves)
                if moves < needed:
                    raise ValueError(
                        "crosstalk of sensors %d and %d moves by %d us: %d us needed" % (y, x, moves, needed)
                    )
        for x in range(n):
            for y in range(n):
                steps = abs(x - y)
                if layout == "blocks":
                    close = neighbours > 0 and x // neighbours == y // neighbours
                else:
                    close = steps < neighbours or (layout == "ring" and n - steps < neighbours)
                if x == y or not close:
                    continue
                for here, after in ((a, b), (b, a)):
                    if (
                        abs(here[x] - here[y]) < min_interval_us
                        or after[y] + self.period_us - here[x] < min_interval_us
                    ):
                        raise ValueError("neighbours %d and %d fire less than %d us apart" % (x, y, min_interval_us))
        if window_us > self.min_refire_us:
            raise ValueError("window_us = %d: at most %d possible" % (window_us, self.min_refire_us))
        self.verified = True
        self.t_delta_us, self.min_interval_us, self.separation_us = t_delta_us, min_interval_us, separation
        self.window_us = window_us or self.min_refire_us
        self.audible_us = (2 if stale_echo else 1) * self.period_us
        return self

    def _settling_us(self):
        return max(self.min_interval_us if self.verified else self.period_us, self.min_refire_us)

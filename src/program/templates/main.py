from eeruf import ACCEPTED, CLEAR, KIND, SENSOR, T_ECHO, Flow, HcSr04FlowRing

# Looks at a line are up to so far apart, in microseconds: two readings may differ by as much more for either edge. A
# loop that does other work has more.
LOOK_US = 200

flow = Flow(
    @sensors@, @window_us@, blanking_us=@blanking_us@, least_us=@least_us@, most_us=@most_us@, rest_us=@rest_us@,
    dice_us=@dice_us@, t_delta_us=@t_delta_us@ + 2 * LOOK_US, near_us=@near_us@ + 2 * LOOK_US,
    path_change_us=@path_change_us@, top_speed_mm_s=@top_speed_mm_s@, alone=@alone@, votes=@votes@,
)  # fmt: skip


class Modules(HcSr04FlowRing):
    """Modules with the times of these."""

    DEAF_US, SHORTEST_US, LONGEST_US = @deaf_us@, @shortest_us@, @longest_us@
    MIN_RETRIGGER_US, TRIGGER_US = @rest_us@, @trigger_us@
    LATEST_RISE_US, LONGEST_HOLD_US = @latest_rise_us@, @longest_hold_us@


print("seed", flow.seed)
print("polled: a loop that comes later than", LOOK_US, "us has fewer distances")
ring = Modules(flow, pins=@triggers@, echoes=@echoes@)
while True:
    # A robot that knows how it moves says so once a control cycle, in mm/s and mrad/s; else the ring file's speed counts:
    # ring.moving(speed, turn)
    reading = ring.read()
    if ring.too_slow():
        print("the loop is too slow: modules are not heard")
    if reading and reading[KIND] == ACCEPTED:
        print(reading[SENSOR] + 1, reading[T_ECHO] * 1716 // 10000)
    elif reading and reading[KIND] == CLEAR:
        print(reading[SENSOR] + 1, "free")

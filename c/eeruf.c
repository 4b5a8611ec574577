/* eeruf in C: see eeruf.h. The parts follow the header; the flow ring comes last.
 * Equations and sections are those of Borenstein and Koren, IEEE Trans. Robotics and Automation 11(1), 1995. */
#include "eeruf.h"

#include <string.h>

#define READY ((uint16_t)(0x4500u + EERUF_VERSION))
#define NOBODY 255u
#define UNDECIDED 254u /* the next of a flow ring, until a call after a firing needs it */
#define HALF_TURN 0x80000000u /* of the clock: beyond it two instants have no order */

/* Sizes that tables and callers rely on. */
#define SIZE_IS(type, size) typedef char type##_has_another_size[sizeof(type) == (size) ? 1 : -1]
#ifdef __AVR__
SIZE_IS(EerufSchedule, 46);
SIZE_IS(EerufLimits, 7);
SIZE_IS(EerufWatched, 10);
SIZE_IS(EerufRing, 73);
SIZE_IS(EerufEdge, 7);
#define PADDING 0u
#else
#define PADDING 2u
#endif
SIZE_IS(EerufSensor, 14 + PADDING + 4 * EERUF_FIRINGS);
SIZE_IS(EerufLine, 8);
SIZE_IS(EerufFlowSensor, 42 + PADDING);

#ifdef __AVR__
#define READ8(place) pgm_read_byte(&(place))
#define READ16(place) pgm_read_word(&(place))
#define READ32(place) pgm_read_dword(&(place))
#define READ_POINTER(type, place) ((type)pgm_read_ptr(&(place)))
#else
#define READ8(place) (place)
#define READ16(place) (place)
#define READ32(place) (place)
#define READ_POINTER(type, place) (place)
#endif

/* For functions whose inlining costs more flash than a call, measured on an AVR. */
#if defined(__GNUC__)
#define OUT_OF_LINE __attribute__((noinline))
#else
#define OUT_OF_LINE
#endif
/* Inlined with a constant argument, so that each kind of ring links nothing of the other. */
#if defined(__GNUC__)
#define IN_LINE inline __attribute__((always_inline))
#else
#define IN_LINE
#endif

uint16_t eeruf_version(void) {
    return EERUF_VERSION;
}

/* True if `now` is `deadline` or up to half a turn of the clock past it. */
static bool EERUF_IN_RAM has_reached(uint32_t now, uint32_t deadline) {
    return now - deadline < HALF_TURN;
}

static uint16_t narrow(uint32_t time) {
    return (uint16_t)(time >> 16) != 0 ? UINT16_MAX : (uint16_t)time;
}

static uint16_t add16(uint16_t one, uint16_t other) {
    const uint16_t sum = (uint16_t)(one + other);
    return sum < one ? UINT16_MAX : sum;
}

static uint32_t add32(uint32_t one, uint32_t other) {
    return one > UINT32_MAX - other ? UINT32_MAX : one + other;
}

static uint32_t apart(uint32_t one, uint32_t other) {
    return one > other ? one - other : other - one;
}

static uint32_t longer(uint32_t one, uint32_t other) {
    return one > other ? one : other;
}

static uint32_t shorter(uint32_t one, uint32_t other) {
    return one < other ? one : other;
}

/* ---- Schedules ---- */

static bool is_verified(const EerufSchedule *schedule) {
    return READ8(schedule->verified) != 0;
}

/* A place in the firing order of a phase: its sensor, or NOBODY for the end of the period, and the gap before it. */
static uint8_t firing(const EerufSchedule *schedule, uint8_t sensors, uint8_t phase, uint8_t place, uint32_t *gap_us) {
    const uint8_t *order = READ_POINTER(const uint8_t *, schedule->order);
    const uint32_t *gaps = READ_POINTER(const uint32_t *, schedule->gap_us);
    const uint16_t at = (uint16_t)(phase * sensors + place);
    *gap_us = READ32(gaps[at + phase]);
    return place < sensors ? READ8(order[at]) : (uint8_t)NOBODY;
}

/* The time from the start of the period to a sensor's firing in a phase. */
static uint32_t fires_at(const EerufSchedule *schedule, uint8_t phase, uint8_t sensor) {
    const uint8_t sensors = READ8(schedule->sensors);
    uint32_t at = 0, gap;
    uint8_t place;
    for (place = 0; place < sensors; place++) {
        const uint8_t who = firing(schedule, sensors, phase, place, &gap);
        at += gap;
        if (who == sensor) break;
    }
    return at;
}

/* The time from a sensor's firing in a phase to its next one. */
static uint32_t refire(const EerufSchedule *schedule, uint8_t phase, uint8_t sensor) {
    const uint8_t next = phase + 1u < READ8(schedule->phases) ? (uint8_t)(phase + 1u) : 0;
    return fires_at(schedule, next, sensor) + READ32(schedule->period_us) - fires_at(schedule, phase, sensor);
}

static uint32_t shortest_refire(const EerufSchedule *schedule) {
    uint32_t least = UINT32_MAX;
    uint8_t sensor, phase;
    for (sensor = 0; sensor < READ8(schedule->sensors); sensor++)
        for (phase = 0; phase < READ8(schedule->phases); phase++)
            least = shorter(least, refire(schedule, phase, sensor));
    return least;
}

static bool are_neighbours(const EerufSchedule *schedule, uint8_t x, uint8_t y) {
    const uint8_t n = READ8(schedule->neighbours), steps = x > y ? (uint8_t)(x - y) : (uint8_t)(y - x);
    if (x == y) return false;
    switch (READ8(schedule->layout)) {
    case EERUF_LAYOUT_LINE: return steps < n;
    case EERUF_LAYOUT_RING: return steps < n || READ8(schedule->sensors) - steps < n;
    case EERUF_LAYOUT_BLOCKS: return n > 0 && x / n == y / n;
    default: return false;
    }
}

/* The time by which a sensor fires earlier in phase b than in phase a, each relative to the start of its period. */
static int32_t shift_of(const EerufSchedule *schedule, uint8_t sensor) {
    return (int32_t)fires_at(schedule, 0, sensor) - (int32_t)fires_at(schedule, 1, sensor);
}

/* The part of (13a) and (13b) that rejecting all crosstalk needs: the smaller of |d_x - d_y| and |d_x + d_y|. With x =
   y the second is the shift of a sensor's own echo from the previous period. */
static uint32_t moves_by(const EerufSchedule *schedule, uint8_t x, uint8_t y) {
    const int32_t dx = shift_of(schedule, x), dy = shift_of(schedule, y);
    const uint32_t even = (uint32_t)(dx > dy ? dx - dy : dy - dx);
    const uint32_t odd = (uint32_t)(dx + dy < 0 ? -(dx + dy) : dx + dy);
    return x == y ? odd : shorter(even, odd);
}

/* The t_delta of one sensor. */
static uint32_t own_t_delta(const EerufLimits *limits, uint8_t sensor, uint32_t t_delta_us) {
    return limits == NULL ? t_delta_us : READ16(limits[sensor].t_delta_us);
}

/* True if two sensors fire together, and so are declared not to hear each other. */
static bool fire_together(const EerufLimits *limits, uint8_t x, uint8_t y) {
    if (limits == NULL || x == y || READ8(limits[x].group) == 0) return false;
    return READ8(limits[x].group) == READ8(limits[y].group);
}

/* The limits that a schedule achieves: the largest t_delta and window of its sensors, and the least shift of crosstalk,
   which exceeds that t_delta by the margin of the closest pair. */
typedef struct Achieved {
    uint32_t t_delta_us, window_us, separation_us;
} Achieved;

/* True if the schedule meets the requirements that it names. */
static EerufStatus meets(const EerufSchedule *schedule, Achieved *achieved) {
    const EerufLimits *limits = READ_POINTER(const EerufLimits *, schedule->limits);
    const uint32_t all_t_delta_us = READ32(schedule->t_delta_us), all_window_us = READ32(schedule->window_us);
    const uint32_t min_interval_us = READ32(schedule->min_interval_us);
    const uint8_t sensors = READ8(schedule->sensors), stale_echo = READ8(schedule->stale_echo);
    uint32_t spare_us = UINT32_MAX;
    EerufStatus stale = EERUF_OK, last = EERUF_OK;
    uint8_t x, y, phase;
    achieved->t_delta_us = achieved->window_us = 0;
    if (READ8(schedule->phases) != 2) return EERUF_ERR_PHASES;
    for (x = 0; x < sensors; x++) {
        const uint32_t own_us = own_t_delta(limits, x, all_t_delta_us);
        const uint32_t listens_us = limits == NULL ? all_window_us : READ32(limits[x].window_us);
        achieved->t_delta_us = longer(achieved->t_delta_us, own_us);
        achieved->window_us =
            longer(achieved->window_us, listens_us == 0 ? READ32(schedule->min_refire_us) : listens_us);
        for (phase = 0; phase < 2; phase++)
            if (refire(schedule, phase, x) < listens_us) last = EERUF_ERR_WINDOW;
        for (y = 0; y <= x; y++) {
            const uint32_t moves = moves_by(schedule, x, y);
            const uint32_t larger_us = longer(own_us, own_t_delta(limits, y, all_t_delta_us));
            if (fire_together(limits, x, y)) {
                for (phase = 0; phase < 2; phase++)
                    if (last == EERUF_OK && fires_at(schedule, phase, x) != fires_at(schedule, phase, y))
                        last = EERUF_ERR_TOGETHER;
                continue;
            }
            if (x == y && !stale_echo) continue;
            if (moves < add32(add32(larger_us, larger_us), 1)) {
                if (x != y) return EERUF_ERR_CROSSTALK;
                stale = EERUF_ERR_STALE_ECHO;
            } else {
                spare_us = shorter(spare_us, moves - larger_us);
            }
        }
    }
    if (stale != EERUF_OK) return stale;
    for (phase = 0; phase < 2; phase++) {
        for (x = 0; x < sensors; x++) {
            const uint32_t t_x = fires_at(schedule, phase, x);
            for (y = 0; y < sensors; y++) {
                const uint32_t t_next = fires_at(schedule, (uint8_t)(1u - phase), y) + READ32(schedule->period_us);
                if (!are_neighbours(schedule, x, y)) continue;
                if (apart(t_x, fires_at(schedule, phase, y)) < min_interval_us || t_next - t_x < min_interval_us)
                    return EERUF_ERR_INTERVAL;
            }
        }
    }
    achieved->separation_us = add32(achieved->t_delta_us, spare_us);
    return last;
}

/* Time for which sound may be audible: beyond it a sensor's own echo, sent two firings before, reads the same. */
static uint32_t audible_for(const EerufSchedule *schedule) {
    const uint32_t period_us = READ32(schedule->period_us);
    return READ8(schedule->stale_echo) ? 2 * period_us : period_us;
}

static EerufStatus schedule_is_usable(const EerufSchedule *schedule) {
    uint16_t version;
    if (schedule == NULL) return EERUF_ERR_NULL;
    version = READ16(schedule->version);
    if (version != EERUF_VERSION) return version == 0 ? EERUF_ERR_NOT_READY : EERUF_ERR_VERSION;
    if (READ8(schedule->sensors) - 1u >= EERUF_MAX_SENSORS) return EERUF_ERR_SENSORS;
    if (READ8(schedule->phases) - 1u >= EERUF_MAX_PHASES) return EERUF_ERR_PHASES;
    return EERUF_OK;
}

EerufStatus eeruf_schedule_check(const EerufSchedule *schedule) {
    EerufStatus status = schedule_is_usable(schedule);
    Achieved achieved;
    uint32_t gap_us, path_change_us;
    uint8_t sensors, phase, place, seen;
    if (status != EERUF_OK) return status;
    if (READ32(schedule->period_us) - 1u >= EERUF_MAX_PERIOD_US) return EERUF_ERR_PERIOD;
    sensors = READ8(schedule->sensors);
    for (phase = 0; phase < READ8(schedule->phases); phase++) {
        uint32_t at = 0;
        for (place = 0; place <= sensors; place++) {
            const uint8_t sensor = firing(schedule, sensors, phase, place, &gap_us);
            const bool is_end = place == sensors;
            uint32_t ignored;
            if (gap_us > READ32(schedule->period_us) - at) return EERUF_ERR_TABLE;
            at += gap_us;
            if (is_end != (at == READ32(schedule->period_us))) return EERUF_ERR_FIRE;
            if (!is_end && sensor >= sensors) return EERUF_ERR_TABLE;
            for (seen = 0; !is_end && seen < place; seen++)
                if (firing(schedule, sensors, phase, seen, &ignored) == sensor) return EERUF_ERR_TABLE;
        }
    }
    if (READ32(schedule->min_refire_us) != shortest_refire(schedule)) return EERUF_ERR_TABLE;
    if (!is_verified(schedule)) return EERUF_ERR_UNVERIFIED;
    status = meets(schedule, &achieved);
    if (status != EERUF_OK) return status;
    if (achieved.t_delta_us != READ32(schedule->t_delta_us)) return EERUF_ERR_TABLE;
    if (achieved.window_us != READ32(schedule->window_us)) return EERUF_ERR_TABLE;
    if (achieved.separation_us != READ32(schedule->separation_us)) return EERUF_ERR_TABLE;
    path_change_us = READ32(schedule->path_change_us);
    if (path_change_us != EERUF_AS_T_DELTA && achieved.separation_us - achieved.t_delta_us <= path_change_us)
        return EERUF_ERR_CROSSTALK;
    return READ32(schedule->audible_us) - 1u >= audible_for(schedule) ? EERUF_ERR_TABLE : EERUF_OK;
}

/* ---- The filter ---- */

/* Number of consecutive readings that contained an echo, up to `consecutive`; 0 if nothing is known. */
#define RUN 0x0fu
#define DISABLED 0x80u /* of a ring's sensor, kept in the same byte */

static void forget(EerufFilter *filter) {
    filter->known_us = EERUF_NO_ECHO;
    filter->state &= DISABLED;
}

/* The greatest uncertainty of an echo time. A sensor's filter stores it in units of 2 us, the current firing's first;
   WIDE stands for more. */
#define MOST_OFF_US 300u
#define WIDE UINT8_MAX

/* The joint uncertainty of the echoes of the current firing and the one before. */
static uint16_t pair_off(const EerufFilter *filter) {
    return (uint16_t)(2 * (filter->off[0] + filter->off[1]));
}

/* Tests Eq. (11) after subtracting the expected change. Echoes are below half a turn. */
static bool near_identical(uint32_t echo_us, uint32_t previous_us, int32_t change_us, uint16_t t_delta_us) {
    /* Silence does not move, and is further from any echo than any t_delta. */
    const bool is_silent = echo_us == EERUF_NO_ECHO || previous_us == EERUF_NO_ECHO;
    const uint32_t change = is_silent ? 0 : (uint32_t)change_us;
    /* A negative change is added to the later echo instead. */
    if (change >= HALF_TURN) echo_us += 0u - change;
    else previous_us += change;
    return apart(echo_us, previous_us) <= t_delta_us;
}

/* True if a reading agrees with the one before. */
static bool agrees(const EerufFilter *filter, uint16_t t_delta_us, uint32_t t_echo_us, int32_t change_us) {
    return (filter->state & RUN) != 0 && near_identical(t_echo_us, filter->known_us, change_us, t_delta_us);
}

/* Records a reading that agrees with the one before, agrees but is explained, or does not agree. Returns its kind. */
static uint8_t push(EerufFilter *filter, uint8_t consecutive, uint32_t t_echo_us, bool agreed, bool explained) {
    const bool silent = t_echo_us == EERUF_NO_ECHO, was_silent = filter->known_us == EERUF_NO_ECHO;
    uint8_t run = 1;
    if (agreed && !explained) {
        run = filter->state & RUN;
        if (run < consecutive) run++;
    }
    filter->known_us = t_echo_us;
    filter->state = (uint8_t)((filter->state & DISABLED) | run);
    if (run >= consecutive) return silent ? EERUF_READING_CLEAR : EERUF_READING_ACCEPTED;
    if (silent) return EERUF_READING_NO_ECHO;
    if (explained) return EERUF_READING_AMBIGUOUS;
    if (was_silent) return EERUF_READING_FIRST;
    return run == 1 ? EERUF_READING_REJECTED : EERUF_READING_REPEATED;
}

/* Moves the origin of an echo time to a firing `later_us` later, modulo 2^32. False if the echo came before that
   firing; it then counts as simultaneous. */
static bool shift(uint32_t *t_echo_us, uint32_t later_us) {
    const uint32_t echo_us = *t_echo_us;
    if (echo_us == EERUF_NO_ECHO) return true;
    if (later_us >= HALF_TURN) {
        *t_echo_us = shorter(add32(echo_us, 0u - later_us), EERUF_NO_ECHO - 1u);
        return true;
    }
    *t_echo_us = echo_us < later_us ? 0 : echo_us - later_us;
    return echo_us >= later_us;
}

/* ---- The ring ---- */

/* The flags of a sensor, in addition to the period in which it fired, modulo 8. */
#define PERIOD 0x07u
#define LISTENING 0x08u    /* it has fired, and its reading is pending */
#define CAN_EMIT 0x10u     /* it has a reading that can be emitted before its window closes */
#define OUTSIDE 0x20u      /* its only edges so far came outside the window */
/* The evidence, in two bits: neither is set once it is complete. */
#define STUCK 0x40u        /* its line was high when it was to fire */
#define UNANSWERED 0x80u   /* nothing has shown yet that it listens: silence means nothing */
#define HELD 0xc0u         /* it holds its line: silence counts once that has fallen. Outlasts the reading */
#define NO_FAULT 0x01u     /* with UNANSWERED in the ring: silence is no fault either */

/* Flow rings do not fire by a table. Common code takes `flows` as a constant, so that only the kinds of rings that a
   program polls are linked; FLOWS asks the ring. */
#define FLOWS(ring) ((ring)->consecutive == 0)
#define FLOW_FIRINGS 3u /* fewer explain nothing, more add nothing */
static void fire_flow(EerufRing *ring, uint8_t sensor, uint32_t now_us);
static void correct_flow(EerufRing *ring, uint8_t x, uint32_t later_us);
static void judge(EerufRing *ring, uint8_t x, EerufReading *reading);
static void decide_from(EerufRing *ring, uint32_t now_us);
static void end_round(EerufRing *ring, uint32_t now_us);
static void restart_flow(EerufRing *ring, uint32_t now_us);
static uint32_t horizon_of_flow(const EerufRing *ring);
#define FIRINGS(flows) ((flows) ? FLOW_FIRINGS : EERUF_FIRINGS)
/* Calls of a flow ring's hook: see change_flow. */
enum { FORGETS = 0, BEGINS_AGAIN = 1, SILENCE_COUNTS = 2, DECIDES = 3 };

static void emit_when_oldest_ends(EerufRing *ring);

static EerufSensor *after(const EerufSensor *sensor, size_t bytes) {
    return (EerufSensor *)(void *)((uint8_t *)(uintptr_t)sensor + bytes);
}

static OUT_OF_LINE EerufSensor *sensor_of(const EerufRing *ring, uint8_t sensor) {
    return after(ring->sensors, (size_t)sensor * ring->stride);
}

static void count(EerufRing *ring, uint8_t kind) {
    if (ring->tally[kind] < UINT8_MAX) ring->tally[kind]++;
}

/* -- What was fired: see the header, and docs/explanation/theory.md, section 2.1. While all firings kept a verified
   timetable, (13a) and (13b) say what asking would find. A late firing delays all that follow, so the time between two
   firings is off by at most the lateness in between; a verified schedule has some of that to spare. -- */

#define AS_T_DELTA UINT16_MAX        /* the path change of a ring that follows its t_delta */
#define MAX_AUDIBLE ((uint32_t)1 << 26)
#define LONG_AGO ((uint32_t)1 << 30) /* older firings are not heard */
#define STEP_BACK ((uint32_t)1 << 20) /* an instant less far ahead of now is from before a step back of the clock */

/* Number of ends of periods for which an irregularity is remembered: the first of three readings, which a filter over
   three may compare, was fired three periods ago, and sound is audible for two. */
#define WATCHED 6u
#define ALWAYS UINT8_MAX /* the timetable is unproven, so each reading is checked */

/* The limits of a schedule's single sensors; null without a schedule: for a flow ring, or if it did not change. */
static OUT_OF_LINE const EerufLimits *limits_of(const EerufSchedule *schedule) {
    return schedule == NULL ? NULL : READ_POINTER(const EerufLimits *, schedule->limits);
}

/* Answers questions about limits of single sensors. Null until a ring with such limits begins, so that other programs
   link none of it. The questions concern a sensor and a value; FIRST_TO_CLOSE changes the ring. */
enum { WINDOW, SHORTEST_WINDOW, T_DELTA, TOGETHER, DIFFER, FIRST_TO_CLOSE };
static uint32_t (*limited)(const EerufRing *ring, uint8_t what, uint8_t x, uint32_t value);

static bool windows_differ(const EerufRing *ring) {
    return limited != NULL && limited(ring, DIFFER, 0, 0) != 0;
}

static uint32_t window_of(const EerufRing *ring, uint8_t sensor) {
    return limited == NULL ? ring->window_us : limited(ring, WINDOW, sensor, ring->window_us);
}

static uint16_t t_delta_of(const EerufRing *ring, uint8_t sensor) {
    return limited == NULL ? ring->t_delta_us : (uint16_t)limited(ring, T_DELTA, sensor, ring->t_delta_us);
}

/* True if a sensor does not hear another, because both fire together. */
static bool is_deaf_to(const EerufRing *ring, uint8_t receiver, uint8_t emitter) {
    return limited != NULL && limited(ring, TOGETHER, receiver, emitter) != 0;
}

/* The time for which a sensor listens: `window_us`, or less if the schedule allows it less. */
static OUT_OF_LINE uint32_t allowed_window(const EerufSchedule *schedule, uint8_t sensor, uint32_t window_us) {
    const EerufLimits *limits = limits_of(schedule);
    uint32_t own_us;
    if (limits == NULL) return window_us;
    own_us = READ32(limits[sensor].window_us);
    return shorter(window_us, own_us == 0 ? READ32(schedule->min_refire_us) : own_us);
}

static uint32_t shortest_window(const EerufSchedule *schedule, uint8_t sensors, uint32_t window_us) {
    while (sensors-- > 0) window_us = allowed_window(schedule, sensors, window_us);
    return window_us;
}

static void find_first_to_close(EerufRing *ring);

static uint32_t answer_by_schedule(const EerufRing *ring, uint8_t what, uint8_t x, uint32_t value) {
    const EerufLimits *const limits = limits_of(ring->schedule);
    switch (what) {
    case WINDOW: return allowed_window(ring->schedule, x, value);
    case SHORTEST_WINDOW: return shortest_window(ring->schedule, ring->count, value);
    case T_DELTA: return shorter(value, own_t_delta(limits, x, value));
    case TOGETHER: return fire_together(limits, x, (uint8_t)value);
    case FIRST_TO_CLOSE: find_first_to_close((EerufRing *)(uintptr_t)ring); return 0;
    default: return limits != NULL;
    }
}

static void heed_limits(const EerufSchedule *schedule) {
    if (limits_of(schedule) != NULL) limited = answer_by_schedule;
}

static uint32_t path_change_of(const EerufRing *ring, uint16_t t_delta_us) {
    return ring->path_change_us == AS_T_DELTA ? t_delta_us : ring->path_change_us;
}

/* Notes an irregularity or a changed setting: checks whether the schedule was verified for it. */
static OUT_OF_LINE void disturb(EerufRing *ring) {
    const EerufSchedule *schedule = ring->schedule;
    uint32_t promised_us;
    ring->watched = ALWAYS;
    if (!is_verified(schedule)) return;
    promised_us = READ32(schedule->path_change_us);
    if (promised_us == EERUF_AS_T_DELTA) promised_us = READ32(schedule->t_delta_us);
    if (ring->path_change_us != AS_T_DELTA && ring->path_change_us > promised_us) return;
    if (ring->audible_us > READ32(schedule->audible_us)) return;
    /* Sound sent two periods apart moves by at least the shortest time between a sensor's firings. */
    if (ring->t_delta_us + path_change_of(ring, ring->t_delta_us) < READ32(schedule->min_refire_us))
        ring->watched = WATCHED;
}

static void note_late(EerufRing *ring, uint16_t late_us) {
    if (late_us > ring->latest_us) ring->latest_us = late_us;
}

/* Notes that a firing made the timetable longer. */
static void add_late(EerufRing *ring, uint16_t late_us) {
    note_late(ring, late_us);
    ring->sum_late_us = add16(ring->sum_late_us, late_us);
}

/* Handles a late firing. Two readings span at most four periods. */
static OUT_OF_LINE void fired_late(EerufRing *ring, uint16_t late_us, bool flows) {
    uint32_t needed_us;
    add_late(ring, late_us);
    if (EERUF_FIRINGS == 1 || flows || ring->watched == ALWAYS) return;
    needed_us = ring->t_delta_us + path_change_of(ring, ring->t_delta_us) + 4 * (uint32_t)ring->sum_late_us + 1u;
    if (READ32(ring->schedule->separation_us) < needed_us) ring->watched = WATCHED;
}

/* Finds the sensor whose sound explains two echoes of a receiver: one heard `first_us` after its second-to-last firing,
   the other `second_us` after its last, along a path that changes by up to P plus `more_us`. */
static OUT_OF_LINE uint8_t explanation(const EerufRing *ring, uint8_t receiver, uint32_t first_us, uint32_t second_us,
                                       uint32_t more_us) {
    const EerufSensor *own = sensor_of(ring, receiver), *sensor = ring->sensors;
    /* Both echoes may be this much later, and their firings audible for twice this longer. */
    const uint8_t *off = own->filter.off, most_off = off[0] > off[1] ? off[0] : off[1];
    const uint32_t heard_before = own->fired_us[1] + first_us + 2u * most_off;
    const uint32_t heard = own->fired_us[0] + second_us + 2u * most_off;
    const uint32_t audible = ring->audible_us + 4u * most_off, between = heard - heard_before;
    const uint32_t change = path_change_of(ring, t_delta_of(ring, receiver)) + more_us + pair_off(&own->filter);
    uint32_t length = heard_before - ring->known_from_us;
    uint8_t x = 0, by = EERUF_BY_NOTHING;
    for (;;) {
        const uint32_t *before = sensor->fired_us, *fired, *end = before + FIRINGS(FLOWS(ring));
        /* All forgotten firings came before this. If it is after the first reading, one may explain it. */
        if (length < audible || length >= HALF_TURN) by = EERUF_BY_HISTORY;
        if (x == ring->count) return by;
        if (is_deaf_to(ring, receiver, x)) {
            length = HALF_TURN - 1;
            before = end;
        }
        for (; before < end; before++) {
            length = heard_before - *before;
            if (length > audible || before == own->fired_us + 1) continue;
            /* Both may be the same firing if the readings are that close. */
            for (fired = sensor->fired_us; fired <= before; fired++) {
                if (fired == own->fired_us || heard - *fired > audible) continue;
                if (*fired - *before - between + change <= 2 * change) return x;
            }
        }
        sensor = after(sensor, ring->stride);
        x++;
    }
}

static bool is_long_ago(uint32_t instant, uint32_t now_us) {
    return now_us - instant - LONG_AGO - 1u < 0u - STEP_BACK - LONG_AGO - 1u;
}

/* Sets all firings to an instant too long ago to be heard. */
static void forget_firings(EerufSensor *sensor, uint8_t firings, uint32_t now_us) {
    while (firings-- > 0) sensor->fired_us[firings] = now_us - LONG_AGO;
}

static void forget_readings(EerufRing *ring, uint8_t sensor);

static IN_LINE void end_late_period(EerufRing *ring, EerufPeriod *ended, uint32_t now_us, bool flows) {
    uint8_t x;
    ended->max_late_us = ring->latest_us;
    ended->sum_late_us = ring->sum_late_us;
    ring->latest_us = ring->sum_late_us = 0;
    /* Old firings must not look recent after a wrap of the clock. */
    for (x = 0; x < ring->count; x++) {
        EerufSensor *sensor = sensor_of(ring, x);
        if (is_long_ago(sensor->fired_us[0], now_us)) {
            forget_firings(sensor, FIRINGS(flows), now_us);
            /* The next reading cannot be compared: the instant of its previous firing is no longer known. */
            forget_readings(ring, x);
            /* No edge can be an echo of them. */
            if (!(sensor->filter.flags & LISTENING))
                sensor->filter.flags = (uint8_t)((sensor->filter.flags & PERIOD) | OUTSIDE);
        }
    }
    if (ring->watched != 0 && ring->watched != ALWAYS) ring->watched--;
    if (is_long_ago(ring->known_from_us, now_us)) ring->known_from_us = now_us - LONG_AGO;
}

/* -- Scheduled firing (Sec. 3.1, Fig. 3): every sensor fires once per period, by the table. A late firing delays all
   later ones by as much: the timetable may stretch but never shrinks. -- */

static void turn_once(EerufRing *ring) {
    uint32_t gap_us;
    ring->next = firing(ring->schedule, ring->count, ring->phase, ring->following, &gap_us);
    ring->following++;
    ring->due_us += gap_us;
}

static void skip_silent(EerufRing *ring) {
    while (ring->next != NOBODY && (ring->paused || (sensor_of(ring, ring->next)->filter.state & DISABLED)))
        turn_once(ring);
}

/* Moves on to the next sensor after a firing, or the start of the period, at `due_us`. */
static OUT_OF_LINE void turn(EerufRing *ring) {
    turn_once(ring);
    skip_silent(ring);
}

static OUT_OF_LINE void begin_period(EerufRing *ring, uint8_t phase) {
    ring->phase = phase;
    ring->following = 0;
    turn(ring);
}

/* Silence needed between the last firing and a period that was not verified against it. */
static uint32_t settling_time(const EerufSchedule *schedule) {
    const uint32_t least = is_verified(schedule) ? READ32(schedule->min_interval_us) : READ32(schedule->period_us);
    return longer(least, READ32(schedule->min_refire_us));
}

/* The longest time to a deadline, unless the clock has jumped. */
static OUT_OF_LINE uint32_t horizon_of_table(const EerufRing *ring) {
    return longer(3 * READ32(ring->schedule->period_us), ring->due_us - ring->last_fired_us);
}

/* Ends the period of a table. Returns true if the next one does not follow as scheduled. */
static bool end_period_of_table(EerufRing *ring, uint32_t now_us, uint32_t late_us) {
    const uint32_t settling = settling_time(ring->schedule);
    const bool changed = late_us > READ32(ring->schedule->period_us);
    const uint8_t phase = (uint8_t)(ring->phase + 1u);
    if (changed) ring->due_us = now_us;
    /* The last firing must not fall half a turn of the clock behind while no sensor is enabled. */
    if (ring->due_us - ring->last_fired_us > settling) ring->last_fired_us = ring->due_us - settling;
    begin_period(ring, phase < READ8(ring->schedule->phases) ? phase : 0);
    return changed;
}

/* Begins with the first phase, assuming enough silence before it. */
static OUT_OF_LINE void begin_table(EerufRing *ring, uint32_t at_us) {
    ring->due_us = at_us;
    ring->last_fired_us = at_us - settling_time(ring->schedule);
    begin_period(ring, 0);
}

static void restart_table(EerufRing *ring, uint32_t now_us) {
    const uint32_t settled_us = ring->last_fired_us + settling_time(ring->schedule);
    /* After a jump of the clock, the instant of the last firing is meaningless. */
    begin_table(ring, settled_us - now_us - 1u < horizon_of_table(ring) ? settled_us : now_us);
}

/* -- The operations of a ring -- */

/* Also makes a flow ring's decision that its last firing left open. */
static OUT_OF_LINE EerufStatus is_ready(const EerufRing *ring) {
    if (ring == NULL) return EERUF_ERR_NULL;
    if (ring->ready != READY) return EERUF_ERR_NOT_READY;
    if (ring->next == UNDECIDED) ring->hook((EerufRing *)(uintptr_t)ring, 0, DECIDES);
    return EERUF_OK;
}

static EerufStatus has_sensor(const EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = is_ready(ring);
    return status == EERUF_OK && sensor >= ring->count ? (EerufStatus)EERUF_ERR_SENSOR : status;
}

/* Checks that a schedule allows this t_delta and window. */
static EerufStatus allows(const EerufSchedule *schedule, uint32_t t_delta_us, uint32_t window_us) {
    if (is_verified(schedule)) {
        if (t_delta_us > READ32(schedule->t_delta_us)) return EERUF_ERR_T_DELTA;
        if (window_us > READ32(schedule->window_us)) return EERUF_ERR_VERIFIED_WINDOW;
        /* No sensor fires again within its own window. */
        if (limits_of(schedule) != NULL)
            return window_us >= HALF_TURN ? EERUF_ERR_WINDOW : EERUF_OK;
    }
    return window_us > READ32(schedule->min_refire_us) || window_us >= HALF_TURN ? EERUF_ERR_WINDOW : EERUF_OK;
}

/* Checks that the window exceeds blanking and t_delta. */
static EerufStatus can_hear(uint32_t t_delta_us, uint32_t window_us, uint32_t blanking_us) {
    if (blanking_us >= window_us || blanking_us > UINT16_MAX) return EERUF_ERR_BLANKING;
    return t_delta_us >= window_us || t_delta_us > UINT16_MAX ? EERUF_ERR_COARSE_T_DELTA : EERUF_OK;
}

/* Sets t_delta, window and blanking from now on, if they are allowed. */
static EerufStatus listen(EerufRing *ring, uint32_t t_delta_us, uint32_t window_us, uint32_t blanking_us) {
    const uint32_t shortest_us = limited == NULL ? window_us : limited(ring, SHORTEST_WINDOW, 0, window_us);
    const EerufStatus status = can_hear(t_delta_us, shortest_us, blanking_us);
    if (status != EERUF_OK) return status;
    ring->t_delta_us = (uint16_t)t_delta_us;
    ring->window_us = window_us;
    ring->blanking_us = (uint16_t)blanking_us;
    return EERUF_OK;
}

static OUT_OF_LINE void drop_firing(EerufRing *ring, uint8_t x, uint32_t now_us) {
    EerufSensor *sensor = sensor_of(ring, x);
    forget_firings(sensor, FIRINGS(FLOWS(ring)), now_us);
    sensor->echo_us = EERUF_NO_ECHO;
    forget_readings(ring, x);
    sensor->filter.flags = OUTSIDE;
    sensor->filter.off[0] = 0;
}

/* Sets up all but listening and scheduling. It assumes silence before: the caller must wait until earlier sound has
   died. */
static void set_up(EerufRing *ring, const EerufSchedule *schedule, void *sensors, uint8_t count_of_sensors,
                   size_t stride, uint8_t consecutive, void (*hook)(EerufRing *, uint8_t, uint32_t), uint32_t now_us) {
    uint8_t x;
    memset(ring, 0, sizeof *ring);
    memset(sensors, 0, count_of_sensors * stride);
    ring->schedule = schedule;
    ring->sensors = (EerufSensor *)sensors;
    ring->stride = (uint8_t)stride;
    ring->consecutive = consecutive;
    ring->hook = hook;
    ring->count = count_of_sensors;
    ring->oldest = NOBODY;
    ring->emit_at_us = now_us;
    ring->unanswered = UNANSWERED | NO_FAULT;
    ring->known_from_us = now_us - LONG_AGO;
    for (x = 0; x < count_of_sensors; x++) {
        drop_firing(ring, x, now_us);
        sensor_of(ring, x)->filter.age = EERUF_NEVER;
    }
}

static EerufStatus init(EerufRing *ring, size_t ring_size, EerufSensor *sensors, size_t sensors_size,
                        const EerufSchedule *schedule, const EerufConfig *config, uint32_t now_us, bool verified) {
    EerufStatus status;
    uint32_t t_delta_us, window_us;
    uint8_t count_of_sensors;
    if (ring == NULL || sensors == NULL || config == NULL) return EERUF_ERR_NULL;
    if (config->version != EERUF_VERSION) return EERUF_ERR_VERSION;
    if (ring_size != sizeof *ring) return EERUF_ERR_MEMORY;
    status = schedule_is_usable(schedule);
    if (status != EERUF_OK) return status;
    count_of_sensors = READ8(schedule->sensors);
    if (sensors_size < count_of_sensors * sizeof *sensors) return EERUF_ERR_MEMORY;
    t_delta_us = config->t_delta_us;
    window_us = config->window_us;
    if (!is_verified(schedule) && (verified || t_delta_us == 0)) return EERUF_ERR_UNVERIFIED;
    if (config->consecutive < 2 || config->consecutive > 8) return EERUF_ERR_CONSECUTIVE;
    if (config->audible_us - 1u < 999u) return EERUF_ERR_AUDIBLE;
    if (!is_verified(schedule) && window_us == 0) return EERUF_ERR_UNVERIFIED;
    if (t_delta_us == 0) t_delta_us = READ32(schedule->t_delta_us);
    if (window_us == 0) window_us = READ32(schedule->window_us);
    heed_limits(schedule);
    /* By default a table sets what it was verified for. */
    if (config->t_delta_us != 0 || config->window_us != 0) status = allows(schedule, t_delta_us, window_us);
    if (status != EERUF_OK) return status;
    set_up(ring, schedule, sensors, count_of_sensors, sizeof *sensors, config->consecutive, NULL, now_us);
    status = listen(ring, t_delta_us, window_us, config->blanking_us);
    if (status != EERUF_OK) return status;
    if (config->audible_us > MAX_AUDIBLE) return EERUF_ERR_AUDIBLE;
    if (config->path_change_us >= AS_T_DELTA) return EERUF_ERR_PATH_CHANGE;
    ring->path_change_us = (uint16_t)config->path_change_us;
    if (config->path_change_us == 0) ring->path_change_us = narrow(READ32(schedule->path_change_us));
    ring->audible_us = config->audible_us;
    /* An unverified schedule does not give it. */
    if (ring->audible_us == 0) ring->audible_us = READ32(schedule->audible_us);
    if (ring->audible_us == 0) ring->audible_us = READ32(schedule->period_us);
    ring->audible_us = shorter(ring->audible_us, MAX_AUDIBLE);
    disturb(ring);
    if (ring->watched == WATCHED) ring->watched = 0; /* nothing has been fired yet */
    begin_table(ring, now_us);
    ring->ready = READY;
    return EERUF_OK;
}

EerufStatus eeruf_ring_init(EerufRing *ring, size_t ring_size, EerufSensor *sensors, size_t sensors_size,
                            const EerufSchedule *schedule, const EerufConfig *config, uint32_t now_us) {
    return init(ring, ring_size, sensors, sensors_size, schedule, config, now_us, true);
}

EerufStatus eeruf_ring_init_unverified(EerufRing *ring, size_t ring_size, EerufSensor *sensors, size_t sensors_size,
                                       const EerufSchedule *schedule, const EerufConfig *config, uint32_t now_us) {
    return init(ring, ring_size, sensors, sensors_size, schedule, config, now_us, false);
}

/* True if a reading will be emitted without another firing: one is pending or there is an oldest. In one expression,
   since two branches take more flash. */
static bool has_pending(const EerufRing *ring) {
    return (uint8_t)(ring->pending | (ring->oldest ^ NOBODY)) != 0;
}

/* The instant when a sensor's last firing ends if there is no echo. */
static uint32_t closes_at(const EerufRing *ring, uint8_t x) {
    return sensor_of(ring, x)->fired_us[0] + longer(window_of(ring, x), ring->report_after_us);
}

/* Sets the next emission to the end of the oldest window, if no reading can be emitted sooner. */
static OUT_OF_LINE void emit_when_oldest_ends(EerufRing *ring) {
    if (ring->pending == 0 && ring->oldest != NOBODY)
        ring->emit_at_us = closes_at(ring, ring->oldest);
}

/* Finds the sensor whose window closes first, which is the oldest if windows differ. */
static void find_first_to_close(EerufRing *ring) {
    uint8_t x;
    ring->oldest = NOBODY;
    for (x = 0; x < ring->count; x++) {
        if (!(sensor_of(ring, x)->filter.flags & LISTENING)) continue;
        if (ring->oldest == NOBODY || !has_reached(closes_at(ring, x), closes_at(ring, ring->oldest)))
            ring->oldest = x;
    }
}

/* Finds the next oldest, now that the one that fired at `before` has stopped listening. All others fired later, or
   earlier by no more than the clock has stepped back: 1 us before is not 71 minutes after. */
static void find_oldest(EerufRing *ring, uint32_t before) {
    const EerufSensor *sensor = ring->sensors;
    uint32_t soonest = UINT32_MAX;
    uint8_t x, oldest = NOBODY;
    if (windows_differ(ring)) {
        (void)limited(ring, FIRST_TO_CLOSE, 0, 0);
        return;
    }
    before -= STEP_BACK;
    for (x = 0; x < ring->count; x++, sensor = after(sensor, ring->stride)) {
        const uint32_t since = sensor->fired_us[0] - before;
        if ((sensor->filter.flags & LISTENING) && since < soonest) {
            oldest = x;
            soonest = since;
        }
    }
    ring->oldest = oldest;
}

static IN_LINE void fire(EerufRing *ring, uint8_t sensor, uint32_t now_us, uint16_t late_us, bool flows) {
    EerufSensor *fired = sensor_of(ring, sensor);
    uint8_t place;
    fired->filter.flags = (uint8_t)(LISTENING | (ring->period & PERIOD) | (ring->unanswered & UNANSWERED));
    for (place = (uint8_t)(FIRINGS(flows) - 1u); place > 0; place--)
        fired->fired_us[place] = fired->fired_us[place - 1];
    fired->fired_us[0] = now_us;
    if (late_us != 0) fired_late(ring, late_us, flows);
    if (ring->oldest == NOBODY) {
        ring->oldest = sensor;
        emit_when_oldest_ends(ring);
    } else if (windows_differ(ring)) {
        (void)limited(ring, FIRST_TO_CLOSE, 0, 0);
        emit_when_oldest_ends(ring);
    }
    if (flows) {
        fire_flow(ring, sensor, now_us);
    } else {
        ring->last_fired_us = now_us;
        /* From now, not from when it was due: all that follows moves by as much as this firing is late. */
        ring->due_us = now_us;
        turn(ring);
    }
}

#define USABLE EERUF_READING_KINDS
#define ON_HOLD (EERUF_READING_KINDS + 1u) /* silence that does not count yet */

/* The kind of a firing that says nothing about the echo time; else USABLE or ON_HOLD. */
static uint8_t unusable(const EerufRing *ring, uint8_t flags, uint8_t off, uint32_t t_echo_us) {
    if ((flags & HELD) == STUCK) return EERUF_READING_STUCK;
    if (off == WIDE) return EERUF_READING_LATE;
    if (flags & OUTSIDE) return EERUF_READING_TOO_EARLY;
    if (!(flags & UNANSWERED) || t_echo_us != EERUF_NO_ECHO) return USABLE;
    if (flags & STUCK) return ON_HOLD;
    return ring->unanswered & NO_FAULT ? EERUF_READING_NO_ECHO : EERUF_READING_UNANSWERED;
}

/* Compares a reading, which has its echo time and a kind if it is unusable, with the one before. */
static void compare(EerufRing *ring, uint8_t x, int32_t change_us, EerufReading *reading) {
    EerufFilter *filter = &sensor_of(ring, x)->filter;
    if (reading->kind != USABLE && (reading->kind != ON_HOLD || filter->known_us != EERUF_NO_ECHO)) forget(filter);
    reading->previous_us = filter->known_us;
    if (reading->kind == ON_HOLD) {
        reading->kind = (filter->state & RUN) == ring->consecutive ? EERUF_READING_CLEAR : EERUF_READING_NO_ECHO;
        reading->age = filter->age;
        return;
    }
    if (reading->kind == USABLE) {
        const uint32_t echo_us = reading->t_echo_us;
        const bool agreed = agrees(filter, t_delta_of(ring, x), echo_us, change_us);
#if EERUF_FIRINGS > 1
        /* The proof covers readings that differ by no more than t_delta, at known times. */
        if (agreed && (ring->watched != 0 || change_us != 0 || pair_off(filter) != 0) && echo_us != EERUF_NO_ECHO)
            reading->explained_by = explanation(ring, x, filter->known_us, echo_us, 0);
#endif
        reading->kind = push(filter, ring->consecutive, echo_us, agreed, reading->explained_by != EERUF_BY_NOTHING);
    }
    if (reading->kind == EERUF_READING_ACCEPTED) filter->age = 0;
    else if (filter->age < EERUF_NEVER - 1u) filter->age++;
    reading->age = filter->age;
}

/* Counts a silence whose reading was already emitted. */
static OUT_OF_LINE void count_silence(EerufRing *ring, uint8_t x) {
    EerufFilter *filter = &sensor_of(ring, x)->filter;
    if (FLOWS(ring)) {
        ring->hook(ring, x, SILENCE_COUNTS);
        return;
    }
    (void)push(filter, ring->consecutive, EERUF_NO_ECHO, filter->known_us == EERUF_NO_ECHO, false);
    if (filter->age < EERUF_NEVER - 1u) filter->age++;
}

/* The phase of a table's period this many periods ago. */
static uint8_t phase_before(const EerufRing *ring, uint8_t ago) {
    const uint8_t phases = READ8(ring->schedule->phases);
    ago = (uint8_t)(ago % phases);
    return (uint8_t)(ring->phase >= ago ? ring->phase - ago : ring->phase + phases - ago);
}

static IN_LINE void emit_reading(EerufRing *ring, uint8_t x, uint32_t now_us, const int32_t *change_us,
                                 EerufEvent *event, bool flows) {
    EerufSensor *sensor = sensor_of(ring, x);
    const uint8_t flags = sensor->filter.flags, ago = (uint8_t)(ring->period - flags) & PERIOD;
    const bool was_stuck = (flags & HELD) == STUCK;
    EerufReading *reading = &event->u.reading;
    if (flags & CAN_EMIT) ring->pending--; /* counted when its edge came */
    reading->t_echo_us = was_stuck || sensor->filter.off[0] == WIDE ? EERUF_NO_ECHO : sensor->echo_us;
    reading->explained_by = EERUF_BY_NOTHING;
    sensor->echo_us = EERUF_NO_ECHO;
    if (flags & LISTENING) {
        reading->kind = unusable(ring, flags, sensor->filter.off[0], reading->t_echo_us);
        sensor->filter.flags = (uint8_t)(flags & (reading->kind == ON_HOLD ? PERIOD | HELD : PERIOD));
        if (flows) judge(ring, x, reading);
        else compare(ring, x, change_us == NULL ? 0 : change_us[x], reading);
        sensor->filter.off[1] = sensor->filter.off[0];
        sensor->filter.off[0] = 0;
        if (flows) decide_from(ring, now_us);
        if (ring->oldest == x) find_oldest(ring, sensor->fired_us[0]);
    } else {
        sensor->filter.flags = flags & (PERIOD | OUTSIDE);
        if ((flags & HELD) == HELD) count_silence(ring, x);
        reading->previous_us = EERUF_NO_ECHO;
        reading->age = sensor->filter.age;
        reading->kind = EERUF_READING_LATE;
    }
    emit_when_oldest_ends(ring);
    count(ring, reading->kind);
    event->kind = EERUF_EVENT_READING;
    if (!flows) event->phase = phase_before(ring, ago);
    event->period -= ago;
}

static IN_LINE void end_period(EerufRing *ring, uint32_t now_us, uint32_t late_us, EerufEvent *event,
                               bool flows) {
    EerufPeriod *ended = &event->u.ended;
    bool changed = false;
    uint8_t kind;
    note_late(ring, narrow(late_us));
    event->kind = EERUF_EVENT_PERIOD;
    event->sensor = 0;
    ring->period++;
    if (flows) end_round(ring, now_us);
    else changed = end_period_of_table(ring, now_us, late_us);
    end_late_period(ring, ended, now_us, flows);
    if (changed) disturb(ring);
    for (kind = 0; kind < EERUF_READING_KINDS; kind++) {
        ended->tally[kind] = ring->tally[kind];
        ring->tally[kind] = 0;
    }
}

/* A sensor with a reading to emit, or NOBODY: the first with an echo, or the oldest if its window is over. */
static uint8_t next_pending(const EerufRing *ring, bool emits) {
    uint8_t x;
    if (ring->pending == 0) return emits ? ring->oldest : (uint8_t)NOBODY;
    if (ring->oldest != NOBODY && (sensor_of(ring, ring->oldest)->filter.flags & CAN_EMIT)) return ring->oldest;
    for (x = 0; x < ring->count; x++)
        if (sensor_of(ring, x)->filter.flags & CAN_EMIT) return x;
    return NOBODY;
}

static IN_LINE void restart(EerufRing *ring, uint32_t now_us, bool flows) {
    uint8_t x;
    if (!flows) restart_table(ring, now_us);
    /* Earlier sound may still be heard, and its firings are unknown by this clock. A firing corrected to an instant
       just ahead is still known. */
    ring->known_from_us = now_us;
    for (x = 0; x < ring->count; x++) {
        const uint32_t fired_us = sensor_of(ring, x)->fired_us[0];
        if (fired_us - ring->known_from_us - 1u < STEP_BACK) ring->known_from_us = fired_us;
        drop_firing(ring, x, now_us);
    }
    if (flows) restart_flow(ring, now_us);
    ring->oldest = NOBODY;
    ring->pending = 0;
    if (!flows) disturb(ring);
}

/* Called both by polls and by the caller. */
static OUT_OF_LINE void restart_by_table(EerufRing *ring, uint32_t now_us) {
    restart(ring, now_us, false);
}
static OUT_OF_LINE void restart_by_flow(EerufRing *ring, uint32_t now_us) {
    restart(ring, now_us, true);
}

/* Firing comes first, since it should be on time; but a sensor's reading is emitted before it fires again. */
static IN_LINE EerufStatus poll(EerufRing *ring, uint32_t now_us, const int32_t *change_us, EerufEvent *event,
                                bool flows) {
    const uint32_t late_us = now_us - ring->due_us;
    const bool is_due = late_us < HALF_TURN, emits = has_pending(ring) && has_reached(now_us, ring->emit_at_us);
    uint8_t sensor = NOBODY;
    bool fires = false;
    if (event == NULL) return EERUF_ERR_NULL;
    if (!is_due && !emits) {
        /* The clock has jumped, or the ring was not polled for half a turn of it. */
        if (flows && 0u - late_us > horizon_of_flow(ring)) restart_by_flow(ring, now_us);
        if (!flows && 0u - late_us > horizon_of_table(ring)) restart_by_table(ring, now_us);
        return EERUF_OK;
    }
    if (is_due) sensor = ring->next;
    if (sensor == NOBODY) sensor = next_pending(ring, emits);
    else fires = !(sensor_of(ring, sensor)->filter.flags & (LISTENING | CAN_EMIT));
    event->sensor = sensor;
    event->phase = ring->phase;
    event->period = ring->period;
    if (fires) {
        event->kind = EERUF_EVENT_FIRE;
        event->u.due_us = ring->due_us;
        fire(ring, sensor, now_us, narrow(late_us), flows);
    } else if (sensor != NOBODY) {
        emit_reading(ring, sensor, now_us, change_us, event, flows);
    } else {
        end_period(ring, now_us, late_us, event, flows);
    }
    return EERUF_EVENT;
}

/* Checks that a ring fires by a table. */
static EerufStatus has_table(const EerufRing *ring) {
    const EerufStatus status = is_ready(ring);
    return status == EERUF_OK && FLOWS(ring) ? (EerufStatus)EERUF_ERR_FLOW : status;
}

EerufStatus eeruf_ring_poll_expecting(EerufRing *ring, uint32_t now_us, const int32_t *change_us, EerufEvent *event) {
    const EerufStatus status = has_table(ring);
    return status == EERUF_OK ? poll(ring, now_us, change_us, event, false) : status;
}

EerufStatus eeruf_ring_poll(EerufRing *ring, uint32_t now_us, EerufEvent *event) {
    return eeruf_ring_poll_expecting(ring, now_us, NULL, event);
}

OUT_OF_LINE uint32_t eeruf_ring_deadline(const EerufRing *ring) {
    if (is_ready(ring) != EERUF_OK) return 0;
    return has_pending(ring) && !has_reached(ring->emit_at_us, ring->due_us) ? ring->emit_at_us : ring->due_us;
}

OUT_OF_LINE uint32_t eeruf_ring_due(const EerufRing *ring) {
    return is_ready(ring) == EERUF_OK ? ring->due_us : 0;
}

EerufStatus eeruf_ring_upcoming(const EerufRing *ring, uint8_t number, uint8_t *sensor, uint32_t *due_us) {
    const EerufStatus status = is_ready(ring);
    uint32_t gap_us, at_us;
    uint8_t phase, place, next;
    bool goes_on;
    if (status != EERUF_OK) return status;
    if (sensor == NULL || due_us == NULL) return EERUF_ERR_NULL;
    if (FLOWS(ring)) {
        *sensor = ring->next;
        *due_us = ring->due_us;
        return ring->next == NOBODY || number > 0 ? EERUF_EMPTY : EERUF_OK;
    }
    phase = ring->phase;
    place = ring->following;
    next = ring->next;
    at_us = ring->due_us;
    goes_on = !ring->paused;
    for (;;) {
        const bool fires = next != NOBODY && !(sensor_of(ring, next)->filter.state & DISABLED);
        if (fires && number-- == 0) {
            *sensor = next;
            *due_us = at_us;
            return EERUF_OK;
        }
        if (next == NOBODY) {
            if (!goes_on) return EERUF_EMPTY;
            goes_on = false;
            phase = (uint8_t)(phase + 1u) < READ8(ring->schedule->phases) ? (uint8_t)(phase + 1u) : 0;
            place = 0;
        }
        next = firing(ring->schedule, ring->count, phase, place++, &gap_us);
        at_us += gap_us;
    }
}

/* Records evidence about the current firing. If the line was stuck, nothing more counts. */
static void show(EerufRing *ring, uint8_t x, uint8_t evidence) {
    uint8_t *flags = &sensor_of(ring, x)->filter.flags;
    if ((*flags & LISTENING) && (*flags & HELD) != STUCK) *flags = (uint8_t)((*flags & ~HELD) | evidence);
}

/* Records that the evidence is complete. */
static void answer(EerufRing *ring, uint8_t x) {
    uint8_t *flags = &sensor_of(ring, x)->filter.flags;
    const bool counts = (*flags & (HELD | LISTENING)) == HELD;
    if ((*flags & HELD) != STUCK) *flags = (uint8_t)(*flags & ~HELD);
    if (counts) count_silence(ring, x);
}

/* Records an echo, which may be off by half `width_us` and may be taken back until `settled_us`. */
static OUT_OF_LINE void hear(EerufRing *ring, uint8_t x, uint32_t at_us, uint32_t width_us, uint32_t settled_us) {
    EerufSensor *sensor = sensor_of(ring, x);
    const uint32_t off_us = width_us - width_us / 2, window_us = window_of(ring, x);
    const uint32_t t_echo_us = at_us + width_us / 2 - sensor->fired_us[0];
    const uint8_t flags = sensor->filter.flags;
    const bool inside = t_echo_us <= window_us, is_before = t_echo_us >= HALF_TURN;
    uint8_t off = WIDE;
    if (off_us > MOST_OFF_US && (int32_t)t_echo_us >= (int32_t)ring->blanking_us - (int32_t)off_us &&
        (!(flags & LISTENING) || is_before || t_echo_us <= window_us + off_us)) {
        /* Too uncertain an edge: without an earlier echo the firing has none. */
        if (!(flags & LISTENING)) return;
        if (!(flags & OUTSIDE) && !is_before && add32(sensor->echo_us, off_us) <= t_echo_us) return;
        sensor->filter.flags |= CAN_EMIT;
    } else if (is_before) {
        return; /* it fired later, or the clock has jumped */
    } else if (flags & LISTENING) {
        if (!inside) {
            if ((flags & HELD) == HELD) sensor->filter.flags = flags & (uint8_t)~HELD;
            count(ring, EERUF_READING_LATE);
            return;
        }
        if (t_echo_us < ring->blanking_us) {
            if (sensor->echo_us != EERUF_NO_ECHO) return;
            sensor->filter.flags |= OUTSIDE;
            sensor->echo_us = t_echo_us;
            return;
        }
        sensor->filter.flags = (uint8_t)((flags & ~OUTSIDE) | CAN_EMIT);
        off = (uint8_t)((off_us + 1) / 2);
    } else {
        if (inside || (flags & OUTSIDE)) return;
        sensor->filter.flags |= OUTSIDE | CAN_EMIT;
        off = 0;
    }
    if (off != WIDE && ((flags & OUTSIDE) || t_echo_us < sensor->echo_us)) sensor->echo_us = t_echo_us;
    if (sensor->filter.off[0] < off) sensor->filter.off[0] = off;
    if (flags & CAN_EMIT) return;
    if (!has_pending(ring) || !has_reached(settled_us, ring->emit_at_us)) ring->emit_at_us = settled_us;
    ring->pending++;
}

/* Takes back an echo whose reading has not been emitted yet. */
static void unhear(EerufRing *ring, uint8_t x) {
    EerufSensor *sensor = sensor_of(ring, x);
    if (!(sensor->filter.flags & CAN_EMIT)) return;
    sensor->filter.flags = (uint8_t)(sensor->filter.flags & ~(CAN_EMIT | OUTSIDE));
    sensor->echo_us = EERUF_NO_ECHO;
    sensor->filter.off[0] = 0;
    ring->pending--;
    emit_when_oldest_ends(ring);
}

EerufStatus eeruf_ring_echo_between(EerufRing *ring, uint8_t sensor, uint32_t earliest_us, uint32_t latest_us) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status != EERUF_OK) return status;
    if (!has_reached(latest_us, earliest_us)) return EERUF_ERR_BETWEEN;
    hear(ring, sensor, earliest_us, latest_us - earliest_us, latest_us);
    return EERUF_OK;
}

EerufStatus eeruf_ring_echo(EerufRing *ring, uint8_t sensor, uint32_t at_us) {
    return eeruf_ring_echo_between(ring, sensor, at_us, at_us);
}

EerufStatus eeruf_ring_fired(EerufRing *ring, uint8_t x, uint32_t at_us) {
    const EerufStatus status = has_sensor(ring, x);
    EerufSensor *sensor;
    uint32_t polled_us, later_us;
    if (status != EERUF_OK) return status;
    sensor = sensor_of(ring, x);
    polled_us = sensor->fired_us[0];
    later_us = at_us - polled_us;
    if (later_us == 0) return EERUF_OK;
    /* Ignore an instant that is not after the previous firing. */
    if (FIRINGS(FLOWS(ring)) > 1 && at_us - sensor->fired_us[1] - 1u >= HALF_TURN - 1u) return EERUF_OK;
    sensor->fired_us[0] = at_us;
    /* The reading of a firing that has ended is in the filter. */
    if (FLOWS(ring)) correct_flow(ring, x, later_us);
    else if (!(sensor->filter.flags & LISTENING) && !shift(&sensor->filter.known_us, later_us)) forget(&sensor->filter);
    /* An edge from before the firing may have kept out the echo. */
    if (!shift(&sensor->echo_us, later_us)) sensor->filter.flags |= OUTSIDE;
    if (sensor->filter.flags & LISTENING) {
        if (later_us < HALF_TURN) {
            if (!FLOWS(ring)) {
                ring->last_fired_us += later_us;
                ring->due_us += later_us;
            }
            add_late(ring, narrow(later_us));
        }
        if (ring->oldest == x || windows_differ(ring)) {
            find_oldest(ring, polled_us);
            emit_when_oldest_ends(ring);
        }
    }
    if (!FLOWS(ring)) disturb(ring);
    return EERUF_OK;
}

uint32_t eeruf_ring_fired_at(const EerufRing *ring, uint8_t sensor) {
    return has_sensor(ring, sensor) == EERUF_OK ? sensor_of(ring, sensor)->fired_us[0] : 0;
}

static EerufStatus show_if_there(EerufRing *ring, uint8_t sensor, uint8_t evidence) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) show(ring, sensor, evidence);
    return status;
}

EerufStatus eeruf_ring_stuck(EerufRing *ring, uint8_t sensor) {
    return show_if_there(ring, sensor, STUCK);
}

EerufStatus eeruf_ring_set_silence(EerufRing *ring, uint8_t silence) {
    const EerufStatus status = is_ready(ring);
    if (status != EERUF_OK) return status;
    if (silence > EERUF_SILENCE_TRUSTED) return EERUF_ERR_RANGE;
    ring->unanswered = silence == EERUF_SILENCE_TRUSTED ? 0 : UNANSWERED;
    if (silence != EERUF_SILENCE_NEEDS_ANSWER) ring->unanswered |= NO_FAULT;
    return EERUF_OK;
}

EerufStatus eeruf_ring_answered(EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) answer(ring, sensor);
    return status;
}

EerufStatus eeruf_ring_unanswered(EerufRing *ring, uint8_t sensor) {
    return show_if_there(ring, sensor, UNANSWERED);
}

EerufStatus eeruf_ring_holds(EerufRing *ring, uint8_t sensor) {
    return show_if_there(ring, sensor, HELD);
}

EerufStatus eeruf_ring_measured_between(EerufRing *ring, uint8_t sensor, uint32_t least_us, uint32_t most_us) {
    const uint32_t fired_us = eeruf_ring_fired_at(ring, sensor);
    if (least_us > most_us && has_sensor(ring, sensor) == EERUF_OK) return EERUF_ERR_BETWEEN;
    return eeruf_ring_echo_between(ring, sensor, fired_us + least_us, fired_us + most_us);
}

EerufStatus eeruf_ring_measured(EerufRing *ring, uint8_t sensor, uint32_t t_echo_us) {
    if (t_echo_us == EERUF_NO_ECHO) return eeruf_ring_answered(ring, sensor);
    return eeruf_ring_measured_between(ring, sensor, t_echo_us, t_echo_us);
}

static void forget_readings(EerufRing *ring, uint8_t sensor) {
    if (FLOWS(ring)) ring->hook(ring, sensor, FORGETS);
    else forget(&sensor_of(ring, sensor)->filter);
}

/* Forgets the last reading, which was false. */
static void begin_again(EerufRing *ring, uint8_t sensor) {
    forget_readings(ring, sensor);
    if (FLOWS(ring)) ring->hook(ring, sensor, BEGINS_AGAIN);
}

EerufStatus eeruf_ring_forget(EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) begin_again(ring, sensor);
    return status;
}

bool eeruf_ring_is_enabled(const EerufRing *ring, uint8_t sensor) {
    return has_sensor(ring, sensor) == EERUF_OK && !(sensor_of(ring, sensor)->filter.state & DISABLED);
}

static IN_LINE void enable(EerufRing *ring, uint8_t sensor, bool enabled, bool flows) {
    EerufFilter *filter = &sensor_of(ring, sensor)->filter;
    if (!enabled) {
        filter->state |= DISABLED;
    } else if (filter->state & DISABLED) {
        filter->state &= (uint8_t)~DISABLED;
        forget_readings(ring, sensor);
        if (!flows) disturb(ring);
    }
}

EerufStatus eeruf_ring_enable(EerufRing *ring, uint8_t sensor, bool enabled) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status != EERUF_OK) return status;
    if (FLOWS(ring)) return EERUF_ERR_FLOW;
    enable(ring, sensor, enabled, false);
    skip_silent(ring);
    return EERUF_OK;
}

EerufStatus eeruf_ring_pause(EerufRing *ring, bool paused) {
    const EerufStatus status = has_table(ring);
    uint8_t x;
    if (status != EERUF_OK) return status;
    ring->paused = paused;
    skip_silent(ring);
    if (paused) return EERUF_OK;
    for (x = 0; x < ring->count; x++) forget(&sensor_of(ring, x)->filter);
    disturb(ring);
    return EERUF_OK;
}

EerufStatus eeruf_ring_restart(EerufRing *ring, uint32_t now_us) {
    const EerufStatus status = has_table(ring);
    if (status == EERUF_OK) restart_by_table(ring, now_us);
    return status;
}

/* The shortest time between two firings of a sensor. */
static uint32_t least_refire(const EerufRing *ring) {
    if (FLOWS(ring)) return longer(((const EerufFlowRing *)(const void *)ring)->rest_us, ring->window_us);
    return READ32(ring->schedule->min_refire_us);
}

EerufStatus eeruf_ring_set_report_after(EerufRing *ring, uint32_t report_after_us) {
    const EerufStatus status = is_ready(ring);
    if (status != EERUF_OK) return status;
    if (report_after_us > least_refire(ring)) return EERUF_ERR_WINDOW;
    ring->report_after_us = report_after_us;
    if (windows_differ(ring)) (void)limited(ring, FIRST_TO_CLOSE, 0, 0);
    emit_when_oldest_ends(ring);
    return EERUF_OK;
}

/* ---- The state in front of each sensor ---- */

/* Bits of one byte: the state, why nothing is known, if the last reading was silence, and if it did not confirm. */
#define KNOWN 0x07u
#define WHY_AT 3u
#define SILENT 0x40u
#define DOUBTED 0x80u

const char *eeruf_state_name(uint8_t kind) {
    static const char *const NAMES[] = {"unknown", "obstacle", "clear", "too close", "unanswered"};
    return kind < sizeof NAMES / sizeof NAMES[0] ? NAMES[kind] : "?";
}

static void forget_states(EerufWatch *watch, uint32_t now_us) {
    uint8_t x;
    memset(watch->sensors, 0, watch->count * sizeof *watch->sensors);
    for (x = 0; x < watch->count; x++) watch->sensors[x].at_us = now_us;
}

EerufStatus eeruf_watch_init(EerufWatch *watch, size_t watch_size, EerufWatched *sensors, size_t sensors_size,
                             uint32_t now_us) {
    const size_t count_of_sensors = sensors_size / sizeof *sensors;
    if (watch == NULL || sensors == NULL) return EERUF_ERR_NULL;
    if (watch_size != sizeof *watch) return EERUF_ERR_MEMORY;
    if (count_of_sensors - 1u >= EERUF_MAX_SENSORS) return EERUF_ERR_SENSORS;
    watch->sensors = sensors;
    watch->count = (uint8_t)count_of_sensors;
    watch->seen_us = now_us;
    forget_states(watch, now_us);
    watch->ready = READY;
    return EERUF_OK;
}

/* The state that a reading shows, with the reason if it is unknown; NOBODY if its firing has already had a reading. */
static uint8_t state_by(const EerufReading *reading) {
    switch (reading->kind) {
    case EERUF_READING_ACCEPTED:
    case EERUF_READING_TENTATIVE: return EERUF_STATE_OBSTACLE;
    case EERUF_READING_CLEAR: return EERUF_STATE_CLEAR;
    case EERUF_READING_TOO_EARLY: return EERUF_STATE_TOO_CLOSE;
    case EERUF_READING_STUCK:
    case EERUF_READING_UNANSWERED: return EERUF_STATE_UNANSWERED;
    case EERUF_READING_LATE:
        if (reading->t_echo_us != EERUF_NO_ECHO) return NOBODY;
        return EERUF_WHY_UNSURE << WHY_AT;
    case EERUF_READING_REJECTED: return EERUF_WHY_REJECTED << WHY_AT;
    case EERUF_READING_AMBIGUOUS: return EERUF_WHY_AMBIGUOUS << WHY_AT;
    default: return EERUF_WHY_UNSURE << WHY_AT;
    }
}

static void watch_reading(EerufWatched *sensor, const EerufReading *reading, uint32_t now_us) {
    const uint8_t known = sensor->state & KNOWN;
    uint8_t state = state_by(reading);
    if (state == NOBODY) return;
    if (reading->kind == EERUF_READING_NO_ECHO)
        state = (uint8_t)((sensor->state & SILENT ? EERUF_WHY_NO_WITNESS << WHY_AT : state) | SILENT);
    if ((state & KNOWN) == EERUF_STATE_UNKNOWN && sensor->state == EERUF_STATE_OBSTACLE) {
        /* One echo may be missed, or a foreign one heard. */
        sensor->state = (uint8_t)(sensor->state | DOUBTED | (state & SILENT));
        return;
    }
    sensor->state = state;
    sensor->explained_by = reading->explained_by;
    /* The time without knowledge or answer keeps counting. */
    if ((state & KNOWN) == known && (known == EERUF_STATE_UNKNOWN || known == EERUF_STATE_UNANSWERED)) return;
    sensor->at_us = now_us;
    sensor->t_echo_us = reading->t_echo_us;
}

EerufStatus eeruf_watch_event(EerufWatch *watch, const EerufEvent *event, uint32_t now_us) {
    uint8_t x;
    if (watch == NULL || event == NULL) return EERUF_ERR_NULL;
    if (watch->ready != READY) return EERUF_ERR_NOT_READY;
    if (!has_reached(now_us + STEP_BACK, watch->seen_us)) forget_states(watch, now_us);
    watch->seen_us = now_us;
    if (event->kind == EERUF_EVENT_READING) {
        if (event->sensor >= watch->count) return EERUF_ERR_SENSOR;
        watch_reading(&watch->sensors[event->sensor], &event->u.reading, now_us);
    } else if (event->kind == EERUF_EVENT_PERIOD) {
        for (x = 0; x < watch->count; x++)
            if (now_us - watch->sensors[x].at_us > HALF_TURN) watch->sensors[x].at_us = now_us - HALF_TURN;
    }
    return EERUF_OK;
}

EerufStatus eeruf_watch_state(const EerufWatch *watch, uint8_t sensor, uint32_t now_us, EerufState *state) {
    const EerufWatched *watched;
    if (watch == NULL || state == NULL) return EERUF_ERR_NULL;
    if (watch->ready != READY) return EERUF_ERR_NOT_READY;
    if (sensor >= watch->count) return EERUF_ERR_SENSOR;
    watched = &watch->sensors[sensor];
    state->kind = watched->state & KNOWN;
    state->why = (uint8_t)((watched->state & ~(DOUBTED | SILENT)) >> WHY_AT);
    state->explained_by = state->why == EERUF_WHY_AMBIGUOUS ? watched->explained_by : EERUF_BY_NOTHING;
    state->age_us = shorter(now_us - watched->at_us, HALF_TURN);
    state->t_echo_us = state->kind == EERUF_STATE_OBSTACLE ? watched->t_echo_us : EERUF_NO_ECHO;
    return EERUF_OK;
}

/* ---- Distances ---- */

/* (a b + add) / d, rounded down, where add < d; stops at UINT32_MAX. In 32 bits, since 64-bit division costs a small
   target more flash than all the rest here. */
static uint32_t multiply_divide(uint32_t a, uint32_t b, uint32_t add, uint32_t d) {
    const uint32_t whole = b / d, part = b % d;
    uint32_t quotient = 0, rest = 0;
    uint8_t bit;
    for (bit = 0; bit < 32; bit++, a <<= 1) {
        if (quotient > UINT32_MAX / 2) return UINT32_MAX;
        quotient += quotient;
        if (rest >= d - rest) {
            rest -= d - rest;
            quotient++;
        } else {
            rest += rest;
        }
        if (a < HALF_TURN) continue;
        if (quotient > UINT32_MAX - whole) return UINT32_MAX;
        quotient += whole;
        if (part >= d - rest) {
            rest -= d - part;
            quotient = add32(quotient, 1);
        } else {
            rest += part;
        }
    }
    return add >= d - rest ? add32(quotient, 1) : quotient;
}

uint32_t eeruf_sound_mm_s(int16_t celsius_tenths) {
    /* 343.2 sqrt(T / 293.15 K) m/s: the largest whole number whose square is no more. */
    const int32_t kelvin_hundredths = 27315 + 10 * (int32_t)celsius_tenths;
    const uint64_t squared = (uint64_t)343200u * 343200u * (uint64_t)(kelvin_hundredths < 0 ? 0 : kelvin_hundredths);
    uint32_t speed = 0, step;
    for (step = (uint32_t)1 << 20; step > 0; step >>= 1)
        if ((uint64_t)(speed + step) * (speed + step) * 29315u <= squared) speed += step;
    return speed;
}

uint32_t eeruf_distance_mm(uint32_t t_echo_us, uint32_t c_mm_s) {
    return multiply_divide(t_echo_us, c_mm_s, 1000000u, 2000000u);
}

/* ---- Edges ---- */

#if defined(__GNUC__)
#define FENCE() __atomic_thread_fence(__ATOMIC_SEQ_CST) /* on one core merely a barrier for the compiler */
#else
#define FENCE() ((void)0)
#endif

/* A width in units of 8 us, rounded up; 255 for anything longer, too wide for every edge. */
static uint8_t in_8us(uint32_t width_us) {
    return (uint8_t)shorter(narrow(width_us + 7) >> 3, UINT8_MAX);
}

/* Converts an uncertainty to a byte and back: units of 8 us up to 127, then of 256 us; 255 stands for any time. */
#define FINE 127u
#define ANY_TIME ((uint32_t)1 << 20)

static uint8_t EERUF_IN_RAM coarse(uint32_t width_us) {
    const uint32_t units = (shorter(width_us, ANY_TIME) + 7u) >> 3;
    return (uint8_t)(units <= FINE ? units : shorter(FINE + (units - FINE + 31u) / 32u, UINT8_MAX));
}

static uint32_t uncoarse(uint8_t early) {
    if (early == UINT8_MAX) return ANY_TIME;
    return 8u * (early <= FINE ? early : FINE + 32u * (early - FINE));
}

EerufStatus eeruf_edges_init(EerufEdges *edges, size_t edges_size, EerufEdge *places, size_t places_size) {
    const size_t length = places_size / sizeof *places;
    if (edges == NULL || places == NULL) return EERUF_ERR_NULL;
    if (edges_size != sizeof *edges || length < 2) return EERUF_ERR_MEMORY;
    if (length > 128 || (length & (length - 1)) != 0) return EERUF_ERR_RANGE;
    memset(edges, 0, sizeof *edges);
    edges->places = places;
    edges->mask = (uint8_t)(length - 1);
    FENCE();
    edges->ready = READY;
    return EERUF_OK;
}

OUT_OF_LINE EerufStatus EERUF_IN_RAM eeruf_edges_push_between(EerufEdges *edges, uint8_t sensor, bool high,
                                                              uint32_t earliest_us, uint32_t latest_us) {
    uint8_t pushed;
    EerufEdge *place;
    if (edges == NULL) return EERUF_ERR_NULL;
    if (edges->ready != READY) return EERUF_ERR_NOT_READY;
    if (sensor > 127) return EERUF_ERR_SENSOR;
    if (!has_reached(latest_us, earliest_us)) return EERUF_ERR_BETWEEN;
    pushed = edges->pushed;
    if ((uint8_t)(pushed - edges->popped) > edges->mask) {
        edges->lost = (uint8_t)(edges->lost + 1u);
        return EERUF_ERR_MEMORY;
    }
    place = &edges->places[pushed & edges->mask];
    place->at_us = latest_us;
    place->sensor = sensor;
    place->high = high;
    place->early = coarse(latest_us - earliest_us);
    FENCE();
    edges->pushed = (uint8_t)(pushed + 1u);
    return EERUF_OK;
}

EerufStatus EERUF_IN_RAM eeruf_edges_push(EerufEdges *edges, uint8_t sensor, bool high, uint32_t at_us) {
    return eeruf_edges_push_between(edges, sensor, high, at_us, at_us);
}

EerufStatus eeruf_edges_pop(EerufEdges *edges, EerufEdge *edge) {
    uint8_t popped;
    if (edges == NULL || edge == NULL) return EERUF_ERR_NULL;
    if (edges->ready != READY) return EERUF_ERR_NOT_READY;
    popped = edges->popped;
    if (popped == edges->pushed) return EERUF_EMPTY;
    FENCE();
    *edge = edges->places[popped & edges->mask];
    FENCE();
    edges->popped = (uint8_t)(popped + 1u);
    return EERUF_OK;
}

/* ---- HC-SR04 ---- */

#define ENDED UINT16_MAX /* the width of a pulse that cannot go on after a gap */
/* The state of a line, in one byte: the stage of its pulse, the flaw of this firing, and the module's health. */
#define PULSE 0x03u
#define IDLE 0x00u /* nothing is expected */
#define AWAITED 0x01u
#define ROSE 0x02u
#define OVER 0x03u
#define FLAW 0x0cu
#define CHATTERED 0x04u
#define LOST_EDGE 0x08u
#define HEALTH_AT 4u
#define HEALTH 0x70u
#define SEEN_HIGH 0x80u /* when it was to be triggered again; so it was not */

static void set_bits(EerufLine *line, uint8_t mask, uint8_t bits) {
    line->state = (uint8_t)((line->state & ~mask) | bits);
}

static void set_health(EerufLine *line, uint8_t health) {
    set_bits(line, HEALTH, (uint8_t)(health << HEALTH_AT));
}

static OUT_OF_LINE EerufStatus has_line(const EerufHcSr04 *modules, uint8_t sensor) {
    if (modules == NULL) return EERUF_ERR_NULL;
    if (modules->ready != READY) return EERUF_ERR_NOT_READY;
    return sensor < modules->ring->count ? (EerufStatus)EERUF_OK : (EerufStatus)EERUF_ERR_SENSOR;
}

static EerufStatus allows_retrigger(const EerufHcSr04Settings *settings, uint32_t min_refire_us) {
    return min_refire_us < settings->min_retrigger_us ? EERUF_ERR_RETRIGGER : EERUF_OK;
}

EerufStatus eeruf_hc_sr04_init(EerufHcSr04 *modules, size_t modules_size, EerufLine *lines, size_t lines_size,
                               EerufRing *ring, const EerufHcSr04Settings *settings) {
    EerufStatus status = is_ready(ring);
    if (status != EERUF_OK) return status;
    if (modules == NULL || lines == NULL || settings == NULL) return EERUF_ERR_NULL;
    if (settings->version != EERUF_VERSION) return EERUF_ERR_VERSION;
    if (modules_size != sizeof *modules || lines_size < ring->count * sizeof *lines) return EERUF_ERR_MEMORY;
    status = allows_retrigger(settings, least_refire(ring));
    if (status != EERUF_OK) return status;
    memset(lines, 0, ring->count * sizeof *lines);
    modules->ring = ring;
    modules->lines = lines;
    modules->settings = settings;
    modules->ready = READY;
    /* A line that does not rise is not free space. */
    return eeruf_ring_set_silence(ring, EERUF_SILENCE_NEEDS_ANSWER);
}

static uint8_t health_of(const EerufLine *line) {
    return (uint8_t)((line->state & HEALTH) >> HEALTH_AT);
}

/* The health after the last firing, before the next trigger. */
static uint8_t end_firing(EerufLine *line, uint8_t missing_after) {
    const uint8_t pulse = line->state & PULSE, flaw = line->state & FLAW;
    if (pulse == AWAITED && flaw == 0) {
        if (line->silent < UINT8_MAX) line->silent++;
        if (line->silent >= missing_after) return EERUF_HEALTH_MISSING;
    } else if (pulse != IDLE) {
        if (pulse != AWAITED) line->silent = 0; /* no longer how much sooner the line may have risen */
        if (pulse == ROSE) return EERUF_HEALTH_LOSES_EDGES; /* if it is still high, the next trigger finds it stuck */
        /* A pulse may follow the apparent end of a pulse that began within the deaf time. */
        if (flaw == 0 || (pulse == OVER && flaw == LOST_EDGE)) return EERUF_HEALTH_WELL;
        return flaw == CHATTERED ? EERUF_HEALTH_CHATTERS : EERUF_HEALTH_LOSES_EDGES;
    }
    return health_of(line);
}

/* Begins a firing. With EERUF_HEALTH_WELL the line has been seen low, unless hardware has triggered it. */
static EerufStatus begin_firing(EerufHcSr04 *modules, uint8_t sensor, uint8_t health, bool by_hardware) {
    const EerufStatus status = has_line(modules, sensor);
    EerufLine *line;
    uint8_t ended;
    if (status != EERUF_OK) return status;
    line = &modules->lines[sensor];
    if ((line->state & PULSE) == ROSE) {
        if ((health == EERUF_HEALTH_STUCK_HIGH || by_hardware) &&
            sensor_of(modules->ring, sensor)->fired_us[0] - line->rose_us <= modules->settings->longest_hold_us) {
            /* The module still listens after an earlier trigger. */
            if (by_hardware) return EERUF_OK;
            set_bits(line, SEEN_HIGH, SEEN_HIGH);
            show(modules->ring, sensor, HELD);
            return EERUF_DO_NOT_TRIGGER;
        }
        /* A pulse began and never ended: an edge was lost, and the apparent silence may have been an echo. */
        if (health == EERUF_HEALTH_WELL) begin_again(modules->ring, sensor);
    }
    ended = end_firing(line, modules->settings->missing_after);
    if (health == EERUF_HEALTH_WELL) {
        line->state = (uint8_t)((uint8_t)(ended << HEALTH_AT) | AWAITED);
        line->rose_us = sensor_of(modules->ring, sensor)->fired_us[0];
        return EERUF_OK;
    }
    line->state = (uint8_t)((uint8_t)(health << HEALTH_AT) | IDLE);
    show(modules->ring, sensor, STUCK);
    return EERUF_DO_NOT_TRIGGER;
}

EerufStatus eeruf_hc_sr04_fire(EerufHcSr04 *modules, uint8_t sensor, bool line_is_high) {
    return begin_firing(modules, sensor, line_is_high ? EERUF_HEALTH_STUCK_HIGH : EERUF_HEALTH_WELL, false);
}

bool eeruf_hc_sr04_is_stuck(const EerufHcSr04 *modules, uint8_t sensor) {
    const EerufLine *line;
    if (has_line(modules, sensor) != EERUF_OK) return false;
    line = &modules->lines[sensor];
    return (line->state & PULSE) == IDLE && health_of(line) == EERUF_HEALTH_STUCK_HIGH;
}

EerufStatus eeruf_hc_sr04_triggered(EerufHcSr04 *modules, uint8_t sensor) {
    return begin_firing(modules, sensor, EERUF_HEALTH_WELL, true);
}

EerufStatus eeruf_hc_sr04_cannot_read(EerufHcSr04 *modules, uint8_t sensor) {
    return begin_firing(modules, sensor, EERUF_HEALTH_PIN_ERROR, false);
}

EerufStatus eeruf_hc_sr04_cannot_write(EerufHcSr04 *modules, uint8_t sensor) {
    const EerufStatus status = has_line(modules, sensor);
    if (status == EERUF_OK) set_health(&modules->lines[sensor], EERUF_HEALTH_PIN_ERROR);
    return status;
}

/* Records that a sensor's line rose at `at_us`, or up to `early_us` before: the sensor listens. */
static void rise(EerufHcSr04 *modules, uint8_t sensor, uint32_t at_us, uint32_t early_us) {
    EerufLine *line = &modules->lines[sensor];
    set_bits(line, PULSE, ROSE);
    line->rose_us = at_us;
    line->width_us = 0;
    line->silent = in_8us(early_us);
    show(modules->ring, sensor, HELD);
}

OUT_OF_LINE EerufStatus eeruf_hc_sr04_edge_between(EerufHcSr04 *modules, uint8_t sensor, bool high,
                                                   uint32_t earliest_us, uint32_t latest_us) {
    const EerufStatus status = has_line(modules, sensor);
    const EerufHcSr04Settings *settings;
    EerufLine *line;
    uint32_t fired_us, since_us, early_us;
    uint8_t pulse;
    if (status != EERUF_OK) return status;
    if (!has_reached(latest_us, earliest_us)) return EERUF_ERR_BETWEEN;
    settings = modules->settings;
    line = &modules->lines[sensor];
    fired_us = sensor_of(modules->ring, sensor)->fired_us[0];
    since_us = latest_us - fired_us;
    early_us = latest_us - earliest_us;
    /* Without a trigger there is no crosstalk in the cable. */
    if (since_us >= HALF_TURN || (since_us < settings->deaf_us && !(line->state & SEEN_HIGH))) return EERUF_OK;
    pulse = line->state & PULSE;
    if (pulse == AWAITED) {
        line->silent = 0;
        if (high && since_us > add32(settings->latest_rise_us, early_us)) {
            set_bits(line, FLAW, CHATTERED);
        } else if (high) {
            rise(modules, sensor, latest_us, shorter(early_us, since_us));
        } else if ((line->state & FLAW) == 0) {
            set_bits(line, FLAW, LOST_EDGE);
        }
    } else if (pulse == ROSE && high && !has_reached(line->rose_us, fired_us)) {
        /* The end of a pulse from before this firing was lost: the apparent silence may have been an echo. */
        set_health(line, EERUF_HEALTH_LOSES_EDGES);
        begin_again(modules->ring, sensor);
        rise(modules, sensor, latest_us, shorter(early_us, since_us));
    } else if (pulse == ROSE && !high) {
        const uint32_t width_us = latest_us - line->rose_us, least_us = width_us - shorter(early_us, width_us);
        /* At least from the latest rise to the earliest fall; at most from the earliest rise to the latest fall. */
        const uint32_t rose_early_us = line->silent == UINT8_MAX ? line->rose_us - fired_us : 8u * line->silent;
        if (width_us < settings->shortest_us && width_us + rose_early_us < settings->shortest_us) {
            line->state = (uint8_t)((line->state & ~(PULSE | FLAW)) | AWAITED | CHATTERED);
            line->rose_us = latest_us;
            line->silent = 0;
            show(modules->ring, sensor, UNANSWERED);
            return EERUF_OK;
        }
        set_bits(line, PULSE, OVER);
        /* The module's own time-out only if it is certainly as long. */
        line->width_us = least_us < settings->longest_us ? narrow(width_us) : ENDED;
        /* A fall and a rise may have been lost since the previous trigger, unless the line was seen high. */
        if (least_us < settings->longest_us)
            hear(modules->ring, sensor, fired_us + least_us, width_us + rose_early_us - least_us,
                 latest_us + settings->shortest_us);
        else if ((line->state & SEEN_HIGH) || has_reached(line->rose_us, fired_us))
            answer(modules->ring, sensor);
    } else if (pulse == OVER && high) {
        set_bits(line, FLAW, CHATTERED);
        if (line->width_us == ENDED || latest_us - line->rose_us - line->width_us >= settings->shortest_us)
            return EERUF_OK;
        /* So short a gap is noise: the pulse goes on. But a silence counts once. */
        set_bits(line, PULSE, ROSE);
        unhear(modules->ring, sensor);
        show(modules->ring, sensor, HELD);
    }
    return EERUF_OK;
}

EerufStatus eeruf_hc_sr04_edge(EerufHcSr04 *modules, uint8_t sensor, bool high, uint32_t at_us) {
    return eeruf_hc_sr04_edge_between(modules, sensor, high, at_us, at_us);
}

EerufStatus eeruf_hc_sr04_look(EerufHcSr04 *modules, uint8_t sensor, bool high, uint32_t before_us, uint32_t after_us) {
    EerufLine *line;
    bool was_high;
    if (!eeruf_hc_sr04_awaits(modules, sensor, &was_high)) return has_line(modules, sensor);
    line = &modules->lines[sensor];
    if (high != was_high)
        return eeruf_hc_sr04_edge_between(modules, sensor, high, line->rose_us + (was_high ? line->width_us : 0), after_us);
    if (!was_high) line->rose_us = before_us;
    else if (has_reached(before_us, line->rose_us)) line->width_us = narrow(before_us - line->rose_us);
    return EERUF_OK;
}

/* Processes the edges in a queue, of lines that the ring has: all, or those up to an instant. */
static EerufStatus drain(EerufHcSr04 *modules, EerufEdges *edges, const uint32_t *until_us) {
    EerufEdge edge;
    EerufStatus status = has_line(modules, 0);
    while (status == EERUF_OK) {
        const bool waits = edges != NULL && edges->ready == READY && edges->popped != edges->pushed;
        FENCE();
        if (waits && until_us != NULL && !has_reached(*until_us, edges->places[edges->popped & edges->mask].at_us)) break;
        status = eeruf_edges_pop(edges, &edge);
        if (status == EERUF_OK)
            (void)eeruf_hc_sr04_edge_between(modules, edge.sensor, edge.high, edge.at_us - uncoarse(edge.early),
                                             edge.at_us);
    }
    return status == EERUF_EMPTY ? (EerufStatus)EERUF_OK : status;
}

EerufStatus eeruf_hc_sr04_edges_until(EerufHcSr04 *modules, EerufEdges *edges, uint32_t until_us) {
    return drain(modules, edges, &until_us);
}

EerufStatus eeruf_hc_sr04_edges(EerufHcSr04 *modules, EerufEdges *edges) {
    return drain(modules, edges, NULL);
}

EerufStatus eeruf_hc_sr04_pulse(EerufHcSr04 *modules, uint8_t sensor, uint32_t width_us) {
    const EerufStatus status = has_line(modules, sensor);
    EerufLine *line;
    if (status != EERUF_OK) return status;
    line = &modules->lines[sensor];
    if ((line->state & PULSE) == IDLE) return EERUF_OK;
    line->silent = 0;
    if (width_us < modules->settings->shortest_us || (line->state & PULSE) == OVER) {
        set_bits(line, FLAW, CHATTERED);
        return EERUF_OK;
    }
    set_bits(line, PULSE | FLAW, OVER);
    line->width_us = ENDED;
    return eeruf_ring_measured(modules->ring, sensor,
                               width_us < modules->settings->longest_us ? width_us : EERUF_NO_ECHO);
}

bool eeruf_hc_sr04_awaits(const EerufHcSr04 *modules, uint8_t sensor, bool *was_high) {
    uint8_t pulse;
    if (has_line(modules, sensor) != EERUF_OK) return false;
    pulse = modules->lines[sensor].state & PULSE;
    if (was_high != NULL) *was_high = pulse == ROSE;
    return pulse == AWAITED || pulse == ROSE;
}

EerufStatus eeruf_hc_sr04_fired(EerufHcSr04 *modules, uint8_t sensor, uint32_t at_us) {
    const EerufStatus status = has_line(modules, sensor);
    return status == EERUF_OK ? eeruf_ring_fired(modules->ring, sensor, at_us) : status;
}

uint8_t eeruf_hc_sr04_health(const EerufHcSr04 *modules, uint8_t sensor) {
    if (has_line(modules, sensor) != EERUF_OK) return EERUF_HEALTH_MISSING;
    return health_of(&modules->lines[sensor]);
}

void eeruf_pace_event(EerufPace *pace, const EerufEvent *event) {
    const uint32_t bit = (uint32_t)1 << (event->sensor & 31);
    /* A late reading without an echo time leaves the next one nothing to compare with. */
    const EerufReading *reading = &event->u.reading;
    if (event->kind != EERUF_EVENT_READING) return;
    if (reading->kind == EERUF_READING_LATE && reading->t_echo_us == EERUF_NO_ECHO) {
        pace->heard &= ~bit;
        return;
    }
    pace->twice |= pace->heard & bit;
    pace->heard |= bit;
}

bool eeruf_pace_too_slow(EerufPace *pace, const EerufRing *ring, uint32_t now_us) {
    uint8_t x;
    bool slow = pace->late |= !FLOWS(ring) && ring->latest_us > 1000;
    /* Twice in two seconds, whatever the loop does in between; one by one two rounds of many sensors take longer. */
    if (now_us - pace->since_us < (ring->count > 9 ? 100000u * ring->count : 950000u)) return false;
    for (x = 0; x < ring->count; x++) slow |= eeruf_ring_is_enabled(ring, x) && !(pace->twice >> (x & 31) & 1);
    pace->since_us = now_us;
    pace->heard = pace->twice = 0;
    pace->late = false;
    return slow && !ring->paused;
}

/* ---- Flow: the rules are in docs/explanation/flow.md ---- */

#define QUIET_US 4u /* the unit of quiet */
#define OLD ((uint32_t)1 << 29) /* age at which firings no longer matter to rest, long before instants wrap */

/* The state of a flow ring's sensor, in addition to DISABLED. */
#define HAS_FIRED 0x01u
#define AHEAD 0x02u    /* it has fired in this round before its turn */
#define FOLLOWS 0x04u  /* it fires with one that has a turn */
#define PENDING 0x08u  /* that sensor has fired, but this one not yet */
/* The flags of a flow ring. */
#define MOVES 0x01u     /* at the last reading or report of speed: random times are doubled */
#define TOLD 0x02u      /* the speed was reported not long ago */
#define ONE_AHEAD 0x04u /* a sensor is AHEAD */
#define EVERY_ECHO_STANDING 0x10u /* every echo is reported as accepted */
#define EVERY_ECHO_MOVING 0x20u

static EerufFlowRing *flow_of(EerufRing *ring) {
    return (EerufFlowRing *)(void *)ring;
}

static OUT_OF_LINE EerufFlowSensor *flow_sensor(const EerufRing *ring, uint8_t x) {
    return (EerufFlowSensor *)(void *)ring->sensors + x;
}

static EerufStatus has_flow(const EerufFlowRing *flow, uint8_t sensor) {
    const EerufStatus status = flow == NULL ? (EerufStatus)EERUF_ERR_NULL : has_sensor(&flow->ring, sensor);
    return status == EERUF_OK && !FLOWS(&flow->ring) ? (EerufStatus)EERUF_ERR_NOT_READY : status;
}

/* -- The plan -- */

/* Draws the random time of the next gap. */
static void throw_dice(EerufFlowRing *flow) {
    uint32_t most = (flow->dice_us << (flow->flags & MOVES)) + 1, r = flow->random, high = 0;
    uint8_t bit;
    /* Xorshift by 13, 17 and 5 (Marsaglia, 2003). */
    r ^= r << 13;
    r ^= r >> 17;
    r ^= r << 5;
    flow->random = r;
    /* The high word of r * most, without 64-bit arithmetic. */
    for (bit = 0; bit < 32; bit++, most >>= 1) {
        const uint32_t sum = most & 1u ? high + r : high;
        high = sum >> 1 | (sum < high ? HALF_TURN : 0);
    }
    flow->thrown_us = high;
}

/* The time from the last firing of any sensor until `after_us` past `fired_us`; 0 if that is over. */
static OUT_OF_LINE uint32_t since_last(const EerufRing *ring, uint32_t fired_us, uint32_t after_us) {
    const uint32_t until_us = fired_us + after_us;
    return has_reached(ring->last_fired_us, until_us) ? 0 : until_us - ring->last_fired_us;
}

static bool reports_every_echo(const EerufFlowRing *flow) {
    return (flow->flags & (flow->flags & MOVES ? EVERY_ECHO_MOVING : EVERY_ECHO_STANDING)) != 0;
}

/* The least quiet, doubled while every echo is reported. */
static uint32_t least_quiet(const EerufFlowRing *flow) {
    return shorter(reports_every_echo(flow) ? 2 * flow->least_us : flow->least_us, flow->ring.audible_us);
}

/* The quiet that a sensor needs before and after its firing. */
static uint32_t quiet_of(const EerufFlowRing *flow, const EerufFlowSensor *sensor) {
    return longer(sensor->doubt * QUIET_US, least_quiet(flow));
}

static OUT_OF_LINE uint8_t line_of(const EerufFlowRing *flow, uint8_t x) {
    return flow->lines == NULL ? 0 : READ8(flow->lines[x]);
}

/* The times from the last firing until there is quiet, and until a sensor has rested and its line is free; without the
   random time. */
typedef struct Waits {
    uint32_t quiet_us, rested_us;
} Waits;

/* True if `other` is this sensor, or an enabled one that fires together with it. */
static bool fires_with(const EerufRing *ring, uint8_t x, uint8_t other) {
    return x == other || (is_deaf_to(ring, x, other) && !(flow_sensor(ring, other)->filter.state & DISABLED));
}

/* True if a sensor shares its echo line with another one, which is `x` or fires with it. */
static bool shares_line(const EerufRing *ring, uint8_t sensor, uint8_t x) {
    const EerufFlowRing *flow = (const EerufFlowRing *)(const void *)ring;
    const uint8_t line = line_of(flow, sensor);
    uint8_t other;
    for (other = 0; line > 0 && other < ring->count; other++)
        if (other != sensor && line_of(flow, other) == line && fires_with(ring, x, other)) return true;
    return false;
}

/* The waits of a sensor and of the sensors that fire with it. */
static OUT_OF_LINE Waits waits_of(const EerufRing *ring, uint8_t x) {
    const EerufFlowRing *flow = (const EerufFlowRing *)(const void *)ring;
    Waits waits = {0, 0};
    uint32_t own_us = 0; /* the quiet that `x` still needs for its last firing: only others of its group heed it */
    bool has_others = false;
    uint8_t other;
    for (other = 0; other < ring->count; other++) {
        const EerufFlowSensor *sensor = flow_sensor(ring, other);
        const bool is_with = fires_with(ring, x, other), shares = shares_line(ring, other, x);
        const uint8_t listens = sensor->filter.flags & LISTENING;
        uint32_t window_us, *quiet_us = other == x ? &own_us : &waits.quiet_us;
        if (is_with) waits.quiet_us = longer(waits.quiet_us, quiet_of(flow, sensor));
        has_others |= is_with && other != x;
        if (!(sensor->filter.state & HAS_FIRED)) continue;
        if (is_with) waits.rested_us = longer(waits.rested_us, since_last(ring, sensor->turn_us, flow->rest_us));
        if (!listens && !shares) continue;
        window_us = window_of(ring, other);
        if (is_with || shares) waits.rested_us = longer(waits.rested_us, since_last(ring, sensor->turn_us, window_us));
        /* Sound after the window does not matter, however late it is reported. */
        window_us = shorter(quiet_of(flow, sensor), window_us);
        if (listens) *quiet_us = longer(*quiet_us, since_last(ring, sensor->turn_us, window_us));
    }
    if (has_others) waits.quiet_us = longer(waits.quiet_us, own_us);
    return waits;
}

/* Gives the turn of a group that fires together to its first sensor. */
static void group(EerufRing *ring) {
    uint8_t x, other;
    for (x = 0; x < ring->count; x++) {
        uint8_t *state = &flow_sensor(ring, x)->filter.state;
        *state &= (uint8_t)~(FOLLOWS | PENDING);
        for (other = 0; other < x; other++)
            if (fires_with(ring, x, other)) *state |= FOLLOWS;
    }
}

static bool is_coprime(uint8_t a, uint8_t b) {
    while (a != b)
        if (a > b) a = (uint8_t)(a - b);
        else b = (uint8_t)(b - a);
    return a == 1;
}

/* The sensor at a place of the order, given the sensor before it. Distant sensors alternate, so that neighbours never
   follow each other if the number of sensors allows it. */
static uint8_t in_order(const EerufRing *ring, uint8_t place, uint8_t before) {
    const uint8_t next = (uint8_t)(before + ((const EerufFlowRing *)(const void *)ring)->stride);
    if (ring->count == 6) return (uint8_t)(0x351420ul >> 4 * place) & 0x0fu;
    return next >= ring->count ? (uint8_t)(next - ring->count) : next;
}

/* The first place, from `place` on, whose sensor has a turn and has not fired ahead of it. */
static uint8_t first_from(const EerufRing *ring, uint8_t place, uint8_t *sensor) {
    while (place < ring->count && (flow_sensor(ring, *sensor)->filter.state & (DISABLED | AHEAD | FOLLOWS)) != 0)
        *sensor = in_order(ring, ++place, *sensor);
    return place;
}

/* Decides which sensor fires next, and when. */
static OUT_OF_LINE void decide(EerufRing *ring) {
    const EerufFlowRing *flow = flow_of(ring);
    Waits waits;
    uint8_t sensor = flow->turn, place = ring->count, x = 0;
    ring->due_us = ring->last_fired_us;
    while (x < ring->count && !(flow_sensor(ring, x)->filter.state & PENDING)) x++;
    ring->next = x;
    if (x < ring->count) return;
    ring->next = NOBODY;
    if (!ring->paused) place = first_from(ring, ring->following, &sensor);
    if (place == ring->count) {
        /* The round ends at once or, if no sensor can fire, after the rest time. */
        for (x = 0; x < ring->count && (flow_sensor(ring, x)->filter.state & DISABLED);) x++;
        if (ring->paused || x == ring->count) ring->due_us += flow->rest_us;
        return;
    }
    waits = waits_of(ring, sensor);
    ring->next = sensor;
    ring->due_us += longer(waits.quiet_us, waits.rested_us) + flow->thrown_us;
    /* No sensor is passed over twice: only one may fire ahead in a round. */
    while (waits.rested_us > waits.quiet_us && !(flow->flags & ONE_AHEAD)) {
        sensor = in_order(ring, ++place, sensor);
        place = first_from(ring, place, &sensor);
        if (place == ring->count) return;
        waits = waits_of(ring, sensor);
        if (waits.rested_us > waits.quiet_us) continue;
        ring->next = sensor;
        ring->due_us = ring->last_fired_us + waits.quiet_us + flow->thrown_us;
    }
}

/* Decides on news that came only now: nothing becomes due before `now_us`, unless it was already. */
static OUT_OF_LINE void decide_from(EerufRing *ring, uint32_t now_us) {
    uint32_t due_us = ring->due_us;
    decide(ring);
    if (!has_reached(now_us, due_us)) due_us = now_us;
    if (has_reached(due_us, ring->due_us)) ring->due_us = due_us;
}

/* Decides after a call without a time: nothing becomes due sooner, since that instant might be long past. */
static void decide_no_sooner(EerufRing *ring) {
    decide_from(ring, ring->due_us);
}

static void fire_flow(EerufRing *ring, uint8_t x, uint32_t now_us) {
    EerufFlowRing *flow = flow_of(ring);
    EerufFlowSensor *sensor = flow_sensor(ring, x);
    const bool had_turn = !(sensor->filter.state & PENDING);
    uint8_t turn = flow->turn, other;
    sensor->filter.state = (uint8_t)((sensor->filter.state & ~PENDING) | HAS_FIRED);
    sensor->turn_us = now_us;
    ring->last_fired_us = now_us;
    if (had_turn) {
        const uint8_t place = first_from(ring, ring->following, &turn);
        if (turn == x) {
            ring->following = (uint8_t)(place + 1u);
            flow->turn = in_order(ring, ring->following, x);
        } else {
            sensor->filter.state |= AHEAD;
            flow->flags |= ONE_AHEAD;
        }
        for (other = 0; other < ring->count && limited != NULL; other++)
            if (other != x && fires_with(ring, x, other)) flow_sensor(ring, other)->filter.state |= PENDING;
        throw_dice(flow);
    }
    /* The trigger comes first: the decision may take a millisecond, and lines that rise late are not believed. */
    ring->next = UNDECIDED;
}

/* Sensors that fired ahead have had their turn. */
static OUT_OF_LINE void begin_round(EerufRing *ring) {
    uint8_t x;
    for (x = 0; x < ring->count; x++) flow_sensor(ring, x)->filter.state &= (uint8_t)~AHEAD;
    flow_of(ring)->flags &= (uint8_t)~ONE_AHEAD;
    flow_of(ring)->turn = ring->following = 0;
}

static void end_round(EerufRing *ring, uint32_t now_us) {
    uint8_t x;
    begin_round(ring);
    for (x = 0; x < ring->count; x++) {
        EerufFlowSensor *sensor = flow_sensor(ring, x);
        if (now_us - sensor->turn_us > OLD) sensor->filter.state &= (uint8_t)~HAS_FIRED;
    }
    /* No sensor fires, but rounds go on. */
    if (now_us - ring->last_fired_us >= flow_of(ring)->rest_us) ring->last_fired_us = now_us;
    decide_no_sooner(ring);
}

static void restart_flow(EerufRing *ring, uint32_t now_us) {
    const EerufFlowRing *flow = flow_of(ring);
    uint8_t x;
    begin_round(ring);
    for (x = 0; x < ring->count; x++) {
        EerufFlowSensor *sensor = flow_sensor(ring, x);
        /* After a jump of the clock, it is unknown when they fired. */
        if (now_us - sensor->turn_us > flow->rest_us) sensor->filter.state &= (uint8_t)~HAS_FIRED;
        sensor->filter.state &= (uint8_t)~PENDING;
        sensor->doubt = flow->first;
    }
    /* Earlier sound dies away first. */
    ring->last_fired_us = now_us + ring->audible_us;
    decide(ring);
}

/* A round of the longest gaps, in which each has its turn: at most 64 times 750 ms, and the rest. */
static uint32_t horizon_of_flow(const EerufRing *ring) {
    const EerufFlowRing *flow = (const EerufFlowRing *)(const void *)ring;
    return (ring->count + 1u) * (ring->audible_us + 2 * flow->dice_us) + longer(flow->rest_us, ring->window_us);
}

/* -- Motion -- */

#define TOLD_FOR 500000u /* time after a report of speed until the top speed is assumed */
#define SENT_BEFORE_US 250000u /* greatest age of audible sound */
#define LONGEST_US (((uint32_t)1 << 20) - 1) /* older beliefs are dropped */

/* Greatest change of a good reading, in 1/16 us per 1,024 us, rounded up: 2 v / c at 331 m/s, the slowest sound that a
   robot meets, plus 6 %, since at 3.6 m/s intervals between sendings exceed those between hearings by that. */
static uint16_t rate_of(uint32_t speed_mm_s) {
    return (uint16_t)((shorter(speed_mm_s, 39000) * 6881 + 65535) >> 16);
}

/* The rate at an instant not long before the last report of speed. */
static OUT_OF_LINE uint16_t rate_at(EerufFlowRing *flow, uint32_t now_us) {
    const uint32_t silent_us = now_us - flow->told_us;
    if ((flow->flags & TOLD) && silent_us > TOLD_FOR && silent_us < HALF_TURN) {
        flow->flags &= (uint8_t)~TOLD;
        flow->rate = flow->top_rate;
    }
    return flow->rate;
}

static OUT_OF_LINE uint16_t larger16(uint16_t one, uint16_t other) {
    return one > other ? one : other;
}

/* The greatest rate while sound heard at `now_us` could have been sent, not long before the last report. It covers two
   spans, neither much shorter than sound is audible. */
static uint16_t recent_rate(EerufFlowRing *flow, uint32_t now_us) {
    const uint16_t rate = rate_at(flow, now_us);
    const uint32_t span_us = now_us - flow->since_us;
    if (span_us > SENT_BEFORE_US && span_us < HALF_TURN) {
        flow->since_us = now_us;
        flow->greatest[0] = flow->greatest[1];
        flow->greatest[1] = rate;
    }
    flow->greatest[1] = larger16(flow->greatest[1], rate);
    return larger16(flow->greatest[0], flow->greatest[1]);
}

/* The change within a time: twelve bits times twenty. */
static uint32_t grow(uint16_t rate, uint32_t time_us) {
    return rate * shorter(time_us, LONGEST_US) >> 14;
}

/* Resets the hold of each belief when the robot starts to move or stops. */
static void set_moves(EerufFlowRing *flow, bool moves) {
    uint8_t x;
    if (moves == ((flow->flags & MOVES) != 0)) return;
    flow->flags ^= MOVES;
    for (x = 0; x < flow->ring.count; x++)
        if (flow_sensor(&flow->ring, x)->conf > 1) flow_sensor(&flow->ring, x)->conf = 1;
}

EerufStatus eeruf_flow_moving(EerufFlowRing *flow, uint32_t speed_mm_s, uint32_t turn_mrad_s, uint32_t now_us) {
    const EerufStatus status = has_flow(flow, 0);
    uint16_t rate;
    uint8_t x;
    if (status != EERUF_OK) return status;
    if (!has_reached(now_us, flow->since_us)) {
        /* The first report of a clock in its upper half, or a clock that has jumped. */
        flow->greatest[0] = larger16(flow->greatest[0], flow->greatest[1]);
        flow->greatest[1] = 0;
        flow->since_us = now_us;
    }
    rate = recent_rate(flow, now_us);
    /* A sensor is assumed 0.5 m from the robot's centre of rotation. */
    flow->rate = rate_of(add32(speed_mm_s, turn_mrad_s / 2));
    flow->told_us = now_us;
    flow->flags |= TOLD;
    flow->greatest[1] = larger16(flow->greatest[1], flow->rate);
    rate = larger16(rate, flow->rate);
    for (x = 0; x < flow->ring.count; x++)
        flow_sensor(&flow->ring, x)->rate = larger16(flow_sensor(&flow->ring, x)->rate, rate);
    set_moves(flow, flow->rate != 0);
    decide_from(&flow->ring, now_us);
    return EERUF_OK;
}

/* -- The judge: accepts what fits the belief, or two readings in a row that nothing foreign explains -- */

#define TOO_FAR_US 1000u /* a belief that has missed readings ends once a good one may have changed by more */
#define SILENCE (EERUF_NO_ECHO - 1u) /* with a witness; EERUF_NO_ECHO means no reading or no belief */

static void forget_belief(EerufFlowSensor *sensor) {
    sensor->filter.known_us = sensor->believed_us = EERUF_NO_ECHO;
    sensor->grown_us = sensor->rate = 0;
    sensor->missed = sensor->conf = 0;
}

static void miss(EerufFlowSensor *sensor) {
    if (sensor->missed < UINT8_MAX) sensor->missed++;
    if (sensor->filter.age < EERUF_NEVER - 1u) sensor->filter.age++;
}

/* Returns how much a good reading may have changed since the one before, and adds it to the change since the belief.
   Sound is heard some time after it was sent, so the rate of that time counts too. */
static uint32_t grow_since(EerufFlowRing *flow, EerufFlowSensor *sensor, uint32_t before_us) {
    const uint32_t fired_us = sensor->fired_us[0];
    const uint16_t rate = rate_at(flow, fired_us), recent = recent_rate(flow, fired_us);
    const uint32_t span_us = grow(larger16(sensor->rate, recent), fired_us - before_us);
    set_moves(flow, rate != 0);
    sensor->rate = recent;
    sensor->grown_us = add16(sensor->grown_us, narrow(span_us));
    return span_us;
}

/* True if a reading fits the belief, which must not be too old. Silence is far from every echo. */
static bool fits(const EerufFlowRing *flow, const EerufFlowSensor *sensor, uint32_t t_echo_us) {
    if (sensor->believed_us == EERUF_NO_ECHO || sensor->missed > flow->memory) return false;
    if (sensor->missed > 0 && sensor->grown_us > TOO_FAR_US) return false;
    return apart(t_echo_us, sensor->believed_us) <= (uint32_t)flow->near_us + sensor->grown_us;
}

/* True if the echo that a sensor heard after its last firing could be the sound of any other firing. */
static bool is_masked(const EerufRing *ring, uint8_t receiver, uint32_t t_echo_us) {
    const EerufFlowSensor *own = flow_sensor(ring, receiver);
    const uint32_t heard_us = own->fired_us[0] + t_echo_us;
    uint8_t x, at;
    for (x = 0; x < ring->count; x++) {
        if (is_deaf_to(ring, receiver, x)) continue;
        for (at = x == receiver ? 1 : 0; at < FLOW_FIRINGS; at++)
            if (heard_us - flow_sensor(ring, x)->fired_us[at] <= ring->audible_us) return true;
    }
    return false;
}

static void give_less_quiet(const EerufFlowRing *flow, EerufFlowSensor *sensor) {
    const uint16_t least = (uint16_t)(least_quiet(flow) / QUIET_US);
    sensor->doubt = (uint16_t)(sensor->doubt > flow->down + least ? sensor->doubt - flow->down : least);
}

/* Judges an echo, or silence with a witness, that may have changed by `span_us` since the previous reading. */
static void weigh(EerufRing *ring, uint8_t x, uint32_t span_us, EerufReading *reading) {
    EerufFlowRing *flow = flow_of(ring);
    EerufFlowSensor *sensor = flow_sensor(ring, x);
    EerufFilter *filter = &sensor->filter;
    const bool is_echo = reading->t_echo_us != EERUF_NO_ECHO, stood = !(flow->flags & MOVES);
    const uint32_t t_echo_us = is_echo ? reading->t_echo_us : SILENCE, last_us = filter->known_us;
    const bool believes = sensor->believed_us != EERUF_NO_ECHO, known = fits(flow, sensor, t_echo_us);
    const bool is_far = believes && !known && (!is_echo || t_echo_us > sensor->believed_us);
    /* A first silence is not a belief yet, but a moving robot has left the old obstacle behind. */
    const bool clears = last_us == SILENCE || known || !stood;
    /* Readings of a moving robot differ anyway: quiet that did not help twice is dropped, then tried again. */
    const bool lets_go = !stood && !reports_every_echo(flow) && (sensor->missed & 2u) != 0;
    bool ok = known || !is_echo, held_back = false;
    if (!ok && last_us < SILENCE && apart(t_echo_us, last_us) <= t_delta_of(ring, x) + span_us) {
        reading->explained_by = explanation(ring, x, last_us, t_echo_us, span_us);
        ok = reading->explained_by == EERUF_BY_NOTHING;
    }
    if (stood && known && sensor->conf < flow->hold) sensor->conf++;
    if (stood && is_far) {
        if (sensor->conf > 0) sensor->conf--;
        held_back = ok;
        ok = ok && sensor->conf == 0;
    }
    filter->known_us = t_echo_us;
    if (!is_echo) reading->kind = ok && clears ? EERUF_READING_CLEAR : EERUF_READING_NO_ECHO;
    else if (ok) reading->kind = EERUF_READING_ACCEPTED;
    else if (reading->explained_by != EERUF_BY_NOTHING) reading->kind = EERUF_READING_AMBIGUOUS;
    else if (held_back) reading->kind = EERUF_READING_REPEATED; /* the belief outlasts it */
    else reading->kind = last_us >= SILENCE && !believes ? EERUF_READING_FIRST : EERUF_READING_REJECTED;
    if (reading->kind == EERUF_READING_ACCEPTED) reading->age = filter->age = 0;
    if (!ok) {
        miss(sensor);
        if (!is_echo || is_far) return;
        /* Quiet does not help against sound that the ring did not fire. */
        if (lets_go || !is_masked(ring, x, t_echo_us))
            give_less_quiet(flow, sensor);
        else
            sensor->doubt = (uint16_t)shorter(sensor->doubt + (uint32_t)flow->up, flow->most);
        return;
    }
    give_less_quiet(flow, sensor);
    if (!is_echo && !clears) return;
    if (!known) sensor->conf = 1;
    sensor->believed_us = t_echo_us;
    sensor->grown_us = 0;
    sensor->missed = 0;
}

static void judge(EerufRing *ring, uint8_t x, EerufReading *reading) {
    EerufFlowRing *flow = flow_of(ring);
    EerufFlowSensor *sensor = flow_sensor(ring, x);
    const uint32_t span_us = grow_since(flow, sensor, sensor->fired_us[1]);
    reading->previous_us = sensor->filter.known_us < SILENCE ? sensor->filter.known_us : EERUF_NO_ECHO;
    reading->age = sensor->filter.age;
    if (reading->kind == ON_HOLD) {
        const bool is_clear = sensor->believed_us == SILENCE && sensor->missed == 0;
        reading->kind = is_clear ? EERUF_READING_CLEAR : EERUF_READING_NO_ECHO;
        reading->previous_us = EERUF_NO_ECHO;
        if (sensor->filter.known_us != SILENCE) sensor->filter.known_us = EERUF_NO_ECHO;
        return;
    }
    if (reading->kind != USABLE) {
        miss(sensor);
        sensor->filter.known_us = EERUF_NO_ECHO;
        return;
    }
    weigh(ring, x, span_us, reading);
    if (reading->t_echo_us == EERUF_NO_ECHO || !reports_every_echo(flow)) return;
    reading->kind = EERUF_READING_ACCEPTED;
    reading->explained_by = EERUF_BY_NOTHING;
    reading->age = sensor->filter.age = 0;
}

/* Corrects the instant of a sensor's last firing. */
static void move_turn(EerufRing *ring, EerufFlowSensor *sensor, uint32_t at_us) {
    if (ring->last_fired_us == sensor->turn_us || has_reached(at_us, ring->last_fired_us)) ring->last_fired_us = at_us;
    sensor->turn_us = at_us;
}

/* The hook of a flow ring: forgets what is known of a sensor, resets its quiet, or counts its silence (the time since
   the previous firing was counted before); before, decides what is still undecided. */
static void change_flow(EerufRing *ring, uint8_t x, uint32_t what) {
    EerufFlowSensor *sensor = flow_sensor(ring, x);
    if (ring->next == UNDECIDED) decide(ring);
    if (what == FORGETS) {
        forget_belief(sensor);
    } else if (what == BEGINS_AGAIN) {
        sensor->doubt = flow_of(ring)->first;
        decide_no_sooner(ring);
    } else if (what == SILENCE_COUNTS) {
        EerufReading silence = {EERUF_NO_ECHO, EERUF_NO_ECHO, 0, USABLE, EERUF_BY_NOTHING};
        weigh(ring, x, grow_since(flow_of(ring), sensor, sensor->fired_us[0]), &silence);
    }
}

/* Handles a sensor that fired `later_us` after its poll, modulo 2^32. */
static void correct_flow(EerufRing *ring, uint8_t x, uint32_t later_us) {
    EerufFlowSensor *sensor = flow_sensor(ring, x);
    const uint32_t at_us = sensor->fired_us[0];
    const bool listens = (sensor->filter.flags & LISTENING) != 0;
    if (!listens && sensor->filter.known_us < SILENCE) {
        /* The reading was already judged, and the belief may be an echo of that firing. */
        (void)shift(&sensor->filter.known_us, later_us);
        if (sensor->missed == 0) (void)shift(&sensor->believed_us, later_us);
    }
    if (!listens || !(sensor->filter.state & HAS_FIRED) || has_reached(sensor->turn_us, at_us))
        move_turn(ring, sensor, at_us);
    if (listens && later_us < HALF_TURN) move_turn(ring, sensor, sensor->turn_us + later_us);
    decide_no_sooner(ring);
}

/* -- The ring -- */

#define LONGEST_REST_US 4000000u /* also the longest window */

/* True if a time is shorter than `least_us` or longer than `most_us`. */
static IN_LINE bool is_outside(uint32_t time_us, uint32_t least_us, uint32_t most_us) {
    return time_us < least_us || time_us > most_us;
}

static EerufStatus begin_flow(EerufFlowRing *flow, size_t flow_size, EerufFlowSensor *sensors, size_t sensors_size,
                              const EerufFlowConfig *config, uint32_t now_us) {
    EerufStatus status;
    uint32_t span_us;
    uint8_t n, x;
    if (flow == NULL || sensors == NULL || config == NULL) return EERUF_ERR_NULL;
    if (config->version != EERUF_VERSION) return EERUF_ERR_VERSION;
    n = config->sensors;
    if (flow_size != sizeof *flow) return EERUF_ERR_MEMORY;
    if (n - 1u >= EERUF_MAX_SENSORS) return EERUF_ERR_SENSORS;
    if (sensors_size / sizeof *sensors < n) return EERUF_ERR_MEMORY;
    if (config->own != NULL && READ8(config->own->sensors) != n) return EERUF_ERR_SENSORS;
    if (config->t_delta_us > 10000) return EERUF_ERR_FLOW_T_DELTA;
    if (config->near_us > 10000) return EERUF_ERR_FLOW_NEAR;
    if (config->path_change_us > 10000) return EERUF_ERR_FLOW_PATH_CHANGE;
    if (config->top_speed_mm_s - 1u < 9) return EERUF_ERR_FLOW_TOP_SPEED;
    if (config->hold == 0 || config->hold > 100) return EERUF_ERR_FLOW_HOLD;
    if (is_outside(config->most_us, 1000, 250000)) return EERUF_ERR_FLOW_MOST;
    if (is_outside(config->least_us, 100, config->most_us)) return EERUF_ERR_FLOW_LEAST;
    if (is_outside(config->rest_us, 1000, LONGEST_REST_US)) return EERUF_ERR_FLOW_REST;
    if (config->dice_us != 0 && is_outside(config->dice_us, 8, 250000)) return EERUF_ERR_FLOW_DICE;
    if (config->seed == 0) return EERUF_ERR_FLOW_SEED;
    if (is_outside(config->window_us, 1000, LONGEST_REST_US)) return EERUF_ERR_FLOW_WINDOW;
    if (config->votes > EERUF_VOTES_TWO_IN_A_ROW) return EERUF_ERR_RANGE;
    memset(flow, 0, sizeof *flow);
    set_up(&flow->ring, config->own, sensors, n, sizeof *sensors, 0, change_flow, now_us);
    status = listen(&flow->ring, config->t_delta_us, config->window_us, config->blanking_us);
    if (status != EERUF_OK) return status;
    flow->ring.path_change_us = config->path_change_us;
    flow->ring.audible_us = config->most_us;
    flow->ring.last_fired_us = now_us;
    flow->ring.watched = ALWAYS;
    flow->random = config->seed;
    flow->dice_us = config->dice_us;
    flow->rest_us = config->rest_us;
    span_us = config->most_us - config->least_us;
    flow->least_us = config->least_us;
    flow->most = (uint16_t)(config->most_us / QUIET_US);
    flow->first = (uint16_t)((config->least_us + span_us / 5) / QUIET_US);
    flow->up = (uint16_t)(span_us / 4 / QUIET_US);
    flow->down = (uint16_t)(span_us / 10 / QUIET_US);
    flow->near_us = config->near_us;
    flow->memory = config->memory;
    flow->hold = config->hold;
    flow->rate = flow->top_rate = flow->greatest[0] = flow->greatest[1] = rate_of(config->top_speed_mm_s);
    flow->stride = n > 4 ? 3 : 1;
    while (n > 4 && !is_coprime(flow->stride, n)) flow->stride++;
    for (x = 0; x < n; x++) {
        sensors[x].turn_us = now_us;
        sensors[x].doubt = flow->first;
    }
    if (config->votes == EERUF_VOTES_EVERY_ECHO) flow->flags = EVERY_ECHO_STANDING | EVERY_ECHO_MOVING;
    if (config->votes == EERUF_VOTES_BY_MOTION && config->alone) flow->flags = EVERY_ECHO_MOVING;
    if (flow->rate != 0) flow->flags |= MOVES;
    flow->lines = config->lines;
    group(&flow->ring);
    throw_dice(flow);
    decide(&flow->ring);
    flow->ring.ready = READY;
    return EERUF_OK;
}

EerufStatus eeruf_flow_init(EerufFlowRing *flow, size_t flow_size, EerufFlowSensor *sensors, size_t sensors_size,
                            const EerufFlowConfig *config, uint32_t now_us) {
    if (config != NULL) heed_limits(config->own);
    return begin_flow(flow, flow_size, sensors, sensors_size, config, now_us);
}

EerufStatus eeruf_flow_init_alike(EerufFlowRing *flow, size_t flow_size, EerufFlowSensor *sensors, size_t sensors_size,
                                  const EerufFlowConfig *config, uint32_t now_us) {
    if (config != NULL && config->own != NULL) return EERUF_ERR_RANGE;
    return begin_flow(flow, flow_size, sensors, sensors_size, config, now_us);
}

EerufStatus eeruf_flow_poll(EerufFlowRing *flow, uint32_t now_us, EerufEvent *event) {
    const EerufStatus status = has_flow(flow, 0);
    return status == EERUF_OK ? poll(&flow->ring, now_us, NULL, event, true) : status;
}

EerufStatus eeruf_flow_enable(EerufFlowRing *flow, uint8_t sensor, bool enabled) {
    const EerufStatus status = has_flow(flow, sensor);
    if (status != EERUF_OK) return status;
    if (enabled && !(flow_sensor(&flow->ring, sensor)->filter.state & DISABLED)) return EERUF_OK;
    if (enabled) flow_sensor(&flow->ring, sensor)->doubt = flow->first;
    enable(&flow->ring, sensor, enabled, true);
    group(&flow->ring);
    decide_no_sooner(&flow->ring);
    return EERUF_OK;
}

EerufStatus eeruf_flow_pause(EerufFlowRing *flow, bool paused) {
    const EerufStatus status = has_flow(flow, 0);
    uint8_t x;
    if (status != EERUF_OK) return status;
    flow->ring.paused = paused;
    for (x = 0; x < flow->ring.count && !paused; x++) {
        /* Beliefs stay, but no reading is compared with one from before. */
        EerufFlowSensor *sensor = flow_sensor(&flow->ring, x);
        sensor->filter.known_us = EERUF_NO_ECHO;
        if (sensor->missed == 0) sensor->missed = 1;
    }
    group(&flow->ring);
    decide_no_sooner(&flow->ring);
    return EERUF_OK;
}

EerufStatus eeruf_flow_restart(EerufFlowRing *flow, uint32_t now_us) {
    const EerufStatus status = has_flow(flow, 0);
    if (status == EERUF_OK) restart_by_flow(&flow->ring, now_us);
    return status;
}

uint32_t eeruf_flow_quiet_us(const EerufFlowRing *flow, uint8_t sensor) {
    return has_flow(flow, sensor) == EERUF_OK ? quiet_of(flow, flow_sensor(&flow->ring, sensor)) : 0;
}

uint32_t eeruf_flow_believed_us(const EerufFlowRing *flow, uint8_t sensor) {
    const EerufFlowSensor *of;
    if (has_flow(flow, sensor) != EERUF_OK) return EERUF_NO_ECHO;
    of = flow_sensor(&flow->ring, sensor);
    return of->missed <= flow->memory && of->believed_us < SILENCE ? of->believed_us : EERUF_NO_ECHO;
}

/* eeruf in C: see eeruf.h. In the order of the header; the hopping ring is the last part.
 * Equations and sections are those of Borenstein and Koren, IEEE Trans. Robotics and Automation 11(1), 1995. */
#include "eeruf.h"

#include <string.h>

#define READY ((uint16_t)(0x4500u + EERUF_VERSION))
#define READY_TO_HOP ((uint16_t)(READY + 0x100u)) /* adaptation of rings that hop */
#define NOBODY 255u
#define HALF_TURN 0x80000000u /* of the clock: beyond it two instants have no order */

/* Sizes that tables and callers rely on. */
#define SIZE_IS(type, size) typedef char type##_has_another_size[sizeof(type) == (size) ? 1 : -1]
#ifdef __AVR__
SIZE_IS(EerufSensor, 12 + 4 * EERUF_FIRINGS);
SIZE_IS(EerufLine, 8);
SIZE_IS(EerufSchedule, 46);
SIZE_IS(EerufLimits, 7);
SIZE_IS(EerufWatched, 10);
#if EERUF_HOPPING
SIZE_IS(EerufRing, 77);
SIZE_IS(EerufHopSensor, 16);
SIZE_IS(EerufHopper, 64);
#endif
#else
SIZE_IS(EerufSensor, 16 + 4 * EERUF_FIRINGS);
SIZE_IS(EerufLine, 8);
#endif

#if defined(__AVR__) && !defined(EERUF_SCHEDULE_IN_RAM)
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

/* Where inlining costs more flash than the call, measured on an AVR. */
#if defined(__GNUC__)
#define OUT_OF_LINE __attribute__((noinline))
#else
#define OUT_OF_LINE
#endif
/* For code that adapting rings need once more: others are no larger for it. */
#if defined(__GNUC__)
#define IN_LINE inline __attribute__((always_inline))
#else
#define IN_LINE
#endif

uint16_t eeruf_version(void) {
    return EERUF_VERSION;
}

/* True if `now` is `deadline` or up to half a turn of the clock past it. */
static bool has_reached(uint32_t now, uint32_t deadline) {
    return now - deadline < HALF_TURN;
}

static uint16_t narrow(uint32_t time) {
    return (uint16_t)(time >> 16) != 0 ? UINT16_MAX : (uint16_t)time;
}

static uint16_t add16(uint16_t one, uint16_t other) {
    const uint16_t sum = (uint16_t)(one + other);
    return sum < one ? UINT16_MAX : sum;
}

static OUT_OF_LINE uint32_t add32(uint32_t one, uint32_t other) {
    return one > UINT32_MAX - other ? UINT32_MAX : one + other;
}

static uint32_t apart(uint32_t one, uint32_t other) {
    return one > other ? one - other : other - one;
}

static OUT_OF_LINE uint32_t longer(uint32_t one, uint32_t other) {
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

/* When a sensor fires in a phase, after the start of the period. */
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

/* From a sensor's firing in a phase to its next one. */
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

EerufStatus eeruf_schedule_make(EerufSchedule *schedule, uint8_t *order, size_t order_size, uint32_t *gap_us,
                                size_t gap_size, uint32_t period_us, uint8_t sensors, uint8_t phases,
                                const uint32_t *t_fire_us) {
#if defined(__AVR__) && !defined(EERUF_SCHEDULE_IN_RAM)
    (void)schedule, (void)order, (void)order_size, (void)gap_us, (void)gap_size;
    (void)period_us, (void)sensors, (void)phases, (void)t_fire_us;
    return EERUF_ERR_MEMORY; /* it would be looked for in flash */
#else
    uint8_t phase, sensor, at;
    if (schedule == NULL || order == NULL || gap_us == NULL || t_fire_us == NULL) return EERUF_ERR_NULL;
    if (sensors == 0 || sensors > EERUF_MAX_SENSORS) return EERUF_ERR_SENSORS;
    if (phases == 0 || phases > EERUF_MAX_PHASES) return EERUF_ERR_PHASES;
    if (period_us == 0 || period_us > EERUF_MAX_PERIOD_US) return EERUF_ERR_PERIOD;
    if (order_size < (size_t)phases * sensors) return EERUF_ERR_MEMORY;
    if (gap_size < (size_t)phases * (sensors + 1u) * sizeof *gap_us) return EERUF_ERR_MEMORY;
    for (phase = 0; phase < phases; phase++) {
        uint8_t *places = order + (size_t)phase * sensors;
        uint32_t *times = gap_us + (size_t)phase * (sensors + 1u), last = 0;
        for (sensor = 0; sensor < sensors; sensor++) {
            /* Insertion sort by firing time; sensors that fire together keep their order. */
            const uint32_t t_fire = t_fire_us[(size_t)phase * sensors + sensor];
            if (t_fire >= period_us) return EERUF_ERR_FIRE;
            for (at = sensor; at > 0 && times[at - 1] > t_fire; at--) {
                times[at] = times[at - 1];
                places[at] = places[at - 1];
            }
            times[at] = t_fire;
            places[at] = sensor;
        }
        times[sensors] = period_us;
        for (at = 0; at <= sensors; at++) {
            const uint32_t t_fire = times[at];
            times[at] = t_fire - last;
            last = t_fire;
        }
    }
    memset(schedule, 0, sizeof *schedule);
    schedule->version = EERUF_VERSION;
    schedule->sensors = sensors;
    schedule->phases = phases;
    schedule->order = order;
    schedule->gap_us = gap_us;
    schedule->period_us = period_us;
    schedule->min_refire_us = shortest_refire(schedule);
    schedule->path_change_us = EERUF_AS_T_DELTA;
    return EERUF_OK;
#endif
}

static bool are_neighbours(uint8_t layout, uint8_t n, uint8_t sensors, uint8_t x, uint8_t y) {
    const uint8_t steps = x > y ? (uint8_t)(x - y) : (uint8_t)(y - x);
    if (x == y) return false;
    switch (layout) {
    case EERUF_LAYOUT_LINE: return steps < n;
    case EERUF_LAYOUT_RING: return steps < n || sensors - steps < n;
    case EERUF_LAYOUT_BLOCKS: return n > 0 && x / n == y / n;
    default: return false;
    }
}

/* The lead of a sensor's firing in phase b over that in phase a, each after the start of its period. */
static int32_t shift_of(const EerufSchedule *schedule, uint8_t sensor) {
    return (int32_t)fires_at(schedule, 0, sensor) - (int32_t)fires_at(schedule, 1, sensor);
}

/* (13a) and (13b) in what rejecting all crosstalk needs of them: |d_x - d_y| and |d_x + d_y|, the smaller. With x = y
   the second is by how much a sensor's own echo from the period before moves. */
static uint32_t moves_by(const EerufSchedule *schedule, uint8_t x, uint8_t y) {
    const int32_t dx = shift_of(schedule, x), dy = shift_of(schedule, y);
    const uint32_t even = (uint32_t)(dx > dy ? dx - dy : dy - dx);
    const uint32_t odd = (uint32_t)(dx + dy < 0 ? -(dx + dy) : dx + dy);
    return x == y ? odd : shorter(even, odd);
}

/* The needs of one sensor. */
static uint32_t own_t_delta(const EerufLimits *limits, uint8_t sensor, uint32_t t_delta_us) {
    return limits == NULL ? t_delta_us : READ16(limits[sensor].t_delta_us);
}


/* True if two sensors fire together, and so are declared not to hear each other. */
static bool fire_together(const EerufLimits *limits, uint8_t x, uint8_t y) {
    if (limits == NULL || x == y || READ8(limits[x].group) == 0) return false;
    return READ8(limits[x].group) == READ8(limits[y].group);
}

/* True if the schedule meets requirements; also the largest t_delta and window, and by how much crosstalk moves at
   least: as much more than that t_delta as the pair with the least to spare has. */
static EerufStatus meets(const EerufSchedule *schedule, EerufRequirements *needs, uint32_t *separation_us) {
    const EerufLimits *limits = needs->limits;
    const uint8_t sensors = READ8(schedule->sensors);
    uint32_t t_delta_us = 0, window_us = 0, spare_us = UINT32_MAX;
    EerufStatus stale = EERUF_OK, last = EERUF_OK;
    uint8_t x, y, phase;
    if (READ8(schedule->phases) != 2) return EERUF_ERR_PHASES;
    for (x = 0; x < sensors; x++) {
        const uint32_t own_us = own_t_delta(limits, x, needs->t_delta_us);
        const uint32_t listens_us = limits == NULL ? needs->window_us : READ32(limits[x].window_us);
        t_delta_us = longer(t_delta_us, own_us);
        window_us = longer(window_us, listens_us == 0 ? READ32(schedule->min_refire_us) : listens_us);
        for (phase = 0; phase < 2; phase++)
            if (refire(schedule, phase, x) < listens_us) last = EERUF_ERR_WINDOW;
        for (y = 0; y <= x; y++) {
            const uint32_t moves = moves_by(schedule, x, y);
            const uint32_t larger_us = longer(own_us, own_t_delta(limits, y, needs->t_delta_us));
            if (fire_together(limits, x, y)) {
                for (phase = 0; phase < 2; phase++)
                    if (last == EERUF_OK && fires_at(schedule, phase, x) != fires_at(schedule, phase, y))
                        last = EERUF_ERR_TOGETHER;
                continue;
            }
            if (x == y && !needs->stale_echo) continue;
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
                if (!are_neighbours(needs->layout, needs->neighbours, sensors, x, y)) continue;
                if (apart(t_x, fires_at(schedule, phase, y)) < needs->min_interval_us) return EERUF_ERR_INTERVAL;
                if (t_next - t_x < needs->min_interval_us) return EERUF_ERR_INTERVAL;
            }
        }
    }
    /* The longest time that any sensor keeps between two firings does not follow from neighbours alone. */
    if (limits != NULL) needs->layout = EERUF_LAYOUT_OTHER;
    for (x = 0; x < sensors && limits != NULL; x++)
        needs->min_interval_us = longer(needs->min_interval_us, READ32(limits[x].window_us));
    needs->t_delta_us = t_delta_us;
    needs->window_us = window_us;
    *separation_us = add32(t_delta_us, spare_us);
    return last;
}

/* For how long sound may be audible where crosstalk moves: its own echo, sent two firings before, reads the same. */
static uint32_t audible_for(const EerufSchedule *schedule) {
    const uint32_t period_us = READ32(schedule->period_us);
    return READ8(schedule->stale_echo) ? 2 * period_us : period_us;
}

EerufStatus eeruf_schedule_verify(EerufSchedule *schedule, const EerufRequirements *requirements) {
#if defined(__AVR__) && !defined(EERUF_SCHEDULE_IN_RAM)
    (void)schedule, (void)requirements;
    return EERUF_ERR_MEMORY;
#else
    EerufStatus status;
    EerufRequirements needs;
    uint32_t separation_us;
    if (schedule == NULL || requirements == NULL) return EERUF_ERR_NULL;
    if (schedule->version != EERUF_VERSION) return schedule->version == 0 ? EERUF_ERR_NOT_READY : EERUF_ERR_VERSION;
    if (requirements->layout > EERUF_LAYOUT_BLOCKS) return EERUF_ERR_RANGE;
    needs = *requirements;
    status = meets(schedule, &needs, &separation_us);
    if (status != EERUF_OK) return status;
    schedule->t_delta_us = needs.t_delta_us;
    schedule->min_interval_us = needs.min_interval_us;
    schedule->window_us = needs.window_us;
    schedule->limits = needs.limits;
    schedule->separation_us = separation_us;
    schedule->layout = needs.layout;
    schedule->neighbours = requirements->neighbours;
    schedule->stale_echo = requirements->stale_echo;
    schedule->path_change_us = EERUF_AS_T_DELTA;
    schedule->audible_us = audible_for(schedule);
    schedule->verified = 1;
    return EERUF_OK;
#endif
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
    EerufRequirements promised;
    uint32_t separation_us, gap_us, path_change_us;
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
    promised.t_delta_us = READ32(schedule->t_delta_us);
    promised.min_interval_us = READ32(schedule->min_interval_us);
    promised.window_us = READ32(schedule->window_us);
    promised.layout = READ8(schedule->layout);
    promised.neighbours = READ8(schedule->neighbours);
    promised.stale_echo = READ8(schedule->stale_echo);
    promised.limits = READ_POINTER(const EerufLimits *, schedule->limits);
    status = meets(schedule, &promised, &separation_us);
    if (status != EERUF_OK) return status;
    if (promised.t_delta_us != READ32(schedule->t_delta_us)) return EERUF_ERR_TABLE;
    if (promised.window_us != READ32(schedule->window_us)) return EERUF_ERR_TABLE;
    if (separation_us != READ32(schedule->separation_us)) return EERUF_ERR_TABLE;
    path_change_us = READ32(schedule->path_change_us);
    if (path_change_us != EERUF_AS_T_DELTA && separation_us - promised.t_delta_us <= path_change_us)
        return EERUF_ERR_CROSSTALK;
    return READ32(schedule->audible_us) - 1u >= audible_for(schedule) ? EERUF_ERR_TABLE : EERUF_OK;
}

/* ---- The filter ---- */

/* Number of readings in a row that an echo was in, up to `consecutive`; 0 where nothing is known. */
#define RUN 0x0fu
#define DISABLED 0x80u /* of a ring's sensor, kept in the same byte */

const char *eeruf_reading_name(uint8_t kind) {
    switch (kind) {
    case EERUF_READING_FIRST: return "first";
    case EERUF_READING_ACCEPTED: return "accepted";
    case EERUF_READING_REJECTED: return "rejected";
    case EERUF_READING_REPEATED: return "repeated";
    case EERUF_READING_NO_ECHO: return "no_echo";
    case EERUF_READING_CLEAR: return "clear";
    case EERUF_READING_TOO_EARLY: return "too_early";
    case EERUF_READING_LATE: return "late";
    case EERUF_READING_STUCK: return "stuck";
    case EERUF_READING_TENTATIVE: return "tentative";
    case EERUF_READING_AMBIGUOUS: return "ambiguous";
    case EERUF_READING_UNANSWERED: return "unanswered";
    default: return "?";
    }
}

static void forget(EerufFilter *filter) {
    filter->known_us = EERUF_NO_ECHO;
    filter->state &= DISABLED;
}

/* Eq. (11), after taking off the change that is expected. Echoes are below half a turn. */
static bool near_identical(uint32_t echo_us, uint32_t previous_us, int32_t change_us, uint16_t t_delta_us) {
    /* Silence does not move, and is further from any echo than any t_delta. */
    if (echo_us == EERUF_NO_ECHO || previous_us == EERUF_NO_ECHO) change_us = 0;
    if (change_us < 0) {
        /* The same with echoes exchanged, so that the change is taken off the later one. */
        const uint32_t earlier = previous_us;
        previous_us = echo_us;
        echo_us = earlier;
        return apart(echo_us, previous_us + (0u - (uint32_t)change_us)) <= t_delta_us;
    }
    return apart(echo_us, previous_us + (uint32_t)change_us) <= t_delta_us;
}

/* True if a reading agrees with the one before. */
static bool agrees(const EerufFilter *filter, uint16_t t_delta_us, uint32_t t_echo_us, int32_t change_us) {
    return (filter->state & RUN) != 0 && near_identical(t_echo_us, filter->known_us, change_us, t_delta_us);
}

/* Takes in a reading that agrees with the one before or not, or agrees but is explained. Returns its kind. */
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

/* The firing that an echo time is measured from was so much later, modulo 2^32. False if the echo came before it; it
   then counts as having come with it. */
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

/* The reading has its kind already. */
static void note_age(EerufReading *reading, EerufFilter *filter) {
    if (reading->kind == EERUF_READING_ACCEPTED) filter->age = 0;
    else if (filter->age < EERUF_NEVER - 1u) filter->age++;
    reading->age = filter->age;
}

EerufStatus eeruf_filter_push(EerufFilter *filter, uint32_t t_delta_us, uint8_t consecutive, uint32_t t_echo_us,
                              int32_t expected_change_us, EerufReading *reading) {
    bool agreed;
    if (filter == NULL || reading == NULL) return EERUF_ERR_NULL;
    if (consecutive < 2 || consecutive > 8) return EERUF_ERR_CONSECUTIVE;
    if (t_delta_us > UINT16_MAX) return EERUF_ERR_COARSE_T_DELTA;
    if (t_echo_us >= HALF_TURN && t_echo_us != EERUF_NO_ECHO) return EERUF_ERR_RANGE;
    reading->t_echo_us = t_echo_us;
    reading->explained_by = EERUF_BY_NOTHING;
    reading->previous_us = filter->known_us;
    agreed = agrees(filter, (uint16_t)t_delta_us, t_echo_us, expected_change_us);
    reading->kind = push(filter, consecutive, t_echo_us, agreed, false);
    note_age(reading, filter);
    return EERUF_OK;
}

EerufStatus eeruf_filter_forget(EerufFilter *filter) {
    if (filter == NULL) return EERUF_ERR_NULL;
    forget(filter);
    return EERUF_OK;
}

/* ---- The ring ---- */

/* The flags of a sensor, beside the period in which it fired, modulo 8. */
#define PERIOD 0x07u
#define LISTENING 0x08u    /* it has fired, and its reading is pending */
#define CAN_EMIT 0x10u     /* it has a reading that can be emitted before its window closes */
#define OUTSIDE 0x20u      /* its only edges so far came outside the window */
#define STUCK 0x40u        /* its line was high when it was to fire */
#define UNANSWERED 0x80u   /* nothing has shown yet that it listens: silence says nothing */
#define NO_FAULT 0x01u     /* beside UNANSWERED in the ring: nor is it called a fault */

/* Rings that hop in time fire otherwise than by a table. What is linked for all takes `hops` as a constant, so that
   nothing of the one kind is linked where only the other is polled; HOPS asks the ring. */
#if EERUF_HOPPING
#define HOPS(ring) ((ring)->schedule == NULL)
#define OWN(ring) ((ring)->schedule_before) /* limits of a hopping ring, which changes to no schedule */
#define STRIDE(ring) ((ring)->stride) /* hopping rings have shorter EerufHopSensors */
static void fire_hop(EerufRing *ring, uint8_t sensor, uint32_t now_us);
static void end_hopping_period(EerufRing *ring, uint32_t now_us);
static void restart_hopping(EerufRing *ring, uint32_t now_us);
static uint32_t horizon_of_hopping(const EerufRing *ring);
static EerufStatus upcoming_hop(const EerufRing *ring, uint8_t number, uint8_t *sensor, uint32_t *due_us);
#else
#define HOPS(ring) false
#define STRIDE(ring) sizeof(EerufSensor)
#define fire_hop(ring, sensor, now_us) ((void)0)
#define end_hopping_period(ring, now_us) ((void)0)
#define restart_hopping(ring, now_us) ((void)0)
#define horizon_of_hopping(ring) 0u
#define upcoming_hop(ring, number, sensor, due_us) EERUF_EMPTY
#endif

static uint32_t window_of(const EerufRing *ring, uint8_t sensor);
static void find_first_to_close(EerufRing *ring);
static void emit_when_oldest_ends(EerufRing *ring);

static EerufSensor *after(const EerufSensor *sensor, size_t bytes) {
    return (EerufSensor *)(void *)((uint8_t *)(uintptr_t)sensor + bytes);
}

static EerufSensor *sensor_of(const EerufRing *ring, uint8_t sensor) {
    return after(ring->sensors, (size_t)sensor * STRIDE(ring));
}

static void count(EerufRing *ring, uint8_t kind) {
    if (ring->tally[kind] < UINT8_MAX) ring->tally[kind]++;
}

/* -- What was fired: see the header, and docs/explanation/theory.md, section 2.1. While all firings kept a verified
   timetable, (13a) and (13b) say what asking would find. A late firing delays all that follow, so the time between two
   firings is off by at most the lateness in between; a verified schedule has some of that to spare. -- */

#define AS_T_DELTA UINT16_MAX        /* the path change of a ring that follows its t_delta */
#define MAX_AUDIBLE ((uint32_t)1 << 26)
#define LONG_AGO ((uint32_t)1 << 30) /* nothing is heard from then */
#define STEP_BACK ((uint32_t)1 << 20) /* what lies so little ahead of now is from before the clock stepped back */

/* For this many ends of periods an irregularity is remembered: the first of three readings, which a filter over three may
   compare, was fired three periods ago, and sound is audible for two. */
#define WATCHED 6u
#define ALWAYS UINT8_MAX /* nothing is proven of the timetable, so that each reading is asked about */

/* Limits that a schedule gives its sensors one by one; null for a hopping ring, or if it was the same before. */
static OUT_OF_LINE const EerufLimits *limits_of(const EerufSchedule *schedule) {
    return schedule == NULL ? NULL : READ_POINTER(const EerufLimits *, schedule->limits);
}

static bool windows_differ(const EerufRing *ring) {
    return limits_of(ring->schedule) != NULL || limits_of(ring->schedule_before) != NULL;
}

/* For how long a sensor listens that is to listen for `window_us`: no longer than a schedule allows it. */
static OUT_OF_LINE uint32_t allowed_window(const EerufSchedule *schedule, uint8_t sensor, uint32_t window_us) {
    const EerufLimits *limits = limits_of(schedule);
    uint32_t own_us;
    if (limits == NULL) return window_us;
    own_us = READ32(limits[sensor].window_us);
    return shorter(window_us, own_us == 0 ? READ32(schedule->min_refire_us) : own_us);
}

/* As the schedule allows it, and the one of the period before, whose last firings may still be listening. */
static uint32_t window_of(const EerufRing *ring, uint8_t sensor) {
    return allowed_window(ring->schedule_before, sensor, allowed_window(ring->schedule, sensor, ring->window_us));
}

/* The same of what counts as the same echo. */
static uint16_t t_delta_of(const EerufRing *ring, uint8_t sensor) {
    const uint32_t now_us = own_t_delta(limits_of(ring->schedule), sensor, ring->t_delta_us);
    const uint32_t before_us = own_t_delta(limits_of(ring->schedule_before), sensor, ring->t_delta_us);
    return (uint16_t)shorter(ring->t_delta_us, shorter(now_us, before_us));
}

static uint32_t path_change_of(const EerufRing *ring, uint16_t t_delta_us) {
    return ring->path_change_us == AS_T_DELTA ? t_delta_us : ring->path_change_us;
}

/* Something irregular happened, or something else is asked of the schedule: whether it was verified for that. */
static OUT_OF_LINE void disturb(EerufRing *ring) {
    const EerufSchedule *schedule = ring->schedule;
    uint32_t promised_us;
    ring->watched = ALWAYS;
    if (HOPS(ring) || !is_verified(schedule)) return;
    promised_us = READ32(schedule->path_change_us);
    if (promised_us == EERUF_AS_T_DELTA) promised_us = READ32(schedule->t_delta_us);
    if (ring->path_change_us != AS_T_DELTA && ring->path_change_us > promised_us) return;
    if (ring->audible_us > READ32(schedule->audible_us)) return;
    /* Sound that was sent two periods apart differs by the time until a sensor fires again. */
    if (ring->t_delta_us + path_change_of(ring, ring->t_delta_us) < READ32(schedule->min_refire_us))
        ring->watched = WATCHED;
}

static void note_late(EerufRing *ring, uint16_t late_us) {
    if (late_us > ring->latest_us) ring->latest_us = late_us;
}

/* The timetable got longer at a firing. */
static void add_late(EerufRing *ring, uint16_t late_us) {
    note_late(ring, late_us);
    ring->sum_late_us = add16(ring->sum_late_us, late_us);
}

/* A firing came late. No two readings hear more than four periods. */
static OUT_OF_LINE void fired_late(EerufRing *ring, uint16_t late_us, bool hops) {
    uint32_t needed_us;
    add_late(ring, late_us);
    if (EERUF_FIRINGS == 1 || hops || ring->watched == ALWAYS) return;
    needed_us = ring->t_delta_us + path_change_of(ring, ring->t_delta_us) + 4 * (uint32_t)ring->sum_late_us + 1u;
    if (READ32(ring->schedule->separation_us) < needed_us) ring->watched = WATCHED;
}

#if EERUF_FIRINGS > 1
/* True if a sensor does not hear another, by the schedule and by the one before. */
static bool is_deaf_to(const EerufRing *ring, uint8_t receiver, uint8_t emitter) {
    return fire_together(limits_of(ring->schedule), receiver, emitter) &&
           (ring->schedule_before == NULL || fire_together(limits_of(ring->schedule_before), receiver, emitter));
}

/* The sensor whose sound could be both echoes of a receiver: the one heard `first_us` after the firing before its last, and
   the one heard `second_us` after its last. */
static OUT_OF_LINE uint8_t explanation(const EerufRing *ring, uint8_t receiver, uint32_t first_us,
                                       uint32_t second_us) {
    const EerufSensor *own = sensor_of(ring, receiver);
    const uint32_t heard_before = own->fired_us[1] + first_us, heard = own->fired_us[0] + second_us;
    const uint32_t audible = ring->audible_us, between = heard - heard_before;
    const uint32_t change = path_change_of(ring, t_delta_of(ring, receiver));
    const EerufSensor *sensor = ring->sensors;
    uint32_t length = heard_before - ring->known_from_us;
    uint8_t x = 0, by = EERUF_BY_NOTHING;
    for (;;) {
        const uint32_t *before = sensor->fired_us, *fired;
        /* All that is forgotten was fired before this. An instant after the first reading leaves that open. */
        if (length < audible || length >= HALF_TURN) by = EERUF_BY_HISTORY;
        if (x == ring->count) return by;
        if (is_deaf_to(ring, receiver, x)) {
            length = HALF_TURN - 1;
            before = sensor->fired_us + EERUF_FIRINGS;
        }
        for (; before < sensor->fired_us + EERUF_FIRINGS; before++) {
            length = heard_before - *before;
            if (length > audible || before == own->fired_us + 1) continue;
            /* Both may be one firing if the readings are as close as that. */
            for (fired = sensor->fired_us; fired <= before; fired++) {
                if (fired == own->fired_us || heard - *fired > audible) continue;
                if (*fired - *before - between + change <= 2 * change) return x;
            }
        }
        sensor++;
        x++;
    }
}

#endif

static bool is_long_ago(uint32_t instant, uint32_t now_us) {
    return now_us - instant - LONG_AGO - 1u < 0u - STEP_BACK - LONG_AGO - 1u;
}

/* All firings so long ago that nothing is heard of them. */
static OUT_OF_LINE void forget_firings(EerufSensor *sensor, uint8_t firings, uint32_t now_us) {
    while (firings-- > 0) sensor->fired_us[firings] = now_us - LONG_AGO;
}

static void forget_readings(EerufRing *ring, uint8_t sensor);

static void end_late_period(EerufRing *ring, EerufPeriod *ended, uint32_t now_us, bool hops) {
    uint8_t x;
    ended->max_late_us = ring->latest_us;
    ended->sum_late_us = ring->sum_late_us;
    ring->latest_us = ring->sum_late_us = 0;
    /* Old firings must not come round with the clock. */
    for (x = 0; x < ring->count; x++) {
        EerufSensor *sensor = sensor_of(ring, x);
        if (is_long_ago(sensor->fired_us[0], now_us)) {
            forget_firings(sensor, hops ? 1 : EERUF_FIRINGS, now_us);
            /* Its next reading cannot be compared: the instant of its firing before is no longer known. */
            forget_readings(ring, x);
            /* No edge is an echo of them. */
            if (!(sensor->flags & LISTENING)) sensor->flags |= OUTSIDE;
        }
    }
#if EERUF_FIRINGS > 1
    if (hops) return;
    if (ring->watched != 0 && ring->watched != ALWAYS) ring->watched--;
    if (is_long_ago(ring->known_from_us, now_us)) ring->known_from_us = now_us - LONG_AGO;
#endif
}

/* -- Scheduled firing (Sec. 3.1, Fig. 3): every sensor fires once per period, by the table. A firing that is polled
   late moves all that follow by as much: the timetable may stretch but never shrinks. -- */

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

/* After the firing, or the start of the period, at `due_us`. */
static OUT_OF_LINE void turn(EerufRing *ring) {
    turn_once(ring);
    skip_silent(ring);
}

static OUT_OF_LINE void begin_period(EerufRing *ring, uint8_t phase) {
    ring->phase = phase;
    ring->following = 0;
    turn(ring);
}

/* Time to stay silent after the last firing so that a period which was not verified against it may begin. */
static uint32_t settling_time(const EerufSchedule *schedule) {
    const uint32_t least = is_verified(schedule) ? READ32(schedule->min_interval_us) : READ32(schedule->period_us);
    return longer(least, READ32(schedule->min_refire_us));
}

/* No deadline lies further ahead, unless the clock has jumped. */
static OUT_OF_LINE uint32_t horizon_of_table(const EerufRing *ring) {
    return longer(3 * READ32(ring->schedule->period_us), ring->due_us - ring->last_fired_us);
}

/* Ends the period of a table. Returns whether the next one does not follow on it as the schedule says. */
static bool end_period_of_table(EerufRing *ring, uint32_t now_us, uint32_t late_us) {
    const uint32_t settling = settling_time(ring->schedule);
    bool changed = late_us > READ32(ring->schedule->period_us);
    uint8_t phase;
    ring->schedule_before = NULL;
    if (changed) ring->due_us = now_us;
    /* The last firing must not fall half a turn of the clock behind while no sensor is enabled. */
    if (ring->due_us - ring->last_fired_us > settling) ring->last_fired_us = ring->due_us - settling;
    if (ring->hook != NULL) {
        ring->hook(ring, 0, settling);
        changed = true;
    }
    phase = (uint8_t)(ring->phase + 1u);
    begin_period(ring, phase < READ8(ring->schedule->phases) ? phase : 0);
    return changed;
}

/* Begins with the first phase, silent for long enough by then. */
static OUT_OF_LINE void begin_table(EerufRing *ring, uint32_t at_us) {
    ring->due_us = at_us;
    ring->last_fired_us = at_us - settling_time(ring->schedule);
    begin_period(ring, 0);
}

static void restart_table(EerufRing *ring, uint32_t now_us) {
    const uint32_t settled_us = ring->last_fired_us + settling_time(ring->schedule);
    /* A clock that has jumped says nothing about when the last firing was. */
    begin_table(ring, settled_us - now_us - 1u < horizon_of_table(ring) ? settled_us : now_us);
}

/* -- What a ring does -- */

static EerufStatus is_ready(const EerufRing *ring) {
    if (ring == NULL) return EERUF_ERR_NULL;
    return ring->ready == READY ? EERUF_OK : EERUF_ERR_NOT_READY;
}

static EerufStatus has_sensor(const EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = is_ready(ring);
    return status == EERUF_OK && sensor >= ring->count ? (EerufStatus)EERUF_ERR_SENSOR : status;
}

/* True if a schedule allows such listening and comparing. */
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

/* True if the shortest window that a schedule allows is long enough, for this many sensors. */
static EerufStatus can_hear(const EerufSchedule *schedule, uint8_t sensors, uint32_t t_delta_us, uint32_t window_us,
                            uint32_t blanking_us) {
    uint8_t x;
    for (x = 0; x < sensors; x++) window_us = allowed_window(schedule, x, window_us);
    if (blanking_us >= window_us || blanking_us > UINT16_MAX) return EERUF_ERR_BLANKING;
    return t_delta_us >= window_us || t_delta_us > UINT16_MAX ? EERUF_ERR_COARSE_T_DELTA : EERUF_OK;
}

/* Listens and compares so from now on, if that is possible. */
static EerufStatus listen(EerufRing *ring, uint32_t t_delta_us, uint32_t window_us, uint32_t blanking_us) {
    EerufStatus status = can_hear(ring->schedule, ring->count, t_delta_us, window_us, blanking_us);
    if (status == EERUF_OK)
        status = can_hear(ring->schedule_before, ring->count, t_delta_us, window_us, blanking_us);
    if (status != EERUF_OK) return status;
    ring->t_delta_us = (uint16_t)t_delta_us;
    ring->window_us = window_us;
    ring->blanking_us = (uint16_t)blanking_us;
    return EERUF_OK;
}

static OUT_OF_LINE void drop_firing(const EerufRing *ring, uint8_t x, uint32_t now_us) {
    EerufSensor *sensor = sensor_of(ring, x);
    forget_firings(sensor, HOPS(ring) ? 1 : EERUF_FIRINGS, now_us);
    sensor->echo_us = EERUF_NO_ECHO;
    forget(&sensor->filter);
    sensor->flags = OUTSIDE;
}

/* Everything but listening and scheduler. As if silence had come before: what was fired earlier is for the caller to
   wait for. */
static void set_up(EerufRing *ring, const EerufSchedule *schedule, void *sensors, uint8_t count_of_sensors,
                   size_t stride, uint32_t now_us) {
    uint8_t x;
    memset(ring, 0, sizeof *ring);
    memset(sensors, 0, count_of_sensors * stride);
    ring->schedule = schedule;
    ring->sensors = (EerufSensor *)sensors;
    ring->stride = (uint8_t)stride;
    ring->count = count_of_sensors;
    ring->oldest = NOBODY;
    ring->emit_at_us = now_us;
    ring->consecutive = 2;
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
    if (!is_verified(schedule) && window_us == 0) return EERUF_ERR_UNVERIFIED;
    if (t_delta_us == 0) t_delta_us = READ32(schedule->t_delta_us);
    if (window_us == 0) window_us = READ32(schedule->window_us);
    /* A table allows what it was verified for. */
    if (config->t_delta_us != 0 || config->window_us != 0) status = allows(schedule, t_delta_us, window_us);
    if (status != EERUF_OK) return status;
    set_up(ring, schedule, sensors, count_of_sensors, sizeof *sensors, now_us);
    status = listen(ring, t_delta_us, window_us, config->blanking_us);
    if (status != EERUF_OK) return status;
    if (config->audible_us > MAX_AUDIBLE) return EERUF_ERR_AUDIBLE;
    if (config->path_change_us >= AS_T_DELTA) return EERUF_ERR_PATH_CHANGE;
    ring->path_change_us = (uint16_t)config->path_change_us;
    if (config->path_change_us == 0) ring->path_change_us = narrow(READ32(schedule->path_change_us));
    ring->audible_us = config->audible_us;
    /* One that was not verified does not say it. */
    if (ring->audible_us == 0) ring->audible_us = READ32(schedule->audible_us);
    if (ring->audible_us == 0) ring->audible_us = READ32(schedule->period_us);
    ring->audible_us = shorter(ring->audible_us, MAX_AUDIBLE);
    disturb(ring);
    if (ring->watched == WATCHED) ring->watched = 0; /* nothing has been fired yet */
    ring->consecutive = config->consecutive;
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

/* True if a reading will be emitted without a further firing: one is pending or there is an oldest. In one byte, since
   two branches take more. */
static bool has_pending(const EerufRing *ring) {
    return (uint8_t)(ring->pending | (ring->oldest ^ NOBODY)) != 0;
}

/* When a sensor's last firing ends if there is no echo. */
static OUT_OF_LINE uint32_t closes_at(const EerufRing *ring, uint8_t x) {
    return sensor_of(ring, x)->fired_us[0] + longer(window_of(ring, x), ring->report_after_us);
}

/* Without a reading that can be emitted sooner, the next one comes when the window of the oldest closes. */
static OUT_OF_LINE void emit_when_oldest_ends(EerufRing *ring) {
    if (ring->pending == 0 && ring->oldest != NOBODY)
        ring->emit_at_us = closes_at(ring, ring->oldest);
}

/* Where windows differ, the oldest is the one whose window closes first. */
static OUT_OF_LINE void find_first_to_close(EerufRing *ring) {
    uint8_t x;
    ring->oldest = NOBODY;
    for (x = 0; x < ring->count; x++) {
        if (!(sensor_of(ring, x)->flags & LISTENING)) continue;
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
        find_first_to_close(ring);
        return;
    }
    before -= STEP_BACK;
    for (x = 0; x < ring->count; x++, sensor = after(sensor, STRIDE(ring))) {
        const uint32_t since = sensor->fired_us[0] - before;
        if ((sensor->flags & LISTENING) && since < soonest) {
            oldest = x;
            soonest = since;
        }
    }
    ring->oldest = oldest;
}

static void fire(EerufRing *ring, uint8_t sensor, uint32_t now_us, uint16_t late_us, bool hops) {
    EerufSensor *fired = sensor_of(ring, sensor);
    fired->flags = (uint8_t)(LISTENING | (ring->period & PERIOD) | (ring->unanswered & UNANSWERED));
#if EERUF_FIRINGS > 1
    if (!hops) {
        uint8_t place;
        for (place = EERUF_FIRINGS - 1; place > 0; place--) fired->fired_us[place] = fired->fired_us[place - 1];
    }
#endif
    fired->fired_us[0] = now_us;
    if (late_us != 0) fired_late(ring, late_us, hops);
    if (ring->oldest == NOBODY) {
        ring->oldest = sensor;
        emit_when_oldest_ends(ring);
    } else if (windows_differ(ring)) {
        find_first_to_close(ring);
        emit_when_oldest_ends(ring);
    }
    if (hops) {
        fire_hop(ring, sensor, now_us);
    } else {
        ring->last_fired_us = now_us;
        /* From now, not from when it was due: all that follows moves by as much as this firing is late. */
        ring->due_us = now_us;
        turn(ring);
    }
}

/* The kind of silence without a witness. */
static uint8_t unwitnessed(const EerufRing *ring) {
    return ring->unanswered & NO_FAULT ? EERUF_READING_NO_ECHO : EERUF_READING_UNANSWERED;
}

/* Ends a firing and compares its reading, which has its echo time already, with the one before. */
static void compare(EerufRing *ring, uint8_t x, int32_t change_us, EerufReading *reading) {
    EerufSensor *sensor = sensor_of(ring, x);
    EerufFilter *filter = &sensor->filter;
    const uint8_t flags = sensor->flags;
    if (flags & (STUCK | OUTSIDE)) forget(filter);
    reading->previous_us = filter->known_us;
    if (flags & STUCK) {
        reading->kind = EERUF_READING_STUCK;
    } else if (flags & OUTSIDE) {
        reading->kind = EERUF_READING_TOO_EARLY;
    } else if ((flags & UNANSWERED) && reading->t_echo_us == EERUF_NO_ECHO) {
        reading->kind = unwitnessed(ring);
        forget(filter);
        reading->previous_us = EERUF_NO_ECHO;
    } else {
        const uint32_t echo_us = reading->t_echo_us;
        const bool agreed = agrees(filter, t_delta_of(ring, x), echo_us, change_us);
#if EERUF_FIRINGS > 1
        /* The proof is about readings that differ by no more than t_delta. */
        if (agreed && (ring->watched != 0 || change_us != 0) && echo_us != EERUF_NO_ECHO)
            reading->explained_by = explanation(ring, x, filter->known_us, echo_us);
#endif
        reading->kind = push(filter, ring->consecutive, echo_us, agreed, reading->explained_by != EERUF_BY_NOTHING);
    }
    note_age(reading, filter);
}

/* The kind of a reading that the tracker weighs. */
static uint8_t kind_of_hop(const EerufRing *ring, uint8_t flags, bool silent) {
    if (flags & STUCK) return EERUF_READING_STUCK;
    if ((flags & UNANSWERED) && silent) return unwitnessed(ring);
    return flags & OUTSIDE ? EERUF_READING_TOO_EARLY : EERUF_READING_FIRST;
}

/* The phase of a table's period this many periods ago. */
static uint8_t phase_before(const EerufRing *ring, uint8_t ago) {
    const uint8_t phases = READ8(ring->schedule->phases);
    ago = (uint8_t)(ago % phases);
    return (uint8_t)(ring->phase >= ago ? ring->phase - ago : ring->phase + phases - ago);
}

static void emit_reading(EerufRing *ring, uint8_t x, const int32_t *change_us, EerufEvent *event, bool hops) {
    EerufSensor *sensor = sensor_of(ring, x);
    const uint8_t flags = sensor->flags, ago = (uint8_t)(ring->period - flags) & PERIOD;
    EerufReading *reading = &event->u.reading;
    if (flags & CAN_EMIT) ring->pending--; /* counted when its edge came */
    reading->t_echo_us = flags & STUCK ? EERUF_NO_ECHO : sensor->echo_us;
    reading->explained_by = EERUF_BY_NOTHING;
    sensor->echo_us = EERUF_NO_ECHO;
    if (flags & LISTENING) {
        if (hops) reading->kind = kind_of_hop(ring, flags, reading->t_echo_us == EERUF_NO_ECHO);
        else compare(ring, x, change_us == NULL ? 0 : change_us[x], reading);
        sensor->flags = flags & PERIOD;
        if (ring->oldest == x) find_oldest(ring, sensor->fired_us[0]);
    } else {
        reading->previous_us = EERUF_NO_ECHO;
        reading->age = sensor->filter.age;
        reading->kind = EERUF_READING_LATE;
        sensor->flags = (uint8_t)(flags & ~CAN_EMIT);
    }
    emit_when_oldest_ends(ring);
    if (!hops) count(ring, reading->kind);
    event->kind = EERUF_EVENT_READING;
    if (!hops) event->phase = phase_before(ring, ago);
    event->period -= ago;
}

static void end_period(EerufRing *ring, uint32_t now_us, uint32_t late_us, EerufEvent *event, bool hops) {
    EerufPeriod *ended = &event->u.ended;
    const bool differed = !hops && windows_differ(ring);
    bool changed = false;
    uint8_t kind;
    note_late(ring, narrow(late_us));
    event->kind = EERUF_EVENT_PERIOD;
    event->sensor = 0;
    ring->period++;
    if (hops) end_hopping_period(ring, now_us);
    else changed = end_period_of_table(ring, now_us, late_us);
    end_late_period(ring, ended, now_us, hops);
    if (changed) disturb(ring);
    /* Another schedule may allow other windows, also to firings under way. */
    if (!hops && (differed || windows_differ(ring))) {
        find_first_to_close(ring);
        emit_when_oldest_ends(ring);
    }
    for (kind = 0; kind < EERUF_READING_KINDS; kind++) {
        ended->tally[kind] = ring->tally[kind];
        ring->tally[kind] = 0;
    }
}

/* A sensor with a reading to emit, or NOBODY: the first with an echo in, or the oldest if it is time for that. */
static uint8_t next_pending(const EerufRing *ring, bool emits) {
    uint8_t x;
    if (ring->pending == 0) return emits ? ring->oldest : (uint8_t)NOBODY;
    if (ring->oldest != NOBODY && (sensor_of(ring, ring->oldest)->flags & CAN_EMIT)) return ring->oldest;
    for (x = 0; x < ring->count; x++)
        if (sensor_of(ring, x)->flags & CAN_EMIT) return x;
    return NOBODY;
}

static void restart(EerufRing *ring, uint32_t now_us, bool hops) {
    uint8_t x;
    /* Sound from before may still be heard, and its firings are no longer known by this clock. One that was said to
       fire a little later still does. */
    ring->known_from_us = now_us;
    for (x = 0; x < ring->count; x++) {
        const uint32_t fired_us = sensor_of(ring, x)->fired_us[0];
        if (!hops && fired_us - ring->known_from_us - 1u < STEP_BACK) ring->known_from_us = fired_us;
        drop_firing(ring, x, now_us);
    }
    if (hops) restart_hopping(ring, now_us);
    else restart_table(ring, now_us);
    ring->oldest = NOBODY;
    ring->pending = 0;
    disturb(ring);
}

/* Firing comes first, since it should be on time; but a sensor's reading is emitted before it fires again. */
static EerufStatus poll(EerufRing *ring, uint32_t now_us, const int32_t *change_us, EerufEvent *event, bool hops) {
    const uint32_t late_us = now_us - ring->due_us;
    const bool is_due = late_us < HALF_TURN, emits = has_pending(ring) && has_reached(now_us, ring->emit_at_us);
    uint8_t sensor = NOBODY;
    bool fires = false;
    if (event == NULL) return EERUF_ERR_NULL;
    if (!is_due && !emits) {
        /* The clock has jumped, or the ring was not polled for half a turn of it. */
        if (0u - late_us > (hops ? horizon_of_hopping(ring) : horizon_of_table(ring))) restart(ring, now_us, hops);
        return EERUF_OK;
    }
    if (is_due) sensor = ring->next;
    if (sensor == NOBODY) sensor = next_pending(ring, emits);
    else fires = !(sensor_of(ring, sensor)->flags & (LISTENING | CAN_EMIT));
    event->sensor = sensor;
    event->phase = ring->phase;
    event->period = ring->period;
    if (fires) {
        event->kind = EERUF_EVENT_FIRE;
        event->u.due_us = ring->due_us;
        fire(ring, sensor, now_us, narrow(late_us), hops);
    } else if (sensor != NOBODY) {
        emit_reading(ring, sensor, change_us, event, hops);
    } else {
        end_period(ring, now_us, late_us, event, hops);
    }
    return EERUF_EVENT;
}

/* A ring that fires by a table. */
static EerufStatus has_table(const EerufRing *ring) {
    const EerufStatus status = is_ready(ring);
    return status == EERUF_OK && HOPS(ring) ? (EerufStatus)EERUF_ERR_HOPPING : status;
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
    if (HOPS(ring)) return upcoming_hop(ring, number, sensor, due_us);
    phase = ring->phase;
    place = ring->following;
    next = ring->next;
    at_us = ring->due_us;
    goes_on = ring->next_schedule == NULL && !ring->paused;
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

/* An echo, which may be taken back until it has settled. */
static void hear(EerufRing *ring, uint8_t x, uint32_t at_us, uint32_t settled_us) {
    EerufSensor *sensor = sensor_of(ring, x);
    const uint32_t t_echo_us = at_us - sensor->fired_us[0];
    const uint8_t flags = sensor->flags;
    const bool inside = t_echo_us <= window_of(ring, x);
    if (t_echo_us >= HALF_TURN) return; /* from before it fired, or from a clock that has jumped */
    if (flags & LISTENING) {
        if (!inside) {
            count(ring, EERUF_READING_LATE);
            return;
        }
        if (t_echo_us < ring->blanking_us) {
            if (sensor->echo_us != EERUF_NO_ECHO) return;
            sensor->flags |= OUTSIDE;
            sensor->echo_us = t_echo_us;
            return;
        }
        sensor->flags = (uint8_t)((flags & ~OUTSIDE) | CAN_EMIT);
    } else {
        if (inside || (flags & OUTSIDE)) return;
        sensor->flags |= OUTSIDE | CAN_EMIT;
    }
    if ((flags & OUTSIDE) || t_echo_us < sensor->echo_us) sensor->echo_us = t_echo_us;
    if (flags & CAN_EMIT) return;
    if (!has_pending(ring) || !has_reached(settled_us, ring->emit_at_us)) ring->emit_at_us = settled_us;
    ring->pending++;
}

/* Takes back an echo whose reading has not been emitted yet. */
static void unhear(EerufRing *ring, uint8_t x) {
    EerufSensor *sensor = sensor_of(ring, x);
    if ((sensor->flags & (LISTENING | CAN_EMIT)) != (LISTENING | CAN_EMIT)) return;
    sensor->flags = (uint8_t)(sensor->flags & ~CAN_EMIT);
    sensor->echo_us = EERUF_NO_ECHO;
    ring->pending--;
    emit_when_oldest_ends(ring);
}

EerufStatus eeruf_ring_echo(EerufRing *ring, uint8_t sensor, uint32_t at_us) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) hear(ring, sensor, at_us, at_us);
    return status;
}

/* True if a sensor may have fired at another instant than it was polled for: after its firing before. */
static bool may_have_fired(const EerufRing *ring, const EerufSensor *sensor, uint32_t at_us) {
    (void)ring;
    if (HOPS(ring)) return has_reached(at_us, sensor->fired_us[0]);
#if EERUF_FIRINGS > 1
    return at_us - sensor->fired_us[1] - 1u < HALF_TURN - 1u;
#else
    return true;
#endif
}

EerufStatus eeruf_ring_fired(EerufRing *ring, uint8_t x, uint32_t at_us) {
    const EerufStatus status = has_sensor(ring, x);
    EerufSensor *sensor;
    uint32_t polled_us, later_us;
    if (status != EERUF_OK) return status;
    sensor = sensor_of(ring, x);
    polled_us = sensor->fired_us[0];
    later_us = at_us - polled_us;
    if (later_us == 0 || !may_have_fired(ring, sensor, at_us)) return EERUF_OK;
    sensor->fired_us[0] = at_us;
    /* The reading of a firing that has ended is with the filter. */
    if (!(sensor->flags & LISTENING) && !shift(&sensor->filter.known_us, later_us)) forget(&sensor->filter);
    /* Where the first edge came before it fired, it may have kept out the echo. */
    if (!shift(&sensor->echo_us, later_us)) sensor->flags |= OUTSIDE;
    if (sensor->flags & LISTENING) {
        if (later_us < HALF_TURN) {
#if EERUF_HOPPING
            if (HOPS(ring)) ring->hook(ring, x, later_us);
#endif
            if (!HOPS(ring)) {
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
#if EERUF_HOPPING
    if (HOPS(ring) && !has_reached(ring->last_fired_us, at_us)) ring->last_fired_us = at_us;
#endif
    disturb(ring);
    return EERUF_OK;
}

uint32_t eeruf_ring_fired_at(const EerufRing *ring, uint8_t sensor) {
    return has_sensor(ring, sensor) == EERUF_OK ? sensor_of(ring, sensor)->fired_us[0] : 0;
}

static void note(EerufSensor *sensor, uint8_t flag) {
    if (sensor->flags & LISTENING) sensor->flags |= flag;
}

EerufStatus eeruf_ring_stuck(EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) note(sensor_of(ring, sensor), STUCK);
    return status;
}

EerufStatus eeruf_ring_set_silence(EerufRing *ring, uint8_t silence) {
    const EerufStatus status = is_ready(ring);
    if (status != EERUF_OK) return status;
    if (silence > EERUF_SILENCE_TRUSTED) return EERUF_ERR_RANGE;
    ring->unanswered = silence == EERUF_SILENCE_TRUSTED ? 0 : UNANSWERED;
    if (silence != EERUF_SILENCE_NEEDS_ANSWER) ring->unanswered |= NO_FAULT;
    return EERUF_OK;
}

static void note_answer(EerufSensor *sensor) {
    sensor->flags = (uint8_t)(sensor->flags & ~UNANSWERED);
}

EerufStatus eeruf_ring_answered(EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) note_answer(sensor_of(ring, sensor));
    return status;
}

EerufStatus eeruf_ring_unanswered(EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) note(sensor_of(ring, sensor), UNANSWERED);
    return status;
}

EerufStatus eeruf_ring_measured(EerufRing *ring, uint8_t sensor, uint32_t t_echo_us) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status != EERUF_OK) return status;
    if (t_echo_us == EERUF_NO_ECHO) note_answer(sensor_of(ring, sensor));
    else {
        t_echo_us += sensor_of(ring, sensor)->fired_us[0];
        hear(ring, sensor, t_echo_us, t_echo_us);
    }
    return EERUF_OK;
}

static void forget_readings(EerufRing *ring, uint8_t sensor) {
    forget(&sensor_of(ring, sensor)->filter);
#if EERUF_HOPPING
    if (HOPS(ring)) ring->hook(ring, sensor, 0);
#endif
}

EerufStatus eeruf_ring_forget(EerufRing *ring, uint8_t sensor) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status == EERUF_OK) forget_readings(ring, sensor);
    return status;
}

bool eeruf_ring_is_enabled(const EerufRing *ring, uint8_t sensor) {
    return has_sensor(ring, sensor) == EERUF_OK && !(sensor_of(ring, sensor)->filter.state & DISABLED);
}

static void enable(EerufRing *ring, uint8_t sensor, bool enabled) {
    EerufFilter *filter = &sensor_of(ring, sensor)->filter;
    if (!enabled) {
        filter->state |= DISABLED;
    } else if (filter->state & DISABLED) {
        filter->state = 0;
        filter->known_us = EERUF_NO_ECHO;
        disturb(ring);
    }
}

EerufStatus eeruf_ring_enable(EerufRing *ring, uint8_t sensor, bool enabled) {
    const EerufStatus status = has_sensor(ring, sensor);
    if (status != EERUF_OK) return status;
    if (HOPS(ring)) return EERUF_ERR_HOPPING;
    enable(ring, sensor, enabled);
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
    if (status == EERUF_OK) restart(ring, now_us, false);
    return status;
}

/* The hook of a ring that changes its schedule at the end of the period, and has been silent for `settling` by then if
   it may go on. */
static void change_now(EerufRing *ring, uint8_t unused, uint32_t settling) {
    const EerufSchedule *next = ring->next_schedule;
    const uint32_t min_interval = is_verified(next) ? READ32(next->min_interval_us) : 0;
    const uint32_t settled = ring->last_fired_us + longer(settling, min_interval);
    (void)unused;
    if (has_reached(settled, ring->due_us)) ring->due_us = settled;
    ring->schedule_before = ring->schedule;
    ring->schedule = next;
    ring->next_schedule = NULL;
    ring->hook = NULL;
}

static EerufStatus change(EerufRing *ring, const EerufSchedule *schedule, bool verified) {
    EerufStatus status = is_ready(ring);
    if (status == EERUF_OK) status = schedule_is_usable(schedule);
    if (status != EERUF_OK) return status;
    if (verified && !is_verified(schedule)) return EERUF_ERR_UNVERIFIED;
    if (HOPS(ring)) return EERUF_ERR_HOPPING;
    if (READ8(schedule->sensors) != ring->count) return EERUF_ERR_SENSORS;
    if (READ8(schedule->phases) != READ8(ring->schedule->phases)) return EERUF_ERR_PHASES;
    status = allows(schedule, ring->t_delta_us, ring->window_us);
    if (status == EERUF_OK)
        status = can_hear(schedule, ring->count, ring->t_delta_us, ring->window_us, ring->blanking_us);
    if (status != EERUF_OK) return status;
    ring->next_schedule = schedule;
    ring->hook = change_now;
    return EERUF_OK;
}

EerufStatus eeruf_ring_change_schedule(EerufRing *ring, const EerufSchedule *schedule) {
    return change(ring, schedule, true);
}

EerufStatus eeruf_ring_change_to_unverified(EerufRing *ring, const EerufSchedule *schedule) {
    return change(ring, schedule, false);
}

/* No sensor fires again within this time. */
static uint32_t least_refire(const EerufRing *ring) {
#if EERUF_HOPPING
    if (HOPS(ring)) return ((const EerufHoppingRing *)(const void *)ring)->rest_us;
#endif
    return READ32(ring->schedule->min_refire_us);
}

/* With one of the three changed. */
static EerufStatus relisten(EerufRing *ring, uint32_t t_delta_us, uint32_t window_us, uint32_t blanking_us) {
    EerufStatus status;
    if (HOPS(ring)) return EERUF_ERR_HOPPING;
    status = allows(ring->schedule, t_delta_us, window_us);
    if (status == EERUF_OK && ring->next_schedule != NULL)
        status = allows(ring->next_schedule, t_delta_us, window_us);
    return status == EERUF_OK ? listen(ring, t_delta_us, window_us, blanking_us) : status;
}

EerufStatus eeruf_ring_set_t_delta(EerufRing *ring, uint32_t t_delta_us) {
    EerufStatus status = is_ready(ring);
    if (status == EERUF_OK) status = relisten(ring, t_delta_us, ring->window_us, ring->blanking_us);
    if (status == EERUF_OK) disturb(ring);
    return status;
}

EerufStatus eeruf_ring_set_window(EerufRing *ring, uint32_t window_us) {
    EerufStatus status = is_ready(ring);
    if (status == EERUF_OK) status = relisten(ring, ring->t_delta_us, window_us, ring->blanking_us);
    if (status == EERUF_OK && windows_differ(ring)) find_first_to_close(ring);
    if (status == EERUF_OK) emit_when_oldest_ends(ring);
    return status;
}

EerufStatus eeruf_ring_set_blanking(EerufRing *ring, uint32_t blanking_us) {
    const EerufStatus status = is_ready(ring);
    return status == EERUF_OK ? relisten(ring, ring->t_delta_us, ring->window_us, blanking_us) : status;
}

EerufStatus eeruf_ring_set_report_after(EerufRing *ring, uint32_t report_after_us) {
    const EerufStatus status = is_ready(ring);
    if (status != EERUF_OK) return status;
    if (report_after_us > least_refire(ring)) return EERUF_ERR_WINDOW;
    ring->report_after_us = report_after_us;
    if (windows_differ(ring)) find_first_to_close(ring);
    emit_when_oldest_ends(ring);
    return EERUF_OK;
}

EerufStatus eeruf_ring_set_path_change(EerufRing *ring, uint32_t path_change_us) {
    const EerufStatus status = has_table(ring);
    if (status != EERUF_OK) return status;
    if (path_change_us >= AS_T_DELTA) return EERUF_ERR_PATH_CHANGE;
    ring->path_change_us = (uint16_t)path_change_us;
    disturb(ring);
    return EERUF_OK;
}

EerufStatus eeruf_ring_set_audible(EerufRing *ring, uint32_t audible_us) {
    const EerufStatus status = has_table(ring);
    if (status != EERUF_OK) return status;
    if (audible_us > MAX_AUDIBLE) return EERUF_ERR_AUDIBLE;
    ring->audible_us = audible_us;
    disturb(ring);
    return EERUF_OK;
}

/* ---- The state before each sensor ---- */

/* In one byte: the state, why nothing is known, whether the last reading was silence, and whether it did not confirm. */
#define KNOWN 0x07u
#define WHY_AT 3u
#define SILENT 0x40u
#define DOUBTED 0x80u

const char *eeruf_state_name(uint8_t kind) {
    switch (kind) {
    case EERUF_STATE_UNKNOWN: return "unknown";
    case EERUF_STATE_OBSTACLE: return "obstacle";
    case EERUF_STATE_CLEAR: return "clear";
    case EERUF_STATE_TOO_CLOSE: return "too close";
    case EERUF_STATE_UNANSWERED: return "unanswered";
    default: return "?";
    }
}

EerufStatus eeruf_watch_init(EerufWatch *watch, size_t watch_size, EerufWatched *sensors, size_t sensors_size,
                             uint32_t now_us) {
    const size_t count_of_sensors = sensors_size / sizeof *sensors;
    uint8_t x;
    if (watch == NULL || sensors == NULL) return EERUF_ERR_NULL;
    if (watch_size != sizeof *watch) return EERUF_ERR_MEMORY;
    if (count_of_sensors - 1u >= EERUF_MAX_SENSORS) return EERUF_ERR_SENSORS;
    watch->sensors = sensors;
    watch->count = (uint8_t)count_of_sensors;
    memset(sensors, 0, sensors_size);
    for (x = 0; x < watch->count; x++) sensors[x].at_us = now_us;
    watch->ready = READY;
    return EERUF_OK;
}

/* The state that a reading shows, with EERUF_STATE_UNKNOWN why; NOBODY for a reading after the one of its firing. */
static uint8_t state_by(const EerufReading *reading) {
    switch (reading->kind) {
    case EERUF_READING_ACCEPTED:
    case EERUF_READING_TENTATIVE: return EERUF_STATE_OBSTACLE;
    case EERUF_READING_CLEAR: return EERUF_STATE_CLEAR;
    case EERUF_READING_TOO_EARLY: return EERUF_STATE_TOO_CLOSE;
    case EERUF_READING_STUCK:
    case EERUF_READING_UNANSWERED: return EERUF_STATE_UNANSWERED;
    case EERUF_READING_LATE: return NOBODY;
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
        /* One echo may be missed, or another's heard. */
        sensor->state = (uint8_t)(sensor->state | DOUBTED | (state & SILENT));
        return;
    }
    sensor->state = state;
    sensor->explained_by = reading->explained_by;
    /* For how long nothing is known or answered goes on. */
    if ((state & KNOWN) == known && (known == EERUF_STATE_UNKNOWN || known == EERUF_STATE_UNANSWERED)) return;
    sensor->at_us = now_us;
    sensor->t_echo_us = reading->t_echo_us;
}

EerufStatus eeruf_watch_event(EerufWatch *watch, const EerufEvent *event, uint32_t now_us) {
    uint8_t x;
    if (watch == NULL || event == NULL) return EERUF_ERR_NULL;
    if (watch->ready != READY) return EERUF_ERR_NOT_READY;
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

/* (a b + add) / d, rounded down, where add < d; stops at UINT32_MAX. In 32 bits, since a division of 64 costs a small
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

uint32_t eeruf_echo_time_us(uint32_t distance_mm, uint32_t c_mm_s) {
    return c_mm_s == 0 ? UINT32_MAX : multiply_divide(distance_mm, 2000000u, c_mm_s / 2, c_mm_s);
}

/* ---- Adaptation ---- */

/* With settings of ours, on the first rung. */
static IN_LINE void begin_adaptation(EerufAdaptation *adaptation, const void *ladder, uint8_t rungs, uint16_t ready) {
    memset(adaptation, 0, sizeof *adaptation);
    adaptation->ladder = ladder;
    adaptation->rungs = rungs;
    adaptation->noisy_permille = 300;
    adaptation->calm_permille = 100;
    adaptation->window = 16;
    adaptation->patience = 4;
    adaptation->rejection_permille = UINT16_MAX;
    adaptation->ready = ready;
}

EerufStatus eeruf_adaptation_init(EerufAdaptation *adaptation, size_t adaptation_size,
                                  const EerufSchedule *const *ladder, uint8_t rungs) {
    uint8_t rung;
    if (adaptation == NULL || ladder == NULL) return EERUF_ERR_NULL;
    if (adaptation_size != sizeof *adaptation) return EERUF_ERR_MEMORY;
    if (rungs == 0) return EERUF_ERR_LADDER;
    for (rung = 0; rung < rungs; rung++) {
        const EerufStatus status = schedule_is_usable(ladder[rung]);
        if (status != EERUF_OK) return status;
        if (!is_verified(ladder[rung])) return EERUF_ERR_UNVERIFIED;
        if (rung == 0) continue;
        if (READ32(ladder[rung]->period_us) <= READ32(ladder[rung - 1]->period_us)) return EERUF_ERR_LADDER;
        if (READ8(ladder[rung]->sensors) != READ8(ladder[0]->sensors)) return EERUF_ERR_LADDER;
        if (READ8(ladder[rung]->phases) != READ8(ladder[0]->phases)) return EERUF_ERR_LADDER;
    }
    begin_adaptation(adaptation, ladder, rungs, READY);
    return EERUF_OK;
}

/* The rung for the window that has just ended. One in which nothing was compared is neither noisy nor calm. */
static IN_LINE uint8_t next_rung(EerufAdaptation *adaptation) {
    const uint16_t rate = adaptation->rejection_permille;
    const uint8_t rung = adaptation->rung;
    if (rate != UINT16_MAX && rate <= adaptation->noisy_permille && rate <= adaptation->calm_permille) {
        if (adaptation->calm_windows < UINT8_MAX) adaptation->calm_windows++;
        return adaptation->calm_windows >= adaptation->patience && rung > 0 ? (uint8_t)(rung - 1u) : rung;
    }
    adaptation->calm_windows = 0;
    if (rate == UINT16_MAX || rate <= adaptation->noisy_permille) return rung;
    return rung + 1u < adaptation->rungs ? (uint8_t)(rung + 1u) : rung;
}

/* Takes in the end of a period: EERUF_EVENT, and the rung, if the ring should change to another. */
static IN_LINE EerufStatus take_period(EerufAdaptation *adaptation, const EerufRing *ring, const EerufEvent *event,
                               uint16_t ready, uint8_t *rung) {
    EerufStatus status;
    uint32_t compared;
    if (adaptation == NULL || event == NULL) return EERUF_ERR_NULL;
    if (adaptation->ready != ready) return EERUF_ERR_NOT_READY;
    status = is_ready(ring);
    if (status != EERUF_OK) return status;
    if (event->kind != EERUF_EVENT_PERIOD) return EERUF_ERR_RANGE;
    adaptation->accepted = add16(adaptation->accepted, event->u.ended.tally[EERUF_READING_ACCEPTED]);
    adaptation->rejected = add16(adaptation->rejected, event->u.ended.tally[EERUF_READING_REJECTED]);
    adaptation->rejected = add16(adaptation->rejected, event->u.ended.tally[EERUF_READING_AMBIGUOUS]);
    adaptation->repeated = add16(adaptation->repeated, event->u.ended.tally[EERUF_READING_REPEATED]);
    if (adaptation->periods < UINT8_MAX) adaptation->periods++;
    if (adaptation->periods < adaptation->window) return EERUF_OK;
    adaptation->periods = 0;
    compared = (uint32_t)adaptation->accepted + adaptation->rejected + adaptation->repeated;
    adaptation->rejection_permille = UINT16_MAX;
    if (compared > 0) adaptation->rejection_permille = (uint16_t)(1000 * (uint32_t)adaptation->rejected / compared);
    adaptation->accepted = adaptation->rejected = adaptation->repeated = 0;
    *rung = next_rung(adaptation);
    if (*rung == adaptation->rung) return EERUF_OK;
    adaptation->calm_windows = 0;
    return EERUF_EVENT;
}

EerufStatus eeruf_adaptation_period(EerufAdaptation *adaptation, EerufRing *ring, const EerufEvent *event) {
    uint8_t rung = 0;
    EerufStatus status = take_period(adaptation, ring, event, READY, &rung);
    if (status != EERUF_EVENT) return status;
    status = eeruf_ring_change_schedule(ring, ((const EerufSchedule *const *)adaptation->ladder)[rung]);
    if (status != EERUF_OK) return status;
    adaptation->rung = rung;
    return EERUF_EVENT;
}

uint32_t eeruf_schedule_max_speed_mm_s(const EerufSchedule *schedule, uint32_t t_delta_us, uint32_t c_mm_s) {
    uint32_t most = 0;
    uint8_t sensor, phase;
    if (schedule_is_usable(schedule) != EERUF_OK) return 0;
    for (sensor = 0; sensor < READ8(schedule->sensors); sensor++)
        for (phase = 0; phase < READ8(schedule->phases); phase++) most = longer(most, refire(schedule, phase, sensor));
    return most == 0 ? 0 : multiply_divide(t_delta_us, c_mm_s, 0, 2 * most);
}

/* ---- Edges ---- */

#if defined(__GNUC__)
#define FENCE() __atomic_thread_fence(__ATOMIC_SEQ_CST) /* on one core no more than an order for the compiler */
#else
#define FENCE() ((void)0)
#endif

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

EerufStatus eeruf_edges_push(EerufEdges *edges, uint8_t sensor, bool high, uint32_t at_us) {
    uint8_t pushed;
    EerufEdge *place;
    if (edges == NULL) return EERUF_ERR_NULL;
    if (edges->ready != READY) return EERUF_ERR_NOT_READY;
    if (sensor > 127) return EERUF_ERR_SENSOR;
    pushed = edges->pushed;
    if ((uint8_t)(pushed - edges->popped) > edges->mask) {
        edges->lost = (uint8_t)(edges->lost + 1u);
        return EERUF_ERR_MEMORY;
    }
    place = &edges->places[pushed & edges->mask];
    place->at_us = at_us;
    place->sensor = sensor;
    place->high = high;
    FENCE();
    edges->pushed = (uint8_t)(pushed + 1u);
    return EERUF_OK;
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

/* The state of a line, in one byte: where its pulse is, what is wrong with this firing, and the module's health. */
#define PULSE 0x03u
#define IDLE 0x00u /* nothing is expected */
#define AWAITED 0x01u
#define ROSE 0x02u
#define OVER 0x03u
#define FLAW 0x0cu
#define CHATTERED 0x04u
#define LOST_EDGE 0x08u
#define HEALTH_AT 4u

const char *eeruf_health_name(uint8_t health) {
    switch (health) {
    case EERUF_HEALTH_WELL: return "well";
    case EERUF_HEALTH_MISSING: return "missing";
    case EERUF_HEALTH_STUCK_HIGH: return "stuck high";
    case EERUF_HEALTH_CHATTERS: return "chatters";
    case EERUF_HEALTH_LOSES_EDGES: return "loses edges";
    case EERUF_HEALTH_PIN_ERROR: return "pin error";
    default: return "?";
    }
}

static void set_bits(EerufLine *line, uint8_t mask, uint8_t bits) {
    line->state = (uint8_t)((line->state & ~mask) | bits);
}

static void set_health(EerufLine *line, uint8_t health) {
    set_bits(line, 0xf0u, (uint8_t)(health << HEALTH_AT));
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
    /* A line that does not rise is no free space. */
    return eeruf_ring_set_silence(ring, EERUF_SILENCE_NEEDS_ANSWER);
}

/* The health by the last firing, before the next trigger. */
static uint8_t end_firing(EerufLine *line, uint8_t missing_after) {
    const uint8_t state = line->state, pulse = state & PULSE, flaw = state & FLAW;
    if (pulse == AWAITED && flaw == 0) {
        if (line->silent < UINT8_MAX) line->silent++;
        if (line->silent >= missing_after) return EERUF_HEALTH_MISSING;
    } else if (pulse == ROSE) {
        /* If the line is still high it is stuck, as will be seen. */
        return EERUF_HEALTH_LOSES_EDGES;
    } else if (pulse != IDLE) {
        /* A pulse may follow what was taken for the end of one whose beginning was too soon after the trigger. */
        if (flaw == 0 || (pulse == OVER && flaw == LOST_EDGE)) return EERUF_HEALTH_WELL;
        return flaw == CHATTERED ? EERUF_HEALTH_CHATTERS : EERUF_HEALTH_LOSES_EDGES;
    }
    return (uint8_t)(state >> HEALTH_AT);
}

/* A firing begins; without health the line is well. */
static EerufStatus begin_firing(EerufHcSr04 *modules, uint8_t sensor, uint8_t health) {
    const EerufStatus status = has_line(modules, sensor);
    EerufLine *line;
    uint8_t ended;
    if (status != EERUF_OK) return status;
    line = &modules->lines[sensor];
    if ((line->state & PULSE) == ROSE) {
        if (health == EERUF_HEALTH_STUCK_HIGH &&
            sensor_of(modules->ring, sensor)->fired_us[0] - line->rose_us <= modules->settings->longest_hold_us) {
            /* It has heard nothing of an earlier trigger yet: nothing is in range. */
            note_answer(sensor_of(modules->ring, sensor));
            return EERUF_DO_NOT_TRIGGER;
        }
        /* A pulse that began and never ended: an edge got lost, and what counted as silence may have been an echo. */
        if (health == EERUF_HEALTH_WELL) forget_readings(modules->ring, sensor);
    }
    ended = end_firing(line, modules->settings->missing_after);
    if (health == EERUF_HEALTH_WELL) {
        line->state = (uint8_t)((uint8_t)(ended << HEALTH_AT) | AWAITED);
        return EERUF_OK;
    }
    line->state = (uint8_t)((uint8_t)(health << HEALTH_AT) | IDLE);
    note(sensor_of(modules->ring, sensor), STUCK);
    return EERUF_DO_NOT_TRIGGER;
}

EerufStatus eeruf_hc_sr04_fire(EerufHcSr04 *modules, uint8_t sensor, bool line_is_high) {
    return begin_firing(modules, sensor, line_is_high ? EERUF_HEALTH_STUCK_HIGH : EERUF_HEALTH_WELL);
}

bool eeruf_hc_sr04_is_stuck(const EerufHcSr04 *modules, uint8_t sensor) {
    uint8_t state;
    if (has_line(modules, sensor) != EERUF_OK) return false;
    state = modules->lines[sensor].state;
    return (state & PULSE) == IDLE && state >> HEALTH_AT == EERUF_HEALTH_STUCK_HIGH;
}

EerufStatus eeruf_hc_sr04_triggered(EerufHcSr04 *modules, uint8_t sensor) {
    const EerufStatus status = has_line(modules, sensor);
    const EerufLine *line;
    if (status != EERUF_OK) return status;
    line = &modules->lines[sensor];
    /* A module that holds its line does not hear a trigger; one that has long held it has lost its end. */
    if ((line->state & PULSE) == ROSE &&
        sensor_of(modules->ring, sensor)->fired_us[0] - line->rose_us <= modules->settings->longest_hold_us)
        return EERUF_OK;
    return begin_firing(modules, sensor, EERUF_HEALTH_WELL);
}

EerufStatus eeruf_hc_sr04_cannot_read(EerufHcSr04 *modules, uint8_t sensor) {
    return begin_firing(modules, sensor, EERUF_HEALTH_PIN_ERROR);
}

EerufStatus eeruf_hc_sr04_cannot_write(EerufHcSr04 *modules, uint8_t sensor) {
    const EerufStatus status = has_line(modules, sensor);
    if (status == EERUF_OK) set_health(&modules->lines[sensor], EERUF_HEALTH_PIN_ERROR);
    return status;
}

OUT_OF_LINE EerufStatus eeruf_hc_sr04_edge(EerufHcSr04 *modules, uint8_t sensor, bool high, uint32_t at_us) {
    const EerufStatus status = has_line(modules, sensor);
    EerufLine *line;
    uint32_t fired_us, since_us, width_us;
    uint8_t pulse;
    if (status != EERUF_OK) return status;
    line = &modules->lines[sensor];
    fired_us = sensor_of(modules->ring, sensor)->fired_us[0];
    since_us = at_us - fired_us;
    if (since_us >= HALF_TURN || since_us < modules->settings->deaf_us) return EERUF_OK;
    pulse = line->state & PULSE;
    if (pulse == AWAITED) {
        line->silent = 0;
        if (high && since_us > modules->settings->latest_rise_us) {
            set_bits(line, FLAW, CHATTERED);
        } else if (high) {
            set_bits(line, PULSE, ROSE);
            line->rose_us = at_us;
            note_answer(sensor_of(modules->ring, sensor));
        } else if ((line->state & FLAW) == 0) {
            set_bits(line, FLAW, LOST_EDGE);
        }
    } else if (pulse == ROSE && high && !has_reached(line->rose_us, fired_us)) {
        /* The end of a pulse that began before this firing got lost: what counted as silence may have been an echo. */
        set_health(line, EERUF_HEALTH_LOSES_EDGES);
        line->rose_us = at_us;
        forget_readings(modules->ring, sensor);
        note_answer(sensor_of(modules->ring, sensor));
    } else if (pulse == ROSE && !high) {
        width_us = at_us - line->rose_us;
        if (width_us < modules->settings->shortest_us) {
            line->state = (uint8_t)((line->state & ~(PULSE | FLAW)) | AWAITED | CHATTERED);
            note(sensor_of(modules->ring, sensor), UNANSWERED);
            return EERUF_OK;
        }
        set_bits(line, PULSE, OVER);
        line->width_us = (uint16_t)(width_us > UINT16_MAX ? 0 : width_us);
        if (width_us < modules->settings->longest_us)
            hear(modules->ring, sensor, fired_us + width_us, at_us + modules->settings->shortest_us);
    } else if (pulse == OVER && high) {
        set_bits(line, FLAW, CHATTERED);
        if (line->width_us == 0 || at_us - line->rose_us - line->width_us >= modules->settings->shortest_us)
            return EERUF_OK;
        /* A gap as short as that is a disturbance: the pulse goes on. */
        set_bits(line, PULSE, ROSE);
        unhear(modules->ring, sensor);
    }
    return EERUF_OK;
}

EerufStatus eeruf_hc_sr04_edges_until(EerufHcSr04 *modules, EerufEdges *edges, uint32_t until_us) {
    if (edges == NULL) return EERUF_ERR_NULL;
    if (edges->ready != READY) return EERUF_ERR_NOT_READY;
    while (edges->popped != edges->pushed) {
        EerufEdge edge;
        FENCE();
        if (!has_reached(until_us, edges->places[edges->popped & edges->mask].at_us)) break;
        (void)eeruf_edges_pop(edges, &edge);
        (void)eeruf_hc_sr04_edge(modules, edge.sensor, edge.high, edge.at_us);
    }
    return has_line(modules, 0);
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
    line->width_us = 0;
    return eeruf_ring_measured(modules->ring, sensor,
                               width_us < modules->settings->longest_us ? width_us : EERUF_NO_ECHO);
}

EerufStatus eeruf_hc_sr04_edges(EerufHcSr04 *modules, EerufEdges *edges) {
    EerufEdge edge;
    EerufStatus status;
    if (modules == NULL) return EERUF_ERR_NULL;
    if (modules->ready != READY) return EERUF_ERR_NOT_READY;
    while ((status = eeruf_edges_pop(edges, &edge)) == EERUF_OK)
        /* An edge of a line that the ring does not have is ignored. */
        (void)eeruf_hc_sr04_edge(modules, edge.sensor, edge.high, edge.at_us);
    return status == EERUF_EMPTY ? (EerufStatus)EERUF_OK : status;
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

EerufStatus eeruf_hc_sr04_change_schedule(EerufHcSr04 *modules, const EerufSchedule *schedule) {
    EerufStatus status = has_line(modules, 0);
    if (status == EERUF_OK) status = schedule_is_usable(schedule);
    if (status == EERUF_OK) status = allows_retrigger(modules->settings, READ32(schedule->min_refire_us));
    return status == EERUF_OK ? eeruf_ring_change_schedule(modules->ring, schedule) : status;
}

uint8_t eeruf_hc_sr04_health(const EerufHcSr04 *modules, uint8_t sensor) {
    if (has_line(modules, sensor) != EERUF_OK) return EERUF_HEALTH_MISSING;
    return (uint8_t)(modules->lines[sensor].state >> HEALTH_AT);
}

#if EERUF_HOPPING
/* ---- Time hopping ---- */

/* The flags of a sensor's turn. */
#define HAS_FIRED 1u
#define SOLO 2u    /* its last firing was alone */
#define SETTLED 4u /* what it hears of its last firing moves as the code says, as far as lags are concerned */
/* The flags of a track. */
#define TRACK_CONFIRMED 1u
#define CONTRADICTED 2u
#define REMEMBERED 4u /* it was confirmed, and is again once it is supported */
#define REGAINED 2u   /* the least score of a track that is confirmed again */

static OUT_OF_LINE uint16_t less16(uint16_t one, uint16_t other) {
    return one > other ? (uint16_t)(one - other) : 0;
}

static uint16_t fewer16(uint16_t one, uint16_t other) {
    return one < other ? one : other;
}

#define CATCHES_UP_US 1000u /* a firing that is later moves all that follow */
#define ONE_SOLO 256u       /* what a solo period costs; as much again may be saved up */
#define LEAST_CHANGE_US 40  /* an expected change that tells how much of it there is */
#define WHOLE 64            /* as much more as is expected */
#define MOST_SURPLUS 80     /* two readings that show more are not of one echo */
#define UNKNOWN INT8_MIN    /* readings that show no surplus */
#define MOVING_VOTES 3u     /* for a tentative echo while odometry moves: any two readings are those of some wall */
#define MOVING_MEMORY 3u    /* and confirmed echoes are remembered for three times as long */
#define DRAWS 8u            /* lags that are drawn in search of one that keeps the neighbours' interval */

/* -- The tracker: which echo of a sensor is its own. A reading within t_delta of a track supports it, and only support
   from different phases counts. A later reading contradicts it; an earlier one hides it:
   docs/explanation/hopping.md. -- */

static OUT_OF_LINE uint32_t between(uint32_t one, uint32_t other) {
    return apart(one, other);
}

/* Echoes are below half a turn, so that silence is further from them than any setting allows. */
static bool is_within(uint32_t one, uint32_t other, uint16_t most) {
    return between(one, other) <= most;
}

static uint16_t phase_bit(uint8_t phase) {
    return (uint16_t)(1u << (phase & 15u));
}

static uint8_t votes_of(const EerufTrack *track) {
    uint16_t phases = track->phases;
    uint8_t votes = track->solo_votes;
    for (; phases != 0; phases &= (uint16_t)(phases - 1u)) votes++;
    return votes;
}

static void forget_track(EerufTrack *track) {
    memset(track, 0, sizeof *track);
    track->t_echo_us = EERUF_NO_ECHO;
    track->age = UINT8_MAX;
}

static void forget_tracks(EerufHopper *hopper) {
    uint8_t place;
    for (place = 0; place < EERUF_HYPOTHESES; place++) forget_track(&hopper->tracks[place]);
    hopper->surplus = 0;
    hopper->last_us = EERUF_NO_ECHO;
    hopper->observed = UNKNOWN;
}

/* Unconfirmed echoes cannot be compared with later ones. */
static void firing_changed(EerufHoppingRing *hopping) {
    uint8_t x, place;
    for (x = 0; x < hopping->ring.count; x++) {
        for (place = 0; place < EERUF_HYPOTHESES; place++) {
            EerufTrack *track = &hopping->hoppers[x].tracks[place];
            if (track->flags & TRACK_CONFIRMED) continue;
            track->phases = 0;
            track->close = 0;
            track->flags &= CONTRADICTED;
            if (track->score > 1) track->score = 1;
        }
    }
}

/* The earliest confirmed track; null if there is none. Silence is a track too, later than all others. */
static const EerufTrack *believed_of(const EerufHopper *hopper) {
    const EerufTrack *earliest = NULL;
    uint8_t place;
    for (place = 0; place < EERUF_HYPOTHESES; place++) {
        const EerufTrack *track = &hopper->tracks[place];
        if (!(track->flags & TRACK_CONFIRMED)) continue;
        if (earliest == NULL || track->t_echo_us < earliest->t_echo_us) earliest = track;
    }
    return earliest;
}

static void grow_older(EerufTrack *track) {
    if (track->age < UINT8_MAX) track->age++;
}

/* The last firing in this phase did not support it. One phase alone keeps no track confirmed. */
static void miss(EerufTrack *track, uint16_t phase, const EerufTrackerSettings *how) {
    track->phases &= (uint16_t)~phase;
    if (!(track->flags & TRACK_CONFIRMED) || votes_of(track) >= 2) return;
    track->flags &= (uint8_t)~TRACK_CONFIRMED;
    if (how->memory > 0) track->flags |= REMEMBERED;
}

/* Nothing speaks for it any more: it is gone, or remembered if it was confirmed. */
static void lose(EerufTrack *track, const EerufTrackerSettings *how) {
    if (!(track->flags & (TRACK_CONFIRMED | REMEMBERED)) || track->age >= how->memory) {
        /* Were it confirmed still, it would keep its place from all that come. */
        forget_track(track);
        return;
    }
    grow_older(track);
    track->phases = 0;
    track->score = 1;
    track->solo_votes = track->close = 0;
    track->flags = CONTRADICTED | REMEMBERED;
}

/* Moves a track towards an echo. */
static OUT_OF_LINE void follow(EerufTrack *track, uint32_t t_echo_us, uint32_t by_us) {
    track->t_echo_us += t_echo_us > track->t_echo_us ? by_us : 0u - by_us;
}

static void support(EerufTrack *track, uint32_t t_echo_us, uint16_t phase, bool solo, const EerufTrackerSettings *how) {
    const bool is_new = (track->phases & phase) == 0;
    const uint32_t distance = between(track->t_echo_us, t_echo_us);
    if (is_new && distance <= how->tentative_within_us && track->close < UINT8_MAX) track->close++;
    track->phases |= phase;
    if (solo && track->solo_votes < how->votes) track->solo_votes++;
    /* A path repeats itself in its own phase for ever, so that says nothing new of a track yet to be confirmed. */
    if (is_new || solo || (track->flags & TRACK_CONFIRMED)) {
        track->score = (uint8_t)(track->score + (solo ? 2u : 1u));
        if (track->score > how->score_limit) track->score = how->score_limit;
    }
    if ((track->flags & REMEMBERED) && track->age <= how->memory) {
        track->flags |= TRACK_CONFIRMED;
        if (track->score < REGAINED) track->score = REGAINED;
    }
    track->flags &= (uint8_t)~REMEMBERED;
    track->age = 0;
    /* A quarter of the way, so that one early or late edge does not move it far. */
    if (track->t_echo_us != EERUF_NO_ECHO) follow(track, t_echo_us, distance / 4);
    if (votes_of(track) >= how->votes && track->score >= how->votes) track->flags |= TRACK_CONFIRMED;
}

static void contradict(EerufTrack *track, uint16_t phase, bool solo, const EerufTrackerSettings *how) {
    const uint8_t weight = solo ? how->solo_contradiction : (track->flags & TRACK_CONFIRMED) ? how->contradiction : 1;
    if (track->score <= weight) {
        lose(track, how);
        return;
    }
    track->score = (uint8_t)(track->score - weight);
    track->flags |= CONTRADICTED;
    track->solo_votes = 0;
    grow_older(track);
    miss(track, phase, how);
}

/* True if one is replaced before the other. */
static bool ranks_below(const EerufTrack *one, const EerufTrack *other) {
    const uint8_t differs = one->flags ^ other->flags;
    if (differs & TRACK_CONFIRMED) return !(one->flags & TRACK_CONFIRMED);
    if (differs & REMEMBERED) return !(one->flags & REMEMBERED);
    return one->score != other->score ? one->score < other->score : one->age > other->age;
}

static uint8_t nearest_track(const EerufHopper *hopper, uint32_t t_echo_us, uint16_t t_delta_us) {
    uint8_t place, nearest = NOBODY;
    for (place = 0; place < EERUF_HYPOTHESES; place++) {
        const EerufTrack *track = &hopper->tracks[place];
        if (track->score == 0 || !is_within(track->t_echo_us, t_echo_us, t_delta_us)) continue;
        if (nearest == NOBODY ||
            between(track->t_echo_us, t_echo_us) < between(hopper->tracks[nearest].t_echo_us, t_echo_us))
            nearest = place;
    }
    return nearest;
}

static void begin_track(EerufHopper *hopper, uint32_t t_echo_us, uint16_t phase, bool solo) {
    EerufTrack *weakest = &hopper->tracks[0];
    uint8_t place;
    for (place = 1; place < EERUF_HYPOTHESES; place++)
        if (ranks_below(&hopper->tracks[place], weakest)) weakest = &hopper->tracks[place];
    weakest->t_echo_us = t_echo_us;
    weakest->phases = phase;
    weakest->score = solo ? 2 : 1;
    weakest->solo_votes = solo ? 1 : 0;
    weakest->close = 1;
    weakest->flags = 0;
    weakest->age = 0;
}

/* The reading has its kind and echo time already. */
static void end_weighing(EerufFilter *filter, EerufReading *reading) {
    if (reading->kind == EERUF_READING_ACCEPTED || reading->kind == EERUF_READING_TENTATIVE) filter->age = 0;
    else if (filter->age < EERUF_NEVER - 1u) filter->age++;
    reading->age = filter->age;
}

/* The tracks move with the robot, by the expected change and what there is more of it. */
static void shift_tracks(EerufHopper *hopper, int32_t change_us) {
    uint8_t place;
    if (change_us > INT16_MAX) change_us = INT16_MAX;
    if (change_us < INT16_MIN) change_us = INT16_MIN;
    change_us += change_us * hopper->surplus / WHOLE;
    for (place = 0; place < EERUF_HYPOTHESES; place++) {
        uint32_t *held = &hopper->tracks[place].t_echo_us;
        /* A time before the firing wraps, and is later than all. */
        const uint32_t moved_us = *held + (uint32_t)change_us;
        if (*held != EERUF_NO_ECHO && moved_us <= EERUF_HOPPING_MAX_WINDOW_US) *held = moved_us;
    }
}

/* The surplus that two consecutive readings of one echo show, or UNKNOWN. */
static int8_t surplus_of(uint32_t last_us, uint32_t t_echo_us, int32_t change_us) {
    int32_t surplus;
    if ((change_us < LEAST_CHANGE_US && change_us > -LEAST_CHANGE_US) || change_us > INT16_MAX ||
        change_us < -INT16_MAX || t_echo_us == EERUF_NO_ECHO || last_us == EERUF_NO_ECHO)
        return UNKNOWN;
    /* Times have 24 bits, the product 30. */
    surplus = WHOLE * ((int32_t)t_echo_us - (int32_t)last_us) / change_us - WHOLE;
    return surplus < -MOST_SURPLUS || surplus > MOST_SURPLUS ? UNKNOWN : (int8_t)surplus;
}

/* Two pairs of consecutive readings that change alike tell how much of the expected change there really is, whatever
   they support. Crosstalk changes otherwise from each phase to the next. */
static void learn(EerufHopper *hopper, uint32_t t_echo_us, int32_t change_us, uint16_t t_delta_us) {
    const int8_t observed = surplus_of(hopper->last_us, t_echo_us, change_us), before = hopper->observed;
    const uint32_t expected_us = change_us < 0 ? 0u - (uint32_t)change_us : (uint32_t)change_us;
    int16_t known = hopper->surplus, differs = (int16_t)(observed - before);
    hopper->last_us = t_echo_us;
    if (observed == UNKNOWN) return;
    hopper->observed = observed;
    if (before == UNKNOWN) return;
    if (differs < 0) differs = (int16_t)-differs;
    if ((uint32_t)differs * expected_us > (uint32_t)WHOLE * t_delta_us) return;
    known = (int16_t)(known + (observed - known) / 2);
    hopper->surplus = (int8_t)(known > WHOLE ? WHOLE : known < -WHOLE ? -WHOLE : known);
}

/* The settings of a robot that moves or stands. */
static EerufTrackerSettings for_motion(EerufTrackerSettings settings, bool moving) {
    const unsigned memory = settings.memory * (moving ? MOVING_MEMORY : 1u);
    settings.memory = (uint8_t)(memory > UINT8_MAX ? UINT8_MAX : memory);
    return settings;
}

static void weigh(EerufHoppingRing *hopping, uint8_t sensor, bool steady, int32_t change_us, EerufReading *reading) {
    const EerufTrackerSettings settings = for_motion(hopping->tracker, change_us != 0), *how = &settings;
    EerufHopper *hopper = &hopping->hoppers[sensor];
    const bool solo = (hopper->flags & SOLO) != 0;
    const uint32_t t_echo_us = reading->t_echo_us;
    const uint16_t phase = phase_bit(hopper->phase);
    const uint8_t votes = how->tentative_votes, least = change_us != 0 ? MOVING_VOTES : 0;
    const uint16_t t_delta_us = t_delta_of(&hopping->ring, sensor);
    const uint8_t nearest = nearest_track(hopper, t_echo_us, t_delta_us);
    const EerufTrack *believed = believed_of(hopper);
    /* A copy: the tracks move below. Without one no echo is as late. */
    const bool believes = believed != NULL;
    const uint32_t held_us = believes ? believed->t_echo_us : EERUF_NO_ECHO;
    const bool is_near = believes && is_within(held_us, t_echo_us, how->near_us);
    bool tentative = false, confirmed;
    EerufTrack *track = hopper->tracks;
    uint8_t place, kind;
    reading->previous_us = nearest != NOBODY ? track[nearest].t_echo_us : held_us;
    for (place = 0; place < EERUF_HYPOTHESES && steady; place++, track++) {
        if (track->score == 0) continue;
        if (place == nearest) {
            bool earlier;
            uint8_t close;
            support(track, t_echo_us, phase, solo, how);
            close = track->flags & CONTRADICTED ? 0 : track->close;
            earlier = (!believes || track->t_echo_us < held_us) && track->t_echo_us != EERUF_NO_ECHO;
            tentative = earlier && votes != 0 && (solo || close >= (votes < least ? least : votes));
        } else if (is_near && track->t_echo_us == held_us) {
            /* It follows an echo that moves faster than its support: three tenths of the way. */
            grow_older(track);
            follow(track, t_echo_us, between(held_us, t_echo_us) * 3 / 10);
        } else if (t_echo_us > track->t_echo_us) {
            contradict(track, phase, solo, how);
        } else {
            grow_older(track);
            if (track->flags & TRACK_CONFIRMED) miss(track, phase, how);
        }
    }
    if (steady && nearest == NOBODY && !is_near) {
        begin_track(hopper, t_echo_us, phase, solo);
        tentative = solo && votes != 0 && t_echo_us != EERUF_NO_ECHO;
    }
    believed = believed_of(hopper);
    confirmed = believed != NULL && is_within(believed->t_echo_us, t_echo_us, how->near_us);
    if (t_echo_us == EERUF_NO_ECHO) kind = confirmed ? EERUF_READING_CLEAR : EERUF_READING_NO_ECHO;
    else if (confirmed) kind = EERUF_READING_ACCEPTED;
    else if (tentative) kind = EERUF_READING_TENTATIVE;
    else kind = believes || nearest != NOBODY ? EERUF_READING_REJECTED : EERUF_READING_FIRST;
    reading->kind = kind;
}

/* -- Firing: each sensor at its lag plus the wait of the phase, and in a solo period one sensor alone -- */

static EerufHoppingRing *hopping_of(EerufRing *ring) {
    return (EerufHoppingRing *)(void *)ring;
}

static uint32_t code_width(const EerufHoppingRing *hopping) {
    return (hopping->cycle - 1u) * (uint32_t)hopping->step_us;
}

static bool is_prime(uint8_t number) {
    uint8_t divisor;
    for (divisor = 2; divisor * divisor <= number; divisor++)
        if (number % divisor == 0) return false;
    return number > 1;
}

/* The least primitive root of a prime. */
static uint8_t primitive_root(uint8_t prime) {
    uint8_t root = 1, power, order;
    for (;; root++) {
        for (power = root, order = 1; power != 1 && order < prime; order++) power = (uint8_t)(power * root % prime);
        if (order >= prime - 1u) return root;
    }
}

/* Welch's sequence: a place and one, times the root, modulo one more than the cycle, less one. */
static uint8_t times_root(uint8_t place, uint8_t root, uint8_t cycle) {
    uint8_t product = 0, left;
    for (left = root; left > 0; left--) {
        product = (uint8_t)((unsigned)product + place + 1u);
        if (product > cycle) product = (uint8_t)((unsigned)product - cycle - 1u);
    }
    return (uint8_t)(product - 1u);
}

/* The most by which two firings of a sensor are closer than a period, in steps. With Welch's sequence all go
   through the same places. */
static IN_LINE uint8_t drop_of(uint8_t sensor, uint8_t cycle, uint8_t root, uint8_t first) {
    uint8_t place, most = (uint8_t)((sensor + first) % cycle);
    if (root == 0) return most == 0 ? 0 : (uint8_t)(cycle - most);
    for (place = 0, most = 0; place < cycle; place++) {
        const uint8_t next = times_root(place, root, cycle);
        if (place > next && place - next > most) most = (uint8_t)(place - next);
    }
    return most;
}

/* The first of the sensors that one fires together with, or itself: they share its places in the code. */
static uint8_t leader_of(const EerufLimits *limits, uint8_t sensor) {
    uint8_t leader = 0;
    if (limits == NULL || READ8(limits[sensor].group) == 0) return sensor;
    while (READ8(limits[leader].group) != READ8(limits[sensor].group)) leader++;
    return leader;
}

/* Where a sensor is in Welch's sequence: each is a phase behind the one before it in the order of lags. */
static uint8_t welch_place(const EerufHoppingRing *hopping, uint8_t sensor) {
    const EerufHopper *hoppers = hopping->hoppers;
    uint8_t other, left = (uint8_t)(hopping->cycle + hopping->phase);
    uint8_t place = (uint8_t)(hopping->first - 1u);
    if (hopping->root == 0) return 0;
    sensor = leader_of(limits_of(OWN(&hopping->ring)), sensor);
    for (other = 0; other < hopping->ring.count; other++)
        if (hoppers[other].lag_us < hoppers[sensor].lag_us ||
            (hoppers[other].lag_us == hoppers[sensor].lag_us && other < sensor))
            left--;
    for (; left > 0; left--) place = times_root(place, hopping->root, hopping->cycle);
    return place;
}

static uint32_t times(uint16_t one, uint16_t other) {
    return (uint32_t)one * other;
}

/* When a sensor fires in this period, after its start, unless it is a solo period: within it. */
static OUT_OF_LINE uint32_t offset_of(const EerufHoppingRing *hopping, uint8_t sensor) {
    const EerufHopper *hopper = &hopping->hoppers[sensor];
    return hopper->lag_us + times(hopper->place, hopping->step_us);
}

/* The next phase. In a linear congruence a sensor's place is its multiplier times the phase, modulo the cycle; all are
   less than that, but for the multiplier, which is less than twice as much. */
static void next_phase(EerufHoppingRing *hopping) {
    const EerufLimits *limits = limits_of(OWN(&hopping->ring));
    const uint8_t cycle = hopping->cycle;
    uint8_t x;
    hopping->phase = hopping->phase + 1u < cycle ? (uint8_t)(hopping->phase + 1u) : 0;
    for (x = 0; x < hopping->ring.count; x++) {
        uint8_t place = (uint8_t)(leader_of(limits, x) + hopping->first);
        if (hopping->root != 0) {
            hopping->hoppers[x].place = times_root(hopping->hoppers[x].place, hopping->root, cycle);
            continue;
        }
        if (place >= cycle) place = (uint8_t)(place - cycle);
        place = (uint8_t)(place + hopping->hoppers[x].place);
        if (place >= cycle) place = (uint8_t)(place - cycle);
        hopping->hoppers[x].place = place;
    }
}

/* The next firing of the period, or its end. */
static void look_ahead(EerufHoppingRing *hopping) {
    uint32_t after_us = hopping->length_us - hopping->lead_us;
    hopping->ring.next = NOBODY;
    if (hopping->place < hopping->planned) {
        hopping->ring.next = hopping->hoppers[hopping->place].order;
        after_us = hopping->solo_at_us;
        if (after_us == EERUF_NO_ECHO) after_us = offset_of(hopping, hopping->ring.next);
    }
    hopping->ring.due_us = hopping->start_us + after_us;
}

/* Nothing that is heard across this moment moves as the code says. */
static void break_off(EerufHoppingRing *hopping) {
    hopping->least_late[0] = 0;
    hopping->most_late[0] = UINT16_MAX;
    hopping->changed = 1;
}

static void note_hop(EerufHoppingRing *hopping, uint16_t late_us) {
    if (late_us < hopping->least_late[0]) hopping->least_late[0] = late_us;
    if (late_us > hopping->most_late[0]) hopping->most_late[0] = late_us;
}

/* True if a firing this late differs from all others of three periods by no more than is tolerated. */
static bool is_steady(const EerufHoppingRing *hopping, uint16_t late_us) {
    uint8_t i;
    for (i = 0; i < 3; i++) {
        if (less16(late_us, hopping->least_late[i]) > hopping->tolerated) return false;
        if (less16(hopping->most_late[i], late_us) > hopping->tolerated) return false;
    }
    return true;
}

/* Time in the period at which so much time has passed since a firing, which may have been late past the end
   of its period. A clock that has jumped says nothing about when that was. */
static OUT_OF_LINE uint32_t wait_after(const EerufHoppingRing *hopping, uint32_t fired_us, uint32_t passes_us) {
    const uint32_t waits = fired_us + passes_us - hopping->start_us;
    return waits > HALF_TURN || waits > passes_us + CATCHES_UP_US ? 0 : waits;
}

/* Time after the start of the period before which a sensor must not fire, since it rests for `rest_us`. */
static uint32_t rests_for(const EerufHoppingRing *hopping, uint8_t sensor, uint32_t rest_us) {
    const EerufHopper *hopper = &hopping->hoppers[sensor];
    const uint32_t fired_us = sensor_of(&hopping->ring, sensor)->fired_us[0];
    return hopper->flags & HAS_FIRED ? wait_after(hopping, fired_us, rest_us) : 0;
}

/* The same in a ring that hops, where a sensor rests while it listens. */
static uint32_t listens_for(const EerufHoppingRing *hopping, uint8_t sensor) {
    return rests_for(hopping, sensor, allowed_window(OWN(&hopping->ring), sensor, hopping->rest_us));
}

static bool is_disabled(const EerufHoppingRing *hopping, uint8_t sensor) {
    return (sensor_of(&hopping->ring, sensor)->filter.state & DISABLED) != 0;
}

/* The sensor with nothing accepted for longest, if that is long enough. */
static uint8_t longest_unserved(const EerufHoppingRing *hopping) {
    uint8_t longest = hopping->by.hop.solo_after, found = NOBODY, x;
    if (longest > 0) longest--;
    for (x = 0; x < hopping->ring.count; x++) {
        if (hopping->hoppers[x].unserved > longest && !is_disabled(hopping, x)) {
            longest = hopping->hoppers[x].unserved;
            found = x;
        }
    }
    return found;
}

/* Gives the period to one sensor, which fires when all else is silent. */
static void plan_solo(EerufHoppingRing *hopping, uint8_t sensor) {
    /* Its own last firing is among those that it waits for, but its window may be longer. */
    const uint32_t at_us =
        longer(wait_after(hopping, hopping->ring.last_fired_us, hopping->by.hop.dies_us), listens_for(hopping, sensor));
    hopping->by.hop.earned = (uint16_t)(hopping->by.hop.earned - ONE_SOLO);
    hopping->by.hop.since_solo = 0;
    hopping->solo_at_us = at_us;
    hopping->fires_as = HAS_FIRED | SOLO | SETTLED;
    hopping->length_us = longer(hopping->length_us, add32(at_us, hopping->by.hop.dies_us));
    hopping->hoppers[0].order = sensor;
    hopping->planned = 1;
}

/* Evenly from 0 to `most`, at most 2^28: a xorshift generator (Marsaglia, 2003), the same on every machine. */
static uint32_t draw(EerufHoppingRing *hopping, uint32_t most) {
    uint32_t r = hopping->by.hop.random;
    uint32_t drawn = 0;
    uint8_t bit;
    r ^= r << 13;
    r ^= r >> 17;
    r ^= r << 5;
    hopping->by.hop.random = r;
    /* The high word of r (most + 1), without 64 bits. */
    for (bit = 0; bit < 32; bit++, r >>= 1) {
        if (r & 1u) drawn += most + 1;
        drawn >>= 1;
    }
    return drawn;
}

/* True if a sensor with this lag keeps the interval from its neighbours, in every phase and across the period's end. */
static bool keeps_interval(const EerufHoppingRing *hopping, uint8_t sensor, uint32_t lag_us) {
    const uint32_t least = add32(hopping->by.hop.shift_interval_us, code_width(hopping));
    uint8_t x;
    if (hopping->by.hop.shift_interval_us == 0) return true;
    for (x = 0; x < hopping->ring.count; x++) {
        const uint32_t distance = between(hopping->hoppers[x].lag_us, lag_us);
        const uint32_t across = hopping->period_us > distance ? hopping->period_us - distance : 0;
        if (!are_neighbours(EERUF_LAYOUT_LINE, hopping->by.hop.neighbours, hopping->ring.count, sensor, x)) continue;
        if (distance < least || across < least) return false;
    }
    return true;
}

static bool draw_lag(EerufHoppingRing *hopping, uint8_t sensor) {
    const uint32_t most = hopping->period_us - code_width(hopping) - 1;
    uint8_t i;
    for (i = 0; i < DRAWS; i++) {
        const uint32_t lag_us = draw(hopping, most);
        if (!keeps_interval(hopping, sensor, lag_us)) continue;
        hopping->hoppers[sensor].lag_us = lag_us;
        hopping->hoppers[sensor].misfits = 0;
        return true;
    }
    return false;
}

static void unsettle(EerufHoppingRing *hopping) {
    uint8_t x;
    for (x = 0; x < hopping->ring.count; x++) hopping->hoppers[x].flags &= (uint8_t)~SETTLED;
}

/* New lags for all sensors whose readings do not fit. */
static void shift_all(EerufHoppingRing *hopping) {
    bool shifted = false;
    uint8_t x;
    for (x = 0; x < hopping->ring.count; x++)
        if (hopping->hoppers[x].misfits >= hopping->by.hop.shift_after && draw_lag(hopping, x)) shifted = true;
    if (!shifted) return;
    hopping->by.hop.since_shift = 0;
    hopping->changed = 1;
    for (x = 0; x < hopping->ring.count && hopping->root != 0; x++) hopping->hoppers[x].place = welch_place(hopping, x);
    /* Pending sensors were fired with the lags of before. */
    unsettle(hopping);
}

/* The sensors that would fire in the period that begins. */
static void choose(EerufHoppingRing *hopping) {
    EerufHopPlan *hop = &hopping->by.hop;
    EerufHopper *hoppers = hopping->hoppers, *place;
    uint8_t x;
    hopping->solo_at_us = EERUF_NO_ECHO;
    hopping->length_us = hopping->period_us;
    if (hop->since_solo < UINT8_MAX) hop->since_solo++;
    hop->earned = fewer16((uint16_t)(hop->earned + hop->solo_rate), 2 * ONE_SOLO);
    if (hop->earned >= ONE_SOLO && hop->since_solo >= hop->solo_spacing) {
        const uint8_t unserved = longest_unserved(hopping);
        if (unserved != NOBODY) {
            plan_solo(hopping, unserved);
            return;
        }
    }
    if (hop->since_shift < UINT8_MAX) hop->since_shift++;
    if (hop->shift_after > 0 && hop->since_shift >= hop->shift_spacing) shift_all(hopping);
    hopping->fires_as = hop->since_shift > 0 ? HAS_FIRED | SETTLED : HAS_FIRED;
    for (x = 0; x < hopping->ring.count; x++) {
        const uint32_t offset = offset_of(hopping, x);
        if (is_disabled(hopping, x) || offset < listens_for(hopping, x)) continue;
        /* Insertion by firing time; sensors that fire together keep their order. */
        place = &hoppers[hopping->planned++];
        for (; place > hoppers && offset_of(hopping, place[-1].order) > offset; place--)
            place->order = place[-1].order;
        place->order = x;
    }
}

/* Decides who fires in the period that begins. */
static void plan(EerufHoppingRing *hopping) {
    hopping->place = hopping->planned = 0;
    hopping->plan(hopping);
    if (hopping->ring.paused) hopping->planned = 0;
    look_ahead(hopping);
}

/* A firing is later than planned, now by `by_us` more. Nothing else fires in a solo period, so that it may move. */
static OUT_OF_LINE void hop_late(EerufHoppingRing *hopping, EerufHopper *hopper, uint32_t late_us, uint32_t by_us) {
    const bool solo = (hopper->flags & SOLO) != 0;
    if (!solo) {
        hopper->late_us = narrow(late_us);
        note_hop(hopping, hopper->late_us);
    }
    if (late_us > CATCHES_UP_US) break_off(hopping);
    if (late_us > CATCHES_UP_US || solo) hopping->start_us += by_us;
    look_ahead(hopping);
}

static void fire_hop(EerufRing *ring, uint8_t sensor, uint32_t now_us) {
    EerufHoppingRing *hopping = hopping_of(ring);
    EerufHopper *hopper = &hopping->hoppers[sensor];
    const uint32_t late_us = now_us - ring->due_us;
    ring->last_fired_us = now_us;
    hopping->place++;
    hopper->late_us = 0;
    hopper->phase = hopping->phase;
    hopper->flags = hopping->fires_as;
    hop_late(hopping, hopper, late_us, late_us);
}

/* The hook of a hopping ring: a firing came later by so much, or, for 0, what is known of the sensor is forgotten. */
static void correct_hop(EerufRing *ring, uint8_t sensor, uint32_t by_us) {
    EerufHoppingRing *hopping = hopping_of(ring);
    EerufHopper *hopper = &hopping->hoppers[sensor];
    const uint32_t late_us = add32(hopper->late_us, by_us);
    uint8_t at;
    if (by_us == 0) {
        forget_tracks(hopper);
        return;
    }
    /* It was noted to be less late: all that this period has had so far are noted again, since steady lateness is
       none. It is one of them, or the last of the period before. */
    if (!(hopper->flags & SOLO)) {
        hopper->late_us = narrow(late_us);
        if (hopping->most_late[0] != UINT16_MAX) {
            hopping->least_late[0] = UINT16_MAX;
            hopping->most_late[0] = 0;
        }
        for (at = 0; at < hopping->place; at++)
            note_hop(hopping, hopping->hoppers[hopping->hoppers[at].order].late_us);
    }
    hop_late(hopping, hopper, late_us, by_us);
}

static void end_hopping_period(EerufRing *ring, uint32_t now_us) {
    EerufHoppingRing *hopping = hopping_of(ring);
    const bool left_out = now_us - hopping->ring.due_us > hopping->period_us;
    hopping->start_us = left_out ? now_us : hopping->ring.due_us + hopping->lead_us;
    hopping->least_late[2] = hopping->least_late[1];
    hopping->most_late[2] = hopping->most_late[1];
    hopping->least_late[1] = hopping->least_late[0];
    hopping->most_late[1] = hopping->most_late[0];
    hopping->least_late[0] = UINT16_MAX;
    hopping->most_late[0] = 0;
    if (left_out) break_off(hopping);
    next_phase(hopping);
    plan(hopping);
}

/* Takes a sensor out of those that are still to fire. */
static void leave_out(EerufHoppingRing *hopping, uint8_t sensor) {
    uint8_t at = hopping->place;
    while (at < hopping->planned && hopping->hoppers[at].order != sensor) at++;
    if (at == hopping->planned) return;
    for (hopping->planned--; at < hopping->planned; at++) hopping->hoppers[at].order = hopping->hoppers[at + 1].order;
    look_ahead(hopping);
}

static EerufStatus upcoming_hop(const EerufRing *ring, uint8_t number, uint8_t *sensor, uint32_t *due_us) {
    const EerufHoppingRing *hopping = (const EerufHoppingRing *)(const void *)ring;
    if (number >= hopping->planned - hopping->place) return EERUF_EMPTY;
    *sensor = hopping->hoppers[hopping->place + number].order;
    *due_us = number == 0 ? ring->due_us : hopping->start_us + offset_of(hopping, *sensor);
    return EERUF_OK;
}

static uint32_t horizon_of_hopping(const EerufRing *ring) {
    return ((const EerufHoppingRing *)(const void *)ring)->horizon_us;
}

static void restart_hopping(EerufRing *ring, uint32_t now_us) {
    EerufHoppingRing *hopping = hopping_of(ring);
    unsettle(hopping);
    hopping->start_us = now_us;
    if (OWN(ring) != NULL) {
        /* Pairs keep their intervals across a restart, unless the clock has jumped. */
        const uint32_t gap_us = READ32(OWN(ring)->min_interval_us);
        const uint32_t waits_us = ring->last_fired_us + gap_us - now_us;
        if (waits_us <= gap_us) hopping->start_us += waits_us;
    }
    break_off(hopping);
    plan(hopping);
}

static bool is_between(uint16_t value, uint16_t least, uint16_t most) {
    return value >= least && value <= most;
}

static EerufStatus tracker_is_fine(const EerufTrackerSettings *how) {
    const bool fine = how->t_delta_us > 0 && how->near_us >= how->t_delta_us && is_between(how->votes, 2, 15) &&
                      is_between(how->score_limit, how->votes, 15) && is_between(how->contradiction, 1, 15) &&
                      is_between(how->solo_contradiction, 1, 15) && how->tentative_within_us <= how->t_delta_us &&
                      (how->tentative_votes == 0 || is_between(how->tentative_votes, 2, 15));
    return fine ? EERUF_OK : EERUF_ERR_TRACKER;
}

/* A Welch code for this many sensors, of at least this many phases. */
static IN_LINE uint8_t narrowest_cycle(uint8_t sensors, uint8_t phases) {
    uint8_t prime = phases > sensors + 1u ? phases : (uint8_t)(sensors + 1u);
    if (prime < 67) prime++;
    if (prime < 5) prime = 5; /* two phases would be those of a linear congruence */
    while (!is_prime(prime)) prime++;
    return (uint8_t)(prime - 1u);
}

/* True if a ring of this many sensors has the memory it needs. */
static EerufStatus has_room(const EerufHoppingRing *hopping, size_t ring_size, uint8_t count_of_sensors,
                            size_t sensors_size, size_t hoppers_size) {
    if (ring_size != sizeof *hopping) return EERUF_ERR_MEMORY;
    if (count_of_sensors - 1u >= EERUF_MAX_SENSORS) return EERUF_ERR_SENSORS;
    if (sensors_size / sizeof(EerufHopSensor) < count_of_sensors) return EERUF_ERR_MEMORY;
    return hoppers_size / sizeof(EerufHopper) < count_of_sensors ? EERUF_ERR_MEMORY : EERUF_OK;
}

/* The beginning of hopping and flow rings, once their settings are in their ranges. */
static EerufStatus set_up_hopping(EerufHoppingRing *hopping, EerufHopSensor *sensors, EerufHopper *hoppers,
                                  uint8_t count_of_sensors, const EerufTrackerSettings *tracker, uint32_t step_us,
                                  uint32_t window_us, uint32_t blanking_us, uint32_t now_us,
                                  const EerufSchedule *own) {
    EerufStatus status;
    uint8_t x;
    memset(hopping, 0, sizeof *hopping);
    set_up(&hopping->ring, NULL, sensors, count_of_sensors, sizeof *sensors, now_us);
    OWN(&hopping->ring) = own;
    hopping->ring.hook = correct_hop;
    status = listen(&hopping->ring, tracker->t_delta_us, window_us, blanking_us);
    if (status != EERUF_OK) return status;
    hopping->hoppers = hoppers;
    hopping->tracker = *tracker;
    hopping->step_us = (uint16_t)step_us;
    hopping->start_us = hopping->ring.last_fired_us = now_us;
    hopping->solo_at_us = EERUF_NO_ECHO;
    hopping->rest_us = window_us;
    /* A track may be off by as much as its readings. */
    hopping->tolerated = (uint16_t)((step_us - tracker->t_delta_us - 1) / 2);
    hopping->least_late[0] = hopping->least_late[1] = hopping->least_late[2] = UINT16_MAX;
    memset(hoppers, 0, count_of_sensors * sizeof *hoppers);
    for (x = 0; x < count_of_sensors; x++) forget_tracks(&hoppers[x]);
    return EERUF_OK;
}

/* From a firing until its sensor no longer listens, and nothing of it is heard in a window that opens then. */
static uint32_t dies_after(uint32_t window_us, uint32_t blanking_us, uint32_t reach_us) {
    return add32(longer(reach_us > blanking_us ? reach_us - blanking_us : 0, window_us), 1);
}

/* Places in Welch's sequence are in the order of lags. */
static void begin_hopping(EerufHoppingRing *hopping) {
    uint8_t x;
    for (x = 0; x < hopping->ring.count; x++) hopping->hoppers[x].place = welch_place(hopping, x);
    plan(hopping);
    hopping->ring.ready = READY;
}

/* The shortest period: a sensor must have stopped listening when it fires again, and a path must not read the same with
   two ages. */
static IN_LINE uint32_t shortest_period(const EerufSchedule *own, uint8_t sensors, uint32_t window_us, uint32_t step_us,
                                        uint8_t cycle, uint8_t root, uint8_t first) {
    uint32_t least_us = (2u * cycle - 1u) * step_us;
    uint8_t x;
    for (x = 0; x < sensors; x++) {
        const uint32_t drop = drop_of(leader_of(limits_of(own), x), cycle, root, first);
        least_us = longer(least_us, add32(allowed_window(own, x, window_us), drop * step_us));
    }
    return least_us;
}

/* The lags of a config, or even ones, in what the code leaves of the period: x room / n, in 32 bits. */
static IN_LINE void take_lags(EerufHopper *hoppers, const EerufHoppingConfig *config, uint32_t room_us) {
    const uint8_t n = config->sensors;
    uint8_t x;
    for (x = 0; x < n; x++)
        hoppers[x].lag_us = config->lag_us != NULL ? config->lag_us[x] : x * (room_us / n) + x * (room_us % n) / n;
}

/* The hook of a ring that hops, for a reading and the change that odometry expected. Neither silence nor another lag
   helps a sensor whose line is stuck, or that does not answer: it costs the others nothing. */
static void judged_hop(EerufHoppingRing *hopping, uint8_t sensor, const EerufReading *reading, int32_t change_us) {
    EerufHopper *hopper = &hopping->hoppers[sensor];
    const bool confirmed = reading->kind == EERUF_READING_ACCEPTED || reading->kind == EERUF_READING_CLEAR;
    const EerufTrack *believed = believed_of(hopper);
    (void)change_us;
    if (reading->kind == EERUF_READING_STUCK || reading->kind == EERUF_READING_UNANSWERED) return;
    /* A sensor that is known to have nothing in range is not fooled by what does not fit. */
    if (confirmed || (believed != NULL && believed->t_echo_us == EERUF_NO_ECHO)) hopper->misfits = 0;
    else if (hopper->misfits < UINT8_MAX) hopper->misfits++;
    if (confirmed || reading->kind == EERUF_READING_TENTATIVE) hopper->unserved = 0;
    else if (hopper->unserved < UINT8_MAX) hopper->unserved++;
}

EerufStatus eeruf_hopping_init(EerufHoppingRing *hopping, size_t ring_size, EerufHopSensor *sensors,
                               size_t sensors_size, EerufHopper *hoppers, size_t hoppers_size,
                               const EerufHoppingConfig *config, uint32_t now_us) {
    EerufStatus status;
    uint32_t width_us, room_us;
    uint8_t x, cycle, root = 0, first = 1;
    if (hopping == NULL || sensors == NULL || hoppers == NULL || config == NULL) return EERUF_ERR_NULL;
    if (config->version != EERUF_VERSION) return EERUF_ERR_VERSION;
    status = has_room(hopping, ring_size, config->sensors, sensors_size, hoppers_size);
    if (status != EERUF_OK) return status;
    if (config->own != NULL && READ8(config->own->sensors) != config->sensors) return EERUF_ERR_SENSORS;
    if (!is_between(config->phases, 2, 67)) return EERUF_ERR_PHASES;
    if (config->step_us == 0 || config->step_us > UINT16_MAX) return EERUF_ERR_STEP;
    if (config->code == 0) {
        cycle = narrowest_cycle(config->sensors, config->phases);
        root = primitive_root((uint8_t)(cycle + 1u));
    } else {
        cycle = config->phases;
        first = (uint8_t)(config->code - 1u);
        if (!is_prime(cycle) || cycle < config->sensors) {
            if (!is_prime((uint8_t)(cycle + 1u)) || cycle <= config->sensors) return EERUF_ERR_PHASES;
            if (config->code == 1) return EERUF_ERR_PHASES;
            root = primitive_root((uint8_t)(cycle + 1u));
        }
        if (config->code > cycle) return EERUF_ERR_PHASES;
    }
    width_us = (cycle - 1u) * config->step_us;
    if (config->period_us <= width_us || config->period_us > EERUF_MAX_PERIOD_US) return EERUF_ERR_PERIOD;
    room_us = config->period_us - width_us;
    for (x = 0; x < config->sensors && config->lag_us != NULL; x++)
        if (config->lag_us[x] >= room_us) return EERUF_ERR_LAG;
    status = tracker_is_fine(&config->tracker);
    if (status != EERUF_OK) return status;
    /* New lags would not keep what sensors and pairs need of their own. */
    if (config->own != NULL && config->shift_after > 0) return EERUF_ERR_HOPPING;
    if (config->step_us <= config->tracker.t_delta_us) return EERUF_ERR_T_DELTA;
    if (config->tracker.votes > cycle) return EERUF_ERR_VOTES;
    if (config->period_us <
        shortest_period(config->own, config->sensors, config->window_us, config->step_us, cycle, root, first))
        return EERUF_ERR_PERIOD;
    if (config->window_us > EERUF_HOPPING_MAX_WINDOW_US) return EERUF_ERR_WINDOW;

    status = set_up_hopping(hopping, sensors, hoppers, config->sensors, &config->tracker, config->step_us,
                            config->window_us, config->blanking_us, now_us, config->own);
    if (status != EERUF_OK) return status;
    hopping->plan = choose;
    hopping->judged = judged_hop;
    hopping->cycle = cycle;
    hopping->root = root;
    hopping->first = first;
    hopping->period_us = config->period_us;
    hopping->by.hop.dies_us = dies_after(config->window_us, config->blanking_us, config->reach_us);
    if (config->own != NULL)
        hopping->by.hop.dies_us = longer(hopping->by.hop.dies_us, READ32(config->own->min_interval_us));
    hopping->by.hop.random = config->seed == 0 ? 0x9e3779b9u : config->seed;
    hopping->by.hop.shift_interval_us = config->shift_interval_us;
    hopping->by.hop.solo_rate = config->solo_rate;
    hopping->by.hop.solo_after = config->solo_after;
    hopping->by.hop.solo_spacing = config->solo_spacing;
    hopping->by.hop.shift_after = config->shift_after;
    hopping->by.hop.shift_spacing = config->shift_spacing;
    hopping->by.hop.neighbours = config->neighbours;
    hopping->horizon_us = add32(hopping->by.hop.dies_us, hopping->by.hop.dies_us);
    hopping->horizon_us = add32(2 * config->period_us, hopping->horizon_us);
    take_lags(hoppers, config, room_us);
    begin_hopping(hopping);
    return EERUF_OK;
}

/* True if what a sensor hears of its last firing moves as the code says. */
static bool was_steady(const EerufHoppingRing *hopping, const EerufHopper *hopper) {
    return (hopper->flags & SETTLED) && is_steady(hopping, hopper->late_us);
}

EerufStatus eeruf_hopping_poll(EerufHoppingRing *hopping, uint32_t now_us, const int32_t *change_us,
                               EerufEvent *event) {
    EerufStatus status = hopping == NULL ? (EerufStatus)EERUF_ERR_NULL : is_ready(&hopping->ring);
    EerufReading *reading;
    EerufHopper *hopper;
    if (status == EERUF_OK && !HOPS(&hopping->ring)) status = EERUF_ERR_NOT_READY;
    if (status == EERUF_OK) status = poll(&hopping->ring, now_us, NULL, event, true);
    if (status != EERUF_EVENT) return status;
    if (hopping->changed) {
        firing_changed(hopping);
        hopping->changes++;
    }
    hopping->changed = 0;
    if (event->kind == EERUF_EVENT_FIRE) {
        event->phase = hopping->phase;
        return status;
    }
    if (event->kind == EERUF_EVENT_PERIOD) {
        event->phase = hopping->phase > 0 ? (uint8_t)(hopping->phase - 1u) : (uint8_t)(hopping->cycle - 1u);
        return status;
    }
    reading = &event->u.reading;
    hopper = &hopping->hoppers[event->sensor];
    event->phase = hopper->phase;
    if (reading->kind != EERUF_READING_LATE) {
        const int32_t change = change_us == NULL ? 0 : change_us[event->sensor];
        const bool unwitnessed = reading->kind == EERUF_READING_NO_ECHO;
        const bool weighs = unwitnessed || reading->kind == EERUF_READING_FIRST;
        reading->previous_us = EERUF_NO_ECHO;
        if (weighs)
            learn(hopper, reading->t_echo_us, change, t_delta_of(&hopping->ring, event->sensor));
        else hopper->last_us = EERUF_NO_ECHO;
        shift_tracks(hopper, change);
        if (weighs) weigh(hopping, event->sensor, was_steady(hopping, hopper), change, reading);
        end_weighing(&sensor_of(&hopping->ring, event->sensor)->filter, reading);
        hopping->judged(hopping, event->sensor, reading, change);
        /* Without a witness it contradicts echoes, and is not reported as free space. */
        if (unwitnessed) reading->kind = EERUF_READING_NO_ECHO;
    }
    count(&hopping->ring, reading->kind);
    return status;
}

/* A hopping ring's sensor. */
static EerufStatus has_hopper(const EerufHoppingRing *hopping, uint8_t sensor) {
    if (hopping == NULL) return EERUF_ERR_NULL;
    return HOPS(&hopping->ring) ? has_sensor(&hopping->ring, sensor) : (EerufStatus)EERUF_ERR_NOT_READY;
}

EerufStatus eeruf_hopping_enable(EerufHoppingRing *hopping, uint8_t sensor, bool enabled) {
    const EerufStatus status = has_hopper(hopping, sensor);
    if (status != EERUF_OK) return status;
    if (enabled && is_disabled(hopping, sensor)) forget_tracks(&hopping->hoppers[sensor]);
    enable(&hopping->ring, sensor, enabled);
    if (!enabled) leave_out(hopping, sensor);
    return EERUF_OK;
}

EerufStatus eeruf_hopping_pause(EerufHoppingRing *hopping, bool paused) {
    const EerufStatus status = has_hopper(hopping, 0);
    uint8_t x;
    if (status != EERUF_OK) return status;
    hopping->ring.paused = paused;
    if (paused) hopping->planned = hopping->place;
    look_ahead(hopping);
    for (x = 0; x < hopping->ring.count && !paused; x++) forget_tracks(&hopping->hoppers[x]);
    return EERUF_OK;
}

EerufStatus eeruf_hopping_restart(EerufHoppingRing *hopping, uint32_t now_us) {
    const EerufStatus status = has_hopper(hopping, 0);
    if (status == EERUF_OK) restart(&hopping->ring, now_us, true);
    return status;
}

EerufStatus eeruf_hopping_change(EerufHoppingRing *hopping, const EerufHoppingConfig *config) {
    const EerufStatus status = has_hopper(hopping, 0);
    uint32_t room_us, waits_us;
    uint8_t x;
    if (status != EERUF_OK) return status;
    if (config == NULL) return EERUF_ERR_NULL;
    if (config->version != EERUF_VERSION) return EERUF_ERR_VERSION;
    if (hopping->plan != choose) return EERUF_ERR_HOPPING;
    if (!is_between(config->phases, 2, 67)) return EERUF_ERR_PHASES;
    if (config->sensors != hopping->ring.count || config->step_us != hopping->step_us) return EERUF_ERR_LADDER;
    if ((config->code == 0 ? narrowest_cycle(config->sensors, config->phases) : config->phases) != hopping->cycle)
        return EERUF_ERR_LADDER;
    if ((config->code == 0 ? 1u : config->code - 1u) != hopping->first || (config->code == 0 && hopping->root == 0))
        return EERUF_ERR_LADDER;
    if (config->period_us <= code_width(hopping) || config->period_us > EERUF_MAX_PERIOD_US) return EERUF_ERR_PERIOD;
    room_us = config->period_us - code_width(hopping);
    for (x = 0; x < config->sensors && config->lag_us != NULL; x++)
        if (config->lag_us[x] >= room_us) return EERUF_ERR_LAG;
    if (config->period_us < shortest_period(OWN(&hopping->ring), config->sensors, hopping->rest_us, hopping->step_us,
                                            hopping->cycle, hopping->root, hopping->first))
        return EERUF_ERR_PERIOD;

    /* Once all sound from before has died. A clock that has jumped says nothing about when anything fired. */
    waits_us = hopping->ring.last_fired_us + hopping->by.hop.dies_us - hopping->start_us;
    if (waits_us > HALF_TURN) waits_us = 0;
    if (waits_us <= add32(hopping->length_us, hopping->by.hop.dies_us)) hopping->start_us += waits_us;
    else break_off(hopping);
    hopping->horizon_us = hopping->horizon_us - 2 * hopping->period_us + 2 * config->period_us;
    hopping->period_us = config->period_us;
    take_lags(hopping->hoppers, config, room_us);
    for (x = 0; x < hopping->ring.count && hopping->root != 0; x++) hopping->hoppers[x].place = welch_place(hopping, x);
    /* Pending firings were those of the schedule of before. */
    unsettle(hopping);
    hopping->changed = 1;
    plan(hopping);
    return EERUF_OK;
}

EerufStatus eeruf_hopping_adaptation_init(EerufAdaptation *adaptation, size_t adaptation_size,
                                          const EerufHoppingConfig *const *ladder, uint8_t rungs) {
    uint8_t rung;
    if (adaptation == NULL || ladder == NULL) return EERUF_ERR_NULL;
    if (adaptation_size != sizeof *adaptation) return EERUF_ERR_MEMORY;
    if (rungs == 0) return EERUF_ERR_LADDER;
    for (rung = 0; rung < rungs; rung++) {
        if (ladder[rung] == NULL) return EERUF_ERR_NULL;
        if (ladder[rung]->version != EERUF_VERSION) return EERUF_ERR_VERSION;
        if (ladder[rung]->sensors != ladder[0]->sensors) return EERUF_ERR_LADDER;
        if (rung > 0 && ladder[rung]->period_us <= ladder[rung - 1]->period_us) return EERUF_ERR_LADDER;
    }
    begin_adaptation(adaptation, ladder, rungs, READY_TO_HOP);
    return EERUF_OK;
}

EerufStatus eeruf_hopping_adaptation_period(EerufAdaptation *adaptation, EerufHoppingRing *hopping,
                                            const EerufEvent *event) {
    uint8_t rung = 0;
    EerufStatus status = has_hopper(hopping, 0);
    if (status == EERUF_OK) status = take_period(adaptation, &hopping->ring, event, READY_TO_HOP, &rung);
    if (status != EERUF_EVENT) return status;
    status = eeruf_hopping_change(hopping, ((const EerufHoppingConfig *const *)adaptation->ladder)[rung]);
    if (status != EERUF_OK) return status;
    adaptation->rung = rung;
    return EERUF_EVENT;
}

uint32_t eeruf_hopping_confirmed_us(const EerufHoppingRing *hopping, uint8_t sensor) {
    const EerufTrack *believed = NULL;
    if (has_hopper(hopping, sensor) == EERUF_OK) believed = believed_of(&hopping->hoppers[sensor]);
    return believed == NULL ? EERUF_NO_ECHO : believed->t_echo_us;
}

uint8_t eeruf_hopping_solo(const EerufHoppingRing *hopping) {
    if (has_hopper(hopping, 0) != EERUF_OK || hopping->solo_at_us == EERUF_NO_ECHO) return NOBODY;
    return hopping->hoppers[0].order;
}

uint32_t eeruf_hopping_lag_us(const EerufHoppingRing *hopping, uint8_t sensor) {
    return has_hopper(hopping, sensor) == EERUF_OK ? hopping->hoppers[sensor].lag_us : 0;
}

uint8_t eeruf_hopping_weighed(const EerufHoppingRing *hopping, uint8_t sensor) {
    const EerufHopper *hopper;
    if (has_hopper(hopping, sensor) != EERUF_OK) return 0;
    hopper = &hopping->hoppers[sensor];
    return (uint8_t)((hopper->flags & SOLO ? EERUF_WEIGHED_SOLO : 0u) |
                     (was_steady(hopping, hopper) ? EERUF_WEIGHED_STEADY : 0u));
}

uint8_t eeruf_hopping_changes(const EerufHoppingRing *hopping) {
    return has_hopper(hopping, 0) == EERUF_OK ? hopping->changes : 0;
}

/* -- Flow: the rules are in docs/explanation/flow.md -- */

#define QUIET_US 256u /* the unit of quiet */

/* A time in units of quiet. */
static uint8_t quiet_of(uint32_t time_us) {
    return (uint8_t)shorter(time_us / QUIET_US, UINT8_MAX);
}

/* A time in whole units of the grid, rounded up. */
static uint32_t in_units(uint32_t time_us, uint32_t unit_us) {
    return add32(time_us, unit_us - 1) / unit_us;
}

static uint8_t less8(uint8_t one, uint8_t other) {
    return one > other ? (uint8_t)(one - other) : 0;
}

static uint8_t larger8(uint8_t one, uint8_t other) {
    return one > other ? one : other;
}

static uint8_t smaller8(uint8_t one, uint8_t other) {
    return one < other ? one : other;
}

static uint8_t add8(uint8_t one, uint8_t other) {
    return one > UINT8_MAX - other ? UINT8_MAX : (uint8_t)(one + other);
}

/* The gap in units that leaves this quiet, and at least the least. By a reciprocal, since small processors divide
   slowly; it is short by less than a unit's share of the longest quiet. */
static OUT_OF_LINE uint8_t gap_for(const EerufFlowPlan *flow, uint8_t quiet) {
    uint32_t gap;
    if (flow->per_quiet != 0) gap = (quiet * flow->per_quiet + 0x00ffffffu) >> 24;
    else gap = shorter(in_units(quiet * QUIET_US, flow->unit_us), UINT8_MAX);
    return larger8((uint8_t)gap, flow->least_gap);
}

/* Hoppers keep the gap after the firing in their place of the order where rings that hop count misfits. */
static uint8_t *gap_at(EerufHoppingRing *hopping, uint8_t place) {
    return &hopping->hoppers[place].misfits;
}

static EerufHopper *firing_at(EerufHoppingRing *hopping, uint8_t place) {
    return &hopping->hoppers[hopping->hoppers[place].order];
}

/* The sensor after one in the order of firing if all do: far from it, since neighbours hear each other loudest. */
static uint8_t sensor_after(const EerufHoppingRing *hopping, uint8_t sensor) {
    const uint8_t next = (uint8_t)(sensor + hopping->by.flow.stride);
    return next >= hopping->ring.count ? (uint8_t)(next - hopping->ring.count) : next;
}

/* Raises a gap to what this quiet needs, by at most `left` units; returns what is left of them. */
static uint16_t raise_gap(EerufHoppingRing *hopping, uint8_t place, uint8_t quiet, uint16_t left) {
    uint8_t *gap = gap_at(hopping, place);
    const uint8_t more = (uint8_t)fewer16(less8(gap_for(&hopping->by.flow, quiet), *gap), left);
    *gap = (uint8_t)(*gap + more);
    return (uint16_t)(left - more);
}

/* The last place of those that fire together with this one: the gaps between them are none. */
static uint8_t last_with(EerufHoppingRing *hopping, uint8_t place) {
    while (*gap_at(hopping, place) == 0) place++;
    return place;
}

/* Gives all the least gap, and what is left of this many units what each needs before and after it, in the order that
   is kept where lags are decided next; returns what is left then. */
static OUT_OF_LINE uint16_t give_gaps(EerufHoppingRing *hopping, uint16_t left) {
    const uint8_t least = hopping->by.flow.least_gap, planned = hopping->planned;
    uint8_t place, rank;
    for (place = 0; place < planned; place++) {
        if (*gap_at(hopping, place) == 0) continue;
        *gap_at(hopping, place) = least;
        left = less16(left, least);
    }
    for (rank = 0; rank < planned && left > 0; rank++) {
        const EerufHopper *hopper = firing_at(hopping, (uint8_t)hopping->hoppers[rank].lag_us);
        uint8_t first = place = (uint8_t)hopping->hoppers[rank].lag_us;
        while (first > 0 && *gap_at(hopping, (uint8_t)(first - 1u)) == 0) first--;
        left = raise_gap(hopping, (uint8_t)((first == 0 ? planned : first) - 1u), hopper->quiet_before, left);
        left = raise_gap(hopping, last_with(hopping, place), hopper->quiet_after, left);
    }
    return left;
}

/* Sorts those first that have been unserved for longest. */
static void sort_by_need(EerufHoppingRing *hopping) {
    EerufHopper *hoppers = hopping->hoppers;
    uint8_t place, rank;
    for (place = 1; place < hopping->planned; place++) {
        const uint8_t unserved = firing_at(hopping, place)->unserved;
        for (rank = place; rank > 0; rank--) {
            const uint32_t before = hoppers[rank - 1u].lag_us;
            if (firing_at(hopping, (uint8_t)before)->unserved >= unserved) break;
            hoppers[rank].lag_us = before;
        }
        hoppers[rank].lag_us = place;
    }
}

/* Adds the gaps up to firing times; a sensor that still listens waits. */
static void place_firings(EerufHoppingRing *hopping) {
    EerufFlowPlan *flow = &hopping->by.flow;
    uint32_t at = 0;
    uint8_t place;
    for (place = 0; place < hopping->planned; place++) {
        const uint8_t sensor = hopping->hoppers[place].order;
        EerufHopper *hopper = &hopping->hoppers[sensor];
        uint32_t rests_us, offset_us;
        uint8_t other = place;
        hopper->lag_us = at * flow->unit_us;
        rests_us = rests_for(hopping, sensor, hopping->rest_us);
        offset_us = offset_of(hopping, sensor);
        if (rests_us > offset_us) {
            at += in_units(rests_us - offset_us, flow->unit_us);
            hopper->lag_us = at * flow->unit_us;
        }
        /* Those that fire together wait for each other. */
        for (; other > 0 && *gap_at(hopping, (uint8_t)(other - 1u)) == 0; other--)
            firing_at(hopping, (uint8_t)(other - 1u))->lag_us = hopper->lag_us;
        at += *gap_at(hopping, place);
    }
    flow->length = longer(at, flow->shortest);
    hopping->length_us = hopping->period_us = flow->length * flow->unit_us;
}

/* The longest that the next cycle may take, in units: the shorter the faster the robot moved in the last. */
static uint32_t longest_cycle(const EerufFlowPlan *flow) {
    uint32_t most = flow->longest;
    if (flow->fastest_us != 0)
        most = shorter(most, times(narrow(flow->length), flow->travel_us) / flow->fastest_us);
    return longer(most, flow->shortest - flow->rounded_up);
}

/* Decides on the cycle that begins. */
static void plan_flow(EerufHoppingRing *hopping) {
    const uint32_t most = longest_cycle(&hopping->by.flow);
    const EerufLimits *limits = limits_of(OWN(&hopping->ring));
    uint8_t sensor = 0, left;
    hopping->by.flow.fastest_us = 0;
    for (left = hopping->ring.count; left > 0; left--) {
        uint8_t other;
        /* Those that fire together in the place of the first of them. */
        for (other = sensor; other < hopping->ring.count; other++) {
            if (leader_of(limits, other) == sensor && !is_disabled(hopping, other)) {
                EerufHopper *place = &hopping->hoppers[hopping->planned];
                place->order = other;
                place->lag_us = hopping->planned;
                *gap_at(hopping, hopping->planned++) = 0;
            }
            if (limits == NULL) break;
        }
        if (hopping->planned > 0) *gap_at(hopping, (uint8_t)(hopping->planned - 1u)) = 1;
        sensor = sensor_after(hopping, sensor);
    }
    /* Gaps of a byte, for at most 64 sensors. */
    if ((uint16_t)(UINT16_MAX - give_gaps(hopping, UINT16_MAX)) > most) {
        sort_by_need(hopping);
        (void)give_gaps(hopping, narrow(most));
    }
    place_firings(hopping);
}

/* Time from a sensor's firing in this cycle to the next of any that it does not fire together with, as planned. */
static uint32_t gap_after(EerufHoppingRing *hopping, uint8_t sensor) {
    uint8_t place;
    for (place = 0; place < hopping->planned; place++)
        if (hopping->hoppers[place].order == sensor)
            return *gap_at(hopping, last_with(hopping, place)) * hopping->by.flow.unit_us;
    return 0;
}

/* Raises a sensor's quiet if others fooled it or nothing of it is believed, lowers it if its reading is. */
static void judged_flow(EerufHoppingRing *hopping, uint8_t sensor, const EerufReading *reading, int32_t change_us) {
    EerufFlowPlan *flow = &hopping->by.flow;
    EerufHopper *hopper = &hopping->hoppers[sensor];
    const uint16_t change = narrow(change_us < 0 ? 0u - (uint32_t)change_us : (uint32_t)change_us);
    const EerufTrack *believed;
    uint8_t before = 0, after = 0;
    if (change > flow->fastest_us) flow->fastest_us = change;
    switch (reading->kind) {
    case EERUF_READING_STUCK:
    case EERUF_READING_UNANSWERED: return; /* quiet does not help a sensor that is not heard */
    case EERUF_READING_ACCEPTED:
    case EERUF_READING_CLEAR:
        hopper->quiet_before = larger8(less8(hopper->quiet_before, flow->believed_takes), flow->least);
        hopper->quiet_after = larger8(less8(hopper->quiet_after, flow->believed_takes), flow->least);
        hopper->unserved = 0;
        return;
    case EERUF_READING_TENTATIVE: hopper->unserved = 0; return;
    default: break;
    }
    hopper->unserved = add8(hopper->unserved, 1);
    if (hopper->unserved % flow->unserved_after == 0) before = after = flow->unserved_adds;
    believed = believed_of(hopper);
    /* It is masked; silence that is believed is later than all. */
    if (believed != NULL && reading->t_echo_us < believed->t_echo_us) {
        before = add8(before, flow->masked_adds);
        if (reading->t_echo_us > gap_after(hopping, sensor)) after = add8(after, flow->masked_adds);
    }
    hopper->quiet_before = smaller8(add8(hopper->quiet_before, before), flow->most);
    hopper->quiet_after = smaller8(add8(hopper->quiet_after, after), flow->most);
}

static bool is_coprime(uint8_t a, uint8_t b) {
    while (b > 0) {
        const uint8_t rest = (uint8_t)(a % b);
        a = b;
        b = rest;
    }
    return a <= 1;
}

EerufStatus eeruf_flow_init(EerufHoppingRing *hopping, size_t ring_size, EerufHopSensor *sensors, size_t sensors_size,
                            EerufHopper *hoppers, size_t hoppers_size, const EerufFlowConfig *config, uint32_t now_us) {
    EerufFlowPlan *flow;
    EerufStatus status;
    uint32_t width_us, unit_us, least_us;
    uint8_t n, turn, cycle, sensor = 0;
    if (hopping == NULL || sensors == NULL || hoppers == NULL || config == NULL) return EERUF_ERR_NULL;
    if (config->version != EERUF_VERSION) return EERUF_ERR_VERSION;
    n = config->sensors;
    status = has_room(hopping, ring_size, n, sensors_size, hoppers_size);
    if (status == EERUF_OK) status = tracker_is_fine(&config->tracker);
    if (status != EERUF_OK) return status;
    if (config->own != NULL && READ8(config->own->sensors) != n) return EERUF_ERR_SENSORS;
    if (config->step_us == 0 || config->step_us > UINT16_MAX) return EERUF_ERR_STEP;
    if (config->step_us <= config->tracker.t_delta_us) return EERUF_ERR_T_DELTA;
    if (config->window_us > EERUF_HOPPING_MAX_WINDOW_US) return EERUF_ERR_WINDOW;
    cycle = narrowest_cycle(n, config->tracker.votes);
    width_us = (cycle - 1u) * config->step_us;
    if (config->shortest_cycle_us < config->window_us + width_us) return EERUF_ERR_PERIOD;
    if (config->shortest_cycle_us > EERUF_MAX_PERIOD_US) return EERUF_ERR_PERIOD;
    status = set_up_hopping(hopping, sensors, hoppers, n, &config->tracker, config->step_us, config->window_us,
                            config->blanking_us, now_us, config->own);
    if (status != EERUF_OK) return status;
    hopping->plan = plan_flow;
    hopping->judged = judged_flow;
    hopping->cycle = cycle;
    hopping->root = primitive_root((uint8_t)(cycle + 1u));
    hopping->first = 1;
    hopping->fires_as = HAS_FIRED | SETTLED;
    flow = &hopping->by.flow;
    unit_us = flow->unit_us = width_us + 2 * config->step_us;
    /* Nothing of a firing is heard in a window that opens so much later; the waits of two may bring them closer. */
    least_us = dies_after(config->window_us, config->blanking_us, config->reach_us);
    flow->least = quiet_of(config->shortest_gap_us);
    flow->most = larger8(quiet_of(add32(least_us, width_us)), flow->least);
    flow->masked_adds = quiet_of(config->masked_adds_us);
    flow->believed_takes = quiet_of(config->believed_takes_us);
    flow->unserved_adds = quiet_of(config->unserved_adds_us);
    flow->unserved_after = larger8(config->unserved_after, 1);
    flow->least_gap = (uint8_t)shorter(longer(in_units(flow->least * QUIET_US, unit_us), 1), UINT8_MAX);
    flow->per_quiet = unit_us > QUIET_US ? UINT32_MAX / unit_us : 0;
    flow->shortest = flow->length = in_units(config->shortest_cycle_us, unit_us);
    flow->rounded_up = flow->shortest * unit_us != config->shortest_cycle_us;
    flow->longest = longer(shorter(config->longest_cycle_us, EERUF_MAX_PERIOD_US), config->shortest_cycle_us) / unit_us;
    flow->travel_us = narrow(config->travel_us);
    hopping->lead_us = (uint16_t)(quiet_of(shorter(config->lead_us, config->shortest_cycle_us)) * QUIET_US);
    flow->stride = (uint8_t)(n > 6 ? n / 3 + 1 : 1);
    while (!is_coprime(flow->stride, n)) flow->stride++;
    /* A cycle of least gaps may be longer than the longest that is asked for. */
    least_us = 2 * longer((uint32_t)n * flow->least_gap, flow->longest + 1) * unit_us;
    hopping->rest_us = longer(shorter(config->rest_us, EERUF_HOPPING_MAX_WINDOW_US), config->window_us);
    hopping->horizon_us = least_us + hopping->rest_us;
    for (turn = 0; turn < n; turn++) {
        hoppers[sensor].lag_us = turn;
        hoppers[sensor].quiet_before = hoppers[sensor].quiet_after = flow->least;
        sensor = sensor_after(hopping, sensor);
    }
    begin_hopping(hopping);
    return EERUF_OK;
}

EerufStatus eeruf_flow_quiet_us(const EerufHoppingRing *hopping, uint8_t sensor, uint32_t *before_us,
                                uint32_t *after_us) {
    const EerufStatus status = has_hopper(hopping, sensor);
    if (status != EERUF_OK) return status;
    if (before_us == NULL || after_us == NULL) return EERUF_ERR_NULL;
    *before_us = hopping->hoppers[sensor].quiet_before * QUIET_US;
    *after_us = hopping->hoppers[sensor].quiet_after * QUIET_US;
    return EERUF_OK;
}
#endif

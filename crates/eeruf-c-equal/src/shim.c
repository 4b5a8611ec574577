/* The C library as functions of numbers and one kind of handle, so that Rust need not know its structures. A ring's
   memory has exactly the required size and comes from malloc, so that a sanitizer sees each access beyond it. */
#include "eeruf.h"
#include "eeruf_serial.h"

#include <stdlib.h>
#include <string.h>

typedef struct Handle {
    EerufSchedule *schedules[8];
    EerufLimits *limits[8];
    unsigned schedule_count;
    EerufRing *ring;
    EerufSensor *sensors;
    EerufFlowRing *flow;
    EerufFlowSensor *flow_sensors;
    EerufSchedule own;
    uint8_t *shared_lines;
    EerufHcSr04 modules;
    EerufHcSr04Settings settings;
    EerufLine *lines;
    EerufWatch watch;
    EerufWatched *watched;
    EerufEvent last;
    EerufSerial line;
    uint16_t late_us[64];
} Handle;

Handle *shim_new(void) {
    return (Handle *)calloc(1, sizeof(Handle));
}

void shim_free(Handle *handle) {
    while (handle->schedule_count > 0) {
        EerufSchedule *schedule = handle->schedules[--handle->schedule_count];
        free((void *)(uintptr_t)schedule->order);
        free((void *)(uintptr_t)schedule->gap_us);
        free(handle->limits[handle->schedule_count]);
        free(schedule);
    }
    if (handle->flow == NULL) free(handle->ring);
    free(handle->flow);
    free(handle->sensors);
    free(handle->flow_sensors);
    free((void *)(uintptr_t)handle->own.limits);
    free(handle->shared_lines);
    free(handle->lines);
    free(handle->watched);
    free(handle);
}

/* Schedules are numbered as they are made, and not verified yet. */
void shim_schedule(Handle *handle, uint32_t period_us, uint32_t min_refire_us, uint8_t sensors, uint8_t phases,
                   const uint8_t *order, const uint32_t *gap_us) {
    EerufSchedule *schedule = (EerufSchedule *)calloc(1, sizeof *schedule);
    const size_t order_size = (size_t)sensors * phases, gap_size = (sensors + 1u) * phases * sizeof(uint32_t);
    schedule->version = EERUF_VERSION;
    schedule->sensors = sensors;
    schedule->phases = phases;
    schedule->order = (uint8_t *)memcpy(malloc(order_size), order, order_size);
    schedule->gap_us = (uint32_t *)memcpy(malloc(gap_size), gap_us, gap_size);
    schedule->period_us = period_us;
    schedule->min_refire_us = min_refire_us;
    schedule->path_change_us = EERUF_AS_T_DELTA;
    handle->schedules[handle->schedule_count++] = schedule;
}

/* Needs of each sensor: window, t_delta and group, and more in flow rings. */
static EerufLimits *limits_of(uint8_t sensors, const uint32_t *own, uint8_t numbers) {
    EerufLimits *limits = (EerufLimits *)calloc(sensors, sizeof *limits);
    uint8_t x;
    for (x = 0; x < sensors; x++, own += numbers) {
        limits[x].window_us = own[0];
        limits[x].t_delta_us = (uint16_t)own[1];
        limits[x].group = (uint8_t)own[2];
    }
    return limits;
}

/* Stores the requirements of a schedule if eeruf_schedule_check accepts them. `numbers`: t_delta, interval, window,
   separation, path change, audible; layout, neighbours, stale echo. */
int shim_verified(Handle *handle, unsigned number, const uint32_t *numbers, const uint32_t *own) {
    EerufSchedule *schedule = handle->schedules[number];
    const EerufSchedule before = *schedule;
    EerufStatus status;
    free(handle->limits[number]);
    handle->limits[number] = own == NULL ? NULL : limits_of(schedule->sensors, own, 3);
    schedule->limits = handle->limits[number];
    schedule->t_delta_us = numbers[0];
    schedule->min_interval_us = numbers[1];
    schedule->window_us = numbers[2];
    schedule->separation_us = numbers[3];
    schedule->path_change_us = numbers[4];
    schedule->audible_us = numbers[5];
    schedule->layout = (uint8_t)numbers[6];
    schedule->neighbours = (uint8_t)numbers[7];
    schedule->stale_echo = (uint8_t)numbers[8];
    schedule->verified = 1;
    status = eeruf_schedule_check(schedule);
    if (status != EERUF_OK) *schedule = before;
    return status;
}

/* `listening`: t_delta, window, blanking, path change, audible. */
int shim_ring(Handle *handle, unsigned schedule, const uint32_t *listening, uint8_t consecutive, uint32_t now_us) {
    EerufConfig config = EERUF_CONFIG;
    const size_t sensors_size = handle->schedules[schedule]->sensors * sizeof(EerufSensor);
    config.t_delta_us = listening[0];
    config.window_us = listening[1];
    config.blanking_us = listening[2];
    config.path_change_us = listening[3];
    config.audible_us = listening[4];
    config.consecutive = consecutive;
    free(handle->sensors);
    if (handle->ring == NULL) handle->ring = (EerufRing *)malloc(sizeof(EerufRing));
    handle->sensors = (EerufSensor *)malloc(sensors_size);
    return eeruf_ring_init_unverified(handle->ring, sizeof(EerufRing), handle->sensors, sensors_size,
                                      handle->schedules[schedule], &config, now_us);
}

static void flatten(const EerufEvent *event, uint32_t *out) {
    unsigned kind;
    out[0] = event->kind;
    out[1] = event->sensor;
    out[2] = event->phase;
    out[3] = event->kind == EERUF_EVENT_FIRE ? event->u.due_us : event->period;
    if (event->kind == EERUF_EVENT_READING) {
        out[4] = event->u.reading.kind;
        out[5] = event->u.reading.t_echo_us;
        out[6] = event->u.reading.previous_us;
        out[7] = event->u.reading.age;
        out[8] = event->u.reading.explained_by;
    } else if (event->kind == EERUF_EVENT_PERIOD) {
        out[4] = event->u.ended.max_late_us;
        out[5] = event->u.ended.sum_late_us;
        for (kind = 0; kind < EERUF_READING_KINDS; kind++) out[6 + kind] = event->u.ended.tally[kind];
    }
}

/* `out` has 18 places, all zero. */
int shim_poll(Handle *handle, uint32_t now_us, const int32_t *change_us, uint32_t *out) {
    const EerufStatus status = handle->flow != NULL
                                   ? eeruf_flow_poll(handle->flow, now_us, &handle->last)
                                   : eeruf_ring_poll_expecting(handle->ring, now_us, change_us, &handle->last);
    if (status != EERUF_EVENT) return status;
    flatten(&handle->last, out);
    return handle->watched == NULL || eeruf_watch_event(&handle->watch, &handle->last, now_us) == EERUF_OK ? status : -99;
}

/* `out`: sensor and instant. */
int shim_upcoming(const Handle *handle, uint8_t number, uint32_t *out) {
    uint8_t sensor = 0;
    const EerufStatus status = eeruf_ring_upcoming(handle->ring, number, &sensor, &out[1]);
    out[0] = sensor;
    return status;
}

/* A watch of the events that are polled from now on. */
int shim_watch(Handle *handle, uint8_t sensors, uint32_t now_us) {
    const size_t size = sensors * sizeof(EerufWatched);
    handle->watched = (EerufWatched *)malloc(size);
    return eeruf_watch_init(&handle->watch, sizeof handle->watch, handle->watched, size, now_us);
}

/* `out`: kind, echo, age, why, explained by. */
int shim_state(const Handle *handle, uint8_t sensor, uint32_t now_us, uint32_t *out) {
    EerufState state = {0, 0, 0, 0, 0};
    const EerufStatus status = eeruf_watch_state(&handle->watch, sensor, now_us, &state);
    out[0] = state.kind;
    out[1] = state.t_echo_us;
    out[2] = state.age_us;
    out[3] = state.why;
    out[4] = state.explained_by;
    return status;
}

uint32_t shim_deadline(const Handle *handle) {
    return eeruf_ring_deadline(handle->ring);
}

/* Calls of functions on a running ring, by number. */
int shim_do(Handle *handle, unsigned what, uint8_t sensor, uint32_t value) {
    EerufRing *ring = handle->ring;
    switch (what) {
    case 0: return eeruf_ring_echo(ring, sensor, value);
    case 1: return eeruf_ring_fired(ring, sensor, value);
    case 2: return eeruf_ring_stuck(ring, sensor);
    case 3:
        if (handle->flow != NULL) return eeruf_flow_enable(handle->flow, sensor, value != 0);
        return eeruf_ring_enable(ring, sensor, value != 0);
    case 4:
        if (handle->flow != NULL) return eeruf_flow_pause(handle->flow, value != 0);
        return eeruf_ring_pause(ring, value != 0);
    case 5:
        if (handle->flow != NULL) return eeruf_flow_restart(handle->flow, value);
        return eeruf_ring_restart(ring, value);
    case 6: return eeruf_hc_sr04_edge(&handle->modules, sensor & 0x7fu, sensor >> 7, value);
    case 7: return eeruf_hc_sr04_fire(&handle->modules, sensor & 0x7fu, sensor >> 7);
    case 8: return eeruf_hc_sr04_cannot_read(&handle->modules, sensor);
    case 9: return eeruf_hc_sr04_cannot_write(&handle->modules, sensor);
    case 10: return eeruf_hc_sr04_fired(&handle->modules, sensor, value);
    case 11: return eeruf_hc_sr04_health(&handle->modules, sensor);
    case 12: return eeruf_ring_is_enabled(ring, sensor);
    case 13: return (int)eeruf_ring_fired_at(ring, sensor);
    case 14: return eeruf_ring_set_silence(ring, (uint8_t)value);
    case 15: return eeruf_ring_answered(ring, sensor);
    case 16: return eeruf_ring_unanswered(ring, sensor);
    case 17: return eeruf_ring_forget(ring, sensor);
    case 18: return eeruf_ring_measured(ring, sensor, value);
    case 19: return eeruf_hc_sr04_triggered(&handle->modules, sensor);
    case 20: return eeruf_hc_sr04_pulse(&handle->modules, sensor, value);
    case 21: return eeruf_ring_holds(ring, sensor);
    default: return eeruf_ring_set_report_after(ring, value);
    }
}

/* A value between two numbers: an echo, a measured time, an edge, a look. */
int shim_between(Handle *handle, unsigned what, uint8_t sensor, uint32_t least, uint32_t most) {
    switch (what) {
    case 0: return eeruf_ring_echo_between(handle->ring, sensor, least, most);
    case 1: return eeruf_ring_measured_between(handle->ring, sensor, least, most);
    case 2: return eeruf_hc_sr04_edge_between(&handle->modules, sensor & 0x7fu, sensor >> 7, least, most);
    default: return eeruf_hc_sr04_look(&handle->modules, sensor & 0x7fu, sensor >> 7, least, most);
    }
}

int shim_modules(Handle *handle, uint32_t min_retrigger_us, uint16_t shortest_us) {
    const EerufHcSr04Settings usual = EERUF_HC_SR04;
    const size_t size = handle->ring->count * sizeof(EerufLine);
    handle->settings = usual;
    handle->settings.min_retrigger_us = min_retrigger_us;
    handle->settings.shortest_us = shortest_us;
    free(handle->lines);
    handle->lines = (EerufLine *)malloc(size);
    return eeruf_hc_sr04_init(&handle->modules, sizeof handle->modules, handle->lines, size, handle->ring,
                              &handle->settings);
}

/* `numbers`: window, blanking, least, most, rest, dice, seed; t_delta, near, path change, memory, hold, top speed, alone,
   votes. `own`: window, t_delta, group and line of each sensor; or null. */
int shim_flow(Handle *handle, uint8_t sensors, const uint32_t *numbers, const uint32_t *own, uint32_t now_us) {
    EerufFlowConfig config = EERUF_FLOW(0, 0);
    const size_t size = sensors * sizeof(EerufFlowSensor);
    config.sensors = sensors;
    config.window_us = numbers[0];
    config.blanking_us = numbers[1];
    config.least_us = numbers[2];
    config.most_us = numbers[3];
    config.rest_us = numbers[4];
    config.dice_us = numbers[5];
    config.seed = numbers[6];
    config.t_delta_us = (uint16_t)numbers[7];
    config.near_us = (uint16_t)numbers[8];
    config.path_change_us = (uint16_t)numbers[9];
    config.memory = (uint8_t)numbers[10];
    config.hold = (uint8_t)numbers[11];
    config.top_speed_mm_s = (uint16_t)numbers[12];
    config.alone = (uint8_t)numbers[13];
    config.votes = (uint8_t)numbers[14];
    if (own != NULL) {
        uint8_t x;
        handle->own.sensors = sensors;
        handle->own.limits = limits_of(sensors, own, 4);
        config.own = &handle->own;
        config.lines = handle->shared_lines = (uint8_t *)malloc(sensors);
        for (x = 0; x < sensors; x++) handle->shared_lines[x] = (uint8_t)own[4 * x + 3];
    }
    handle->flow = (EerufFlowRing *)malloc(sizeof(EerufFlowRing));
    handle->flow_sensors = (EerufFlowSensor *)malloc(size);
    handle->ring = &handle->flow->ring;
    return eeruf_flow_init(handle->flow, sizeof(EerufFlowRing), handle->flow_sensors, size, &config, now_us);
}

int shim_moving(Handle *handle, uint32_t speed_mm_s, uint32_t turn_mrad_s, uint32_t now_us) {
    return eeruf_flow_moving(handle->flow, speed_mm_s, turn_mrad_s, now_us);
}

/* `out`: quiet, and the believed echo time. */
void shim_quiet(const Handle *handle, uint8_t sensor, uint32_t *out) {
    out[0] = eeruf_flow_quiet_us(handle->flow, sensor);
    out[1] = eeruf_flow_believed_us(handle->flow, sensor);
}

static EerufEdges edges;
static EerufEdge places[8];

void shim_edges_new(void) {
    (void)eeruf_edges_init(&edges, sizeof edges, places, sizeof places);
}

int shim_edges_push(uint8_t sensor, uint8_t high, uint32_t at_us) {
    return eeruf_edges_push(&edges, sensor, high, at_us);
}

int shim_edges_pop(uint32_t *out) {
    EerufEdge edge = {0, 0, false, 0};
    const EerufStatus status = eeruf_edges_pop(&edges, &edge);
    out[0] = edge.sensor;
    out[1] = edge.high;
    out[2] = edge.at_us;
    out[3] = edges.lost;
    return status;
}

/* Makes the last event, a reading, ambiguous. */
void shim_explain(Handle *handle, uint8_t explained_by) {
    handle->last.u.reading.kind = EERUF_READING_AMBIGUOUS;
    handle->last.u.reading.explained_by = explained_by;
}

/* Makes the serial frame of the last poll's event; returns its size. */
size_t shim_serial_event(Handle *handle, uint8_t sensors, uint32_t now_us, uint8_t *frame) {
    if (handle->line.clock == NULL) {
        const EerufSerial line = EERUF_SERIAL(handle->late_us, sensors, "board of sixteen letters");
        handle->line = line;
    }
    return eeruf_serial_event(&handle->line, handle->ring, NULL, &handle->last, now_us, frame);
}

/* Each mistake of a caller has a status: null, too little memory, a sensor out of range, use before initialisation,
   another version. The exit code is 0 if each call returns the expected status. */
#include "eeruf.h"

#include <stdio.h>
#include <string.h>

static int wrong;

#define EXPECT(call, status)                                                                                           \
    do {                                                                                                               \
        const long got = (long)(call);                                                                                 \
        if (got != (long)(status)) {                                                                                   \
            printf("line %d: %s: %ld, expected %ld\n", __LINE__, #call, got, (long)(status));                          \
            wrong++;                                                                                                   \
        }                                                                                                              \
    } while (0)

/* A call with one field of a good structure changed. */
#define WITH(type, good, field, value, call, status)                                                                   \
    do {                                                                                                               \
        type with = good;                                                                                              \
        with.field = value;                                                                                            \
        EXPECT(call, status);                                                                                          \
    } while (0)

#define SENSORS 4u
static uint8_t order[2 * SENSORS] = {0, 1, 2, 3, 0, 1, 2, 3};
static uint32_t gaps[2 * (SENSORS + 1)] = {0, 15000, 15000, 15000, 15000, 0, 17000, 17000, 17000, 9000};
static const EerufSchedule schedule = {
    EERUF_VERSION, SENSORS, 2, order, gaps, 60000, 54000, 999, 9000, 36000, 2000, EERUF_AS_T_DELTA, 60000, 1,
    EERUF_LAYOUT_LINE, 4, 0, NULL,
};
static EerufSchedule unverified, empty;
static EerufRing ring, not_ready;
static EerufSensor sensors[SENSORS];
static EerufEvent event;
static const EerufConfig usual = EERUF_CONFIG;

static void schedules(void) {
    unverified = schedule;
    unverified.verified = 0;
    EXPECT(eeruf_schedule_check(NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_schedule_check(&empty), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_schedule_check(&unverified), EERUF_ERR_UNVERIFIED);
    EXPECT(eeruf_schedule_check(&schedule), EERUF_OK);
    /* Each number of a table is checked. */
#define TABLE(field, value, status) WITH(EerufSchedule, schedule, field, value, eeruf_schedule_check(&with), status)
    TABLE(version, EERUF_VERSION + 1, EERUF_ERR_VERSION);
    TABLE(sensors, 65, EERUF_ERR_SENSORS);
    TABLE(phases, 0, EERUF_ERR_PHASES);
    TABLE(period_us, 0, EERUF_ERR_PERIOD);
    TABLE(period_us, EERUF_MAX_PERIOD_US + 1, EERUF_ERR_PERIOD);
    TABLE(period_us, 61000, EERUF_ERR_FIRE);
    TABLE(min_refire_us, 54001, EERUF_ERR_TABLE);
    TABLE(separation_us, 2001, EERUF_ERR_TABLE);
    TABLE(audible_us, 60001, EERUF_ERR_TABLE);
    TABLE(path_change_us, 1001, EERUF_ERR_CROSSTALK);
    TABLE(path_change_us, 1000, EERUF_OK);
    TABLE(t_delta_us, 1000, EERUF_ERR_CROSSTALK);
    TABLE(stale_echo, 1, EERUF_ERR_STALE_ECHO);
    TABLE(min_interval_us, 9001, EERUF_ERR_INTERVAL);
    TABLE(window_us, 54001, EERUF_ERR_WINDOW);
    order[1] = 0; /* twice */
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_TABLE);
    order[1] = 4;
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_TABLE);
    order[1] = 1;
    gaps[1] += 60000;
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_TABLE);
    gaps[1] -= 60000;
    EXPECT(eeruf_schedule_check(&schedule), EERUF_OK);
    /* Sensors that are not all alike. */
    {
        EerufLimits limits[4] = {{36000, 999, 0}, {20000, 400, 0}, {0, 999, 0}, {12000, 999, 0}};
        EerufSchedule unlike = schedule;
        unlike.limits = limits;
        unlike.window_us = unlike.min_refire_us;
        EXPECT(eeruf_schedule_check(&unlike), EERUF_OK);
        limits[3].t_delta_us = 1000;
        EXPECT(eeruf_schedule_check(&unlike), EERUF_ERR_CROSSTALK);
        limits[3].t_delta_us = 998;
        EXPECT(eeruf_schedule_check(&unlike), EERUF_OK);
        limits[0].window_us = UINT32_MAX;
        EXPECT(eeruf_schedule_check(&unlike), EERUF_ERR_WINDOW);
        limits[0].window_us = 0;
        limits[0].group = limits[1].group = 1;
        EXPECT(eeruf_schedule_check(&unlike), EERUF_ERR_TOGETHER);
    }
}

static EerufStatus init(size_t ring_size, size_t sensors_size, const EerufSchedule *by, const EerufConfig *config) {
    return eeruf_ring_init(&ring, ring_size, sensors, sensors_size, by, config, 0);
}

static void before_init(EerufRing *none, int status) {
    EXPECT(eeruf_ring_poll(none, 0, &event), status);
    EXPECT(eeruf_ring_poll_expecting(none, 0, NULL, &event), status);
    EXPECT(eeruf_ring_deadline(none), 0);
    EXPECT(eeruf_ring_echo(none, 0, 0), status);
    EXPECT(eeruf_ring_fired(none, 0, 0), status);
    EXPECT(eeruf_ring_stuck(none, 0), status);
    EXPECT(eeruf_ring_unanswered(none, 0), status);
    EXPECT(eeruf_ring_set_silence(none, 0), status);
    EXPECT(eeruf_ring_enable(none, 0, true), status);
    EXPECT(eeruf_ring_is_enabled(none, 0), false);
    EXPECT(eeruf_ring_pause(none, true), status);
    EXPECT(eeruf_ring_restart(none, 0), status);
    EXPECT(eeruf_ring_set_report_after(none, 1), status);
    EXPECT(eeruf_ring_fired_at(none, 0), 0);
}

static void rings(void) {
    const size_t r = sizeof ring, s = sizeof sensors;
    before_init(NULL, EERUF_ERR_NULL);
    before_init(&not_ready, EERUF_ERR_NOT_READY);
    EXPECT(eeruf_ring_init(NULL, r, sensors, s, &schedule, &usual, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_init(&ring, r, NULL, s, &schedule, &usual, 0), EERUF_ERR_NULL);
    EXPECT(init(r, s, NULL, &usual), EERUF_ERR_NULL);
    EXPECT(init(r, s, &schedule, NULL), EERUF_ERR_NULL);
    EXPECT(init(r - 1, s, &schedule, &usual), EERUF_ERR_MEMORY);
    EXPECT(init(r + 1, s, &schedule, &usual), EERUF_ERR_MEMORY);
    EXPECT(init(r, s - 1, &schedule, &usual), EERUF_ERR_MEMORY);
    EXPECT(init(r, s, &empty, &usual), EERUF_ERR_NOT_READY);
    EXPECT(init(r, s, &unverified, &usual), EERUF_ERR_UNVERIFIED);
    EXPECT(eeruf_ring_init_unverified(&ring, r, sensors, s, &unverified, &usual, 0),
           EERUF_ERR_UNVERIFIED); /* nor does it give t_delta and window */
#define CONFIG(field, value, status) WITH(EerufConfig, usual, field, value, init(r, s, &schedule, &with), status)
    CONFIG(version, EERUF_VERSION + 1, EERUF_ERR_VERSION);
    CONFIG(consecutive, 9, EERUF_ERR_CONSECUTIVE);
    CONFIG(t_delta_us, 1000, EERUF_ERR_T_DELTA);
    CONFIG(window_us, 36001, EERUF_ERR_VERIFIED_WINDOW);
    CONFIG(blanking_us, 36000, EERUF_ERR_BLANKING);
    CONFIG(audible_us, 0x4000001u, EERUF_ERR_AUDIBLE);
    CONFIG(path_change_us, 65535, EERUF_ERR_PATH_CHANGE);
    EXPECT(eeruf_ring_poll(&ring, 0, &event), EERUF_ERR_NOT_READY); /* none of these has made a ring */
    EXPECT(init(r, s, &schedule, &usual), EERUF_OK);
    EXPECT(eeruf_ring_poll(&ring, 0, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_echo(&ring, SENSORS, 0), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_fired(&ring, SENSORS, 0), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_stuck(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_enable(&ring, SENSORS, true), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_fired_at(&ring, SENSORS), 0);
}

static void edge_queues(void) {
    EerufEdge places[8], edge;
    EerufEdges edges;
    uint8_t pushed;
    memset(&edges, 0, sizeof edges);
    EXPECT(eeruf_edges_init(NULL, sizeof edges, places, sizeof places), EERUF_ERR_NULL);
    EXPECT(eeruf_edges_init(&edges, sizeof edges, NULL, sizeof places), EERUF_ERR_NULL);
    EXPECT(eeruf_edges_init(&edges, sizeof edges - 1, places, sizeof places), EERUF_ERR_MEMORY);
    EXPECT(eeruf_edges_init(&edges, sizeof edges, places, sizeof places[0]), EERUF_ERR_MEMORY);
    EXPECT(eeruf_edges_init(&edges, sizeof edges, places, 6 * sizeof places[0]), EERUF_ERR_RANGE);
    EXPECT(eeruf_edges_push(NULL, 0, true, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_edges_push(&edges, 0, true, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_edges_pop(&edges, &edge), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_edges_init(&edges, sizeof edges, places, sizeof places), EERUF_OK);
    EXPECT(eeruf_edges_pop(&edges, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_edges_pop(&edges, &edge), EERUF_EMPTY);
    EXPECT(eeruf_edges_push(&edges, 128, true, 0), EERUF_ERR_SENSOR);
    for (pushed = 0; pushed < 8; pushed++) EXPECT(eeruf_edges_push(&edges, pushed, true, pushed), EERUF_OK);
    EXPECT(eeruf_edges_push(&edges, 8, true, 8), EERUF_ERR_MEMORY);
    EXPECT(edges.lost, 1);
    /* The uncertainty of an edge is rounded up. */
    EXPECT(eeruf_edges_init(&edges, sizeof edges, places, sizeof places), EERUF_OK);
    EXPECT(eeruf_edges_push_between(&edges, 0, true, 5, 4), EERUF_ERR_BETWEEN);
    EXPECT(eeruf_edges_push_between(&edges, 0, true, UINT32_MAX, 16), EERUF_OK);
    EXPECT(eeruf_edges_push_between(&edges, 0, true, 0, 5000), EERUF_OK);
    EXPECT(eeruf_edges_push_between(&edges, 0, true, 0, 40000), EERUF_OK);
    EXPECT(eeruf_edges_pop(&edges, &edge) == EERUF_OK && edge.at_us == 16 && edge.early == 3, 1);
    EXPECT(eeruf_edges_pop(&edges, &edge) == EERUF_OK && edge.early == 127 + 16, 1);
    EXPECT(eeruf_edges_pop(&edges, &edge) == EERUF_OK && edge.early == 255, 1);
}

static void modules(void) {
    EerufHcSr04Settings settings = EERUF_HC_SR04;
    EerufHcSr04 four, none;
    EerufLine lines[SENSORS];
    EerufEdges edges;
    memset(&none, 0, sizeof none);
    memset(&edges, 0, sizeof edges);
    EXPECT(eeruf_hc_sr04_init(NULL, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, NULL, sizeof lines, &ring, &settings), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, NULL, &settings), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &not_ready, &settings), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four - 1, lines, sizeof lines, &ring, &settings), EERUF_ERR_MEMORY);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines - 1, &ring, &settings), EERUF_ERR_MEMORY);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_ERR_RETRIGGER);
    settings.min_retrigger_us = 54000;
    settings.version++;
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_ERR_VERSION);
    settings.version--;
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_OK);
    EXPECT(eeruf_hc_sr04_fire(NULL, 0, false), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_fire(&none, 0, false), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_fire(&four, SENSORS, false), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_fire(&four, 0, true), EERUF_DO_NOT_TRIGGER);
    EXPECT(eeruf_hc_sr04_health(&four, 0), EERUF_HEALTH_STUCK_HIGH);
    EXPECT(eeruf_hc_sr04_is_stuck(&four, 0), true);
    EXPECT(eeruf_hc_sr04_is_stuck(&four, 1), false);
    EXPECT(eeruf_hc_sr04_is_stuck(&four, SENSORS), false);
    EXPECT(eeruf_hc_sr04_is_stuck(NULL, 0), false);
    EXPECT(eeruf_hc_sr04_cannot_read(&none, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_cannot_write(&four, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_edge(NULL, 0, true, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_edge(&none, 0, true, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_edge(&four, SENSORS, true, 0), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_edge_between(&four, 1, true, 5, 4), EERUF_ERR_BETWEEN);
    EXPECT(eeruf_hc_sr04_look(NULL, 0, true, 0, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_look(&four, SENSORS, true, 0, 0), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_edges(NULL, &edges), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_edges(&none, &edges), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_edges(&four, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_edges(&four, &edges), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_awaits(NULL, 0, NULL), false);
    EXPECT(eeruf_hc_sr04_awaits(&four, SENSORS, NULL), false);
    EXPECT(eeruf_hc_sr04_fired(&none, 0, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_health(NULL, 0), EERUF_HEALTH_MISSING);
    EXPECT(eeruf_hc_sr04_health(&four, SENSORS), EERUF_HEALTH_MISSING);
}

static EerufFlowRing flow;
static EerufFlowSensor flow_sensors[SENSORS];

static EerufStatus begin_flow(size_t flow_size, size_t sensors_size, const EerufFlowConfig *config) {
    return eeruf_flow_init(&flow, flow_size, flow_sensors, sensors_size, config, 0);
}

static void flow_rings(void) {
    const EerufFlowConfig fine = EERUF_FLOW(SENSORS, 36000);
    const size_t r = sizeof flow, s = sizeof flow_sensors;
    static EerufLimits limits[SENSORS];
    static EerufSchedule own;
    EerufFlowConfig config = fine;
    EXPECT(eeruf_flow_poll(NULL, 0, &event), EERUF_ERR_NULL);
    EXPECT(eeruf_flow_poll(&flow, 0, &event), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_flow_moving(NULL, 0, 0, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_flow_enable(&flow, 0, true), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_flow_pause(&flow, true), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_flow_restart(&flow, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_flow_believed_us(&flow, 0), EERUF_NO_ECHO);
    EXPECT(eeruf_flow_init(NULL, r, flow_sensors, s, &config, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_flow_init(&flow, r, NULL, s, &config, 0), EERUF_ERR_NULL);
    EXPECT(begin_flow(r, s, NULL), EERUF_ERR_NULL);
    EXPECT(begin_flow(r - 1, s, &config), EERUF_ERR_MEMORY);
    EXPECT(begin_flow(r, s - 1, &config), EERUF_ERR_MEMORY);
#define FLOW(field, value, status) WITH(EerufFlowConfig, fine, field, value, begin_flow(r, s, &with), status)
    FLOW(version, EERUF_VERSION + 1, EERUF_ERR_VERSION);
    FLOW(sensors, 0, EERUF_ERR_SENSORS);
    FLOW(sensors, 65, EERUF_ERR_SENSORS);
    /* Values in milliseconds or m/s, and values that are too long. */
    FLOW(least_us, 6, EERUF_ERR_FLOW_LEAST);
    FLOW(least_us, 33501, EERUF_ERR_FLOW_LEAST);
    FLOW(most_us, 33, EERUF_ERR_FLOW_MOST);
    FLOW(most_us, 250001, EERUF_ERR_FLOW_MOST);
    FLOW(rest_us, 60, EERUF_ERR_FLOW_REST);
    FLOW(rest_us, 4000001, EERUF_ERR_FLOW_REST);
    FLOW(dice_us, 2, EERUF_ERR_FLOW_DICE);
    FLOW(dice_us, 250001, EERUF_ERR_FLOW_DICE);
    FLOW(seed, 0, EERUF_ERR_FLOW_SEED);
    FLOW(t_delta_us, 10001, EERUF_ERR_FLOW_T_DELTA);
    FLOW(near_us, 10001, EERUF_ERR_FLOW_NEAR);
    FLOW(path_change_us, 10001, EERUF_ERR_FLOW_PATH_CHANGE);
    FLOW(top_speed_mm_s, 2, EERUF_ERR_FLOW_TOP_SPEED);
    FLOW(hold, 0, EERUF_ERR_FLOW_HOLD);
    FLOW(hold, 101, EERUF_ERR_FLOW_HOLD);
    FLOW(window_us, 25, EERUF_ERR_FLOW_WINDOW);
    FLOW(votes, 3, EERUF_ERR_RANGE);
    FLOW(own, &own, EERUF_ERR_SENSORS);
    own.sensors = SENSORS;
    own.limits = limits;
    limits[0].window_us = limits[1].window_us = limits[2].window_us = 36000;
    limits[3].window_us = 900;
    config.own = &own;
    EXPECT(begin_flow(r, s, &config), EERUF_OK);
    EXPECT(eeruf_flow_init_alike(&flow, r, flow_sensors, s, &config, 0), EERUF_ERR_RANGE);
    config.blanking_us = 900;
    EXPECT(begin_flow(r, s, &config), EERUF_ERR_BLANKING);
    FLOW(window_us, 4000001, EERUF_ERR_FLOW_WINDOW);
    FLOW(blanking_us, 36000, EERUF_ERR_BLANKING);
    config = fine;
    config.window_us = config.t_delta_us = 9000;
    EXPECT(begin_flow(r, s, &config), EERUF_ERR_COARSE_T_DELTA);
    FLOW(least_us, 33500, EERUF_OK); /* one by one */
    EXPECT(eeruf_flow_quiet_us(&flow, 0), 33500);
    EXPECT(begin_flow(r, s, &fine), EERUF_OK);
    EXPECT(eeruf_flow_quiet_us(&flow, 0), 11500);
    EXPECT(eeruf_flow_quiet_us(&flow, SENSORS), 0);
    EXPECT(eeruf_flow_poll(&flow, 0, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_flow_moving(&flow, UINT32_MAX, UINT32_MAX, 0), EERUF_OK);
    EXPECT(eeruf_flow_enable(&flow, SENSORS, true), EERUF_ERR_SENSOR);
    EXPECT(eeruf_flow_believed_us(&flow, SENSORS), EERUF_NO_ECHO);
    EXPECT(eeruf_ring_poll(&flow.ring, 0, &event), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_enable(&flow.ring, 0, true), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_pause(&flow.ring, true), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_restart(&flow.ring, 0), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_set_report_after(&flow.ring, 60001), EERUF_ERR_WINDOW);
    EXPECT(eeruf_flow_poll((EerufFlowRing *)(void *)&ring, 0, &event), EERUF_ERR_NOT_READY);
}

static void evidence(void) {
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &usual), EERUF_OK);
    EXPECT(eeruf_ring_set_silence(&ring, 3), EERUF_ERR_RANGE);
    EXPECT(eeruf_ring_answered(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_forget(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured(&ring, SENSORS, 1000), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured_between(&ring, SENSORS, 1000, 1001), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured_between(&ring, 0, 1001, 1000), EERUF_ERR_BETWEEN);
    EXPECT(eeruf_ring_echo_between(&ring, 0, 1001, 1000), EERUF_ERR_BETWEEN);
    EXPECT(eeruf_ring_holds(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured(&ring, 0, EERUF_NO_ECHO), EERUF_OK);
}

/* Hardware that fires and reports by itself. */
static void by_hardware(void) {
    const EerufHcSr04Settings settings = EERUF_HC_SR04;
    static const uint32_t longer[] = {0, 15000, 15000, 15000, 23000, 0, 17000, 17000, 17000, 17000};
    EerufSchedule table = unverified;
    EerufHcSr04 modules;
    EerufLine lines[SENSORS];
    EerufConfig config = usual;
    uint32_t due_us = 0;
    uint8_t sensor = 9, number = 0;
    EXPECT(eeruf_ring_upcoming(NULL, 0, &sensor, &due_us), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_upcoming(&not_ready, 0, &sensor, &due_us), EERUF_ERR_NOT_READY);
    table.gap_us = longer;
    table.period_us = 68000;
    table.min_refire_us = 62000;
    config.t_delta_us = 900;
    config.window_us = 40000;
    EXPECT(eeruf_ring_init_unverified(&ring, sizeof ring, sensors, sizeof sensors, &table, &config, 1000), EERUF_OK);
    EXPECT(eeruf_ring_upcoming(&ring, 0, NULL, &due_us), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_upcoming(&ring, 0, &sensor, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_set_report_after(&ring, 62001), EERUF_ERR_WINDOW);
    EXPECT(eeruf_ring_set_report_after(&ring, 50000), EERUF_OK);
    while (eeruf_ring_upcoming(&ring, number, &sensor, &due_us) == EERUF_OK) number++;
    EXPECT(number, 2 * SENSORS); /* this period and the next */
    EXPECT(due_us, 1000 + 68000 + 51000);
    EXPECT(eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, &ring, &settings), EERUF_OK);
    EXPECT(eeruf_hc_sr04_triggered(NULL, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_triggered(&modules, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_pulse(&modules, SENSORS, 9000), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_pulse(&modules, 0, 9000), EERUF_OK); /* not triggered: ignored */
    EXPECT(eeruf_hc_sr04_edges_until(&modules, NULL, 0), EERUF_ERR_NULL);
}

static void watches(void) {
    EerufWatched watched[SENSORS];
    EerufWatch watch;
    EerufState state;
    memset(&watch, 0, sizeof watch);
    EXPECT(eeruf_watch_init(NULL, sizeof watch, watched, sizeof watched, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_watch_init(&watch, sizeof watch, NULL, sizeof watched, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_watch_init(&watch, sizeof watch - 1, watched, sizeof watched, 0), EERUF_ERR_MEMORY);
    EXPECT(eeruf_watch_init(&watch, sizeof watch, watched, sizeof *watched - 1, 0), EERUF_ERR_SENSORS);
    EXPECT(eeruf_watch_event(&watch, &event, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_watch_state(&watch, 0, 0, &state), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_watch_init(&watch, sizeof watch, watched, sizeof watched, 5), EERUF_OK);
    EXPECT(eeruf_watch_event(NULL, &event, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_watch_event(&watch, NULL, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_watch_state(&watch, SENSORS, 0, &state), EERUF_ERR_SENSOR);
    EXPECT(eeruf_watch_state(&watch, 0, 0, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_watch_state(&watch, 1, 25, &state), EERUF_OK);
    EXPECT(state.kind == EERUF_STATE_UNKNOWN && state.why == EERUF_WHY_NO_FIRING && state.age_us == 20, 1);
    event.kind = EERUF_EVENT_READING;
    event.sensor = SENSORS;
    EXPECT(eeruf_watch_event(&watch, &event, 600), EERUF_ERR_SENSOR);
    EXPECT(strcmp(eeruf_state_name(EERUF_STATE_TOO_CLOSE), "too close"), 0);
    EXPECT(strcmp(eeruf_state_name(9), "?"), 0);
}

int main(void) {
    EXPECT(eeruf_version(), EERUF_VERSION);
    schedules();
    rings();
    edge_queues();
    modules();
    evidence();
    watches();
    by_hardware();
    flow_rings();
    printf("%d wrong\n", wrong);
    return wrong != 0;
}

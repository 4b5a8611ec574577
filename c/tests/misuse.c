/* Whatever a caller does wrong has a status: null, memory that is too small, a sensor out of range, use before
   initialisation, another version. Exit code 0 if each call gives the status that it should. */
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

#define SENSORS 4u
static const uint32_t TIMES[2 * SENSORS] = {0, 15000, 30000, 45000, 0, 17000, 34000, 51000};
static uint8_t order[2 * SENSORS];
static uint32_t gaps[2 * (SENSORS + 1)];
static EerufSchedule schedule, unverified, empty;
static EerufRing ring, not_ready;
static EerufSensor sensors[SENSORS];
static EerufEvent event;

static EerufStatus make(size_t order_size, size_t gap_size, uint32_t period_us, uint8_t count, uint8_t phases) {
    return eeruf_schedule_make(&schedule, order, order_size, gaps, gap_size, period_us, count, phases, TIMES);
}

static void schedules(void) {
    EerufRequirements needs = {999, 9000, 36000, EERUF_LAYOUT_LINE, 4, 0, NULL};
    EerufSchedule broken;
    EXPECT(eeruf_schedule_make(NULL, order, sizeof order, gaps, sizeof gaps, 60000, 4, 2, TIMES), EERUF_ERR_NULL);
    EXPECT(eeruf_schedule_make(&schedule, NULL, 0, gaps, sizeof gaps, 60000, 4, 2, TIMES), EERUF_ERR_NULL);
    EXPECT(eeruf_schedule_make(&schedule, order, sizeof order, NULL, 0, 60000, 4, 2, TIMES), EERUF_ERR_NULL);
    EXPECT(eeruf_schedule_make(&schedule, order, sizeof order, gaps, sizeof gaps, 60000, 4, 2, NULL), EERUF_ERR_NULL);
    EXPECT(make(sizeof order, sizeof gaps, 60000, 0, 2), EERUF_ERR_SENSORS);
    EXPECT(make(sizeof order, sizeof gaps, 60000, 65, 2), EERUF_ERR_SENSORS);
    EXPECT(make(sizeof order, sizeof gaps, 60000, 4, 0), EERUF_ERR_PHASES);
    EXPECT(make(sizeof order, sizeof gaps, 60000, 4, 9), EERUF_ERR_PHASES);
    EXPECT(make(sizeof order, sizeof gaps, 0, 4, 2), EERUF_ERR_PERIOD);
    EXPECT(make(sizeof order, sizeof gaps, EERUF_MAX_PERIOD_US + 1, 4, 2), EERUF_ERR_PERIOD);
    EXPECT(make(sizeof order - 1, sizeof gaps, 60000, 4, 2), EERUF_ERR_MEMORY);
    EXPECT(make(sizeof order, sizeof gaps - 1, 60000, 4, 2), EERUF_ERR_MEMORY);
    EXPECT(make(sizeof order, sizeof gaps, 51000, 4, 2), EERUF_ERR_FIRE);
    EXPECT(eeruf_schedule_verify(&empty, &needs), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_schedule_check(&empty), EERUF_ERR_NOT_READY);
    EXPECT(make(sizeof order, sizeof gaps, 60000, 4, 2), EERUF_OK);
    EXPECT(eeruf_schedule_check(NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_UNVERIFIED);
    EXPECT(eeruf_schedule_verify(NULL, &needs), EERUF_ERR_NULL);
    EXPECT(eeruf_schedule_verify(&schedule, NULL), EERUF_ERR_NULL);
    unverified = schedule;
    needs.t_delta_us = 1000;
    EXPECT(eeruf_schedule_verify(&schedule, &needs), EERUF_ERR_CROSSTALK);
    needs.t_delta_us = 999;
    needs.stale_echo = 1;
    EXPECT(eeruf_schedule_verify(&schedule, &needs), EERUF_ERR_STALE_ECHO);
    needs.stale_echo = 0;
    needs.min_interval_us = 9001;
    EXPECT(eeruf_schedule_verify(&schedule, &needs), EERUF_ERR_INTERVAL);
    needs.min_interval_us = 9000;
    needs.window_us = 54001;
    EXPECT(eeruf_schedule_verify(&schedule, &needs), EERUF_ERR_WINDOW);
    needs.window_us = 36000;
    needs.layout = EERUF_LAYOUT_OTHER;
    EXPECT(eeruf_schedule_verify(&schedule, &needs), EERUF_ERR_RANGE);
    needs.layout = EERUF_LAYOUT_LINE;
    EXPECT(eeruf_schedule_verify(&schedule, &needs), EERUF_OK);
    EXPECT(eeruf_schedule_check(&schedule), EERUF_OK);
    /* Sensors that are not all alike. */
    {
        EerufLimits limits[4] = {{36000, 999, 0}, {20000, 400, 0}, {0, 999, 0}, {12000, 999, 0}};
        EerufSchedule unlike = unverified;
        EerufRequirements each = needs;
        each.limits = limits;
        EXPECT(eeruf_schedule_verify(&unlike, &each), EERUF_OK);
        EXPECT(unlike.t_delta_us == 999 && unlike.window_us == unlike.min_refire_us, 1);
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
    /* Each number of a table is checked. */
    broken = schedule;
    broken.version++;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_VERSION);
    EXPECT(eeruf_schedule_verify(&broken, &needs), EERUF_ERR_VERSION);
    broken = schedule;
    broken.sensors = 65;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_SENSORS);
    broken = schedule;
    broken.phases = 0;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_PHASES);
    broken = schedule;
    broken.period_us = 0;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_PERIOD);
    broken.period_us = 61000;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_FIRE);
    broken = schedule;
    broken.min_refire_us++;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_TABLE);
    broken = schedule;
    broken.separation_us++;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_TABLE);
    broken = schedule;
    broken.audible_us++;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_TABLE);
    broken = schedule;
    broken.path_change_us = broken.separation_us - broken.t_delta_us;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_CROSSTALK);
    broken.path_change_us--;
    EXPECT(eeruf_schedule_check(&broken), EERUF_OK);
    broken = schedule;
    broken.t_delta_us = 1000;
    EXPECT(eeruf_schedule_check(&broken), EERUF_ERR_CROSSTALK);
    order[1] = 0; /* twice */
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_TABLE);
    order[1] = 4;
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_TABLE);
    order[1] = 1;
    gaps[1] += 60000;
    EXPECT(eeruf_schedule_check(&schedule), EERUF_ERR_TABLE);
    gaps[1] -= 60000;
    EXPECT(eeruf_schedule_check(&schedule), EERUF_OK);
    EXPECT(eeruf_schedule_max_speed_mm_s(NULL, 999, EERUF_SOUND_20C), 0);
    EXPECT(eeruf_schedule_max_speed_mm_s(&empty, 999, EERUF_SOUND_20C), 0);
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
    EXPECT(eeruf_ring_enable(none, 0, true), status);
    EXPECT(eeruf_ring_is_enabled(none, 0), false);
    EXPECT(eeruf_ring_pause(none, true), status);
    EXPECT(eeruf_ring_restart(none, 0), status);
    EXPECT(eeruf_ring_change_schedule(none, &schedule), status);
    EXPECT(eeruf_ring_change_to_unverified(none, &schedule), status);
    EXPECT(eeruf_ring_set_t_delta(none, 1), status);
    EXPECT(eeruf_ring_set_window(none, 1), status);
    EXPECT(eeruf_ring_set_blanking(none, 1), status);
    EXPECT(eeruf_ring_set_path_change(none, 1), status);
    EXPECT(eeruf_ring_set_audible(none, 1), status);
    EXPECT(eeruf_ring_fired_at(none, 0), 0);
}

static void rings(void) {
    EerufConfig config = EERUF_CONFIG;
    before_init(NULL, EERUF_ERR_NULL);
    before_init(&not_ready, EERUF_ERR_NOT_READY);
    EXPECT(eeruf_ring_init(NULL, sizeof ring, sensors, sizeof sensors, &schedule, &config, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_init(&ring, sizeof ring, NULL, sizeof sensors, &schedule, &config, 0), EERUF_ERR_NULL);
    EXPECT(init(sizeof ring, sizeof sensors, NULL, &config), EERUF_ERR_NULL);
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, NULL), EERUF_ERR_NULL);
    EXPECT(init(sizeof ring - 1, sizeof sensors, &schedule, &config), EERUF_ERR_MEMORY);
    EXPECT(init(sizeof ring + 1, sizeof sensors, &schedule, &config), EERUF_ERR_MEMORY);
    EXPECT(init(sizeof ring, sizeof sensors - 1, &schedule, &config), EERUF_ERR_MEMORY);
    EXPECT(init(sizeof ring, sizeof sensors, &empty, &config), EERUF_ERR_NOT_READY);
    EXPECT(init(sizeof ring, sizeof sensors, &unverified, &config), EERUF_ERR_UNVERIFIED);
    EXPECT(eeruf_ring_init_unverified(&ring, sizeof ring, sensors, sizeof sensors, &unverified, &config, 0),
           EERUF_ERR_UNVERIFIED); /* it does not say t_delta and window either */
    config.version++;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_VERSION);
    config.version--;
    config.consecutive = 9;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_CONSECUTIVE);
    config.consecutive = 2;
    config.t_delta_us = 1000;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_T_DELTA);
    config.t_delta_us = 0;
    config.window_us = 36001;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_VERIFIED_WINDOW);
    config.window_us = 0;
    config.blanking_us = 36000;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_BLANKING);
    config.blanking_us = 0;
    config.audible_us = 0x4000001u;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_AUDIBLE);
    config.audible_us = 0x4000000u;
    config.path_change_us = 65535;
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_ERR_PATH_CHANGE);
    config.path_change_us = config.audible_us = 0;
    EXPECT(eeruf_ring_poll(&ring, 0, &event), EERUF_ERR_NOT_READY); /* none of these has made a ring */
    EXPECT(init(sizeof ring, sizeof sensors, &schedule, &config), EERUF_OK);
    EXPECT(eeruf_ring_poll(&ring, 0, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_echo(&ring, SENSORS, 0), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_fired(&ring, SENSORS, 0), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_stuck(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_enable(&ring, SENSORS, true), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_change_schedule(&ring, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_change_schedule(&ring, &empty), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_ring_change_schedule(&ring, &unverified), EERUF_ERR_UNVERIFIED);
    EXPECT(eeruf_ring_set_t_delta(&ring, 1000), EERUF_ERR_T_DELTA);
    EXPECT(eeruf_ring_set_window(&ring, 900), EERUF_ERR_COARSE_T_DELTA);
    EXPECT(eeruf_ring_set_blanking(&ring, 36000), EERUF_ERR_BLANKING);
    EXPECT(eeruf_ring_set_path_change(&ring, 65535), EERUF_ERR_PATH_CHANGE);
    EXPECT(eeruf_ring_set_path_change(&ring, EERUF_AS_T_DELTA), EERUF_ERR_PATH_CHANGE);
    EXPECT(eeruf_ring_set_path_change(&ring, 65534), EERUF_OK);
    EXPECT(eeruf_ring_set_audible(&ring, 0x4000001u), EERUF_ERR_AUDIBLE);
    EXPECT(eeruf_ring_set_audible(&ring, 0x4000000u), EERUF_OK);
    EXPECT(eeruf_ring_fired_at(&ring, SENSORS), 0);
}

static void filters_and_edges(void) {
    EerufFilter filter = EERUF_FILTER;
    EerufReading reading;
    EerufEdge places[8], edge;
    EerufEdges edges;
    uint8_t pushed;
    memset(&edges, 0, sizeof edges);
    EXPECT(eeruf_filter_push(NULL, 1, 2, 1, 0, &reading), EERUF_ERR_NULL);
    EXPECT(eeruf_filter_push(&filter, 1, 2, 1, 0, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_filter_push(&filter, 1, 1, 1, 0, &reading), EERUF_ERR_CONSECUTIVE);
    EXPECT(eeruf_filter_push(&filter, 65536, 2, 1, 0, &reading), EERUF_ERR_COARSE_T_DELTA);
    EXPECT(eeruf_filter_push(&filter, 1, 2, 0x80000000u, 0, &reading), EERUF_ERR_RANGE);
    EXPECT(eeruf_filter_forget(NULL), EERUF_ERR_NULL);
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
    /* The time by which an edge may have come sooner is rounded up. */
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
    EXPECT(eeruf_hc_sr04_change_schedule(&none, &schedule), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_change_schedule(&four, &empty), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_hc_sr04_health(NULL, 0), EERUF_HEALTH_MISSING);
    EXPECT(eeruf_hc_sr04_health(&four, SENSORS), EERUF_HEALTH_MISSING);
}

static void adaptations(void) {
    const EerufSchedule *ladder[2];
    EerufAdaptation adaptation;
    memset(&adaptation, 0, sizeof adaptation);
    ladder[0] = ladder[1] = &schedule;
    event.kind = EERUF_EVENT_FIRE;
    EXPECT(eeruf_adaptation_init(NULL, sizeof adaptation, ladder, 1), EERUF_ERR_NULL);
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation, NULL, 1), EERUF_ERR_NULL);
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation - 1, ladder, 1), EERUF_ERR_MEMORY);
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation, ladder, 0), EERUF_ERR_LADDER);
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation, ladder, 2), EERUF_ERR_LADDER);
    EXPECT(eeruf_adaptation_period(&adaptation, &ring, &event), EERUF_ERR_NOT_READY);
    ladder[1] = &unverified;
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation, ladder, 2), EERUF_ERR_UNVERIFIED);
    ladder[1] = NULL;
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation, ladder, 2), EERUF_ERR_NULL);
    EXPECT(eeruf_adaptation_init(&adaptation, sizeof adaptation, ladder, 1), EERUF_OK);
    EXPECT(eeruf_adaptation_period(NULL, &ring, &event), EERUF_ERR_NULL);
    EXPECT(eeruf_adaptation_period(&adaptation, NULL, &event), EERUF_ERR_NULL);
    EXPECT(eeruf_adaptation_period(&adaptation, &ring, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_adaptation_period(&adaptation, &not_ready, &event), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_adaptation_period(&adaptation, &ring, &event), EERUF_ERR_RANGE);
}

#if EERUF_WITH_FLOW
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
#undef WITH
#define WITH(field, value, status)                                                                                     \
    config = fine;                                                                                                     \
    config.field = value;                                                                                              \
    EXPECT(begin_flow(r, s, &config), status)
    WITH(version, EERUF_VERSION + 1, EERUF_ERR_VERSION);
    WITH(sensors, 0, EERUF_ERR_SENSORS);
    WITH(sensors, 65, EERUF_ERR_SENSORS);
    /* Milliseconds, metres a second, and what is too long. */
    WITH(least_us, 6, EERUF_ERR_FLOW_LEAST);
    WITH(least_us, 33501, EERUF_ERR_FLOW_LEAST);
    WITH(most_us, 33, EERUF_ERR_FLOW_MOST);
    WITH(most_us, 250001, EERUF_ERR_FLOW_MOST);
    WITH(rest_us, 60, EERUF_ERR_FLOW_REST);
    WITH(rest_us, 4000001, EERUF_ERR_FLOW_REST);
    WITH(dice_us, 2, EERUF_ERR_FLOW_DICE);
    WITH(dice_us, 250001, EERUF_ERR_FLOW_DICE);
    WITH(seed, 0, EERUF_ERR_FLOW_SEED);
    WITH(t_delta_us, 10001, EERUF_ERR_FLOW_T_DELTA);
    WITH(near_us, 10001, EERUF_ERR_FLOW_NEAR);
    WITH(path_change_us, 10001, EERUF_ERR_FLOW_PATH_CHANGE);
    WITH(top_speed_mm_s, 2, EERUF_ERR_FLOW_TOP_SPEED);
    WITH(hold, 0, EERUF_ERR_FLOW_HOLD);
    WITH(hold, 101, EERUF_ERR_FLOW_HOLD);
    WITH(window_us, 25, EERUF_ERR_FLOW_WINDOW);
    WITH(votes, 3, EERUF_ERR_RANGE);
    WITH(own, &own, EERUF_ERR_SENSORS);
    own.sensors = SENSORS;
    own.limits = limits;
    limits[0].window_us = limits[1].window_us = limits[2].window_us = 36000;
    limits[3].window_us = 900;
    WITH(own, &own, EERUF_OK);
    EXPECT(eeruf_flow_init_alike(&flow, r, flow_sensors, s, &config, 0), EERUF_ERR_RANGE);
    config.blanking_us = 900;
    EXPECT(begin_flow(r, s, &config), EERUF_ERR_BLANKING);
    WITH(window_us, 4000001, EERUF_ERR_FLOW_WINDOW);
    WITH(blanking_us, 36000, EERUF_ERR_BLANKING);
    WITH(window_us, 9000, EERUF_OK);
    config.t_delta_us = 9000;
    EXPECT(begin_flow(r, s, &config), EERUF_ERR_COARSE_T_DELTA);
    WITH(least_us, 33500, EERUF_OK); /* one by one */
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
    EXPECT(eeruf_ring_set_t_delta(&flow.ring, 1), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_set_window(&flow.ring, 1), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_set_blanking(&flow.ring, 1), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_set_path_change(&flow.ring, 1), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_set_audible(&flow.ring, 1), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_change_schedule(&flow.ring, &schedule), EERUF_ERR_FLOW);
    EXPECT(eeruf_ring_set_report_after(&flow.ring, 60001), EERUF_ERR_WINDOW);
    EXPECT(eeruf_flow_poll((EerufFlowRing *)(void *)&ring, 0, &event), EERUF_ERR_NOT_READY);
}

/* A wall before each sensor and a loop that is late by up to 5 ms: nearly all is believed, and at once. */
static void flow_believes_walls_in_a_late_loop(void) {
    EerufFlowConfig config = EERUF_FLOW(SENSORS, 36000);
    uint32_t now = 0xfff00000u, edges[SENSORS], noise = 1;
    unsigned readings = 0, accepted = 0, waits = 0;
    uint8_t x;
    config.seed = 7;
    EXPECT(eeruf_flow_init(&flow, sizeof flow, flow_sensors, sizeof flow_sensors, &config, now), EERUF_OK);
    while (readings < 2000) {
        uint32_t next = eeruf_ring_deadline(&flow.ring);
        noise = noise * 1664525u + 1013904223u;
        if (next - now < 0x80000000u) now = next;
        now += noise >> 8 & 4095u;
        for (x = 0; x < SENSORS; x++) {
            if (!(waits >> x & 1u) || now - edges[x] >= 0x80000000u) continue;
            EXPECT(eeruf_ring_echo(&flow.ring, x, edges[x]), EERUF_OK);
            waits &= ~(1u << x);
        }
        while (eeruf_flow_poll(&flow, now, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_FIRE) {
                edges[event.sensor] = now + 4000u + 3000u * event.sensor;
                waits |= 1u << event.sensor;
            }
            if (event.kind != EERUF_EVENT_READING) continue;
            readings++;
            accepted += event.u.reading.kind == EERUF_READING_ACCEPTED;
        }
    }
    EXPECT(accepted >= 1950, 1);
    EXPECT(eeruf_flow_believed_us(&flow, 3), 13000);
}

/* A loop that finds the end of a pulse after the window, but last saw the line high within it: no silence. */
static void an_end_found_late_is_no_silence(void) {
    EerufFlowConfig config = EERUF_FLOW(1, 23310);
    EerufHcSr04Settings settings = EERUF_HC_SR04;
    EerufHcSr04 module;
    EerufLine line;
    EerufEdge places[2];
    EerufEdges edges;
    uint32_t now = 0;
    uint8_t firings = 0;
    EXPECT(eeruf_flow_init(&flow, sizeof flow, flow_sensors, sizeof flow_sensors, &config, now), EERUF_OK);
    EXPECT(eeruf_hc_sr04_init(&module, sizeof module, &line, sizeof line, &flow.ring, &settings), EERUF_OK);
    EXPECT(eeruf_edges_init(&edges, sizeof edges, places, sizeof places), EERUF_OK);
    while (firings < 4) {
        while (eeruf_flow_poll(&flow, now, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_READING) EXPECT(event.u.reading.kind, EERUF_READING_LATE);
            if (event.kind != EERUF_EVENT_FIRE) continue;
            firings++;
            EXPECT(eeruf_hc_sr04_fire(&module, 0, false), EERUF_OK);
            EXPECT(eeruf_edges_push(&edges, 0, true, now + 450), EERUF_OK);
            EXPECT(eeruf_edges_push_between(&edges, 0, false, now + 22000, now + 27000), EERUF_OK);
            EXPECT(eeruf_hc_sr04_edges(&module, &edges), EERUF_OK);
        }
        now = eeruf_ring_deadline(&flow.ring);
    }
}
#endif

/* Modules whose driver is not called, or whose lines show nothing, are not told as free space; what one edge of two
   shows is not confirmed. */
static void silence_needs_a_witness(void) {
    EerufHcSr04Settings settings = EERUF_HC_SR04;
    EerufConfig config = EERUF_CONFIG;
    EerufHcSr04 four;
    EerufLine lines[SENSORS];
    unsigned kinds[SENSORS][EERUF_READING_KINDS], periods = 0;
    uint32_t now = 0;
    memset(kinds, 0, sizeof kinds);
    settings.min_retrigger_us = 54000;
    EXPECT(eeruf_ring_init(&ring, sizeof ring, sensors, sizeof sensors, &schedule, &config, now), EERUF_OK);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_OK);
    while (periods < 20) {
        now = eeruf_ring_deadline(&ring);
        if (eeruf_ring_poll(&ring, now, &event) != EERUF_EVENT) continue;
        if (event.kind == EERUF_EVENT_PERIOD) periods++;
        if (event.kind == EERUF_EVENT_READING) kinds[event.sensor][event.u.reading.kind]++;
        /* Nobody calls it for sensor 0; sensor 1 does not answer; of sensor 2 falling edges get lost; 3 is well. */
        if (event.kind != EERUF_EVENT_FIRE || event.sensor == 0) continue;
        EXPECT(eeruf_hc_sr04_fire(&four, event.sensor, false), EERUF_OK);
        if (event.sensor >= 2) EXPECT(eeruf_hc_sr04_edge(&four, event.sensor, true, now + 450), EERUF_OK);
        if (event.sensor == 3) EXPECT(eeruf_hc_sr04_edge(&four, event.sensor, false, now + 38450), EERUF_OK);
    }
    EXPECT(kinds[0][EERUF_READING_UNANSWERED] + kinds[1][EERUF_READING_UNANSWERED], 2 * 20);
    EXPECT(kinds[2][EERUF_READING_NO_ECHO], 19); /* the last is pending */
    EXPECT(kinds[3][EERUF_READING_CLEAR], 18);
    EXPECT(eeruf_hc_sr04_health(&four, 1), EERUF_HEALTH_MISSING);
    EXPECT(eeruf_hc_sr04_health(&four, 2), EERUF_HEALTH_LOSES_EDGES);
    EXPECT(eeruf_ring_set_silence(NULL, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_set_silence(&ring, 3), EERUF_ERR_RANGE);
    EXPECT(eeruf_ring_answered(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_unanswered(&not_ready, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_ring_forget(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured(&ring, SENSORS, 1000), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured_between(&ring, SENSORS, 1000, 1001), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured_between(&ring, 0, 1001, 1000), EERUF_ERR_BETWEEN);
    EXPECT(eeruf_ring_echo_between(&ring, 0, now + 1001, now + 1000), EERUF_ERR_BETWEEN);
    EXPECT(eeruf_ring_holds(&ring, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_ring_measured(&ring, 0, EERUF_NO_ECHO), EERUF_OK);
}

/* Sampled lines: an edge came between two looks, so that a loop that is held off says nothing. */
static void looks(void) {
    /* The looks at a line after its firing, and what comes of them. */
    static const struct {
        uint32_t low_us, high_us, still_us, fell_us, t_echo_us;
        uint8_t kind;
    } CASES[] = {
        {400, 500, 6200, 6300, 5800, EERUF_READING_FIRST},
        {400, 500, 6200, 6300, 5800, EERUF_READING_ACCEPTED},
        {400, 1200, 6200, 6300, EERUF_NO_ECHO, EERUF_READING_LATE}, /* a millisecond in all is too much */
        {440, 460, 17000, 58000, EERUF_NO_ECHO, EERUF_READING_LATE}, /* longer than any pulse, or a wall at 3 m */
        {440, 460, 37000, 38500, EERUF_NO_ECHO, EERUF_READING_NO_ECHO},
        {440, 460, 37000, 38500, EERUF_NO_ECHO, EERUF_READING_CLEAR},
    };
    EerufHcSr04Settings settings = EERUF_HC_SR04;
    EerufConfig config = EERUF_CONFIG;
    EerufHcSr04 four;
    EerufLine lines[SENSORS];
    unsigned at = 0;
    config.t_delta_us = 900;
    config.window_us = 54000;
    settings.min_retrigger_us = 54000;
    EXPECT(eeruf_ring_init_unverified(&ring, sizeof ring, sensors, sizeof sensors, &unverified, &config, 0), EERUF_OK);
    EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_OK);
    while (at < sizeof CASES / sizeof CASES[0]) {
        const uint32_t now = eeruf_ring_deadline(&ring);
        if (eeruf_ring_poll(&ring, now, &event) != EERUF_EVENT || event.sensor != 3) continue;
        if (event.kind == EERUF_EVENT_FIRE) {
            const uint32_t looks_us[] = {CASES[at].low_us, CASES[at].high_us, CASES[at].still_us, CASES[at].fell_us};
            unsigned look;
            EXPECT(eeruf_hc_sr04_fire(&four, 3, false), EERUF_OK);
            for (look = 0; look < 4; look++) {
                const uint32_t at_us = now + looks_us[look];
                EXPECT(eeruf_hc_sr04_look(&four, 3, look == 1 || look == 2, at_us, at_us + 4), EERUF_OK);
            }
        } else if (event.kind == EERUF_EVENT_READING) {
            EXPECT(event.u.reading.kind, CASES[at].kind);
            EXPECT(event.u.reading.t_echo_us, CASES[at].t_echo_us);
            at++;
        }
    }
}

/* Clones hold their line far longer than it takes to the next firing: they listen still, and are clear and well, after two
   pulses. Longer than that the line is stuck. */
static void a_line_that_is_held_listens_still(void) {
    static const uint32_t HOLDS_MS[] = {38, 66, 130, 200, 1000}, CLEAR[] = {98, 97, 95, 93, 0};
    EerufHcSr04Settings settings = EERUF_HC_SR04;
    EerufConfig config = EERUF_CONFIG;
    unsigned run;
    settings.min_retrigger_us = 54000;
    for (run = 0; run < sizeof HOLDS_MS / sizeof HOLDS_MS[0]; run++) {
        EerufHcSr04 four;
        EerufLine lines[SENSORS];
        unsigned kinds[EERUF_READING_KINDS], readings = 0, well = 0;
        uint32_t falls_us = 0, next;
        bool high = false;
        memset(kinds, 0, sizeof kinds);
        EXPECT(eeruf_ring_init(&ring, sizeof ring, sensors, sizeof sensors, &schedule, &config, 0), EERUF_OK);
        EXPECT(eeruf_hc_sr04_init(&four, sizeof four, lines, sizeof lines, &ring, &settings), EERUF_OK);
        while (readings < 100) {
            next = eeruf_ring_deadline(&ring);
            if (high && falls_us <= next) {
                next = falls_us;
                high = false;
                EXPECT(eeruf_hc_sr04_edge(&four, 3, false, falls_us), EERUF_OK);
            }
            if (eeruf_ring_poll(&ring, next, &event) != EERUF_EVENT || event.sensor != 3) continue;
            if (event.kind == EERUF_EVENT_READING) {
                readings++;
                kinds[event.u.reading.kind]++;
            }
            if (event.kind != EERUF_EVENT_FIRE) continue;
            if (eeruf_hc_sr04_fire(&four, 3, high) == EERUF_OK) {
                high = true;
                falls_us = next + 450 + 1000 * HOLDS_MS[run];
                EXPECT(eeruf_hc_sr04_edge(&four, 3, true, next + 450), EERUF_OK);
            }
            if (eeruf_hc_sr04_health(&four, 3) == EERUF_HEALTH_WELL) well++;
        }
        EXPECT(kinds[EERUF_READING_CLEAR], CLEAR[run]);
        if (HOLDS_MS[run] < 250) {
            EXPECT(well >= 100, 1);
        } else {
            EXPECT(kinds[EERUF_READING_STUCK] > 60, 1);
        }
    }
}

/* Hardware that fires and reports by itself. */
static void by_hardware(void) {
    const EerufHcSr04Settings settings = EERUF_HC_SR04;
    EerufSchedule table;
    uint8_t places_of[2 * SENSORS];
    uint32_t times[2 * (SENSORS + 1)];
    EerufHcSr04 modules;
    EerufLine lines[SENSORS];
    EerufEdge places[4];
    EerufEdges edges;
    EerufConfig config = EERUF_CONFIG;
    uint32_t due_us = 0, first_us;
    uint8_t sensor = 9, first, last, number = 0;
    EXPECT(eeruf_ring_upcoming(NULL, 0, &sensor, &due_us), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_upcoming(&not_ready, 0, &sensor, &due_us), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_ring_set_report_after(&not_ready, 0), EERUF_ERR_NOT_READY);
    EXPECT(eeruf_schedule_make(&table, places_of, sizeof places_of, times, sizeof times, 68000, SENSORS, 2, TIMES),
           EERUF_OK);
    config.t_delta_us = 900;
    config.window_us = 40000;
    EXPECT(eeruf_ring_init_unverified(&ring, sizeof ring, sensors, sizeof sensors, &table, &config, 1000), EERUF_OK);
    EXPECT(eeruf_ring_upcoming(&ring, 0, NULL, &due_us), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_upcoming(&ring, 0, &sensor, NULL), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_set_report_after(&ring, 62001), EERUF_ERR_WINDOW);
    EXPECT(eeruf_ring_set_report_after(&ring, 50000), EERUF_OK);
    while (eeruf_ring_upcoming(&ring, number, &last, &due_us) == EERUF_OK) number++;
    EXPECT(number, 2 * SENSORS); /* this period and the next */
    EXPECT(due_us, 1000 + 68000 + 51000);
    EXPECT(eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, &ring, &settings), EERUF_OK);
    EXPECT(eeruf_edges_init(&edges, sizeof edges, places, sizeof places), EERUF_OK);
    EXPECT(eeruf_hc_sr04_triggered(NULL, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_hc_sr04_triggered(&modules, SENSORS), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_pulse(&modules, SENSORS, 9000), EERUF_ERR_SENSOR);
    EXPECT(eeruf_hc_sr04_pulse(&modules, 0, 9000), EERUF_OK); /* not triggered: ignored */
    EXPECT(eeruf_hc_sr04_edges_until(&modules, NULL, 0), EERUF_ERR_NULL);
    EXPECT(eeruf_ring_upcoming(&ring, 0, &first, &first_us), EERUF_OK);
    /* The timer has triggered the first while the loop slept, and its line has risen since. */
    EXPECT(eeruf_edges_push(&edges, first, true, first_us + 450), EERUF_OK);
    EXPECT(eeruf_hc_sr04_edges_until(&modules, &edges, first_us), EERUF_OK);
    EXPECT(eeruf_ring_poll(&ring, first_us, &event), EERUF_EVENT);
    EXPECT(event.kind == EERUF_EVENT_FIRE && event.sensor == first && event.u.due_us == first_us, 1);
    EXPECT(eeruf_hc_sr04_triggered(&modules, first), EERUF_OK);
    EXPECT(eeruf_hc_sr04_edges_until(&modules, &edges, first_us + 449), EERUF_OK);
    EXPECT(edges.pushed != edges.popped, 1); /* later than that: it waits */
    EXPECT(eeruf_hc_sr04_edges(&modules, &edges), EERUF_OK);
    /* The pulse is reported after the window, and still counts: nothing is in range. */
    while (eeruf_ring_poll(&ring, first_us + 49000, &event) == EERUF_EVENT) {
        EXPECT(event.kind == EERUF_EVENT_FIRE, 1);
        EXPECT(eeruf_hc_sr04_triggered(&modules, event.sensor), EERUF_OK);
    }
    EXPECT(eeruf_hc_sr04_pulse(&modules, first, 39000), EERUF_OK);
    EXPECT(eeruf_hc_sr04_health(&modules, first), EERUF_HEALTH_WELL);
    EXPECT(eeruf_ring_poll(&ring, first_us + 50000, &event), EERUF_EVENT);
    EXPECT(event.kind == EERUF_EVENT_READING && event.sensor == first, 1);
    EXPECT(event.u.reading.kind, EERUF_READING_NO_ECHO);
}

static void reads(EerufWatch *watch, uint8_t kind, uint32_t t_echo_us, uint32_t now_us) {
    event.kind = EERUF_EVENT_READING;
    event.sensor = 1;
    event.u.reading.kind = kind;
    event.u.reading.t_echo_us = t_echo_us;
    event.u.reading.explained_by = kind == EERUF_READING_AMBIGUOUS ? 3 : EERUF_BY_NOTHING;
    EXPECT(eeruf_watch_event(watch, &event, now_us), EERUF_OK);
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
    reads(&watch, EERUF_READING_ACCEPTED, 9000, 100);
    reads(&watch, EERUF_READING_AMBIGUOUS, 9100, 200);
    EXPECT(eeruf_watch_state(&watch, 1, 250, &state), EERUF_OK);
    EXPECT(state.kind == EERUF_STATE_OBSTACLE && state.t_echo_us == 9000 && state.age_us == 150, 1);
    reads(&watch, EERUF_READING_AMBIGUOUS, 9100, 300);
    EXPECT(eeruf_watch_state(&watch, 1, 310, &state), EERUF_OK);
    EXPECT(state.kind == EERUF_STATE_UNKNOWN && state.why == EERUF_WHY_AMBIGUOUS && state.explained_by == 3, 1);
    EXPECT(state.age_us == 10 && state.t_echo_us == EERUF_NO_ECHO, 1);
    reads(&watch, EERUF_READING_UNANSWERED, EERUF_NO_ECHO, 400);
    reads(&watch, EERUF_READING_STUCK, EERUF_NO_ECHO, 500);
    EXPECT(eeruf_watch_state(&watch, 1, 510, &state), EERUF_OK);
    EXPECT(state.kind == EERUF_STATE_UNANSWERED && state.age_us == 110, 1);
    event.sensor = SENSORS;
    EXPECT(eeruf_watch_event(&watch, &event, 600), EERUF_ERR_SENSOR);
    EXPECT(strcmp(eeruf_state_name(EERUF_STATE_TOO_CLOSE), "too close"), 0);
    EXPECT(strcmp(eeruf_state_name(9), "?"), 0);
}

int main(void) {
    EXPECT(eeruf_version(), EERUF_VERSION);
    EXPECT(strcmp(eeruf_reading_name(EERUF_READING_CLEAR), "clear"), 0);
    EXPECT(strcmp(eeruf_reading_name(EERUF_READING_AMBIGUOUS), "ambiguous"), 0);
    EXPECT(strcmp(eeruf_reading_name(EERUF_READING_UNANSWERED), "unanswered"), 0);
    EXPECT(strcmp(eeruf_reading_name(EERUF_READING_KINDS), "?"), 0);
    EXPECT(strcmp(eeruf_health_name(EERUF_HEALTH_LOSES_EDGES), "loses edges"), 0);
    EXPECT(strcmp(eeruf_health_name(200), "?"), 0);
    schedules();
    rings();
    filters_and_edges();
    modules();
    silence_needs_a_witness();
    looks();
    a_line_that_is_held_listens_still();
    adaptations();
    watches();
    by_hardware();
#if EERUF_WITH_FLOW
    flow_rings();
    flow_believes_walls_in_a_late_loop();
    an_end_found_late_is_no_silence();
#endif
    printf("%d wrong\n", wrong);
    return wrong != 0;
}

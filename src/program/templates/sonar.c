#include "sonar.h"

static Eeruf@Flow@Ring ring;
static Eeruf@Flow@Sensor sensors[EERUF_SENSORS];
static EerufHcSr04 modules;
static EerufLine lines[EERUF_SENSORS];
static const EerufHcSr04Settings settings = EERUF_MODULES;
static EerufEdges edges;
static EerufEdge places[32];
static EerufPace pace;
static EerufWatch watch;  //@mavlink
static EerufWatched states[EERUF_SENSORS];  //@mavlink
static const EerufMavlinkPlace directions[] = {@places@};  //@mavlink
static EerufMavlink autopilot = EERUF_MAVLINK(directions, EERUF_SENSORS, @half_view_deg@, @min_cm@, @max_cm@);  //@mavlink

EerufStatus sonar_begin(@seed@) {
    EerufFlowConfig config = eeruf_flow_config;  //@flow
    config.seed = seed;  //@flow
    const EerufConfig config = EERUF_RING_CONFIG;  //@table
    EerufStatus status =
        eeruf_@flow@_init(&ring, sizeof ring, sensors, sizeof sensors, @table@&config, board_micros());
    if (status == EERUF_OK)
        status = eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, @base@, &settings);
    pace.since_us = board_micros();
    if (status == EERUF_OK) status = eeruf_edges_init(&edges, sizeof edges, places, sizeof places);
    if (status == EERUF_OK) status = eeruf_watch_init(&watch, sizeof watch, states, sizeof states, board_micros());  //@mavlink
    return status;
}

void sonar_edge(uint8_t sensor, bool high) {
    (void)eeruf_edges_push(&edges, sensor, high, board_micros());
}

void sonar_moving(uint32_t speed_mm_s, uint32_t turn_mrad_s) {  //@flow
    (void)eeruf_flow_moving(&ring, speed_mm_s, turn_mrad_s, board_micros());  //@flow
}  //@flow
  //@flow
bool sonar_too_slow(void) {
    return eeruf_pace_too_slow(&pace, @base@, board_micros());
}

bool sonar_read(uint8_t *sensor, EerufReading *reading) {
    EerufEvent event;
    /* The clock is read before the edges: then no window closes on one that came in time. */
    const uint32_t now = board_micros();
    (void)eeruf_hc_sr04_edges(&modules, &edges);
    if (eeruf_@flow@_poll(&ring, now, &event) != EERUF_EVENT) return false;
    (void)eeruf_watch_event(&watch, &event, now);  //@mavlink
    eeruf_pace_event(&pace, &event);
    if (event.kind == EERUF_EVENT_FIRE) {
        if (eeruf_hc_sr04_fire(&modules, event.sensor, board_line_is_high(event.sensor)) == EERUF_OK)
            board_trigger(event.sensor, settings.trigger_us);
        return false;
    }
    if (event.kind != EERUF_EVENT_READING) return false;
    *sensor = event.sensor;
    *reading = event.u.reading;
    return true;
}
  //@mavlink
void sonar_heard(uint8_t byte) {  //@mavlink
    eeruf_mavlink_hear(&autopilot, byte);  //@mavlink
}  //@mavlink
  //@mavlink
size_t sonar_mavlink(size_t room, const uint8_t **bytes) {  //@mavlink
    return eeruf_mavlink_take(&autopilot, &watch, board_micros(), room, bytes);  //@mavlink
}  //@mavlink

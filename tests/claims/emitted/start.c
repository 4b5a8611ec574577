/* Starts the ring of an emitted table, SCHEDULE, or of a flow configuration, FLOW, on its modules where there are some,
   SETTINGS: exit code 0 if each sensor fires in each of PERIODS periods and has its wall accepted. */
#include "eeruf.h"

#include TABLE

#include <stdio.h>

#define MOST 64u

#ifdef FLOW
#define PERIODS 4u
#define COUNT FLOW.sensors
#define ECHO_US (2000u + FLOW.blanking_us)
static EerufFlowRing flow;
static EerufFlowSensor sensors[MOST];
static EerufRing *const ring = &flow.ring;
#else
#define PERIODS 4u
#define COUNT SCHEDULE.sensors
#define ECHO_US (2000u + config.blanking_us)
#ifndef CONFIG
#define CONFIG EERUF_CONFIG
#endif
static const EerufConfig config = CONFIG;
static EerufRing table;
static EerufSensor sensors[MOST];
static EerufRing *const ring = &table;
#endif
static EerufLine lines[MOST];
static EerufHcSr04 modules;

static int refused(const char *what, EerufStatus status) {
    printf("%s: status %d\n", what, status);
    return 1;
}

static EerufStatus start(uint32_t now_us) {
#ifdef FLOW
    return eeruf_flow_init(&flow, sizeof flow, sensors, sizeof sensors, &FLOW, now_us);
#else
    const EerufStatus status = eeruf_schedule_check(&SCHEDULE);
    if (status != EERUF_OK) return status;
    return eeruf_ring_init(&table, sizeof table, sensors, sizeof sensors, &SCHEDULE, &config, now_us);
#endif
}

static EerufStatus poll(uint32_t now_us, EerufEvent *event) {
#ifdef FLOW
    return eeruf_flow_poll(&flow, now_us, event);
#else
    return eeruf_ring_poll(&table, now_us, event);
#endif
}

int main(void) {
    unsigned fired[MOST] = {0}, accepted[MOST] = {0}, sensor;
    uint32_t now_us = 4294900000u;
    EerufEvent event;
    EerufStatus status = start(now_us);
    if (status != EERUF_OK) return refused("ring", status);
#ifdef SETTINGS
    static const EerufHcSr04Settings settings = SETTINGS;
    status = eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, ring, &settings);
    if (status != EERUF_OK) return refused("modules", status);
#endif
    for (;;) {
        while (poll(now_us, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_READING) {
                accepted[event.sensor] += event.u.reading.kind == EERUF_READING_ACCEPTED;
            } else if (event.kind == EERUF_EVENT_PERIOD && event.period == PERIODS - 1) {
                for (sensor = 0; sensor < COUNT; sensor++)
                    if (fired[sensor] != PERIODS || accepted[sensor] == 0) break;
                printf("sensor %u: fired %u times, accepted %u\n", sensor, fired[sensor % MOST], accepted[sensor % MOST]);
                return sensor < COUNT;
            } else if (event.kind == EERUF_EVENT_FIRE) {
                fired[event.sensor]++;
#ifdef SETTINGS
                status = eeruf_hc_sr04_fire(&modules, event.sensor, false);
                if (status != EERUF_OK) return refused("trigger", status);
                (void)eeruf_hc_sr04_edge(&modules, event.sensor, true, now_us + 450);
                (void)eeruf_hc_sr04_edge(&modules, event.sensor, false, now_us + 450 + ECHO_US);
#else
                (void)eeruf_ring_echo(ring, event.sensor, now_us + ECHO_US);
#endif
            }
        }
        now_us = eeruf_ring_deadline(ring);
    }
}

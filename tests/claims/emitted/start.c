/* Starts the ring of an emitted table, SCHEDULE, on its modules where the table has them, SETTINGS: exit code 0 if each
   sensor fires in each of four periods and has its wall accepted. */
#include "eeruf.h"

#include TABLE

#include <stdio.h>

#define MOST 64u

static EerufRing ring;
static EerufSensor sensors[MOST];
static EerufLine lines[MOST];
static EerufHcSr04 modules;

static int refused(const char *what, EerufStatus status) {
    printf("%s: status %d\n", what, status);
    return 1;
}

int main(void) {
    const EerufConfig config = EERUF_CONFIG;
    unsigned fired[MOST] = {0}, accepted[MOST] = {0}, sensor;
    uint32_t now_us = 4294900000u;
    EerufEvent event;
    EerufStatus status = eeruf_schedule_check(&SCHEDULE);
    if (status != EERUF_OK) return refused("table", status);
    status = eeruf_ring_init(&ring, sizeof ring, sensors, sizeof sensors, &SCHEDULE, &config, now_us);
    if (status != EERUF_OK) return refused("ring", status);
#ifdef SETTINGS
    static const EerufHcSr04Settings settings = SETTINGS;
    status = eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, &ring, &settings);
    if (status != EERUF_OK) return refused("modules", status);
#endif
    for (;;) {
        while (eeruf_ring_poll(&ring, now_us, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_READING) {
                accepted[event.sensor] += event.u.reading.kind == EERUF_READING_ACCEPTED;
            } else if (event.kind == EERUF_EVENT_PERIOD && event.period == 3) {
                for (sensor = 0; sensor < SCHEDULE.sensors; sensor++)
                    if (fired[sensor] != 4 || accepted[sensor] == 0) break;
                printf("sensor %u: fired %u times, accepted %u\n", sensor, fired[sensor % MOST], accepted[sensor % MOST]);
                return sensor < SCHEDULE.sensors;
            } else if (event.kind == EERUF_EVENT_FIRE) {
                fired[event.sensor]++;
#ifdef SETTINGS
                status = eeruf_hc_sr04_fire(&modules, event.sensor, false);
                if (status != EERUF_OK) return refused("trigger", status);
                (void)eeruf_hc_sr04_edge(&modules, event.sensor, true, now_us + 450);
                (void)eeruf_hc_sr04_edge(&modules, event.sensor, false, now_us + 450 + 2000);
#else
                (void)eeruf_ring_echo(&ring, event.sensor, now_us + 2000);
#endif
            }
        }
        now_us = eeruf_ring_deadline(&ring);
    }
}

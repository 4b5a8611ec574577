/* A ring of eight sensors with a table from `eeruf design rings/hc-sr04-8.toml --emit c`. `now_us`, `sleep_until_us`
   and the trigger depend on the board; here time jumps from deadline to deadline, and a wall is 2 m in front of each
   sensor. */
#include "eeruf.h"

#include "ring.h"

#include <stdio.h>

static EerufRing ring;
static EerufSensor sensors[EERUF_SENSORS];

static uint32_t clock_us = 4294000000u; /* wraps after one second */
static uint32_t now_us(void) {
    return clock_us;
}
static void sleep_until_us(uint32_t deadline_us) {
    clock_us = deadline_us;
}

int main(void) {
    const EerufConfig config = EERUF_CONFIG;
    EerufStatus status = eeruf_schedule_check(&eeruf_schedule); /* worthwhile for a table written by hand */
    unsigned accepted = 0, last_mm = 0;
    if (status == EERUF_OK)
        status = eeruf_ring_init(&ring, sizeof ring, sensors, sizeof sensors, &eeruf_schedule, &config, now_us());
    if (status != EERUF_OK) {
        printf("status %d\n", status);
        return 1;
    }
    for (;;) {
        EerufEvent event;
        while (eeruf_ring_poll(&ring, now_us(), &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_FIRE) {
                /* Raise the trigger here; later the echo line reports: */
                (void)eeruf_ring_echo(&ring, event.sensor, now_us() + 12000);
            } else if (event.kind == EERUF_EVENT_READING && event.u.reading.kind == EERUF_READING_ACCEPTED) {
                last_mm = (unsigned)eeruf_distance_mm(event.u.reading.t_echo_us, EERUF_SOUND_20C);
                accepted++;
            } else if (event.kind == EERUF_EVENT_PERIOD && event.period == 99) {
                printf("c: accepted %u, at %u mm\n", accepted, last_mm);
                return accepted < EERUF_SENSORS * 98;
            }
        }
        sleep_until_us(eeruf_ring_deadline(&ring));
    }
}

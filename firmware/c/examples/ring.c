/* A ring of four sensors in C. `now_us`, `sleep_until_us` and `trigger` are the board's; here time jumps from deadline
   to deadline, and a wall stands 2 m in front of each sensor. */
#include "eeruf.h"
#include <stdio.h>

static const uint32_t FIRE_A_US[4] = {0, 15000, 30000, 45000};
static const uint32_t FIRE_B_US[4] = {0, 17000, 34000, 51000};

static EerufSchedule schedule;
static EerufRing ring;

static uint32_t clock_us = 4294000000u; /* wraps after one second */
static uint32_t now_us(void) { return clock_us; }
static void sleep_until_us(uint32_t deadline_us) { clock_us = deadline_us; }

#define EXPECT(call, status)                                                                                           \
    do {                                                                                                               \
        int got = (int)(call);                                                                                         \
        if (got != (int)(status)) {                                                                                    \
            printf("%s: %d\n", #call, got);                                                                            \
            return 1;                                                                                                  \
        }                                                                                                              \
    } while (0)

/* What a caller may do wrong. */
static int mistakes(void) {
    const EerufConfig no_window = {999, 0, 0, 2}, one_reading = {999, 36000, 0, 1}, fine = {999, 36000, 0, 2};
    const EerufConfig too_long = {999, 40000, 0, 2};
    static EerufRing not_set_up;
    EerufEvent event;
    EXPECT(eeruf_ring_poll(NULL, 0, &event), EERUF_NULL);
    EXPECT(eeruf_ring_poll(&not_set_up, 0, &event), EERUF_NOT_SET_UP);
    EXPECT(eeruf_ring_init(&ring, &schedule, &fine, 0), EERUF_NOT_VERIFIED);
    EXPECT(eeruf_ring_init_unverified(&ring, &schedule, &fine, 0), EERUF_OK);
    EXPECT(eeruf_schedule_verify(&schedule, 999, 15000, 4, 36000), EERUF_NOT_MET);
    EXPECT(eeruf_schedule_verify(&schedule, 999, 9000, 4, 36000), EERUF_OK);
    EXPECT(eeruf_ring_init(&ring, &schedule, &too_long, 0), EERUF_NOT_VERIFIED);
    EXPECT(eeruf_ring_init(&ring, &schedule, &no_window, 0), EERUF_WINDOW);
    EXPECT(eeruf_ring_init(&ring, &schedule, &one_reading, 0), EERUF_CONSECUTIVE);
    EXPECT(eeruf_ring_init(&ring, &schedule, &fine, 0), EERUF_OK);
    EXPECT(eeruf_ring_echo(&ring, 4, 0), EERUF_NO_SUCH_SENSOR);
    EXPECT(eeruf_ring_fired(&ring, 4, 0), EERUF_NO_SUCH_SENSOR);
    return 0;
}

int main(void) {
    const EerufConfig config = {999, 36000, 0, 2};
    unsigned accepted = 0;
    EXPECT(eeruf_schedule_init(&schedule, 60000, 25, FIRE_A_US, FIRE_B_US), EERUF_SENSORS);
    EXPECT(eeruf_schedule_init(&schedule, 50000, 4, FIRE_A_US, FIRE_B_US), EERUF_FIRE);
    EXPECT(eeruf_schedule_init(&schedule, 60000, 4, FIRE_A_US, FIRE_B_US), EERUF_OK);
    if (mistakes() != 0) {
        return 1;
    }
    EXPECT(eeruf_ring_init(&ring, &schedule, &config, now_us()), EERUF_OK);
    for (;;) {
        EerufEvent event;
        uint32_t deadline_us;
        while (eeruf_ring_poll(&ring, now_us(), &event) == EERUF_EVENT) {
            if (event.kind == EERUF_FIRE_SENSOR) {
                EXPECT(eeruf_ring_echo(&ring, event.sensor, now_us() + 12000), EERUF_OK);
            } else if (event.kind == EERUF_READING && event.reading == EERUF_ACCEPTED) {
                accepted += 1;
            } else if (event.kind == EERUF_PERIOD_ENDED && event.period == 99) {
                printf("c: accepted %u\n", accepted);
                return accepted < 4 * 98;
            }
        }
        EXPECT(eeruf_ring_next_deadline(&ring, &deadline_us), EERUF_OK);
        sleep_until_us(deadline_us);
    }
}

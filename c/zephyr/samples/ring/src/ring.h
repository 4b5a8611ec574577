/* 8 sensors, T_p = 67 ms;
   t_delta = 416 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
   Times are microseconds from the start of each period; phases a and b alternate. */
#ifndef EERUF_SCHEDULE_H
#define EERUF_SCHEDULE_H

#include <stdint.h>

#define EERUF_SENSORS 8
#define EERUF_PERIOD_US 67000u
#define EERUF_T_DELTA_US 416u
#define EERUF_WINDOW_US 60000u

static const uint32_t eeruf_t_fire_us[2][EERUF_SENSORS] = {
    {0u, 17000u, 34000u, 51000u, 1000u, 18000u, 35000u, 52000u}, /* phase a */
    {0u, 15000u, 30000u, 45000u, 0u, 15000u, 30000u, 45000u}, /* phase b */
};

#ifdef EERUF_H /* with eeruf.h before this file: the schedule for eeruf_ring_init */
static const uint8_t eeruf_schedule_order[] EERUF_FLASH = {
    0, 4, 1, 5, 2, 6, 3, 7, /* phase a */
    0, 4, 1, 5, 2, 6, 3, 7, /* phase b */
};
static const uint32_t eeruf_schedule_gap_us[] EERUF_FLASH = {
    0u, 1000u, 16000u, 1000u, 16000u, 1000u, 16000u, 1000u, 15000u,
    0u, 0u, 15000u, 0u, 15000u, 0u, 15000u, 0u, 22000u,
};
static const EerufSchedule eeruf_schedule EERUF_FLASH = {
    5, 8, 2, eeruf_schedule_order, eeruf_schedule_gap_us,
    67000u, 60000u, 416u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 67000u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};
#endif

#endif

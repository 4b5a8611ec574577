// Ready tables for rings of 2, 3, 4, 5, 6, 8, 10, 12, 16 and 24 HC-SR04 modules: no shorter period lets
// each module rest for 60 ms and keeps four adjacent ones 14.569 ms apart, so that sound from up to 2.5 m
// has died. The slower ones are for EerufAdaptation. Those that a sketch does not name take no room.
// Written by `cargo xtask arduino --write` from what `eeruf design` finds; for your own ring:
//   eeruf design RING.toml --period-only --emit arduino > ring.h
#pragma once
#include <EerufArduino.h>

// 2 sensors, T_p = 61 ms;
// t_delta = 381 us, 2 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_2_order[] EERUF_FLASH = {
    0, 1, /* phase a */
    0, 1, /* phase b */
};
static const uint32_t EERUF_HC_SR04_2_gap_us[] EERUF_FLASH = {
    0u, 31000u, 30000u,
    0u, 30000u, 31000u,
};
static const EerufSchedule EERUF_HC_SR04_2 EERUF_FLASH = {
    5, 2, 2, EERUF_HC_SR04_2_order, EERUF_HC_SR04_2_gap_us,
    61000u, 60000u, 381u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 61000u,
    1, EERUF_LAYOUT_RING, 2, 0, 0,
};

// 3 sensors, T_p = 62 ms;
// t_delta = 387 us, 3 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_3_order[] EERUF_FLASH = {
    0, 1, 2, /* phase a */
    0, 1, 2, /* phase b */
};
static const uint32_t EERUF_HC_SR04_3_gap_us[] EERUF_FLASH = {
    0u, 21000u, 21000u, 20000u,
    0u, 20000u, 20000u, 22000u,
};
static const EerufSchedule EERUF_HC_SR04_3 EERUF_FLASH = {
    5, 3, 2, EERUF_HC_SR04_3_order, EERUF_HC_SR04_3_gap_us,
    62000u, 60000u, 387u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 62000u,
    1, EERUF_LAYOUT_RING, 3, 0, 0,
};

// 4 sensors, T_p = 63 ms;
// t_delta = 393 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_4_order[] EERUF_FLASH = {
    0, 1, 2, 3, /* phase a */
    0, 1, 2, 3, /* phase b */
};
static const uint32_t EERUF_HC_SR04_4_gap_us[] EERUF_FLASH = {
    0u, 16000u, 16000u, 16000u, 15000u,
    0u, 15000u, 15000u, 15000u, 18000u,
};
static const EerufSchedule EERUF_HC_SR04_4 EERUF_FLASH = {
    5, 4, 2, EERUF_HC_SR04_4_order, EERUF_HC_SR04_4_gap_us,
    63000u, 60000u, 393u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 63000u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 5 sensors, T_p = 76.5 ms;
// t_delta = 471 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_5_order[] EERUF_FLASH = {
    2, 3, 1, 4, 0, /* phase a */
    3, 2, 1, 0, 4, /* phase b */
};
static const uint32_t EERUF_HC_SR04_5_gap_us[] EERUF_FLASH = {
    15000u, 15000u, 16000u, 15000u, 15000u, 500u,
    14500u, 15000u, 15000u, 15000u, 15000u, 2000u,
};
static const EerufSchedule EERUF_HC_SR04_5 EERUF_FLASH = {
    5, 5, 2, EERUF_HC_SR04_5_order, EERUF_HC_SR04_5_gap_us,
    76500u, 60000u, 471u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 76500u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 6 sensors, T_p = 91.5 ms;
// t_delta = 557 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_6_order[] EERUF_FLASH = {
    3, 2, 5, 1, 4, 0, /* phase a */
    3, 2, 1, 0, 5, 4, /* phase b */
};
static const uint32_t EERUF_HC_SR04_6_gap_us[] EERUF_FLASH = {
    0u, 16500u, 15000u, 15000u, 15000u, 15000u, 15000u,
    0u, 15000u, 15000u, 15500u, 15000u, 15000u, 16000u,
};
static const EerufSchedule EERUF_HC_SR04_6 EERUF_FLASH = {
    5, 6, 2, EERUF_HC_SR04_6_order, EERUF_HC_SR04_6_gap_us,
    91500u, 60500u, 557u, 14569u, 60000u, 1500u,
    EERUF_AS_T_DELTA, 91500u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 8 sensors, T_p = 67 ms;
// t_delta = 416 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_8_order[] EERUF_FLASH = {
    0, 4, 1, 5, 2, 6, 3, 7, /* phase a */
    0, 4, 1, 5, 2, 6, 3, 7, /* phase b */
};
static const uint32_t EERUF_HC_SR04_8_gap_us[] EERUF_FLASH = {
    0u, 1000u, 16000u, 1000u, 16000u, 1000u, 16000u, 1000u, 15000u,
    0u, 0u, 15000u, 0u, 15000u, 0u, 15000u, 0u, 22000u,
};
static const EerufSchedule EERUF_HC_SR04_8 EERUF_FLASH = {
    5, 8, 2, EERUF_HC_SR04_8_order, EERUF_HC_SR04_8_gap_us,
    67000u, 60000u, 416u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 67000u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 8 sensors, T_p = 100.5 ms;
// t_delta = 524 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 90 ms.
static const uint8_t EERUF_HC_SR04_8_SLOWER_order[] EERUF_FLASH = {
    0, 4, 1, 5, 2, 6, 3, 7, /* phase a */
    0, 4, 1, 5, 2, 6, 3, 7, /* phase b */
};
static const uint32_t EERUF_HC_SR04_8_SLOWER_gap_us[] EERUF_FLASH = {
    0u, 1500u, 24000u, 1500u, 24000u, 1500u, 24000u, 1500u, 22500u,
    0u, 0u, 22500u, 0u, 22500u, 0u, 22500u, 0u, 33000u,
};
static const EerufSchedule EERUF_HC_SR04_8_SLOWER EERUF_FLASH = {
    5, 8, 2, EERUF_HC_SR04_8_SLOWER_order, EERUF_HC_SR04_8_SLOWER_gap_us,
    100500u, 90000u, 524u, 14569u, 90000u, 1500u,
    EERUF_AS_T_DELTA, 100500u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 8 sensors, T_p = 130.5 ms;
// t_delta = 611 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 120 ms.
static const uint8_t EERUF_HC_SR04_8_SLOWEST_order[] EERUF_FLASH = {
    0, 4, 1, 5, 2, 6, 3, 7, /* phase a */
    0, 4, 1, 5, 2, 6, 3, 7, /* phase b */
};
static const uint32_t EERUF_HC_SR04_8_SLOWEST_gap_us[] EERUF_FLASH = {
    0u, 1500u, 31500u, 1500u, 31500u, 1500u, 31500u, 1500u, 30000u,
    0u, 0u, 30000u, 0u, 30000u, 0u, 30000u, 0u, 40500u,
};
static const EerufSchedule EERUF_HC_SR04_8_SLOWEST EERUF_FLASH = {
    5, 8, 2, EERUF_HC_SR04_8_SLOWEST_order, EERUF_HC_SR04_8_SLOWEST_gap_us,
    130500u, 120000u, 611u, 14569u, 120000u, 1500u,
    EERUF_AS_T_DELTA, 130500u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 10 sensors, T_p = 77.5 ms;
// t_delta = 474 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_10_order[] EERUF_FLASH = {
    4, 9, 5, 0, 6, 1, 7, 2, 8, 3, /* phase a */
    0, 4, 9, 5, 2, 6, 1, 7, 3, 8, /* phase b */
};
static const uint32_t EERUF_HC_SR04_10_gap_us[] EERUF_FLASH = {
    0u, 2500u, 12500u, 2500u, 12500u, 2500u, 12500u, 2500u, 12500u, 2500u, 15000u,
    1000u, 0u, 15000u, 1000u, 15000u, 1000u, 14000u, 2000u, 13500u, 2500u, 12500u,
};
static const EerufSchedule EERUF_HC_SR04_10 EERUF_FLASH = {
    5, 10, 2, EERUF_HC_SR04_10_order, EERUF_HC_SR04_10_gap_us,
    77500u, 61000u, 474u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 77500u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 12 sensors, T_p = 71 ms;
// t_delta = 439 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_12_order[] EERUF_FLASH = {
    0, 4, 8, 1, 5, 9, 2, 6, 10, 3, 7, 11, /* phase a */
    0, 4, 8, 1, 5, 9, 2, 6, 10, 3, 7, 11, /* phase b */
};
static const uint32_t EERUF_HC_SR04_12_gap_us[] EERUF_FLASH = {
    0u, 1000u, 1000u, 16000u, 1000u, 1000u, 16000u, 1000u, 1000u, 16000u, 1000u, 1000u, 15000u,
    0u, 0u, 0u, 15000u, 0u, 0u, 15000u, 0u, 0u, 15000u, 0u, 0u, 26000u,
};
static const EerufSchedule EERUF_HC_SR04_12 EERUF_FLASH = {
    5, 12, 2, EERUF_HC_SR04_12_order, EERUF_HC_SR04_12_gap_us,
    71000u, 60000u, 439u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 71000u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 16 sensors, T_p = 75 ms;
// t_delta = 463 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_16_order[] EERUF_FLASH = {
    0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15, /* phase a */
    0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15, /* phase b */
};
static const uint32_t EERUF_HC_SR04_16_gap_us[] EERUF_FLASH = {
    0u, 1000u, 1000u, 1000u, 16000u, 1000u, 1000u, 1000u, 16000u, 1000u, 1000u, 1000u, 16000u, 1000u, 1000u, 1000u, 15000u,
    0u, 0u, 0u, 0u, 15000u, 0u, 0u, 0u, 15000u, 0u, 0u, 0u, 15000u, 0u, 0u, 0u, 30000u,
};
static const EerufSchedule EERUF_HC_SR04_16 EERUF_FLASH = {
    5, 16, 2, EERUF_HC_SR04_16_order, EERUF_HC_SR04_16_gap_us,
    75000u, 60000u, 463u, 14569u, 60000u, 1000u,
    EERUF_AS_T_DELTA, 75000u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// 24 sensors, T_p = 94.5 ms;
// t_delta = 576 us, 4 adjacent sensors of a ring at least 14.569 ms apart, listening for 60 ms.
static const uint8_t EERUF_HC_SR04_24_order[] EERUF_FLASH = {
    18, 14, 10, 6, 22, 2, 15, 7, 11, 19, 3, 23, 9, 4, 0, 20, 16, 12, 8, 21, 17, 13, 5, 1, /* phase a */
    10, 14, 2, 6, 22, 18, 12, 8, 4, 0, 16, 20, 11, 7, 3, 23, 19, 15, 5, 9, 1, 21, 13, 17, /* phase b */
};
static const uint32_t EERUF_HC_SR04_24_gap_us[] EERUF_FLASH = {
    5250u, 150u, 150u, 150u, 150u, 5400u, 13500u, 150u, 1350u, 6000u, 1500u, 1500u, 10500u, 7500u, 1500u, 150u, 7350u, 3000u, 150u, 11850u, 4500u, 3000u, 4350u, 150u, 5250u,
    9750u, 3000u, 1350u, 150u, 1500u, 3000u, 13500u, 1500u, 1500u, 150u, 2850u, 150u, 14850u, 1350u, 150u, 3000u, 150u, 1350u, 14850u, 150u, 3000u, 150u, 1350u, 1500u, 14250u,
};
static const EerufSchedule EERUF_HC_SR04_24 EERUF_FLASH = {
    5, 24, 2, EERUF_HC_SR04_24_order, EERUF_HC_SR04_24_gap_us,
    94500u, 60000u, 576u, 14569u, 60000u, 1200u,
    EERUF_AS_T_DELTA, 94500u,
    1, EERUF_LAYOUT_RING, 4, 0, 0,
};

// Ready tables for rings of 4, 8 and 12 HC-SR04 modules: no shorter period lets each module rest for 60 ms
// and keeps four adjacent ones 14.569 ms apart, so that sound from up to 2.5 m has died. Unused
// tables take no room.
// Written by `cargo xtask arduino --write` from what `eeruf design` finds; for your own ring:
//   eeruf design RING.toml --period-only --emit arduino > ring.h
#pragma once
#include <EerufArduino.h>

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

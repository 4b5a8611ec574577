/*
 * Messages of a ring to an autopilot over a serial line, in MAVLink 2: OBSTACLE_DISTANCE of the whole ring,
 * DISTANCE_SENSOR of sensors with a named rotation, and HEARTBEAT, SYS_STATUS and STATUSTEXT about failing sensors. How
 * autopilots use them: docs/how-to/autopilots.md.
 *
 *     static const EerufMavlinkPlace PLACES[] = {{0, 0}, {90, 2}, {180, 4}, {270, 6}};
 *     EerufMavlink link = EERUF_MAVLINK(PLACES, 4, 15, 2, 400);
 *     ...
 *         eeruf_mavlink_hear(&link, byte);                     // each byte of the autopilot
 *         size = eeruf_mavlink_take(&link, &watch, now, room, &bytes);
 *         write(bytes, size);                                  // as many as there is room for: nothing waits
 *
 * Until the vehicle arms, a sensor that does not answer holds back all distances, so that the pre-arm check fails;
 * after that, its sectors are 65535. Messages: https://mavlink.io/en/messages/common.html. C99 to C++20.
 */
#ifndef EERUF_MAVLINK_H
#define EERUF_MAVLINK_H

#include "eeruf.h"

#include <string.h>

/* The vehicle's system, and our component: obstacle avoidance. */
#ifndef EERUF_MAVLINK_SYSTEM
#define EERUF_MAVLINK_SYSTEM 1
#endif
#define EERUF_MAVLINK_COMPONENT 196

/* The time between two messages; at 57,600 baud the longest takes 31 ms. */
#define EERUF_MAVLINK_PACE_US 20000u
/* Time after which an unconfirmed state counts as unknown. */
#define EERUF_MAVLINK_OLD_US 1000000u
#define EERUF_MAVLINK_HEARTBEAT 50 /* the CRC_EXTRA byte, which depends on the message's fields */

/* The direction of a sensor, clockwise from straight ahead, and its MAV_SENSOR_ORIENTATION, or 255. */
typedef struct EerufMavlinkPlace {
    uint16_t yaw_deg;
    uint8_t rotation;
} EerufMavlinkPlace;

typedef struct EerufMavlink {
    const EerufMavlinkPlace *places;
    uint8_t sensors, half_view_deg; /* at least 5: PX4 reads every second sector */
    uint16_t min_cm, max_cm;
    /* Not for the caller. */
    uint32_t now_us, turns, beat_us, sent_us;
    uint8_t sequence, next, armed, owes_status, failed, sees, size, written;
    uint8_t reported[EERUF_MAX_SENSORS / 8], heard[21], frame[180];
} EerufMavlink;
#define EERUF_MAVLINK(places, sensors, half_view_deg, min_cm, max_cm)                                                  \
    {places, sensors, half_view_deg, min_cm, max_cm, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, {0}, {0}, {0}}

/* CRC-16/MCRF4XX. */
static inline uint16_t eeruf_mavlink_crc(uint16_t crc, uint8_t byte) {
    byte = (uint8_t)(byte ^ (crc & 0xff));
    byte = (uint8_t)(byte ^ (byte << 4));
    return (uint16_t)((crc >> 8) ^ (byte << 8) ^ (byte << 3) ^ (byte >> 4));
}

/* Processes a byte from the autopilot, whose HEARTBEAT, of MAVLink 1 or 2, tells whether the vehicle is armed. */
static inline void eeruf_mavlink_hear(EerufMavlink *link, uint8_t byte) {
    uint8_t is_first;
    memmove(link->heard, link->heard + 1, sizeof link->heard - 1);
    link->heard[sizeof link->heard - 1] = byte;
    for (is_first = 0; is_first < 2; is_first++) {
        const uint8_t *frame = link->heard + 4 * is_first;
        const uint8_t header = is_first ? 6 : 10;
        uint16_t crc = 0xffff;
        uint8_t at, number = frame[header - 1], armed;
        if (!is_first) number = (uint8_t)(number | frame[7] | frame[8]);
        if (frame[0] != (is_first ? 0xfe : 0xfd) || frame[1] != 9 || number != 0) continue;
        /* Other components have no autopilot: 8. */
        if (frame[is_first ? 3 : 5] != EERUF_MAVLINK_SYSTEM || frame[header + 5] == 8) continue;
        for (at = 1; at < header + 9; at++) crc = eeruf_mavlink_crc(crc, frame[at]);
        crc = eeruf_mavlink_crc(crc, EERUF_MAVLINK_HEARTBEAT);
        if (frame[header + 9] != (crc & 0xff) || frame[header + 10] != crc >> 8) continue;
        armed = frame[header + 6] >> 7;
        /* Sensors that have failed are named again. */
        if (armed && !link->armed) memset(link->reported, 0, sizeof link->reported);
        link->armed = armed;
    }
}

static inline void eeruf_mavlink_put(EerufMavlink *link, uint32_t value, uint8_t bytes) {
    for (; bytes > 0; bytes--, value >>= 8) link->frame[link->size++] = (uint8_t)(value & 0xff);
}

static inline void eeruf_mavlink_begin(EerufMavlink *link, uint16_t message) {
    link->size = link->written = 0;
    eeruf_mavlink_put(link, 0xfd, 4);
    eeruf_mavlink_put(link, link->sequence++, 1);
    eeruf_mavlink_put(link, EERUF_MAVLINK_SYSTEM, 1);
    eeruf_mavlink_put(link, EERUF_MAVLINK_COMPONENT, 1);
    eeruf_mavlink_put(link, message, 3);
}

/* Ends a message; zeros at the end of the payload are left out. */
static inline void eeruf_mavlink_end(EerufMavlink *link, uint8_t extra) {
    uint16_t crc = 0xffff;
    uint8_t at;
    while (link->size > 11 && link->frame[link->size - 1] == 0) link->size--;
    link->frame[1] = (uint8_t)(link->size - 10);
    for (at = 1; at < link->size; at++) crc = eeruf_mavlink_crc(crc, link->frame[at]);
    eeruf_mavlink_put(link, eeruf_mavlink_crc(crc, extra), 2);
}

/* The distance that a sensor sees, in centimetres: above the maximum for nothing in range, 65535 for unknown. */
static inline uint16_t eeruf_mavlink_cm(const EerufMavlink *link, const EerufWatch *watch, uint8_t sensor,
                                        uint8_t *unanswered) {
    EerufState state = {0, 0, EERUF_STATE_UNKNOWN, 0, 0};
    uint32_t cm;
    (void)eeruf_watch_state(watch, sensor, link->now_us, &state);
    *unanswered = state.kind == EERUF_STATE_UNANSWERED;
    if (state.kind == EERUF_STATE_UNKNOWN || *unanswered || state.age_us > EERUF_MAVLINK_OLD_US) return UINT16_MAX;
    if (state.kind == EERUF_STATE_CLEAR) return (uint16_t)(link->max_cm + 1u);
    cm = state.kind == EERUF_STATE_OBSTACLE ? (eeruf_distance_mm(state.t_echo_us, EERUF_SOUND_20C) + 5) / 10 : 0;
    if (cm > link->max_cm) return (uint16_t)(link->max_cm + 1u);
    return cm < link->min_cm ? link->min_cm : (uint16_t)cm;
}

/* Makes a message of the nearest obstacle in each 5-degree sector; without one, unknown if any sensor is, else free. */
static inline void eeruf_mavlink_obstacles(EerufMavlink *link, const EerufWatch *watch) {
    uint16_t sectors[72] = {0};
    uint8_t sector, x, unanswered;
    for (x = 0; x < link->sensors; x++) {
        const uint16_t cm = eeruf_mavlink_cm(link, watch, x, &unanswered);
        for (sector = 0; sector < 72; sector++) {
            /* Starting 20 degrees to the left, where one of ArduPilot's faces begins. */
            const uint16_t apart = (uint16_t)((700u + 5u * sector - link->places[x].yaw_deg) % 360u);
            uint16_t *held = &sectors[sector];
            if ((apart < 180 ? apart : 360u - apart) > link->half_view_deg) continue;
            /* Obstacles come before unknown before free: the order of the numbers but for the last two. */
            if (*held == 0 || (cm <= link->max_cm ? cm < *held : *held > link->max_cm && cm > *held)) *held = cm;
        }
    }
    eeruf_mavlink_begin(link, 330);
    eeruf_mavlink_put(link, link->now_us, 4);
    eeruf_mavlink_put(link, link->turns, 4);
    for (sector = 0; sector < 72; sector++)
        eeruf_mavlink_put(link, sectors[sector] == 0 ? UINT16_MAX : sectors[sector], 2);
    eeruf_mavlink_put(link, link->min_cm, 2);
    eeruf_mavlink_put(link, link->max_cm, 2);
    eeruf_mavlink_put(link, 1 | 5 << 8, 2);      /* ultrasound; 5 degrees */
    eeruf_mavlink_put(link, 0x40a00000u, 4);     /* 5.0 */
    eeruf_mavlink_put(link, 0xc1a00000u, 4);     /* -20.0 */
    eeruf_mavlink_put(link, 12, 1);              /* body, front right down */
    eeruf_mavlink_end(link, 23);
}

static inline void eeruf_mavlink_distance(EerufMavlink *link, uint8_t sensor, uint16_t cm) {
    eeruf_mavlink_begin(link, 132);
    eeruf_mavlink_put(link, link->now_us / 1000u + link->turns * 4294967u, 4);
    eeruf_mavlink_put(link, link->min_cm, 2);
    eeruf_mavlink_put(link, link->max_cm, 2);
    eeruf_mavlink_put(link, cm, 2);
    eeruf_mavlink_put(link, 1, 1);               /* ultrasound */
    eeruf_mavlink_put(link, sensor, 1);
    eeruf_mavlink_put(link, link->places[sensor].rotation, 1);
    eeruf_mavlink_put(link, 255, 1);             /* covariance unknown */
    eeruf_mavlink_put(link, 0x3f051eb8u, 4);     /* 0.52 rad */
    eeruf_mavlink_put(link, 0x3f051eb8u, 4);
    eeruf_mavlink_put(link, 0, 16);              /* the quaternion is for custom rotations */
    eeruf_mavlink_put(link, 100, 1);
    eeruf_mavlink_end(link, 85);
}

static inline void eeruf_mavlink_failure(EerufMavlink *link, uint8_t sensor) {
    static const char text[] = "\2eeruf: sensor 00 does not answer"; /* critical */
    eeruf_mavlink_begin(link, 253);
    memcpy(link->frame + link->size, text, sizeof text - 1);
    link->frame[link->size + 15] = (uint8_t)('0' + (sensor + 1) / 10);
    link->frame[link->size + 16] = (uint8_t)('0' + (sensor + 1) % 10);
    link->size = (uint8_t)(link->size + sizeof text - 1);
    eeruf_mavlink_end(link, 83);
}

/* Makes the next message, if there is one to send. */
static inline void eeruf_mavlink_next(EerufMavlink *link, const EerufWatch *watch) {
    uint8_t x, tried, unanswered, named = 255;
    link->failed = link->sees = 0;
    for (x = 0; x < link->sensors; x++) {
        link->sees |= eeruf_mavlink_cm(link, watch, x, &unanswered) != UINT16_MAX;
        link->failed |= unanswered;
        if (unanswered && named == 255 && !(link->reported[x / 8] >> x % 8 & 1)) named = x;
    }
    if (named != 255) {
        link->reported[named / 8] = (uint8_t)(link->reported[named / 8] | 1u << named % 8);
        eeruf_mavlink_failure(link, named);
    } else if (link->now_us - link->beat_us >= 1000000u) {
        link->beat_us = link->now_us;
        link->owes_status = 1;
        eeruf_mavlink_begin(link, 0);
        eeruf_mavlink_put(link, 0, 4);
        eeruf_mavlink_put(link, 18 | 8 << 8, 3); /* an onboard controller without autopilot */
        eeruf_mavlink_put(link, link->failed ? 5 : 4, 1); /* critical, or active */
        eeruf_mavlink_put(link, 3, 1);
        eeruf_mavlink_end(link, EERUF_MAVLINK_HEARTBEAT);
    } else if (link->owes_status) {
        link->owes_status = 0;
        eeruf_mavlink_begin(link, 1);
        eeruf_mavlink_put(link, (uint32_t)1 << 25, 4); /* proximity: present, enabled, in health */
        eeruf_mavlink_put(link, (uint32_t)1 << 25, 4);
        eeruf_mavlink_put(link, (uint32_t)!link->failed << 25, 4);
        eeruf_mavlink_put(link, 0xffff0000u, 4); /* load; voltage and current unknown */
        eeruf_mavlink_put(link, 0xffff, 2);
        eeruf_mavlink_put(link, 0, 12);
        eeruf_mavlink_put(link, 0xff, 1);
        eeruf_mavlink_end(link, 124);
    } else if (link->sees && (link->armed || !link->failed)) {
        /* The ring, then each sensor that has a rotation and sees something. */
        for (tried = 0; tried <= link->sensors; tried++) {
            const uint8_t turn = link->next;
            uint16_t cm;
            link->next = turn < link->sensors ? (uint8_t)(turn + 1u) : 0;
            if (turn == link->sensors) {
                eeruf_mavlink_obstacles(link, watch);
                return;
            }
            cm = eeruf_mavlink_cm(link, watch, turn, &unanswered);
            if (link->places[turn].rotation == 255 || cm == UINT16_MAX) continue;
            eeruf_mavlink_distance(link, turn, cm);
            return;
        }
    }
}

/* Returns the bytes to write now, at most as many as there is room for; they stay valid until the next call. Pass the
   events of the ring to the watch. */
static inline size_t eeruf_mavlink_take(EerufMavlink *link, const EerufWatch *watch, uint32_t now_us, size_t room,
                                        const uint8_t **bytes) {
    size_t size;
    link->turns += now_us < link->now_us;
    link->now_us = now_us;
    if (link->written == link->size && now_us - link->sent_us >= EERUF_MAVLINK_PACE_US) {
        link->sent_us = now_us;
        eeruf_mavlink_next(link, watch);
    }
    size = (size_t)(link->size - link->written);
    if (size > room) size = room;
    *bytes = link->frame + link->written;
    link->written = (uint8_t)(link->written + size);
    return size;
}

#endif

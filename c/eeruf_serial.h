/*
 * The frames of a ring on a serial line: one for each firing, for eeruf-ros2 and `eeruf diagnose`. Byte by byte:
 * docs/reference/serial.md.
 *
 *     uint16_t late_us[8];
 *     EerufSerial line = EERUF_SERIAL(late_us, 8, "board");
 *     ...
 *         while (eeruf_ring_poll(&ring, now, &event) == EERUF_EVENT) {
 *             uint8_t frame[EERUF_FRAME];
 *             size_t size = eeruf_serial_event(&line, &ring, &modules, &event, now, frame);
 *             if (size > 0) write(frame, size);
 *
 * C99 to C++20. Frames at the end of a period hold a byte for each sensor; EERUF_FRAME is enough for all 64.
 */
#ifndef EERUF_SERIAL_H
#define EERUF_SERIAL_H

#include "eeruf.h"

#ifdef __AVR__
#include <util/crc16.h> /* the same check sum in 20 cycles a byte */
#endif

/* The longest frame: 74 bytes of content, two of check sum, two of packing. */
#ifndef EERUF_FRAME
#define EERUF_FRAME 78
#endif

typedef struct EerufSerial {
    uint16_t *late_us; /* a place for each sensor */
    const char *clock; /* the name of the board's clock: ASCII, of which 16 bytes are sent */
    uint16_t sequence;
    uint8_t sensors, firings;
} EerufSerial;
#define EERUF_SERIAL(late_us, sensors, clock) {late_us, clock, 0, sensors, 0}

/* A frame in progress: content from bytes[1] on, packed in place. Not for the caller. */
typedef struct EerufFrame {
    uint8_t *bytes;
    uint16_t crc;
    uint8_t length, zero;
} EerufFrame;

/* Packs a byte by COBS: a zero becomes the distance to the next one; contents are shorter than 254 bytes. */
static inline void eeruf_frame_pack(EerufFrame *frame, uint8_t byte) {
    frame->length++;
    frame->bytes[frame->length] = byte;
    if (byte == 0) {
        frame->bytes[frame->zero] = (uint8_t)(frame->length - frame->zero);
        frame->zero = frame->length;
    }
}

/* Adds a number, with its CRC-16/IBM-3740: polynomial 0x1021, initial value 0xFFFF. */
static inline void eeruf_frame_put(EerufFrame *frame, uint32_t value, uint8_t bytes) {
    for (; bytes > 0; bytes--, value >>= 8) {
#ifdef __AVR__
        frame->crc = _crc_xmodem_update(frame->crc, (uint8_t)(value & 0xFF));
#else
        uint8_t bit;
        frame->crc = (uint16_t)(frame->crc ^ (uint16_t)((value & 0xFF) << 8));
        for (bit = 0; bit < 8; bit++)
            frame->crc = (uint16_t)((uint16_t)(frame->crc << 1) ^ ((frame->crc & 0x8000) != 0 ? 0x1021 : 0));
#endif
        eeruf_frame_pack(frame, (uint8_t)(value & 0xFF));
    }
}

static inline EerufFrame eeruf_frame_begin(EerufSerial *line, uint8_t kind, uint8_t *bytes) {
    EerufFrame frame = {bytes, 0xFFFF, 0, 0};
    eeruf_frame_put(&frame, (uint32_t)0x20 | kind, 1);
    eeruf_frame_put(&frame, line->sequence++, 2);
    return frame;
}

static inline size_t eeruf_frame_end(EerufFrame *frame) {
    const uint16_t crc = frame->crc;
    eeruf_frame_pack(frame, (uint8_t)(crc & 0xFF));
    eeruf_frame_pack(frame, (uint8_t)(crc >> 8));
    /* The zero at the end, and the distance to it. */
    eeruf_frame_pack(frame, 0);
    return (size_t)frame->length + 1;
}

/* Makes the frame of an event and returns its size; 0 if there is none. Pass every event, with the `now_us` of its
   poll. `modules` may be null if the sensors' health is unknown. */
static inline size_t eeruf_serial_event(EerufSerial *line, const EerufRing *ring, const EerufHcSr04 *modules,
                                        const EerufEvent *event, uint32_t now_us, uint8_t *bytes) {
    EerufFrame frame;
    uint8_t sensor;
    if (event->kind == EERUF_EVENT_FIRE) {
        const uint32_t late_us = now_us - event->u.due_us;
        const char *letter = line->clock;
        if (event->sensor < line->sensors) line->late_us[event->sensor] = (uint16_t)(late_us > 65535 ? 65535 : late_us);
        /* Sends a greeting now and then, for late listeners. */
        if (line->firings++ % 128 != 0) return 0;
        frame = eeruf_frame_begin(line, 0, bytes);
        eeruf_frame_put(&frame, line->sensors, 1);
        for (; *letter != 0 && letter - line->clock < 16; letter++) eeruf_frame_put(&frame, (uint8_t)*letter, 1);
        return eeruf_frame_end(&frame);
    }
    if (event->kind == EERUF_EVENT_READING) {
        uint32_t fired_us;
        if (event->sensor >= line->sensors || event->sensor >= ring->count) return 0;
        fired_us = eeruf_ring_fired_at(ring, event->sensor);
        frame = eeruf_frame_begin(line, 1, bytes);
        eeruf_frame_put(&frame, event->sensor, 1);
        eeruf_frame_put(&frame, event->phase, 1);
        eeruf_frame_put(&frame, event->u.reading.kind, 1);
        eeruf_frame_put(&frame, fired_us, 4);
        eeruf_frame_put(&frame, event->period, 4);
        eeruf_frame_put(&frame, event->u.reading.t_echo_us, 4);
        eeruf_frame_put(&frame, line->late_us[event->sensor], 2);
        eeruf_frame_put(&frame, now_us - fired_us, 4);
        eeruf_frame_put(&frame, event->u.reading.explained_by, 1);
        return eeruf_frame_end(&frame);
    }
    frame = eeruf_frame_begin(line, 2, bytes);
    eeruf_frame_put(&frame, event->period, 4);
    eeruf_frame_put(&frame, event->u.ended.max_late_us, 2);
    eeruf_frame_put(&frame, 0, 1);
    for (sensor = 0; sensor < line->sensors; sensor++)
        eeruf_frame_put(&frame, modules == NULL ? 0 : eeruf_hc_sr04_health(modules, sensor), 1);
    return eeruf_frame_end(&frame);
}

#endif

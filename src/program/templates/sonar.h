#ifndef SONAR_H
#define SONAR_H

#include "eeruf.h"
#include "eeruf_mavlink.h"  //@mavlink
#include "ring.h"

/* Written by you, for the board: */

/* A clock in microseconds that runs on and wraps at 32 bits. */
uint32_t board_micros(void);
/* True if the echo line of a module, from 0, is high. */
bool board_line_is_high(uint8_t sensor);
/* A pulse of this many microseconds on the trigger of a module. */
void board_trigger(uint8_t sensor, uint16_t us);

/* Called by you: */

/* Begins. The seed is the chip's number, or another that each robot has of its own, not 0. EERUF_OK, or what is wrong. */  //@flow
EerufStatus sonar_begin(uint32_t seed);  //@flow
/* Begins. EERUF_OK, or what is wrong. */  //@table
EerufStatus sonar_begin(void);  //@table
/* From the interrupt of any change of an echo line. */
void sonar_edge(uint8_t sensor, bool high);
/* Says how fast the robot moves, in mm/s, and turns, in mrad/s: once a control cycle. Else the ring file's speed counts. */  //@flow
void sonar_moving(uint32_t speed_mm_s, uint32_t turn_mrad_s);  //@flow
/* As often as you can: fires what is due. True with a reading: EERUF_READING_ACCEPTED is a distance
   (eeruf_distance_mm), EERUF_READING_CLEAR free space, all else no news. */
bool sonar_read(uint8_t *sensor, EerufReading *reading);
/* True, about once a second, if you do not: a module had no two readings in it. */
bool sonar_too_slow(void);
/* Each byte that comes from the autopilot. */  //@mavlink
void sonar_heard(uint8_t byte);  //@mavlink
/* Bytes for the autopilot, at most as many as the line has room for, and where they are until the next call. */  //@mavlink
size_t sonar_mavlink(size_t room, const uint8_t **bytes);  //@mavlink

#endif

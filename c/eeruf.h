/* eeruf: Error Eliminating Rapid Ultrasonic Firing (Borenstein and Koren, 1995) for rings of ultrasonic sensors, in C.
 *
 *   #include "eeruf.h"
 *   #include "ring.h"                          // written by: eeruf design RING.toml --period-only --emit c > ring.h
 *
 *   static EerufRing ring;                     // your memory: nothing is allocated
 *   static EerufSensor sensors[EERUF_SENSORS];
 *
 *   int main(void) {
 *       EerufConfig config = EERUF_CONFIG;     // listen and compare as the schedule was verified for
 *       if (eeruf_ring_init(&ring, sizeof ring, sensors, sizeof sensors, &eeruf_schedule, &config, now_us()) != 0)
 *           halt();                            // a status says why
 *       for (;;) {
 *           EerufEvent event;
 *           while (eeruf_ring_poll(&ring, now_us(), &event) == EERUF_EVENT) {
 *               if (event.kind == EERUF_EVENT_FIRE) trigger(event.sensor);
 *               if (event.kind == EERUF_EVENT_READING && event.u.reading.kind == EERUF_READING_ACCEPTED)
 *                   use(event.sensor, eeruf_distance_mm(event.u.reading.t_echo_us, EERUF_SOUND_20C));
 *           }
 *           sleep_until_us(eeruf_ring_deadline(&ring));
 *       }                                      // and from the echo line: eeruf_ring_echo(&ring, sensor, at_us)
 *   }
 *
 * C99 to C++20; no floats, no clock, nothing that blocks, 64-bit arithmetic only for the speed of sound. Times are in
 * us. Instants (`now_us`, `at_us`) are readings of your free-running 32-bit counter, which may wrap at any moment.
 * Sensors are counted from 0. One caller at a time: interrupts pass edges on through EerufEdges. For HC-SR04 modules
 * see EerufHcSr04. The events are those of the Rust crates eeruf-core and eeruf-hc-sr04.
 *
 * Licence: MIT OR Apache-2.0. */
#ifndef EERUF_H
#define EERUF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define EERUF_VERSION 5u /* raised with each change of a structure or a table */

/* Number of firings that a ring with a table remembers of each sensor, 4 bytes each: 2 to 32, the same for library and
   program. Four suffice if sound is audible for no longer than a period; readings that a forgotten firing might explain
   are ambiguous. -DEERUF_AGREEMENT_ALONE skips that check and accepts crosstalk that repeats: a baseline. */
#ifdef EERUF_AGREEMENT_ALONE
#define EERUF_FIRINGS 1
#elif !defined(EERUF_FIRINGS)
#define EERUF_FIRINGS 4
#elif EERUF_FIRINGS < 2 || EERUF_FIRINGS > 32
#error "EERUF_FIRINGS: expected 2 to 32, likely meant: -DEERUF_AGREEMENT_ALONE, a baseline that accepts crosstalk"
#endif

/* Schedules lie in flash, which on an AVR has its own address space, named by PROGMEM. */
#ifdef __AVR__
#include <avr/pgmspace.h>
#define EERUF_FLASH PROGMEM
#else
#define EERUF_FLASH
#endif

/* Code called by interrupts is in RAM, since flash cannot be read while it is being written. */
#if defined(ESP8266)
#include <c_types.h>
#define EERUF_IN_RAM IRAM_ATTR
#elif defined(ESP_PLATFORM)
#include <esp_attr.h>
#define EERUF_IN_RAM IRAM_ATTR
#else
#define EERUF_IN_RAM
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The result of a call: 0 or more is success. */
typedef int8_t EerufStatus;
enum {
    EERUF_OK = 0,
    EERUF_EVENT = 1,             /* there is an event: handle it and poll again */
    EERUF_DO_NOT_TRIGGER = 2,    /* the echo line is high: the module would not hear the trigger */
    EERUF_EMPTY = 3,             /* no edge is waiting in the queue */
    EERUF_ERR_NULL = -1,         /* a pointer is null */
    EERUF_ERR_MEMORY = -2,       /* the memory handed in is too small, or of another version's size */
    EERUF_ERR_VERSION = -3,      /* header, library and table differ in version */
    EERUF_ERR_NOT_READY = -4,    /* not initialised */
    EERUF_ERR_SENSOR = -5,       /* there is no such sensor */
    EERUF_ERR_SENSORS = -6,      /* not 1 to 64 sensors, or not as many as the ring has */
    EERUF_ERR_PHASES = -7,       /* not 1 to 8 phases (2 if verified), or not as many as the ring has */
    EERUF_ERR_PERIOD = -8,       /* a period that is not 1 us to 268 s, or too short for window and code */
    EERUF_ERR_FIRE = -9,         /* a sensor would fire after its period has ended */
    EERUF_ERR_TABLE = -10,       /* a schedule that contradicts itself */
    EERUF_ERR_CROSSTALK = -11,   /* crosstalk would pass: (13a) or (13b) does not hold for this t_delta */
    EERUF_ERR_STALE_ECHO = -12,  /* a sensor's own echo from the previous period would pass */
    EERUF_ERR_INTERVAL = -13,    /* two neighbours fire too close together */
    EERUF_ERR_UNVERIFIED = -14,  /* the schedule was not verified */
    EERUF_ERR_T_DELTA = -15,     /* more t_delta than the schedule was verified for */
    EERUF_ERR_VERIFIED_WINDOW = -16, /* a longer window than the schedule was verified for */
    EERUF_ERR_WINDOW = -17,      /* a sensor would fire again while it still listens */
    EERUF_ERR_BLANKING = -18,    /* blanking no shorter than the window, or longer than 65,535 us */
    EERUF_ERR_COARSE_T_DELTA = -19, /* t_delta no shorter than the window, or longer than 65,535 us */
    EERUF_ERR_CONSECUTIVE = -20, /* not 2 to 8 readings compared */
    EERUF_ERR_RETRIGGER = -21,   /* the schedule triggers a module before it has rested */
    EERUF_ERR_RANGE = -26,       /* a number outside its range */
    EERUF_ERR_FLOW = -27,        /* not possible with a flow ring, or it has its own function for this */
    EERUF_ERR_AUDIBLE = -29,     /* sound audible for less than 1,000 us (likely given in ms), or for more than 67 s */
    EERUF_ERR_PATH_CHANGE = -30, /* a path of sound that changes by more than 65,534 us */
    EERUF_ERR_TOGETHER = -31,    /* two sensors of one group do not fire together */
    EERUF_ERR_BETWEEN = -32,     /* an edge whose latest instant is before its earliest: likely swapped */
    /* A setting of a flow ring is out of range: likely given in milliseconds or m/s. */
    EERUF_ERR_FLOW_T_DELTA = -40,     /* more than 10,000 us */
    EERUF_ERR_FLOW_NEAR = -41,        /* more than 10,000 us */
    EERUF_ERR_FLOW_PATH_CHANGE = -42, /* more than 10,000 us */
    EERUF_ERR_FLOW_TOP_SPEED = -43,   /* less than 10 mm/s, and not 0 */
    EERUF_ERR_FLOW_HOLD = -44,        /* not 1 to 100 */
    EERUF_ERR_FLOW_MOST = -45,        /* not 1,000 to 250,000 us */
    EERUF_ERR_FLOW_LEAST = -46,       /* not 100 us to the most */
    EERUF_ERR_FLOW_REST = -47,        /* not 1,000 to 4,000,000 us */
    EERUF_ERR_FLOW_DICE = -48,        /* not 8 to 250,000 us, nor 0 */
    EERUF_ERR_FLOW_SEED = -49,        /* 0 */
    EERUF_ERR_FLOW_WINDOW = -50       /* not 1,000 to 4,000,000 us */
};

/* The library's EERUF_VERSION, to be compared with the header's. */
uint16_t eeruf_version(void);

/* ---- Schedules ---- */

#define EERUF_MAX_SENSORS 64u
#define EERUF_MAX_PHASES 8u
#define EERUF_MAX_PERIOD_US 268435456u

/* Neighbours are less than `neighbours` apart on a line or a closed ring, or in one block of this many. */
enum { EERUF_LAYOUT_LINE = 0, EERUF_LAYOUT_RING = 1, EERUF_LAYOUT_BLOCKS = 2, EERUF_LAYOUT_OTHER = 3 };

#define EERUF_AS_T_DELTA UINT32_MAX /* a path of sound changes by as much as the receiver's t_delta */

/* The limits of one sensor, if sensors are not all alike. */
typedef struct EerufLimits {
    uint32_t window_us;   /* listening time; 0: as long as the schedule allows */
    uint16_t t_delta_us;  /* greatest difference that counts as the same echo */
    uint8_t group;        /* sensors of one group fire together and do not hear each other; 0 for none */
} EerufLimits;

/* The firing times of each sensor: `eeruf design --emit c` writes them as a constant in flash. */
typedef struct EerufSchedule {
    uint16_t version;       /* EERUF_VERSION */
    uint8_t sensors;        /* 1 to 64 */
    uint8_t phases;         /* 1 to 8; two to be verified */
    const uint8_t *order;   /* [phases][sensors]: the sensors in firing order */
    const uint32_t *gap_us; /* [phases][sensors + 1]: time before each firing; from the last to the end */
    uint32_t period_us;     /* T_p */
    uint32_t min_refire_us; /* the shortest time between two firings of one sensor */
    /* The requirements that were verified; all zero if none were. */
    uint32_t t_delta_us;    /* (13a) and (13b) hold for it; like the window, the largest of all sensors */
    uint32_t min_interval_us;
    uint32_t window_us;
    uint32_t separation_us; /* least shift of crosstalk from one reading to the next */
    uint32_t path_change_us; /* P: the largest change of a path in that time, or EERUF_AS_T_DELTA */
    uint32_t audible_us;    /* R: how long sound may be heard after its firing */
    uint8_t verified;
    uint8_t layout;         /* EERUF_LAYOUT_.. */
    uint8_t neighbours;
    uint8_t stale_echo;     /* true if a sensor's own echo from the previous period is rejected too */
    const EerufLimits *limits; /* one for each sensor if they differ; else null */
} EerufSchedule;

/* Checks every number of a schedule in flash, and that the schedule meets the requirements that it names: (13a), (13b),
   the interval (not for EERUF_LAYOUT_OTHER) and the window. Tables written by `eeruf` pass. */
EerufStatus eeruf_schedule_check(const EerufSchedule *schedule);

/* ---- The filter ---- */

#define EERUF_NO_ECHO UINT32_MAX
#define EERUF_NEVER UINT16_MAX /* the age of a sensor that has never had a reading accepted */

/* The outcome of one firing. */
enum {
    EERUF_READING_FIRST = 0,    /* an echo with nothing to compare it with */
    EERUF_READING_ACCEPTED = 1, /* near-identical to the one before (Eq. 11): it counts */
    EERUF_READING_REJECTED = 2, /* not near-identical: crosstalk, noise, or an object that moved too fast */
    EERUF_READING_REPEATED = 3, /* near-identical, but not yet often enough; in a flow ring: belief outlasts it */
    EERUF_READING_NO_ECHO = 4,  /* no echo, once, or without a witness */
    EERUF_READING_CLEAR = 5,    /* no echo several times in a row: nothing is in range */
    EERUF_READING_TOO_EARLY = 6, /* nothing but an edge within the blanking time */
    EERUF_READING_LATE = 7,     /* an edge after the window has ended; without echo time: too uncertain an edge */
    EERUF_READING_STUCK = 8,    /* the echo line was high when the sensor was to fire */
    EERUF_READING_TENTATIVE = 9, /* only from rings before version 4 */
    EERUF_READING_AMBIGUOUS = 10, /* near-identical, but sound of another firing explains both: not believed */
    EERUF_READING_UNANSWERED = 11, /* no evidence at all: no edge, no sign of listening; never free space */
    EERUF_READING_KINDS = 12
};

#define EERUF_BY_HISTORY 0xFEu /* a firing that may explain an ambiguous reading is no longer remembered */
#define EERUF_BY_NOTHING 0xFFu

typedef struct EerufReading {
    uint32_t t_echo_us;   /* EERUF_NO_ECHO if there was none */
    uint32_t previous_us; /* the echo time that it was compared with, or EERUF_NO_ECHO */
    uint16_t age;         /* firings since the last accepted reading, or EERUF_NEVER */
    uint8_t kind;         /* EERUF_READING_.. */
    uint8_t explained_by; /* reason for ambiguity: a sensor, or EERUF_BY_HISTORY; else EERUF_BY_NOTHING */
} EerufReading;

/* One sensor's filter. Not for the caller. */
typedef struct EerufFilter {
    uint32_t known_us;
    uint16_t age;
    uint8_t state, flags, off[2]; /* the last two of a ring's sensor */
} EerufFilter;

/* ---- The ring: a reading is accepted if it agrees with the one before and no firing explains both ----

   Sound of a sensor explains two readings, heard at h1 and h2, if it fired at a and b with 0 <= h1 - a <= R,
   0 <= h2 - b <= R and |(h2 - b) - (h1 - a)| <= P; the receiver's own two firings, whose echoes it is meant to hear, do
   not count. The test uses actual, not planned firings: late polls, pauses and restarts may cost readings, but no
   single path of foreign sound that is audible for at most R and changes by at most P is ever accepted. Such readings
   are EERUF_READING_AMBIGUOUS. While firings are as punctual as the schedule was verified for, there are none, and the
   ring skips the test. */

/* One sensor of a ring: 30 bytes on an AVR. Not for the caller. */
typedef struct EerufSensor {
    uint32_t echo_us;
    EerufFilter filter;
    uint32_t fired_us[EERUF_FIRINGS]; /* latest first */
} EerufSensor;

/* Settings by which a ring listens and compares. */
typedef struct EerufConfig {
    uint16_t version;     /* EERUF_VERSION */
    uint8_t consecutive;  /* number of consecutive readings that must agree, 2 to 8 */
    uint32_t t_delta_us;  /* 0: the schedule's; at most 65,535 us */
    uint32_t window_us;   /* 0: what the schedule was verified for */
    uint32_t blanking_us; /* edges sooner than this after firing are ringing, not echoes */
    uint32_t path_change_us; /* P; 0: what the schedule was verified for, by default t_delta */
    uint32_t audible_us;  /* R; 0: what the schedule was verified for, or else its period */
} EerufConfig;
#define EERUF_CONFIG {EERUF_VERSION, 2, 0, 0, 0, 0, 0}

enum {
    EERUF_EVENT_FIRE = 0,    /* fire this sensor, now */
    EERUF_EVENT_READING = 1, /* the outcome of an earlier firing */
    EERUF_EVENT_PERIOD = 2   /* a period has ended */
};

/* Counts since the end of the previous period. Lateness stops at 65,535 us. */
typedef struct EerufPeriod {
    uint16_t max_late_us;  /* largest lateness of a firing or of the end */
    uint16_t sum_late_us;  /* sum of lateness, by which the timetable got longer */
    uint8_t tally[EERUF_READING_KINDS]; /* readings by kind; each stops at 255 */
} EerufPeriod;

typedef struct EerufEvent {
    uint8_t kind;    /* EERUF_EVENT_.. */
    uint8_t sensor;  /* for a firing or a reading */
    uint8_t phase;   /* of the firing, or of the period that has ended */
    uint32_t period; /* number of that period, from 0; for a reading or a period */
    union {
        uint32_t due_us;      /* EERUF_EVENT_FIRE: in the past if the poll is late */
        EerufReading reading; /* EERUF_EVENT_READING */
        EerufPeriod ended;    /* EERUF_EVENT_PERIOD */
    } u;
} EerufEvent;

/* A ring: 73 bytes on an AVR. Initialise it with eeruf_ring_init; not for the caller otherwise. */
typedef struct EerufRing {
    uint16_t ready;
    const EerufSchedule *schedule;
    EerufSensor *sensors;
    void (*hook)(struct EerufRing *ring, uint8_t sensor, uint32_t us);
    uint32_t due_us, last_fired_us, emit_at_us, window_us, period, audible_us, known_from_us, report_after_us;
    uint16_t t_delta_us, blanking_us, path_change_us, latest_us, sum_late_us;
    uint8_t count, phase, following, next, paused, oldest, pending, consecutive, watched, stride, unanswered;
    uint8_t tally[EERUF_READING_KINDS];
} EerufRing;

/* Makes a ring that fires by a verified schedule from `now_us` on. `sensors` has an entry for each sensor of the
   schedule. Sizes are in bytes. The config may ask for less than the schedule was verified for, but not for more. */
EerufStatus eeruf_ring_init(EerufRing *ring, size_t ring_size, EerufSensor *sensors, size_t sensors_size,
                            const EerufSchedule *schedule, const EerufConfig *config, uint32_t now_us);
/* Makes a ring by a schedule that need not be verified; the config gives t_delta and window. It accepts no crosstalk
   either, but readings that crosstalk could explain are ambiguous: nearly all with constant waits. */
EerufStatus eeruf_ring_init_unverified(EerufRing *ring, size_t ring_size, EerufSensor *sensors, size_t sensors_size,
                                       const EerufSchedule *schedule, const EerufConfig *config, uint32_t now_us);

/* Returns EERUF_EVENT with the next event, or EERUF_OK if there is none at `now_us`: then sleep until the deadline.
   Report all edges you know of first. A late poll loses nothing: the due firing and all later ones are postponed. If
   that shifts crosstalk so that it could explain a reading, the reading is ambiguous. */
EerufStatus eeruf_ring_poll(EerufRing *ring, uint32_t now_us, EerufEvent *event);
/* Like eeruf_ring_poll, for a robot that moves: `change_us` has the change that each sensor's good reading should show
   since its previous firing; or null. If it is not 0, readings on time are checked for explanations too. */
EerufStatus eeruf_ring_poll_expecting(EerufRing *ring, uint32_t now_us, const int32_t *change_us, EerufEvent *event);
/* The time of the next poll; 0 for a ring that is not initialised. */
uint32_t eeruf_ring_deadline(const EerufRing *ring);
/* The instant when the next firing or the end of the period is due, even if readings are waiting. Do not poll shortly
   before it: emitting a reading takes time and would make the firing late. 0 for a ring that is not initialised. */
uint32_t eeruf_ring_due(const EerufRing *ring);

/* The upcoming firings, for a timer or other hardware that fires by itself: number 0 is the next, 1 the one after it.
   They hold until one is late or the ring is changed. EERUF_EMPTY beyond the end of the next period, or in a flow ring
   beyond the next firing. The main loop may then run late and replay what happened in order: for each firing, poll at
   its instant until there is no event (EERUF_EVENT_FIRE then reports a firing already done) and report its echoes;
   finally poll at the current time. A firing that hardware has missed is then still due. */
EerufStatus eeruf_ring_upcoming(const EerufRing *ring, uint8_t number, uint8_t *sensor, uint32_t *due_us);

/* Reports an echo at an instant: any number, in any order, at any time, expected or not. For a module whose pulse is as
   wide as the echo time, pass the firing's instant plus the width: see EerufHcSr04. */
EerufStatus eeruf_ring_echo(EerufRing *ring, uint8_t sensor, uint32_t at_us);
/* Reports an echo between two instants: the line was last seen without it at `earliest_us`, and first with it at
   `latest_us`. The middle counts, and explanations allow for the width. If the echo may be off by more than 300 us (5
   cm), its reading is EERUF_READING_LATE, without echo time. */
EerufStatus eeruf_ring_echo_between(EerufRing *ring, uint8_t sensor, uint32_t earliest_us, uint32_t latest_us);
/* Corrects the instant of a sensor's last firing, before or after the poll, for example to a time that a timer
   captured. Echo times count from it. If it is later, all later firings move by as much. Call it before you poll for
   readings that may contain the firing's sound: an accepted reading cannot be taken back. An instant not after the
   previous firing is ignored. */
EerufStatus eeruf_ring_fired(EerufRing *ring, uint8_t sensor, uint32_t at_us);
/* The instant when a sensor last fired; 0 for one out of range. */
uint32_t eeruf_ring_fired_at(const EerufRing *ring, uint8_t sensor);
/* Reports that a sensor's echo line was high when it was to fire: its reading is EERUF_READING_STUCK. */
EerufStatus eeruf_ring_stuck(EerufRing *ring, uint8_t sensor);

/* The meaning of a firing without an echo, from the next firing on, if neither eeruf_ring_answered nor
   eeruf_ring_measured has shown that the sensor listened. EerufHcSr04 takes care of all this. */
enum {
    EERUF_SILENCE_NEVER_FREE = 0,   /* the default: neither free space nor a fault, EERUF_READING_NO_ECHO however often */
    EERUF_SILENCE_NEEDS_ANSWER = 1, /* a fault, EERUF_READING_UNANSWERED: for sensors that show that they listen */
    EERUF_SILENCE_TRUSTED = 2       /* free space once repeated; then even a cut wire is */
};
EerufStatus eeruf_ring_set_silence(EerufRing *ring, uint8_t silence);
EerufStatus eeruf_ring_answered(EerufRing *ring, uint8_t sensor);
EerufStatus eeruf_ring_unanswered(EerufRing *ring, uint8_t sensor); /* takes it back: it was noise */
/* Reports that a sensor holds its line, which rose after the trigger, or is still high so that there was no trigger.
   Its silence counts once, when eeruf_ring_answered reports that the line has fallen. Until then its readings neither
   add to a run of silences nor break it. */
EerufStatus eeruf_ring_holds(EerufRing *ring, uint8_t sensor);
/* Reports the result of a sensor's firing that hardware or a protocol measured, before its reading is emitted: the echo
   time, or EERUF_NO_ECHO if the sensor listened and heard nothing. */
EerufStatus eeruf_ring_measured(EerufRing *ring, uint8_t sensor, uint32_t t_echo_us);
/* Reports a measured echo time between two limits, like eeruf_ring_echo_between. */
EerufStatus eeruf_ring_measured_between(EerufRing *ring, uint8_t sensor, uint32_t least_us, uint32_t most_us);
/* Forgets a sensor's last echo, if it was false: its next reading is compared with nothing. The age keeps counting. */
EerufStatus eeruf_ring_forget(EerufRing *ring, uint8_t sensor);

EerufStatus eeruf_ring_enable(EerufRing *ring, uint8_t sensor, bool enabled); /* from its next turn on */
bool eeruf_ring_is_enabled(const EerufRing *ring, uint8_t sensor);
EerufStatus eeruf_ring_pause(EerufRing *ring, bool paused); /* no sensor fires; periods go on */
EerufStatus eeruf_ring_restart(EerufRing *ring, uint32_t now_us); /* after a long sleep: phase a */

/* Sets the least time from a firing to a reading without an echo, for modules that report over a bus or by a pulse's
   width after their window has closed: at most the time until a sensor fires again. 0: the end of the window. */
EerufStatus eeruf_ring_set_report_after(EerufRing *ring, uint32_t report_after_us);
/* ---- The state in front of each sensor: what is there, since when, and why nothing is known ---- */

enum {
    EERUF_STATE_UNKNOWN = 0,    /* nothing is known: `why` */
    EERUF_STATE_OBSTACLE = 1,   /* something is there: an accepted echo */
    EERUF_STATE_CLEAR = 2,      /* nothing is in range: silence was confirmed */
    EERUF_STATE_TOO_CLOSE = 3,  /* something is closer than the sensor can measure */
    EERUF_STATE_UNANSWERED = 4  /* the sensor does not answer, or its line is stuck */
};
enum {
    EERUF_WHY_NO_FIRING = 0, /* the sensor has not fired yet */
    EERUF_WHY_UNSURE = 1,    /* one echo, or one silence, that is not confirmed yet */
    EERUF_WHY_REJECTED = 2,  /* the last two echoes differ */
    EERUF_WHY_AMBIGUOUS = 3, /* readings agree, and sound of `explained_by` explains both */
    EERUF_WHY_NO_WITNESS = 4 /* silence again, but the sensor has not shown that it listens */
};
const char *eeruf_state_name(uint8_t kind); /* "clear"; not linked unless called */

typedef struct EerufState {
    uint32_t t_echo_us;   /* echo time of an obstacle, else EERUF_NO_ECHO */
    uint32_t age_us;      /* since the last confirmation, or how long nothing is known or answered; at most 2^31 */
    uint8_t kind;         /* EERUF_STATE_.. */
    uint8_t why;          /* for EERUF_STATE_UNKNOWN: EERUF_WHY_.. */
    uint8_t explained_by; /* the explanation, as in the reading */
} EerufState;

/* One sensor of a watch: 10 bytes on an AVR. Not for the caller. */
typedef struct EerufWatched {
    uint32_t at_us, t_echo_us;
    uint8_t state, explained_by;
} EerufWatched;

/* Watches the events of a ring of any kind. Not for the caller. */
typedef struct EerufWatch {
    uint16_t ready;
    EerufWatched *sensors;
    uint32_t seen_us;
    uint8_t count;
} EerufWatch;

/* Starts a watch that knows nothing yet. Call it again with each eeruf_ring_restart: after a long sleep the clock may
   have wrapped, and an old state would look recent. If the clock jumps back, all states are forgotten. */
EerufStatus eeruf_watch_init(EerufWatch *watch, size_t watch_size, EerufWatched *sensors, size_t sensors_size,
                             uint32_t now_us);
/* Processes an event of a poll at `now_us`: pass every one, or at least readings and ends of periods. One reading that
   does not confirm an obstacle only lets its age grow; two in a row end it. Any echo ends EERUF_STATE_CLEAR. */
EerufStatus eeruf_watch_event(EerufWatch *watch, const EerufEvent *event, uint32_t now_us);
EerufStatus eeruf_watch_state(const EerufWatch *watch, uint8_t sensor, uint32_t now_us, EerufState *state);

/* ---- Pace: whether the loop polls often enough ---- */

/* The pace of a loop; initialise it with {0}. Not for the caller. */
typedef struct EerufPace {
    uint32_t heard, twice, since_us; /* sensors with a punctual reading since then, and with two in a row */
    bool late;
} EerufPace;
/* Records an event of a poll. */
void eeruf_pace_event(EerufPace *pace, const EerufEvent *event);
/* True if the loop is too slow, about once a second, and from ten sensors on once in 0.1 s a sensor: one had no two such
   readings in it, or a table's firings came more than a millisecond late, which makes readings ambiguous. */
bool eeruf_pace_too_slow(EerufPace *pace, const EerufRing *ring, uint32_t now_us);

/* ---- Distances ---- */

#define EERUF_SOUND_20C 343200u /* mm/s at 20 C (ISO 9613-1) */
uint32_t eeruf_sound_mm_s(int16_t celsius_tenths);
uint32_t eeruf_distance_mm(uint32_t t_echo_us, uint32_t c_mm_s); /* c t / 2, to the nearest; stops at UINT32_MAX */

/* ---- Edges: from an interrupt, which only time-stamps, to the main loop ---- */

typedef struct EerufEdge {
    uint32_t at_us;    /* instant of detection */
    uint8_t sensor;    /* 0 to 127 */
    bool high;         /* true if the line rose */
    uint8_t early;     /* how much sooner it may have come: units of 8 us to 127, then of 256; 255: any time */
} EerufEdge;

/* A queue of edges; `places` is your memory for 2, 4, 8, .. or 128 of them. */
typedef struct EerufEdges {
    uint16_t ready;
    EerufEdge *places;
    uint8_t mask;
    volatile uint8_t pushed, popped, lost; /* `lost`: edges dropped because it was full; wraps at 256 */
} EerufEdges;

EerufStatus eeruf_edges_init(EerufEdges *edges, size_t edges_size, EerufEdge *places, size_t places_size);
/* Adds an edge. Call it from one interrupt, or from several that do not interrupt one another. */
EerufStatus eeruf_edges_push(EerufEdges *edges, uint8_t sensor, bool high, uint32_t at_us);
/* Adds an edge from a delayed interrupt: the instants when the line was last seen unchanged, and when the edge was
   seen. */
EerufStatus eeruf_edges_push_between(EerufEdges *edges, uint8_t sensor, bool high, uint32_t earliest_us,
                                     uint32_t latest_us);
/* Takes out the oldest edge, in the main loop. EERUF_EMPTY if there is none. */
EerufStatus eeruf_edges_pop(EerufEdges *edges, EerufEdge *edge);

/* ---- HC-SR04 and relatives: a trigger, and an echo line that is high for as long as the echo took ---- */

enum {
    EERUF_HEALTH_WELL = 0,        /* the line answers, or has not been triggered often enough */
    EERUF_HEALTH_MISSING = 1,     /* its line does not answer triggers */
    EERUF_HEALTH_STUCK_HIGH = 2,  /* its line was high when it was to be triggered */
    EERUF_HEALTH_CHATTERS = 3,    /* several pulses followed one trigger */
    EERUF_HEALTH_LOSES_EDGES = 4, /* its line fell without having risen, or the other way round */
    EERUF_HEALTH_PIN_ERROR = 5    /* one of its pins reported an error */
};

/* The modules' times, in microseconds: EERUF_HC_SR04, or EERUF_MODULES of a table whose ring file names them. */
typedef struct EerufHcSr04Settings {
    uint16_t version;          /* EERUF_VERSION */
    uint16_t deaf_us;          /* edges sooner than this after the trigger are crosstalk in the cable */
    uint16_t shortest_us;      /* shorter pulses are not echoes */
    uint16_t latest_rise_us;   /* a line that rises later than this was not raised by the trigger: swapped wires */
    uint32_t longest_us;       /* pulses as long as this are the module's own time-out: no echo */
    uint32_t longest_hold_us;  /* a line that is high no longer than this still listens: clones hold it for 200 ms */
    uint32_t min_retrigger_us; /* the data sheet advises 60 ms */
    uint8_t missing_after;     /* consecutive firings without a pulse until a module counts as missing */
    uint8_t trigger_us;        /* time for which the caller raises the trigger */
} EerufHcSr04Settings;
#define EERUF_HC_SR04 {EERUF_VERSION, 100, 100, 1400, 36000, 250000, 60000, 3, 10}

/* One echo line: 8 bytes on an AVR. Not for the caller. */
typedef struct EerufLine {
    uint32_t rose_us;  /* instant of its rise; before that, when it was last seen low */
    uint16_t width_us; /* width of the last pulse; during one, from its rise to when it was last seen high */
    uint8_t state, silent;
} EerufLine;

/* A ring of HC-SR04 modules. Not for the caller. */
typedef struct EerufHcSr04 {
    uint16_t ready;
    EerufRing *ring;
    EerufLine *lines;
    const EerufHcSr04Settings *settings;
} EerufHcSr04;

/* Puts a ring on its lines. The window should exceed the longest echo by a millisecond, because a line rises only about
   half a millisecond after the trigger. Poll the ring as usual, but report edges of lines here instead of echoes. The
   settings must outlive it. */
EerufStatus eeruf_hc_sr04_init(EerufHcSr04 *modules, size_t modules_size, EerufLine *lines, size_t lines_size,
                               EerufRing *ring, const EerufHcSr04Settings *settings);
/* Begins a firing: call it for each EERUF_EVENT_FIRE, before the next poll, with the level of the echo line. EERUF_OK:
   now raise the trigger for the settings' trigger_us. EERUF_DO_NOT_TRIGGER: do not; the line is stuck, or the module
   still listens and holds it. If one pin is both, read it before you make it an output. */
EerufStatus eeruf_hc_sr04_fire(EerufHcSr04 *modules, uint8_t sensor, bool line_is_high);
/* True after EERUF_DO_NOT_TRIGGER if the line is stuck, but not if the module still listens. Some modules hold their
   line for ever after a lost echo, until it is pulled low: if the pin can drive, and a 1 kOhm resistor in the line
   limits the current, make it an output, low, for EERUF_RECOVERY_US, then an input again. The reading is still
   EERUF_READING_STUCK; the next firing triggers the module if its line stays low. */
bool eeruf_hc_sr04_is_stuck(const EerufHcSr04 *modules, uint8_t sensor);
#define EERUF_RECOVERY_US 200
/* Replaces eeruf_hc_sr04_fire if a timer or other hardware triggers the module. If its line was not seen to fall, the
   module still holds it. */
EerufStatus eeruf_hc_sr04_triggered(EerufHcSr04 *modules, uint8_t sensor);
/* Reports that a pin could not be read before the trigger (then nothing is triggered), or not written. */
EerufStatus eeruf_hc_sr04_cannot_read(EerufHcSr04 *modules, uint8_t sensor);
EerufStatus eeruf_hc_sr04_cannot_write(EerufHcSr04 *modules, uint8_t sensor);
/* Reports an edge of an echo line. Report all edges before you poll. */
EerufStatus eeruf_hc_sr04_edge(EerufHcSr04 *modules, uint8_t sensor, bool high, uint32_t at_us);
/* Reports an edge between two instants: see eeruf_ring_echo_between. The uncertainties of rise and fall add up. */
EerufStatus eeruf_hc_sr04_edge_between(EerufHcSr04 *modules, uint8_t sensor, bool high, uint32_t earliest_us,
                                       uint32_t latest_us);
/* Reports a sample of a line, changed or not, instead of edges, with the clock before and after it. If the level
   changed, the edge came between this sample and the one before. */
EerufStatus eeruf_hc_sr04_look(EerufHcSr04 *modules, uint8_t sensor, bool high, uint32_t before_us, uint32_t after_us);
/* Takes all edges from a queue, or only those up to an instant, such as that of a timer's trigger. */
EerufStatus eeruf_hc_sr04_edges(EerufHcSr04 *modules, EerufEdges *edges);
EerufStatus eeruf_hc_sr04_edges_until(EerufHcSr04 *modules, EerufEdges *edges, uint32_t until_us);
/* Reports the width of a module's pulse, from hardware that measures it, instead of edges. Call it before the reading
   is emitted. */
EerufStatus eeruf_hc_sr04_pulse(EerufHcSr04 *modules, uint8_t sensor, uint32_t width_us);
/* True if the line of a sensor is worth a look: it was triggered, and its pulse is not over. `was_high`, if not null,
   receives its last level. */
bool eeruf_hc_sr04_awaits(const EerufHcSr04 *modules, uint8_t sensor, bool *was_high);
/* Corrects a firing like eeruf_ring_fired, if the trigger came later than the poll. */
EerufStatus eeruf_hc_sr04_fired(EerufHcSr04 *modules, uint8_t sensor, uint32_t at_us);
/* The health of a module at its last complete firing; EERUF_HEALTH_MISSING for one out of range. */
uint8_t eeruf_hc_sr04_health(const EerufHcSr04 *modules, uint8_t sensor);

/* ---- Flow: one sensor after the other, each with as much quiet around its firing as it has needed ----

   A sensor fires a random time after the quiet that it and the sensors before it need; distant sensors
   alternate. A reading is accepted if it fits the belief about its sensor, or if it agrees with the one before and no
   firing explains both as foreign sound. Late polls cost only time. docs/explanation/flow.md has the rules. */

/* Settings of a flow ring: firing, listening and belief. */
typedef struct EerufFlowConfig {
    uint16_t version;        /* EERUF_VERSION */
    uint8_t sensors;         /* 1 to 64 */
    uint32_t window_us, blanking_us; /* as in EerufConfig */
    uint32_t least_us;       /* least time between two firings; equal to most_us: one by one */
    uint32_t most_us;        /* R: greatest such time, and how long sound is heard, with its tail; to 250 ms */
    uint32_t rest_us;        /* least time between two firings of a sensor, for its module to rest; at most 4 s */
    uint32_t dice_us;        /* random time in every gap, twice as long while the robot moves; at least 8 ticks of the
                                clock, at most 250 ms */
    uint32_t seed;           /* seed of the random time, not 0: different on each robot, such as its chip's number */
    uint16_t t_delta_us;     /* greatest difference between two readings that agree, while standing still */
    uint16_t near_us;        /* greatest difference between a reading and the belief; at most 10 ms */
    uint16_t path_change_us; /* P, while standing still */
    uint8_t memory;          /* firings without confirmation after which a belief ends */
    uint8_t hold;            /* contradictions that a belief outlasts while standing still; 1 to 100 */
    uint16_t top_speed_mm_s; /* assumed speed without eeruf_flow_moving; 0: it stands still */
    uint8_t alone;           /* true if no other robot sends sound nearby */
    uint8_t votes;           /* EERUF_VOTES_.. */
    const EerufSchedule *own; /* limits of each sensor if they differ, as `eeruf` writes them; or null */
    const uint8_t *lines;    /* the echo line that each sensor shares, from 1, or 0, in flash like `own`; or null */
} EerufFlowConfig;

/* The number of consecutive echoes needed to accept one. */
enum {
    EERUF_VOTES_BY_MOTION = 0,  /* one while the robot moves and no other is near; else two */
    EERUF_VOTES_EVERY_ECHO = 1, /* one, with twice the least quiet: nothing else keeps foreign sound out */
    EERUF_VOTES_TWO_IN_A_ROW = 2
};

/* For HC-SR04 and other modules that hear up to 4 m, on a robot that stands still unless it reports a speed. */
#define EERUF_FLOW(sensors, window_us)                                                                                 \
    {EERUF_VERSION, sensors, window_us, 0, 6000, 33500, 60000, 2000, 1, 80, 150, 150, 8, 4, 0, 0, 0, NULL, NULL}

/* A ring of HC-SR04 modules, with their own times at 20 degrees Celsius, as `eeruf design` has them. */
#define EERUF_FLOW_HC_SR04(sensors)                                                                                    \
    {EERUF_VERSION, sensors, 24310, 117, 6028, 33159, 60000, 2000, 1, 80, 150, 150, 8, 4, 0, 0, 0, NULL, NULL}

/* One sensor of a flow ring, in place of an EerufSensor: 42 bytes on an AVR. Not for the caller. */
typedef struct EerufFlowSensor {
    uint32_t echo_us;
    EerufFilter filter;   /* its echo is that of the last firing */
    uint32_t fired_us[3]; /* the last first */
    uint32_t turn_us, believed_us;
    uint16_t doubt, grown_us, rate;
    uint8_t missed, conf;
} EerufFlowSensor;

/* A flow ring. Not for the caller. */
typedef struct EerufFlowRing {
    EerufRing ring; /* first, so that a pointer to one is a pointer to the other */
    const uint8_t *lines;
    uint32_t random, thrown_us, dice_us, rest_us, told_us, since_us, least_us;
    uint16_t most, first, up, down, near_us, rate, top_rate, greatest[2];
    uint8_t memory, hold, stride, turn, flags;
} EerufFlowRing;

/* Makes a flow ring that begins at `now_us`; `sensors` has an entry for each sensor of the config. Report echoes, late
   firings, measured times and stuck lines with the functions of its `ring`. Polling, enabling, pausing and restarting
   have functions of their own; changing settings of a table returns EERUF_ERR_FLOW. */
EerufStatus eeruf_flow_init(EerufFlowRing *flow, size_t flow_size, EerufFlowSensor *sensors, size_t sensors_size,
                            const EerufFlowConfig *config, uint32_t now_us);
/* Like eeruf_flow_init, for sensors that are all alike, without `config->own`; links less code. */
EerufStatus eeruf_flow_init_alike(EerufFlowRing *flow, size_t flow_size, EerufFlowSensor *sensors, size_t sensors_size,
                                  const EerufFlowConfig *config, uint32_t now_us);
/* A period is a round. After EERUF_EVENT_FIRE trigger first: the next call decides which sensor follows. */
EerufStatus eeruf_flow_poll(EerufFlowRing *flow, uint32_t now_us, EerufEvent *event);
/* Reports how fast the robot moves and turns, both unsigned, once a control cycle: readings may change by as much.
   After half a second without a call the top speed is assumed. */
EerufStatus eeruf_flow_moving(EerufFlowRing *flow, uint32_t speed_mm_s, uint32_t turn_mrad_s, uint32_t now_us);
/* Work like the functions of a ring. */
EerufStatus eeruf_flow_enable(EerufFlowRing *flow, uint8_t sensor, bool enabled);
EerufStatus eeruf_flow_pause(EerufFlowRing *flow, bool paused);
EerufStatus eeruf_flow_restart(EerufFlowRing *flow, uint32_t now_us);
/* The quiet that a sensor gets before and after its firing; 0 for one out of range. */
uint32_t eeruf_flow_quiet_us(const EerufFlowRing *flow, uint8_t sensor);
/* The believed echo time of a sensor; EERUF_NO_ECHO without a belief, or if nothing is in range. */
uint32_t eeruf_flow_believed_us(const EerufFlowRing *flow, uint8_t sensor);

#ifdef __cplusplus
}
#endif

#endif

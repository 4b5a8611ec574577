// Times the edges of echo lines by interrupts: exact to some 20 us however long loop() takes. EerufArduino.h includes
// it, and begin() starts it, for one ring on a board.
//
// On an Uno, a Nano and a Mega it uses the pin-change interrupts. On a Mega, pins 2, 3 and 18 to 21 use the external
// ones; the other pins with interrupts are 10 to 15, 50 to 53 and A8 to A15. Elsewhere it uses attachInterrupt(): on a
// SAMD, two pins cannot share one of the 16 lines (EXTINT); on an Uno R4, only some pins have interrupts. If a line has
// none, read() samples all lines.
//
// SoftwareSerial uses pin-change interrupts too: then define EERUF_POLLED before the first include, as in all files of
// a sketch but one. If it is included before this, an error says so; if after, the linker finds __vector_3 twice.
//
// While noInterrupts() holds, edges wait. On these boards two interrupts of timer 0, that of micros() and compare B
// half-way, reveal each block of more than 0.55 ms: its edges have no time. Blocks of more than 1 ms can cost micros()
// time; timers 1 and 2 make up for it if one is left as the core sets it: tone() takes timer 2, Servo timer 1. On other
// boards, edges that come together reveal a block. quietFor() says when to call noInterrupts().
#pragma once

#include <Arduino.h>

#include "eeruf.h"

namespace EerufLines {
// Starts queueing edges of these lines; true if interrupts time them.
bool begin(const uint8_t *pins, uint8_t count, EerufEdges &edges);
// Samples all lines, and queues their edges since the last sample.
void look();
void onInterrupt();
// The clock of rings: micros() plus the time that it has lost.
uint32_t now();
extern bool hasInterrupts;
} // namespace EerufLines

// False if read() never has to sample, so that the code for it is not linked.
#if !defined(EERUF_POLLED) && (defined(__AVR_ATmega328P__) || defined(__AVR_ATmega168__))
#define EERUF_LOOKS false
#else
#define EERUF_LOOKS true
#endif

#ifndef EERUF_POLLED
#ifdef SoftwareSerial_h
#error "SoftwareSerial takes the interrupts of pin changes, too: define EERUF_POLLED before the first include of Eeruf"
#endif
#if defined(PCINT0_vect) && defined(PCINT1_vect) && defined(PCINT2_vect)
ISR(PCINT0_vect) {
    EerufLines::onInterrupt();
}
ISR(PCINT1_vect, ISR_ALIASOF(PCINT0_vect));
ISR(PCINT2_vect, ISR_ALIASOF(PCINT0_vect));
#endif
namespace EerufLines {
static const bool __attribute__((unused)) is_interrupted = hasInterrupts = true;
}
#endif

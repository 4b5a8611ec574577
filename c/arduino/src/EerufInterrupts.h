// Times of edges of the echo lines, by interrupts that their changes raise: exact to some 20 us however long loop() takes.
// EerufArduino.h includes it, and begin() starts it, of one ring on a board.
//
// On an Uno, a Nano and a Mega it takes the pin-change interrupts, and the external ones for pins 2, 3 and 18 to 21 of a
// Mega, whose other pins with an interrupt are 10 to 15, 50 to 53 and A8 to A15. Elsewhere it takes those of
// attachInterrupt(): on a SAMD only one of two pins that share one of its 16 lines (EXTINT); on an Uno R4 only some pins.
// If a line has none, read() samples all lines.
//
// SoftwareSerial takes the interrupts of pin changes too: then define EERUF_POLLED before the first include. So do all
// files of a sketch but one. Included before this, it is an error that says so; after it, the linker finds __vector_3 twice.
//
// While noInterrupts() holds, an edge waits. On these boards two interrupts of timer 0, that of micros() and compare B
// half-way, tell of each block of more than 0.55 ms: its edges count as ones without a time. Blocks of more than 1 ms can
// cost micros() time, for which timers 1 and 2 make up, as long as one of them is left as the core sets it: tone() takes
// timer 2, Servo timer 1. Elsewhere edges that come together tell. quietFor() says when to call noInterrupts().
#pragma once

#include <Arduino.h>

#include "eeruf.h"

namespace EerufLines {
// Begins with lines and a queue; whether interrupts time their edges.
bool begin(const uint8_t *pins, uint8_t count, EerufEdges &edges);
// Looks at all lines, and queues their edges since the look before.
void look();
void onInterrupt();
// The clock of rings: micros(), and the time that it has lost.
uint32_t now();
extern bool hasInterrupts;
} // namespace EerufLines

// Whether read() may have to look, so that what it never does is not linked.
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

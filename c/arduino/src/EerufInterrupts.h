// Echo lines by interrupt: echo times are exact to some 20 us however long loop() takes. For an Uno, a Nano or a Mega.
//
//   #include <EerufTables.h>
//   #include <EerufInterrupts.h>        // in one file of the sketch
//
//   void setup() { sonar.begin(); eerufInterrupts(sonar); }
//
// Without it read() looks at the lines, and an edge that comes while it judges a reading, or loop() prints one, is seen
// up to a millisecond late: from eight modules on that rejects good readings, of some modules all. It takes the
// interrupts of pin changes, which SoftwareSerial takes too, and on a Mega for pins 2, 3 and 18 to 21 their external
// ones; the Mega's other pins that can be watched are 10 to 15, 50 to 53 and A8 to A15.
#pragma once
#include <EerufArduino.h>

namespace EerufInterrupts {
// Eight lines at most have one interrupt: a group. Their levels, and which of the pins are outputs.
#if defined(__AVR_ATmega328P__) || defined(__AVR_ATmega168__)
const uint8_t GROUPS = 3;
static inline uint8_t levels(uint8_t group) {
    return group == 0 ? PINB : group == 1 ? PINC : PIND;
}
static inline uint8_t outputs(uint8_t group) {
    return group == 0 ? DDRB : group == 1 ? DDRC : DDRD;
}
#elif defined(__AVR_ATmega2560__)
const uint8_t GROUPS = 4, BY_PIN = 3;
static inline uint8_t levels(uint8_t group) {
    if (group == BY_PIN) return (PIND & 0x0f) | (PINE & 0x30);
    return group == 0 ? PINB : group == 1 ? PINJ << 1 | (PINE & 0x01) : PINK;
}
static inline uint8_t outputs(uint8_t group) {
    if (group == BY_PIN) return (DDRD & 0x0f) | (DDRE & 0x30);
    return group == 0 ? DDRB : group == 1 ? DDRJ << 1 | (DDRE & 0x01) : DDRK;
}
#else
#error "EerufInterrupts.h is for an Uno, a Nano or a Mega; elsewhere use attachInterrupt and a queue as the example Two"
#endif

const uint8_t NOBODY = 255;
static EerufEdge places[32];
static EerufEdges edges;
static uint8_t sensorOf[GROUPS][8], known[GROUPS];

static inline __attribute__((always_inline)) void look(uint8_t group) {
    const uint32_t at = micros();
    // A pin that is an output is high by our own trigger.
    uint8_t changed = (uint8_t)((levels(group) ^ known[group]) & ~outputs(group)), high = (known[group] ^= changed);
    for (const uint8_t *sensor = sensorOf[group]; changed != 0; sensor++, changed >>= 1, high >>= 1)
        if (changed & 1 && *sensor != NOBODY) (void)eeruf_edges_push(&edges, *sensor, high & 1, at);
}

#ifdef __AVR_ATmega2560__
static void lookAtExternal() {
    look(BY_PIN);
}
#endif

// The group of a pin and its place there; false for a pin that no interrupt watches.
static bool find(uint8_t pin, uint8_t *group, uint8_t *place) {
#ifdef __AVR_ATmega2560__
    // The core's own table leaves out 14 and 15.
    static const uint8_t FIRST[] PROGMEM = {255,  255,  0x34, 0x35, 255,  255,  255,  255,  255,  255,  0x04,
                                            0x05, 0x06, 0x07, 0x12, 0x11, 255,  255,  0x33, 0x32, 0x31, 0x30};
    uint8_t at = 255;
    if (pin < sizeof FIRST) at = pgm_read_byte(FIRST + pin);
    else if (pin >= 50 && pin <= 53) at = 53 - pin;
    else if (pin >= A8 && pin <= A15) at = 0x20 + pin - A8;
    *group = at >> 4;
    *place = at & 7;
    return at != 255;
#else
    *group = digitalPinToPCICRbit(pin);
    *place = digitalPinToPCMSKbit(pin);
    return pin <= A5;
#endif
}
} // namespace EerufInterrupts

ISR(PCINT0_vect) {
    EerufInterrupts::look(0);
}
ISR(PCINT1_vect) {
    EerufInterrupts::look(1);
}
ISR(PCINT2_vect) {
    EerufInterrupts::look(2);
}

// Times the echo lines of a ring by interrupt from now on. False, and nothing is changed, if a line is on a pin that no
// interrupt watches. `Modules` are an EerufSonar, or what has count(), echoPin() and use() as it does.
template <class Modules> static inline bool eerufInterrupts(Modules &modules) {
    using namespace EerufInterrupts;
    uint8_t group, place;
    for (uint8_t i = 0; i < modules.count(); i++)
        if (!find(modules.echoPin(i), &group, &place)) return false;
    (void)eeruf_edges_init(&edges, sizeof edges, places, sizeof places);
    memset(sensorOf, NOBODY, sizeof sensorOf);
    for (group = 0; group < GROUPS; group++) known[group] = levels(group);
    for (uint8_t i = 0; i < modules.count(); i++) {
        const uint8_t pin = modules.echoPin(i);
        (void)find(pin, &group, &place);
        sensorOf[group][place] = i;
#ifdef __AVR_ATmega2560__
        if (group == BY_PIN) {
            attachInterrupt(digitalPinToInterrupt(pin), lookAtExternal, CHANGE);
            continue;
        }
#endif
        (&PCMSK0)[group] |= bit(place);
        PCICR |= bit(group);
    }
    modules.use(edges);
    return true;
}

// See EerufArduino.h. The sketch has the interrupts.
#ifndef EERUF_POLLED
#define EERUF_POLLED
#endif
#include "EerufArduino.h"

// Lines are sampled continuously for this long at a time, and longer if an edge is expected before loop() returns.
static const uint32_t LOOKS_US = 300, LONGEST_US = 4000;
// Lines rise within this time after their trigger.
static const uint32_t RISES_US = 1000;
// Time from a poll to its trigger in a flow ring. On an Uno a poll that fires takes up to 0.22 ms, in groups 0.35.
#ifdef __AVR__
static const uint16_t FIRES_US = 8000 / (F_CPU / 1000000);
#else
static const uint16_t FIRES_US = 0;
#endif
// An edge known only to within TOO_LONG_US has no time, which LATE_US marks.
static const uint32_t TOO_LONG_US = 500, LATE_US = 40000;

// AVRs whose core has these tables; that of the megaAVRs does not.
#if defined(__AVR__) && !defined(ARDUINO_ARCH_MEGAAVR)
// Takes a quarter of the time of digitalRead, and less flash than the core's functions together.
bool EerufPin::isHigh(uint8_t pin) {
    return *portInputRegister(digitalPinToPort(pin)) & digitalPinToBitMask(pin);
}

static __attribute__((noinline)) void setBit(const uint16_t *registers, uint8_t pin, bool on) {
    volatile uint8_t *place = (volatile uint8_t *)pgm_read_word(registers + digitalPinToPort(pin));
    const uint8_t mask = digitalPinToBitMask(pin), before = SREG;
    cli(); // an interrupt may change other pins of the port
    uint8_t bits = *place | mask;
    if (!on) bits ^= mask;
    *place = bits;
    SREG = before;
}

static inline void drive(uint8_t pin, bool high) {
    setBit(port_to_output_PGM, pin, high);
}

static inline void setOutput(uint8_t pin, bool output) {
    setBit(port_to_mode_PGM, pin, output);
}
#else
bool EERUF_IN_RAM EerufPin::isHigh(uint8_t pin) {
    return digitalRead(pin) != LOW;
}

static void drive(uint8_t pin, bool high) {
    digitalWrite(pin, high ? HIGH : LOW);
}

static void setOutput(uint8_t pin, bool output) {
    pinMode(pin, output ? OUTPUT : INPUT);
}
#endif

void EerufPin::release(uint8_t trigger, uint8_t echo) {
    drive(trigger, false);
    setOutput(trigger, trigger != echo);
}

void EerufPin::trigger(uint8_t trigger, uint8_t echo, uint8_t us) {
    // The order matters: an input that is driven high has its pull-up on, which reads as an edge of the echo line.
    setOutput(trigger, true);
    drive(trigger, true);
    delayMicroseconds(us);
    release(trigger, echo);
}

namespace EerufLines {
bool hasInterrupts;
static uint8_t alone; // lines that are read one by one

// Eight lines form a group: those of a port if its pins interrupt when they change. Other lines form groups too, whose
// pins are read one by one. `levels` reads a group, `outputs` tells which of its pins are outputs.
#if defined(__AVR_ATmega328P__) || defined(__AVR_ATmega168__)
static const uint8_t PORTS = 3, BY_CHANGE = 3, GROUPS = PORTS; // `BY_CHANGE`: ports that have an interrupt
static inline uint8_t levels(uint8_t group) {
    return group == 0 ? PINB : group == 1 ? PINC : PIND;
}
static inline uint8_t outputs(uint8_t group) {
    return group == 0 ? DDRB : group == 1 ? DDRC : DDRD;
}
#else
#ifdef __AVR_ATmega2560__
static const uint8_t PORTS = 4, BY_CHANGE = 3, BY_PIN = 3, GROUPS = PORTS + 3;
static inline uint8_t port(uint8_t group) {
    if (group == BY_PIN) return (PIND & 0x0f) | (PINE & 0x30);
    return group == 0 ? PINB : group == 1 ? PINJ << 1 | (PINE & 0x01) : PINK;
}
static inline uint8_t outputs(uint8_t group) {
    if (group >= PORTS) return 0;
    if (group == BY_PIN) return (DDRD & 0x0f) | (DDRE & 0x30);
    return group == 0 ? DDRB : group == 1 ? DDRJ << 1 | (DDRE & 0x01) : DDRK;
}
#else
static const uint8_t PORTS = 0, BY_CHANGE = 0, GROUPS = 8;
static inline uint8_t EERUF_IN_RAM port(uint8_t) {
    return 0;
}
static inline uint8_t EERUF_IN_RAM outputs(uint8_t) {
    return 0; // lines are not sampled during a trigger
}
#endif
static uint8_t pinOf[8 * (GROUPS - PORTS)];
static uint8_t EERUF_IN_RAM levels(uint8_t group) {
    if (group + 1 <= PORTS) return port(group);
    uint8_t bits = 0;
    for (uint8_t place = 8 * (group - PORTS); place < alone && place < 8 * (group - PORTS + 1); place++)
        bits |= EerufPin::isHigh(pinOf[place]) << (place & 7);
    return bits;
}
#endif

static EerufEdges *edges;
// The levels of lines, the pins that are echo lines, and pulses whose start has no time.
static uint8_t sensorOf[GROUPS][8], known[GROUPS], ours[GROUPS], timeless[GROUPS];
static uint32_t looked;

#if defined(TIMER0_COMPB_vect) && (F_CPU == 16000000 || F_CPU == 8000000)
#define EERUF_HALVES
// The timer of micros() counts on while interrupts wait, but if it overflows twice one overflow is lost. Timers 1 and 2
// reveal that unless both are taken: the core leaves them counting at that speed, up to 255 and down again.
static uint16_t lead; // of their place ahead of that of micros(), in a round of 510
static uint32_t lost; // by micros()

static bool count(uint8_t *at) {
#ifdef TCCR2A
    if ((TCCR2A & 0x03) == _BV(WGM20) && (TCCR2B & 0x0f) == _BV(CS22)) {
        *at = TCNT2;
        return true;
    }
#endif
    *at = TCNT1L;
    return (TCCR1A & 0x03) == _BV(WGM10) && (TCCR1B & 0x1f) == (_BV(CS11) | _BV(CS10));
}

// Makes up for overflows that micros() had lost by an instant, from the counter just after it. Returns true if it
// cannot, because the counter was set to something else.
static bool hasLostTime(uint32_t us, uint8_t at) {
    const uint8_t TICKS_AT = F_CPU == 16000000 ? 2 : 3; // of micros()
    // In ticks, modulo 510: 512 counts as 2, so that each byte but the first counts alike.
    const uint16_t sum = (uint8_t)(us >> 8) + (uint16_t)(uint8_t)(us >> 16) + (uint8_t)(us >> 24);
    const uint16_t ticks = (sum << (8 - TICKS_AT)) + ((uint8_t)us >> TICKS_AT);
    uint16_t place = lead + (ticks & 511) + (ticks >> 9) * 2;
    for (uint8_t more = 0; more < 4; more++, place += 256) {
        while (place >= 510) place -= 510;
        const uint8_t expected = place > 255 ? 510 - place : place;
        if ((uint8_t)(expected - at + 1) > 2) continue;
        lead += more << 8;
        while (lead >= 510) lead -= 510;
        lost += (uint32_t)more << (8 + TICKS_AT);
        return false;
    }
    uint8_t next = at;
    for (uint8_t i = 255; next == at; i--)
        if (i == 0 || !count(&next)) return false; // it stands
    // Four overflows are 4 ticks more than none.
    lead += (next > at ? at : 510 - at) + 4 + 1020 - place;
    while (lead >= 510) lead -= 510;
    return true;
}

// The clock of rings, with interrupts off. Timer 0 raises two interrupts in each pass: if one is pending here,
// interrupts have waited for longer than other interrupts take.
static uint32_t read(bool *haveWaited, bool *hasLost) {
    uint8_t at;
    const uint8_t flags = TIFR0, ticks = TCNT0, since = ticks - OCR0B;
    const uint32_t us = micros();
    *hasLost = count(&at) && hasLostTime(us, at);
    *haveWaited = ((flags & _BV(TOV0)) && ticks > 12) || ((flags & _BV(OCF0B)) && since > 12);
    return us + lost;
}
static const bool IS_KNOWN = true;
#else
static inline uint32_t EERUF_IN_RAM read(bool *, bool *) {
    return micros();
}
static const bool IS_KNOWN = false; // only edges that come together reveal it
#endif

// Queues the edges that came since an instant, or just now, with interrupts off. An edge has no time if its interrupt
// was late; nor has the end of a pulse whose start has none, or during which time was lost.
static void EERUF_IN_RAM take(uint32_t since, bool isInterrupt) {
    bool waited = false, hasLost = false;
    const uint32_t at = read(&waited, &hasLost);
    const bool isLate = isInterrupt ? waited : hasLost || at - since > TOO_LONG_US;
    if (isInterrupt) since = at;
    // Lines with interrupts wait meanwhile, so empty groups are left out.
    for (uint8_t group = 0; group < (alone ? GROUPS : PORTS); group++) {
        // A pin that is an output is high because of our own trigger.
        uint8_t changed = (uint8_t)((levels(group) ^ known[group]) & ours[group] & ~outputs(group));
        uint8_t late = timeless[group];
        if (hasLost) late |= known[group];
        const bool areSeveral = (changed & (uint8_t)(changed - 1)) != 0;
        if (isLate || (!IS_KNOWN && isInterrupt && areSeveral)) late |= changed;
        uint8_t high = known[group] ^= changed;
        timeless[group] = (uint8_t)(late & high);
        for (const uint8_t *sensor = sensorOf[group]; changed != 0; sensor++, changed >>= 1, high >>= 1, late >>= 1)
            if (changed & 1)
                (void)eeruf_edges_push_between(edges, *sensor, high & 1, late & 1 ? at - LATE_US : since, at);
    }
}

void look() {
    const uint32_t since = looked;
    looked = now();
    noInterrupts();
    take(since, false);
    interrupts();
}

uint32_t now() {
#ifdef EERUF_HALVES
    const uint8_t before = SREG;
    cli();
    const uint32_t at = micros() + lost;
    SREG = before;
    return at;
#else
    return micros();
#endif
}

// Marks pulses in which time was lost as having none.
static void makeUp() {
#ifdef EERUF_HALVES
    bool waited, hasLost;
    const uint8_t before = SREG;
    cli();
    (void)read(&waited, &hasLost);
    for (uint8_t group = 0; group < GROUPS && hasLost; group++) timeless[group] |= known[group];
    SREG = before;
#endif
}

void EERUF_IN_RAM onInterrupt() {
    take(0, true);
}

#if !defined(__AVR_ATmega328P__) && !defined(__AVR_ATmega168__)
// True if attachInterrupt() works for a pin.
static bool canInterrupt(uint8_t pin) {
#ifdef ARDUINO_ARCH_SAMD
    // The chip has 16 lines for all pins: if two pins share one, only the last would interrupt.
    static uint16_t taken;
    const int line = g_APinDescription[pin].ulExtInt;
    if (line < 0 || line > 15 || (taken >> line & 1)) return false;
    taken |= bit(line);
    return true;
#elif defined(ARDUINO_ARCH_RENESAS)
    return getPinCfgs(pin, PIN_CFG_REQ_INTERRUPT)[0] != 0;
#else
    return digitalPinToInterrupt(pin) != NOT_AN_INTERRUPT;
#endif
}
#endif

// Finds a group and a place for a line; true if its changes interrupt.
static bool find(uint8_t pin, uint8_t *group, uint8_t *place) {
#if defined(__AVR_ATmega328P__) || defined(__AVR_ATmega168__)
    *group = digitalPinToPCICRbit(pin);
    *place = digitalPinToPCMSKbit(pin);
    return true;
#else
#ifdef __AVR_ATmega2560__
    // The core's own table leaves out 14 and 15.
    static const uint8_t FIRST[] PROGMEM = {255,  255,  0x34, 0x35, 255,  255,  255,  255,  255,  255,  0x04,
                                            0x05, 0x06, 0x07, 0x12, 0x11, 255,  255,  0x33, 0x32, 0x31, 0x30};
    uint8_t at = 255;
    if (pin < sizeof FIRST) at = pgm_read_byte(FIRST + pin);
    else if (pin >= 50 && pin <= 53) at = 53 - pin;
    else if (pin >= A8 && pin <= A15) at = 0x20 + pin - A8;
    if (at != 255) {
        *group = at >> 4;
        *place = at & 7;
        return true;
    }
#endif
    *group = PORTS + (alone >> 3);
    *place = alone & 7;
    pinOf[alone++] = pin;
    return canInterrupt(pin);
#endif
}

static void attach(uint8_t pin, uint8_t group, uint8_t place) {
#ifdef PCICR
    if (group + 1 <= BY_CHANGE || BY_CHANGE == GROUPS) {
        (&PCMSK0)[group] |= bit(place);
        PCICR |= bit(group);
        return;
    }
#endif
    attachInterrupt(digitalPinToInterrupt(pin), onInterrupt, CHANGE);
    (void)group, (void)place;
}

bool begin(const uint8_t *pins, uint8_t count, EerufEdges &queue) {
    bool isTimed = hasInterrupts;
    uint8_t group, place;
    edges = &queue;
#ifdef EERUF_HALVES
    OCR0B = 128;
    TIFR0 = _BV(OCF0B);
    TIMSK0 |= _BV(OCIE0B);
#endif
    memset(ours, 0, sizeof ours);
    alone = 0;
    for (uint8_t i = 0; i < count; i++) {
        const bool can = find(pins[i], &group, &place);
        sensorOf[group][place] = i;
        ours[group] |= bit(place);
        if (can && hasInterrupts) attach(pins[i], group, place);
        isTimed &= can;
    }
    for (group = 0; group < GROUPS; group++) known[group] = levels(group);
    return isTimed;
}
} // namespace EerufLines

#ifdef EERUF_HALVES
EMPTY_INTERRUPT(TIMER0_COMPB_vect)
#endif

bool EerufModules::begin(EerufStatus status, EerufRing &ring, EerufLine *lines, EerufEdge *places, uint8_t count,
                         const EerufHcSr04Settings &settings) {
    for (uint8_t i = 0; i < count_; i++) {
        setOutput(echoes_[i], false);
        EerufPin::release(triggers_[i], echoes_[i]);
    }
    if (status == EERUF_OK)
        status = eeruf_hc_sr04_init(&modules_, sizeof modules_, lines, count_ * sizeof *lines, &ring, &settings);
    if (status == EERUF_OK && edges_ == nullptr) {
        status = eeruf_edges_init(&queue_, sizeof queue_, places, count * sizeof *places);
        looks_ = !EerufLines::begin(echoes_, count_, queue_);
        edges_ = &queue_;
    }
    status_ = status;
    return status == EERUF_OK;
}

// True if a module's reading is pending.
static bool awaits(const EerufHcSr04 &modules, uint8_t sensor) {
    return eeruf_hc_sr04_awaits(&modules, sensor, nullptr) &&
           EerufLines::now() - eeruf_ring_fired_at(modules.ring, sensor) <= modules.ring->window_us;
}

// True if an edge is expected before loop() returns: that of the believed echo.
bool EerufModules::expects(uint32_t now) const {
    for (uint8_t i = 0; i < count_ && modules_.ring->consecutive == 0; i++) {
        if (!awaits(modules_, i)) continue;
        const uint32_t echo = eeruf_flow_believed_us((const EerufFlowRing *)modules_.ring, i);
        const uint32_t at = eeruf_ring_fired_at(modules_.ring, i) + RISES_US + echo;
        if (echo != EERUF_NO_ECHO && at - now < away_ + RISES_US) return true;
    }
    return false;
}

uint32_t EerufModules::collect(uint16_t soon, bool looks) {
    uint32_t now;
    // Only once: firings due within some 150 us of each other leave no time for it.
    EerufLines::makeUp();
    // The ring decides here, which takes less stack than below an edge.
    (void)eeruf_ring_due(modules_.ring);
    if (looks && looks_) {
        const uint32_t began = EerufLines::now(), away = began - seen_;
        away_ -= away_ / 16;
        if (away > away_) away_ = away > LONGEST_US ? LONGEST_US : away;
        do EerufLines::look();
        while (queue_.pushed == queue_.popped && (int32_t)((now = EerufLines::now()) - eeruf_ring_due(modules_.ring)) < 0 &&
               (now - began < LOOKS_US || expects(now)));
    }
    // The clock is read before the edges, so that no window closes on one that came in time.
    do {
        now = EerufLines::now();
        if (looks && looks_) EerufLines::look();
        (void)eeruf_hc_sr04_edges(&modules_, edges_);
    } while (eeruf_ring_due(modules_.ring) - now - 1 < soon);
    if (looks) seen_ = EerufLines::now();
    return now;
}

void EerufModules::watchEvent(EerufModules &self, const EerufEvent &event, uint32_t now) {
    (void)eeruf_watch_event(self.watch_, &event, now);
}

EerufState EerufModules::state(uint8_t sensor) const {
    EerufState state = {EERUF_NO_ECHO, 0, EERUF_STATE_UNKNOWN, EERUF_WHY_NO_FIRING, EERUF_BY_NOTHING};
    (void)eeruf_watch_state(watch_, sensor, EerufLines::now(), &state);
    return state;
}

void EerufModules::pullLow(EerufModules &self, uint8_t sensor) {
    const uint8_t echo = self.echoes_[sensor];
    if (!eeruf_hc_sr04_is_stuck(&self.modules_, sensor)) return;
    drive(echo, false);
    setOutput(echo, true);
    delayMicroseconds(self.recovery_);
    setOutput(echo, false);
}

// Triggers a module unless its line is high.
void EerufModules::fire(uint8_t sensor, bool looks) {
    bool isHigh;
    if (eeruf_hc_sr04_fire(&modules_, sensor, EerufPin::isHigh(echoes_[sensor])) != EERUF_OK) {
        if (onStuck_ != nullptr) onStuck_(*this, sensor);
        return;
    }
    EerufPin::trigger(triggers_[sensor], echoes_[sensor], modules_.settings->trigger_us);
    // The line rises soon: wait for it before loop() does other things.
    const uint32_t fired = ::micros();
    while (looks && looks_ && eeruf_hc_sr04_awaits(&modules_, sensor, &isHigh) && !isHigh && ::micros() - fired < RISES_US) {
        EerufLines::look();
        (void)eeruf_hc_sr04_edges(&modules_, edges_);
    }
}

void EerufModules::holdBack(uint32_t now, bool looks) {
    while (EerufLines::now() - now < FIRES_US)
        if (looks && looks_) EerufLines::look();
}

bool EerufModules::take(const EerufEvent &event, uint32_t now, bool looks) {
    if (event.kind == EERUF_EVENT_FIRE) {
        fire(event.sensor, looks);
    } else if (event.kind == EERUF_EVENT_READING) {
        sensor_ = event.sensor;
        reading_ = event.u.reading;
        eeruf_pace_event(&pace_, &event);
    }
    if (onReading_ != nullptr) onReading_(*this, event, now);
    // A sensor that is to fire has fired by now.
    if (onEvent_ != nullptr) onEvent_(*this, event, now);
    return event.kind == EERUF_EVENT_READING;
}

uint32_t EerufModules::quietFor() const {
    for (uint8_t i = 0; i < count_; i++)
        if (awaits(modules_, i)) return 0;
    const uint32_t quiet = eeruf_ring_due(modules_.ring) - EerufLines::now();
    return quiet < 0x80000000 ? quiet : 0;
}

uint16_t EerufModules::millimetres(uint32_t soundMmPerS) const {
    if (reading_.t_echo_us == EERUF_NO_ECHO) return 0;
    // c t / 2 in 32 bits, enough for these modules, whose echoes take at most 36 ms. eeruf_distance_mm takes any.
    return (reading_.t_echo_us * (soundMmPerS / 8) + 125000) / 250000;
}

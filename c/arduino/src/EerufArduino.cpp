// See EerufArduino.h.
#include "EerufArduino.h"

// How long before a firing no reading is judged any more: that takes longer the more modules could explain it.
static const uint32_t SOON_US = 200, SOON_PER_MODULE_US = 40;

#if defined(__AVR__) && defined(portModeRegister)
// A quarter of the time of digitalRead, and less flash than the core's functions together.
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
bool EerufPin::isHigh(uint8_t pin) {
    return digitalRead(pin);
}

static void drive(uint8_t pin, bool high) {
    digitalWrite(pin, high);
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
    // In this order: an input that is driven high has its pull-up on, and reads as an edge of the echo line.
    setOutput(trigger, true);
    drive(trigger, true);
    delayMicroseconds(us);
    release(trigger, echo);
}

const EerufHcSr04Settings &EerufModules::hcSr04() {
    static const EerufHcSr04Settings settings = EERUF_HC_SR04;
    return settings;
}

bool EerufModules::begin(const EerufHcSr04Settings &settings) {
    const EerufConfig config = EERUF_CONFIG;
    const uint8_t *echo = echoes_, *trigger = triggers_;
    for (uint8_t left = count_; left > 0; left--, echo++, trigger++) {
        setOutput(*echo, false);
        EerufPin::release(*trigger, *echo);
    }
    const size_t sensors = count_ * sizeof *sensors_, lines = count_ * sizeof *lines_;
    status_ = eeruf_ring_init(&ring_, sizeof ring_, sensors_, sensors, schedule_, &config, ::micros());
    if (status_ == EERUF_OK)
        status_ = eeruf_hc_sr04_init(&modules_, sizeof modules_, lines_, lines, &ring_, &settings);
    return status_ == EERUF_OK;
}

// Edges of the lines that a pulse is awaited on, until something is due: to fire on time matters more.
void EerufModules::sample(EerufModules &self) {
    const uint32_t due = eeruf_ring_due(&self.ring_);
    const uint8_t *echo = self.echoes_;
    bool was_high;
    for (uint8_t sensor = 0; sensor < self.count_ && (int32_t)(::micros() - due) < 0; sensor++, echo++) {
        if (!eeruf_hc_sr04_awaits(&self.modules_, sensor, &was_high)) continue;
        const bool high = EerufPin::isHigh(*echo);
        if (high != was_high) (void)eeruf_hc_sr04_edge(&self.modules_, sensor, high, ::micros());
    }
}

void EerufModules::drain(EerufModules &self) {
    (void)eeruf_hc_sr04_edges(&self.modules_, self.edges_);
}

void EerufModules::climb(EerufModules &self, const EerufEvent &event) {
    (void)eeruf_adaptation_period(self.adaptation_, &self.ring_, &event);
}

void EerufModules::watchEvent(EerufModules &self, const EerufEvent &event, uint32_t now) {
    (void)eeruf_watch_event(self.watch_, &event, now);
}

EerufState EerufModules::state(uint8_t sensor) const {
    EerufState state = {EERUF_NO_ECHO, 0, EERUF_STATE_UNKNOWN, EERUF_WHY_NO_FIRING, EERUF_BY_NOTHING};
    (void)eeruf_watch_state(watch_, sensor, ::micros(), &state);
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

// Unless the line is high.
void EerufModules::fire(uint8_t sensor) {
    if (eeruf_hc_sr04_fire(&modules_, sensor, EerufPin::isHigh(echoes_[sensor])) != EERUF_OK) {
        if (onStuck_ != nullptr) onStuck_(*this, sensor);
        return;
    }
    EerufPin::trigger(triggers_[sensor], echoes_[sensor], modules_.settings->trigger_us);
}

bool EerufModules::read() {
    EerufEvent event;
    if (status_ != EERUF_OK) return false;
    // A firing that is due soon is waited for, while lines are sampled: where modules fire late, by differing times, more
    // is ambiguous. The clock is read before: then no window closes on an edge that came in time.
    const uint32_t soon = SOON_US + SOON_PER_MODULE_US * count_;
    uint32_t now;
    do {
        now = ::micros();
        collect_(*this);
    } while (eeruf_ring_due(&ring_) - now - 1 < soon);
    if (eeruf_ring_poll(&ring_, now, &event) != EERUF_EVENT) return false;
    if (event.kind == EERUF_EVENT_FIRE) {
        fire(event.sensor);
    } else if (event.kind == EERUF_EVENT_PERIOD) {
        if (onPeriod_ != nullptr) onPeriod_(*this, event);
    } else {
        sensor_ = event.sensor;
        reading_ = event.u.reading;
    }
    if (onReading_ != nullptr) onReading_(*this, event, now);
    // A sensor that is to fire has fired by now.
    if (onEvent_ != nullptr) onEvent_(*this, event, now);
    return event.kind == EERUF_EVENT_READING;
}

bool EerufModules::tooSlow() {
    if (ring_.latest_us <= 1000 || ::micros() - told_ < 1000000) return false;
    told_ = ::micros();
    return true;
}

uint16_t EerufModules::millimetres(uint32_t soundMmPerS) const {
    if (reading_.t_echo_us == EERUF_NO_ECHO) return 0;
    // c t / 2 in 32 bits, which holds for these modules: no echo is longer than 36 ms. eeruf_distance_mm takes any.
    return (reading_.t_echo_us * (soundMmPerS / 8) + 125000) / 250000;
}

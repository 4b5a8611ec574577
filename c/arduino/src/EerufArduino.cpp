// See EerufArduino.h.
#include "EerufArduino.h"

bool EerufModules::begin() {
    const EerufConfig config = EERUF_CONFIG;
    const EerufHcSr04Settings settings = EERUF_HC_SR04;
    for (uint8_t sensor = 0; sensor < count_; sensor++) {
        pinMode(echoes_[sensor], INPUT);
        if (triggers_ == echoes_) continue;
        digitalWrite(triggers_[sensor], LOW);
        pinMode(triggers_[sensor], OUTPUT);
    }
    status_ = eeruf_ring_init(&ring_, sizeof ring_, sensors_, count_ * sizeof *sensors_, schedule_, &config, ::micros());
    if (status_ == EERUF_OK)
        status_ = eeruf_hc_sr04_init(&modules_, sizeof modules_, lines_, count_ * sizeof *lines_, &ring_, &settings);
    return status_ == EERUF_OK;
}

// Edges of the lines that a pulse is awaited on.
void EerufModules::sample() {
    bool was_high;
    for (uint8_t sensor = 0; sensor < count_; sensor++) {
        if (!eeruf_hc_sr04_awaits(&modules_, sensor, &was_high)) continue;
        const bool high = digitalRead(echoes_[sensor]);
        if (high != was_high) edge(sensor, high, ::micros());
    }
}

// A pulse of 10 us on the trigger, unless the line is high.
void EerufModules::fire(uint8_t sensor, uint32_t now) {
    const uint8_t pin = triggers_[sensor];
    if (eeruf_hc_sr04_fire(&modules_, sensor, now, digitalRead(echoes_[sensor])) != EERUF_OK) return;
    digitalWrite(pin, HIGH);
    pinMode(pin, OUTPUT);
    delayMicroseconds(10);
    digitalWrite(pin, LOW);
    if (triggers_ == echoes_) pinMode(pin, INPUT);
}

bool EerufModules::read() {
    EerufEvent event;
    if (status_ != EERUF_OK) return false;
    sample();
    const uint32_t now = ::micros();
    if (eeruf_ring_poll(&ring_, now, &event) != EERUF_EVENT) return false;
    if (event.kind == EERUF_EVENT_FIRE) {
        fire(event.sensor, now);
    } else if (event.kind == EERUF_EVENT_PERIOD) {
        if (adaptation_ != nullptr) (void)eeruf_adaptation_period(adaptation_, &ring_, &event);
    } else {
        sensor_ = event.sensor;
        reading_ = event.u.reading;
        return true;
    }
    return false;
}

uint16_t EerufModules::millimetres(uint32_t soundMmPerS) const {
    if (reading_.t_echo_us == EERUF_NO_ECHO) return 0;
    const uint32_t mm = eeruf_distance_mm(reading_.t_echo_us, soundMmPerS);
    return mm > 65535 ? 65535 : mm;
}

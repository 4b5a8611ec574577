// Rings of HC-SR04 modules that fire by flow, without a table: one module after the other, each with as much quiet
// around its firing as it has needed. A module takes 50 bytes of RAM.
//
//   #include <EerufFlow.h>
//   const uint8_t PINS[] = {2, 3, 4, 5};                  // trigger and echo of each module on one pin
//   EerufFlow<4> sonar(PINS);
//
//   void setup() { Serial.begin(115200); if (!sonar.begin()) Serial.println(sonar.status()); }
//   void loop() { if (sonar.read() && sonar.accepted()) Serial.println(sonar.millimetres()); }
#pragma once

#include "EerufArduino.h"

template <uint8_t N> class EerufFlow : public EerufModules {
public:
    // One pin for trigger and echo of each module.
    explicit EerufFlow(const uint8_t (&pins)[N]) : EerufModules(pins, pins, N) {}
    // Two pins for each module.
    EerufFlow(const uint8_t (&triggers)[N], const uint8_t (&echoes)[N]) : EerufModules(triggers, echoes, N) {}

    // Begins firing HC-SR04 modules. False if the settings cannot be used: status() says why. Robots that meet need
    // different seeds, not 0.
    bool begin(uint32_t seed = 1) {
        EerufFlowConfig config = EERUF_FLOW(N, 37000); // their longest echo and a millisecond
        config.seed = seed;
        static const EerufHcSr04Settings settings = EERUF_HC_SR04;
        return begin(config, settings);
    }
    // Begins with RING and RING_MODULES from `eeruf design RING.toml --emit arduino`; the latter must outlive this.
    inline __attribute__((always_inline)) bool begin(const EerufFlowConfig &config, const EerufHcSr04Settings &settings) {
        EerufStatus status = EERUF_ERR_SENSORS;
        const auto init = config.own == nullptr ? eeruf_flow_init_alike : eeruf_flow_init;
        if (config.sensors == N)
            status = init(&ring_, sizeof ring_, sensors_, sizeof sensors_, &config, EerufLines::now());
        return EerufModules::begin(status, ring_.ring, lines_, places_, sizeof places_ / sizeof *places_, settings);
    }

    // Reports how fast the robot moves (mm/s) and turns (mrad/s): call it at least twice a second while it does.
    void moving(uint32_t speed, uint32_t turn = 0) { (void)eeruf_flow_moving(&ring_, speed, turn, EerufLines::now()); }

    // Takes one step; true if a module has a new reading.
    bool read() {
        EerufEvent event;
        if (status_ != EERUF_OK) return false;
        const uint32_t now = collect(0, EERUF_LOOKS);
        if (eeruf_flow_poll(&ring_, now, &event) != EERUF_EVENT) return false;
        if (event.kind == EERUF_EVENT_FIRE) holdBack(now, EERUF_LOOKS);
        return take(event, now, EERUF_LOOKS);
    }

    // Stops a module, or lets it fire again.
    bool enable(uint8_t sensor, bool enabled = true) {
        return eeruf_flow_enable(&ring_, sensor, enabled) == EERUF_OK;
    }
    // Pauses all modules, or resumes them.
    void pause(bool paused = true) { (void)eeruf_flow_pause(&ring_, paused); }
    EerufFlowRing &flow() { return ring_; }

private:
    EerufFlowRing ring_;
    EerufFlowSensor sensors_[N];
    EerufLine lines_[N];
    EerufEdge places_[16]; // no more than four listen at a time
};

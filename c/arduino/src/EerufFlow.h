// Rings of HC-SR04 modules that fire by flow, without a table: one module after the other, each with as much quiet
// around its firing as it has needed. A module takes 48 bytes of RAM.
//
//   #include <EerufFlow.h>
//   #include <EerufInterrupts.h>                          // on an Uno, a Nano or a Mega; elsewhere see use()
//   const uint8_t PINS[] = {2, 3, 4, 5};                  // trigger and echo of each module on one pin
//   EerufFlow<4> sonar(PINS);
//
//   void setup() { Serial.begin(115200); sonar.begin() && eerufInterrupts(sonar); }
//   void loop() { if (sonar.read() && sonar.accepted()) Serial.println(sonar.millimetres()); }
#pragma once

#include "EerufArduino.h"

// All of it stands here, since what is not called and what is computed of constants then takes no flash.
template <uint8_t N> class EerufFlow {
public:
    // One pin for trigger and echo of each module.
    explicit EerufFlow(const uint8_t (&pins)[N]) : triggers_(pins), echoes_(pins) {}
    // Two pins for each.
    EerufFlow(const uint8_t (&triggers)[N], const uint8_t (&echoes)[N]) : triggers_(triggers), echoes_(echoes) {}

    // Begins firing HC-SR04 modules. False if the settings cannot be used: status() says why. Robots that meet need
    // seeds of their own, not 0.
    bool begin(uint32_t seed = 1) {
        EerufFlowConfig config = EERUF_FLOW(N, 37000); // their longest echo and a millisecond
        config.seed = seed;
        static const EerufHcSr04Settings settings = EERUF_HC_SR04;
        return begin(config, settings);
    }
    // By the settings that `eeruf design RING.toml --emit arduino` writes: RING and RING_MODULES. The latter must last.
    bool begin(const EerufFlowConfig &config, const EerufHcSr04Settings &settings) {
        // Echo lines are inputs after a reset.
        for (uint8_t i = 0; i < N; i++) EerufPin::release(triggers_[i], echoes_[i]);
        status_ = EERUF_ERR_SENSORS;
        if (config.sensors == N)
            status_ = eeruf_flow_init(&ring_, sizeof ring_, sensors_, sizeof sensors_, &config, ::micros());
        if (status_ == EERUF_OK)
            status_ = eeruf_hc_sr04_init(&modules_, sizeof modules_, lines_, sizeof lines_, &ring_.ring, &settings);
        return status_ == EERUF_OK;
    }

    // How fast the robot moves, in mm/s, and turns, in mrad/s: at least twice a second while it does.
    void moving(uint32_t speed, uint32_t turn = 0) { (void)eeruf_flow_moving(&ring_, speed, turn, ::micros()); }

    // One step; true if a module has a new reading, which the functions below are about. Call it as often as you can.
    bool read() {
        EerufEvent event;
        if (!step(event) || event.kind != EERUF_EVENT_READING) return false;
        sensor_ = event.sensor;
        reading_ = event.u.reading;
        return true;
    }
    // The same for whoever wants each event: true if there is one.
    bool step(EerufEvent &event) {
        // Before the edges: then no window closes on one that came in time.
        const uint32_t now = ::micros();
        if (edges_ == nullptr) return false;
        (void)eeruf_hc_sr04_edges(&modules_, edges_);
        if (eeruf_flow_poll(&ring_, now, &event) != EERUF_EVENT) return false;
        if (event.kind == EERUF_EVENT_FIRE) fire(event.sensor);
        if (onEvent_ != nullptr) (void)onEvent_(watch_, &event, now);
        return true;
    }

    uint8_t sensor() const { return sensor_; }                     // which one, from 0
    uint8_t kind() const { return reading_.kind; }                 // EERUF_READING_..
    bool accepted() const { return kind() == EERUF_READING_ACCEPTED; } // an echo that counts
    bool clear() const { return kind() == EERUF_READING_CLEAR; }   // nothing is in range
    uint32_t micros() const { return reading_.t_echo_us; }         // the echo time, EERUF_NO_ECHO without echo
    uint16_t age() const { return reading_.age; }                  // firings since its last accepted reading
    // The distance at this temperature; 0 without echo.
    uint16_t millimetres(uint32_t soundMmPerS = EERUF_SOUND_20C) const {
        // c t / 2 in 32 bits: no echo is longer than 37 ms.
        return micros() == EERUF_NO_ECHO ? 0 : (micros() * (soundMmPerS / 8) + 125000) / 250000;
    }

    // Keeps the state before each module, which state() then asks for, in EerufStates<N>.
    void watch(EerufWatch &watch) {
        watch_ = &watch;
        onEvent_ = eeruf_watch_event; // by a pointer, so that a sketch that does not watch links none of it
    }
    // What is before a module now, since when, and why nothing is known; EERUF_WHY_NO_FIRING without watch().
    EerufState state(uint8_t sensor) const {
        EerufState state = {EERUF_NO_ECHO, 0, EERUF_STATE_UNKNOWN, EERUF_WHY_NO_FIRING, EERUF_BY_NOTHING};
        (void)eeruf_watch_state(watch_, sensor, ::micros(), &state);
        return state;
    }
    // How a module is: EERUF_HEALTH_..
    uint8_t health(uint8_t sensor) const { return eeruf_hc_sr04_health(&modules_, sensor); }
    // Stops a module, or lets it fire again.
    bool enable(uint8_t sensor, bool enabled = true) {
        return eeruf_flow_enable(&ring_, sensor, enabled) == EERUF_OK;
    }
    // Fires no module, or all again.
    void pause(bool paused = true) { (void)eeruf_flow_pause(&ring_, paused); }
    // Takes edges from this queue, which interrupts fill. Without one nothing fires.
    void use(EerufEdges &edges) { edges_ = &edges; }

    uint8_t count() const { return N; }
    uint8_t echoPin(uint8_t sensor) const { return echoes_[sensor]; }
    // What begin() came to: EERUF_OK or EERUF_ERR_..
    int8_t status() const { return status_; }
    // All that eeruf.h can do.
    EerufFlowRing &ring() { return ring_; }
    EerufHcSr04 &modules() { return modules_; }

private:
    // Unless the line is high.
    void fire(uint8_t sensor) {
        if (eeruf_hc_sr04_fire(&modules_, sensor, EerufPin::isHigh(echoes_[sensor])) != EERUF_OK) return;
        EerufPin::trigger(triggers_[sensor], echoes_[sensor], modules_.settings->trigger_us);
    }

    const uint8_t *triggers_, *echoes_;
    EerufEdges *edges_ = nullptr;
    EerufWatch *watch_ = nullptr;
    EerufStatus (*onEvent_)(EerufWatch *, const EerufEvent *, uint32_t) = nullptr;
    EerufFlowRing ring_;
    EerufHcSr04 modules_;
    EerufFlowSensor sensors_[N];
    EerufLine lines_[N];
    EerufReading reading_;
    uint8_t sensor_;
    EerufStatus status_ = EERUF_ERR_NOT_READY;
};

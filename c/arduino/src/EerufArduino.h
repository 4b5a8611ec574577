// Rings of HC-SR04 modules that reject each other's sound: eeruf for Arduino.
//
//   #include <EerufTables.h>
//   const uint8_t PINS[] = {2, 3, 4, 5};                  // trigger and echo of each module on one pin
//   EerufSonar<4> sonar(EERUF_HC_SR04_4, PINS);
//
//   void setup() { Serial.begin(115200); if (!sonar.begin()) Serial.println(sonar.status()); }
//   void loop() { if (sonar.read() && sonar.accepted()) Serial.println(sonar.millimetres()); }
//
// read() samples the echo lines, fires what is due and returns; what is due within 0.3 ms it waits for. Call it as
// often as you can: echo times are as exact as the calls are frequent, and where modules fire late by more than the
// table has to spare, a reading that sound of another module could explain is not accepted but ambiguous.
#pragma once

#include <Arduino.h>

#include "eeruf.h"

// Pins of modules, without Arduino's functions where that is faster: on an AVR by the port's registers.
namespace EerufPin {
bool isHigh(uint8_t pin);
// Ends a trigger; one that is the echo line too is an input from then on.
void release(uint8_t trigger, uint8_t echo);
// A pulse of this many microseconds.
void trigger(uint8_t trigger, uint8_t echo, uint8_t us = 10);
} // namespace EerufPin

// What all rings have in common, whatever their number of modules.
class EerufModules {
public:
    // Begins firing. False if the table cannot be used: status() says why. Of other modules than HC-SR04, or some that
    // may be triggered sooner, the settings are RING_MODULES of the table of their ring file; they must last.
    bool begin(const EerufHcSr04Settings &settings = hcSr04());

    // One step; true if a module has a new reading, which the functions below are about.
    bool read();
    uint8_t sensor() const { return sensor_; }             // which one, from 0
    uint8_t kind() const { return reading_.kind; }         // EERUF_READING_..
    bool accepted() const { return reading_.kind == EERUF_READING_ACCEPTED; } // an echo that counts
    bool clear() const { return reading_.kind == EERUF_READING_CLEAR; }       // nothing is in range
    uint32_t micros() const { return reading_.t_echo_us; } // the echo time, EERUF_NO_ECHO without echo
    uint16_t age() const { return reading_.age; }          // firings since its last accepted reading
    uint8_t explainedBy() const { return reading_.explained_by; } // the sensor that makes it ambiguous, or EERUF_BY_..
    // The distance at this temperature; 0 without echo.
    uint16_t millimetres(uint32_t soundMmPerS = EERUF_SOUND_20C) const;

    // Keeps the state before each module, which state() then asks for.
    void watch(EerufWatch &watch) {
        watch_ = &watch;
        onReading_ = watchEvent;
    }
    // What is before a module now, since when, and why nothing is known; EERUF_WHY_NO_FIRING without watch().
    EerufState state(uint8_t sensor) const;
    // How a module is: EERUF_HEALTH_..
    uint8_t health(uint8_t sensor) const { return eeruf_hc_sr04_health(&modules_, sensor); }
    // True if loop() is too slow, at most once a second: a firing of this period came more than a millisecond late. Late
    // firings make readings cost more time, and ambiguous. late() has the microseconds.
    bool tooSlow();
    uint16_t late() const { return ring_.latest_us; }
    // Stops a module, or lets it fire again.
    bool enable(uint8_t sensor, bool enabled = true) { return eeruf_ring_enable(&ring_, sensor, enabled) == EERUF_OK; }
    // Fires no module, or all again.
    void pause(bool paused = true) { (void)eeruf_ring_pause(&ring_, paused); }
    // By another table of as many modules, from the next period on.
    bool change(const EerufSchedule &schedule) {
        return eeruf_hc_sr04_change_schedule(&modules_, &schedule) == EERUF_OK;
    }
    // Changes along a ladder of tables, the first of which the ring began with, as its readings ask for.
    void adapt(EerufAdaptation &adaptation) {
        adaptation_ = &adaptation;
        onPeriod_ = climb; // by pointers, so that what a sketch does not use is not linked
    }
    // Pulls the line of a module that is stuck high low for this many microseconds before its next firing: some modules
    // hold it for ever after a lost echo. Put 1 kOhm into each line before, since module and pin drive against each other.
    void recover(uint16_t us = EERUF_RECOVERY_US) {
        recovery_ = us;
        onStuck_ = pullLow;
    }
    // Takes edges from this queue, which interrupts fill, instead of sampling the lines.
    void use(EerufEdges &edges) {
        edges_ = &edges;
        collect_ = drain;
    }
    // Calls this with each event and the clock that it was polled at, also with those that read() does not return for.
    void tell(void (*listener)(EerufModules &modules, const EerufEvent &event, uint32_t now)) { onEvent_ = listener; }

    uint8_t count() const { return count_; }
    uint8_t echoPin(uint8_t sensor) const { return echoes_[sensor]; }
    // What begin() came to: EERUF_OK or EERUF_ERR_..
    int8_t status() const { return status_; }
    // All that eeruf.h can do.
    EerufRing &ring() { return ring_; }
    EerufHcSr04 &modules() { return modules_; }

protected:
    EerufModules(const EerufSchedule &schedule, const uint8_t *triggers, const uint8_t *echoes, EerufSensor *sensors,
                 EerufLine *lines, uint8_t count)
        : schedule_(&schedule), triggers_(triggers), echoes_(echoes), sensors_(sensors), lines_(lines), count_(count) {}

private:
    static const EerufHcSr04Settings &hcSr04();
    static void sample(EerufModules &self);
    static void drain(EerufModules &self);
    static void climb(EerufModules &self, const EerufEvent &event);
    static void watchEvent(EerufModules &self, const EerufEvent &event, uint32_t now);
    static void pullLow(EerufModules &self, uint8_t sensor);
    void fire(uint8_t sensor);

    const EerufSchedule *schedule_;
    const uint8_t *triggers_, *echoes_;
    EerufSensor *sensors_;
    EerufLine *lines_;
    EerufAdaptation *adaptation_;
    EerufEdges *edges_;
    EerufWatch *watch_ = nullptr;
    void (*collect_)(EerufModules &) = sample;
    void (*onStuck_)(EerufModules &, uint8_t) = nullptr;
    void (*onPeriod_)(EerufModules &, const EerufEvent &) = nullptr;
    void (*onReading_)(EerufModules &, const EerufEvent &, uint32_t) = nullptr;
    void (*onEvent_)(EerufModules &, const EerufEvent &, uint32_t) = nullptr;
    EerufRing ring_;
    EerufHcSr04 modules_;
    EerufReading reading_;
    uint32_t told_ = 0;
    uint16_t recovery_;
    uint8_t count_, sensor_;
    EerufStatus status_ = EERUF_ERR_NOT_READY;
};

// The state before each of N modules: sonar.watch(states) after sonar.begin(). 10 bytes a module.
template <uint8_t N> class EerufStates : public EerufWatch {
public:
    EerufStates() { (void)eeruf_watch_init(this, sizeof(EerufWatch), watched_, sizeof watched_, 0); }

private:
    EerufWatched watched_[N];
};

// A ring of N modules by a table for N.
template <uint8_t N> class EerufSonar : public EerufModules {
public:
    // One pin for trigger and echo of each module.
    EerufSonar(const EerufSchedule &schedule, const uint8_t (&pins)[N])
        : EerufModules(schedule, pins, pins, sensors_, lines_, N) {}
    // Two pins for each.
    EerufSonar(const EerufSchedule &schedule, const uint8_t (&triggers)[N], const uint8_t (&echoes)[N])
        : EerufModules(schedule, triggers, echoes, sensors_, lines_, N) {}

private:
    EerufSensor sensors_[N];
    EerufLine lines_[N];
};

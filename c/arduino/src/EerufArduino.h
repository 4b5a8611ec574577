// Rings of HC-SR04 modules that reject each other's sound: eeruf for Arduino.
//
//   #include <EerufTables.h>
//   const uint8_t PINS[] = {2, 3, 4, 5};                  // trigger and echo of each module on one pin
//   EerufSonar<4> sonar(EERUF_HC_SR04_4, PINS);
//
//   void setup() { Serial.begin(115200); if (!sonar.begin()) Serial.println(sonar.status()); }
//   void loop() { if (sonar.read() && sonar.accepted()) Serial.println(sonar.millimetres()); }
//
// read() processes the edges of the echo lines, fires the modules that are due and returns; it waits for steps due
// within 0.3 ms. Call it as often as you can: modules that fire late fire less often.
//
// Edges are timed by interrupts: see EerufInterrupts.h. If EERUF_POLLED is defined before the first include, read()
// samples the lines instead: for 0.3 ms, until a triggered line rises, and for up to 4 ms if it expects an edge before
// loop() returns. An edge came at some time since the previous sample; if that is more than half a millisecond ago, the
// reading is EERUF_READING_LATE, without a distance.
#pragma once

#include <Arduino.h>

#include "eeruf.h"
#include "EerufInterrupts.h"

// Access to the modules' pins without Arduino's functions where that is faster: on an AVR through the port registers.
namespace EerufPin {
bool isHigh(uint8_t pin);
// Ends a trigger; a pin that is also the echo line becomes an input.
void release(uint8_t trigger, uint8_t echo);
// Sends a trigger pulse of this many microseconds.
void trigger(uint8_t trigger, uint8_t echo, uint8_t us = 10);
} // namespace EerufPin

// The common part of all rings, with a table or by flow, for any number of modules.
class EerufModules {
public:
    // The module of the reading for which read() returned true, from 0.
    uint8_t sensor() const { return sensor_; }
    uint8_t kind() const { return reading_.kind; }         // EERUF_READING_..
    bool accepted() const { return reading_.kind == EERUF_READING_ACCEPTED; } // an echo that counts
    bool clear() const { return reading_.kind == EERUF_READING_CLEAR; }       // nothing is in range
    uint32_t micros() const { return reading_.t_echo_us; } // the echo time, EERUF_NO_ECHO without echo
    uint16_t age() const { return reading_.age; }          // firings since its last accepted reading
    uint8_t explainedBy() const { return reading_.explained_by; } // the sensor that makes it ambiguous, or EERUF_BY_..
    // The distance at this speed of sound; 0 without echo.
    uint16_t millimetres(uint32_t soundMmPerS = EERUF_SOUND_20C) const;

    // Tracks the state in front of each module, for state().
    void watch(EerufWatch &watch) {
        watch_ = &watch;
        onReading_ = watchEvent;
    }
    // The state in front of a module, since when, and why nothing is known; EERUF_WHY_NO_FIRING without watch().
    EerufState state(uint8_t sensor) const;
    // The health of a module: EERUF_HEALTH_..
    uint8_t health(uint8_t sensor) const { return eeruf_hc_sr04_health(&modules_, sensor); }
    // Microseconds for which no module is awaited or due: time to write a strip of LEDs, whose library calls
    // noInterrupts(). 0 while a module is awaited: see the example Strip.
    uint32_t quietFor() const;
    // Pulls a line that is stuck high low for this many microseconds before the module's next firing: some modules hold
    // it for ever after a lost echo. Put 1 kOhm into each line first, since module and pin drive against each other.
    void recover(uint16_t us = EERUF_RECOVERY_US) {
        recovery_ = us;
        onStuck_ = pullLow;
    }
    // Takes edges from this queue, which interrupts fill, instead of sampling the lines.
    void use(EerufEdges &edges) { edges_ = &edges; }
    // Calls `listener` with each event and the time of its poll, also for events for which read() does not return.
    void tell(void (*listener)(EerufModules &modules, const EerufEvent &event, uint32_t now)) { onEvent_ = listener; }

    // True, about once a second, if loop() is too slow: a module had no two punctual readings in a row, or a table's
    // firings were more than a millisecond late, which makes readings ambiguous and costs time.
    bool tooSlow() { return eeruf_pace_too_slow(&pace_, modules_.ring, ::micros()); }
    // True if interrupts time the edges; else read() samples the lines, by request or because a pin has no interrupt.
    bool byInterrupts() const { return !looks_; }

    uint8_t count() const { return count_; }
    uint8_t echoPin(uint8_t sensor) const { return echoes_[sensor]; }
    // The result of begin(): EERUF_OK or EERUF_ERR_..
    int8_t status() const { return status_; }
    // Access to all functions of eeruf.h.
    EerufRing &ring() { return *modules_.ring; }
    EerufHcSr04 &modules() { return modules_; }

protected:
    EerufModules(const uint8_t *triggers, const uint8_t *echoes, uint8_t count)
        : triggers_(triggers), echoes_(echoes), count_(count) {}

    // Begins with a ring whose initialisation returned `status`, its lines and its queue of edges.
    bool begin(EerufStatus status, EerufRing &ring, EerufLine *lines, EerufEdge *places, uint8_t count,
               const EerufHcSr04Settings &settings);
    // Processes edges, and waits for a step due within `soon`; returns the clock before it. `looks` as EERUF_LOOKS.
    uint32_t collect(uint16_t soon, bool looks);
    // Delays the trigger that was polled at `now` so that all triggers follow their polls by the same time, however
    // long the poll took: an uneven delay would look like a change of a foreign path.
    void holdBack(uint32_t now, bool looks);
    // Handles an event; true for a reading.
    bool take(const EerufEvent &event, uint32_t now, bool looks);

    EerufStatus status_ = EERUF_ERR_NOT_READY;

private:
    static void watchEvent(EerufModules &self, const EerufEvent &event, uint32_t now);
    static void pullLow(EerufModules &self, uint8_t sensor);
    void fire(uint8_t sensor, bool looks);
    bool expects(uint32_t now) const;

    const uint8_t *triggers_, *echoes_;
    EerufEdges *edges_ = nullptr;
    EerufWatch *watch_ = nullptr;
    // Pointers, so that functions which a sketch does not use are not linked.
    void (*onStuck_)(EerufModules &, uint8_t) = nullptr;
    void (*onReading_)(EerufModules &, const EerufEvent &, uint32_t) = nullptr;
    void (*onEvent_)(EerufModules &, const EerufEvent &, uint32_t) = nullptr;
    EerufEdges queue_;
    EerufHcSr04 modules_;
    EerufReading reading_;
    EerufPace pace_ = {0, 0, 0, false};
    uint32_t seen_ = 0; // time of the last read()
    uint16_t recovery_, away_ = 0; // how long loop() does other things
    uint8_t count_, sensor_;
    bool looks_ = false; // read() looks at the lines
};

// The state in front of each of N modules: call sonar.watch(states) after sonar.begin(). 10 bytes a module.
template <uint8_t N> class EerufStates : public EerufWatch {
public:
    EerufStates() { (void)eeruf_watch_init(this, sizeof(EerufWatch), watched_, sizeof watched_, 0); }

private:
    EerufWatched watched_[N];
};

// A ring of N modules with a table for N.
template <uint8_t N> class EerufSonar : public EerufModules {
public:
    // One pin for trigger and echo of each module.
    EerufSonar(const EerufSchedule &schedule, const uint8_t (&pins)[N])
        : EerufModules(pins, pins, N), schedule_(&schedule) {}
    // Two pins for each module.
    EerufSonar(const EerufSchedule &schedule, const uint8_t (&triggers)[N], const uint8_t (&echoes)[N])
        : EerufModules(triggers, echoes, N), schedule_(&schedule) {}

    // Begins firing HC-SR04 modules. False if the table cannot be used: status() says why.
    bool begin() {
        static const EerufHcSr04Settings settings = EERUF_HC_SR04;
        return begin(settings);
    }
    // Begins with other modules, or a shorter rest: RING_MODULES of their table, which must outlive this.
    bool begin(const EerufHcSr04Settings &settings) {
        const EerufConfig config = EERUF_CONFIG;
        const EerufStatus status =
            eeruf_ring_init(&ring_, sizeof ring_, sensors_, sizeof sensors_, schedule_, &config, EerufLines::now());
        return EerufModules::begin(status, ring_, lines_, places_, sizeof places_ / sizeof *places_, settings);
    }

    // Takes one step; true if a module has a new reading. Just before a firing no reading is judged, to be on time.
    bool read() {
        EerufEvent event;
        if (status_ != EERUF_OK) return false;
        const uint32_t now = collect(200 + 40 * N, EERUF_LOOKS);
        if (eeruf_ring_poll(&ring_, now, &event) != EERUF_EVENT) return false;
        return take(event, now, EERUF_LOOKS);
    }

    // The greatest lateness of this period's firings, in microseconds.
    uint16_t late() const { return ring_.latest_us; }
    // Stops a module, or lets it fire again.
    bool enable(uint8_t sensor, bool enabled = true) { return eeruf_ring_enable(&ring_, sensor, enabled) == EERUF_OK; }
    // Pauses all modules, or resumes them.
    void pause(bool paused = true) { (void)eeruf_ring_pause(&ring_, paused); }

private:
    const EerufSchedule *schedule_;
    EerufRing ring_;
    EerufSensor sensors_[N];
    EerufLine lines_[N];
    EerufEdge places_[N > 8 ? 32 : 16];
};

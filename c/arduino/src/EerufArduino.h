// Rings of HC-SR04 modules that reject each other's sound: eeruf for Arduino.
//
//   #include <EerufTables.h>
//   const uint8_t PINS[] = {2, 3, 4, 5};                  // trigger and echo of each module on one pin
//   EerufSonar<4> sonar(EERUF_HC_SR04_4, PINS);
//
//   void setup() { Serial.begin(115200); if (!sonar.begin()) Serial.println(sonar.status()); }
//   void loop() { if (sonar.read() && sonar.accepted()) Serial.println(sonar.millimetres()); }
//
// read() takes in the edges of the echo lines, fires what is due and returns; what is due within 0.3 ms it waits for. Call
// it as often as you can: modules that fire late fire less often.
//
// Edges are timed by interrupts: see EerufInterrupts.h. With EERUF_POLLED defined before the first include, read() looks at
// the lines instead: for 0.3 ms, until a line that was triggered rises, and for up to 4 ms where it expects an edge before
// loop() comes back. An edge came at some time since the look before; if that is more than half a millisecond, the reading
// is EERUF_READING_LATE, which is no distance.
#pragma once

#include <Arduino.h>

#include "eeruf.h"
#include "EerufInterrupts.h"

// Pins of modules, without Arduino's functions where that is faster: on an AVR by the port's registers.
namespace EerufPin {
bool isHigh(uint8_t pin);
// Ends a trigger; one that is the echo line too is an input from then on.
void release(uint8_t trigger, uint8_t echo);
// A pulse of this many microseconds.
void trigger(uint8_t trigger, uint8_t echo, uint8_t us = 10);
} // namespace EerufPin

// What all rings have in common, by a table or by flow, whatever their number of modules.
class EerufModules {
public:
    // After read() has returned true: which one, from 0.
    uint8_t sensor() const { return sensor_; }
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
    // For how long, in microseconds, no module is awaited and none is due: the time to write a strip of LEDs, whose library
    // calls noInterrupts(). 0 while one is awaited: see the example Strip.
    uint32_t quietFor() const;
    // Pulls the line of a module that is stuck high low for this many microseconds before its next firing: some modules
    // hold it for ever after a lost echo. Put 1 kOhm into each line before, since module and pin drive against each other.
    void recover(uint16_t us = EERUF_RECOVERY_US) {
        recovery_ = us;
        onStuck_ = pullLow;
    }
    // Takes edges from this queue, which interrupts fill, instead of looking at the lines.
    void use(EerufEdges &edges) { edges_ = &edges; }
    // Calls this with each event and the clock that it was polled at, also with those that read() does not return for.
    void tell(void (*listener)(EerufModules &modules, const EerufEvent &event, uint32_t now)) { onEvent_ = listener; }

    // True if loop() is too slow, about once a second: a module had no two readings in it, or a table's firings came more than a
    // millisecond late, which makes readings ambiguous and cost more time.
    bool tooSlow() { return eeruf_pace_too_slow(&pace_, modules_.ring, ::micros()); }
    // Whether interrupts time the edges. If not, read() looks at the lines: it was asked for, or a pin has none.
    bool byInterrupts() const { return !looks_; }

    uint8_t count() const { return count_; }
    uint8_t echoPin(uint8_t sensor) const { return echoes_[sensor]; }
    // What begin() came to: EERUF_OK or EERUF_ERR_..
    int8_t status() const { return status_; }
    // All that eeruf.h can do.
    EerufRing &ring() { return *modules_.ring; }
    EerufHcSr04 &modules() { return modules_; }

protected:
    EerufModules(const uint8_t *triggers, const uint8_t *echoes, uint8_t count)
        : triggers_(triggers), echoes_(echoes), count_(count) {}

    // Begins with a ring that came to this status, its lines and places for edges.
    bool begin(EerufStatus status, EerufRing &ring, EerufLine *lines, EerufEdge *places, uint8_t count,
               const EerufHcSr04Settings &settings);
    // Takes in edges, and waits for what is due within a time: the clock before. `looks` as EERUF_LOOKS.
    uint32_t collect(uint16_t soon, bool looks);
    // Waits until a trigger may be given that was polled for at `now`: as long after it as others are, however long it took
    // to decide who is next. By what a trigger comes sooner or later, a path of foreign sound seems to change.
    void holdBack(uint32_t now, bool looks);
    // Does what an event asks for; true for a reading.
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
    // By pointers, so that what a sketch does not use is not linked.
    void (*onStuck_)(EerufModules &, uint8_t) = nullptr;
    void (*onReading_)(EerufModules &, const EerufEvent &, uint32_t) = nullptr;
    void (*onEvent_)(EerufModules &, const EerufEvent &, uint32_t) = nullptr;
    EerufEdges queue_;
    EerufHcSr04 modules_;
    EerufReading reading_;
    EerufPace pace_ = {0, 0, 0, false};
    uint32_t seen_ = 0; // by read(), for the last time
    uint16_t recovery_, away_ = 0; // how long loop() does other things
    uint8_t count_, sensor_;
    bool looks_ = false; // read() looks at the lines
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
        : EerufModules(pins, pins, N), schedule_(&schedule) {}
    // Two pins for each.
    EerufSonar(const EerufSchedule &schedule, const uint8_t (&triggers)[N], const uint8_t (&echoes)[N])
        : EerufModules(triggers, echoes, N), schedule_(&schedule) {}

    // Begins firing HC-SR04 modules. False if the table cannot be used: status() says why.
    bool begin() {
        static const EerufHcSr04Settings settings = EERUF_HC_SR04;
        return begin(settings);
    }
    // The same of others, or some that may be triggered sooner: RING_MODULES of their table, which must last.
    bool begin(const EerufHcSr04Settings &settings) {
        const EerufConfig config = EERUF_CONFIG;
        const EerufStatus status =
            eeruf_ring_init(&ring_, sizeof ring_, sensors_, sizeof sensors_, schedule_, &config, EerufLines::now());
        return EerufModules::begin(status, ring_, lines_, places_, sizeof places_ / sizeof *places_, settings);
    }

    // One step; true if a module has a new reading. To fire on time matters: just before, no reading is judged.
    bool read() {
        EerufEvent event;
        if (status_ != EERUF_OK) return false;
        const uint32_t now = collect(200 + 40 * N, EERUF_LOOKS);
        if (eeruf_ring_poll(&ring_, now, &event) != EERUF_EVENT) return false;
        return take(event, now, EERUF_LOOKS);
    }

    // The microseconds by which firings of this period came late at most.
    uint16_t late() const { return ring_.latest_us; }
    // Stops a module, or lets it fire again.
    bool enable(uint8_t sensor, bool enabled = true) { return eeruf_ring_enable(&ring_, sensor, enabled) == EERUF_OK; }
    // Fires no module, or all again.
    void pause(bool paused = true) { (void)eeruf_ring_pause(&ring_, paused); }

private:
    const EerufSchedule *schedule_;
    EerufRing ring_;
    EerufSensor sensors_[N];
    EerufLine lines_[N];
    EerufEdge places_[N > 8 ? 32 : 16];
};

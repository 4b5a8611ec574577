// Three HC-SR04 modules on ESPHome's host platform, in place of its hal.cpp and gpio.cpp: the first is 1 m from a wall,
// the second faces nothing, and the third has no power. Triggers are on even pins, each with its echo line on the next
// pin. A look at the clock takes 5 us, and the program ends after 10 s of its time.
#include <cstdlib>

#include "esphome/components/host/gpio.h"

static uint64_t now_us;
static struct Line {
    void (*edge)(void *);
    void *arg;
    bool high;
    uint64_t rises, falls;
} lines[6];

static uint64_t pass(uint64_t us) {
    now_us += us;
    for (Line &line : lines) {
        if ((now_us >= line.rises && now_us < line.falls) == line.high) continue;
        line.high = !line.high;
        line.edge(line.arg);
    }
    if (now_us > 10000000) exit(0);
    return now_us;
}

namespace esphome {
uint32_t micros() { return (uint32_t)pass(5); }
uint64_t millis_64() { return pass(5) / 1000; }
uint32_t millis() { return (uint32_t)millis_64(); }
void delay(uint32_t ms) { pass(1000 * ms); }
void delayMicroseconds(uint32_t us) { pass(us); }
void arch_restart() { exit(1); }
uint32_t arch_get_cpu_cycle_count() { return micros(); }
bool ISRInternalGPIOPin::digital_read() { return static_cast<Line *>(arg_)->high; }

namespace host {
void HostGPIOPin::pin_mode(gpio::Flags) {}
bool HostGPIOPin::digital_read() { return lines[pin_].high; }
void HostGPIOPin::digital_write(bool value) {
    static const uint32_t HOLDS_US[] = {5827, 38000, 0};
    if (!value) return;
    lines[pin_ + 1].rises = now_us + 450;
    lines[pin_ + 1].falls = now_us + 450 + HOLDS_US[pin_ / 2];
}
size_t HostGPIOPin::dump_summary(char *, size_t) const { return 0; }
void HostGPIOPin::detach_interrupt() const {}
ISRInternalGPIOPin HostGPIOPin::to_isr() const { return ISRInternalGPIOPin(&lines[pin_]); }
void HostGPIOPin::attach_interrupt(void (*edge)(void *), void *arg, gpio::InterruptType) const {
    lines[pin_].edge = edge;
    lines[pin_].arg = arg;
}
} // namespace host
} // namespace esphome

// Rings of HC-SR04 modules in ESPHome.
#pragma once

#include "eeruf.h"
#include "esphome/components/sensor/sensor.h"
#include "esphome/core/component.h"
#include "esphome/core/helpers.h"

namespace esphome::eeruf {

struct Echo {
    EerufEdges *edges;
    ISRInternalGPIOPin pin;
    uint8_t sensor;
};

static void IRAM_ATTR on_edge(Echo *echo) {
    (void)eeruf_edges_push(echo->edges, echo->sensor, echo->pin.digital_read(), micros());
}

// N modules that fire by flow, each with a sensor in metres: infinity if nothing is in range, minus infinity if
// something is too close, NAN if nothing is known.
template <uint8_t N> class Ring : public PollingComponent {
public:
    // The settings of EerufFlowConfig for one kind of module, and the shortest pulse that is not an echo.
    Ring(uint32_t window_us, uint32_t blanking_us, uint32_t least_us, uint32_t most_us, uint32_t rest_us, uint32_t longest_us) {
        config_.window_us = window_us;
        config_.blanking_us = blanking_us;
        config_.least_us = least_us;
        config_.most_us = most_us;
        config_.rest_us = settings_.min_retrigger_us = rest_us;
        settings_.longest_us = longest_us;
    }

    void add(sensor::Sensor *distance, InternalGPIOPin *trigger, InternalGPIOPin *echo) {
        distances_[count_] = distance;
        triggers_[count_] = trigger;
        echoes_[count_++] = echo;
    }

    void setup() override {
        const uint32_t now = micros();
        config_.seed = random_uint32() | 1;
        EerufStatus status = eeruf_flow_init(&ring_, sizeof ring_, sensors_, sizeof sensors_, &config_, now);
        if (status == EERUF_OK)
            status = eeruf_hc_sr04_init(&modules_, sizeof modules_, lines_, sizeof lines_, &ring_.ring, &settings_);
        if (status == EERUF_OK) status = eeruf_edges_init(&edges_, sizeof edges_, places_, sizeof places_);
        if (status == EERUF_OK) status = eeruf_watch_init(&watch_, sizeof watch_, watched_, sizeof watched_, now);
        if (status != EERUF_OK) return mark_failed(LOG_STR("settings out of range"));
        for (uint8_t i = 0; i < N; i++) {
            triggers_[i]->setup();
            triggers_[i]->digital_write(false);
            echoes_[i]->setup();
            edges_of_[i] = {&edges_, echoes_[i]->to_isr(), i};
            echoes_[i]->attach_interrupt(on_edge, &edges_of_[i], gpio::INTERRUPT_ANY_EDGE);
        }
        often_.start();
    }

    void loop() override {
        EerufEvent event;
        const uint32_t now = micros(); // before the edges, so that no window closes on one that came in time
        (void)eeruf_hc_sr04_edges(&modules_, &edges_);
        while (eeruf_flow_poll(&ring_, now, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_FIRE) fire(event.sensor);
            (void)eeruf_watch_event(&watch_, &event, now);
        }
    }

    void update() override {
        EerufState state;
        for (uint8_t i = 0; i < N; i++) {
            (void)eeruf_watch_state(&watch_, i, micros(), &state);
            float metres = NAN;
            if (state.kind == EERUF_STATE_OBSTACLE) metres = eeruf_distance_mm(state.t_echo_us, EERUF_SOUND_20C) / 1000.0f;
            if (state.kind == EERUF_STATE_CLEAR) metres = INFINITY;
            if (state.kind == EERUF_STATE_TOO_CLOSE) metres = -INFINITY;
            distances_[i]->publish_state(metres);
        }
    }

private:
    void fire(uint8_t sensor) {
        if (eeruf_hc_sr04_fire(&modules_, sensor, echoes_[sensor]->digital_read()) != EERUF_OK) return;
        triggers_[sensor]->digital_write(true);
        delayMicroseconds(settings_.trigger_us);
        triggers_[sensor]->digital_write(false);
    }

    EerufFlowConfig config_ = EERUF_FLOW(N, 37000);
    EerufHcSr04Settings settings_ = EERUF_HC_SR04;
    EerufFlowRing ring_;
    EerufFlowSensor sensors_[N];
    EerufHcSr04 modules_;
    EerufLine lines_[N];
    EerufEdges edges_;
    EerufEdge places_[32]; // no more than four listen at a time
    EerufWatch watch_;
    EerufWatched watched_[N];
    sensor::Sensor *distances_[N];
    InternalGPIOPin *triggers_[N], *echoes_[N];
    Echo edges_of_[N];
    uint8_t count_ = 0;
    HighFrequencyLoopRequester often_;
};

} // namespace esphome::eeruf

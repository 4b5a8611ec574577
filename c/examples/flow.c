/* Twelve sensors that fire by flow, in the main loop of a firmware; docs/explanation/flow.md says how much flash and
   RAM it takes. CLOCK_US stands for a free-running timer, fire and use for functions of the board. */
#include "eeruf.h"

#define SENSORS 12

static volatile uint32_t CLOCK_US, triggered, distance_mm;

static EerufFlowRing ring;
static EerufFlowSensor sensors[SENSORS];

static void fire(uint8_t sensor) {
    triggered = sensor;
}

static void use(uint32_t t_echo_us) {
    distance_mm = eeruf_distance_mm(t_echo_us, EERUF_SOUND_20C);
}

/* Called from the interrupt of an echo line, or after it. */
static void heard(uint8_t sensor) {
    (void)eeruf_ring_echo(&ring.ring, sensor, CLOCK_US);
}

int main(void) {
    const EerufFlowConfig config = EERUF_FLOW(SENSORS, 36000);
    EerufStatus status = eeruf_flow_init(&ring, sizeof ring, sensors, sizeof sensors, &config, CLOCK_US);
    if (status != EERUF_OK) return status;
    for (;;) {
        EerufEvent event;
        while (eeruf_flow_poll(&ring, CLOCK_US, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_FIRE) fire(event.sensor);
            if (event.kind == EERUF_EVENT_READING && event.u.reading.kind == EERUF_READING_ACCEPTED)
                use(event.u.reading.t_echo_us);
        }
        while (CLOCK_US - eeruf_ring_deadline(&ring.ring) >= 0x80000000u)
            if (triggered > SENSORS) heard(0);
    }
}

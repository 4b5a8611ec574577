/* A ring of HC-SR04 modules on Zephyr. Interrupts stamp the edges of the echo lines, the main thread fires by flow, and
 * once a second the log says what is in front of each module. */
#include <zephyr/device.h>
#include <zephyr/devicetree.h>
#include <zephyr/drivers/gpio.h>
#include <zephyr/kernel.h>
#include <zephyr/logging/log.h>

#include <eeruf.h>

LOG_MODULE_REGISTER(ring, LOG_LEVEL_INF);

#define RING DT_COMPAT_GET_ANY_STATUS_OKAY(eeruf_hc_sr04_ring)

#define SENSORS ARRAY_SIZE(triggers)

static const struct gpio_dt_spec triggers[] = {
    DT_FOREACH_PROP_ELEM_SEP(RING, trigger_gpios, GPIO_DT_SPEC_GET_BY_IDX, (,))};
static const struct gpio_dt_spec echoes[] = {
    DT_FOREACH_PROP_ELEM_SEP(RING, echo_gpios, GPIO_DT_SPEC_GET_BY_IDX, (,))};
BUILD_ASSERT(ARRAY_SIZE(echoes) == SENSORS, "echo-gpios: expected a pin for each trigger");

static struct gpio_callback callbacks[SENSORS];
static EerufFlowRing ring;
static EerufFlowSensor sensors[SENSORS];
static EerufHcSr04 modules;
static EerufLine lines[SENSORS];
static EerufEdges edges;
static EerufEdge places[64];
static EerufWatch watch;
static EerufWatched watched[SENSORS];
static const EerufHcSr04Settings settings = EERUF_HC_SR04;

/* Microseconds that wrap at 32 bits. The cycle counter wraps sooner, so its steps are summed: call this at least once
   every 2^32 cycles, which are 51 s at 84 MHz. */
static uint32_t now_us(void) {
    static uint32_t cycles_before, us;
    static uint64_t rest; /* of a microsecond, in 1/1,000,000 of a cycle */
    const uint32_t cycles_per_s = (uint32_t)sys_clock_hw_cycles_per_sec();
    const unsigned int key = irq_lock();
    const uint32_t cycles = k_cycle_get_32();
    rest += (uint64_t)(cycles - cycles_before) * 1000000u;
    cycles_before = cycles;
    us += (uint32_t)(rest / cycles_per_s);
    rest %= cycles_per_s;
    const uint32_t now = us;
    irq_unlock(key);
    return now;
}

/* One callback for each echo line. Interrupts of two ports must not interrupt one another here. */
static void on_edge(const struct device *port, struct gpio_callback *callback, gpio_port_pins_t pins) {
    ARG_UNUSED(port);
    ARG_UNUSED(pins);
    const unsigned int key = irq_lock();
    const uint8_t sensor = (uint8_t)(callback - callbacks);
    const uint32_t at_us = now_us();
    (void)eeruf_edges_push(&edges, sensor, gpio_pin_get_dt(&echoes[sensor]) > 0, at_us);
    irq_unlock(key);
}

static int open_pins(void) {
    for (uint8_t sensor = 0; sensor < SENSORS; sensor++) {
        const struct gpio_dt_spec *trigger = &triggers[sensor], *echo = &echoes[sensor];
        if (!gpio_is_ready_dt(trigger) || !gpio_is_ready_dt(echo)) return -ENODEV;
        int status = gpio_pin_configure_dt(trigger, GPIO_OUTPUT_INACTIVE);
        if (status == 0) status = gpio_pin_configure_dt(echo, GPIO_INPUT);
        gpio_init_callback(&callbacks[sensor], on_edge, BIT(echo->pin));
        if (status == 0) status = gpio_add_callback_dt(echo, &callbacks[sensor]);
        if (status == 0) status = gpio_pin_interrupt_configure_dt(echo, GPIO_INT_EDGE_BOTH);
        if (status != 0) return status;
    }
    return 0;
}

static EerufStatus begin(void) {
    const EerufFlowConfig config = EERUF_FLOW(SENSORS, 37000); /* their longest echo and a millisecond */
    const uint32_t now = now_us();
    EerufStatus status = eeruf_flow_init(&ring, sizeof ring, sensors, sizeof sensors, &config, now);
    if (status == EERUF_OK)
        status = eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, &ring.ring, &settings);
    if (status == EERUF_OK) status = eeruf_edges_init(&edges, sizeof edges, places, sizeof places);
    if (status == EERUF_OK) status = eeruf_watch_init(&watch, sizeof watch, watched, sizeof watched, now);
    return status;
}

static void fire(uint8_t sensor) {
    const int level = gpio_pin_get_dt(&echoes[sensor]);
    if (level < 0) {
        (void)eeruf_hc_sr04_cannot_read(&modules, sensor);
        return;
    }
    if (eeruf_hc_sr04_fire(&modules, sensor, level > 0) != EERUF_OK) return;
    int status = gpio_pin_set_dt(&triggers[sensor], 1);
    k_busy_wait(settings.trigger_us);
    if (status == 0) status = gpio_pin_set_dt(&triggers[sensor], 0);
    if (status != 0) (void)eeruf_hc_sr04_cannot_write(&modules, sensor);
}

static void report(uint32_t now) {
    for (uint8_t sensor = 0; sensor < SENSORS; sensor++) {
        EerufState state;
        (void)eeruf_watch_state(&watch, sensor, now, &state);
        if (state.kind == EERUF_STATE_OBSTACLE)
            LOG_INF("%u: %u mm", sensor + 1u, (unsigned int)eeruf_distance_mm(state.t_echo_us, EERUF_SOUND_20C));
        else
            LOG_INF("%u: %s", sensor + 1u, eeruf_state_name(state.kind));
    }
}

int main(void) {
    const EerufStatus status = begin();
    if (status != EERUF_OK) {
        LOG_ERR("ring: status %d", status);
        return status;
    }
    const int error = open_pins();
    if (error != 0) {
        LOG_ERR("pins: error %d", error);
        return error;
    }
    uint32_t reported = now_us();
    for (;;) {
        EerufEvent event;
        /* Before the edges are taken, so that no window closes on an edge that came in time. */
        const uint32_t now = now_us();
        (void)eeruf_hc_sr04_edges(&modules, &edges);
        while (eeruf_flow_poll(&ring, now, &event) == EERUF_EVENT) {
            if (event.kind == EERUF_EVENT_FIRE) fire(event.sensor);
            (void)eeruf_watch_event(&watch, &event, now);
        }
        if (now - reported >= 1000000) {
            report(now);
            reported = now;
        }
        const int32_t left_us = (int32_t)(eeruf_ring_deadline(&ring.ring) - now_us());
        if (left_us > 0) (void)k_usleep(left_us);
    }
}

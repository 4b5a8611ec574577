/* Stands in for Zephyr's header of this name: see ../../../board.c. Types and results are as documented; values of
 * flags are not, for no program may depend on them. */
#pragma once

#include <errno.h>
#include <stdbool.h>
#include <stdint.h>

#include <zephyr/device.h>
#include <zephyr/devicetree.h>

typedef uint8_t gpio_pin_t;
typedef uint16_t gpio_dt_flags_t;
typedef uint32_t gpio_flags_t;
typedef uint32_t gpio_port_pins_t;

struct gpio_dt_spec {
    const struct device *port;
    gpio_pin_t pin;
    gpio_dt_flags_t dt_flags;
};
#define GPIO_DT_SPEC_GET_BY_IDX(node, property, index) PIN_##property##_##index
#define GPIO_ACTIVE_HIGH 0u

enum { GPIO_INPUT = 1, GPIO_OUTPUT_INACTIVE = 2, GPIO_INT_EDGE_BOTH = 4 };

struct gpio_callback;
typedef void (*gpio_callback_handler_t)(const struct device *port, struct gpio_callback *callback,
                                        gpio_port_pins_t pins);
struct gpio_callback {
    struct gpio_callback *next;
    gpio_callback_handler_t handler;
    gpio_port_pins_t pin_mask;
};

bool gpio_is_ready_dt(const struct gpio_dt_spec *spec);
int gpio_pin_configure_dt(const struct gpio_dt_spec *spec, gpio_flags_t extra_flags);
int gpio_pin_get_dt(const struct gpio_dt_spec *spec);
int gpio_pin_set_dt(const struct gpio_dt_spec *spec, int value);
int gpio_pin_interrupt_configure_dt(const struct gpio_dt_spec *spec, gpio_flags_t flags);
void gpio_init_callback(struct gpio_callback *callback, gpio_callback_handler_t handler, gpio_port_pins_t pin_mask);
int gpio_add_callback_dt(const struct gpio_dt_spec *spec, struct gpio_callback *callback);

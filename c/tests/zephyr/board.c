/* A board that runs c/zephyr/samples/ring on this machine, for two minutes of its own time, among HC-SR04 modules in a
 * room. It stands in for Zephyr, which CI cannot install: include/ declares the part that the sample calls, after
 * Zephyr 4.2's documentation. Its main is compiled as sample_main.
 *
 * The cycle counter wraps every 51 s, and soon after the start. A sleep ends at a tick of 100 us, one or two later than
 * requested. An interrupt occurs when interrupts are unlocked and none is being handled. Each call takes time.
 *
 * A module whose trigger falls sends its sound 450 us later and raises its line, until the first sound reaches it, its
 * own or a neighbour's, or until 38 ms are over. It is deaf for the first 150 us. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zephyr/drivers/gpio.h>
#include <zephyr/kernel.h>
#include <zephyr/logging/log.h>

#define HZ 84000000u
#define US (HZ / 1000000u)
#define TICK (HZ / CONFIG_SYS_CLOCK_TICKS_PER_SEC)
#define RUN_S 120u
#define MODULES 8
#define NEVER UINT64_MAX

/* Walls of the modules, in mm. CUT has no power, OPEN hears nothing at all, LOUD has no wall and hears both of its
 * neighbours. The line of STICKS sticks high for two seconds at a random time in every six. */
enum { CUT = 2, OPEN = 5, STICKS = 6, LOUD = 7 };
static const unsigned walls_mm[MODULES] = {500, 700, 600, 1500, 2000, 0, 900, 0};
/* The time of sound from a module to its neighbour. */
#define BESIDE_US 900u
/* The least number of firings of a module a second, in hundredths. */
#define FIRINGS 1160u

extern int sample_main(void);

const struct device ports[8];
static const struct gpio_dt_spec triggers[] = {
    DT_FOREACH_PROP_ELEM_SEP(ring, trigger_gpios, GPIO_DT_SPEC_GET_BY_IDX, (,))};
static const struct gpio_dt_spec echoes[] = {
    DT_FOREACH_PROP_ELEM_SEP(ring, echo_gpios, GPIO_DT_SPEC_GET_BY_IDX, (,))};
BUILD_ASSERT(ARRAY_SIZE(triggers) == MODULES && ARRAY_SIZE(echoes) == MODULES, "a module for each pin");

static const uint64_t began = UINT32_MAX - HZ / 100;
static uint64_t cycles = UINT32_MAX - HZ / 100;
static bool locked, in_interrupt;

static struct Module {
    bool is_output, is_input, interrupts, raised, line, pending;
    uint64_t raised_at, rise_at, rose_at, end_at;
    struct gpio_callback *callback;
    unsigned firings, last_mm, echoes, unanswered;
    char said[32];
} modules[MODULES];

/* Sounds in the air. */
static struct {
    uint64_t at;
    int receiver;
} sounds[64];
static size_t sound_count;

static unsigned wrong;

static void expect(bool holds, const char *what, int module) {
    if (holds) return;
    printf("module %d: expected %s\n", module + 1, what);
    wrong++;
}

static void send(int receiver, unsigned after_us) {
    if (sound_count == ARRAY_SIZE(sounds)) {
        expect(false, "fewer sounds at a time", receiver);
        exit(1);
    }
    sounds[sound_count].at = cycles + (450 + after_us) * US;
    sounds[sound_count++].receiver = receiver;
}

static void on_trigger(int i) {
    struct Module *module = &modules[i];
    const int beside[2] = {(i + 1) % MODULES, (i + MODULES - 1) % MODULES};
    if (i == CUT) return;
    expect(cycles - module->raised_at >= 10 * US, "a trigger of 10 us", i);
    expect(!module->line && module->rise_at == NEVER, "no trigger while the line is high", i);
    module->firings++;
    module->rise_at = cycles + 450 * US;
    if (walls_mm[i] != 0) send(i, walls_mm[i] * 20000 / 3432);
    for (size_t side = 0; side < 2; side++)
        if (beside[side] != OPEN && beside[side] != CUT) send(beside[side], BESIDE_US);
}

static void set_line(struct Module *module, bool high) {
    module->line = high;
    module->pending |= module->interrupts;
}

/* The instant of the next event. */
static uint64_t next(void) {
    uint64_t first = NEVER;
    for (int i = 0; i < MODULES; i++) {
        if (modules[i].rise_at < first) first = modules[i].rise_at;
        if (modules[i].end_at < first) first = modules[i].end_at;
    }
    for (size_t i = 0; i < sound_count; i++)
        if (sounds[i].at < first) first = sounds[i].at;
    return first;
}

/* The time until which a module's line sticks; 0 if it does not. */
static uint64_t stuck_until(int i) {
    const uint64_t turn = (cycles - began) / (6 * (uint64_t)HZ), drawn_us = turn * 2654435761u % 3900000u;
    const uint64_t from = began + turn * 6 * HZ + drawn_us * US, until = from + 2 * (uint64_t)HZ;
    return i == STICKS && cycles >= from && cycles < until ? until : 0;
}

/* Performs everything that is due. */
static void happen(void) {
    for (int i = 0; i < MODULES; i++) {
        struct Module *module = &modules[i];
        if (module->rise_at <= cycles) {
            module->rose_at = module->rise_at;
            module->end_at = stuck_until(i) != 0 ? stuck_until(i) : module->rise_at + 38000 * US;
            module->rise_at = NEVER;
            set_line(module, true);
        }
        if (module->end_at <= cycles) {
            module->end_at = NEVER;
            set_line(module, false);
        }
    }
    for (size_t i = 0; i < sound_count;) {
        struct Module *module = &modules[sounds[i].receiver];
        if (sounds[i].at > cycles) {
            i++;
            continue;
        }
        if (module->line && sounds[i].at - module->rose_at >= 150 * US && stuck_until(sounds[i].receiver) == 0) {
            module->end_at = NEVER;
            set_line(module, false);
        }
        sounds[i] = sounds[--sound_count];
    }
}

static void interrupt(void) {
    for (int i = 0; i < MODULES; i++) {
        struct Module *module = &modules[i];
        if (locked || in_interrupt || !module->pending || module->callback == NULL) continue;
        module->pending = false;
        in_interrupt = true;
        cycles += US;
        if (module->callback->pin_mask & BIT(echoes[i].pin))
            module->callback->handler(echoes[i].port, module->callback, (gpio_port_pins_t)BIT(echoes[i].pin));
        in_interrupt = false;
        i = -1;
    }
}

static void pass(uint64_t by) {
    const uint64_t until = cycles + by;
    for (uint64_t at = next(); at <= until; at = next()) {
        if (at > cycles) cycles = at;
        happen();
        interrupt();
    }
    if (until > cycles) cycles = until;
}

static void end(void) {
    for (int i = 0; i < MODULES; i++) {
        const struct Module *module = &modules[i];
        printf("zephyr: module %d: %u firings, said %s, %u mm in %u reports\n", i + 1, module->firings, module->said,
               module->last_mm, module->echoes);
        if (i == CUT) {
            expect(strcmp(module->said, "unanswered") == 0, "unanswered", i);
            continue;
        }
        /* A line that sticks 20 times for two seconds: the ring must report that, and never free space. */
        const unsigned lost_s = i == STICKS ? 40 : 0;
        expect(100 * module->firings >= (RUN_S - lost_s) * FIRINGS, "11.6 firings a second", i);
        expect(module->unanswered >= lost_s / 2, "that it does not answer while its line sticks", i);
        if (i == OPEN) expect(strcmp(module->said, "clear") == 0, "clear", i);
        if (walls_mm[i] == 0) {
            expect(module->echoes == 0, "no echo of any wall", i);
            continue;
        }
        expect(module->last_mm + 3 > walls_mm[i] && module->last_mm < walls_mm[i] + 3, "the distance of its wall", i);
        expect(module->echoes + lost_s >= RUN_S - 5, "it in nearly each report", i);
    }
    exit(wrong != 0);
}

int main(void) {
    for (int i = 0; i < MODULES; i++) modules[i].rise_at = modules[i].end_at = NEVER;
    printf("zephyr: the sample ended with %d\n", sample_main());
    return 1;
}

/* ---- Zephyr's functions ---- */

int sys_clock_hw_cycles_per_sec(void) {
    return HZ;
}

uint32_t k_cycle_get_32(void) {
    pass(20);
    return (uint32_t)cycles;
}

void k_busy_wait(uint32_t usec_to_wait) {
    pass((uint64_t)usec_to_wait * US);
}

int32_t k_usleep(int32_t us) {
    const uint64_t ticks = ((uint64_t)us * US + TICK - 1) / TICK;
    pass((cycles / TICK + ticks + 1) * TICK - cycles + 5 * US);
    if (cycles - began > (uint64_t)RUN_S * HZ) end();
    return 0;
}

unsigned int irq_lock(void) {
    const unsigned int key = locked;
    locked = true;
    return key;
}

void irq_unlock(unsigned int key) {
    locked = key != 0;
    interrupt();
}

void board_log(const char *format, ...) {
    char said[64];
    unsigned module, mm;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(said, sizeof said, format, arguments);
    va_end(arguments);
    pass(10 * US);
    if (sscanf(said, "%u: ", &module) != 1 || module < 1 || module > MODULES) {
        printf("zephyr: %s\n", said);
        return;
    }
    struct Module *about = &modules[module - 1];
    (void)snprintf(about->said, sizeof about->said, "%s", strchr(said, ' ') + 1);
    if (strcmp(about->said, "clear") == 0) expect(walls_mm[module - 1] == 0, "no free space", (int)module - 1);
    if (strcmp(about->said, "unanswered") == 0) about->unanswered++;
    if (sscanf(about->said, "%u mm", &mm) == 1) {
        about->last_mm = mm;
        about->echoes++;
    }
}

static struct Module *of_pin(const struct gpio_dt_spec *specs, const struct gpio_dt_spec *spec) {
    for (int i = 0; i < MODULES; i++)
        if (specs[i].port == spec->port && specs[i].pin == spec->pin) return &modules[i];
    return NULL;
}

bool gpio_is_ready_dt(const struct gpio_dt_spec *spec) {
    return of_pin(triggers, spec) != NULL || of_pin(echoes, spec) != NULL;
}

int gpio_pin_configure_dt(const struct gpio_dt_spec *spec, gpio_flags_t extra_flags) {
    struct Module *trigger = of_pin(triggers, spec), *echo = of_pin(echoes, spec);
    if (trigger != NULL) trigger->is_output = extra_flags == GPIO_OUTPUT_INACTIVE;
    if (echo != NULL) echo->is_input = extra_flags == GPIO_INPUT;
    return 0;
}

int gpio_pin_get_dt(const struct gpio_dt_spec *spec) {
    const struct Module *module = of_pin(echoes, spec);
    pass(30);
    return module == NULL || !module->is_input ? -EIO : module->line;
}

int gpio_pin_set_dt(const struct gpio_dt_spec *spec, int value) {
    struct Module *module = of_pin(triggers, spec);
    pass(30);
    if (module == NULL || !module->is_output) return -EIO;
    if (value != 0 && !module->raised) module->raised_at = cycles;
    if (value == 0 && module->raised) on_trigger((int)(module - modules));
    module->raised = value != 0;
    return 0;
}

int gpio_pin_interrupt_configure_dt(const struct gpio_dt_spec *spec, gpio_flags_t flags) {
    struct Module *module = of_pin(echoes, spec);
    if (module == NULL || !module->is_input) return -EIO;
    module->interrupts = flags == GPIO_INT_EDGE_BOTH;
    return 0;
}

void gpio_init_callback(struct gpio_callback *callback, gpio_callback_handler_t handler, gpio_port_pins_t pin_mask) {
    callback->handler = handler;
    callback->pin_mask = pin_mask;
}

int gpio_add_callback_dt(const struct gpio_dt_spec *spec, struct gpio_callback *callback) {
    struct Module *module = of_pin(echoes, spec);
    if (module == NULL) return -EIO;
    module->callback = callback;
    return 0;
}

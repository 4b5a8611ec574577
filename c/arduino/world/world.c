/* A simulated world around an emulated Arduino: HC-SR04 modules on its pins, in a room where they hear each other.
 *
 *   world [--pulses] [--mega] [--eeprom HEX] [--fault KIND:MODULE] SKETCH.elf SECONDS ECHO_TIMES MODULES TRIGGER_PIN.. ECHO_PIN..
 *
 * ECHO_TIMES has a line for each path of sound: emitter, receiver, microseconds; `crates/eeruf-sim`'s example echo_times writes
 * it. Pins are the Uno's numbers, or with --mega those of a Mega 2560; the same pin twice is a module with one pin. The
 * sketch's serial output goes to standard output; then come lines that begin with `world`: firings of each module, triggers
 * that came while its line was high, how often its latched line was pulled low, and the greatest depth of the stack in bytes.
 * With --pulses there is also a line for each pulse that sound has ended: the module from 1, the source of the sound (`own`,
 * `earlier` for an earlier firing of its own, or `foreign`), and the pulse's width in microseconds. With --eeprom the board's EEPROM begins with these bytes. A byte that the sketch writes to GPIOR0
 * prints a line, too: `read`, the byte, and the number in GPIOR1 (high) and GPIOR2.
 *
 * With --fault a module, counted from 1, has a fault: `cut`, its trigger is not connected, or it has no power; `deaf`, its
 * echo wire is cut; `glitch-high`, cut, with a spike of 5 us on its line 3 ms after each trigger; `glitch-low`, its pulse has
 * a gap of 5 us after 2 ms; `spike`, a spike of 5 us on its line 0.25 ms after each trigger; `lost-rise`, `lost-fall`, the
 * interrupts of pins are masked while its line rises or falls; `stuck`, its line stays high; `latched`, so it does without an
 * echo, until the sketch pulls it low, and hears none in the first second; `hold-N`, it holds its line for N ms without an echo; `exchanged-N`, its echo wire and
 * module N's are exchanged.
 *
 * A module whose trigger falls sends its sound 450 us later and raises its line, until the first sound reaches it, its
 * own or another's, or until 38 ms are over. It is deaf for the first 150 us. Time is the board's own, to the cycle. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_time.h>

#define MODULES 24
#define WAYS 4096

static avr_t *avr;
static struct {
    int emitter, receiver;
    unsigned after_us;
} ways[WAYS];
static int way_count;

static struct Module {
    int trigger, echo;
    int triggered, line_high;
    avr_cycle_count_t rose, fired;
    unsigned firings, ignored, glitches, pulled;
} modules[MODULES];
static int says_pulses;
enum Fault { NONE, CUT, DEAF, GLITCH_HIGH, GLITCH_LOW, SPIKE, LOST_RISE, LOST_FALL, STUCK, LATCHED };
static enum Fault fault;
static int faulty = -1; /* the module with the fault, if any */
static unsigned hold_ms = 38; /* the faulty module's */
static int partner = -1; /* the module that has its echo wire */
static int module_count;

/* The pins of a board from 0 on, each with its port and bit; the last are A0 to A5 of an Uno, A0 to A15 of a Mega. */
struct Board {
    const char *controller, *ports, *pins;
};
static const struct Board uno = {"atmega328p", "BCD", "D0D1D2D3D4D5D6D7B0B1B2B3B4B5C0C1C2C3C4C5"};
static const struct Board mega = {
    "atmega2560", "ABCDEFGHJKL",
    "E0E1E4E5G5E3H3H4H5H6B4B5B6B7J1J0H1H0D3D2D1D0A0A1A2A3A4A5A6A7C7C6C5C4C3C2C1C0D7G2G1G0L7L6L5L4L3L2L1L0B3B2B1B0"
    "F0F1F2F3F4F5F6F7K0K1K2K3K4K5K6K7"};
static const struct Board *board = &uno;

static char port_of(int pin) {
    return board->pins[2 * pin];
}
static int bit_of(int pin) {
    return board->pins[2 * pin + 1] - '0';
}

static int is_pin(int pin) {
    return pin >= 0 && (size_t)pin < strlen(board->pins) / 2;
}

static uint8_t ports['L' - 'A' + 1], directions['L' - 'A' + 1];
#define INDEX_OF(port) ((port) - 'A')

/* True if the board itself drives a pin to a level. */
static int is_driven(int pin, int level) {
    const int port = INDEX_OF(port_of(pin));
    return directions[port] >> bit_of(pin) & 1 && (ports[port] >> bit_of(pin) & 1) == level;
}

/* simavr 1.6 does not know that pins of the Mega's ports J and K interrupt when they change: PCINT1 and PCINT2. */
#define PCICR 0x68
#define PCIFR 0x3b
#define PCMSK0 0x6b
static avr_int_vector_t pin_changes[3];

static void register_pin_changes(void) {
    int group;
    for (group = 1; group < 3 && board == &mega; group++) {
        pin_changes[group].vector = (uint8_t)(9 + group);
        pin_changes[group].enable = (avr_regbit_t)AVR_IO_REGBIT(PCICR, group);
        pin_changes[group].raised = (avr_regbit_t)AVR_IO_REGBIT(PCIFR, group);
        avr_register_vector(avr, &pin_changes[group]);
    }
}

static void note_change(int pin) {
    const int group = port_of(pin) == 'J' ? 1 : port_of(pin) == 'K' ? 2 : 0;
    const int place = group == 1 ? bit_of(pin) + 1 : bit_of(pin);
    if (board == &mega && group != 0 && avr->data[PCMSK0 + group] >> place & 1)
        avr_raise_interrupt(avr, &pin_changes[group]);
}

/* simavr 1.6 does not count with timers that go to 255 and down again, as the core sets timers 1 and 2, at clock / 64. */
static struct Counter {
    uint16_t value, control; /* addresses: of TCNTnL, of TCCRnA */
    uint8_t clock;
    avr_io_read_t read;
    void *param;
} counters[2] = {{0x84, 0x80, 0x03, NULL, NULL}, {0xb2, 0xb0, 0x04, NULL, NULL}};

static uint8_t read_counter(struct avr_t *a, avr_io_addr_t address, void *param) {
    const struct Counter *counter = (const struct Counter *)param;
    const unsigned place = (unsigned)(a->cycle / 64 % 510);
    if ((a->data[counter->control] & 0x03) == 0x01 && (a->data[counter->control + 1] & 0x1f) == counter->clock)
        return (uint8_t)(place > 255 ? 510 - place : place);
    return counter->read == NULL ? a->data[address] : counter->read(a, address, counter->param);
}

static void register_counters(void) {
    int i;
    for (i = 0; i < 2; i++) {
        const avr_io_addr_t io = AVR_DATA_TO_IO(counters[i].value);
        counters[i].read = avr->io[io].r.c;
        counters[i].param = avr->io[io].r.param;
        avr->io[io].r.c = read_counter;
        avr->io[io].r.param = &counters[i];
    }
}

static int has(const struct Module *module, enum Fault which) {
    return fault == which && module - modules == faulty;
}

#define EIMSK 0x3d

static void set_line(struct Module *module, int high) {
    const uint8_t external = avr->data[EIMSK], changes = avr->data[PCICR];
    module->line_high = high;
    if (has(module, DEAF)) return;
    if (has(module, high ? LOST_RISE : LOST_FALL)) avr->data[EIMSK] = avr->data[PCICR] = 0;
    note_change(module->echo);
    avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ(port_of(module->echo)), bit_of(module->echo)),
                  (uint32_t)high);
    avr->data[EIMSK] = external;
    avr->data[PCICR] = changes;
}

/* Time for which a module holds its line without an echo, in microseconds. */
static uint32_t held_us(const struct Module *module) {
    return module - modules == faulty ? 1000u * hold_ms : 38000u;
}

static void on_arrival(struct Module *module, const struct Module *emitter, unsigned firing) {
    if (has(module, STUCK) || (has(module, LATCHED) && avr->cycle < avr->frequency)) return;
    if (!module->line_high || avr->cycle - module->rose < avr_usec_to_cycles(avr, 150)) return;
    set_line(module, 0);
    if (says_pulses)
        printf("world pulse %d %s %u\n", (int)(module - modules) + 1,
               module != emitter ? "foreign" : firing == module->firings ? "own" : "earlier",
               (unsigned)((avr->cycle - module->rose) / (avr->frequency / 1000000)));
}

static avr_cycle_count_t on_time_out(avr_t *a, avr_cycle_count_t when, void *param) {
    struct Module *module = (struct Module *)param;
    (void)when;
    if (module->line_high && a->cycle - module->rose >= avr_usec_to_cycles(a, held_us(module) - 10)) set_line(module, 0);
    return 0;
}

/* A spike or a gap of 5 us. */
static avr_cycle_count_t on_glitch(avr_t *a, avr_cycle_count_t when, void *param) {
    struct Module *module = (struct Module *)param;
    const int is_gap = fault == GLITCH_LOW;
    (void)when;
    if (is_gap && !module->line_high && module->glitches == 0) return 0;
    if (module->glitches++ == 0) {
        set_line(module, !is_gap);
        module->line_high = is_gap;
        avr_cycle_timer_register_usec(a, 5, on_glitch, module);
    } else {
        module->glitches = 0;
        set_line(module, is_gap);
    }
    return 0;
}

/* simavr keeps one timer for each function and parameter, so pending sounds are kept here. */
static struct {
    avr_cycle_count_t at;
    struct Module *module, *emitter;
    unsigned firing; /* which of the emitter's */
} sounds[WAYS];
static int sound_count;
static avr_cycle_count_t next_sound = ~(avr_cycle_count_t)0;

static void hear_what_is_due(void) {
    int i = 0;
    next_sound = ~(avr_cycle_count_t)0;
    while (i < sound_count) {
        if (sounds[i].at > avr->cycle) {
            if (sounds[i].at < next_sound) next_sound = sounds[i].at;
            i++;
            continue;
        }
        on_arrival(sounds[i].module, sounds[i].emitter, sounds[i].firing);
        sounds[i] = sounds[--sound_count];
    }
}

static avr_cycle_count_t on_burst(avr_t *a, avr_cycle_count_t when, void *param) {
    struct Module *module = (struct Module *)param;
    int way;
    (void)when;
    module->triggered = 0;
    module->rose = a->cycle;
    module->firings++;
    set_line(module, 1);
    for (way = 0; way < way_count; way++) {
        if (ways[way].emitter != (int)(module - modules) || sound_count == WAYS) continue;
        sounds[sound_count].at = a->cycle + avr_usec_to_cycles(a, ways[way].after_us);
        if (sounds[sound_count].at < next_sound) next_sound = sounds[sound_count].at;
        sounds[sound_count].emitter = module;
        sounds[sound_count].firing = module->firings;
        sounds[sound_count++].module = &modules[ways[way].receiver];
    }
    if (!has(module, STUCK) && !has(module, LATCHED)) avr_cycle_timer_register_usec(a, held_us(module), on_time_out, module);
    if (has(module, GLITCH_LOW)) avr_cycle_timer_register_usec(a, 2000, on_glitch, module);
    return 0;
}

/* Called when a port's outputs or directions have changed. */
static void look_at_triggers(void) {
    int i;
    for (i = 0; i < module_count; i++) {
        struct Module *module = &modules[i];
        const int high = is_driven(module->trigger, 1);
        if (has(module, LATCHED) && module->line_high && is_driven(module->echo, 0)) {
            module->pulled++;
            set_line(module, 0);
        }
        if (high == (module->triggered == 1)) continue;
        note_change(module->trigger);
        if (high && !module->triggered) {
            module->fired = avr->cycle;
            module->triggered = 1;
        } else if (!high && module->triggered == 1) {
            module->triggered = 0;
            /* Too short for a module. Data sheets ask for 10 us; delayMicroseconds(10) may take a little less. */
            if (avr->cycle - module->fired < avr_usec_to_cycles(avr, 9)) continue;
            if (has(module, GLITCH_HIGH)) avr_cycle_timer_register_usec(avr, 3000, on_glitch, module);
            if (has(module, SPIKE) && !module->line_high) avr_cycle_timer_register_usec(avr, 250, on_glitch, module);
            if (has(module, CUT) || has(module, GLITCH_HIGH)) continue;
            if (module->line_high) {
                module->ignored++;
                continue;
            }
            module->triggered = 2; /* busy until its burst */
            avr_cycle_timer_register_usec(avr, 450, on_burst, module);
        }
    }
}

static void on_port(struct avr_irq_t *irq, uint32_t value, void *param) {
    (void)irq;
    ports[(intptr_t)param] = (uint8_t)value;
    look_at_triggers();
}

static void on_direction(struct avr_irq_t *irq, uint32_t value, void *param) {
    (void)irq;
    directions[(intptr_t)param] = (uint8_t)value;
    look_at_triggers();
}

/* Prints whole lines, so that others do not come in between. */
static void on_serial(struct avr_irq_t *irq, uint32_t value, void *param) {
    static char line[200];
    static size_t length;
    (void)irq, (void)param;
    line[length++] = (char)value;
    if (value != '\n' && length < sizeof line) return;
    fwrite(line, 1, length, stdout);
    length = 0;
}

static void on_note(struct avr_t *a, avr_io_addr_t address, uint8_t value, void *param) {
    (void)address, (void)param;
    printf("world read %u %u\n", value, (unsigned)(a->data[0x4a] << 8 | a->data[0x4b]));
}

/* Parses `KIND:MODULE`. */
static int read_fault(const char *text) {
    static const char *const kinds[] = {"",          "cut",       "deaf",  "glitch-high", "glitch-low", "spike",
                                        "lost-rise", "lost-fall", "stuck", "latched"};
    const char *colon = strchr(text, ':');
    size_t kind;
    if (colon == NULL || (faulty = atoi(colon + 1) - 1) < 0) return 0;
    if (strncmp(text, "hold-", 5) == 0) return (hold_ms = (unsigned)atoi(text + 5)) > 0;
    if (strncmp(text, "exchanged-", 10) == 0) return (partner = atoi(text + 10) - 1) >= 0;
    for (kind = CUT; kind <= LATCHED; kind++)
        if (strlen(kinds[kind]) == (size_t)(colon - text) && strncmp(text, kinds[kind], strlen(kinds[kind])) == 0) {
            fault = (enum Fault)kind;
            return 1;
        }
    return 0;
}

static int read_ways(const char *name) {
    FILE *file = fopen(name, "r");
    if (file == NULL) return 0;
    while (way_count < WAYS && fscanf(file, "%d %d %u", &ways[way_count].emitter, &ways[way_count].receiver,
                                      &ways[way_count].after_us) == 3)
        if (ways[way_count].emitter < module_count && ways[way_count].receiver < module_count) way_count++;
    fclose(file);
    return way_count;
}

/* Bytes from the top of RAM down to the stack pointer, at its deepest; it points at the next free one. */
static unsigned deepest_stack;

static void look_at_stack(void) {
    const unsigned pointer = avr->data[R_SPL] | (unsigned)avr->data[R_SPH] << 8;
    /* The pointer is 0 before the program sets it. */
    if (pointer >= 0x100 && avr->ramend - pointer > deepest_stack) deepest_stack = avr->ramend - pointer;
}

static uint8_t eeprom_bytes[64];

/* Parses hexadecimal bytes of two digits each. */
static avr_eeprom_desc_t read_eeprom(const char *hex) {
    avr_eeprom_desc_t eeprom = {eeprom_bytes, 0, 0};
    unsigned byte;
    for (; eeprom.size < sizeof eeprom_bytes && sscanf(hex, "%2x", &byte) == 1; hex += 2)
        eeprom_bytes[eeprom.size++] = (uint8_t)byte;
    return eeprom;
}

int main(int argc, char **argv) {
    elf_firmware_t firmware;
    avr_eeprom_desc_t eeprom = {eeprom_bytes, 0, 0};
    avr_cycle_count_t end;
    uint32_t flags = 0;
    const char *port;
    int i;
    memset(&firmware, 0, sizeof firmware);
    for (; argc > 1 && argv[1][0] == '-'; argc--, argv++) {
        if (strcmp(argv[1], "--pulses") == 0) says_pulses = 1;
        else if (strcmp(argv[1], "--mega") == 0) board = &mega;
        else if (strcmp(argv[1], "--eeprom") == 0 && argc > 2) eeprom = read_eeprom(argv[2]), argc--, argv++;
        else if (strcmp(argv[1], "--fault") == 0 && argc > 2 && read_fault(argv[2])) argc--, argv++;
        else break;
    }
    if (argc < 5 || (module_count = atoi(argv[4])) < 1 || module_count > MODULES || argc != 5 + 2 * module_count) {
        fprintf(stderr, "usage: world [--pulses] [--mega] [--eeprom HEX] [--fault KIND:MODULE] SKETCH.elf SECONDS ECHO_TIMES "
                        "MODULES TRIGGER_PIN.. ECHO_PIN..\n");
        return 2;
    }
    for (i = 0; i < module_count; i++) {
        modules[i].trigger = atoi(argv[5 + i]);
        modules[i].echo = atoi(argv[5 + module_count + i]);
        if (!is_pin(modules[i].trigger) || !is_pin(modules[i].echo)) {
            fprintf(stderr, "pins %d and %d of module %d: expected pins of an %s\n", modules[i].trigger,
                    modules[i].echo, i + 1, board->controller);
            return 2;
        }
    }
    if (partner >= 0 && partner < module_count && faulty < module_count) {
        const int echo = modules[faulty].echo;
        modules[faulty].echo = modules[partner].echo;
        modules[partner].echo = echo;
    }
    if (!read_ways(argv[3]) || elf_read_firmware(argv[1], &firmware) != 0) {
        fprintf(stderr, "%s or %s cannot be read\n", argv[1], argv[3]);
        return 2;
    }
    avr = avr_make_mcu_by_name(board->controller);
    if (avr == NULL) return 2;
    avr_init(avr);
    avr->log = LOG_ERROR;
    avr_load_firmware(avr, &firmware);
    avr->frequency = 16000000;
    if (eeprom.size > 0) avr_ioctl(avr, AVR_IOCTL_EEPROM_SET, &eeprom);
    for (port = board->ports; *port != 0; port++) {
        void *number = (void *)(intptr_t)INDEX_OF(*port);
        const uint32_t io = AVR_IOCTL_IOPORT_GETIRQ(*port);
        avr_irq_register_notify(avr_io_getirq(avr, io, IOPORT_IRQ_REG_PORT), on_port, number);
        avr_irq_register_notify(avr_io_getirq(avr, io, IOPORT_IRQ_DIRECTION_ALL), on_direction, number);
    }
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_serial, NULL);
    register_pin_changes();
    register_counters();
    avr_register_io_write(avr, 0x3e, on_note, NULL); /* GPIOR0 */
    for (i = 0; i < module_count; i++) set_line(&modules[i], 0);
    end = (avr_cycle_count_t)(atof(argv[2]) * 16e6);
    while (avr->cycle < end) {
        const int state = avr_run(avr);
        if (state == cpu_Done || state == cpu_Crashed) {
            printf("world crashed\n");
            return 1;
        }
        look_at_stack();
        if (avr->cycle >= next_sound) hear_what_is_due();
    }
    printf("\nworld firings");
    for (i = 0; i < module_count; i++) printf(" %u", modules[i].firings);
    printf("\nworld ignored");
    for (i = 0; i < module_count; i++) printf(" %u", modules[i].ignored);
    printf("\nworld pulled low");
    for (i = 0; i < module_count; i++) printf(" %u", modules[i].pulled);
    printf("\nworld stack %u\n", deepest_stack);
    return 0;
}

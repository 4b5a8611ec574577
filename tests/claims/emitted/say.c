/* Prints what the emitted table SCHEDULE says, with the configuration CONFIG of its ring and the settings SETTINGS of its
   modules where there are some: a name and its numbers on each line. */
#include "eeruf.h"

#include TABLE

#include <stdio.h>

#define MOST 64u
#define EACH(name, number) \
    do { \
        printf("%s", name); \
        for (x = 0; x < SCHEDULE.sensors; x++) printf(" %lu", (unsigned long)(number)); \
        printf("\n"); \
    } while (0)

static void say(const char *name, uint32_t number) {
    printf("%s %lu\n", name, (unsigned long)number);
}

int main(void) {
    uint32_t fire_us[MOST], at_us;
    unsigned phase, place, x;
    for (phase = 0; phase < SCHEDULE.phases; phase++) {
        at_us = 0;
        for (place = 0; place < SCHEDULE.sensors; place++) {
            at_us += SCHEDULE.gap_us[phase * (SCHEDULE.sensors + 1u) + place];
            fire_us[SCHEDULE.order[phase * SCHEDULE.sensors + place]] = at_us;
        }
        EACH(phase == 0 ? "t_fire_a" : "t_fire_b", fire_us[x]);
    }
    EACH("t_delta", SCHEDULE.limits ? SCHEDULE.limits[x].t_delta_us : SCHEDULE.t_delta_us);
    EACH("window", SCHEDULE.limits ? SCHEDULE.limits[x].window_us : SCHEDULE.window_us);
    EACH("group", SCHEDULE.limits ? SCHEDULE.limits[x].group : 0u);
    say("period", SCHEDULE.period_us);
    say("stale_echo", SCHEDULE.stale_echo);
    say("verified", SCHEDULE.verified);
    if (SCHEDULE.path_change_us != EERUF_AS_T_DELTA) say("path_change", SCHEDULE.path_change_us);
    say("audible", SCHEDULE.audible_us);
#ifdef CONFIG
    {
        const EerufConfig config = CONFIG;
        say("blanking", config.blanking_us);
    }
#endif
#ifdef SETTINGS
    {
        const EerufHcSr04Settings settings = SETTINGS;
        printf("settings %u %u %u", settings.deaf_us, settings.shortest_us, settings.latest_rise_us);
        printf(" %lu %lu", (unsigned long)settings.longest_us, (unsigned long)settings.longest_hold_us);
        printf(" %lu", (unsigned long)settings.min_retrigger_us);
        printf(" %u %u\n", settings.missing_after, settings.trigger_us);
    }
#endif
    return 0;
}

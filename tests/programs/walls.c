/* The program of `eeruf design --program c` on modules that are each before a wall of their own, in a loop that comes up
   to 300 us late, beside the work of LOAD: how many microseconds, and after how many again; then by how many microseconds
   walls are apart. A line for each module: its
   readings after the first, those accepted, and those of them that are wrong. A program that speaks MAVLink hears the bytes
   of its input, and its own go to the output, at 115,200 baud. Numbers: a module without power, and one with nothing
   in range. */
#include <stdio.h>
#include <stdlib.h>

#include "sonar.h"

static uint32_t clock_us = 4294000000u, span = 20; /* wraps after one second */
static uint32_t rises_us[EERUF_SENSORS], falls_us[EERUF_SENSORS];
static uint8_t level[EERUF_SENSORS], pending[EERUF_SENSORS];
static int without_power = -1, open = -1;

static uint32_t wall_us(uint8_t sensor) {
    return sensor == open ? 38000u : 2000u + sensor * 618u % 1000u * span;
}

uint32_t board_micros(void) {
    return clock_us;
}

bool board_line_is_high(uint8_t sensor) {
    return level[sensor];
}

void board_trigger(uint8_t sensor, uint16_t us) {
    clock_us += us;
    rises_us[sensor] = clock_us + 450u;
    falls_us[sensor] = rises_us[sensor] + wall_us(sensor);
    pending[sensor] = sensor == without_power ? 0 : 2;
}

/* The edges up to an instant, each at its own. */
static void edges_until(uint32_t now) {
    for (uint8_t x = 0; x < EERUF_SENSORS; x++)
        while (pending[x] && (int32_t)(now - (pending[x] == 2 ? rises_us[x] : falls_us[x])) >= 0) {
            clock_us = pending[x] == 2 ? rises_us[x] : falls_us[x];
            level[x] = pending[x]-- == 2;
            sonar_edge(x, level[x]);
        }
    clock_us = now;
}

int main(int count, char **words) {
    const char *too_slow = "";
    uint32_t random = 1, work_us = 0, every_us = 0, next = 0, x;
    int readings[EERUF_SENSORS] = {0}, accepted[EERUF_SENSORS] = {0}, wrong[EERUF_SENSORS] = {0};
    if (getenv("LOAD") != NULL) sscanf(getenv("LOAD"), "%u %u %u", &work_us, &every_us, &span);
#ifdef EERUF_PERIOD_US /* a table */
    if (sonar_begin() != EERUF_OK) return puts("wrong settings"), 1;
#else
    if (sonar_begin(7) != EERUF_OK) return puts("wrong settings"), 1;
    sonar_moving(0, 0);
#endif
    if (count > 2) without_power = atoi(words[1]), open = atoi(words[2]);
#ifdef EERUF_MAVLINK_H
    for (int byte; (byte = getchar()) != EOF;) sonar_heard((uint8_t)byte);
#endif
    for (uint32_t elapsed = 0, step; elapsed < 20000000u; elapsed += step) {
        uint8_t sensor;
        EerufReading reading;
        random = random * 1664525u + 1013904223u;
        step = 20u + (random >> 16) % 280u;
        if (elapsed >= next) step += work_us, next = elapsed + step + every_us;
        edges_until(clock_us + step);
#ifdef EERUF_MAVLINK_H
        const uint8_t *bytes;
        const size_t size = sonar_mavlink(step / 87u, &bytes);
        fwrite(bytes, 1, size, stdout);
#endif
        if (sonar_too_slow()) too_slow = "too slow";
        while (sonar_read(&sensor, &reading)) {
            if (readings[sensor]++ == 0 || reading.kind != EERUF_READING_ACCEPTED) continue;
            accepted[sensor]++, wrong[sensor] += reading.t_echo_us - wall_us(sensor) + 2 > 4;
        }
    }
    for (x = 0; x < EERUF_SENSORS; x++) printf("%d %d %d\n", readings[x] - 1, accepted[x], wrong[x]);
    return puts(too_slow) < 0;
}

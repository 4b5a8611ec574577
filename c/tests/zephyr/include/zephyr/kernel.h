/* Stands in for Zephyr's header of this name: see ../../board.c. */
#pragma once

#include <stdint.h>

#define ARG_UNUSED(x) (void)(x)
#define ARRAY_SIZE(array) (sizeof(array) / sizeof((array)[0]))
#define BIT(n) (1ul << (n))
#define BUILD_ASSERT(condition, message) _Static_assert(condition, message)

/* Zephyr's default where the clock can be set to any instant. */
#define CONFIG_SYS_CLOCK_TICKS_PER_SEC 10000

int sys_clock_hw_cycles_per_sec(void);
uint32_t k_cycle_get_32(void);
void k_busy_wait(uint32_t usec_to_wait);
int32_t k_usleep(int32_t us);
unsigned int irq_lock(void);
void irq_unlock(unsigned int key);

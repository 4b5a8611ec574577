/* Stands in for Zephyr's header of this name: see ../../../board.c. */
#pragma once

#define LOG_LEVEL_INF 3
#define LOG_MODULE_REGISTER(name, level) _Static_assert((level) == LOG_LEVEL_INF, #name)
#define LOG_INF(...) board_log(__VA_ARGS__)
#define LOG_ERR(...) board_log(__VA_ARGS__)

void board_log(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Stands in for Zephyr's header of this name: see ../../board.c. */
#pragma once

struct device {
    char name;
};

// Seeds of EerufSeed.h on boards without a number, each with a noise of its own, at their first start and at the next.
#include <cstdio>
#include <cstring>

#include "EerufSeed.h"

uint32_t noise, clock_us;
uint8_t eeprom[E2END + 1];

uint32_t micros() {
    return clock_us += 112;
}

int analogRead(uint8_t) {
    noise = noise * 1664525u + 1013904223u;
    return 300 + (noise >> 30);
}

uint32_t eeprom_read_dword(const uint32_t *at) {
    uint32_t value;
    memcpy(&value, eeprom + (size_t)at, sizeof value);
    return value;
}

void eeprom_write_dword(uint32_t *at, uint32_t value) {
    memcpy(eeprom + (size_t)at, &value, sizeof value);
}

int main() {
    for (uint32_t board = 1; board <= 6; board++) {
        noise = board, clock_us = 4000;
        memset(eeprom, 0xff, sizeof eeprom);
        const uint32_t first = eerufSeed();
        printf("%lu %d\n", (unsigned long)first, eerufSeed() == first);
    }
}

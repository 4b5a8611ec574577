// A sketch's seeds on six boards, each with a chip's number and a noise of its own, at their first start and at the next.
#include <cstdio>
#include <pico/unique_id.h>

#include "Arduino.h"
#include SKETCH

uint32_t board, noise, clock_us, eeprom;

void pico_get_unique_board_id(pico_unique_board_id_t *number) {
    *number = {{0xe6, 0x61, 0, 0, 0, 0, 0, (uint8_t)board}};
}

uint32_t micros() {
    return clock_us += 112;
}

int analogRead(uint8_t) {
    noise = noise * 1664525u + 1013904223u;
    return 300 + (noise >> 30);
}

int main() {
    for (board = 1; board <= 6; board++) {
        noise = board, clock_us = 4000, eeprom = 0xffffffff;
        setup();
        setup();
        puts("");
    }
}

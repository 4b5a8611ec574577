// What a sketch's seed takes of an Arduino core.
#pragma once
#include <cstdint>
enum { A0 = 14, A5 = 19 };
#define E2END 1023
extern uint32_t board;
uint32_t micros();
int analogRead(uint8_t pin);
struct Chip {
    uint64_t getEfuseMac() { return 0x24a160000000u + board; }
};
#define ESP Chip()

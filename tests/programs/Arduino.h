// What EerufSeed.h takes of an Arduino core.
#pragma once
#include <cstddef>
#include <cstdint>
#define A0 14
#define E2END 1023
uint32_t micros();
int analogRead(uint8_t pin);

// What EerufSeed.h takes of avr-libc.
#pragma once
#include <cstdint>
extern uint32_t eeprom;
#define eeprom_read_dword(at) ((void)(at), eeprom)
#define eeprom_write_dword(at, value) ((void)(at), eeprom = (value))

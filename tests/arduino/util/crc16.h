// As avr-libc declares it.
#pragma once
uint16_t _crc_xmodem_update(uint16_t crc, uint8_t data);

// Flash of an AVR, which here is memory like any other.
#pragma once
#define PROGMEM
#define pgm_read_byte(place) (*(const uint8_t *)(place))
#define pgm_read_word(place) (*(const uint16_t *)(place))
#define pgm_read_dword(place) (*(const uint32_t *)(place))
#define pgm_read_ptr(place) (*(void *const *)(place))

// A seed for flow that differs from board to board: the chip's number if there is one. An AVR without one draws a seed
// at its first start, from the noise at an open analog pin and the clock, and keeps it in the last four bytes of its
// EEPROM; other boards without a number draw it at each start.
#pragma once

#include <Arduino.h>

#if defined(__AVR__) && !defined(SIGROW)
#include <avr/eeprom.h>
#elif defined(ARDUINO_ARCH_RP2040) && !defined(ARDUINO_ARCH_MBED)
#include <pico/unique_id.h>
#endif

namespace EerufSeed {
// FNV-1a.
inline uint32_t mixed(uint32_t seed, uint32_t number) {
    for (uint8_t byte = 0; byte < 4; ++byte) seed = (seed ^ (number >> 8 * byte & 0xff)) * 0x01000193u;
    return seed;
}

inline uint32_t ofNoise(uint8_t pin) {
    uint32_t seed = 0x811c9dc5u;
    for (uint8_t look = 0; look < 64; ++look) seed = mixed(seed, micros() << 16 ^ (uint32_t)analogRead(pin));
    return seed;
}

template <typename Number> uint32_t ofNumber(const Number *numbers, uint8_t count) {
    uint32_t seed = 0x811c9dc5u;
    while (count--) seed = mixed(seed, (uint32_t)*numbers++);
    return seed;
}

inline uint32_t drawn(uint8_t pin) {
#if defined(ARDUINO_ARCH_ESP32)
    const uint64_t mac = ESP.getEfuseMac();
    (void)pin;
    return mixed((uint32_t)mac, (uint32_t)(mac >> 32));
#elif defined(ARDUINO_ARCH_ESP8266)
    (void)pin;
    return mixed(0x811c9dc5u, ESP.getChipId());
#elif defined(ARDUINO_ARCH_RP2040) && !defined(ARDUINO_ARCH_MBED)
    pico_unique_board_id_t id;
    pico_get_unique_board_id(&id);
    (void)pin;
    return ofNumber(id.id, sizeof id.id);
#elif defined(ARDUINO_ARCH_SAMD) && defined(__SAMD21__)
    const volatile uint32_t *const words[] = {(uint32_t *)0x0080A00C, (uint32_t *)0x0080A040, (uint32_t *)0x0080A044,
                                              (uint32_t *)0x0080A048};
    uint32_t seed = 0x811c9dc5u;
    (void)pin;
    for (uint8_t word = 0; word < 4; ++word) seed = mixed(seed, *words[word]);
    return seed;
#elif defined(__AVR__) && defined(SIGROW)
    (void)pin;
    return ofNumber(&SIGROW.SERNUM0, 10);
#elif defined(__AVR__)
    uint32_t *const kept = (uint32_t *)(E2END - 3);
    uint32_t seed = eeprom_read_dword(kept);
    if (seed == 0 || seed == 0xffffffffu) {
        seed = ofNoise(pin);
        eeprom_write_dword(kept, seed);
    }
    return seed;
#else
    return ofNoise(pin);
#endif
}
} // namespace EerufSeed

// The board's seed; `pin` is an unconnected analog pin.
inline uint32_t eerufSeed(uint8_t pin = A0) {
    const uint32_t seed = EerufSeed::drawn(pin);
    return seed == 0 ? 1 : seed;
}

// The part of Arduino's cores that the library and its examples use, for a compiler of this machine: what each of them
// declares differently, as its own headers have it. ARDUINO_ARCH_.. says which one.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(ARDUINO_ARCH_ESP8266) || defined(ARDUINO_ARCH_ESP32)
// Numbers. ESP32: HIGH 1, INPUT 1, OUTPUT 3 or 2; both -1 for no interrupt.
typedef uint8_t pin_size_t, PinStatus, PinMode;
typedef int ReadStatus, InterruptMode;
#define LOW 0x0
#define HIGH 0x1
#define CHANGE 0x03
#define INPUT 0x01
#define OUTPUT 0x03
#define NOT_AN_INTERRUPT -1
#define digitalPinToInterrupt(p) (((p) < 16) ? (p) : NOT_AN_INTERRUPT)
#else
// ArduinoCore-API: a bool is no PinStatus.
typedef uint8_t pin_size_t;
typedef enum { LOW = 0, HIGH = 1, CHANGE = 2, FALLING = 3, RISING = 4 } PinStatus;
typedef enum { INPUT = 0x0, OUTPUT = 0x1, INPUT_PULLUP = 0x2 } PinMode;
typedef PinStatus ReadStatus, InterruptMode;
#endif

#if defined(ARDUINO_ARCH_MEGAAVR)
// An AVR whose ports have no tables, and whose vectors have other names.
#define __AVR__
#define NOT_AN_INTERRUPT 255
#define digitalPinToInterrupt(P) (P)
#define digitalPinToPort(pin) (pin)
#define portModeRegister(P) ((volatile uint8_t *)0)
#define F_CPU 16000000L
#elif defined(ARDUINO_ARCH_SAMD)
typedef enum { NOT_AN_INTERRUPT = -1, EXTERNAL_INT_0 = 0, EXTERNAL_INT_NMI = 16 } EExt_Interrupts;
typedef struct {
    EExt_Interrupts ulExtInt;
} PinDescription;
#ifdef __cplusplus
extern "C" const PinDescription g_APinDescription[];
#endif
#define digitalPinToInterrupt(P) (P)
#elif defined(ARDUINO_ARCH_RENESAS_UNO)
// Without NOT_AN_INTERRUPT.
#define ARDUINO_ARCH_RENESAS
typedef enum { PIN_CFG_REQ_INTERRUPT } PinCfgReq_t;
#ifdef __cplusplus
#include <array>
std::array<uint16_t, 3> getPinCfgs(const pin_size_t pin, PinCfgReq_t req);
pin_size_t digitalPinToInterrupt(pin_size_t pin);
#endif
#elif defined(ARDUINO_ARCH_RP2040)
#define NOT_AN_INTERRUPT (-1)
#define digitalPinToInterrupt(pin) (pin)
#endif

enum { A0 = 14, A1, A2, A3 };
#define F(text) (text)
#define bit(b) (1UL << (b))
#if defined(ARDUINO_ARCH_RP2040) && defined(__cplusplus)
extern "C" void interrupts();
extern "C" void noInterrupts();
#else
#define interrupts() ((void)0)
#define noInterrupts() ((void)0)
#endif

#ifdef __cplusplus
extern "C" {
void pinMode(pin_size_t pin, PinMode mode);
void digitalWrite(pin_size_t pin, PinStatus value);
ReadStatus digitalRead(pin_size_t pin);
int analogRead(pin_size_t pin);
void attachInterrupt(pin_size_t pin, void (*callback)(void), InterruptMode mode);
unsigned long millis(void);
unsigned long micros(void);
void delay(unsigned long ms);
void delayMicroseconds(unsigned int us);
}

template <typename A, typename B> auto min(A a, B b) -> decltype(a < b ? a : b);

class Print {
public:
    size_t write(uint8_t byte);
    size_t write(const uint8_t *bytes, size_t count);
    template <typename What> size_t print(What what);
    template <typename What = const char *> size_t println(What what = What());
};
class HardwareSerial : public Print {
public:
    void begin(unsigned long baud);
    int availableForWrite();
    int available();
    int read();
};
extern HardwareSerial Serial;
#endif

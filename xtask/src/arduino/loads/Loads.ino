// A flow ring whose loop() has other work, as described in the EEPROM: its duration, the time from one start to the next
// (or in each turn), and whether it masks interrupts or waits until no line is awaited.
#if POLLED
#define EERUF_POLLED
#endif
#include <EerufFlow.h>
#include <avr/eeprom.h>
#include "ring.h"

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9};
const uint8_t (&OURS)[MODULES] = *(const uint8_t (*)[MODULES])PINS;
EerufFlow<MODULES> sonar(OURS);
const EerufHcSr04Settings modules = RING_MODULES;

struct {
  uint32_t us, everyUs, baud;
  bool masks, waits;
} work;

void setup() {
  eeprom_read_block(&work, 0, sizeof work);
  Serial.begin(work.baud);
  sonar.begin(RING, modules);
}

void doWork() {
  static uint32_t next;
  const uint32_t began = micros();
  if (work.us == 0 || (int32_t)(began - next) < 0) return;
  if (work.waits && sonar.quietFor() < work.us + 50) return;
  next = began + work.everyUs;
  if (work.masks) {
    noInterrupts();
    // delayMicroseconds() counts cycles.
    for (uint32_t left = work.us; left > 0; left -= 100) delayMicroseconds(100);
    interrupts();
  } else if (work.everyUs == 0) {
    delay(work.us / 1000);
  } else {
    while (micros() - began + 1 <= work.us) continue;
  }
}

void loop() {
  doWork();
#if POLLED
  // The robot stands, and says so: edges seen late, and walls that may come nearer, would let foreign sound in.
  static uint32_t told;
  if (millis() - told >= 200) {
    told = millis();
    sonar.moving(0);
  }
#endif
  if (sonar.tooSlow()) {
    Serial.print(F("slow "));
    Serial.println(millis());
  }
  if (sonar.read() && sonar.accepted()) {
    Serial.print(sonar.sensor() + 1);
    Serial.print(' ');
    Serial.println(sonar.millimetres());
  }
}

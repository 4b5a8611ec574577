// Six HC-SR04 modules on pins 2 to 7 that fire by flow, and a strip of 30 LEDs on pin 8 that shows the nearest
// obstacle. LED libraries call noInterrupts() for 0.9 ms, in which no echo can be timed, so the strip is written while
// no echo is awaited. In the open one is always awaited, so every half second the modules pause for the strip.
// One read() takes up to 1.6 ms on an Uno.
#include <EerufFlow.h>

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7};
EerufFlow<6> sonar(PINS);
const uint8_t STRIP = 8;
const uint16_t STRIP_US = 950;
uint16_t nearest = 0xffff;
uint32_t written;

// Stands for strip.show().
void show() {
  noInterrupts();
  digitalWrite(STRIP, nearest < 500 ? HIGH : LOW);
  delayMicroseconds(900);
  interrupts();
  written = millis();
  nearest = 0xffff;
}

void setup() {
  Serial.begin(115200);
  pinMode(STRIP, OUTPUT);
  if (!sonar.begin()) Serial.println(sonar.status());
}

void loop() {
  const uint32_t age = millis() - written;
  if (age > 500) sonar.pause();
  if (age > 50 && sonar.quietFor() > STRIP_US) {
    show();
    if (age > 500) sonar.pause(false);
  }
  if (!sonar.read() || !sonar.accepted()) return;
  nearest = min(nearest, sonar.millimetres());
  Serial.print(sonar.sensor() + 1);
  Serial.print(' ');
  Serial.println(sonar.millimetres());
}

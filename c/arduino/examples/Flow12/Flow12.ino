// Twelve HC-SR04 modules around a robot, each with trigger and echo on one pin of the Uno (2 to 13), that fire by flow:
// one after the other, each with as much quiet around its firing as it has needed. There is no table to design. For
// each accepted echo it prints the module's number and the distance in millimetres. One read() takes up to 1.1 ms on an
// Uno.
#include <EerufFlow.h>

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
EerufFlow<12> sonar(PINS);

void setup() {
  Serial.begin(115200);
  if (!sonar.begin()) Serial.println(sonar.status());
}

void loop() {
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow"));
  if (sonar.read() && sonar.accepted()) {
    Serial.print(sonar.sensor() + 1);
    Serial.print(' ');
    Serial.println(sonar.millimetres());
  }
}

// Twelve HC-SR04 modules around a robot, each with trigger and echo on one pin of the Uno (2 to 13).
// Prints the module's number and the distance in millimetres of each echo that counts.
// One read() takes up to 1.4 ms on an Uno.
#include <EerufTables.h>

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
EerufSonar<12> sonar(EERUF_HC_SR04_12, PINS);

void setup() {
  Serial.begin(115200);
  if (!sonar.begin()) Serial.println(F("wrong table"));
}

void loop() {
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow"));
  if (sonar.read() && sonar.accepted()) {
    Serial.print(sonar.sensor() + 1);
    Serial.print(' ');
    Serial.println(sonar.millimetres());
  }
}

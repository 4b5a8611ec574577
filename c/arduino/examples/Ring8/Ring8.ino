// Eight HC-SR04 modules around a robot with two pins each: triggers on 2 to 9, echoes on 10 to 13 and A0 to A3. Prints
// the outcome of each firing, and which modules do not answer. One read() takes up to 0.8 ms on an Uno.
#include <EerufTables.h>

const uint8_t TRIGGERS[] = {2, 3, 4, 5, 6, 7, 8, 9};
const uint8_t ECHOES[] = {10, 11, 12, 13, A0, A1, A2, A3};
EerufSonar<8> sonar(EERUF_HC_SR04_8, TRIGGERS, ECHOES);

void setup() {
  Serial.begin(115200);
  if (!sonar.begin()) {
    Serial.print(F("table refused: "));
    Serial.println(sonar.status());
  }
}

void loop() {
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow"));
  if (!sonar.read()) return;
  Serial.print(sonar.sensor() + 1);
  if (sonar.accepted()) {
    Serial.print(' ');
    Serial.println(sonar.millimetres());
  } else if (sonar.clear()) {
    Serial.println(F(" clear"));
  } else if (sonar.health(sonar.sensor()) != EERUF_HEALTH_WELL) {
    Serial.println(F(" does not answer"));
  } else {
    Serial.println(F(" unsure"));
  }
}

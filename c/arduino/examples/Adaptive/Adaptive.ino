// Eight HC-SR04 modules with one pin each (2 to 9), fired more slowly where too many readings are rejected, and faster
// again when it is calm: one of three tables, looked at again every 16 periods.
// One read() takes up to 0.8 ms on an Uno.
#include <EerufTables.h>

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9};
const EerufSchedule *const LADDER[] = {&EERUF_HC_SR04_8, &EERUF_HC_SR04_8_SLOWER, &EERUF_HC_SR04_8_SLOWEST};
EerufSonar<8> sonar(EERUF_HC_SR04_8, PINS);
EerufAdaptation adaptation;
uint8_t rung;

void setup() {
  Serial.begin(115200);
  eeruf_adaptation_init(&adaptation, sizeof adaptation, LADDER, 3);
  sonar.adapt(adaptation);
  sonar.begin();
}

void loop() {
  if (adaptation.rung != rung) {
    rung = adaptation.rung;
    Serial.print(F("now by table "));
    Serial.println(rung + 1);
  }
  if (sonar.read() && sonar.accepted()) {
    Serial.print(sonar.sensor() + 1);
    Serial.print(' ');
    Serial.println(sonar.millimetres());
  }
}

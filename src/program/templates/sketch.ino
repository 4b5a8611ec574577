#include "src/eeruf/EerufFlow.h"  //@flow
#include "src/eeruf/EerufSeed.h"  //@flow
#include "src/eeruf/EerufArduino.h"  //@table
#include "ring.h"

@pins@
EerufFlow<@sensors@> sonar(@given@);  //@flow
EerufSonar<@sensors@> sonar(RING, @given@);  //@table
static const EerufHcSr04Settings MODULES = RING_MODULES;

void setup() {
  Serial.begin(115200);
  EerufFlowConfig ring = RING;  //@flow
  ring.seed = eerufSeed(@noise@);  //@flow
  Serial.print(F("seed "));  //@flow
  Serial.println(ring.seed);  //@flow
  if (!sonar.begin(ring, MODULES)) {  //@flow
  if (!sonar.begin(MODULES)) {  //@table
    Serial.print(F("begin: status "));
    Serial.println(sonar.status());
  }
}

void loop() {
  // A robot that knows how it moves says so once a control cycle, in mm/s and mrad/s; else the ring file's speed counts:  //@flow
  // sonar.moving(speed, turn);  //@flow
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow: modules are not heard"));
  // A line that does not fit into the port's buffer would hold loop() up.
  if (!sonar.read() || Serial.availableForWrite() < 14) return;
  if (!sonar.accepted() && !sonar.clear()) return;
  Serial.print(sonar.sensor() + 1);
  Serial.print(' ');
  if (sonar.clear()) {
    Serial.println(F("free"));
  } else {
    Serial.println(sonar.millimetres());
  }
}

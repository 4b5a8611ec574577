#include "src/eeruf/EerufArduino.h"
#include "ring.h"

@pins@
EerufSonar<@sensors@> sonar(RING, @given@);
static const EerufHcSr04Settings MODULES = RING_MODULES;

void setup() {
  Serial.begin(115200);
  if (!sonar.begin(MODULES)) {
    Serial.print(F("begin: status "));
    Serial.println(sonar.status());
  }
}

void loop() {
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

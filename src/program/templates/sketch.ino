#include "src/eeruf/EerufFlow.h"  //@flow
#include "src/eeruf/EerufSeed.h"  //@flow
#include "src/eeruf/EerufArduino.h"  //@table
#include "src/eeruf/eeruf_mavlink.h"  //@mavlink
#include "ring.h"

@pins@
EerufFlow<@sensors@> sonar(@given@);  //@flow
EerufSonar<@sensors@> sonar(RING, @given@);  //@table
static const EerufHcSr04Settings MODULES = RING_MODULES;
EerufStates<@sensors@> states;  //@mavlink
static const EerufMavlinkPlace PLACES[] = {@places@};  //@mavlink
EerufMavlink autopilot = EERUF_MAVLINK(PLACES, @sensors@, @half_view_deg@, @min_cm@, @max_cm@);  //@mavlink

void setup() {
  @line@.begin(115200);
  EerufFlowConfig ring = RING;  //@flow
  ring.seed = eerufSeed(@noise@);  //@flow
  Serial.print(F("seed "));  //@flow //@print
  Serial.println(ring.seed);  //@flow //@print
  if (!sonar.begin(ring, MODULES)) {  //@flow //@print
  if (!sonar.begin(MODULES)) {  //@table //@print
    Serial.print(F("begin: status "));  //@print
    Serial.println(sonar.status());  //@print
  }  //@print
  sonar.begin(ring, MODULES);  //@flow //@mavlink
  sonar.begin(MODULES);  //@table //@mavlink
  sonar.watch(states);  //@mavlink
}

void loop() {
  // A robot that knows how it moves says so once a control cycle, in mm/s and mrad/s; else the ring file's speed counts:  //@flow
  // sonar.moving(speed, turn);  //@flow
  sonar.read();  //@mavlink
  while (@line@.available()) eeruf_mavlink_hear(&autopilot, @line@.read());  //@mavlink
  // Bytes that do not fit into the port's buffer would hold loop() up.  //@mavlink
  const uint8_t *bytes;  //@mavlink
  const size_t room = @line@.availableForWrite();  //@mavlink
  const size_t size = eeruf_mavlink_take(&autopilot, &states, EerufLines::now(), room, &bytes);  //@mavlink
  @line@.write(bytes, size);  //@mavlink
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow: modules are not heard"));  //@print
  // A line that does not fit into the port's buffer would hold loop() up.  //@print
  if (!sonar.read() || Serial.availableForWrite() < 14) return;  //@print
  if (!sonar.accepted() && !sonar.clear()) return;  //@print
  Serial.print(sonar.sensor() + 1);  //@print
  Serial.print(' ');  //@print
  if (sonar.clear()) {  //@print
    Serial.println(F("free"));  //@print
  } else {  //@print
    Serial.println(sonar.millimetres());  //@print
  }  //@print
}

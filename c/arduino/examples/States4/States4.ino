// Four HC-SR04 modules with trigger and echo on one pin each, 2 to 5, for a robot that checks its surroundings now and
// then: twenty times a second it prints what is in front of each module, since when, or why nothing is known.
// One read() takes up to 0.7 ms on an Uno.
#include <EerufTables.h>

const uint8_t PINS[] = {2, 3, 4, 5};
EerufSonar<4> sonar(EERUF_HC_SR04_4, PINS);
EerufStates<4> states;
uint32_t said;

void setup() {
  Serial.begin(115200);
  if (!sonar.begin()) Serial.println(F("wrong table"));
  sonar.watch(states);
}

// Slow down for what is not known; only EERUF_STATE_CLEAR is free space.
void say(uint8_t sensor) {
  const EerufState state = sonar.state(sensor);
  Serial.print(sensor + 1);
  if (state.kind == EERUF_STATE_OBSTACLE) {
    Serial.print(' ');
    Serial.println(eeruf_distance_mm(state.t_echo_us, EERUF_SOUND_20C));
  } else if (state.kind == EERUF_STATE_CLEAR) {
    Serial.println(F(" clear"));
  } else if (state.kind == EERUF_STATE_UNANSWERED) {
    Serial.print(F(" has not answered for ms: "));
    Serial.println(state.age_us / 1000);
  } else {
    Serial.println(state.why == EERUF_WHY_AMBIGUOUS ? F(" hears another module") : F(" unsure"));
  }
}

void loop() {
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow"));
  sonar.read();
  // One module at a time: a line of text takes longer than a firing may be late.
  static uint8_t sensor;
  if (micros() - said < 12500) return;
  said = micros();
  say(sensor);
  sensor = sensor < 3 ? sensor + 1 : 0;
}

// A log of a real ring, to compare with the simulator: eight HC-SR04 modules, each with trigger and echo on one pin of
// the Uno (2 to 9), that fire one by one, by flow, and as sketches do (wait for the echo, then 10 ms), each for 150
// seconds. Prints a row for each firing: sensor, time in microseconds, period, phase, echo time (none: nothing heard),
// way. docs/how-to/real-log.md says what else to measure. One read() takes up to 0.8 ms on an Uno.
#include <EerufFlow.h>

#ifndef SECONDS
#define SECONDS 150
#endif
const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9};
const uint8_t MODULES = sizeof PINS;
EerufFlow<MODULES> sonar(PINS);
enum Way : uint8_t { SEQUENTIAL, FLOW, BLOCKING, WAYS } way = BLOCKING;
uint32_t firedUs[MODULES], begunMs, period = 0;
uint8_t next = 0; // the next module to wait for

void row(uint8_t sensor, uint32_t us, uint32_t echo) {
  Serial.print(sensor);
  Serial.print(',');
  Serial.print(us);
  Serial.print(',');
  Serial.print(period);
  Serial.print(F(",0,"));
  if (echo > 0) Serial.print(echo);
  Serial.println(way == FLOW ? F(",flow") : way == SEQUENTIAL ? F(",sequential") : F(",blocking"));
}

void tell(EerufModules &, const EerufEvent &event, uint32_t now) {
  if (event.kind == EERUF_EVENT_FIRE) {
    firedUs[event.sensor] = now;
  } else if (event.kind == EERUF_EVENT_READING) {
    const uint32_t echo = event.u.reading.t_echo_us;
    row(event.sensor, firedUs[event.sensor], echo == EERUF_NO_ECHO ? 0 : echo);
    period += event.sensor == MODULES - 1;
  }
}

void begin(Way chosen) {
  way = chosen;
  begunMs = millis();
  EerufFlowConfig config = EERUF_FLOW(MODULES, 24000);
  if (way == SEQUENTIAL) config.least_us = config.most_us;
  static const EerufHcSr04Settings modules = EERUF_HC_SR04;
  if (way != BLOCKING && !sonar.begin(config, modules)) Serial.println(sonar.status());
  sonar.tell(tell);
}

// Fires as most sketches do: like pulseIn().
void wait(uint8_t sensor) {
  const uint8_t pin = PINS[sensor];
  EerufPin::trigger(pin, pin);
  const uint32_t us = micros();
  while (digitalRead(pin) == LOW && micros() - us < 2000) {}
  const uint32_t rose = micros();
  while (digitalRead(pin) == HIGH && micros() - rose < 45000) {}
  const uint32_t echo = micros() - rose;
  row(sensor, us, echo > 24000 ? 0 : echo);
  period += sensor == MODULES - 1;
  delay(10);
}

void setup() {
  Serial.begin(115200);
  Serial.println(F("sensor,fired_us,period,phase,t_echo_us,way"));
  begin(SEQUENTIAL);
}

void loop() {
  if (way == BLOCKING) {
    wait(next);
    next = (next + 1) % MODULES;
  } else {
    sonar.read();
  }
  if (millis() - begunMs >= SECONDS * 1000ul) begin(Way((way + 1) % WAYS));
}

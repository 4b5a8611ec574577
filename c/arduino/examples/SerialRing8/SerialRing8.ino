// Eight HC-SR04 modules whose firings go to a computer as frames, for `eeruf-ros2 --port` and `eeruf diagnose`.
// Modules as in Ring8. A frame has 28 bytes: at 500,000 baud, which an Uno makes exactly, it delays nothing.
// One read() takes up to 0.5 ms on an Uno.
#include <EerufTables.h>
#include <eeruf_serial.h>

const uint8_t TRIGGERS[] = {2, 3, 4, 5, 6, 7, 8, 9};
const uint8_t ECHOES[] = {10, 11, 12, 13, A0, A1, A2, A3};
EerufSonar<8> sonar(EERUF_HC_SR04_8, TRIGGERS, ECHOES);

uint16_t late[8];
EerufSerial line = EERUF_SERIAL(late, 8, "uno");

// What has happened and is not yet said: a frame takes some time, in which nothing is fired and no line is looked at.
const uint8_t PLACES = 8;
EerufEvent waiting[PLACES];
uint32_t polled[PLACES];
uint8_t first, count;

void say(EerufModules &modules, const EerufEvent &event, uint32_t now) {
  uint8_t frame[EERUF_FRAME];
  Serial.write(frame, eeruf_serial_event(&line, &modules.ring(), &modules.modules(), &event, now, frame));
}

void keep(EerufModules &modules, const EerufEvent &event, uint32_t now) {
  if (event.kind == EERUF_EVENT_FIRE) {
    say(modules, event, now); // only notes when
  } else if (count < PLACES) {
    waiting[(first + count) % PLACES] = event;
    polled[(first + count) % PLACES] = now;
    count++;
  }
}

void setup() {
  Serial.begin(500000);
  sonar.tell(keep);
  sonar.begin();
}

void loop() {
  sonar.read();
  const bool soon = (int32_t)(eeruf_ring_deadline(&sonar.ring()) - micros()) < 2000;
  if (count == 0 || soon || Serial.availableForWrite() < 40) return;
  say(sonar, waiting[first], polled[first]);
  first = (first + 1) % PLACES;
  count--;
}

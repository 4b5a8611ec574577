// Eight HC-SR04 modules whose firings go to a computer as frames, for `eeruf-ros2 --port` and `eeruf diagnose`.
// Pins as in Ring8; by flow. A frame has 28 bytes: 500,000 baud, which an Uno makes exactly, are enough for all.
#include <EerufFlow.h>
#include <eeruf_serial.h>

const uint8_t TRIGGERS[] = {2, 3, 4, 5, 6, 7, 8, 9};
const uint8_t ECHOES[] = {10, 11, 12, 13, A0, A1, A2, A3};
EerufFlow<8> sonar(TRIGGERS, ECHOES);

uint16_t late[8];
EerufSerial line = EERUF_SERIAL(late, 8, "uno");

void say(EerufModules &modules, const EerufEvent &event, uint32_t now) {
  uint8_t frame[EERUF_FRAME];
  Serial.write(frame, eeruf_serial_event(&line, &modules.ring(), &modules.modules(), &event, now, frame));
}

void setup() {
  Serial.begin(500000);
  sonar.tell(say);
  sonar.begin();
}

void loop() { sonar.read(); }

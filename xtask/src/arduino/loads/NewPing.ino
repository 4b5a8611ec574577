// A ring with NewPing's own means: one module after the other, waiting for each echo, with a pause of WAIT_MS between them.
#include <NewPing.h>

const uint16_t MOST_CM = 400;
NewPing sonar[MODULES] = {
  NewPing(2, 2, MOST_CM), NewPing(3, 3, MOST_CM), NewPing(4, 4, MOST_CM), NewPing(5, 5, MOST_CM),
  NewPing(6, 6, MOST_CM), NewPing(7, 7, MOST_CM),
#if MODULES > 6
  NewPing(8, 8, MOST_CM), NewPing(9, 9, MOST_CM),
#endif
};

void say(uint8_t module, uint32_t us) {
  if (us == 0) return;
  Serial.print(module + 1);
  Serial.print(' ');
  Serial.println((us * 42900 + 125000) / 250000);  // at 343.2 m/s, as for the others
}

void setup() { Serial.begin(115200); }

void loop() {
  for (uint8_t i = 0; i < MODULES; i++) {
    delay(WAIT_MS);
    say(i, sonar[i].ping());
  }
}

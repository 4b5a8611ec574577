// A ring with NewPing's own means: one module every 33 ms, timed by its interrupts, as its documents recommend; or with
// WAIT_MS one module after the other, waiting for each echo, with a pause of this length between them.
#include <NewPing.h>

const uint16_t INTERVAL_MS = 33, MOST_CM = 400;
NewPing sonar[MODULES] = {
  NewPing(2, 2, MOST_CM), NewPing(3, 3, MOST_CM), NewPing(4, 4, MOST_CM), NewPing(5, 5, MOST_CM),
  NewPing(6, 6, MOST_CM), NewPing(7, 7, MOST_CM),
#if MODULES > 6
  NewPing(8, 8, MOST_CM), NewPing(9, 9, MOST_CM),
#endif
#if MODULES > 8
  NewPing(10, 10, MOST_CM), NewPing(11, 11, MOST_CM), NewPing(12, 12, MOST_CM), NewPing(13, 13, MOST_CM),
#endif
};

void say(uint8_t module, uint32_t us) {
  if (us == 0) return;
  Serial.print(module + 1);
  Serial.print(' ');
  Serial.println((us * 42900 + 125000) / 250000);  // at 343.2 m/s, as for the others
}

#ifdef WAIT_MS
void setup() { Serial.begin(115200); }

void loop() {
  for (uint8_t i = 0; i < MODULES; i++) {
    delay(WAIT_MS);
    say(i, sonar[i].ping());
  }
}
#else
uint8_t now = MODULES - 1;
volatile uint32_t echo;  // in microseconds, 0: none
uint32_t due;

void check() {
  if (sonar[now].check_timer()) echo = sonar[now].ping_result;
}

void setup() {
  Serial.begin(115200);
  due = millis() + 75;
}

void loop() {
  if ((int32_t)(millis() - due) < 0) return;
  due += INTERVAL_MS;
  sonar[now].timer_stop();
  say(now, echo);
  echo = 0;
  now = now + 1 < MODULES ? now + 1 : 0;
  sonar[now].ping_timer(check);
}
#endif

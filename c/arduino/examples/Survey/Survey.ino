// A measuring run of up to sixteen HC-SR04 modules with one pin each: it finds which of them hear each other, and after
// what time. Each fires alone, then each ordered pair with twenty leads. Prints a log for `eeruf survey`, like
// eeruf_core::Survey; four modules take half a minute, eight take two minutes.
#define EERUF_POLLED // no interrupts
#include <EerufArduino.h>

const uint8_t PINS[] = {2, 3, 4, 5};
const uint8_t MODULES = sizeof PINS;
const uint8_t SOLOS = 3, LEADS = 20;
const uint16_t LEAD_US = 750;      // from one lead to the next
const uint16_t WINDOW_US = 40000;  // a module without echo holds its line for 38 ms
const uint16_t NO_ECHO_US = 30000;
const uint16_t QUIET_US = 57000;   // sound travels for this long

enum State : uint8_t { WAITS, TRIGGERED, LISTENS, OVER };
struct Line {
  uint8_t module;
  State state;
  uint32_t after, rose, fell;
};

uint16_t slot = 0;

// The sound leaves when the line rises; the line falls with the first sound that arrives.
void look(Line &line, uint32_t begun) {
  const uint8_t pin = PINS[line.module];
  if (line.state == WAITS && micros() - begun >= line.after) EerufPin::trigger(pin, pin);
  else if (line.state == TRIGGERED && EerufPin::isHigh(pin)) line.rose = micros();
  else if (line.state == LISTENS && !EerufPin::isHigh(pin)) line.fell = micros();
  else return;
  line.state = State(line.state + 1);
}

// Prints the module from 0, the time of its firing, the slot, and the echo time if there was an echo.
void print(const Line &line) {
  if (line.state < LISTENS) return;
  Serial.print(line.module);
  Serial.print(',');
  Serial.print(line.rose);
  Serial.print(',');
  Serial.print(slot);
  Serial.print(F(",0,"));
  const uint32_t echo = line.fell - line.rose;
  if (line.state == OVER && echo < NO_ECHO_US) Serial.print(echo);
  Serial.println();
}

void fire(uint8_t first, uint8_t second, uint32_t lead) {
  Line lines[2] = {{first, WAITS, 0, 0, 0}, {second, WAITS, lead, 0, 0}};
  const uint8_t count = first == second ? 1 : 2;
  const uint32_t begun = micros();
  while (micros() - begun < lead + WINDOW_US)
    for (uint8_t i = 0; i < count; i++) look(lines[i], begun);
  for (uint8_t i = 0; i < count; i++) print(lines[i]);
  while (micros() - begun < (uint32_t)LEAD_US * (LEADS - 1) + WINDOW_US + QUIET_US) {}
  slot++;
}

void setup() {
  Serial.begin(115200);
  Serial.println(F("# clock: micros() of the board, 32 bits"));
  Serial.println(F("sensor,fired_us,period,phase,t_echo_us"));
  for (uint8_t solo = 0; solo < SOLOS; solo++)
    for (uint8_t x = 0; x < MODULES; x++) fire(x, x, 0);
  for (uint8_t lead = 0; lead < LEADS; lead++)
    for (uint8_t x = 0; x < MODULES; x++)
      for (uint8_t y = 0; y < MODULES; y++)
        if (x != y) fire(x, y, (uint32_t)lead * LEAD_US);
  Serial.println(F("# over"));
}

void loop() {}

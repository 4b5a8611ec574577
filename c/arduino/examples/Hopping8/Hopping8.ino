// Eight HC-SR04 modules with one pin each (2 to 9) that hop in time: firing times move through a cycle of ten
// phases, and a module that hears nothing of its own gets a period alone, so that none stays blind. It takes twice the
// memory. Written with the functions of eeruf.h, as a program without Arduino would be.
#include <EerufArduino.h>

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9};
EerufHoppingRing ring;
EerufHopSensor sensors[8];
EerufHopper hoppers[8];
EerufHcSr04 modules;
EerufLine lines[8];
const EerufHcSr04Settings settings = EERUF_HC_SR04;
// Evenly over the period, neighbours 21 ms apart, and none at its beginning, when the ring is busy with its plan: what
// is heard moves as it should only if firings differ by less than 45 us in lateness.
const uint32_t LAGS_US[] = {2000, 23000, 44000, 65000, 12500, 33500, 54500, 75500};

void setup() {
  // Eight modules, a period of 90 ms, and 60 ms in which each rests.
  EerufHoppingConfig config = EERUF_HOPPING_BALANCED(8, 90000, 60000);
  config.lag_us = LAGS_US;
  Serial.begin(115200);
  int8_t status =
    eeruf_hopping_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers, &config, micros());
  if (status == EERUF_OK)
    status = eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, &ring.ring, &settings);
  if (status != EERUF_OK) Serial.println(status);
}

// Looks at the lines until something is due. An edge came at some time since the look before: half way.
void sample() {
  static uint32_t looked;
  const uint32_t due = eeruf_ring_due(&ring.ring), now = micros(), halfway = now - (now - looked) / 2;
  bool wasHigh;
  for (uint8_t i = 0; i < 8 && (int32_t)(micros() - due) < 0; i++) {
    if (!eeruf_hc_sr04_awaits(&modules, i, &wasHigh)) continue;
    if (EerufPin::isHigh(PINS[i]) != wasHigh) eeruf_hc_sr04_edge(&modules, i, !wasHigh, halfway);
  }
  looked = now;
}

void fire(uint8_t i) {
  if (eeruf_hc_sr04_fire(&modules, i, EerufPin::isHigh(PINS[i])) == EERUF_OK) EerufPin::trigger(PINS[i], PINS[i]);
}

void loop() {
  EerufEvent event;
  uint32_t now;
  do {
    sample();
    now = micros();
  } while (eeruf_ring_due(&ring.ring) - now - 1 < 600);  // a reading takes as long, and must not make a firing late
  if (eeruf_hopping_poll(&ring, now, NULL, &event) != EERUF_EVENT) return;
  if (event.kind == EERUF_EVENT_FIRE) fire(event.sensor);
  if (event.kind == EERUF_EVENT_READING && event.u.reading.kind == EERUF_READING_ACCEPTED) {
    sample();  // edges are as exact as looks are frequent
    Serial.print(event.sensor + 1);
    Serial.print(' ');
    Serial.println(event.u.reading.t_echo_us * 1716 / 10000);  // half of 343.2 m/s; eeruf_distance_mm takes any
  }
}

// Twelve HC-SR04 modules around a robot, each with trigger and echo on one pin of the Uno (2 to 13), that fire by flow:
// one after the other, each with as much quiet around its firing as it has needed. There is no table to design. Prints
// the module's number and the distance in millimetres of each echo that counts. Written with the functions of eeruf.h,
// as a program without Arduino would be.
#include <EerufArduino.h>
#include <EerufInterrupts.h>

const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
EerufHoppingRing ring;
EerufHopSensor sensors[12];
EerufHopper hoppers[12];
EerufHcSr04 modules;
EerufLine lines[12];
const EerufHcSr04Settings settings = EERUF_HC_SR04;

// What the interrupts ask for.
struct Lines {
  uint8_t count() const { return 12; }
  uint8_t echoPin(uint8_t i) const { return PINS[i]; }
  void use(EerufEdges &queue) { edges = &queue; }
  EerufEdges *edges;
} echoes;

void setup() {
  EerufFlowConfig config = EERUF_FLOW(12, 37000);  // their longest echo and a millisecond
  config.rest_us = 60000;                          // for which each rests between two triggers
  config.lead_us = 4000;                           // the next cycle is planned so long before it begins
  Serial.begin(115200);
  for (uint8_t i = 0; i < 12; i++) EerufPin::release(PINS[i], PINS[i]);
  int8_t status =
    eeruf_flow_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers, &config, micros());
  if (status == EERUF_OK)
    status = eeruf_hc_sr04_init(&modules, sizeof modules, lines, sizeof lines, &ring.ring, &settings);
  if (status != EERUF_OK || !eerufInterrupts(echoes)) Serial.println(status);
}

void fire(uint8_t i) {
  if (eeruf_hc_sr04_fire(&modules, i, EerufPin::isHigh(PINS[i])) == EERUF_OK) EerufPin::trigger(PINS[i], PINS[i]);
}

void loop() {
  EerufEvent event;
  uint32_t now;
  do {
    now = micros();
    (void)eeruf_hc_sr04_edges(&modules, echoes.edges);
  } while (eeruf_ring_due(&ring.ring) - now - 1 < 1000);  // a reading must not make a firing late
  if (eeruf_hopping_poll(&ring, now, NULL, &event) != EERUF_EVENT) return;
  if (event.kind == EERUF_EVENT_FIRE) fire(event.sensor);
  if (event.kind == EERUF_EVENT_READING && event.u.reading.kind == EERUF_READING_ACCEPTED) {
    Serial.print(event.sensor + 1);
    Serial.print(' ');
    Serial.println(event.u.reading.t_echo_us * 1716 / 10000);  // half of 343.2 m/s; eeruf_distance_mm takes any
  }
}

// Four modules, each with an interrupt of its own that reports the level of its line. Prints the state in front of a
// module at each of its readings. `cargo xtask arduino` puts the table LINE_FAULTS of tests/data/line-faults.txt before
// it; with FORGOTTEN, module 2's interrupt is not attached.
const uint8_t TRIGGERS[] = {4, 5, 6, 7};
const uint8_t ECHOES[] = {8, 2, A0, 3};
EerufSonar<4> sonar(LINE_FAULTS, TRIGGERS, ECHOES);
EerufStates<4> states;
EerufEdge places[32];
EerufEdges edges;

template <uint8_t sensor> void onEdge() {
  eeruf_edges_push(&edges, sensor, EerufPin::isHigh(ECHOES[sensor]), micros());
}
ISR(PCINT0_vect) { onEdge<0>(); }
ISR(PCINT1_vect) { onEdge<2>(); }

void setup() {
  Serial.begin(115200);
  eeruf_edges_init(&edges, sizeof edges, places, sizeof places);
  sonar.use(edges);
  sonar.watch(states);
  if (!sonar.begin()) Serial.println(F("wrong table"));
#ifndef FORGOTTEN
  attachInterrupt(digitalPinToInterrupt(2), onEdge<1>, CHANGE);
#endif
  attachInterrupt(digitalPinToInterrupt(3), onEdge<3>, CHANGE);
  PCMSK0 = bit(PCINT0);
  PCMSK1 = bit(PCINT8);
  PCICR = bit(PCIE0) | bit(PCIE1);
}

void loop() {
  if (!sonar.read()) return;
  const EerufState state = sonar.state(sonar.sensor());
  Serial.print(sonar.sensor() + 1);
  Serial.print(' ');
  if (state.kind == EERUF_STATE_OBSTACLE) Serial.println(eeruf_distance_mm(state.t_echo_us, EERUF_SOUND_20C));
  else Serial.println(eeruf_state_name(state.kind));
}

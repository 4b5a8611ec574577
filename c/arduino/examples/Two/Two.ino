// Two HC-SR04 modules side by side: triggers on 4 and 5, echoes on 2 and 3, whose interrupts time the echoes to some
// microseconds while loop() does other things for 0.3 ms. The longer that takes the later modules fire, and the more
// readings the other module's sound could explain.
// One read() takes up to 0.5 ms on an Uno.
#include <EerufTables.h>

const uint8_t TRIGGERS[] = {4, 5};
const uint8_t ECHOES[] = {2, 3};
EerufSonar<2> sonar(EERUF_HC_SR04_2, TRIGGERS, ECHOES);
EerufEdge places[16];
EerufEdges edges;

void onEdge0() { eeruf_edges_push(&edges, 0, digitalRead(2), micros()); }
void onEdge1() { eeruf_edges_push(&edges, 1, digitalRead(3), micros()); }

void setup() {
  Serial.begin(115200);
  eeruf_edges_init(&edges, sizeof edges, places, sizeof places);
  sonar.use(edges);
  sonar.begin();
  attachInterrupt(digitalPinToInterrupt(2), onEdge0, CHANGE);
  attachInterrupt(digitalPinToInterrupt(3), onEdge1, CHANGE);
}

void loop() {
  if (sonar.tooSlow()) Serial.println(F("loop() is too slow: modules fire late"));
  if (sonar.read() && sonar.accepted()) {
    Serial.print(sonar.sensor() + 1);
    Serial.print(' ');
    Serial.println(sonar.millimetres());
  }
  delayMicroseconds(300);  // something else
}

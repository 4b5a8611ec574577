// A sketch for three HC-SR04 modules with one pin each that used NewPing. The old code was:
//
//   #include <NewPing.h>
//   NewPing sonar[3] = {NewPing(4, 4, 400), NewPing(5, 5, 400), NewPing(6, 6, 400)};
//
//   void loop() {
//     for (uint8_t i = 0; i < 3; i++) {
//       delay(29);                                  // the last ping must have died
//       unsigned cm = sonar[i].ping_cm();           // waits for the echo; 0: none
//       if (cm != 0) report(i, cm);
//     }
//   }
//
// Now each module reports 16 times a second instead of 11 or fewer, and nothing waits.
// One read() takes up to 0.8 ms on an Uno.
#include <EerufFlow.h>

const uint8_t PINS[] = {4, 5, 6};
EerufFlow<3> sonar(PINS);

void report(uint8_t i, unsigned cm) {
  Serial.print(i + 1);
  Serial.print(' ');
  Serial.print(cm);
  Serial.println(F(" cm"));
}

void setup() {
  Serial.begin(115200);
  sonar.begin();
}

void loop() {
  if (sonar.read() && sonar.accepted()) report(sonar.sensor(), sonar.millimetres() / 10);
}

// The same ring with eeruf: by its table, or by the table's first phase over and over, so that all waits are constant.
#include <EerufTables.h>

#if MODULES == 12
const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
#define TABLE(what) EERUF_HC_SR04_12##what
#define PERIOD_US 71000u
#define T_DELTA_US 439u
#else
const uint8_t PINS[] = {2, 3, 4, 5, 6, 7, 8, 9};
#define TABLE(what) EERUF_HC_SR04_8##what
#define PERIOD_US 67000u
#define T_DELTA_US 416u
#endif

#if CONSTANT
// Marked as verified so that the same class runs it, although a table with one phase cannot be.
static const EerufSchedule RING EERUF_FLASH = {
  EERUF_VERSION, MODULES, 1, TABLE(_order), TABLE(_gap_us), PERIOD_US, PERIOD_US,
  T_DELTA_US, 14569u, 60000u, 1000u, EERUF_AS_T_DELTA, PERIOD_US, 1, EERUF_LAYOUT_RING, 4, 0, NULL,
};
#else
#define RING TABLE()
#endif
EerufSonar<MODULES> sonar(RING, PINS);

void setup() {
  Serial.begin(115200);
  sonar.begin();
}

void loop() {
  if (!sonar.read()) return;
#if EVERY
  if (sonar.micros() == EERUF_NO_ECHO || sonar.kind() == EERUF_READING_TOO_EARLY) return;
#elif CONSTANT
  // Readings that agree: sound of the same firing explains each pair.
  if (!sonar.accepted() && sonar.kind() != EERUF_READING_AMBIGUOUS) return;
#else
  if (!sonar.accepted()) return;
#endif
  Serial.print(sonar.sensor() + 1);
  Serial.print(' ');
  Serial.println(sonar.millimetres());
}

// Rings of ultrasonic sensors: by flow, EerufFlow<N>, or by a table, EerufSonar<N>; and the board's own
// seed, eerufSeed(). See EerufArduino.h.
#pragma once

#include "EerufFlow.h"
#include "EerufSeed.h"
#include "EerufTables.h"

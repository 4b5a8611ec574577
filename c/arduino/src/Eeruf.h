// Rings of ultrasonic sensors: by flow, EerufFlow<N>, or by a table, EerufSonar<N>. See EerufArduino.h.
#pragma once

#include "EerufFlow.h"
#include "EerufTables.h"

#!/bin/sh
# Builds a sketch for an Uno with nothing but Debian's packages, and runs it among simulated HC-SR04 modules.
#
#   apt install gcc gcc-avr avr-libc binutils-avr arduino-core-avr libsimavr-dev libelf-dev
#   ./uno.sh examples/FromNewPing/FromNewPing.ino 5 world/alcove.txt 3  4 5 6  4 5 6
#
# The arguments: the sketch; for how many seconds it runs; which ways sound takes (emitter, receiver, microseconds);
# how many modules there are; their trigger pins and their echo pins. What it builds goes into the folder `uno`.
set -eu
[ $# -ge 6 ] || { sed -n '2,8p' "$0"; exit 2; }
sketch=$1
shift
here=$(dirname "$0")
core=/usr/share/arduino/hardware/arduino/avr/cores/arduino
mkdir -p uno/core
flags="-c -g -Os -ffunction-sections -fdata-sections -flto -mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10819
  -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR -DDECIMAL_DIG=10 -I $core -I $core/../../variants/standard -I $here/src"
compile() { # source, object
    case $1 in
    *.c) avr-gcc $flags -std=gnu11 -fno-fat-lto-objects -w "$1" -o "$2" ;;
    *) avr-g++ $flags -std=gnu++11 -fpermissive -fno-exceptions -fno-threadsafe-statics -w "$1" -o "$2" ;;
    esac
}
for source in "$core"/*.c "$core"/*.cpp; do
    object=uno/core/$(basename "$source").o
    [ -f "$object" ] || compile "$source" "$object"
done
{ echo '#include <Arduino.h>'; cat "$sketch"; } >uno/sketch.cpp
compile uno/sketch.cpp uno/sketch.o
compile "$here/src/EerufArduino.cpp" uno/EerufArduino.o
compile "$here/src/eeruf.c" uno/eeruf.o
avr-gcc -w -Os -g -flto -fuse-linker-plugin -Wl,--gc-sections -mmcu=atmega328p -o uno/sketch.elf \
    uno/sketch.o uno/EerufArduino.o uno/eeruf.o uno/core/*.o -lm
avr-size uno/sketch.elf
gcc -std=gnu99 -O2 "$here/world/world.c" -o uno/world -lsimavr -lelf
exec uno/world uno/sketch.elf "$@"

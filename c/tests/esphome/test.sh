#!/bin/sh
# The component in ESPHome: its validation, the program that it writes, and its core on the host platform among the modules of
# board.cpp. From the root of the clone: test.sh FOLDER ESPHOME EERUF
set -eu
folder=$1 esphome=$2 eeruf=$3
wall='{name: Wall, trigger_pin: 0, echo_pin: 1}' open='{name: Open, trigger_pin: 2, echo_pin: 3}'
dead='{name: Dead, trigger_pin: 4, echo_pin: 5}'

fail() {
    echo "esphome: $1" >&2
    exit 1
}

ring() { # settings of the ring, file
    cat >"$folder/$2.yaml" <<YAML
esphome: {name: ring}
host:
logger: {level: VERBOSE}
external_components: [{source: {type: local, path: $PWD/c/esphome}}]
eeruf: {$1}
YAML
}

refuses() { # settings, reason
    ring "$1" wrong
    ! said=$("$esphome" config "$folder/wrong.yaml" 2>&1) || fail "accepts $1"
    case $said in *"$2"*) ;; *) fail "$1: $said; expected $2" ;; esac
}

mkdir -p "$folder"
refuses "ring: [$wall], module: hc-sr05" "Unknown value 'hc-sr05', did you mean 'hc-sr04'"
refuses "ring: []" "length of value must be at least 1"
refuses "ring: [{name: Wall, trigger_pin: 0}]" "'echo_pin' is a required option"
refuses "ring: [$wall, {name: Open, trigger_pin: 0, echo_pin: 3}]" "Pin 0 is used in multiple places"

# Times of modules as in ring files.
modules=$(sed -n '/^MODULES/ { s/.*{"/"/; s/.*\["/"/; s/), /\n/g; s/["(),:={}]//g; s/]//; p }' c/esphome/eeruf/__init__.py)
[ "$(echo "$modules" | wc -l)" -ge 3 ] || fail "few modules: $modules"
echo "$modules" |
    while read -r module window blanking least most rest longest; do
        printf 'sensors = 8\nlayout = "ring"\nneighbours = 4\nmodule = "%s"\n' "$module" >"$folder/ring.toml"
        said=$("$eeruf" design "$folder/ring.toml" --way flow --emit c)
        flow="${window}u, ${blanking}u, ${least}u, ${most}u, ${rest}u,"
        for expected in "$flow" "100, 100, 1400, $longest, 250000, $rest, 3, 10}"; do
            case $said in *"$expected"*) ;; *) fail "$module: $expected is not what eeruf design says: $said" ;; esac
        done
        echo "$module: as eeruf design says"
    done

ring "ring: [$wall, $open, $dead]" ring
"$esphome" -q config "$folder/ring.yaml" >/dev/null
"$esphome" -q compile --only-generate "$folder/ring.yaml"
cd "$folder/.esphome/build/ring/src"
cp "$OLDPWD/c/tests/esphome/board.cpp" esphome/components/host/hal.cpp
rm esphome/components/host/gpio.cpp
find . -name '*.cpp' | xargs -P "$(nproc)" -I{} g++ -std=gnu++20 -DUSE_HOST -DESPHOME_LOG_LEVEL=6 -I. -c {} -o {}.o
gcc -c esphome/components/eeruf/eeruf.c -o eeruf.o
find . -name '*.o' | xargs g++ -o ring
./ring >ring.txt
for state in "'Wall' >> 1.00 m" "'Open' >> inf m" "'Dead' >> nan m"; do
    count=$(grep -c "$state" ring.txt || true)
    echo "$state: $count times"
    [ "$count" -ge 8 ] || fail "$state: $count times in 10 s; expected 8 or more: $(grep '>>' ring.txt)"
done
! grep "'Dead' >> [^n]" ring.txt || fail "a module without power is known"

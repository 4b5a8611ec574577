#!/bin/sh
# README's commands in an empty Debian 12 root with Rust, Python 3 and git alone. As root, with debootstrap:
#
#     packaging/clean_root.sh FOLDER first     # the study and its pictures, minutes
#     packaging/clean_root.sh FOLDER all       # then `cargo xtask test`, half an hour and more
#
# Clones HEAD. A FOLDER that exists is used as it is, so a second run is warm; remove it yourself.
set -eu

[ $# -eq 2 ] || { echo "usage: $0 FOLDER first|all" >&2; exit 2; }
root=$1 which=$2
here=$(cd "$(dirname "$0")/.." && pwd)

in_root() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

[ -e "$root" ] || debootstrap --variant=minbase bookworm "$root" >/dev/null
if [ ! -x "$root/usr/bin/cargo" ]; then
    echo "deb http://deb.debian.org/debian-security bookworm-security main" >>"$root/etc/apt/sources.list"
    in_root apt-get update -qq
    in_root apt-get install -y -qq --no-install-recommends rustc-web cargo-web python3 git ca-certificates >/dev/null
fi
# Names and certificates as on this machine, which may sit behind a proxy of its own.
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/ca-certificates.crt"
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
[ -e "$root/eeruf" ] || git clone --quiet "$here" "$root/eeruf"

# The two commands under "Start", as README has them.
start=$(sed -n '/^## Start/,/^## /p' "$here/README.md" | sed -n '/^```sh$/,/^```$/p' | grep -v '^```')
[ "$(echo "$start" | wc -l)" -eq 2 ] || { echo "README.md: Start: expected two commands, found: $start" >&2; exit 1; }
first=$(echo "$start" | sed -n 1p) second=$(echo "$start" | sed -n 2p)

run() {
    echo "\$ $1"
    began=$(date +%s)
    in_root sh -c "cd /eeruf && $1"
    echo "$(($(date +%s) - began)) s: $1"
}

run "$first"
pictures=$(find "$root/eeruf/target/alcove" -name '*.svg' | wc -l)
[ "$pictures" -ge 4 ] || { echo "target/alcove: $pictures pictures; expected 4 and more" >&2; exit 1; }
[ "$which" = first ] || run "$second"

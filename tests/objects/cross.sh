#!/usr/bin/env bash
# The objects of tests/objects.rs on processors that this machine does not have, by emulation; not part of CI.
# Needs: apt-get install qemu-user-static gcc-aarch64-linux-gnu libc6-dev-arm64-cross
#
# The same driver compares every bit with what this machine's JIT gave: on 64-bit ARM, on a Nehalem (level 2, where the C
# library computes fused operations in software) and on a Haswell (level 3).
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

OBJECTS=$folder cargo test --test objects -- --exact objects_for_other_machines
driver=$PWD/tests/objects/driver.c
cd "$folder"
gcc -O1 -I. -static "$driver" table.c x86_64.o -o x86_64 -lm -lpthread
aarch64-linux-gnu-gcc -O1 -I. -static "$driver" table.c aarch64.o -o aarch64 -lm -lpthread
qemu-aarch64-static ./aarch64 fixture.bin 8
qemu-x86_64-static -cpu Nehalem ./x86_64 fixture.bin 2
qemu-x86_64-static -cpu Haswell ./x86_64 fixture.bin 3

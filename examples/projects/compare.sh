#!/usr/bin/env bash
# Builds both projects for release, checks that they compute the same bit for bit, and prints what each costs.
set -euo pipefail
cd "$(dirname "$0")/../.."

target=$(cargo metadata --format-version 1 --no-deps | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
cargo build --release --quiet -p example-build-script -p example-run-time

declare -A said size dependencies cranelift
for name in example-build-script example-run-time; do
    program=$target/release/$name
    said[$name]=$("$program")
    cp "$program" "$program.stripped"
    strip "$program.stripped"
    size[$name]=$(stat -c %s "$program.stripped")
    rm "$program.stripped"
    dependencies[$name]=$(($(cargo tree -e normal --prefix none -p "$name" | sed 's/ (\*)$//' | sort -u | wc -l) - 1))
    cranelift[$name]=$(nm -C "$program" | grep -ci cranelift || true)
done

value() { sed -n "s/^$2: //p" <<<"${said[$1]}"; }
row() { printf '%-34s %22s %22s\n' "$1" "$2" "$3"; }
both() { row "$1" "$(value example-build-script "$1")" "$(value example-run-time "$1")"; }

row '' 'ahead of time' 'at run time'
row 'bytes of the stripped program' "${size[example-build-script]}" "${size[example-run-time]}"
row 'packages that it links' "${dependencies[example-build-script]}" "${dependencies[example-run-time]}"
row 'symbols of Cranelift' "${cranelift[example-build-script]}" "${cranelift[example-run-time]}"
both 'one box of a line'
both 'one box'
both 'a box of 4096 in rows'
both 'a box of 4096 in columns'
both 'bits of bounds'
both 'bits of values'

[ "${cranelift[example-build-script]}" -eq 0 ] || { echo 'Cranelift is in the program that was compiled ahead of time'; exit 1; }
for line in 'bits of bounds' 'bits of values'; do
    [ "$(value example-build-script "$line")" = "$(value example-run-time "$line")" ] || { echo "$line differ"; exit 1; }
done

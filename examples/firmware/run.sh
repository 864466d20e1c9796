#!/bin/sh
# Builds the firmware, lets a bench judge it, changes one C file, builds again, and shows which step of the bench fails.
#   SOURCE  what holds firmware/ and rtl/ (default: ../..)     BRICK  the brick command (default: brick)
#   BUILD   folder of the copy and the images (default: build)
# Exit status 0: the bench passed before the change and failed after it, 1: it did not, 77: a program is missing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
source=${SOURCE:-$here/../..} build=${BUILD:-build} brick=${BRICK:-brick}
for program in riscv64-unknown-elf-gcc make patch "$brick"; do
  command -v "$program" >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done

image() { make -s --no-print-directory -j2 -f "$here/Makefile" SOURCE="$build/source" BUILD="$build"; }
bench() { "$brick" run breq-rotary --engine systemc --firmware "$build/turbo.elf" >"$build/$1.log"; }

rm -rf "$build/source"  # a copy, so that the change stays here
mkdir -p "$build/source/rtl/regs"
cp -R "$source/firmware" "$build/source/"
cp "$source"/rtl/regs/*.h "$build/source/rtl/regs/"
image >"$build/make.log"
bench before || { cat "$build/before.log"; echo "the bench fails without the change"; exit 1; }
tail -n 2 "$build/before.log" | head -n 1

patch -s -p1 -d "$build/source" <"$here/i17_off_by_one.patch"
echo "changed: $(grep '^+++ ' "$here/i17_off_by_one.patch" | cut -c 7-)"
image
status=0
bench after || status=$?
if [ $status -ne 1 ]; then
  echo "the bench did not notice the change: exit status $status"
  exit 1
fi
grep -m 1 ' FAIL ' "$build/after.log"  # the first step that failed; the others are in the log
tail -n 2 "$build/after.log" | head -n 1

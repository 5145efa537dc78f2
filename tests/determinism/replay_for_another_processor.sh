#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# replay_for_another_processor.sh SOURCE BUILD PROCESSOR RECORDINGS ALTER: builds the replay program
# with Debian's cross compiler for a processor and replays all recordings under its user-mode
# emulator (replay_all.sh). Skips (77) without the compiler or emulator.
set -euo pipefail
readonly source=$1 build=$2 processor=$3 recordings=$4 alter=$5

for tool in "$processor-linux-gnu-g++" "qemu-$processor"; do
    command -v "$tool" >/dev/null || {
        echo "skipped: $tool is missing (cmake/packages-ci.txt)"
        exit 77
    }
done
bash "$source/tests/portable/configure_for_another_processor.sh" "$source" "$build" "$processor"
cmake --build "$build" --parallel 2 --target replay_recordings >>"$build.log" 2>&1 \
    || { tail -50 "$build.log"; exit 1; }

export QEMU_LD_PREFIX=/usr/$processor-linux-gnu
exec bash "$source/tests/determinism/replay_all.sh" "$build/bin/replay_recordings" "$recordings" \
    "$alter" "$build/altered.rec" "qemu-$processor"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# replay_in_another_build.sh SOURCE BUILD RECORDINGS ALTER COMPILER LEVEL [EMULATOR PROCESSOR]:
# builds the replay program with a compiler and level, for another processor if one is named (with
# the options of tests/portable), and replays all recordings (replay_all.sh). Skips (77) without the
# compiler or emulator.
set -euo pipefail
readonly source=$1 build=$2 recordings=$3 alter=$4 compiler=$5 level=$6
readonly emulator=${7:-} processor=${8:-}

for tool in "$compiler" ${emulator:+"$emulator"}; do
    command -v "$tool" >/dev/null || {
        echo "skipped: $tool is missing (cmake/packages-ci.txt)"
        exit 77
    }
done
if [[ -n "$processor" ]]; then # The build of portable.aarch64, with its compiled objects.
    bash "$source/tests/portable/configure_for_another_processor.sh" \
        "$source" "$build" "$processor"
    export QEMU_LD_PREFIX=/usr/$processor-linux-gnu
else
    options=(-DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug
        -DCMAKE_CXX_FLAGS_DEBUG="$level" -DTACTUS_ONLY_REPLAYER=ON -DTACTUS_WERROR=OFF
        -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16)
    if command -v ccache >/dev/null; then
        options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    cmake -S "$source" -B "$build" -G Ninja "${options[@]}" >"$build.log" 2>&1 \
        || { cat "$build.log"; exit 1; }
fi
cmake --build "$build" --parallel 2 --target replay_recordings >>"$build.log" 2>&1 \
    || { tail -50 "$build.log"; exit 1; }

exec bash "$source/tests/determinism/replay_all.sh" "$build/bin/replay_recordings" "$recordings" \
    "$alter" "$build/altered.rec" ${emulator:+"$emulator"}

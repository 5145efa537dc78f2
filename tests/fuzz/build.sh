#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh SOURCE BUILD: builds the fuzz targets with clang's libFuzzer and the address and
# undefined-behaviour sanitizers (preset fuzz) into BUILD. Skips (77) without clang or libFuzzer.
set -euo pipefail
readonly source=$1 build=$2

command -v clang++ >/dev/null || {
    echo "skipped: clang++ is missing (cmake/packages-ci.txt)"
    exit 77
}
mkdir -p "$build"
printf 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }\n' \
    | clang++ -x c++ - -fsanitize=fuzzer,address,undefined -o "$build/probe" 2>"$build/probe.log" \
    || {
        tail -n 1 "$build/probe.log"
        echo "skipped: clang++ has no libFuzzer (cmake/packages-ci.txt)"
        exit 77
    }
options=()
if command -v ccache >/dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cd "$source"
cmake --preset fuzz -B "$build" "${options[@]}" >"$build/build.log" 2>&1 \
    || { cat "$build/build.log"; exit 1; }
cmake --build "$build" --parallel 2 --target fuzz_targets >>"$build/build.log" 2>&1 \
    || { tail -50 "$build/build.log"; exit 1; }

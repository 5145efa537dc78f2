#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# configure_for_another_processor.sh SOURCE BUILD PROCESSOR: configures for Debian's cross compiler,
# with the portable tests and the replay program, which share one rt_core at -O2. GoogleTest's
# sources are expected at Debian's path; without them only the replay program is built.
set -euo pipefail
readonly source=$1 build=$2 processor=$3
readonly compiler=$processor-linux-gnu-g++

options=(-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR="$processor"
    -DCMAKE_C_COMPILER="${compiler/g++/gcc}" -DCMAKE_CXX_COMPILER="$compiler"
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O2 -DTACTUS_ONLY_REPLAYER=ON
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16)
if [[ -r /usr/src/googletest/CMakeLists.txt ]]; then
    options+=(-DTACTUS_ONLY_PORTABLE=ON)
fi
if command -v ccache >/dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
cmake -S "$source" -B "$build" -G Ninja "${options[@]}" >"$build.log" 2>&1 \
    || { cat "$build.log"; exit 1; }

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run_for_another_processor.sh SOURCE BUILD PROCESSOR: builds the portable tests with Debian's cross
# compiler for a processor and runs them under its user-mode emulator. Skips (77) without compiler,
# emulator or GoogleTest's sources.
set -euo pipefail
readonly source=$1 build=$2 processor=$3
readonly compiler=$processor-linux-gnu-g++ emulator=qemu-$processor

for tool in "$compiler" "$emulator"; do
    command -v "$tool" >/dev/null || {
        echo "skipped: $tool is missing (cmake/packages-ci.txt)"
        exit 77
    }
done
if [[ ! -r /usr/src/googletest/CMakeLists.txt ]]; then
    echo "skipped: GoogleTest's sources are missing (cmake/packages-ci.txt)"
    exit 77
fi
bash "$source/tests/portable/configure_for_another_processor.sh" "$source" "$build" "$processor"
cmake --build "$build" --parallel 2 --target portable_tests tactus_platform >>"$build.log" 2>&1 \
    || { tail -50 "$build.log"; exit 1; }
bash "$source/cmake/checks/check_platform_symbols.sh" "$build/platform/libtactus_platform.a" \
    "$source/cmake/checks/platform_symbols.txt" "$processor-linux-gnu-nm"
exec "$emulator" -L "/usr/$processor-linux-gnu" "$build/bin/portable_tests" --gtest_brief=1

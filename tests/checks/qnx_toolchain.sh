#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# qnx_toolchain.sh CHECKOUT SCRATCH CMAKE CC CXX EIGEN_DIR: tests the QNX toolchain file without
# QNX: it refuses wrong settings, and with stand-ins for QNX's compilers the portable part is
# configured for QNX, with the generic extras.
set -euo pipefail
readonly checkout=$1 scratch=$2 cmake=$3 cc=$4 cxx=$5 eigen=$6
rm -rf "$scratch"
mkdir -p "$scratch"/{host/usr/bin,target,googletest}

# A stand-in answers -V like QNX's driver, by which CMake identifies it, drops the target from the
# options, and otherwise is this machine's compiler.
stand_in() { # stand_in NAME COMPILER
    cat >"$scratch/host/usr/bin/$1" <<STAND_IN
#!/usr/bin/env bash
options=()
for option in "\$@"; do
    case "\$option" in
        -V) echo "targets available: gcc_ntoaarch64le gcc_ntox86_64" && exit ;;
        -Vgcc_nto* | -lang-c++) echo "\$option" >>"$scratch/seen.txt" ;;
        *) options+=("\$option") ;;
    esac
done
exec "$2" -D__QNXNTO__ "\${options[@]}"
STAND_IN
    chmod +x "$scratch/host/usr/bin/$1"
}
stand_in qcc "$cc"
stand_in q++ "$cxx"
for tool in ar ranlib nm strip; do
    for processor in aarch64 x86_64; do
        ln -s "$(command -v "$tool")" "$scratch/host/usr/bin/nto$processor-$tool"
    done
done
printf 'add_library(gtest_main INTERFACE)\n' >"$scratch/googletest/CMakeLists.txt"

configure() { # configure QNX_HOST PROCESSOR
    rm -rf "$scratch/build"
    QNX_HOST=$1 QNX_TARGET="$scratch/target" "$cmake" -S "$checkout" -B "$scratch/build" -G Ninja \
        --toolchain "$checkout/cmake/qnx.toolchain.cmake" -DTACTUS_QNX_PROCESSOR="$2" \
        -DTACTUS_ONLY_PORTABLE=ON -DTACTUS_GOOGLETEST_SOURCES="$scratch/googletest" \
        -DEigen3_DIR="$eigen" 2>&1
}

expect() { # expect TEXT WHERE: expects TEXT in the output or in the file WHERE.
    if [[ "$2" != *"$1"* ]]; then
        printf 'expected "%s" in:\n%s\n' "$1" "$2"
        exit 1
    fi
}

output=$(configure "$scratch/nowhere" aarch64le) && exit 1
expect 'QNX_HOST names no folder' "$output"
output=$(configure "$scratch/host" armv7) && exit 1
expect "TACTUS_QNX_PROCESSOR 'armv7': aarch64le or x86_64" "$output"

for processor in aarch64le x86_64; do
    rm -f "$scratch/seen.txt"
    output=$(configure "$scratch/host" "$processor") || { echo "$output"; exit 1; }
    rules=$(<"$scratch/build/build.ninja")
    expect 'platform/machine/posix/generic_extras.cpp' "$rules"
    expect 'tests/unit/platform/test_timer_conformance.cpp' "$rules"
    expect '-D_QNX_SOURCE' "$rules"
    expect '-lsocket' "$rules"
    expect "/nto${processor%le}-ar" "$(<"$scratch/build/CMakeFiles/rules.ninja")"
    expect "-Vgcc_nto$processor" "$(<"$scratch/seen.txt")"
    if [[ "$rules" == *platform/machine/posix/linux_extras.cpp* ]]; then
        echo "the extras of Linux are built for QNX"
        exit 1
    fi
done
rm -rf "$scratch"
echo "configured for QNX with stand-ins for its compilers; nothing was compiled for it"

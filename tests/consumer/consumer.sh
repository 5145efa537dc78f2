#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# consumer.sh quick|all|aarch64 BUILD PROJECT FOLDER COMPILER EXAMPLES: installs the libraries of
# BUILD into FOLDER, moves them, and lets external projects find, link and run them.
#
# quick: with COMPILER and the shared libraries. all: with g++ and clang++, shared and static, with
# our flags and with -march=native -O3, by CMake and by pkg-config; refusals; and the component
# core, built alone. aarch64: that component for aarch64 with only Eigen and libccd, and a program
# of it under an emulator; skips (77) without compiler, emulator or mmdebstrap, which fetches those
# two.
set -euo pipefail
readonly extent=$1 build=$2 project=$3 folder=$4 compiler=$5 examples=$6
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source=$(cd "$here/../.." && pwd)
readonly here source
readonly domain=${TACTUS_TEST_DOMAIN:-$(($$ % 231))}

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
quietly() { # quietly LOG COMMAND...: prints the output only on failure.
    local log=$1
    shift
    "$@" >"$log" 2>&1 || { tail -n 40 "$log"; fail "this failed: $*"; }
}

if [[ "$extent" == aarch64 ]]; then
    for tool in aarch64-linux-gnu-g++ qemu-aarch64 mmdebstrap; do
        command -v "$tool" >/dev/null || {
            echo "skipped: $tool is missing (cmake/packages-ci.txt)"
            exit 77
        }
    done
fi
rm -rf "$folder"
mkdir -p "$folder/first"
cd "$folder"
for component in libtactus0 libtactus-dev; do
    quietly install.log cmake --install "$build" --prefix "$PWD/first/usr" --component "$component"
done
mv first second # No file may contain the path of the installation.
readonly prefix=$PWD/second/usr
if grep -rIlE "$PWD/first|$build|$source" "$prefix"; then
    fail "these files name folders of this machine"
fi
grep -rnE '#include "' "$prefix/include" && fail "a header is included by another name than <...>"
library=$(dirname "$(find "$prefix" -name libtactus_core.so)")
readonly library
launcher=()
if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi

configure() { configure_in "$project" "$@"; } # configure NAME COMPILER OPTION...
configure_in() { # configure_in PROJECT NAME COMPILER OPTION...
    cmake -S "$1" -B "$2" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$3" \
        -DCMAKE_PREFIX_PATH="$prefix" "${launcher[@]}" "${@:4}"
}
declare digest=''
printf '%s\n' '0 0 0' '0.03 0 0.001' '1 2 3' >points.txt
try() { # try NAME COMPILER FLAGS STATIC: builds it; the model and all answers are unchanged.
    quietly "$1.log" configure "$1" "$2" -DTactus_USE_STATIC_LIBS="$4" \
        -DCMAKE_CXX_FLAGS="$3" -DCMAKE_C_FLAGS="$3"
    quietly "$1.log" cmake --build "$1" --parallel 2
    quietly "$1.log" configure_in "$examples" "$1/examples" "$2" \
        -DTactus_USE_STATIC_LIBS="$4" -DCMAKE_CXX_FLAGS="$3"
    quietly "$1.log" cmake --build "$1/examples" --parallel 2
    "$1/serve" "$1/ring.spm" >"$1.txt" || fail "$1: serve ends with $?"
    [[ -e ring.spm ]] || cp "$1/ring.spm" ring.spm
    cmp ring.spm "$1/ring.spm" || fail "$1: another model"
    touches "$1/touch"
    "$1/ask" ring.spm >"$1.txt" || fail "$1: ask ends with $?"
    "$1/examples/distances" ring.spm <points.txt >"$1.txt" || fail "$1: distances: $(<"$1.txt")"
    [[ -e distances.txt ]] || cp "$1.txt" distances.txt
    cmp distances.txt "$1.txt" || fail "$1: other distances"
    "$1/examples/hello" ring.spm >"$1.txt" || fail "$1: hello ends with $?"
    [[ -e hello.txt ]] || cp "$1.txt" hello.txt
    cmp hello.txt "$1.txt" || fail "$1: hello feels something else"
    "$1/examples/hello_c" ring.spm | cmp - hello.txt || fail "$1: hello in C feels something else"
    "$1/world" ring.spm >"$1.txt" || fail "$1: world ends with $?"
    "$1/examples/guarded" ring.spm >"$1.txt" || fail "$1: guarded ends with $?: $(<"$1.txt")"
}
touches() { # touches PROGRAM: prints the same as the others, and its recording replays.
    "$1" ring.spm run.rec >said.txt || fail "$1 ends with $?: $(<said.txt)"
    grep -q '^2000 frames agree bit for bit; ' said.txt || fail "$1 says $(<said.txt)"
    sed -i 1q said.txt
    [[ -z "$digest" || "$digest" == "$(<said.txt)" ]] || fail "$1: $(<said.txt), before '$digest'"
    digest=$(<said.txt)
    echo "$1: $digest"
}
refuses() { # refuses EXPECTED COMMAND...: fails with this text.
    local expected=$1
    shift
    if "$@" >refused.log 2>&1; then
        fail "not refused: $*"
    fi
    tr '\n' ' ' <refused.log | tr -s ' ' | grep -qF "$expected" \
        || { cat refused.log; fail "refused without '$expected'"; }
}

# Each block of code of these pages occurs in the project verbatim.
blocks_are_there() { # blocks_are_there PAGE COUNT: expects at least this number of blocks.
    local block blocks=0
    # shellcheck disable=SC2016 # Backquotes as they stand in the page.
    awk -v RS='```' \
        'NR % 2 == 0 && /^(c|cpp|cmake)\n/ { sub(/^[a-z]+\n/, ""); printf "%s%c", $0, 0 }' \
        "$source/docs/$1" >blocks.txt
    while IFS= read -r -d '' block; do
        [[ "$(<project.txt)" == *"$block"* ]] || fail "docs/$1 shows what is not there: $block"
        blocks=$((blocks + 1))
    done <blocks.txt
    ((blocks >= $2)) || fail "docs/$1 has $blocks blocks of code"
}
if [[ "$extent" != aarch64 ]]; then
    cat "$project"/CMakeLists.txt "$project"/*.cpp "$project"/*.c \
        "$examples"/CMakeLists.txt "$examples"/*.cpp >project.txt
    blocks_are_there library.md 7
    blocks_are_there how-to.md 9
    blocks_are_there devices.md 2
fi

# The component core alone sees only Eigen and libccd.
core_alone() { # core_alone NAME OPTION...
    quietly "$1.log" cmake -S "$source" -B "$1" -G Ninja -DTACTUS_ONLY_CORE=ON \
        -DCMAKE_DISABLE_FIND_PACKAGE_CycloneDDS=ON -DCMAKE_DISABLE_FIND_PACKAGE_fmt=ON \
        -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON -DCMAKE_UNITY_BUILD=ON "${launcher[@]}" "${@:2}"
    quietly "$1.log" cmake --build "$1" --parallel 2
    quietly "$1.log" cmake --install "$1" --prefix "$PWD/$1/usr"
    [[ -n $(find "$1/usr" -name libtactus_core.so) ]] || fail "$1: nothing is installed"
}
fade() { # fade NAME PREFIX OPTION...: builds the program of core alone.
    quietly "$1.log" cmake -S "$project" -B "$1" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_PREFIX_PATH="$2" "${launcher[@]}" "${@:3}"
    quietly "$1.log" cmake --build "$1"
}
if [[ "$extent" == aarch64 ]]; then
    # Debian's packages for that processor are unpacked here; none of them is run.
    release=$(. /etc/os-release && echo "$VERSION_CODENAME")
    if ! mmdebstrap --variant=extract --architectures=arm64 \
        --include=libccd-dev,libeigen3-dev "$release" sysroot >sysroot.log 2>&1; then
        echo "skipped: Debian's packages for arm64 can't be had: $(tail -n 1 sysroot.log)"
        exit 77
    fi
    # libccd names the mathematics library by path; the compiler's is used.
    sed -i "s|/usr/lib/aarch64-linux-gnu/libm.so|m|" \
        sysroot/usr/lib/aarch64-linux-gnu/ccd/ccd-targets-none.cmake
    cat >aarch64.cmake <<TOOLCHAIN
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH $PWD/sysroot $PWD/core/usr)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
TOOLCHAIN
    core_alone core -DCMAKE_TOOLCHAIN_FILE="$PWD/aarch64.cmake"
    fade here "$prefix"
    ./here/fade >here.txt || fail "fade ends with $?"
    of_core=$(dirname "$(find core/usr -name libtactus_core.so)")
    for static in OFF ON; do
        fade "there-$static" "$PWD/core/usr" -DTactus_USE_STATIC_LIBS="$static" \
            -DCMAKE_TOOLCHAIN_FILE="$PWD/aarch64.cmake" \
            -DCMAKE_EXE_LINKER_FLAGS="-Wl,-rpath-link,$PWD/sysroot/usr/lib/aarch64-linux-gnu"
        qemu-aarch64 -L /usr/aarch64-linux-gnu \
            -E LD_LIBRARY_PATH="$PWD/$of_core:$PWD/sysroot/usr/lib/aarch64-linux-gnu" \
            "there-$static/fade" >there.txt || fail "fade for aarch64 ends with $?"
        diff here.txt there.txt || fail 'another processor gives other bits'
    done
    [[ $(wc -l <here.txt) == 101 && $(sort -u here.txt | wc -l) -gt 50 ]] \
        || fail 'fade does not say what it should'
    echo "core for aarch64: $(tail -n 1 here.txt)"
    exit
fi

readonly warnings='-Wall -Wextra -Wpedantic -Wconversion -Werror'
if [[ "$extent" == quick ]]; then
    try shared "$compiler" "-O2 $warnings" OFF
    # External server and controller, over DDS.
    ./shared/serve ring.spm "$domain" >/dev/null &
    serving=$!
    trap 'kill "$serving" 2>/dev/null' EXIT
    ./shared/touch ring run.rec "$domain" || fail "over DDS touch ends with $?"
    ./shared/ask ring "$domain" >ask.txt || fail "over DDS ask ends with $?"
    ./shared/ask ring.spm | cmp - ask.txt || fail 'over DDS ask says something else'
    kill "$serving"
    # Two controllers push one cup of an external server, which yields to both, by the page's lines.
    # shellcheck disable=SC2016 # Backquotes as they stand in the page.
    mapfile -t shown < <(sed -n '/^```console$/,/^```$/{s/ *#.*//;s/^\$ //p}' \
        "$source/docs/library.md")
    [[ "${shown[*]}" == 'serve cup.spm 0 hrtc --model cup hrtc --model cup' ]] \
        || fail "docs/library.md shows other lines: ${shown[*]}"
    # The lines use this test's domain.
    # shellcheck disable=SC2317 # By the page's lines.
    serve() { exec ./shared/serve "$1" "$domain" >slide.txt; }
    # shellcheck disable=SC2317 # By the page's lines.
    hrtc() {
        exec "$build/bin/hrtc" --allow-no-rt --domain "$domain" --device sim:touch --duration 8 \
            --report "$name.json" "$@" >"$name.log" 2>&1
    }
    ${shown[0]} &
    serving=$!
    pushing=()
    trap 'kill $(jobs -p) 2>/dev/null' EXIT
    for name in left right; do
        ${shown[1]} &
        pushing+=($!)
    done
    for id in "${pushing[@]}"; do
        wait "$id" || fail "a controller ends badly: $(cat left.log right.log)"
    done
    grep -qE '^cup at( -?[0-9]+\.[0-9]){3} mm, pushed by 2 of 2 controllers$' slide.txt \
        || fail "two do not push: $(<slide.txt)"
    for name in left right; do
        grep -qE '^poses  *cup: moved in [0-9]{3,} frames' "$name.log" \
            || fail "$name: the cup did not give way: $(<"$name.log")"
    done
    # The device of the examples, in the loop of hrtc, moves up and down over the ring's thickness.
    cp shared/examples/libmy_device.so .
    "$build/bin/hrtc" --allow-no-rt ring.spm --device "plugin:$PWD/libmy_device.so,0.03" \
        --device-frame 0.028,0,0 --duration 4 >rail.log 2>&1 \
        || fail "with the examples' device: $(<rail.log)"
    grep -qE '^tool .* on rail, 0.03 m around' rail.log || fail "another device: $(<rail.log)"
    grep -qE '^frames +4000 .*in contact +[1-9]' rail.log || fail "it touches nothing: $(<rail.log)"
    refuses 'libmy_device.so: give its height' \
        "$build/bin/hrtc" --allow-no-rt ring.spm --device "plugin:$PWD/libmy_device.so"
    refuses 'is no device library: it has no TACTUS_DEVICE_PLUGIN' \
        "$build/bin/hrtc" --allow-no-rt ring.spm --device "plugin:$library/libtactus_core.so"
    refuses "missing.so: can't be loaded" \
        "$build/bin/hrtc" --allow-no-rt ring.spm --device "plugin:$PWD/missing.so"
    # Line of the page for pkg-config, verbatim.
    mkdir by_hand
    cp "$project/touch.cpp" by_hand
    # shellcheck disable=SC2016 # Backquotes as they stand in the page.
    line=$(sed -n '/^```sh$/,/^```$/{/^g++/p}' "$source/docs/library.md")
    [[ -n "$line" ]] || fail 'docs/library.md shows no line for pkg-config'
    (cd by_hand && PKG_CONFIG_PATH=$library/pkgconfig quietly log bash -euc "$line")
    LD_LIBRARY_PATH=$library touches ./by_hand/a.out
    # Lines of docs/install.md for a prefix, with this build folder and this prefix.
    grep -E '^    cmake --install |`cmake --install ' "$source/docs/install.md" \
        | grep -oE 'cmake --install build/release( --[a-z]+ [a-z/-]+)*' \
        | sed "s| build/release| '$build'|;s| /opt/tactus| '$PWD/opt'|" >shown.sh
    [[ $(wc -l <shown.sh) == 2 ]] || fail "docs/install.md shows other lines: $(<shown.sh)"
    sed -i "2s|\$| --prefix '$PWD/part'|" shown.sh
    quietly install.log bash -eu shown.sh
    opt/bin/hrtc --version >opt.txt || fail 'hrtc of a prefix does not run'
    [[ -x part/bin/spm_build && ! -e part/bin/hrtc ]] || fail 'one component is another'
    ./shared/touch nobody.spm run.rec 2>refused.log && fail "a missing file is not refused"
    grep -qF 'touch: nobody.spm: ' refused.log || fail "a missing file: $(<refused.log)"
    refuses "'gui' is not installed; there are: core, transport, platform, host, c, tactus" \
        cmake -DCMAKE_PREFIX_PATH="$prefix" -DPART=gui -P "$here/find_part.cmake"
    exit
fi

compilers=(g++)
if command -v clang++ >/dev/null; then
    compilers+=(clang++)
else
    echo 'not tried: clang++ is missing (cmake/packages-ci.txt)'
fi
for each in "${compilers[@]}"; do
    for static in OFF ON; do
        try "$each-static-$static" "$each" "-O2 $warnings" "$static"
        try "$each-static-$static-native" "$each" "-O3 -march=native" "$static"
    done
done
# All public headers; the checkout tests that each compiles by itself.
export PKG_CONFIG_PATH=$library/pkgconfig
read -ra flags < <(pkg-config --cflags tactus-host tactus-platform)
find "$prefix/include/tactus" -name '*.hpp' -not -path '*/detail/*' | sort -r \
    | sed "s|^$prefix/include/\\(.*\\)|#include <\\1>|" >headers.cpp
quietly headers.log "$compiler" -std=c++20 -fsyntax-only "${flags[@]}" headers.cpp
echo "$(wc -l <headers.cpp) public headers"
# Built by pkg-config; statically if there are no shared libraries.
by_pkg_config() { # by_pkg_config NAME OPTION...
    local libraries
    read -ra libraries < <(pkg-config "${@:2}" --libs tactus-transport tactus-platform)
    quietly "$1.log" "$compiler" -std=c++20 -O2 "${flags[@]}" "$project/touch.cpp" -o "$1" \
        "${libraries[@]}" "-Wl,-rpath,$library"
    touches "./$1"
}
by_pkg_config pc-shared
rm "$library"/libtactus*.so*
by_pkg_config pc-static --static
# Missing component, and another version.
rm "$library"/cmake/Tactus/Tactus-host-*.cmake
refuses "the component 'host' is not installed; there are: core, transport, platform, c, tactus" \
    configure without_host "$compiler"
refuses 'version: 0.2.0' \
    cmake -DCMAKE_PREFIX_PATH="$prefix" -DVERSION=0.3 -P "$here/find_part.cmake"

core_alone core

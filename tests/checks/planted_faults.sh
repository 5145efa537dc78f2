#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# planted_faults.sh CHECKOUT SCRATCH CMAKE CXX: every guard must pass on a small clean house and
# must name file and line of a fault planted in it.
set -euo pipefail
readonly checks="$1/cmake/checks" house=$2 cmake=$3 cxx=$4
failures=0

begin_house() {
    rm -rf "$house"
    mkdir -p "$house"/rt_core/{base,math,forest,abtree} "$house"/{transport,tests/unit,cmake}
    printf '# SPDX-License-Identifier: Apache-2.0\nadd_subdirectory(rt_core)\n%s\n' \
        'add_subdirectory(tests)' >"$house/CMakeLists.txt"
    printf '# SPDX-License-Identifier: Apache-2.0\nadd_library(core base/good.hpp limits.hpp)\n' \
        >"$house/rt_core/CMakeLists.txt"
    printf '# SPDX-License-Identifier: Apache-2.0\nadd_executable(t unit/test_good.cpp)\n' \
        >"$house/tests/CMakeLists.txt"
    printf '# SPDX-License-Identifier: Apache-2.0\ntactus_component(core PUBLIC %s)\n' \
        rt_core/base/good.hpp >"$house/cmake/components.cmake"
    source_file rt_core/base/good.hpp $'#include <array>\n// Any thread.'
    source_file rt_core/limits.hpp 'inline constexpr int kMaxGood = 1;'
    source_file tests/unit/test_good.cpp \
        $'#include "rt_core/base/good.hpp"\nstatic_assert(kMaxGood == 1);'
}

source_file() { # source_file PATH LINE: the LINE becomes line 4.
    printf '// SPDX-License-Identifier: Apache-2.0\n// Copyright the Tactus authors.\n\n%s\n' "$2" \
        >"$house/$1"
}

run_guard() {
    case "$1" in
        floors) "$cmake" "-DROOT=$house" -P "$checks/check_floors.cmake" 2>&1 ;;
        *) bash "$checks/check_text.sh" "$1" "$house" 2>&1 ;;
    esac
}

expect_clean() { # expect_clean GUARD
    local output
    if ! output=$(run_guard "$1"); then
        printf '%s refuses a clean house:\n%s\n' "$1" "$output"
        failures=$((failures + 1))
    fi
}

expect_refusal() { # expect_refusal GUARD TEXT: fails, and the output has TEXT.
    local output code=0
    output=$(run_guard "$1") || code=$?
    if ((code == 0)) || [[ "$output" != *"$2"* ]]; then
        printf '%s: expected a refusal with "%s"; exit %d and:\n%s\n' "$1" "$2" "$code" "$output"
        failures=$((failures + 1))
    fi
    begin_house
}

begin_house
for guard in floors line_length no_leftovers machine_paths licence files_listed limits_tested \
    own_header_first threads_told links named_tests; do
    expect_clean "$guard"
done

source_file rt_core/base/good.hpp '#include "rt_core/math/vec3.hpp"'
expect_refusal floors "rt_core/base/good.hpp:4: includes 'rt_core/math/vec3.hpp'; rt_core/base may"
source_file rt_core/abtree/ab_tree.hpp '#include "rt_core/forest/forest.hpp"'
expect_refusal floors "rt_core/abtree/ab_tree.hpp:4: includes 'rt_core/forest/forest.hpp'"
source_file rt_core/math/box.hpp '  #  include <vector>'
expect_refusal floors "rt_core/math/box.hpp:4: includes 'vector'; rt_core may include: algorithm"
source_file transport/link.hpp '#include <dds/dds.h>'
expect_refusal floors "transport/link.hpp:4: includes 'dds/dds.h'; only these may include dds"
source_file transport/link.hpp '#include "chunks.h"'
expect_refusal floors "transport/link.hpp:4: includes 'chunks.h'; not a path of a room"
mkdir -p "$house/transport/dds"
source_file transport/dds/link.cpp '#include "chunks.h"'
expect_clean floors
mkdir -p "$house/host_tools/attic"
source_file host_tools/attic/old.hpp ''
expect_refusal floors 'host_tools/attic/old.hpp: in no room'
mkdir -p "$house"/platform/{posix,hrtc}
source_file platform/hrtc/main.cpp '#include "transport/link.hpp"'
expect_clean floors
source_file platform/posix/clock.cpp '#include "platform/hrtc/loop.hpp"'
expect_refusal floors "platform/posix/clock.cpp:4: includes 'platform/hrtc/loop.hpp'; platform may"

source_file rt_core/base/good.hpp "// $(printf 'x%.0s' {1..98})"
expect_refusal line_length 'rt_core/base/good.hpp:4:'
source_file rt_core/base/good.hpp "// $(printf '\303\251%.0s' {1..97})" # 100 columns, 197 bytes
expect_clean line_length
source_file rt_core/base/good.hpp '// TO''DO: later.'
expect_refusal no_leftovers 'rt_core/base/good.hpp:4:'
source_file rt_core/base/good.hpp '// see /ho''me/me/notes.txt'
expect_refusal machine_paths 'rt_core/base/good.hpp:4:'
echo '#pragma once' >"$house/rt_core/base/good.hpp"
expect_refusal licence 'rt_core/base/good.hpp:1:'
echo 'add_library(core base/good.hpp)' >"$house/rt_core/CMakeLists.txt"
expect_refusal licence 'rt_core/CMakeLists.txt:1:'
source_file tests/unit/test_lost.cpp ''
expect_refusal files_listed 'tests/unit/test_lost.cpp:1:'
source_file rt_core/base/lost.hpp ''
expect_refusal files_listed 'rt_core/base/lost.hpp:1:'
echo '# add_executable(t unit/test_good.cpp)' >"$house/tests/CMakeLists.txt"
expect_refusal files_listed 'tests/unit/test_good.cpp:1:'
source_file tests/unit/test_good.cpp 'int kMaxGoods; // kMaxGood'
source_file tests/unit/rig.hpp 'static_assert(kMaxGood == 1);'
expect_refusal limits_tested 'rt_core/limits.hpp:4: kMaxGood is named in no tests/*/test_*.cpp'
source_file rt_core/base/good.cpp '#include <array>'
expect_refusal own_header_first 'rt_core/base/good.cpp:4: its own header, rt_core/base/good.hpp, is'
source_file rt_core/base/good.hpp 'int* thread(); // Of a needle.'
expect_refusal threads_told 'rt_core/base/good.hpp:1: is installed, and no comment says'
# Spelt in two parts, so that this file passes.
source_file rt_core/base/good.hpp '// See docs/''nowhere.md; a thread.'
expect_refusal links "rt_core/base/good.hpp:4: names 'docs/""nowhere.md', which is not there"
printf '# One way\n[a](page.md#one-way) [b](page.md#another)\n' >"$house/page.md"
expect_refusal links "page.md:2: a link to 'page.md#another', which is not there"
printf '[a](../nowhere.md)\n' >"$house/page.md"
expect_refusal links "page.md:1: a link to '../nowhere.md', which is not there"

# shellcheck disable=SC2016 # CMake's marks, and the pages'.
printf '# SPDX-License-Identifier: Apache-2.0\n%s\n' 'add_executable(t unit/test_good.cpp)' \
    'foreach(name one two)' 'add_test(NAME good.${name} COMMAND t)' 'endforeach()' \
    'add_test(NAME good.whole COMMAND t)' 'tactus_test(test_all SOURCES unit/test_good.cpp)' \
    >"$house/tests/CMakeLists.txt"
source_file tests/unit/test_good.cpp 'TEST_F(GoodSuite, says_so) {}'
# shellcheck disable=SC2016
named='`good.one`, `good.whole`, `page.md`, `test_all` GoodSuite and `test_good`'
printf '%s\n' "$named" >"$house/page.md"
expect_clean named_tests
# shellcheck disable=SC2016
for fault in '`good.three`|good.three' '`test_none`|test_none' '`test_all` GoodSuite, Bad|Bad'; do
    printf '%s\n' "$named" "${fault%|*}" >"$house/page.md"
    output=$(run_guard named_tests) && code=0 || code=$?
    if ((code == 0)) || [[ "$output" != *"page.md:2: no "*"called '${fault#*|}'"* ]]; then
        printf 'named_tests: %s: exit %d and:\n%s\n' "$fault" "$code" "$output"
        failures=$((failures + 1))
    fi
done
begin_house

# An archive whose one object takes memory from the heap.
printf 'int* make() { return new int(1); }\n' >"$house/heap.cpp"
"$cxx" -c "$house/heap.cpp" -o "$house/heap.o"
ar rcs "$house/libheap.a" "$house/heap.o"
output=$(bash "$checks/check_rt_core_symbols.sh" "$house/libheap.a" "$checks/rt_core_symbols.txt") \
    && code=0 || code=$?
if ((code != 1)) || [[ "$output" != *'operator new(unsigned long) in heap.o'* ]]; then
    printf 'symbols: expected operator new in heap.o; exit %d and:\n%s\n' "$code" "$output"
    failures=$((failures + 1))
fi

# Calls of one system only, in an object that may make them and in others.
expect_platform() { # expect_platform CODE TEXT OBJECT CALL: of an archive whose object calls it.
    local output code=0
    printf 'extern "C" int %s(...);\nint run() { return %s(1); }\n' "$4" "$4" >"$house/$3.cpp"
    "$cxx" -w -O1 -c "$house/$3.cpp" -o "$house/$3.cpp.o"
    rm -f "$house/libcalls.a"
    ar rcs "$house/libcalls.a" "$house/$3.cpp.o"
    output=$(bash "$checks/check_platform_symbols.sh" "$house/libcalls.a" \
        "$checks/platform_symbols.txt") || code=$?
    if ((code != $1)) || [[ "$output" != *"$2"* ]]; then
        printf 'platform symbols: expected exit %d and "%s" for %s in %s; exit %d and:\n%s\n' \
            "$1" "$2" "$4" "$3" "$code" "$output"
        failures=$((failures + 1))
    fi
}
expect_platform 0 'needs nothing but' timer clock_nanosleep
expect_platform 1 'epoll_wait in timer.cpp.o' timer epoll_wait
expect_platform 1 'sched_getaffinity in timer.cpp.o' timer sched_getaffinity
expect_platform 0 'needs nothing but' linux_extras sched_getaffinity
expect_platform 1 'prctl in linux_extras.cpp.o' linux_extras prctl
expect_platform 0 'needs nothing but' system_call_trap prctl
expect_platform 1 'clock_gettime64 in timer.cpp.o' timer clock_gettime64

if ((failures > 0)); then
    echo "$failures guards do not see what they are for"
    exit 1
fi
rm -rf "$house"

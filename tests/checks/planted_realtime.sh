#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# planted_realtime.sh CHECKOUT SCRATCH CXX EIGEN: clang must refuse to compile, and its realtime
# sanitizer must refuse to run, marked functions with operations forbidden in a frame. A copy of one
# of rt_core's sources represents all; without a fault it must compile and run.
set -euo pipefail
readonly root=$1 scratch=$2 cxx=$3 eigen=$4
readonly source=$root/rt_core/predict/region_predictor.cpp function=RegionPredictor::observe
failures=0
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"

# plant FILE INCLUDE STATEMENT: copies the source to FILE, with the STATEMENT in its function.
plant() {
    awk -v include="$2" -v statement="$3" -v function_name="$function" '
        NR == 4 { print include }
        { print }
        index($0, function_name "(") { is_next = 1 }
        is_next && /^{/ { print statement; is_next = 0; ++planted }
        END { exit planted == 1 ? 0 : 1 }' "$source" >"$1" || {
        echo "$source: $function can't be found, so nothing can be planted"
        exit 1
    }
}

compile() { # compile ARGUMENT...
    "$cxx" -std=c++20 -I"$root" -isystem "$eigen" -DEIGEN_DONT_VECTORIZE \
        -DEIGEN_MAX_ALIGN_BYTES=0 -DEIGEN_NO_DEBUG "$@"
}
# Precompiled, since Eigen takes a second.
compile -fsanitize=realtime -fpch-instantiate-templates \
    -x c++-header "$root/rt_core/predict/region_predictor.hpp" -o first.pch
again() { compile -fsanitize=realtime -include-pch first.pch "$@"; }

expect() { # expect ok|fault TEXT COMMAND...: expects success or failure, and TEXT in the output.
    local output outcome=ok wanted=$1 text=$2
    shift 2
    output=$("$@" 2>&1) || outcome=fault
    if [[ "$outcome" != "$wanted" || "$output" != *"$text"* ]]; then
        printf '%s: expected %s and "%s"; %s and:\n%s\n' "$*" "$wanted" "$text" "$outcome" "$output"
        failures=$((failures + 1))
    fi
}

warned() { # warned ok|fault TEXT INCLUDE STATEMENT: result of compiling.
    plant copy.cpp "$3" "$4"
    expect "$1" "$2" again -Werror=function-effects -fsyntax-only copy.cpp
}

warned ok '' '' ''
warned fault "non-'nonblocking' function 'clock_gettime'" '#include <ctime>' \
    'timespec now; clock_gettime(CLOCK_MONOTONIC, &now);'
warned fault "non-'nonblocking' function 'std::chrono::steady_clock::now'" '#include <chrono>' \
    'static_cast<void>(std::chrono::steady_clock::now());'
warned fault "non-'nonblocking' function 'malloc'" '#include <cstdlib>' \
    'static_cast<void>(std::malloc(1));'
warned fault 'allocate' '' 'delete new int(1);'
warned fault "std::mutex::lock" '#include <mutex>' 'static std::mutex m; m.lock();'
warned fault "static local" '' 'static int n = static_cast<int>(horizon_s); static_cast<void>(n);'
warned fault 'throw' '' 'if (horizon_s < 0.0) throw 1;'
warned fault 'pointer' 'void (*hook)() noexcept;' 'hook();'
warned fault "non-'nonblocking' function 'elsewhere'" 'void elsewhere() noexcept;' 'elsewhere();'

# Faults that only the run shows: the compiler is told to trust.
cat >main.cpp <<'EOC'
#include "rt_core/predict/region_predictor.hpp"
#include <cstdio>
int main()
{
    tactus::RegionPredictor predictor;
    tactus::PairMotion motion;
    motion.elapsed_s = 0.001;
    predictor.observe(motion, 0.02);
    std::puts("went through");
}
EOC
again -c main.cpp "$root/rt_core/base/assert.cpp"
caught() { # caught ok|fault TEXT INCLUDE STATEMENT: result of running.
    plant copy.cpp "$3" "$4"
    again -c copy.cpp -o copy.o
    compile -fsanitize=realtime main.o copy.o assert.o -o program
    expect "$1" "$2" ./program
}

caught ok 'went through' '' ''
caught fault 'malloc' '#include <cstdlib>' \
    'auto* p = static_cast<volatile char*>(std::malloc(1)); p[0] = 1;'
caught fault 'pthread_mutex_lock' '#include <mutex>' 'static std::mutex m; m.lock();'
caught fault 'nanosleep' '#include <ctime>' 'timespec t{0, 1}; nanosleep(&t, nullptr);'

if ((failures > 0)); then
    echo "$failures faults are not seen as they should"
    exit 1
fi
cd /
rm -rf "$scratch"

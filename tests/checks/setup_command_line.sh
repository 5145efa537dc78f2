#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# setup_command_line.sh SETUP: cmake/setup.sh refuses wrong usage with exit 3 and one line that
# names the fault, prints its help with exit 0, names packages that it could not install, and counts
# instructions in a full run with peers.
set -euo pipefail
readonly setup=$1
failures=0

expect() { # expect CODE TEXT ARGUMENT...
    local code=0 output wanted=$1 text=$2
    shift 2
    output=$(bash "$setup" "$@" 2>&1) || code=$?
    if ((code != wanted)) || [[ "$output" != *"$text"* ]] \
        || { ((wanted == 3)) && [[ "$output" == *$'\n'* ]]; }; then
        printf 'setup.sh %s: expected exit %d and "%s"; exit %d and:\n%s\n' \
            "$*" "$wanted" "$text" "$code" "$output"
        failures=$((failures + 1))
    fi
}

cd / # Works in any folder.
expect 0 'Usage: bash cmake/setup.sh' --help
expect 3 'no command'
expect 3 "unknown argument 'bild'" bild
expect 3 "unknown argument '--fast'" build --fast
expect 3 "'build' and 'test'" build test
expect 3 "'docs' and 'demo'" docs demo
expect 3 "unknown argument '--benches'" packages --benches
expect 3 "--seconds 'ten'" demo --seconds ten
expect 3 "--seconds '0'" demo --seconds 0
expect 3 "--seconds ''" demo --seconds
expect 3 "--domain '233'" demo --domain 233
expect 3 "--quick, --peers and --docs are for 'bench' and 'rt-machine' only" test --quick
expect 3 "--quick, --peers and --docs are for 'bench' and 'rt-machine' only" packages --peers
expect 3 "--quick, --peers and --docs are for 'bench' and 'rt-machine' only" build --docs
expect 3 "--peers is for 'bench' only" rt-machine --peers
expect 3 "--arm64 is for 'rt-machine' only" bench --arm64
TACTUS_MESHES=nowhere expect 3 'TACTUS_MESHES must name the folder' bench --docs

# A dpkg without packages and a sudo that refuses represent a user without packages and root.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
printf '#!/bin/sh\nexit 1\n' | tee "$scratch/dpkg-query" "$scratch/sudo" >"$scratch/apt-get"
chmod +x "$scratch"/*
if ((EUID != 0)); then
    PATH="$scratch:$PATH" expect 2 \
        'apt-get install --no-install-recommends assimp-testmodels binutils cmake' packages
else
    PATH="$scratch:$PATH" expect 2 \
        'apt-get update failed; still missing: assimp-testmodels binutils cmake' packages
fi

# A checkout with one installed package; its build and its bench print their arguments.
mkdir -p "$scratch"/{tools,house/cmake,house/build/release/bin}
cp "$setup" "$scratch/house/cmake"
printf 'dpkg\n' | tee "$scratch"/house/cmake/packages{,-test}.txt \
    >"$scratch/house/cmake/packages-bench.txt"
printf '#!/bin/sh\necho "$@" >>"%s/built"\n' "$scratch" >"$scratch/tools/cmake"
bench=$scratch/house/build/release/bin/tactus_bench
printf '#!/bin/sh\necho "$@" >"%s/asked"\n' "$scratch" >"$bench"
chmod +x "$scratch/tools/cmake" "$bench"
counts_instructions() { # counts_instructions YES|NO OPTION...
    local wanted=$1 asked
    shift
    PATH="$scratch/tools:$PATH" bash "$scratch/house/cmake/setup.sh" bench "$@" \
        >"$scratch/said" 2>&1 || { cat "$scratch/said"; failures=$((failures + 1)); }
    asked=" $(<"$scratch/asked") "
    if [[ "$asked" == *' --instructions '* ]]; then
        asked=YES
    else
        asked=NO
    fi
    [[ "$asked" == "$wanted" ]] || {
        printf 'setup.sh bench %s: instructions are counted: %s\n' "$*" "$asked"
        failures=$((failures + 1))
    }
}
counts_instructions YES --peers
counts_instructions NO --peers --quick
counts_instructions NO

# Programs only, without tests and their needs.
rm "$scratch/built"
PATH="$scratch/tools:$PATH" bash "$scratch/house/cmake/setup.sh" programs >"$scratch/said" 2>&1 \
    || { cat "$scratch/said"; failures=$((failures + 1)); }
if ! grep -q -e '-DTACTUS_TESTS=OFF' "$scratch/built" || ! grep -q ' --target .*hrtc' \
    "$scratch/built" || grep -qE ' (all|test_[a-z]+)( |$)' "$scratch/built"; then
    printf 'setup.sh programs: %s\n' "$(<"$scratch/built")"
    failures=$((failures + 1))
fi

if ((failures > 0)); then
    exit 1
fi

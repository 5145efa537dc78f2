#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_no_avx.sh KERNELS FILE...: fails when code of an archive, object or program FILE needs more
# than a plain x86-64 processor: a VEX- or EVEX-coded instruction (AVX, FMA, BMI). Left out are the
# kernel objects, archive members that match the shell pattern KERNELS, and in programs what those
# define, since they run only where the processor was asked. A kernel object may therefore share no
# function with others: the linker could keep its copy for all. And neither fused multiplication nor
# estimates may be in it, which would change bits.
set -euo pipefail
if (($# < 2)); then
    echo "usage: check_no_avx.sh KERNELS FILE..." >&2
    exit 3
fi
readonly kernels=$1
shift
for file in "$@"; do
    [[ -r "$file" ]] || { echo "check_no_avx.sh: $file can't be read" >&2; exit 3; }
done

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
faults=0

# What the kernel objects define, and what they would share.
: >"$scratch/own"
for file in "$@"; do
    [[ "$file" == *.a ]] || continue
    nm -A --defined-only --format=posix "$file" 2>/dev/null | while read -r place name kind _; do
        member=${place##*[}
        # shellcheck disable=SC2053 # The right side is a pattern on purpose.
        if [[ "${member%%]*}" == $kernels ]]; then
            echo "$kind $name ${member%%]*}"
        fi
    done >>"$scratch/own"
done
if grep -E '^[WVu] ' "$scratch/own" >"$scratch/shared"; then
    while read -r _ name member; do
        echo "$member: shares $(c++filt "$name") with objects that are not kernels"
    done <"$scratch/shared"
    faults=1
fi
awk '$1 ~ /[tT]/ { print $2 }' "$scratch/own" | sort -u >"$scratch/skipped"

# Every VEX and EVEX instruction: names in v but for two old ones, and the general-purpose ones.
foreign() { # foreign FILE
    objdump -d --no-show-raw-insn "$1" | awk -F '\t' -v kernels="$scratch/members" \
        -v skipped="$scratch/skipped" '
        BEGIN {
            while ((getline line < kernels) > 0) is_kernel[line] = 1
            while ((getline line < skipped) > 0) is_skipped[line] = 1
        }
        /file format/ { sub(/:.*/, ""); member = $0; is_program = member !~ /\.o$/ }
        /^[0-9a-f]+ <.*>:$/ { sub(/^[0-9a-f]+ </, ""); sub(/>:$/, ""); symbol = $0 }
        NF < 2 { next }
        { split($2, words, " "); name = words[1] }
        member in is_kernel && name ~ /^v(fn?m(add|sub)|fmaddsub|fmsubadd|rcp|rsqrt)/ {
            print member ": " symbol ": " $2
        }
        !(member in is_kernel) && !(is_program && symbol in is_skipped) {
            if ((name ~ /^v/ && name !~ /^ver[rw]$/) || $2 ~ /%[yz]mm/ ||
                name ~ /^(andn|bextr|bls(i|r|msk)|bzhi|mulx|pdep|pext|rorx|sarx|shlx|shrx)[lq]?$/)
                print member ": " symbol ": " $2
        }'
}

for file in "$@"; do
    : >"$scratch/members"
    if [[ "$file" == *.a ]]; then
        ar t "$file" | while read -r member; do
            # shellcheck disable=SC2053 # The right side is a pattern on purpose.
            [[ "$member" != $kernels ]] || echo "$member"
        done >"$scratch/members"
    fi
    foreign "$file" >"$scratch/found"
    if [[ -s "$scratch/found" ]]; then
        echo "$file: $(wc -l <"$scratch/found") instructions that must not be there, first:"
        head -n 10 "$scratch/found" | c++filt
        faults=1
    fi
done
((faults == 0)) || exit 1
echo "$# files need nothing but x86-64; left out: $(wc -l <"$scratch/skipped") kernel functions"

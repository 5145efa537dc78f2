#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_rt_core_instructions.sh ARCHIVE: fails when code of the archive enters the system, reads a
# clock or counter, or asks what the processor is: instructions that no symbol betrays. x86-64.
set -euo pipefail
if (($# != 1)) || [[ ! -r "${1:-}" ]]; then
    echo "usage: check_rt_core_instructions.sh ARCHIVE, readable" >&2
    exit 3
fi
code=$(objdump -d --no-show-raw-insn "$1")
if [[ "$code" != *'>:'* ]]; then
    echo "$1: holds no code; is it the right archive?" >&2
    exit 3
fi
found=$(awk -F '\t' '
    /file format/ { sub(/:.*/, ""); member = $0 }
    /^[0-9a-f]+ <.*>:$/ { sub(/^[0-9a-f]+ </, ""); sub(/>:$/, ""); symbol = $0 }
    NF >= 2 {
        split($2, words, " ")
        if (words[1] ~ /^(syscall|sysenter|int|rdtscp?|rdpmc|rdrand|rdseed|cpuid|pause)$/)
            print member ": " symbol ": " $2
    }' <<<"$code")
if [[ -n "$found" ]]; then
    echo "$1 has instructions that rt_core must not have:"
    c++filt <<<"$found"
    exit 1
fi
echo "no system call, clock, counter or random source in $(grep -c '>:$' <<<"$code") functions"

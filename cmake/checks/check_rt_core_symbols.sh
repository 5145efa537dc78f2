#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_rt_core_symbols.sh ARCHIVE ALLOWED [NM]: fails when an object of the archive needs a symbol
# that neither the archive itself nor a pattern in the file ALLOWED provides. Heap, locks, clocks,
# files and exceptions all come in as such symbols.
set -euo pipefail
if (($# < 2 || $# > 3)) || [[ ! -r "${1:-}" || ! -r "${2:-}" ]]; then
    echo "usage: check_rt_core_symbols.sh ARCHIVE ALLOWED [NM], both files readable" >&2
    exit 3
fi
readonly archive=$1 allowed=$2 nm=${3:-nm}

defined=$("$nm" --defined-only --format=posix "$archive" | awk 'NF > 1 { print $1 }' | sort -u)
needed=$("$nm" --undefined-only --format=posix "$archive" | awk 'NF > 1 { print $1 }' | sort -u)
if [[ -z "$defined" ]]; then
    echo "$archive: defines no symbol; is it the right archive?" >&2
    exit 3
fi
patterns=$(sed -e 's/[[:space:]]*#.*//' -e '/^$/d' "$allowed")
outside=$(comm -23 <(echo "$needed") <(echo "$defined"))
foreign=$(grep -vxE -e "$patterns" <<<"$outside" || true)
if [[ -n "$foreign" ]]; then
    echo "$archive needs what rt_core must not call (allowed: $allowed):"
    while IFS= read -r symbol; do
        echo "  $(c++filt "$symbol") in" \
            "$("$nm" -A --undefined-only "$archive" | grep -w -- "$symbol" | cut -d: -f2 | sort -u \
                | tr '\n' ' ')"
    done <<<"$foreign"
    exit 1
fi
echo "rt_core needs only: ${outside//$'\n'/ }"

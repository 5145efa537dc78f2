#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_platform_symbols.sh ARCHIVE ALLOWED [NM]: fails when an object of the archive needs a symbol
# that neither the archive itself nor a pattern in the file ALLOWED provides for that object. What
# one system has and others do not comes in as such symbols.
set -euo pipefail
if (($# < 2 || $# > 3)) || [[ ! -r "${1:-}" || ! -r "${2:-}" ]]; then
    echo "usage: check_platform_symbols.sh ARCHIVE ALLOWED [NM], both files readable" >&2
    exit 3
fi
readonly archive=$1 allowed=$2 nm=${3:-nm}

# Lines "symbol object" of the archive's objects; nm names them as archive[object.o]:.
symbols() { # symbols OPTION
    "$nm" -A "$1" --format=posix "$archive" \
        | sed -n 's/^[^[]*\[\(.*\)\.o\]: \([^ ]*\) .*$/\2 \1/p' | sort -u
}

defined=$(symbols --defined-only)
if [[ -z "$defined" ]]; then
    echo "$archive: defines no symbol; is it the right archive?" >&2
    exit 3
fi
# Three lists: what is allowed, what is defined, what is needed.
foreign=$(awk '
    FNR == 1 { ++list; only = "" }
    list == 1 {
        sub(/[ \t]*#.*/, "")
        if (/^\[any\]$/) {
            only = ""
        } else if (/^\[only .*\]$/) {
            only = " " substr($0, 7, length($0) - 7) " "
        } else if ($0 != "") {
            pattern[++patterns] = "^(" $0 ")$"
            objects[patterns] = only
        }
        next
    }
    list == 2 { ours[$1] = 1; next }
    $1 in ours { next }
    {
        for (i = 1; i <= patterns; ++i) {
            if ($1 ~ pattern[i] && (objects[i] == "" || index(objects[i], " " $2 " "))) {
                next
            }
        }
        print
    }' "$allowed" <(echo "$defined") <(symbols --undefined-only))
if [[ -n "$foreign" ]]; then
    echo "$archive needs what not every system has (allowed: $allowed):"
    while read -r symbol object; do
        echo "  $(c++filt "$symbol") in $object.o"
    done <<<"$foreign"
    exit 1
fi
echo "the platform needs nothing but C++, C, POSIX and, in their objects, the extras"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hello.sh HELLO SPM_BUILD PAGE: the program touches a model as PAGE says, and PAGE shows its
# source.
set -euo pipefail
readonly hello=$1 build=$2 page=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }

# The page's one block of C++.
# shellcheck disable=SC2016 # Backquotes as they stand in the page.
sed -n '/^```cpp$/,/^```$/p' "$page" | sed '1d;$d' >shown.cpp
diff "$here/hello.cpp" shown.cpp || fail "$page shows another program than hello.cpp"

"$build" --shape torus --faces 2000 -o torus.spm >/dev/null 2>&1
said=$("$hello" torus.spm) || fail "hello ends with $?: $said"
grep -qxF "$said" "$page" || fail "hello says '$said', the page something else"

code=0
"$hello" other.spm >out.txt 2>said.txt || code=$?
[[ $code == 2 && ! -s out.txt && $(<said.txt) == 'hello: other.spm: '* ]] \
    || fail "a missing file: exit $code, $(<said.txt)"

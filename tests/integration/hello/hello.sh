#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hello.sh HELLO SPM_BUILD PAGE: PAGE's lines for a shell touch a model with the stated output, and
# it shows the program's source.
set -euo pipefail
readonly hello=$1 build=$2 page=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }

# Single C++ block of the page.
# shellcheck disable=SC2016 # Backquotes as they stand in the page.
sed -n '/^```cpp$/,/^```$/p' "$page" | sed '1d;$d' >shown.cpp
diff "$here/hello.cpp" shown.cpp || fail "$page shows another program than hello.cpp"

# Lines of the page, with the build folder at their path.
mkdir -p build/release/{bin,tests}
ln -s "$build" build/release/bin/spm_build
ln -s "$hello" build/release/tests/hello
# shellcheck disable=SC2016 # Backquotes as they stand in the page.
sed -n '/^```sh$/,/^```$/p' "$page" | sed '1d;$d' >shown.sh
said=$(bash -eu shown.sh 2>log.txt) || fail "the page's lines end with $?: $said $(<log.txt)"
said=$(tail -n 1 <<<"$said") # The earlier lines are spm_build's.
grep -qxF "$said" "$page" || fail "hello says '$said', the page something else"

code=0
"$hello" other.spm >out.txt 2>said.txt || code=$?
[[ $code == 2 && ! -s out.txt && $(<said.txt) == 'hello: other.spm: '* ]] \
    || fail "a missing file: exit $code, $(<said.txt)"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hello.sh HELLO GUARDED SPM_BUILD EXAMPLES PAGE: PAGE shows the two programs of EXAMPLES, its lines
# for a shell touch a model with the stated output, and both refuse a missing model in one line.
set -euo pipefail
readonly hello=$1 guarded=$2 build=$3 examples=$4 page=$5
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }

# C++ blocks of the page, in order; the licence is not shown.
# shellcheck disable=SC2016 # Backquotes as they stand in the page.
sed -n '/^```cpp$/,/^```$/{/^```/d;p}' "$page" >shown.cpp
sed -s 1,2d "$examples/hello.cpp" "$examples/guarded.cpp" >there.cpp
diff there.cpp shown.cpp || fail "$page shows other programs than the examples"

# Lines of the page, with the build folder at their path.
mkdir -p build/release/{bin,tests}
ln -s "$build" build/release/bin/spm_build
ln -s "$hello" build/release/tests/hello
ln -s "$guarded" build/release/tests/guarded
# shellcheck disable=SC2016 # Backquotes as they stand in the page.
sed -n '/^```sh$/,/^```$/{/^```/d;p}' "$page" >shown.sh
said=$(bash -eu shown.sh 2>log.txt) || fail "the page's lines end with $?: $said $(<log.txt)"
force=$(grep '^force ' <<<"$said") || fail "hello says nothing: $said"
grep -qxF "$force" "$page" || fail "hello says '$force', the page something else"
[[ $(grep -cE '^ *-?[0-9]+\.[0-9]{3} N ' <<<"$said") -ge 10 ]] || fail "guarded says: $said"

for program in hello guarded; do
    code=0
    "${!program}" other.spm >out.txt 2>said.txt || code=$?
    [[ $code == 2 && ! -s out.txt && $(wc -l <said.txt) == 1 \
        && $(<said.txt) == "$program: "*' the World has no object; refused: other.spm: '* ]] \
        || fail "a missing file: exit $code, $(<said.txt)"
done

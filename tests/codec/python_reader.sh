#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# python_reader.sh SPM_BUILD: a second reader, written by docs/internals/spm-format.md, must find
# the sources in the files of spm_build, and refuse the files with a changed byte.
set -euo pipefail
readonly build=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly reader="$here/read_spm.py"
command -v python3 >/dev/null || {
    echo 'skipped: no python3 here'
    exit 77
}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
# figure NAME FILE: prints a number of a flat JSON object.
figure() { sed -n "s/.*\"$1\": *\(-\{0,1\}[0-9]*\).*/\1/p" "$2"; }

# agrees SHAPE FACES EULER: compares the reader's result with spm_build's output and Euler's number.
agrees() {
    local name wanted
    "$build" --shape "$1" --faces "$2" -o "$1.spm" --json >built.json 2>/dev/null
    python3 "$reader" "$1.spm" >read.json || fail "$1 is refused"
    for name in faces vertices records base_faces; do
        wanted=$(figure $name built.json)
        [[ -n "$wanted" && $(figure $name read.json) == "$wanted" ]] \
            || fail "$1: $name is $(figure $name read.json), not $wanted"
    done
    [[ $(figure euler read.json) == "$3" ]] || fail "$1: Euler's number $(figure euler read.json)"
}

agrees torus 1000 0
[[ $(figure faces read.json) == 1000 ]] || fail "a torus of $(figure faces read.json) faces"
[[ $(figure border_edges read.json) == 0 ]] || fail 'the torus has a border'
agrees terrain 1000 1
(($(figure border_edges read.json) > 0)) || fail 'the terrain has no border'

# Changes one byte at a time, in one process. The step is prime, so that header, base, index and
# chunks are changed at all alignments.
python3 - "$here" torus.spm <<'PYTHON' || fail 'a changed byte'
import sys

sys.path.insert(0, sys.argv[1])
import read_spm

table = read_spm.read_table(read_spm.TABLE)
whole = open(sys.argv[2], "rb").read()
for at in range(0, len(whole), 53):
    data = bytearray(whole)
    data[at] ^= 64
    try:
        read_spm.figures(bytes(data), table)
    except read_spm.Refused:
        continue
    sys.exit(f"byte {at} of {len(whole)} is another, and nothing is refused")
PYTHON

# refuses FILE WHAT: expects exit code 1 and one line, without a trace.
refuses() {
    local code=0
    python3 "$reader" "$1" >out.txt 2>said.txt || code=$?
    if ((code != 1)) || [[ -s out.txt || $(wc -l <said.txt) != 1 ||
        $(<said.txt) != "read_spm.py: $1: "* ]]; then
        fail "$2: exit $code, $(<said.txt)"
    fi
}
size=$(stat -c %s torus.spm)
readonly size
cp torus.spm other.spm
printf '\xff\xff' | dd of=other.spm bs=1 seek=$((size / 2)) conv=notrunc status=none
refuses other.spm 'two bytes changed'
head -c $((size - 1)) torus.spm >other.spm
refuses other.spm 'one byte cut off'
head -c 100 torus.spm >other.spm
refuses other.spm 'cut in the header'
{ cat torus.spm; printf x; } >other.spm
refuses other.spm 'one byte more'

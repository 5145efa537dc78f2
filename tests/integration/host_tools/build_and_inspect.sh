#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_and_inspect.sh SPM_BUILD SPM_INSPECT: what goes right: figures, extraction, replacing a
# file, an interrupted run.
set -euo pipefail
readonly build=$1 inspect=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
# figure NAME: a number of spm_build's JSON, one flat line on stdin.
figure() { sed -n "s/.*\"$1\": *\([-+.e0-9]*\).*/\1/p"; }
# seen NAME: the same of spm_inspect's, whose outermost figures are indented by two.
seen() { sed -n "s/^  \"$1\": \([-+.e0-9]*\),*$/\1/p" seen.json; }

[[ $("$build" --version) == 'spm_build '* ]] || fail 'spm_build --version'
[[ $("$inspect" --version) == 'spm_inspect '* ]] || fail 'spm_inspect --version'
[[ $("$build" --help) == *--position-bits* ]] || fail 'spm_build --help'
[[ $("$inspect" --help) == *--extract* ]] || fail 'spm_inspect --help'

"$build" --shape torus --faces 5000 -o torus.spm --json >built.json 2>notes.txt
"$inspect" torus.spm --json >seen.json
for name in faces vertices records rounds base_faces chunks; do
    [[ -n $(figure $name <built.json) ]] || fail "no $name in spm_build's figures"
    [[ $(figure $name <built.json) == $(seen $name) ]] || fail "$name differs"
done
for name in seconds faces_per_second peak_bytes file_bytes bytes_per_face quantisation_diag \
    e_max_diag regions; do
    [[ -n $(figure $name <built.json) ]] || fail "no $name in spm_build's figures"
done
[[ $(figure file_bytes <built.json) == $(stat -c %s torus.spm) ]] || fail 'file_bytes'
# Through a file: grep -q would end the pipe, and so the program, too early.
"$inspect" torus.spm --regions >text.txt
grep -q 'chunks sound' text.txt || fail 'the text says nothing of sound chunks'
grep -q '^region [0-9]*: cell' text.txt || fail '--regions'

# At, below and above what the model has, and between.
faces=$(figure faces <built.json)
base=$(figure base_faces <built.json)
readonly faces base
for wanted in 1 "$base" 1000 "$faces" 99999; do
    "$inspect" torus.spm --json --extract --faces "$wanted" -o out.ply >/dev/null 2>said.txt
    has=$(sed -n 's/^out.ply: \([0-9]*\) faces$/\1/p' said.txt)
    least=$((wanted < base ? base : (wanted > faces ? faces : wanted - 1)))
    most=$((wanted < base ? base : (wanted > faces ? faces : wanted)))
    ((has >= least && has <= most)) || fail "--faces $wanted gave $has"
    "$build" out.ply -o again.spm --json --base-faces 16384 >again.json 2>/dev/null
    [[ $(figure faces <again.json) == "$has" ]] || fail "out.ply does not have $has faces"
done

# The same input gives the same file, whatever the threads; an old file is replaced.
printf 'old' >one.spm
"$build" --shape torus --faces 5000 --threads 1 -o one.spm >/dev/null 2>&1
cmp torus.spm one.spm || fail 'the file depends on the threads'

# A face count that the shape can't have is said.
"$build" --shape sphere --faces 3000 -o sphere.spm --json >/dev/null 2>notes.txt
grep -q '3000 faces were asked for' notes.txt || fail 'no word about the rounded face count'

# An interrupted run leaves nothing.
mkdir half
"$build" --shape bumpy-sphere --faces 400000 -o half/a.spm >/dev/null 2>&1 &
readonly job=$!
sleep 1
kill -TERM "$job"
wait "$job" && fail 'the interrupted run says that it is done'
[[ -z $(ls -A half) ]] || fail "left behind: $(ls -A half)"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_and_inspect.sh SPM_BUILD SPM_INSPECT: successful runs: figures, extraction, replacement of a
# file, an interrupted run.
set -euo pipefail
readonly build=$1 inspect=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
# figure NAME: prints a number of spm_build's JSON, one flat line on stdin.
figure() { sed -n "s/.*\"$1\": *\([-+.e0-9]*\).*/\1/p"; }
# seen NAME: the same for spm_inspect's JSON, whose outermost figures are indented by two.
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
keys=$(grep -o '"[a-z_]*":' built.json | tr -d '":' | sort | paste -sd ' ')
[[ $keys == 'base_faces bytes_per_face chunks e_max_diag faces faces_per_second file_bytes'\
' hausdorff_diag_sampled metres_per_unit peak_bytes quantisation_diag records regions rounds'\
' seconds vertices' ]] \
    || fail "the figures are: $keys"
for name in $keys; do
    [[ -n $(figure "$name" <built.json) ]] || fail "$name is no number"
done
# Sampled distances cannot exceed certified ones; the base mesh of a torus is not exact.
awk -v sampled="$(figure hausdorff_diag_sampled <built.json)" \
    -v bound="$(figure e_max_diag <built.json)" \
    'BEGIN { exit !(0 < sampled && sampled <= bound && bound < 10 * sampled) }' \
    || fail 'the sampled distance and the certified bound'
# An unlikely size is noted, with a better unit; an explicit one is not.
printf 'v 0 0 0\nv 300 0 0\nv 0 400 0\nf 1 2 3\n' >large.obj
"$build" large.obj -o large.spm >large.txt 2>notes.txt
grep -q '^note: the model is 500 m across; .* --unit mm (0.5 m) or cm (5 m), --scale' notes.txt \
    || fail "$(cat notes.txt)"
"$build" large.obj -o large.spm --unit MM >large.txt 2>notes.txt
grep -q '^diagonal 0.5 m, a unit of the mesh is 0.001 m' large.txt || fail "$(cat large.txt)"
"$build" large.obj -o large.spm --fit-diag 20 >large.txt 2>>notes.txt
grep -q '^diagonal 20 m, a unit of the mesh is 0.04 m' large.txt || fail "$(cat large.txt)"
[[ ! -s notes.txt ]] || fail "$(cat notes.txt)"
# expect_placed LOW HIGH, for each axis, ARGUMENT...: expects large.obj's model at this place in
# spm_inspect.
expect_placed() {
    "$build" large.obj -o placed.spm "${@:7}" >/dev/null 2>notes.txt || fail "$(cat notes.txt)"
    "$inspect" placed.spm | awk -v expected="${*:1:6}" '
        /^bounds/ { found = found " " $3 " " $5 }
        END { split(expected, e); n = split(found, f)
              for (i = 1; i <= 6; ++i) if ((f[i] - e[i]) ^ 2 > 1e-9) exit 1
              exit n != 6 }' || fail "${*:7}: $("$inspect" placed.spm | grep '^bounds')"
}
printf 'v 1000 7000 2\nv 1300 7000 2\nv 1000 7400 8\nf 1 2 3\n' >large.obj
expect_placed 1 1.3 7 7.4 0.002 0.008 --scale 1e-3
expect_placed 1 1.3 -0.008 -0.002 7 7.4 --scale 1e-3 --up y
expect_placed -0.15 0.15 -0.003 0.003 -0.2 0.2 --unit mm --up y --center
expect_placed -0.15 0.15 -0.2 0.2 -0.003 0.003 --fit-diag 0.500036 --center
expect_placed -0.15 0.15 -0.2 0.2 -0.003 0.003 --unit mm --center
grep -qx 'note: moved by -1.15, -7.2, -0.005 m to the origin' notes.txt || fail "$(cat notes.txt)"
"$build" large.obj -o far.spm --fit-diag 0.2 >/dev/null 2>notes.txt
grep -q '^note: the model lies [0-9.]* m from its origin, .* --center moves the model' notes.txt \
    || fail "$(cat notes.txt)"
# A need beyond the memory limit is refused before the work, with the least sufficient limit.
"$build" --shape sphere --faces 100000 -o refused.spm --memory-mib 30 2>said.txt && fail '30 MiB'
least=$(sed -n 's/.* faces needs \([0-9]*\) MiB; --memory-mib allows 30$/\1/p' said.txt)
"$build" --shape sphere --faces 100000 -o refused.spm --memory-mib "$((least - 1))" 2>said.txt \
    && fail "$((least - 1)) MiB"
[[ ! -e refused.spm ]] || fail 'a refused model is there'
"$build" --shape sphere --faces 100000 -o allowed.spm --memory-mib "$least" --json >allowed.json \
    2>said.txt || fail "$(cat said.txt)"
(($(figure peak_bytes <allowed.json) <= least << 20)) || fail "it took $(cat allowed.json)"
[[ $(figure file_bytes <built.json) == $(stat -c %s torus.spm) ]] || fail 'file_bytes'
# A file replaces the pipe, which grep -q would close too early for the program.
"$inspect" torus.spm --regions >text.txt
grep -q 'chunks sound' text.txt || fail 'the text says nothing of sound chunks'
grep -q '^region [0-9]*: cell' text.txt || fail '--regions'
# Each record's vertex is new, has an existing parent, and is one of the source's.
"$inspect" torus.spm --records >records.txt
"$inspect" torus.spm --extract --error 0 -o whole.obj >/dev/null 2>&1
awk -v records="$(figure records <built.json)" -v vertices="$(figure vertices <built.json)" '
    function place(x, y, z) { return sprintf("%.7f %.7f %.7f", x, y, z) }
    FNR == NR { if ($1 == "v") at[place($2, $3, $4)] = 1; next }
    !/^vertex / { next }
    { vertex = $2 + 0; depth[vertex] = $6 + 0; from[vertex] = $4 + 0
      if (!(place($8, $9, $10) in at)) exit bad = 1 }
    END {
        if (bad || length(depth) != records) exit 1
        for (vertex in depth) {
            if (vertex + 0 < vertices - records || vertex + 0 >= vertices) exit 1
            if (from[vertex] >= vertices || depth[vertex] < 1) exit 1
            if (from[vertex] in depth && depth[from[vertex]] >= depth[vertex]) exit 1
        }
    }' whole.obj records.txt || fail "--records: $(tail -n 3 records.txt)"

# Points outside of a ring: its middle, and one far above.
printf '# three\n0 0 0\n\n0 0 10\n' >points.txt
"$inspect" torus.spm --distances points.txt >distances.txt
[[ $(grep -c ' outside ' distances.txt) == 2 ]] || fail "$(cat distances.txt)"
awk '/^#/ { next } { if ($2 - $1 > 1e-12 * $2) exit 1; d[++n] = $1 }
    END { exit !(n == 2 && d[2] > 9.9 && d[2] < 10) }' distances.txt || fail "$(cat distances.txt)"
"$inspect" torus.spm --distances points.txt --json >distances.json
[[ $(grep -c '"side": "outside"' distances.json) == 2 ]] || fail "$(cat distances.json)"

# Face counts at, below and above the model's, and between.
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

# extract NAME ARGUMENT...: the mesh NAME, said to have as many faces as can be read back.
extract() {
    "$inspect" torus.spm --extract "${@:2}" -o "$1" >/dev/null 2>said.txt
    has=$(sed -n "s/^$1: \([0-9]*\) faces$/\1/p" said.txt)
    "$build" "$1" -o again.spm --json --base-faces 16384 >again.json 2>/dev/null
    [[ $(figure faces <again.json) == "$has" ]] || fail "$1 does not have $has faces"
}
# bound: prints the greatest error bound of the last extraction, in metres.
bound() { sed -n 's/^error bound *\([^ ]*\) m at most$/\1/p' said.txt; }

# The formats contain the same mesh; an error bound is kept; a bound of zero gives the whole model.
extract some.ply --error 5e-4
some=$has
((some > base && some < faces)) || fail "--error 5e-4 gave $some faces"
awk -v bound="$(bound)" 'BEGIN { exit !(0 < bound && bound <= 5e-4) }' \
    || fail "--error 5e-4 gave a bound of $(bound)"
for suffix in obj stl OBJ; do
    extract "some.$suffix" --error 5e-4
    [[ $has == "$some" ]] || fail "some.$suffix has $has faces, some.ply $some"
done
extract all.stl --error 0
[[ $has == "$faces" && $(bound) == 0 ]] || fail "--error 0 gave $has faces, bound $(bound)"

# A region is fine inside, with the requested outside.
extract ball.ply --region sphere:0.05,0,0,0.02
ball=$has
inside=$(sed -n 's/^region *\([0-9]*\) faces of the source$/\1/p' said.txt)
((inside > 50 && inside < ball && ball < faces)) || fail "a sphere: $inside inside, $ball faces"
extract filled.ply --region sphere:0.05,0,0,0.02 --faces $((ball + 500))
((has > ball + 498 && has <= ball + 500)) || fail "a sphere and $((ball + 500)) faces: $has"
extract few.ply --region sphere:0.05,0,0,0.02 --faces 1
cmp ball.ply few.ply || fail 'a ball and too few faces'
extract close.ply --region box:0,-1,-1,1,1,1 --error 5e-4
((has > some && has < faces)) || fail "a box and an error: $has faces"

# A mesh from a pipe gives the same model; points may come from a pipe too.
"$build" some.ply -o named.spm >/dev/null 2>&1
"$build" - --format ply -o piped.spm <some.ply >/dev/null 2>&1 || fail 'standard input'
cmp named.spm piped.spm || fail 'standard input gives another model'
"$build" <(cat some.ply) --format ply -o piped.spm >/dev/null 2>&1 || fail 'a pipe'
cmp named.spm piped.spm || fail 'a pipe gives another model'
"$build" <(cat some.ply) -o piped.spm 2>said.txt && fail 'a pipe without --format'
grep -q 'a pipe needs --format' said.txt || fail "a pipe without --format: $(cat said.txt)"
printf '0 0 0\n' >point.txt
"$inspect" named.spm --distances point.txt >said.txt || fail '--distances'
"$inspect" named.spm --distances - <point.txt | cmp - said.txt || fail '--distances -'

# The same input gives the same file with any threads; an old file is replaced.
printf 'old' >one.spm
"$build" --shape torus --faces 5000 --threads 1 -o one.spm >/dev/null 2>&1
cmp torus.spm one.spm || fail 'the file depends on the threads'

# An impossible face count of a shape is reported.
"$build" --shape sphere --faces 3000 -o sphere.spm --json >/dev/null 2>notes.txt
grep -q '3000 faces were requested' notes.txt || fail 'no word about the rounded face count'

# An interrupted run leaves nothing.
mkdir half
"$build" --shape bumpy-sphere --faces 400000 -o half/a.spm >/dev/null 2>&1 &
readonly job=$!
# A third of a second of CPU time is within the work, which prints nothing.
until (($(awk '{ print $14 + $15 }' "/proc/$job/stat") * 3 > $(getconf CLK_TCK))); do
    sleep 0.05
done
kill -TERM "$job"
wait "$job" && fail 'the interrupted run says that it is done'
[[ -z $(ls -A half) ]] || fail "left behind: $(ls -A half)"

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# bad_input.sh SPM_BUILD SPM_INSPECT: every kind of bad input gives the right exit code and exactly
# one line that begins with the program's name and states the fault; no file is left behind.
# ServerOptions covers wrong options, and ReadMesh faults within a mesh.
set -euo pipefail
readonly build=$1 inspect=$2
scratch=$(mktemp -d)
trap 'chmod -R u+w "$scratch"; rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir in out
failures=0

# expect CODE TEXT PROGRAM ARGUMENT...: expects one line with TEXT, and an unchanged out/.
expect() {
    local code=0 wanted=$1 text=$2 output before
    shift 2
    before=$(ls -A out)
    output=$("$@" 2>&1) || code=$?
    if ((code != wanted)) || [[ "$output" != "$(basename "$1"): "*"$text"* ]] \
        || [[ "$output" == *$'\n'* ]] || [[ "$(ls -A out)" != "$before" ]]; then
        printf '%s\n  expected exit %d, one line with "%s" and no new file\n' "$*" "$wanted" "$text"
        printf '  got exit %d, files "%s" and:\n%s\n' "$code" "$(ls -A out)" "$output"
        failures=$((failures + 1))
    fi
}

# refuse_mesh TEXT NAME: expects in/NAME to be refused by its name, with exit 2.
refuse_mesh() { expect 2 "$1" "$build" "in/$2" -o out/a.spm; }

readonly vertices='v 0 0 0
v 1 0 0
v 0 1 0'
printf '%s\nf 1 2 4\n' "$vertices" >in/beyond.obj
printf 'v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n' >in/point.obj
printf '%s\nf 1 2 3\n' "$vertices" >in/mesh.obj
cp in/mesh.obj in/mesh.spm

refuse_mesh 'in/missing.obj: no such file' missing.obj
refuse_mesh 'in/beyond.obj: line 4: ' beyond.obj
refuse_mesh 'in/point.obj: no face is left' point.obj
refuse_mesh "in/mesh.spm: begins like a obj file, unlike its name: give --format obj" \
    mesh.spm

expect 2 nowhere/a.spm "$build" in/mesh.obj -o nowhere/a.spm
mkdir out/folder.spm
expect 2 folder.spm "$build" in/mesh.obj -o out/folder.spm
if ((EUID != 0)); then # Root may write anywhere.
    chmod u-w out
    expect 2 out/a.spm "$build" in/mesh.obj -o out/a.spm
    chmod u+w out
fi
# Rings keep their holes, so each keeps at least 14 faces: the base of 50 of them grows.
awk 'BEGIN {
    for (ring = 0; ring < 50; ++ring) {
        for (i = 0; i < 16; ++i) {
            across = int(i / 4) * 1.5708
            round = (i % 4) * 1.5708
            radius = 3 + cos(round)
            print "v", radius * cos(across) + 10 * ring, radius * sin(across), sin(round)
        }
        for (i = 0; i < 16; ++i) {
            a = 16 * ring + 1 + i
            b = 16 * ring + 1 + int(i / 4) * 4 + (i + 1) % 4
            c = 16 * ring + 1 + (i + 4) % 16
            d = 16 * ring + 1 + (int(i / 4) * 4 + 4) % 16 + (i + 1) % 4
            print "f", a, c, b
            print "f", b, c, d
        }
    }
}' >in/rings.obj
"$build" in/rings.obj -o rings.spm >rings.log 2>&1 || failures=$((failures + 1))
grep -q 'note: the base mesh has [0-9]* faces instead of 500' rings.log ||
    { cat rings.log; failures=$((failures + 1)); }
# Separate triangles vanish into each other.
for ((i = 0; i < 600; ++i)); do
    printf 'v %d 0 0\nv %d 1 0\nv %d 0 1\nf -3 -2 -1\n' $((2 * i)) $((2 * i)) $((2 * i))
done >in/soup.obj
"$build" in/soup.obj -o soup.spm >soup.log 2>&1 || failures=$((failures + 1))
grep -q 'on a base of 500 faces' soup.log || { cat soup.log; failures=$((failures + 1)); }
expect 2 --region-size "$build" in/mesh.obj --region-size 1e-9 -o out/a.spm

expect 2 'in/missing.spm: cannot be opened: No such file or directory' "$inspect" in/missing.spm
expect 2 'in: ' "$inspect" in
"$build" --shape sphere --faces 2000 -o out/sphere.spm >/dev/null 2>&1
bytes=$(stat -c %s out/sphere.spm)
readonly bytes
head -c $((bytes - 1)) out/sphere.spm >in/cut.spm
expect 2 'the file is cut short' "$inspect" in/cut.spm
cp out/sphere.spm in/bent.spm
printf '\xff' | dd of=in/bent.spm bs=1 seek=$((bytes - 100)) conv=notrunc status=none
expect 2 'in/bent.spm: chunk' "$inspect" in/bent.spm
expect 2 '--region: the region meets no face of the model, whose bounds are x -' \
    "$inspect" out/sphere.spm --extract --region sphere:9,9,9,0.1 -o out/a.ply
expect 2 nowhere/a.ply "$inspect" out/sphere.spm --json --extract --faces 100 -o nowhere/a.ply

# refuse_points TEXT LINE...: refuses points of a file, by the number of the line or of the point.
refuse_points() {
    printf '%s\n' "${@:2}" >in/points.txt
    expect 2 "in/points.txt: $1" "$inspect" out/sphere.spm --distances in/points.txt
}
refuse_points 'line 2: has fewer than the three numbers' '0 0 0' '1 2'
refuse_points 'line 3: has more than the three numbers' '# two' '' '1 2 3 4'
refuse_points "line 1: '1mm' is not a finite number" '1mm 0 0'
refuse_points "line 1: 'nan' is not a finite number" '0 nan 0'
refuse_points 'point 1 (0 0 1e+300): not within' '0 0 0' '0 0 1e300'
expect 2 'in/nowhere.txt: no such file' "$inspect" out/sphere.spm --distances in/nowhere.txt
echo '0 0 0' >in/point.txt
expect 2 'in/bent.spm: 1 piece is damaged' "$inspect" in/bent.spm --distances in/point.txt
# Vertices so far from the origin that floats cannot distinguish them.
awk '/^v/ { printf "v %.3f %s %s\n", $2 + 5e7, $3, $4; next } 1' in/mesh.obj >in/far.obj
"$build" in/far.obj --fit-diag 0.1 -o in/far.spm >/dev/null 2>&1
expect 2 "out/a.stl: STL's 32-bit coordinates" \
    "$inspect" in/far.spm --extract --error 0 -o out/a.stl

((failures == 0)) || { printf '%d faults\n' "$failures"; exit 1; }

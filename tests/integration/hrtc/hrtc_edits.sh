#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_edits.sh: simulated operators carve a published model, one and then two at a time; others
# that only touch it, from the beginning and later, have the same surface as the server; the run
# replays; the saved file has lost the volume that the server reports; editors without the right,
# servers and tools that can't edit are refused by name.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-20000 bumpy.spm
carves=(--model bumpy --tool sphere:0.002 --motion slide --edit carve:200 --pool-mib 16)

# volume_mm3 FILE: prints the volume of a closed mesh in an OBJ file.
volume_mm3() {
    python3 - "$1" <<'PYTHON'
import sys

corners, volume = [], 0.0
for line in open(sys.argv[1]):
    words = line.split()
    if words[:1] == ["v"]:
        corners.append([float(word) for word in words[1:4]])
    elif words[:1] == ["f"]:
        a, b, c = (corners[int(word.split("/")[0]) - 1] for word in words[1:4])
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                   + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
print(volume * 1e9)
PYTHON
}
# of_edits PATTERN: prints the number that PATTERN captures in the server's last line of edits.
of_edits() { sed -n "s/^.*edits of 'bumpy': .*$1.*\$/\\1/p" publish.log; }
# of_report FILE KEY: prints a number of the first model in a report.
of_report() {
    python3 -c 'if True:
        import json, sys
        print(json.load(open(sys.argv[1]))["models"][0][sys.argv[2]])' "$@"
}

# Two hands carve; a third one touches the model from the beginning to the end.
start_publisher bumpy.spm --edits --edit-room 16384 --save carved.spm
start_hrtc --model bumpy --motion free --pool-mib 16 --duration 600 --report watching.json
watching=$controller
mv hrtc.log watching.log
start_hrtc "${carves[@]}" --duration 4 --name second --report second.json
second=$controller
mv hrtc.log second.log
run_hrtc "${carves[@]}" --duration 4 --name first --record carved.rec
wait "$second" || fail "the second hand ended with $?: $(cat second.log)"
check_clean report.json
for report in report.json second.json; do
    check "$report" carving.sent '>' 0 carving.volume_mm3 '>' 0 carving.samples_lost == 0 \
        models.0.edits '>' 0 models.0.added_faces '>' 0
done
grep -q '^carving  *[0-9]* edit requests sent' hrtc.log || fault 'the summary tells no carving'
"$hrtc" --replay carved.rec >replay.log 2>&1 || fault "another replay: $(cat replay.log)"

# One that joins later has the sum of all edits.
contact=0 run_hrtc --model bumpy --motion free --pool-mib 16 --duration 4
cp report.json late.json
kill -TERM "$watching"
wait "$watching" || fail "the watching controller ended with $?: $(cat watching.log)"
stop_publisher
cat publish.log
added=$(of_edits ' \([0-9]*\) of [0-9]* added faces')
removed=$(of_edits ' \([0-9.]*\) mm^3 removed')
((added > 0)) || fail "added faces: '$added'"
for report in watching.json late.json; do
    [[ $(of_report "$report" added_faces) == "$added" ]] \
        || fault "$report: $(of_report "$report" added_faces) added faces, not $added"
done

# The saved file is a sound model with that revision, and has lost that volume.
"$inspect" carved.spm --json >carved.json || fault 'carved.spm is not sound'
check carved.json revision == "$(of_edits ' \([0-9]*\) edits\{0,1\},')" is_closed == 1
"$inspect" bumpy.spm --extract --error 0 -o before.obj >/dev/null
"$inspect" carved.spm --extract --error 0 -o after.obj >/dev/null
awk -v before="$(volume_mm3 before.obj)" -v after="$(volume_mm3 after.obj)" -v removed="$removed" \
    'BEGIN { off = before - after - removed
             exit !(before > after && off < 0.02 * removed && off > -0.02 * removed) }' \
    || fault "lost $(volume_mm3 before.obj) - $(volume_mm3 after.obj), not $removed mm^3"

# Editors without the right change nothing.
start_publisher bumpy.spm --edits --edits-from elsewhere:1
run_hrtc "${carves[@]}" --duration 2
check report.json carving.sent '>' 0 models.0.edits == 0
stop_publisher
grep -q "edits of 'bumpy': 0 changes" publish.log || fault 'an editor without the right'
grep -Eq '0 edit requests accepted, [1-9][0-9]* refused' publish.log || fault "$(cat publish.log)"

# Servers and tools that can't edit.
start_publisher bumpy.spm
expect_found 2 '--edit: no model can be edited; start its server with --edits' "${carves[@]}"
stop_publisher
finish

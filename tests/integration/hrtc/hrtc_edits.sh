#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_edits.sh: simulated operators carve a published model, one and then two at a time; others
# that only touch it, from the beginning and later, have the same surface as the server; the run
# replays; the saved file has lost the volume that the server reports; editors without the right,
# servers and tools that can't edit are refused by name.
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/edits.sh"
model bumpy-sphere-20000 bumpy.spm
carves=(--model bumpy --tool sphere:0.002 --motion slide --edit carve:200 --pool-mib 16)

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
((added > 0)) || fail "added faces: '$added'"
for report in watching.json late.json; do
    [[ $(of_report "$report" added_faces) == "$added" ]] \
        || fault "$report: $(of_report "$report" added_faces) added faces, not $added"
done

check_saved "$inspect"

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

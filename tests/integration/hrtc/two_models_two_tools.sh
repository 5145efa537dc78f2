#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# two_models_two_tools.sh: every pair of a tool and a model is answered and reported. The ring is
# upright through the sphere, so that the hands, which follow the sphere, meet both.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-20000 first.spm
model torus-10000 second.spm
start_publisher first.spm second.spm
[[ $(grep -c '^serving ' publish.log) == 2 ]] || fault "not two models: $(cat publish.log)"
run_hrtc --model first --model second --place 0,0,0 --place 0.035,0,0,0,90,0,0.7 \
    --tool sphere:0.002 --tool sphere:0.004 --duration 3 --pool-mib 4
check report.json frames == 3000 models == 2 tools == 2 pairs == 4 \
    tools.0.radius_m == 0.002 tools.1.radius_m == 0.004 pools.total_bytes '<=' 4194304 \
    pairs.0.tool+pairs.1.tool+pairs.2.tool+pairs.3.tool == 2
for i in 0 1 2 3; do
    pair=pairs.$i.answers
    check report.json $pair.bounded '<' '0.01*frames' $pair.stale == 0 \
        $pair.exact '>' 0 $pair.exact+$pair.separated+$pair.bounded+$pair.stale '<=' '1*frames'
done
for i in 0 1; do
    check report.json models.$i.pieces_refused == 0 models.$i.bytes_received '>' 0 \
        tools.$i.force_max_n '>' 0
    check_contact report.json tools.$i.contact_share 0.5
done
check_answers report.json
check_clean report.json

# Objects of one model, more than are ever near, and tools of one size.
places=(--place "0,0,0")
for i in {1..40}; do
    places+=(--place "$((i % 7)),$((i / 7)),1")
done
run_hrtc --model second "${places[@]}" --tools 2 --duration 3 --pool-mib 4
check report.json models == 1 tools == 2 scene.objects == 41 scene.objects_max == 41 \
    scene.pairs_awake_max '<=' 8 scene.capacity_exceeded_frames == 0 scene.traversals '>' 0 \
    work.skipped.objects '>' '76*frames' pairs.0.object == 0 faults.scene_over_capacity == 0 \
    pools.total_bytes '<=' 4194304
check_answers report.json
check_clean report.json
# Each hand as configured, on the named model or its own.
run_hrtc --virtual-time --model first.spm --model second.spm --place 0,0,0 --place 0.5,0,0 \
    --tools 3 --motion tap:second --motion slide:second --motion slide:first --duration 3 \
    --pool-mib 4
check report.json pairs == 3 pairs.0.object == 1 pairs.1.object == 1 pairs.2.object == 0
run_hrtc --virtual-time --model first.spm --model second.spm --place 0,0,0 --place 0.5,0,0 \
    --tools 3 --duration 3 --pool-mib 4
check report.json pairs.0.object == 0 pairs.1.object == 1 pairs.2.object == 0
for i in 0 1 2; do
    check_contact report.json tools.$i.contact_share 0.3
done
finish

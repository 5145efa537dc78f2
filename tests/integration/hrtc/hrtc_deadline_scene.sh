#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_deadline_scene.sh: 200 objects of two models and four tools at 1 kHz, in pools of 2 MiB,
# without an overrun.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 ball.spm
model torus-10000 ring.spm

# Ten by twenty objects, 0.3 m apart.
objects=()
for ((i = 0; i < 200; ++i)); do
    file=ball
    ((i % 2 == 0)) || file=ring
    row=$((i / 10))
    objects+=("object-$i $file $((i % 10 * 3))e-1 $((row * 3))e-1")
done
scene scene.gltf "${objects[@]}"

deadline_test --scene scene.gltf --tools 4 --duration 2 --load none
check run.json frames == 2000 scene.objects == 200 scene.objects_max == 200 \
    scene.objects_room == 200 scene.pairs_room == 32 scene.pairs_awake_max '>=' 4 \
    scene.pairs_awake_max '<=' 32 scene.changes_refused.number_too_big == 0 force.max_n '>' 0
((ended_with != 0)) || check run.json self_check.passed == 1 deadline.overrun == 0
finish

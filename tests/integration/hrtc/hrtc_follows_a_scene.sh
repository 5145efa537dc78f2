#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_follows_a_scene.sh: touches a server's whole scene: objects that are added, moved and
# removed; a server that dies and one that takes over; objects that cannot be touched; missing
# scenes.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 ball.spm
model torus-10000 ring.spm

scene bench.gltf 'ball ball 0' 'ring-1 ring 0.5' 'ring-2 ring 1'
scene other.gltf 'ball ball 0' 'ring-1 ring 0.6' 'late ball 2' 'later ball 3'
cat >poses.txt <<'POSES'
0.5 ring-1 gone
1.0 ring-1 0.4 0 0 0 0 0 1
1.1 ball material stiffness=300,static=0.4,viscosity=1
1.2 ring-2 1.2 0 0 0 0 0 1
1.4 ball material stiffness=800,texture_height=2e-5,texture_length=1e-3
1.5 ring-2 1.0 0 0 0 0 0 1
POSES

# All of the server's objects are present, added and removed.
start_publisher bench.gltf --scene workshop --poses poses.txt --poses-loop
grep -qx "showing 3 objects as scene 'workshop'" publish.log || fault 'no name of the scene'
run_hrtc --scene workshop --duration 4 --record scene.rec
check_answers report.json
check_clean report.json
check report.json models == 2 scene.objects_max == 3 scene.added '>=' 2 scene.removed '>=' 2 \
    scene.material_changes '>=' 3 scene.ignored == 0 models.0.pose.followed == 1 \
    scene.changes_refused.not_here == 0 scene.changes_refused.already_here == 0 \
    scene.changes_refused.old_generation == 0 scene.changes_refused.bad_pose == 0 \
    scene.changes_refused.bad_material == 0
"$hrtc" --replay scene.rec >replay.log 2>&1 || fault "another replay: $(cat replay.log)"
grep -q '^scene .* objects*, at most 3; ' hrtc.log || fault 'the summary tells no scene'

# Run with a shaped tool.
contact=0 run_hrtc --scene workshop --duration 2 --tool box:0.02,0.015,0.01,0.001
check_clean report.json
check report.json scene.objects_max == 3 tools.0.torque_max_nm '>' 0 tools.0.twist_max_rad '>' 0

# Objects stay in place.
contact=0 run_hrtc --scene workshop --duration 1 --ignore-poses
check report.json scene.objects_room == 512 scene.pairs_room == 32 \
    scene.objects_max '<=' 3 scene.added == 0 scene.removed == 0 \
    models.0.pose.followed == 0

# The server dies; one with the same scene takes over if permitted, with one object more than the
# capacity.
stop KILL "$publisher"
start_publisher bench.gltf --scene workshop --watch
start_hrtc --scene workshop --failover any --objects 3 --duration 600 --report report.json
wait_for_contact publish.log
stop KILL "$publisher"
wait_for_line hrtc.log 'disconnected'
start_publisher other.gltf --scene workshop --watch
wait_for_contact publish.log
wait_for_more_frames 500 publish.log
stop_hrtc
check report.json scene.objects == 3 scene.objects_max == 3 scene.objects_room == 3 \
    scene.pairs_room == 3 scene.added == 3 \
    scene.removed == 3 scene.ignored == 1 \
    scene.changes_refused.number_too_big == 0 wire.server_lost == 1 \
    tools.0.contact_share '>' 0 answers.stale '>' 0 servers.replaced == 1
check_clean report.json

# Missing scenes, and exceeded capacities.
expect_found 2 "--scene: 'kitchen' is not shown on domain $domain (scenes there: workshop)" \
    --scene kitchen
expect_found 2 '--objects: 2 is less than the 4 objects at the start' --scene workshop --objects 2
expect 3 "--scene: name 'a/b.gltf' is not 1 to 63 bytes" "$hrtc" \
    --transport dds --scene a/b.gltf
stop_publisher
expect 3 "--scene: 'a b' is not" "$publish" --domain "$domain" --scene 'a b' ball.spm
start_publisher ball.spm --scene nothing
expect_found 2 "--scene: 'nothing' has no object with a model that its server serves on domain" \
    --scene nothing
finish

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_follows_poses.sh: a server moves an object while the tool touches it; poses that stop and
# resume; a controller that ignores them; the server's view of the controller; refused pose files.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 bumpy.spm

# Swing of 4 mm in x within two seconds, 100 poses a second; the model is 173 mm across.
awk 'BEGIN {
    print "# time name x y z qx qy qz qw"
    for (i = 0; i <= 200; ++i)
        printf "%.3f bumpy %.6f 0 0 0 0 0 1\n", i / 100, 0.002 * sin(i * 3.14159265 / 100)
}' >swing.txt

# check_steps: a followed object moves little in each frame, unless frames were lost.
check_steps() { was_held_up report.json || check report.json models.0.pose.step_max_m '<' 0.005; }

# The object moves, the force follows, and the server reports it.
start_publisher bumpy.spm --poses swing.txt --poses-loop --watch
run_hrtc --model bumpy --duration 2.5 --record swing.rec
"$hrtc" --replay swing.rec >replay.log 2>&1 || fault "another replay: $(cat replay.log)"
check_clean report.json
check_answers report.json
check report.json models.0.pose.followed == 1 models.0.pose.accepted '>' 50 \
    models.0.pose.moves '>' 50 \
    models.0.pose.refused.rotation == 0 models.0.pose.refused.not_newer == 0 \
    force.max_n '>' 0 safety.begun.jump == 0 telemetry.sent '>' 50
check_steps
grep -q '^poses  *bumpy: moved in [0-9]* frames' hrtc.log || fault 'the summary tells no poses'
wait_until 'word of the server on a tool in contact and a pose that is followed' \
    grep -q '^watch hrtc-[0-9]*: .* N in contact.*; bumpy .* pages.* pose ' publish.log

# A controller that ignores poses: still visible, but nothing moves.
contact=0 run_hrtc --model bumpy --duration 1 --ignore-poses
check report.json models.0.pose.followed == 0 models.0.pose.accepted == 0 \
    telemetry.sent '>' 10 answers.stale == 0

# Poses stop: the touched object becomes stale and the force fades; poses and force return. A fully
# resident model needs no server for anything else.
start_hrtc --model bumpy --duration 600 --report report.json
wait_for_contact publish.log "hrtc-$controller"
kill -STOP "$publisher"
wait_for_more "$controller"
kill -CONT "$publisher"
wait_for_more_frames 900 publish.log "hrtc-$controller"
stop_hrtc
check report.json frames '>' 1500 answers.stale '>' 300 models.0.pose.old_frames '>' 300 \
    models.0.pose.age_max_s '>' 0.5 models.0.static == 1 \
    safety.begun.stale '>=' 1 safety.begun.server == 0 answers.stale '<' '0.9*frames'
check_clean report.json
stop_publisher

# Files have no poses, but a viewer of the domain sees the run.
contact=0 run_hrtc --transport file --model bumpy.spm --duration 0.5
check report.json models.0.pose.followed == 0 telemetry.sent '>' 0

# An object jumps far while it is touched: the force fades and returns by the ramp.
printf '0 bumpy 0 0 0 0 0 0 1\n0.5 bumpy 0.04 0 0 0 0 0 1\n1 bumpy 0 0 0 0 0 0 1\n' >jump.txt
start_publisher bumpy.spm --poses jump.txt --poses-loop --watch
start_hrtc --model bumpy --duration 600 --motion slide --report report.json
wait_for_contact publish.log
wait_for_more_frames 1500 publish.log
stop_hrtc
check report.json safety.begun.jump '>=' 1 models.0.pose.step_max_m '>' 0.039
check_clean report.json
stop_publisher

# Half a metre from its place in the file, sent in lines a second apart: hand and object begin
# there, the motion is blended, and the hand follows.
printf '%s\n' '0 bumpy 0.5 0 0 0 0 0 1' '1 bumpy 0.5 0.03 0 0 0 0.1 0.995' \
    '2 bumpy 0.5 0 0 0 0 0 1' >far.txt
start_publisher bumpy.spm --poses far.txt --poses-loop --poses-rate 100
contact=0.3 run_hrtc --model bumpy --duration 4
check report.json models.0.pose.accepted '>' 100 models.0.pose.moves '>' 100 \
    safety.begun.jump == 0
check_steps
check_contact report.json force.contact_share 0.3
check_clean report.json
stop_publisher

refuse() { expect "$1" "$2" "$publish" --domain "$domain" --seconds 5 bumpy.spm "${@:3}"; }
bad_line() {
    printf '0 bumpy 0 0 0 0 0 0 1\n%s\n' "$2" >bad.txt
    refuse 2 "bad.txt: line 2: $1" --poses bad.txt
}
refuse 3 'needs --poses' --poses-loop
refuse 2 'missing.txt: cannot be opened' --poses missing.txt
: >empty.txt
refuse 2 'empty.txt: has no line' --poses empty.txt
printf '0 bumpy 0 0 0 0 0 0 1\n' >still.txt
refuse 2 'still.txt: --poses-loop needs' --poses still.txt --poses-loop
bad_line 'is neither TIME_S NAME' '1 bumpy 0 0 0'
bad_line "time '-1'" '-1 bumpy 0 0 0 0 0 0 1'
bad_line "no object is called 'bunny'" '1 bunny 0 0 0 0 0 0 1'
bad_line "'nan' is not a finite" '1 bumpy nan 0 0 0 0 0 1'
bad_line 'QX QY QZ QW must have a length within 0.001 of 1' '1 bumpy 0 0 0 0 0 0 1.1'
bad_line 'X Y Z must be' '1 bumpy 2e4 0 0 0 0 0 1'
bad_line 'SCALE must be 0.001 to 1000' '1 bumpy 0 0 0 0 0 0 1 0'
finish

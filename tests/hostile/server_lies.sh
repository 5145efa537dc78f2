#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# server_lies.sh BIN CHECK_REPORT SANITIZER ATTACK: a server behaves correctly until the tool
# touches its model; checks the force afterwards.
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly attack=$4
model bumpy-sphere-20000 bumpy.spm

touch_it() { # touch_it ARGUMENT...
    start_publisher bumpy.spm --watch "${poses[@]}"
    start_hrtc --model bumpy --no-static --name victim --device sim:touch --duration 600 \
        --report report.json "$@"
    wait_for_contact publish.log victim
}
poses=()
end_well() { # end_well FRAMES: ends after this number of further frames.
    wait_for_more_frames "$1" publish.log victim
    stop_hrtc
    cat publish.log
    check_clean report.json
    stop_publisher
}
check_starved() { # For data that the server cannot send: reported, and the force fades.
    check report.json safety.begun.starved '>=' 1 models.0.pieces_overdue '>=' 1 \
        force.max_n '<' 3.3
    grep -Eq '^verdict .*starved [0-9]' hrtc.log || fault 'the verdict does not say starved'
    check_sizes hrtc.log publish.log
}

case $attack in
    server_swings)
        # Motion by 4 mm to and fro, 250 times a second, for two of three seconds: 2 N a step at 500
        # N/m.
        awk 'BEGIN {
            print "0 bumpy 0 0 0 0 0 0 1"
            for (i = 250; i <= 750; ++i)
                printf "%.3f bumpy %.3f 0 0 0 0 0 1\n", i / 250, i % 2 ? 0.004 : 0
        }' >swing.txt
        poses=(--poses swing.txt --poses-loop)
        touch_it --motion slide
        end_well 2500
        check report.json models.0.pose.rate_limited_frames '>' 100 wire.server_lost == 0
        # Steps of the force are checked by test_hrtc MovedObject, on a lasting touch: here the hand
        # sometimes releases, and the object it meets then moves freely, 1 mm a frame, with or
        # without the guard.
        ;;
    file_cut)
        touch_it
        truncate -s 20000 bumpy.spm
        wait_for_line hrtc.log "has not arrived; the surface there stays coarse"
        end_well 2500
        check_starved
        ;;
    second_server)
        # Another server has the same model, so it takes over when the first one ends, and then
        # sends nothing of it.
        touch_it
        first=$publisher
        mv publish.log first.log
        mkdir second
        cp bumpy.spm second/bumpy.spm
        start_publisher second/bumpy.spm --watch
        truncate -s 20000 second/bumpy.spm
        kill -KILL "$first"
        wait_for_line hrtc.log "has not arrived; the surface there stays coarse"
        end_well 2500
        check_starved
        was_held_up report.json || check report.json force.max_step_n '<' 0.45
        ;;
    *) fail "there is no attack $attack" ;;
esac
finish

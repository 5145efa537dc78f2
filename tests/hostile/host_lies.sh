#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# host_lies.sh BIN CHECK_REPORT SANITIZER ATTACK: a host that is honest until the tool touches what
# it serves; what is felt then.
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly attack=$4
model bumpy-sphere-20000 bumpy.spm

touch_it() { # touch_it SECONDS ARGUMENT...
    start_hrtc --model bumpy --no-static --name victim --device sim:touch --duration "$1" \
        --report report.json "${@:2}"
    wait_for_line publish.log 'controller victim subscribed' 10
}
end_well() {
    local code=0
    wait "$controller" || code=$?
    cat hrtc.log publish.log
    ((code == 0)) || fail "hrtc ended with $code"
    check_clean report.json
    stop TERM "$publisher"
    ((stopped_with == 0)) || fault "spm_publish ended with $stopped_with"
}

case $attack in
    host_swings)
        # 4 mm to and fro, 250 times a second, from 3 s on: 2 N a step at 500 N/m.
        awk 'BEGIN {
            print "0 bumpy 0 0 0 0 0 0 1"
            for (i = 750; i <= 2500; ++i)
                printf "%.3f bumpy %.3f 0 0 0 0 0 1\n", i / 250, i % 2 ? 0.004 : 0
        }' >swing.txt
        start_publisher bumpy.spm --poses swing.txt
        touch_it 6 --motion slide
        end_well
        check report.json frames == 6000 models.0.pose.outran_frames '>' 100 wire.host_lost == 0
        # Steps of the force are held by test_hrtc MovedObject, on a touch that lasts: here the hand
        # lets go at times, and what it then meets moves freely, 1 mm a frame, guard or not.
        ;;
    file_cut)
        start_publisher bumpy.spm
        touch_it 8
        sleep 2 # In contact.
        truncate -s 20000 bumpy.spm
        end_well
        check report.json frames == 8000 safety.begun.starved '>=' 1 \
            models.0.pieces_overdue '>=' 1 force.max_n '<' 3.3
        grep -Eq '^verdict .*starved [0-9]' hrtc.log || fault 'the verdict does not say starved'
        grep -q "doesn't come; the surface there stays coarse" hrtc.log \
            || fault 'no line names the piece'
        (($(wc -l <hrtc.log) < 100 && $(wc -l <publish.log) < 200)) || fault 'the logs are full'
        ;;
    second_host)
        # Another host has the same model, so it steps in when the first one goes, and then sends
        # nothing of it.
        start_publisher bumpy.spm
        touch_it 8
        first=$publisher
        mv publish.log first.log
        mkdir second
        cp bumpy.spm second/bumpy.spm
        start_publisher second/bumpy.spm
        truncate -s 20000 second/bumpy.spm
        sleep 1 # In contact.
        kill -KILL "$first"
        end_well
        check report.json frames == 8000 \
            safety.begun.starved '>=' 1 models.0.pieces_overdue '>=' 1 force.max_n '<' 3.3
        was_held_up report.json || check report.json force.max_step_n '<' 0.45
        ;;
    *) fail "there is no attack $attack" ;;
esac
finish

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# at_the_door.sh BIN CHECK_REPORT SANITIZER ATTACK: unauthenticated peers at the port of a udp
# device, and a mesh made to keep spm_build busy.
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
flood=$(cd "$(dirname "$0")" && pwd)/datagrams.py
readonly docs flood
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly attack=$4
readonly port=$((20000 + $$ % 20000))

drive() { # drive [DRIVER]: starts a driver; its id is in $driving.
    PYTHONPATH=$docs/examples python3 "${1:-$docs/examples/udp_driver.py}" "$port" 0.02 \
        >driver.log 2>&1 &
    driving=$!
    started+=("$driving")
}
# The refusal is named; no force exceeds the device's, and there is no overrun.
end_well() { # end_well REFUSAL
    stop_hrtc
    check report.json frames '>' 300 force.max_n '<=' 8 "tools.0.traffic.refused.$1" '>=' 3
    check_clean report.json
    grep -q 'tool 0: [0-9]* datagrams* .* refused, mostly: ' hrtc.log \
        || fault 'no line tells of the strangers'
    check_sizes hrtc.log
}
touch_by_udp() {
    model bumpy-sphere-20000 bumpy.spm
    drive
    start_hrtc --transport file --model bumpy.spm --device "udp:$port" \
        --device-frame 0,0,0.06 --duration 600 --wait "$patience_s" --report report.json
    wait_for_line hrtc.log 'touch: '
    wait_for_more "$driving" 400
}

case $attack in
    udp_impostor)
        # It describes itself ten times a second, and waits for the driver to be silent longer than
        # hrtc's limit.
        touch_by_udp
        true_one=$driving
        drive
        wait_for_more "$driving" 800
        kill -STOP "$true_one"
        wait_for_more "$driving" 200
        kill -CONT "$true_one"
        wait_for_more "$driving" 500
        end_well foreign
        # Only the true instance, despite its pauses: no force for the other.
        check report.json tools.0.traffic.samples '>' 100
        ;;
    udp_first_liar)
        # First and stronger: a driver that claims 1,000 N. While the true one also describes
        # itself, none is accepted; when the false one is gone the true one is, with its own limits.
        # A later false one in its place ends the run.
        model bumpy-sphere-20000 bumpy.spm
        sed 's/force_max_n=8,/force_max_n=1000,/' "$docs/examples/udp_driver.py" >liar.py
        cmp -s liar.py "$docs/examples/udp_driver.py" && fail 'the driver tells its force otherwise'
        drive "$PWD/liar.py"
        liar=$driving
        drive
        start_hrtc --transport file --model bumpy.spm --device "udp:$port" \
            --device-frame 0,0,0.06 --duration 600 --wait "$patience_s" --report report.json
        wait_for_more "$liar" 400
        wait_for_more "$driving" 100
        ! grep -q 'touch: ' hrtc.log || fault 'one of two that say to be the device was taken'
        stop KILL "$liar"
        wait_for_line hrtc.log 'touch: '
        wait_for_more "$driving" 400
        true_one=$driving
        drive "$PWD/liar.py"
        wait_for_more "$driving" 200
        stop KILL "$true_one"
        end_hrtc 2
        grep -q 'another device describes itself at its port; the run ends' hrtc.log \
            || fault 'hrtc does not say why it ended'
        check report.json frames '>' 300 force.max_n '<=' 8 tools.0.traffic.refused.foreign '>=' 3 \
            tools.0.traffic.refused.other_device '>=' 5 tools.0.traffic.sessions == 1
        check_clean report.json
        ;;
    udp_flooded)
        touch_by_udp
        python3 "$flood" "$port" 0 >flood.log || fault "the flood: $(cat flood.log)"
        end_well size
        check report.json tools.0.traffic.samples '>' 100
        ;;
    edge_faces)
        # 8,000 faces around one edge: as many pieces at one place, which vanish into each other.
        awk 'BEGIN {
            print "v 0 0 0\nv 0 0 1"
            for (i = 0; i < 8000; ++i) {
                a = 6.283185307 * i / 8000
                printf "v %.9f %.9f 0.5\n", cos(a), sin(a)
                printf "f 1 2 %d\n", i + 3
            }
        }' >fan.obj
        # Half of them in each round. Ten minutes of CPU time detect a hang.
        code=0
        (ulimit -t 600 && "$build" fan.obj --unit m -o fan.spm) >build.log 2>&1 || code=$?
        ((code == 0)) || fail "spm_build ended with $code: $(cat build.log)"
        grep -Eq '^fan.spm: 8000 faces, .* records in ([1-9]|[12][0-9]) rounds ' build.log \
            || fault "so many rounds: $(cat build.log)"
        "$inspect" fan.spm >said.txt 2>&1 || fault "spm_inspect ended with $?: $(cat said.txt)"
        ;;
    *) fail "there is no attack $attack" ;;
esac
finish

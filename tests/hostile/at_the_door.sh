#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# at_the_door.sh BIN CHECK_REPORT SANITIZER ATTACK: strangers at the port of a udp device, and a
# mesh that is made to keep spm_build busy.
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
flood=$(cd "$(dirname "$0")" && pwd)/datagrams.py
readonly docs flood
source "$(dirname "$0")/../integration/hrtc/common.sh"
readonly attack=$4
readonly port=$((20000 + $$ % 20000))

drive() { # drive: a driver of its own; its id is in $driving.
    python3 "$docs/examples/udp_driver.py" "$port" 0.02 >driver.log 2>&1 &
    driving=$!
    started+=("$driving")
}
# What it names; no force from it above the device's, no own fault.
end_well() { # end_well REFUSAL
    stop_hrtc
    check report.json frames '>' 300 force.max_n '<=' 8 "tools.0.traffic.refused.$1" '>=' 3
    check_clean report.json
    grep -q 'tool 0: [0-9]* datagrams .* refused, most of them: ' hrtc.log \
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
        # It describes itself ten times a second, and waits for the driver to stumble: for longer
        # than hrtc takes to miss it.
        touch_by_udp
        true_one=$driving
        drive
        wait_for_more "$driving" 800
        kill -STOP "$true_one"
        wait_for_more "$driving" 200
        kill -CONT "$true_one"
        wait_for_more "$driving" 500
        end_well foreign
        # The true one's instance alone, however often it stumbled: no force for the other.
        check report.json tools.0.traffic.samples '>' 100
        ;;
    udp_flooded)
        touch_by_udp
        python3 "$flood" "$port" 0 >flood.log || fault "the flood: $(cat flood.log)"
        end_well size
        check report.json tools.0.traffic.samples '>' 100
        ;;
    edge_faces)
        # 3,000 faces round one edge.
        awk 'BEGIN {
            print "v 0 0 0\nv 0 0 1"
            for (i = 0; i < 3000; ++i) {
                a = 6.283185307 * i / 3000
                printf "v %.9f %.9f 0.5\n", cos(a), sin(a)
                printf "f 1 2 %d\n", i + 3
            }
        }' >fan.obj
        # What is left can't vanish in the rounds that are left. It may tell how far it is before.
        # Ten minutes of a processor are for what hangs.
        code=0
        (ulimit -t 600 && "$build" fan.obj --unit m -o fan.spm) >build.log 2>&1 || code=$?
        { ((code == 2)) && tail -n 1 build.log | grep -Eq \
            "not written: the mesh can't be simplified below 2[0-9]{3} faces"; } \
            || fault "spm_build ended with $code: $(cat build.log)"
        [[ ! -e fan.spm ]] || fault 'it wrote a model'
        ;;
    *) fail "there is no attack $attack" ;;
esac
finish

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_tools.sh: a tool of each form touches a ball, with a torque where it has a shape; one that is
# a mesh streams like what it touches, and its recording replays; hulls and meshes that can't be
# tools are refused by name.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-20000 ball.spm
model torus-10000 ring.spm
cat >wedge.off <<'END'
OFF
4 4 0
-0.01 -0.01 0
0.01 -0.01 0
0 0.01 0
0 0 0.02
3 0 2 1
3 0 1 3
3 1 2 3
3 2 0 3
END

# touch TORQUE ARGUMENT...: the tool is in contact, and turns the hand if TORQUE is 1.
touch() {
    local torque=$1
    shift
    run_hrtc "$@" --duration 3 --pool-mib 8
    check_clean report.json
    check report.json force.contact_share '>' 0 tools.0.force_max_n '>' 0 \
        answers.bracket+answers.stale '<' '0.05*frames'
    if ((torque)); then
        check report.json tools.0.torque_max_nm '>' 0 tools.0.twist_max_rad '>' 0
        grep -q '; torque at most' hrtc.log || fault 'no word of the torque'
    else
        check report.json tools.0.torque_max_nm == 0
    fi
}
touch_file() { touch "$1" --transport file --model ball.spm --tool "$2"; }
for tool in point sphere:0.02; do
    touch_file 0 "$tool"
    grep -q "\"shape\": *\"$tool\"" report.json || fault "the report does not name $tool"
done
for tool in capsule:0.005,0.05 box:0.04,0.03,0.02,0.001 hull:wedge.off,0.001; do
    touch_file 1 "$tool"
done

# A device without torque gets the force alone.
touch 0 --transport file --model ball.spm --tool capsule:0.005,0.05 --device sim:omega

# The probe streams from the same host.
"$build" --shape torus --faces 3000 --fit-diag 0.1 -o probe.spm >build.log 2>&1
start_publisher ball.spm probe.spm
touch 1 --model ball --tool mesh:probe,0.001 --record run.rec
check report.json models == 2 models.1.bytes_received '>' 0 scene.objects == 1 pairs == 1
stop TERM "$publisher"
"$hrtc" --replay run.rec >replay.log || fault "the recording of a mesh: $(tail -n 1 replay.log)"

# What is no tool.
refuse() { expect 2 "$1" "$hrtc" --allow-no-rt --transport file --model ball.spm --tool "$2"; }
refuse 'none.off' hull:none.off
refuse 'none.spm' mesh:none.spm
refuse "'ball.spm' is touched as well" mesh:ball.spm
{
    printf 'OFF\n65 1 0\n'
    for ((i = 100; i < 165; ++i)); do
        printf '0.%d 0 0\n' "$i"
    done
    printf '3 0 1 2\n'
} >many.off
refuse 'many.off: 65 corners; *at most 64' hull:many.off
sed 's/0.02$/2/' wedge.off >far.off
refuse 'far.off: corner (0, 0, 2) is 2 m from' hull:far.off
expect 2 '--pool-mib' "$hrtc" --allow-no-rt --transport file --model ball.spm \
    --tool mesh:ring.spm --pool-mib 0.3
finish

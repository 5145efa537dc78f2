#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_tools.sh: a tool of each form touches a sphere, with a torque if it has a shape, in the
# default pools; hands rotate it, move over edges with it, and put a peg into its hole by a clutch;
# a mesh tool streams like its object, and its recording replays; one larger than that, and one in
# its exact place, end well; flat hulls have a proxy; hulls and meshes that cannot be tools are
# refused by name. Parts without a server are in virtual time.
docs=$(cd "$(dirname "$0")/../../../docs" && pwd)
readonly docs
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

# touch TORQUE ARGUMENT...: the tool is in contact, and rotates the hand if TORQUE is 1.
touch() {
    local torque=$1
    shift
    contact=0 run_hrtc "$@" --duration "${seconds:-3}"
    check_clean report.json
    check report.json force.contact_share '>' 0 tools.0.force_max_n '>' 0 \
        answers.bounded+answers.stale '<' '0.05*frames'
    if ((torque)); then
        check report.json tools.0.torque_max_nm '>' 0 tools.0.twist_max_rad '>' 0
        grep -q '; torque at most' hrtc.log || fault 'no word of the torque'
    else
        check report.json tools.0.torque_max_nm == 0
    fi
}
touch_file() { touch "$1" --virtual-time --model ball.spm --tool "$2" "${@:3}"; }
for tool in point sphere:0.02; do
    touch_file 0 "$tool"
    grep -q "\"shape\": *\"$tool\"" report.json || fault "the report does not name $tool"
done
for tool in capsule:0.005,0.05 box:0.04,0.03,0.02,0.001 hull:wedge.off,0.001; do
    touch_file 1 "$tool"
done

# Only a sphere has force shading; the report names the tool.
run_hrtc --virtual-time --model ball.spm --tool sphere:0.02 --tool box:0.04,0.03,0.02,0.001 \
    --force-shading 0.005 --duration 3
check_clean report.json
check report.json tools.0.shading_m == 0.005 tools.0.force_max_n '>' 0 tools.1.shading_m == 0
touch_file 0 sphere:0.02
check report.json tools.0.shading_m == 0

# A device without torque gets only the force.
touch_file 0 capsule:0.005,0.05 --device sim:omega

# Hulls that are flat, or only a line.
printf 'OFF\n3 1 0\n-0.02 -0.02 0\n0.02 -0.02 0\n0 0.02 0\n3 0 1 2\n' >flat.off
printf 'OFF\n3 1 0\n0 0 -0.02\n0 0 0\n0 0 0.02\n3 0 1 2\n' >line.off
for file in flat.off line.off; do
    touch_file 1 "hull:$file,0.001"
done

expect 2 "--fixture: 'gripper:0': the device sim has no gripper force" \
    "$hrtc" --allow-no-rt ball.spm --fixture gripper:0

# Hands move 6-DoF tools; these have a mass that gravity compensation carries, and a spring pulls
# them to the middle of the sphere with its greatest force.
for motion in turn edge; do
    touch_file 1 box:0.04,0.03,0.02,0.001 --motion "$motion" --tool-mass 0.1,0,0.01,0 \
        --fixture point:0,0,0,100,0.25
    check report.json tools.0.mass_kg == 0.1 tools.0.load_max_n '>' 0.98 \
        tools.0.load_max_n '<' 0.981 tools.0.load_max_nm '>' 0.0095 \
        tools.0.fixture_max_n '>' 0.249 tools.0.fixture_max_n '<' 0.251
done

# A peg enters its hole, and a button separates it from the hand that retreats.
"$build" --shape socket --faces 500 -o socket.spm >build.log 2>&1
seconds=8 touch 1 --virtual-time --model socket.spm --tool capsule:0.0099,0.03 \
    --material 500,0.3,0.2 --motion peg --clutch 0 --fixture gripper:0.01,100,0.5 --record peg.rec
check report.json safety.begun.clutch '>=' 1
# The gripper, 20 mm open, is closed with half a newton, less than its spring's force.
"$hrtc" --replay peg.rec --export peg.csv >replay.log || fault "no export: $(cat replay.log)"
python3 - <<'PYTHON' || fault 'the gripper is not held'
import csv
sent = [float(line["tool0.sent_gripper_n"] or 0) for line in csv.DictReader(open("peg.csv"))]
assert min(sent) == -0.5 and max(sent) == 0 and sent.count(-0.5) > 4000, (min(sent), max(sent))
PYTHON
grep -q 'force off, causes: .*clutch' hrtc.log || fault 'nobody tells of the clutch'

# The probe streams from the same server.
"$build" --shape torus --faces 3000 --fit-diag 0.1 -o probe.spm >build.log 2>&1
start_publisher ball.spm probe.spm
seconds=2.5 touch 1 --model ball --tool mesh:probe,0.001 --pool-mib 8 --record run.rec
check report.json models == 2 models.1.bytes_received '>' 0 scene.objects == 1 pairs == 1
"$hrtc" --replay run.rec >replay.log || fault "the recording of a mesh: $(tail -n 1 replay.log)"

# An object is also a tool under another name: it is streamed twice.
hash=$(sed -n "s/^serving 'ball' hash \([0-9a-f]*\):.*/\1/p" publish.log)
seconds=2.5 touch 1 --model ball --tool "mesh:ball@$hash,0.001" --pool-mib 8
check report.json models == 2 models.1.bytes_received '>' 0
stop_publisher
touch_file 1 mesh:./ball.spm,0.001 --pool-mib 8

# A probe larger than the default pools is as coarse as they permit, and its answers are bounds.
model bumpy-sphere-200000 large.spm
run_hrtc --virtual-time --model ball.spm --tool mesh:large.spm,0.001 --duration 3
check_clean report.json
check report.json models.1.pages_used_max '>' 0 \
    answers.exact+answers.separated+answers.within_tolerance+answers.bounded '>' \
    '0.9*frames'

# Larger than its object.
"$build" --shape bumpy-sphere --faces 5000 --fit-diag 1.5 -o wide.spm >build.log 2>&1
run_hrtc --virtual-time --model ball.spm --tool mesh:wide.spm,0.001 --pool-mib 8 --duration 2
check_clean report.json
check report.json tools.0.force_max_n '<=' 8 \
    answers.exact+answers.separated+answers.within_tolerance '>' '0.9*frames'

# Equal to its object, in its place from the start: a device at rest in the middle.
readonly port=$((20000 + $$ % 20000))
python3 "$docs/examples/udp_driver.py" "$port" >driver.log 2>&1 &
started+=("$!")
"$hrtc" --allow-no-rt --wait "$patience_s" --transport file --model ball.spm \
    --tool mesh:./ball.spm,0.001 --pool-mib 16 --device "udp:$port" --duration 1 \
    --report report.json >hrtc.log 2>&1 \
    || fault 'two models in one place are more than it can stand'
check report.json tools.0.force_max_n '<=' 8 realtime.allocations '>=' 0
was_held_up report.json || check report.json answers.exact '>' 0

# Invalid tools.
refuse() { expect 2 "$1" "$hrtc" --allow-no-rt --transport file --model ball.spm --tool "$2"; }
refuse 'none.off' hull:none.off
refuse 'none.spm' mesh:none.spm
refuse "'ball.spm' is the model of an object as well" mesh:ball.spm
expect 2 'kg weigh 9.81 N; the device sim carries at most half of' "$hrtc" --allow-no-rt \
    --transport file --model ball.spm --tool-mass 1
expect 2 'cause a torque of 0.392 N m' "$hrtc" --allow-no-rt --transport file --model ball.spm \
    --tool box:0.04,0.03,0.02 --tool-mass 0.2,0.2,0,0
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

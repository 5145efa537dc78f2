#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_simulated_devices.sh: the controller on each kind of simulated device, in virtual time, which
# makes each run repeatable to the byte. The last argument is the stand-in of Force Dimension's SDK.
source "$(dirname "$0")/common.sh"
readonly stand_in=$4

model bumpy-sphere-20000 bumpy.spm
readonly model=(--virtual-time --model bumpy.spm)

# One device of each class. Its greatest stiffness is that of docs/stability.md.
run_hrtc "${model[@]}" --pool-mib 4 --duration 2 \
    --tool sphere:0.002 --tool sphere:0.002 --tool sphere:0.002 --tool sphere:0.002 \
    --device sim:touch --device sim:omega --device sim:delta --device sim
check report.json frames == 2000 tools.0.stiffness_limit_n_per_m == 400 \
    tools.1.stiffness_limit_n_per_m '>' 3059 tools.1.stiffness_limit_n_per_m '<' 3061 \
    tools.2.stiffness_limit_n_per_m '>' 3059 tools.2.stiffness_limit_n_per_m '<' 3061 \
    tools.3.stiffness_limit_n_per_m == 1800
grep -q '^touches  *bumpy: 0\.[0-9.x ]* m, around (0, 0, 0)$' hrtc.log \
    || fault 'it does not say where the object is'
grep -q '^tool  *sphere:0.002 on sim, .*: 1 object in reach; stiffness up to 400 N/m instead of' \
    hrtc.log || fault 'it does not say what the first tool can do'
grep -q '^tool  *sphere:0.002 on sim, .*: 1 object in reach; stiffness up to 500 N/m$' hrtc.log \
    || fault 'it does not say what the second tool can do'
for i in 0 1 2 3; do
    check report.json tools.$i.force_max_n '<' 3.3
    check report.json tools.$i.contact_share '>' 0.5
done
check_clean report.json

# Defaults of devices that do not report their limits: a simulated one, and one of Force
# Dimension's, with a stand-in of its SDK. A wall is 0.9 x 2 b / (T + 2 delay), docs/stability.md.
cp "$stand_in" libdhd.so
LD_LIBRARY_PATH=$PWD "$hrtc" --allow-no-rt bumpy.spm --duration 0.3 --stiffness 3000 --tools 2 \
    --device sim --device dhd --device-limits damping_n_s_per_m=0.5,delay_s=125e-6 \
    --device-limits damping_n_s_per_m=1 >limits.log 2>&1 || fault "limits: $(cat limits.log)"
wanted="stiffness up to 720 N/m instead of 3000 N/m because of its damping of 0.5 N s/m, delay of"
grep -q "^tool .* on sim, .*; $wanted 0.125 ms and the period of 1 ms$" limits.log \
    || fault "the simulated device has others: $(cat limits.log)"
wanted='stiffness up to 947.4 N/m instead of 3000 N/m because of its damping of 1 N s/m, delay of '
grep -q "^tool .* on stand-in, .*; $wanted" limits.log \
    || fault "the true device has others: $(cat limits.log)"

# An object out of reach is reported with the distance, and a default value is named as such.
"$hrtc" "${model[@]}" --model bumpy.spm --place 0,0,0.5 --material 400 --duration 0.3 >start.log
grep -q '^touches .*around (0, 0, 0.5)$' start.log || fault "the first object: $(cat start.log)"
wanted='no --place: placed as in the file; no --material: stiffness of --stiffness, no friction'
grep -q "^touches .*around (0, 0, 0); $wanted" start.log \
    || fault "the second object: $(cat start.log)"
LD_LIBRARY_PATH=$PWD "$hrtc" --allow-no-rt bumpy.spm --duration 0.3 --place 2,0,0 --device dhd \
    >far.log 2>&1 || fault "out of reach: $(cat far.log)"
# The device reaches 0.5 m.
python3 - far.log <<'CHECK' || fault "out of reach: $(cat far.log)"
import math, re, sys
text = open(sys.argv[1], encoding="utf-8").read()
edges = re.search(r"^touches .*: (\S+) x (\S+) x (\S+) m,", text, re.M).groups()
across = math.hypot(*map(float, edges))
radius = float(re.search(r"^tool +sphere:(\S+) ", text, re.M)[1])
beyond = float(re.search(r"NO OBJECT IN REACH: bumpy is (\S+) m beyond the reach;", text)[1])
sys.exit(abs(beyond - (2 - across / 2 - radius - 0.5)) > 0.005)
CHECK

# A tool on more faces than a frame evaluates reports it at the start, with the effect.
run_large() {
    "$hrtc" "${model[@]}" --tool box:0.05,0.05,0.05 --duration 0.1 "$@" >large.log \
        || fault "a large tool: $(cat large.log)"
}
readonly covers='^ +covers about [1-9][0-9]*00 faces of bumpy, but a frame searches 1024: the tool'
run_large
grep -qE "$covers touches a coarser surface" large.log || fault "$(cat large.log)"
run_large --force-tolerance 0
grep -qE "$covers MAY BE DATA-LIMITED" large.log || fault "without a tolerance: $(cat large.log)"
run_large --tool sphere:0.002
[[ $(grep -cE "$covers" large.log) == 1 ]] || fault "a small tool, too: $(cat large.log)"

# A damping that leaves no wall is refused, with a sufficient value; one that leaves some is
# accepted.
expect 2 "--material: a damping of 2 N s/m on 'bumpy' is too high for the device sim at 1000 Hz; \
at most 0.994 N s/m leaves a stiffness that can be felt, at most 0.722 N s/m one of 500 N/m" \
    "$hrtc" --allow-no-rt "${model[@]}" --duration 0.5 --material 500,0,0,2
run_hrtc "${model[@]}" --duration 0.5 --material 500,0,0,0.722
grep -q '^tool .*: 1 object in reach; stiffness up to 500 N/m$' hrtc.log \
    || fault 'less than that is not enough'

# Only a touched object softens a tool's wall.
run_hrtc "${model[@]}" --place 0,0,0 --place 1,0,0 --material 500 --material 500,0,0,0.9 \
    --tools 2 --pool-mib 4 --duration 2
check report.json tools.0.conditioned.stiffness_limited == 0 \
    tools.1.conditioned.stiffness_limited '>' 100 tools.1.least_stiffness_n_per_m '>' 179 \
    tools.1.least_stiffness_n_per_m '<' 181

# A run without a result is a failure under --strict.
code=0
"$hrtc" "${model[@]}" --duration 0.5 --motion free --strict >strict.log || code=$?
((code == 1)) || fault "--strict: a run without a touch ended with $code"
grep -q '^verdict .*nothing was touched' strict.log || fault 'the verdict is silent'

# Readings become wrong while the hand slides.
run_hrtc "${model[@]}" --duration 3 --device-fault jitter@700+50 --device-fault nan@1000+50 \
    --device-fault dropout@1300+50 --device-fault disconnect@1600+50 \
    --device-fault time_jump@1900+50 --device-fault stuck@2400+20
grep -q '^verdict .*force off, causes: .*disconnect 1.*; 1 device disconnection' hrtc.log \
    || fault 'the verdict does not tell of the device'
grep -q '^hrtc: tool 0: the device sim is disconnected; no force' hrtc.log \
    || fault 'nobody tells that it is gone'
grep -q '^hrtc: tool 0: the device sim is connected again' hrtc.log \
    || fault 'nobody tells that it is back'
check report.json frames == 3000 safety.begun.garbage '>=' 3 safety.begun.disconnect == 1 \
    tools.0.force_max_n '>' 0.5 tools.0.force_max_n '<=' 8
check_clean report.json

# The hand finds the surface again after repeated stalls, and the report distinguishes
# contact from force.
for length in 5 60; do
    dropouts=()
    for ((i = 0; i < 30; ++i)); do
        dropouts+=(--device-fault "dropout@$((200 + 155 * i))+$length")
    done
    run_hrtc "${model[@]}" --duration 5 "${dropouts[@]}"
    check report.json frames == 5000 force.force_share '>' 0.05
    check report.json force.contact_share '>' "0.$((80 - length / 2))"
done
check report.json force.force_share '<' '0.99*force.contact_share'

# Other motions.
run_hrtc "${model[@]}" --duration 1 --motion free
check report.json tools.0.contact_share == 0 tools.0.force_max_n == 0 # The run's end is no touch.
for motion in approach slide tap spin turn edge; do
    run_hrtc "${model[@]}" --duration 2 --motion "$motion"
    check report.json tools.0.force_max_n '>' 0.3 tools.0.force_max_n '<' 6
    check report.json tools.0.contact_share '>' 0.2
    check_clean report.json
done
run_hrtc "${model[@]}" --duration 3 --motion teleport
check report.json tools.0.force_max_n '>' 0 tools.0.force_max_n '<=' 8

# Repeated runs are equal, and so is their replay; a run is longer than the disk's queue.
for run in 1 2; do
    run_hrtc "${model[@]}" --pool-mib 0.7 --duration 8 --record "$run.rec" --report page.html
    check report.json realtime.virtual_time == 1 recording.frames == 8000 frames == 8000 \
        cache.evictions '>' 0 times_us.frame.max == 0 deadline.missed == 0
    grep -q '^times *none: virtual time stands still' hrtc.log \
        || fault 'it tells of times'
    check_clean report.json
done
cmp 1.rec 2.rec || fault 'virtual time does not repeat'
"$hrtc" --replay 1.rec || fault 'its recording does not replay'

# Options tied to the time of day are refused.
refuse() { expect 3 "--virtual-time: $1" "$hrtc" --virtual-time "${@:2}"; }
refuse 'models must be files' --model bumpy
refuse 'devices must be simulated or replayed' bumpy.spm --device udp

# A recorded hand has the same touch, and is gone after its end.
run_hrtc "${model[@]}" --duration 2 --record run.rec
check report.json tools.0.contact_share '>' 0.5
run_hrtc "${model[@]}" --duration 3 --device replay:run.rec
check report.json safety.begun.disconnect == 1 tools.0.contact_share '>' 0.33 \
    tools.0.contact_share '<' 0.67 tools.0.force_max_n '>' 0.5
check_clean report.json
expect 2 '--rate: 2000 Hz; the device replay takes 1000 to 1000 Hz' \
    "$hrtc" --allow-no-rt "${model[@]}" --rate 2000 --device replay:run.rec
expect 2 '--device: bumpy.spm: *is not a Tactus recording' \
    "$hrtc" --allow-no-rt "${model[@]}" --device replay:bumpy.spm
finish

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_simulated_devices.sh: the controller on each kind of simulated device.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-20000 bumpy.spm
readonly model=(--transport file --model bumpy.spm)

# One device of each class. Its largest stiffness is that of docs/stability.md.
run_hrtc "${model[@]}" --pool-mib 4 --duration 2 \
    --tool sphere:0.002 --tool sphere:0.002 --tool sphere:0.002 --tool sphere:0.002 \
    --device sim:touch --device sim:omega --device sim:delta --device sim
check report.json frames == 2000 tools.0.stiffness_cap_n_per_m == 400 \
    tools.1.stiffness_cap_n_per_m '>' 3059 tools.1.stiffness_cap_n_per_m '<' 3061 \
    tools.2.stiffness_cap_n_per_m '>' 3059 tools.2.stiffness_cap_n_per_m '<' 3061 \
    tools.3.stiffness_cap_n_per_m == 1800
grep -q '^touches  *bumpy: 0\.[0-9]* m across, round (0, 0, 0)$' hrtc.log \
    || fault 'it does not say where the object is'
grep -q '^tool  *sphere:0.002 on sim, .*: 1 object in reach; a wall of 400 N/m, of 500 asked for' \
    hrtc.log || fault 'it does not say what the first tool can do'
grep -q '^tool  *sphere:0.002 on sim, .*: 1 object in reach; a wall of 500 N/m$' hrtc.log \
    || fault 'it does not say what the second tool can do'
for i in 0 1 2 3; do
    check report.json tools.$i.force_max_n '<' 3.3
    check_contact report.json tools.$i.contact_share 0.5
done
check_clean report.json

# A damping that leaves no wall is refused, with what would do; one that leaves some goes.
expect 2 "--material: a damping of 2 N s/m on 'bumpy' leaves the device sim no wall at 1000 Hz; at \
most 0.994 leave it one that is felt, 0.722 one of 500 N/m" \
    "$hrtc" --allow-no-rt "${model[@]}" --duration 0.5 --material 500,0,0,2
run_hrtc "${model[@]}" --duration 0.5 --material 500,0,0,0.722
grep -q '^tool .*: 1 object in reach; a wall of 500 N/m$' hrtc.log \
    || fault 'less than that is not enough'

# It is what a tool touches that softens its wall, and nothing else.
run_hrtc "${model[@]}" --place 0,0,0 --place 1,0,0 --material 500 --material 500,0,0,0.9 \
    --tools 2 --pool-mib 4 --duration 2
check report.json tools.0.conditioned.stiffness_capped == 0 \
    tools.1.conditioned.stiffness_capped '>' 100 tools.1.softest_wall_n_per_m '>' 179 \
    tools.1.softest_wall_n_per_m '<' 181

# A run of which nothing came is a failure for who says so.
code=0
"$hrtc" --allow-no-rt "${model[@]}" --duration 0.5 --motion free --strict >strict.log || code=$?
((code == 1)) || fault "--strict: a run without a touch ended with $code"
grep -q '^verdict .*nothing was touched' strict.log || fault 'the verdict is silent'

# Readings that go wrong while the hand slides.
run_hrtc "${model[@]}" --duration 3 --device-fault jitter@700+50 --device-fault nan@1000+50 \
    --device-fault dropout@1300+50 --device-fault disconnect@1600+50 \
    --device-fault time_jump@1900+50 --device-fault stuck@2400+20
grep -q '^verdict .*force off for: .*disconnect 1.*; devices gone: 1' hrtc.log \
    || fault 'the verdict does not tell of the device'
grep -q '^hrtc: tool 0: its device, sim, is gone' hrtc.log || fault 'nobody tells that it is gone'
grep -q '^hrtc: tool 0: its device, sim, is back' hrtc.log || fault 'nobody tells that it is back'
check report.json frames == 3000 safety.begun.garbage '>=' 3 safety.begun.disconnect == 1 \
    tools.0.force_max_n '>' 0.5 tools.0.force_max_n '<=' 8
check_clean report.json

# A machine on which the force is off again and again: the hand finds the surface again, and the
# report tells contact from force.
for length in 5 60; do
    dropouts=()
    for ((i = 0; i < 62; ++i)); do
        dropouts+=(--device-fault "dropout@$((200 + 155 * i))+$length")
    done
    run_hrtc "${model[@]}" --duration 10 "${dropouts[@]}"
    check report.json frames == 10000 force.force_share '>' 0.05
    check_contact report.json force.contact_share "0.$((80 - length / 2))"
done
check report.json force.force_share '<' '0.99*force.contact_share'

# Other motions.
run_hrtc "${model[@]}" --duration 1 --motion free
check report.json tools.0.contact_share == 0
was_held_up report.json || check report.json tools.0.force_max_n == 0 # The run's end is no touch.
for motion in approach slide tap spin turn edge; do
    run_hrtc "${model[@]}" --duration 2 --motion "$motion"
    check report.json tools.0.force_max_n '>' 0.3 tools.0.force_max_n '<' 6
    check_contact report.json tools.0.contact_share 0.2
    check_clean report.json
done
run_hrtc "${model[@]}" --duration 3 --motion teleport
check report.json tools.0.force_max_n '>' 0 tools.0.force_max_n '<=' 8

# A recorded hand touches the same, and is gone after its end.
run_hrtc "${model[@]}" --duration 2 --record run.rec
check_contact report.json tools.0.contact_share 0.5
least=0.33
! was_held_up report.json || least=0.05
run_hrtc "${model[@]}" --duration 3 --device replay:run.rec
check report.json safety.begun.disconnect == 1 tools.0.contact_share '>' $least \
    tools.0.contact_share '<' 0.67 tools.0.force_max_n '>' 0.5
check_clean report.json
expect 2 '--rate: 2000 Hz; the device replay takes 1000 to 1000 Hz' \
    "$hrtc" --allow-no-rt "${model[@]}" --rate 2000 --device replay:run.rec
expect 2 '--device: bumpy.spm: *is not a Tactus recording' \
    "$hrtc" --allow-no-rt "${model[@]}" --device replay:bumpy.spm
finish

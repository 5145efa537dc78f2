#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_makes_no_system_call.sh: over DDS, with a model that does not fit, no frame makes a system
# call, allocates or faults. Further arguments: RATE FRAMES. Skipped (77) if the kernel accepts no
# seccomp filter.
source "$(dirname "$0")/common.sh"
readonly rate=$4 frames=$5

model bumpy-sphere-200000 large.spm
code=0
output=$("$hrtc" --allow-no-rt --transport file --model large.spm --duration 0.1 \
    --trap-system-calls 2>&1) || code=$?
if ((code == 2)) && [[ "$output" == *"--trap-system-calls: system calls can't be trapped"* ]]; then
    printf 'skipped: %s\n' "$output"
    exit 77
fi

start_publisher large.spm
contact=0 run_hrtc --model large --pool-mib 1 --rate "$rate" --duration $((frames / rate)) \
    --trap-system-calls
grep -q '^calls  *0 system calls in frames, [1-9]' hrtc.log || fault 'the summary has no calls'
check report.json frames == "$frames" realtime.system_calls_trapped == 1 \
    realtime.system_calls_in_frame == 0 cache.evictions '>' 0 wire.bytes_received '>' 0 \
    work.splits '>' 0
# The loop itself sleeps and reads its counters, which the trap must have counted.
check report.json realtime.system_calls_outside '>=' '2*frames'
check_clean report.json
if [[ -z "$sanitizer" ]] && is_realtime report.json; then
    check report.json realtime.page_faults == 0
fi
finish

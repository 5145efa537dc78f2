#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_stopped.sh: a run that is stopped and continued from outside misses its deadlines for that
# reason, neither as an overrun nor by the machine.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm

"$hrtc" --allow-no-rt --transport file --model good.spm --duration 600 --report run.json \
    >run.log 2>&1 &
started+=($!)
readonly run=${started[-1]}
wait_for_line run.log 'touch: '
wait_for_more "$run" 300
# Each stop lasts some periods after the kernel reports it.
readonly times=20
for ((i = 0; i < times; ++i)); do
    kill -STOP "$run"
    until [[ $(awk '/^State:/ { print $2 }' "/proc/$run/status") == T ]]; do sleep 0.01; done
    sleep 0.05
    kill -CONT "$run"
    wait_for_more "$run" 100
done
stop INT "$run"
((stopped_with == 0)) || fault "it ended with $stopped_with"
# A page fault makes the cycle of a stop an overrun.
check run.json deadline.stopped '<=' $times \
    deadline.stopped+deadline.cycles.page_fault '>=' $times
[[ -n "$sanitizer" ]] || ! is_realtime run.json || check_no_overrun run.json
grep -q 'stopped from outside; ' run.log || fault 'the summary does not tell of the stops'
finish

#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_deadline_test.sh: the accounting flags injected faults, alone and beside load; report,
# histograms and page are written and agree; nothing is left behind; wrong options are refused.
source "$(dirname "$0")/common.sh"
model bumpy-sphere-5000 good.spm
mkdir temporary
export TMPDIR=$scratch/temporary

refuse() { expect "$1" "$2" "$hrtc" "${@:3}"; }
refuse 3 'a model is required' deadline-test
refuse 3 '--load: ' deadline-test --model bumpy --load network
refuse 3 'none goes with no other' deadline-test --model bumpy --load none,cpu
for name in run run.txt run.JSON; do
    refuse 3 "'$name' must end in .json or .html" deadline-test --model bumpy --report "$name"
done
refuse 3 'must end in .json' deadline-test --model bumpy --report run.html
refuse 3 '--record' deadline-test --model bumpy --record run.rec
refuse 3 '--replay' deadline-test --model bumpy --replay run.rec
refuse 2 'nowhere/run.json' deadline-test --model bumpy --report nowhere/run.json
refuse 2 'missing.spm' deadline-test --allow-no-rt --transport file --model missing.spm
refuse 3 'KIND' load
refuse 3 'KIND' load network
"$hrtc" deadline-test --help >help.txt
grep -q -- '--load ' help.txt || fault 'deadline-test --help does not tell of --load'

for kind in cpu memory disk; do
    "$hrtc" load $kind </dev/null || fault "load $kind did not end well at the end of its input"
done

# pass ARGUMENT...: checks the laws of any test.
pass() {
    deadline_test --model good.spm --duration 1 "$@"
    [[ -z $(ls temporary) ]] || fault "left behind: $(ls temporary)"
    check run.json schema == 3 frames == 1000 self_check.injected '>=' 15 duration_s == 1 \
        times_us.cpu.p50 '>' 0 times_us.response.max '>=' '1*times_us.response.p99' \
        deadline.latency_misses+deadline.stopped '<=' '1*deadline.missed'
    ((ended_with != 0)) || {
        check run.json self_check.passed == 1 self_check.false_flags == 0 deadline.overrun == 0
        grep -q '^verdict     passed: 0 overruns in ' test.log || fault 'no verdict'
    }
}

pass --load none
check run.json load == 0
! grep -q 'beside load' test.log || fault 'loaded without being asked to'
for tool in capsule:0.002,0.02 box:0.02,0.015,0.01,0.001; do
    pass --load none --tool "$tool"
done
pass --load cpu,disk
check run.json load == 2 alone.load == 0 alone.frames == 1000
grep -q 'beside load (cpu, disk)' run.txt || fault 'the histogram does not tell of the load'
for title in 'Wake-up latency' 'Processor time' 'Time from the deadline'; do
    grep -q "^$title" run.txt || fault "no histogram '$title'"
    grep -q "<figcaption>$title" run.html || fault "no chart '$title'"
done
[[ $(tail -n 1 run.html) == '</html>' ]] || fault 'the page has no end'

# An interrupted test judges nothing, writes nothing and leaves no load.
# Meanwhile the loop has its processor to itself: the last allowed one, the end of a list of allowed
# ones.
rm run.*
cpu=$(taskset -cp $$ | sed 's/.*[ ,-]//')
"$hrtc" deadline-test --allow-no-rt --transport file --model good.spm --report run.json \
    --cpu "$cpu" >test.log 2>&1 &
started+=($!)
wait_for_line test.log 'alone: '
ending=$(awk '/^Cpus_allowed_list/ { print $2 }' "/proc/${started[-1]}/task/"*/status \
    | grep -cE "(^|[,-])$cpu\$")
others=$(taskset -cp $$ | sed 's/.*: //')
[[ $others == "$cpu" ]] || ((ending == 1)) || fault "$ending threads may run on processor $cpu"
stop INT "${started[-1]}"
((stopped_with == 2)) || fault "interrupted, it ended with $stopped_with"
grep -q 'interrupted; there is no verdict' test.log \
    || fault 'it does not say that it was interrupted'
[[ ! -e run.json ]] || fault 'interrupted, it wrote a report'
[[ -z $(ls temporary) ]] || fault "left behind: $(ls temporary)"
finish

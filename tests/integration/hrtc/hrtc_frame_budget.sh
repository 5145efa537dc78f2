#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_frame_budget.sh: a frame's work stays within its budget, and the answers hold; too small a
# budget is reported. Times are printed, not judged.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-100000 bumpy.spm
touch_it() { contact=0 run_hrtc --transport file --model bumpy.spm --duration 1.5 "$@"; }

# Half of the period at an instruction a nanosecond, in virtual time on any machine.
touch_it --virtual-time --splits 48
check report.json budgets.frame_us == 500 budgets.splits == 48 budgets.work.min == 500000 \
    budgets.work.max == 500000 budgets.at_floor == 0 budgets.work_done.max '<=' 600000 \
    deadline.over_budget == 0
! grep -q '^work ' hrtc.log || fault 'the summary reports a budget that did not run short'

touch_it --virtual-time --frame-budget-us 100
check report.json budgets.frame_us == 100 budgets.work.max == 100000 \
    budgets.work_done.max '<=' 120000 deadline.over_budget == 0 answers.stale == 0 frames == 1500
check_clean report.json

# A slow machine may get less in real time, and never more.
touch_it
check report.json budgets.frame_us == 500 budgets.splits == 64 budgets.work.max '<=' 500000 \
    budgets.work.min '>=' 80000 deadline.over_budget == 0
touch_it --frame-budget-us 900 --splits 100
check report.json budgets.splits == 100 budgets.work.max '<=' 900000 budgets.work.min '>=' 80000 \
    deadline.over_budget == 0

# Smallest permitted value: refinement still progresses.
touch_it --frame-budget-us 80
check report.json budgets.work.min == 80000 budgets.work.max == 80000 work.splits '>' 40 \
    answers.exact '>' 0 deadline.over_budget == 0
finish

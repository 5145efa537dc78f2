#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_frame_budget.sh: with a time to keep, the budgets follow what frames cost, stay within their
# limits, and the answers hold; with too little the report says so. Times are printed, not judged.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-100000 bumpy.spm
touch_it() { contact=0 run_hrtc --transport file --model bumpy.spm --duration 1.5 "$@"; }

# Without the option they are what they always were.
touch_it --splits 48
check report.json budgets.splits.min == 48 budgets.splits.max == 48 budgets.merges.max == 48 \
    budgets.nodes.min == '1*budgets.nodes.max' budgets.at_floor == 0
! grep -q '^budgets ' hrtc.log || fault 'fixed budgets are told as governed ones'

touch_it --frame-budget-us 60
grep -q '^budgets     for 60 us a frame: splits ' hrtc.log || fault 'the summary has no budgets'
check report.json budgets.frame_us == 60 budgets.splits.min '>=' 1 budgets.splits.max '<=' 256 \
    budgets.splits.max '>' '1*budgets.splits.min' budgets.splits.mean '<' 64 \
    budgets.scanned.min '>=' 32 budgets.scanned.max '<=' 512 budgets.nodes.min '>=' 128 \
    budgets.nodes.max '<=' 2048 budgets.triangles.min '>=' 512 budgets.triangles.max '<=' 8192 \
    budgets.planes.min '>=' 128 budgets.planes.max '<=' 1024 \
    deadline.over_budget == 0 answers.stale == 0 frames == 1500
check_clean report.json

# All that a frame may do, and --splits as the most of it.
touch_it --frame-budget-us 900 --splits 100
check report.json budgets.splits.max '<=' 100 budgets.merges.max '<=' 100

# Less time than an idle frame takes: least budgets, said so, and the front still moves.
touch_it --frame-budget-us 1
check report.json budgets.at_floor '>' '0.9*frames' budgets.splits.min == 1 \
    budgets.splits.mean '<' 4 work.splits '>' 40 answers.exact '>' 0 deadline.over_budget == 0
finish

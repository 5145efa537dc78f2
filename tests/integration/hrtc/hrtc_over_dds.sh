#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_over_dds.sh: from a shape to the report, over DDS on loopback; the report has every key of
# schema 3, and the run was correct.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-20000 bumpy.spm
start_publisher bumpy.spm
run_hrtc --model bumpy --duration 3 --rate 1000
grep -q "^report *report.json$" hrtc.log || fault 'the summary does not name the report'

for stage in load refine refit query force frame wake; do
    for figure in mean p50 p90 p99 p999 max; do
        check report.json times_us.$stage.$figure '>=' 0
    done
    check report.json times_us.$stage.p50 '<=' "1*times_us.$stage.p99" \
        times_us.$stage.p999 '<=' "1*times_us.$stage.max"
done
for key in answers.longest_inexact_run answers.width_max_diag work.splits work.merges \
    work.nodes_visited work.pages_adopted cache.hits cache.misses cache.loads cache.evictions \
    deadline.missed deadline.latency_misses force.max_step_n; do
    check report.json $key '>=' 0
done
for list in pages index_pages faces blocks nodes; do
    check report.json pools.$list.used_max '>' 0 pools.$list.bytes '>' 0 \
        pools.$list.used_max '<=' "1*pools.$list.capacity"
done
check report.json machine '>' 0 models == 1 tools == 1 pairs == 1 period_ns == 1000000
check report.json models.0.faces '>' 19000 tools.0.radius_m '>' 0 \
    pairs.0.answers.exact+pairs.0.answers.separated+pairs.0.answers.within_tolerance '>' 0

check report.json frames == 3000 pools.total_bytes '<=' 2097152 wire.bytes_received '>' 0 \
    wire.server_lost == 0 work.splits '>' 0 force.max_n '>' 0 force.max_n '<' 20
check_clean report.json
check_answers report.json

stop_publisher
grep -q '^ended; [1-9][0-9]* chunks' publish.log || fault 'spm_publish does not say what it sent'
finish

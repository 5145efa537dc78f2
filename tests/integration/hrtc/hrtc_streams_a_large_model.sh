#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_streams_a_large_model.sh: a model larger than the pools is touched as well as a small one;
# NAME@HASH takes this file and no other.
source "$(dirname "$0")/common.sh"

model bumpy-sphere-200000 large.spm
start_publisher large.spm
hash=$(sed -n "s/^serving 'large' hash \([0-9a-f]*\):.*/\1/p" publish.log)
((${#hash} == 32)) || fail "spm_publish names no hash: $(cat publish.log)"

run_hrtc --model "large@$hash" --pool-mib 1 --duration 3
check report.json frames == 3000 pools.total_bytes '<=' 1048576 wire.bytes_received '>' 0 \
    cache.misses+cache.evictions '>' 0 cache.loads '>' '1*pools.pages.capacity' \
    models.0.pieces_refused == 0
check_clean report.json
check_answers report.json

wrong=$(tr 0-9a-f 1-9a-f0 <<<"$hash")
expect_found 2 "with hash $hash" --model "large@$wrong"
finish

#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# deadline.sh SECONDS LOAD FACES OPTION...: cyclictest, then hrtc deadline-test.
source ./helpers.sh
readonly seconds=$1 load=$2 faces=$3
take_model "$faces"
cyclictest -q -m -p 90 -i 1000 -l 10000 | tee kept/cyclictest.txt
hrtc deadline-test --transport file --model /var/lib/tactus/bumpy.spm --duration "$seconds" \
    --load "${load//+/,}" --report kept/report.json "${@:4}"

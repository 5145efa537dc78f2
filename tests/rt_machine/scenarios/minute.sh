#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# minute.sh SECONDS: server and controller over DDS. Two runs are equal to the bit.
source ./helpers.sh
take_model 200000
cyclictest -q -m -p 90 -i 1000 -l 5000 | tee kept/cyclictest.txt
serve bumpy.spm
wait_until 10 'publisher' systemctl is-active --quiet spm_publish
hrtc --model bumpy --duration "$1" --report kept/report.json
sha256sum kept/report.json

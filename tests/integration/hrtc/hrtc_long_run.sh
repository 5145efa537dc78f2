#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_long_run.sh: SECONDS ($5) at RATE ($4) on the demo's scene over DDS, in real time: no
# overrun, every frame in the histograms, and no growth of memory.
source "$(dirname "$0")/common.sh"
readonly rate=$4 seconds=$5


model bumpy-sphere-200000 bumpy.spm
start_publisher bumpy.spm --watch
start_hrtc --model bumpy --rate "$rate" --duration 3600 --report report.json
wait_for_frames $((5 * rate)) publish.log # Everything is set up, the first requests are served.
first=$(resident_kib "$controller")
publisher_first=$(resident_kib "$publisher")
for ((i = 10; i <= seconds; i += 5)); do # Each has its own wait.
    wait_for_frames $((i * rate)) publish.log
done
last=$(resident_kib "$controller")
publisher_last=$(resident_kib "$publisher")
stop_hrtc
check_clean report.json
check report.json frames '>=' $((rate * seconds))
printf 'resident: hrtc %s to %s KiB, spm_publish %s to %s KiB\n' "$first" "$last" \
    "$publisher_first" "$publisher_last"
if [[ -n "$sanitizer" ]]; then # A sanitizer keeps freed memory.
    finish
    exit
fi
((last - first <= 1024)) || fault "hrtc grew by $((last - first)) KiB"
((publisher_last - publisher_first <= 2048)) \
    || fault "spm_publish grew by $((publisher_last - publisher_first)) KiB"
finish

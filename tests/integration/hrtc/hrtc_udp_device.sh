#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_udp_device.sh: a program in another language moves the tool. The driver of
# docs/udp-device.md, with a hand that leans on the model, is killed; another one takes over.
source "$(dirname "$0")/common.sh"

readonly port=$((20000 + $$ % 20000))
model bumpy-sphere-20000 bumpy.spm
# shellcheck disable=SC2016 # The page's own marks.
sed -n '/^```python$/,/^```$/{/^```/!p}' "$(dirname "$0")/../../../docs/udp-device.md" \
    | sed -e 's/200 \* x\[i\]/200 * (x[i] - (0.045, 0, 0)[i])/' \
        -e 's/^\(x, v, force, state, last = \)\[0.0\] \* 6/\1[0.08] + [0.0] * 5/' >driver.py
if ! grep -q '0.045' driver.py || ! grep -q '0.08' driver.py; then
    fail 'the driver of the page is another'
fi
drive() {
    python3 driver.py "$port" >driver.log 2>&1 &
    driver=$!
    started+=("$driver")
}

readonly run=("$hrtc" --allow-no-rt --transport file --model bumpy.spm)
expect 2 'no device described itself' "${run[@]}" --device "udp:$port" --wait 0.2
expect 2 'dhd' "${run[@]}" --device dhd
start_hrtc --transport file --model bumpy.spm --device "udp:$port" --wait 3600
wait_until 10 "program at UDP port $port" grep -qs "$(printf ':%04X 0' "$port")" /proc/net/udp
stop TERM "$controller" # It waits for a device, and not for an hour.
((stopped_with == 2)) || fault "told to end while it waited, hrtc ended with $stopped_with"
grep -q 'no device described itself' hrtc.log || fault 'it does not say what it waited for'

drive
start_hrtc --transport file --model bumpy.spm --device "udp:$port" --tool sphere:0.004 \
    --duration 6 --report report.json
wait_for_sleeps 3000 "$controller"
stop KILL "$driver"
wait_for_line hrtc.log 'is gone; no force until' 5
drive
code=0
wait "$controller" || code=$?
cat hrtc.log
((code == 0)) || fail "hrtc ended with $code"
check_contact report.json tools.0.contact_share 0.3
check report.json frames == 6000 safety.begun.disconnect '>=' 1 \
    tools.0.force_max_n '>' 0.2 tools.0.force_max_n '<=' 8
finish

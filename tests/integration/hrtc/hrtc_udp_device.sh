#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# hrtc_udp_device.sh: a program in another language moves the tool. The driver of docs/examples,
# whose hand moves up and down, is killed; another one takes over. With a key, one with another key
# is ignored. The commands of docs/udp-device.md are run verbatim.
docs=$(cd "$(dirname "$0")/../../../docs" && pwd)
readonly docs
readonly in_c=$4
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/run_page.sh"

readonly port=$((20000 + $$ % 20000))
model bumpy-sphere-20000 bumpy.spm
drive() { # drive [KEY]
    python3 "$docs/examples/udp_driver.py" "$port" 0.02 "$@" >driver.log 2>&1 &
    driving=$!
    started+=("$driving")
}

readonly run=("$hrtc" --allow-no-rt --transport file --model bumpy.spm)
expect 2 'no device described itself' "${run[@]}" --device "udp:$port" --wait 0.2
expect 2 'dhd' "${run[@]}" --device dhd
start_hrtc --transport file --model bumpy.spm --device "udp:$port" --wait 3600
wait_until "program at UDP port $port" grep -qs "$(printf ':%04X 0' "$port")" /proc/net/udp
stop TERM "$controller" # hrtc waits for a device, but not for an hour.
((stopped_with == 2)) || fault "told to end while it waited, hrtc ended with $stopped_with"
grep -q 'no device described itself' hrtc.log || fault 'it does not say what it waited for'

drive
start_hrtc --transport file --model bumpy.spm --device "udp:$port" --device-frame 0,0,0.06 \
    --strict --duration 600 --wait "$patience_s" --report report.json
wait_for_line hrtc.log 'touch: '
wait_for_more "$driving" 500 # This hand is still above; the second one touches.
stop KILL "$driving"
wait_for_line hrtc.log 'is disconnected; no force until'
drive # The second one waits for the first one's place.
wait_until 'device that is back' grep -q 'tool 0: the device .* is connected again' hrtc.log
wait_for_more "$driving" 2500
kill -TERM "$controller"
end_hrtc 1
check report.json frames '>' 1000 safety.begun.disconnect '>=' 1 tools.0.contact_share '>' 0 \
    tools.0.force_max_n '>' 0.2 tools.0.force_max_n '<=' 8 tools.0.traffic.sessions '>=' 2 \
    tools.0.traffic.samples '>' 300 tools.0.traffic.refused.tag == 0
stop KILL "$driving"

# Drivers with another key and without one send constantly.
(umask 077 && printf '%064x\n' 7 >device.key && printf '%064x\n' 8 >other.key)
drive other.key
stranger=$driving
drive
plain=$driving
drive device.key
start_hrtc --transport file --model bumpy.spm --device "udp:$port" --device-key device.key \
    --device-frame 0,0,0.06 --duration 600 --wait "$patience_s" --report report.json
wait_for_line hrtc.log 'touch: '
for id in "$stranger" "$plain" "$driving"; do wait_for_more "$id" 500; done
stop_hrtc
check report.json frames '>' 300 tools.0.traffic.sessions '>=' 1 tools.0.traffic.samples '>' 100 \
    tools.0.traffic.refused.tag '>' 10 tools.0.traffic.refused.foreign == 0
grep -q "tool 0: [0-9]* datagrams .* refused, mostly: not authenticated by the key" hrtc.log \
    || fault 'no line tells of the strangers'
for id in "$stranger" "$plain" "$driving"; do stop KILL "$id"; done

refuse_key() { expect 2 "$2" "${run[@]}" --device udp --device-key "$1"; }
refuse_key missing.key 'no such file'
chmod 644 other.key
refuse_key other.key 'chmod 600'
for text in ' ' 12 "$(printf '%063x' 7)" "$(printf '%065x' 7)" "$(printf '%063xg' 7)"; do
    (umask 077 && printf '%s' "$text" >bad.key)
    refuse_key bad.key '64 hexadecimal digits'
done
expect 3 'there is no udp device' "${run[@]}" --device-key device.key

# Driver in C.
"$in_c" "$port" 0.02 &
driving=$!
started+=("$driving")
run_hrtc --transport file --model bumpy.spm --device "udp:$port" --device-frame 0,0,0.06 \
    --duration 5
grep -q '^tool .* on c, 0.2 m around (0, 0, 0.06)' hrtc.log \
    || fault "another device: $(cat hrtc.log)"
check report.json tools.0.contact_share '>' 0.05 tools.0.force_max_n '>' 0.2 \
    tools.0.traffic.refused.content == 0 tools.0.traffic.refused.checksum == 0
stop KILL "$driving"

cp "$docs/examples/tactus_driver.py" "$docs/examples/udp_driver.py" .
sed "s/48500/$((port + 1))/; s/--duration 8/--duration 5/" "$docs/udp-device.md" >page.md
run_page page.md 1
check driven.json frames == 5000 force.max_n '>' 0.8 force.max_n '<' 3 \
    tools.0.contact_share '>' 0.05
finish

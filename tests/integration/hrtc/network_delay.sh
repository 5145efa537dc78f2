#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# network_delay.sh: server and controller 10 ms apart. A streamed model is touched, and no answer is
# wrong because of data in transit. The relay's options, answers and end are also checked.
source "$(dirname "$0")/two_networks.sh"

# Command line, before any setup.
for option in --loss --duplicates; do
    for value in -0.1 1.1 nan many ''; do
        expect 3 "$option: *0 .. 1" "$network_relay" "$option" "$value"
    done
done
for option in --delay-ms --jitter-ms; do
    for value in -1 10001 nan soon ''; do
        expect 3 "$option: *0 .. 10000" "$network_relay" "$option" "$value"
    done
done
for value in -1 4294967296 1.5 any ''; do
    expect 3 '--seed: *0 .. 4294967295' "$network_relay" --seed "$value"
done
for value in 575 9001 large; do
    expect 3 '--mtu: *576 .. 9000' "$network_relay" --mtu "$value"
done
expect 3 extra "$network_relay" extra

start_relay --delay-ms 10
for command in '' 'set loss 2' 'set speed 1' halt; do
    printf '%s\n' "$command" >&"$relay_in"
    read -r -t "$patience_s" relay_answer <&"$relay_out" \
        || fail "the relay says nothing to '$command'"
    [[ "$relay_answer" == 'refused: '*'set loss 0..1'* ]] || fault "'$command': $relay_answer"
done

# An unaccepted connection is refused after one round trip.
for try in 1 2 3; do
    # shellcheck disable=SC2016 # For the other shell.
    passed_us=$(in_controller_network bash -c '
        began=${EPOCHREALTIME/[.,]/}
        exec 3<>"/dev/tcp/10.77.0.1/9" && exit 1
        echo $((${EPOCHREALTIME/[.,]/} - began))' 2>/dev/null) || fail 'somebody listens at port 9'
    echo "round trip $try: $passed_us us"
    ((passed_us >= 20000)) || fault "a round trip of $passed_us us over 10 ms each way"
done

touch_large_model
count_frames counts.json
check counts.json to_controller.lost+to_controller.duplicated+to_controller.cut == 0 \
    to_server.lost+to_server.duplicated+to_server.cut == 0 \
    to_controller.udp_payload_bytes '>' '1*to_controller.udp_datagrams'

exec {relay_in}>&- # Simulates the death of its controlling process.
code=0
wait "$relay" || code=$?
((code == 0)) || fault "at the end of its commands the relay ended with $code"
finish

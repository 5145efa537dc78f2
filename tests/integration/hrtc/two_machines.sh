#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# two_machines.sh: the configuration of docs/two-machines.md for a network, between two separate
# networks: a model is found and touched, at the ports of the page.
source "$(dirname "$0")/two_networks.sh"
example=$(cd "$(dirname "$0")/../../.." && pwd)/docs/examples/cyclonedds.xml
readonly example

start_relay --delay-ms 2 --loss 0.01 --seed 3

# use_example ARRAY: uses the interface and the peers of the relay's own configuration in the
# example's.
use_example() {
    local -n side=$1
    local peers interface
    mapfile -t peers < <(grep -o "Peer address='[^']*'" <<<"${side[3]}" | cut -d "'" -f 2)
    interface=$(sed -n "s/.*NetworkInterface name='\([^']*\)'.*/\1/p" <<<"${side[3]}")
    [[ ${#peers[@]} == 2 && -n "$interface" ]] || fail "no configuration: ${side[3]}"
    sed "s/eth0/$interface/; s/192.168.1.10/${peers[0]}/; s/192.168.1.20/${peers[1]}/" \
        "$example" >"$1.xml"
    side[3]="CYCLONEDDS_URI=file://$PWD/$1.xml"
}
use_example on_server
use_example on_controller

touch_large_model

# ports_of COMMAND...: prints the UDP ports of a network within those of the domain.
readonly first_port=$((7400 + 250 * domain)) next_port=$((7400 + 250 * (domain + 1)))
ports_of() {
    "$@" cat /proc/net/udp | awk 'NR > 1 { split($2, at, ":"); print at[2] }' | while read -r port
    do
        port=$((16#$port))
        ((port < first_port || port >= next_port)) || echo "$((port - first_port))"
    done | sort -n | tr '\n' ' '
}
heard=$(ports_of in_server_network)
[[ "$heard" == '10 11 ' ]] || fault "the server hears on $first_port and: $heard"

# The doctor finds the server and its models.
hears_server() {
    in_controller_network "$hrtc" doctor --json --domain "$domain" --wait 1 \
        "${controller_security[@]}" >doctor.json || true
    grep -q 'spm_publish (process .*models published: large' doctor.json
}
wait_until 'word of the doctor on the server' hears_server

# Nothing passes from another domain, and nothing is found. Keys are for one domain.
wrong=$(((domain + 7) % 200))
if in_controller_network "$hrtc" --allow-no-rt --domain "$wrong" --model large --wait 1 \
    "${controller_security[@]}" >wrong.log 2>&1; then
    fault 'another domain is the same'
fi
refusal="model 'large' is not published on domain $wrong"
[[ -z "${TACTUS_TEST_SECURED:-}" ]] || refusal="is for another domain than $wrong"
grep -q "$refusal" wrong.log || fault "$(cat wrong.log)"
stop_publisher
finish

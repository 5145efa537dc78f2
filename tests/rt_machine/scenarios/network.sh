#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# network.sh SECONDS DELAY_MS LOSS_PERCENT: server and controller in separate networks, with the
# configuration of docs/two-machines.md; netem delays and loses on both ends.
source ./helpers.sh
modprobe -a veth sch_netem
take_model 200000
ip link add eth0 type veth peer name eth1
address=10
for side in host controller; do
    ip netns add "$side"
    [[ "$side" == host ]] && link=eth0 || link=eth1
    ip link set "$link" netns "$side"
    ip -n "$side" address add "192.168.1.$address/24" dev "$link"
    ip -n "$side" link set "$link" up
    ip -n "$side" link set lo up
    ip netns exec "$side" tc qdisc add dev "$link" root netem delay "$2ms" loss "$3%"
    sed "s/eth0/$link/" /usr/share/doc/tactus/docs/examples/cyclonedds.xml >"$side.xml"
    address=$((address + 10))
done
CYCLONEDDS_URI=file:///rt_machine/host.xml ip netns exec host \
    spm_publish /var/lib/tactus/bumpy.spm --plain >publish.log 2>&1 &
CYCLONEDDS_URI=file:///rt_machine/controller.xml ip netns exec controller \
    hrtc --model bumpy --plain --duration "$1" --report kept/report.json
for side in host controller; do
    ip netns exec "$side" tc -s qdisc show | grep -A 1 netem
done

# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash disable=SC2034 # The scripts use what is set here.
# Unauthenticated peers on the domain; sourced after common.sh.

# CYCLONEDDS_URI of a peer that is discovered by all and discovers servers.
readonly stranger_uri='<CycloneDDS><Domain id="any"><General><Interfaces><NetworkInterface name="lo"
multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery>
<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>9</MaxAutoParticipantIndex>
<LeaseDuration>1 s</LeaseDuration><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain>
</CycloneDDS>'

# udp_ports ID: prints the UDP ports of the process.
udp_ports() {
    local link inode
    for link in "/proc/$1/fd/"*; do
        inode=$(readlink "$link" || true)
        [[ "$inode" == 'socket:['* ]] || continue
        inode=${inode#'socket:['}
        awk -v inode="${inode%]}" '$10 == inode { sub(/.*:/, "", $2); print $2 }' /proc/net/udp
    done | while read -r hex; do echo $((16#$hex)); done
}

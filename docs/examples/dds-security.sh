#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# dds-security.sh FOLDER [CYCLONEDDS.XML]: keys, certificates and permissions for DDS
# Security, into a new FOLDER, by openssl: one role for servers, one for controllers. Without a
# configuration of your own, servers and controllers are those of this machine. It writes
#
#     server.xml, controller.xml   for CYCLONEDDS_URI of spm_publish and of hrtc
#
# They are good for domains 0 to 230: Cyclone takes no higher ones in these files. Keep ca.key apart
# from both machines; who has it makes roles. docs/security.md tells the rest.
set -euo pipefail
[[ $# -ge 1 && $# -le 2 ]] || {
    echo 'dds-security.sh FOLDER [CYCLONEDDS.XML]' >&2
    exit 3
}
settings=${2:-}
[[ -z "$settings" ]] || settings=$(<"$settings")
umask 077
mkdir "$1"
cd "$1"
readonly days=3650
readonly curve=(-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes)

openssl req -x509 "${curve[@]}" -keyout ca.key -out ca.pem -days "$days" -subj /CN=tactus-ca \
    2>openssl.log

sign() { # sign NAME: NAME.xml, by the CA.
    openssl smime -sign -text -in "$1.xml" -out "$1.p7s" -signer ca.pem -inkey ca.key 2>>openssl.log
}

cat >governance.xml <<XML
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>230</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>NONE</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
XML
sign governance

topics() { # topics TOPIC...: as elements.
    printf '<topics>'
    printf '<topic>tactus/v5/%s</topic>' "$@"
    printf '</topics><partitions><partition>*</partition></partitions>'
}

# role NAME PUBLISHES -- SUBSCRIBES: certificate, permissions and configuration of one role.
role() {
    local name=$1 publishes=() from until
    shift
    while [[ $1 != -- ]]; do
        publishes+=("$1")
        shift
    done
    shift
    openssl req "${curve[@]}" -keyout "$name.key" -out "$name.csr" -subj "/CN=$name" 2>>openssl.log
    openssl x509 -req -in "$name.csr" -CA ca.pem -CAkey ca.key -CAcreateserial -days "$days" \
        -out "$name.pem" 2>>openssl.log
    from=$(date -u -d yesterday +%Y-%m-%dT%H:%M:%S)
    until=$(date -u -d "$days days" +%Y-%m-%dT%H:%M:%S)
    cat >"$name-permissions.xml" <<XML
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <permissions>
    <grant name="$name">
      <subject_name>CN=$name</subject_name>
      <validity><not_before>$from</not_before><not_after>$until</not_after></validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>230</max></id_range></domains>
        <publish>$(topics "${publishes[@]}")</publish>
        <subscribe>$(topics "$@")</subscribe>
      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
XML
    sign "$name-permissions"
    configure "$name"
}

# The plugins are no libraries of the loader's path: Debian has them in a folder of Cyclone's.
plugins() {
    local plugin folder
    folder=$(dirname "$(find /usr/lib -name libdds_security_auth.so -print -quit)")
    for plugin in auth/authentication/Authentication ac/access_control/AccessControl \
        crypto/crypto/Cryptographic; do
        IFS=/ read -r file function element <<<"$plugin"
        printf '<%s>\n<Library path="%s/libdds_security_%s.so" initFunction="init_%s"\n' \
            "$element" "$folder" "$file" "$function"
        printf ' finalizeFunction="finalize_%s"/>\n' "$function"
        case $file in
            auth)
                printf '<IdentityCertificate>file:%s/%s.pem</IdentityCertificate>\n' "$PWD" "$1"
                printf '<IdentityCA>file:%s/ca.pem</IdentityCA>\n' "$PWD"
                printf '<PrivateKey>file:%s/%s.key</PrivateKey>\n' "$PWD" "$1"
                ;;
            ac)
                printf '<PermissionsCA>file:%s/ca.pem</PermissionsCA>\n' "$PWD"
                printf '<Governance>file:%s/governance.p7s</Governance>\n' "$PWD"
                printf '<Permissions>file:%s/%s-permissions.p7s</Permissions>\n' "$PWD" "$1"
                ;;
        esac
        printf '</%s>\n' "$element"
    done
}

configure() { # configure ROLE: ROLE.xml, the settings with the role's security.
    local text=$settings index=auto
    [[ $1 == server ]] || index=none
    if [[ -z "$text" ]]; then
        text="<CycloneDDS><Domain id=\"any\">
<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>$index</ParticipantIndex>
<MaxAutoParticipantIndex>10</MaxAutoParticipantIndex><LeaseDuration>1 s</LeaseDuration>
<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery>
<Internal><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>
</Domain></CycloneDDS>"
    fi
    printf '%s<Security>\n%s\n</Security></Domain>%s\n' "${text%%</Domain>*}" "$(plugins "$1")" \
        "${text#*</Domain>}" >"$1.xml"
}

role server catalogue chunks objects motion -- wanted telemetry refinement_state catalogue
role controller wanted telemetry refinement_state -- catalogue chunks objects motion
rm -f -- *.csr openssl.log
echo "$PWD/server.xml and $PWD/controller.xml are for CYCLONEDDS_URI"

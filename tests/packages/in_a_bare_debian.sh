#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# in_a_bare_debian.sh VERSION DOMAIN: run by debian.sh inside its system, as root.
set -euo pipefail
readonly version=$1 domain=$2
cd /packages

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
quietly() { # quietly LOG COMMAND...: prints the output only on failure.
    local log=$1
    shift
    "$@" >"$log" 2>&1 || { tail -n 40 "$log"; fail "this failed: $*"; }
}
# State that a purge must restore: names of files except caches and backups, users and groups.
state() {
    find / -xdev \( -path /packages -o -path /var/lib/dpkg -o -path /var/log -o -path /tmp \
        -o -path /etc/ld.so.cache -o -path /etc/group- -o -path /etc/gshadow- \
        -o -path /var/cache/ldconfig -o -name __pycache__ \) -prune \
        -o -print | sort
    sort /etc/passwd /etc/group
}
called() { # called CALL: true if systemctl got this call since the log was emptied.
    grep -qxF -- "$1" /run/systemctl.log \
        || fail "systemctl $1 was not called: $(</run/systemctl.log)"
}
wait_for_line() { # wait_for_line FILE TEXT
    local i
    for ((i = 0; i < 3000; ++i)); do
        grep -qsF -- "$2" "$1" && return
        sleep 0.05
    done
    cat "$1" || true
    fail "no '$2' in $1"
}

mv systemctl /usr/bin/systemctl
mkdir -p /run/systemd/system # Maintainer scripts take this for a running systemd.
state >before.txt

# --- installed -----------------------------------------------------------------------------------

: >/run/systemctl.log
quietly install.log dpkg --install old/*.deb
[[ -z $(dpkg --audit) ]] || fail "$(dpkg --audit)"
grep -qE '^[0-9]+ critical, [0-9]+ unknown, [0-9]+ advice, [0-9]+ good$' install.log \
    || fail "the doctor says nothing when hrtc is installed: $(<install.log)"
getent group haptics >/dev/null || fail 'there is no group haptics'
called '--system daemon-reload'
! grep -qE 'start|enable' /run/systemctl.log || fail "a service is started: $(</run/systemctl.log)"
[[ -z $(find /etc/systemd -name 'hrtc*' -o -name 'spm_*') ]] || fail 'a service is enabled'

# Programs, from a file and over DDS; the module.
spm_build --shape torus --faces 20000 -o torus.spm 2>&1
spm_inspect torus.spm | grep -x 'mesh .*20000 faces.*' || fail 'spm_inspect'
tactus inspect torus.spm | grep -x 'mesh .*20000 faces.*' || fail 'tactus inspect'
tactus touch torus.spm --no-view --duration 1 >touch.log 2>&1 || fail "tactus: $(<touch.log)"
code=0
hrtc deadline-test --allow-no-rt --transport file --model torus.spm --duration 2 --load none \
    --report test.json >test.log 2>&1 || code=$?
cat test.log
# 1: an overrun, on a machine that is busy with this.
((code <= 1)) || fail "deadline-test ends with $code"
[[ -s test.json && -s test.html ]] || fail 'deadline-test writes no report'
python3 -c '
import tactus
model = tactus.Model("torus.spm")
frame = tactus.Frame([model], [tactus.Tool(0.02, query_only=True)], [tactus.Object()])
place = [(low + high) / 2 for low, high in zip(model.low_m, model.high_m)]
answer = frame.run([place], rounds=1000)
assert answer.lower_m[0, 0] > 0.0, answer.lower_m
' || fail 'the module tactus'

# --- upgraded while the services run -------------------------------------------------------------

cp torus.spm /var/lib/tactus/
printf 'OPTIONS="--domain %s torus.spm"\n' "$domain" >>/etc/default/spm_publish
sed -i -e 's/^model = .*/model = "torus"/' -e 's/^report/#report/' \
    -e "1i domain = $domain\nallow-no-rt = true" /etc/tactus/hrtc.toml
systemctl enable spm_publish.service hrtc.service
systemctl start spm_publish.service
wait_for_line /run/services/spm_publish.service.log 'ready on DDS domain'
systemctl start hrtc.service
wait_for_line /run/services/hrtc.service.log 'touch: '
systemctl is-active spm_publish.service hrtc.service || fail 'the services do not run'

upgrade() { # upgrade: logs the calls of systemctl, with process ids in $old and $new.
    old=$(paste -sd' ' /run/services/*.service)
    : >/run/systemctl.log
    quietly upgrade.log dpkg --install new/*.deb
    new=$(paste -sd' ' /run/services/*.service)
    systemctl is-active spm_publish.service hrtc.service || fail 'a service ended'
}
upgrade
[[ $(dpkg-query --show --showformat '${Version}' tactus-controller) == "$version" ]] \
    || fail 'no newer version is there'
called '--system daemon-reload'
called 'try-restart hrtc.service'
called 'try-restart spm_publish.service'
for id in $old; do
    [[ " $new " != *" $id "* ]] || fail "a service was not restarted: '$old', '$new'"
done
grep -qx 'model = "torus"' /etc/tactus/hrtc.toml || fail 'what was configured is lost'
[[ -L /etc/systemd/system/multi-user.target.wants/hrtc.service ]] || fail 'no longer enabled'
# A policy that forbids it prevents restarts.
printf '#!/bin/sh\nexit 101\n' >/usr/sbin/policy-rc.d
chmod 755 /usr/sbin/policy-rc.d
upgrade
[[ "$old" == "$new" ]] || fail "policy-rc.d is passed over: '$old', '$new'"
rm /usr/sbin/policy-rc.d

# --- removed, purged -----------------------------------------------------------------------------

readonly packages=(libtactus-dev libtactus0 tactus-host tactus-controller tactus-doc python3-tactus)
: >/run/systemctl.log
rm /var/lib/tactus/torus.spm
quietly remove.log dpkg --remove "${packages[@]}"
called 'stop hrtc.service'
called 'stop spm_publish.service'
called '--system daemon-reload'
[[ -z $(find /run/services -name '*.service') ]] || fail 'a service runs on'
[[ -z $(ls /usr/bin/hrtc /usr/bin/spm_* /usr/bin/tactus* 2>/dev/null) ]] || fail 'programs are left'
grep -qx 'model = "torus"' /etc/tactus/hrtc.toml || fail 'removal takes the configuration along'
mkdir -p /var/log/tactus
quietly purge.log dpkg --purge "${packages[@]}"
state >after.txt
diff before.txt after.txt || fail 'a purge leaves something behind'
[[ ! -e /var/log/tactus ]] || fail 'reports of the service are left'
echo 'installed, upgraded while the services ran, removed, purged'

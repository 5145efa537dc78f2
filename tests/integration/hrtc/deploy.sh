#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# deploy.sh: an installation in an empty folder has the programs, their services and an example of
# options that hrtc accepts; under a service manager hrtc reports when it is ready, that it is
# alive, and that it stops. $4 is the build folder.
source "$(dirname "$0")/common.sh"
readonly folder=$4
command -v python3 >/dev/null || exit 77

cmake --install "$folder" --prefix "$scratch/root" >install.log || fail 'cmake --install'
readonly installed=$scratch/root/bin documents=$scratch/root/share/doc/tactus
for program in spm_build spm_inspect spm_publish spm_view hrtc; do
    [[ $("$installed/$program" --version) == "$program "* ]] || fault "$program --version"
done
for file in README.md LICENSE docs/deploy.md examples/hrtc.toml; do
    [[ -s $documents/$file ]] || fault "no $file in the documents"
done
[[ $(find root -name 'test_*' -o -name 'tactus_bench' | wc -l) == 0 ]] \
    || fault 'tests are installed, too'

# Options of the example, and the services.
"$installed/hrtc" --config "$documents/examples/hrtc.toml" --print-config >options.toml \
    || fault 'hrtc does not take the options of its example'
grep -qx 'duration=86400' options.toml || fault 'the example is not read'
for unit in hrtc spm_publish spm_view; do
    service=$scratch/root/lib/systemd/system/$unit.service
    ! grep '@[A-Z_]*@' "$service" || fault "a line of $unit.service is not configured"
    grep -q '^ExecStart=.* [$]KEYS$' "$service" || fault "$unit.service takes no keys"
    [[ -s $scratch/root/share/man/man1/$unit.1 ]] || fault "no page of $unit in the manual"
    if command -v systemd-analyze >/dev/null; then
        sed -e "s|^ExecStart=[^ ]*|ExecStart=$installed/$unit|" "$service" >"$unit.service"
        # It also reports other units of the machine.
        systemd-analyze verify --man=no "./$unit.service" >verify.log 2>&1 || true
        ! grep "$unit\.service" verify.log || fault "systemd does not like the service $unit"
        systemd-analyze security --offline=true --threshold=30 "./$unit.service" >exposure.log \
            || fault "exposure of $unit: $(tail -n 1 exposure.log)"
    fi
done

# Models that the example of docs/two-machines.md lets the publisher's service serve.
model bumpy-sphere-5000 ball.spm
options=$(sed -n 's/^OPTIONS="\(.*\)"$/\1/p' "$documents/docs/examples/spm_publish.default")
read -ra options <<<"${options/--domain 0/--domain $domain}"
"$installed/spm_publish" "${options[@]}" --seconds 1 >publish.log \
    || fault 'the example of the service'
grep -q "^serving 'ball'" publish.log || fault "the example serves: $(cat publish.log)"

# Run under a manager that listens.
cat >manager.py <<'PYTHON'
import os, signal, socket, subprocess, sys
listener = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
listener.bind("notify")
listener.settimeout(150)
environment = dict(os.environ, NOTIFY_SOCKET=os.path.abspath("notify"), WATCHDOG_USEC="400000")
environment.pop("WATCHDOG_PID", None)
run = subprocess.Popen(sys.argv[1:], env=environment)
try:
    words = [listener.recv(64).decode() for _ in range(4)]
    run.send_signal(signal.SIGTERM)
    while words[-1] != "STOPPING=1":
        words.append(listener.recv(64).decode())
    code = run.wait(150)
finally:
    run.kill()
sys.exit(code or words[:4] != ["READY=1"] + 3 * ["WATCHDOG=1"])
PYTHON
model bumpy-sphere-5000 good.spm
python3 manager.py "$installed/hrtc" --allow-no-rt --transport file --model good.spm \
    --duration 600 --report report.json >hrtc.log 2>&1 || fault "as a service: $(cat hrtc.log)"
check report.json frames '<' 600000 safety.begun.software == 1
finish

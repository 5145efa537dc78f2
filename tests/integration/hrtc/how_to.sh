#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# how_to.sh: what docs/how-to.md shows of shell and Python is run as it stands there, in its order.
# Its C++ is held by tests/consumer.
page=$(cd "$(dirname "$0")/../../.." && pwd)/docs/how-to.md
readonly page
source "$(dirname "$0")/common.sh"
command -v python3 >/dev/null || exit 77

# Programs as the page calls them: on a domain of this test's, and on any machine.
mkdir programs
cat >programs/hrtc <<SCRIPT
#!/bin/bash
[[ "\$1" == --replay ]] || set -- --allow-no-rt --domain $domain "\$@"
exec "$hrtc" "\$@"
SCRIPT
cat >programs/spm_publish <<SCRIPT
#!/bin/bash
exec "$publish" --domain $domain "\$@"
SCRIPT
chmod +x programs/*
ln -s "$build" programs/spm_build

# The blocks as one script; one of Python is a document for python3.
awk '/^```/ { kind = kind == "" ? substr($0, 4) : ""; blocks += kind == "sh" || kind == "python"
              if (kind == "python") print "python3 - <<\"PYTHON\""
              if (kind == "" && was == "python") print "PYTHON"
              was = kind; next }
     kind == "sh" || kind == "python"
     END { print "echo ran " blocks " blocks" }' "$page" >page.sh
PATH=$scratch/programs:$PATH bash -eu page.sh >page.log 2>&1 || fail "the page: $(cat page.log)"
cat page.log
grep -qx 'ran 5 blocks' page.log || fail 'not all blocks were run'
grep -qE '^[0-9.]+ % of 2000 frames exact or decided$' page.log || fail 'the report is not read'
check many.json frames == 2000 scene.objects == 3 answers.exact+answers.decided '>' 1000
check moving.json frames == 3000 models.0.pose.followed == 1 models.0.pose.moves '>' 100
check again.json frames '>' 1000
finish

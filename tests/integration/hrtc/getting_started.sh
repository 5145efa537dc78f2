#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# getting_started.sh: docs/getting-started.md leads to a touched model, verbatim.
page=$(cd "$(dirname "$0")/../../.." && pwd)/docs/getting-started.md
readonly page
source "$(dirname "$0")/common.sh"
source "$(dirname "$0")/run_page.sh"

run_page "$page" 7
check_contact run.json force.contact_share 0.5
check run.json frames == 5000 force.max_n '>' 0.5 models.0.pieces_refused == 0
grep -qi '<!doctype html>' run.html || fault 'no page for people'
grep -qi '<!doctype html>' part.report.html || fault 'no report of tactus touch'
check part.json frames == 3000 models.0.bytes_received '>' 0
grep -qx 'run.rec: 2000 frames agree bit for bit; .*' page.log || fault 'another replay'
grep -q '^diagonal 0.17[0-9]* m, a unit of the mesh is 1 m;' page.log || fault 'another size'
finish

# SPDX-License-Identifier: Apache-2.0
# shellcheck shell=bash
# Functions for mmdebstrap; to be sourced.

# Lines of this machine's sources.list with Debian's packages.
apt_sources() {
    # shellcheck disable=SC2016 # It is apt-get that knows these names.
    apt-get indextargets \
        --format '$(CREATED_BY) $(ORIGIN) deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 2>/dev/null \
        | sed -n 's/^Packages Debian //p' | sort -u
}

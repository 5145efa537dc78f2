#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# debian.sh SOURCE BUILD FOLDER COMPILER: builds the Debian packages in FOLDER, lets lintian judge
# them, and installs, upgrades, removes and purges them in a bare Debian that mmdebstrap makes there
# from this machine's apt sources. BUILD is a build for another prefix, which cpack must refuse.
# Skips (77) without the tools, without root or without apt sources of Debian.
#
# No systemd runs in that Debian: systemctl.sh replaces it. It records its calls and starts and
# stops the units' programs, so a service that runs during an upgrade is a running process.
set -euo pipefail
readonly source=$1 build=$2 folder=$3 compiler=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here

fail() { printf 'FAULT: %s\n' "$*"; exit 1; }
skip() { printf 'skipped: %s\n' "$*"; exit 77; }
quietly() { # quietly LOG COMMAND...: prints the output only on failure.
    local log=$1
    shift
    "$@" >"$log" 2>&1 || { tail -n 40 "$log"; fail "this failed: $*"; }
}

for tool in dpkg-deb dpkg-shlibdeps file lintian mmdebstrap unshare; do
    command -v "$tool" >/dev/null || skip "$tool is missing (cmake/packages-ci.txt)"
done
((EUID == 0)) || skip 'only root can make a system of its own'
# shellcheck source=apt_sources.sh
source "$here/apt_sources.sh"
mapfile -t sources < <(apt_sources)
((${#sources[@]} > 0)) || skip "this machine has no apt sources of Debian's"
mkdir -p "$folder"
cd "$folder"

# --- packages ------------------------------------------------------------------------------------

if grep -qx 'CMAKE_INSTALL_PREFIX:PATH=/usr' "$build/CMakeCache.txt"; then
    echo "$build is for /usr: not tried that cpack refuses another prefix"
else
    ! cpack --config "$build/CPackConfig.cmake" -B "$folder/refused" >refused.log 2>&1 \
        || fail 'cpack makes packages for another prefix than /usr'
    grep -q 'Debian packages are for /usr' refused.log || fail "$(<refused.log)"
fi
launcher=()
if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
fi
(cd "$source" && quietly "$folder/build.log" cmake --preset deb -B "$folder/build" \
    -DCMAKE_CXX_COMPILER="$compiler" "${launcher[@]}")
quietly build.log cmake --build build --parallel 2
rm -rf new old root
mkdir new old
(umask 077 && quietly cpack.log cpack --config build/CPackConfig.cmake -B "$folder/new")
version=$(sed -n '1s/^tactus (\(.*\)) .*$/\1/p' "$source/cmake/debian/changelog")
packages=(libtactus0 libtactus-dev tactus-host tactus-controller tactus-doc python3-tactus)
for package in "${packages[@]}"; do
    [[ -f $(echo "new/${package}_${version}"_*.deb) ]] || fail "no package $package $version"
done
# docs/install.md names the preset of all three steps, and the name of a package.
preset=$(sed -n 's/^    cmake --workflow --preset //p' "$source/docs/install.md")
presets=$(cd "$source" && cmake --workflow --list-presets)
[[ -n "$preset" && "$presets" == *"\"$preset\""* ]] || fail "docs/install.md: no preset '$preset'"
named=$(sed -n 's|^    apt-get install \./build/deb/\([^ ]*\) .*$|\1|p' "$source/docs/install.md")
made=new/${named%_*}_$(dpkg --print-architecture).deb
[[ "$named" == *"_${version}_amd64.deb" ]] || fail "docs/install.md names '$named'"
[[ -f "$made" ]] || fail "docs/install.md names '$named', but there is no $made"
quietly lintian.log lintian --allow-root --fail-on error,warning --tag-display-limit 0 new/*.deb
grep -v '^running with root privileges' lintian.log || true

# holds PACKAGE FILE...: expects these files in the package.
holds() {
    local file package=$1
    dpkg-deb --fsys-tarfile "new/${package}_${version}"_*.deb | tar --list >contents.txt
    for file in "${@:2}"; do
        grep -qE "^\\./$file\$" contents.txt || fail "$package lacks $file"
    done
}
libraries=usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)
readonly libraries
holds libtactus0 "$libraries"/libtactus_{core,transport,platform,host,c}.so.0 \
    "$libraries"/libtactus.so.0
holds libtactus-dev "$libraries"/libtactus_{core,transport,platform,host,c}.{a,so} \
    "$libraries"/libtactus.{a,so} "$libraries"/pkgconfig/tactus.pc usr/include/tactus/world.hpp \
    "$libraries"/pkgconfig/tactus-{core,transport,platform,host,c}.pc \
    "$libraries/cmake/Tactus/TactusConfig.cmake" usr/include/tactus/tactus.h \
    usr/include/tactus/rt_core/frame/frame.hpp usr/share/man/man3/tactus.h.3.gz
holds tactus-host usr/bin/{spm_{build,inspect,publish},tactus,tactus-keys} \
    usr/share/man/man1/{spm_{build,inspect,publish},tactus}.1.gz \
    usr/lib/systemd/system/spm_{publish,view}.service etc/default/spm_{publish,view}
holds tactus-controller usr/bin/hrtc usr/share/man/man1/hrtc.1.gz etc/tactus/hrtc.toml \
    usr/lib/systemd/system/hrtc.service usr/lib/sysctl.d/61-tactus.conf \
    etc/security/limits.d/tactus.conf
holds tactus-doc usr/share/doc/tactus/docs/deploy.md usr/share/doc/tactus/examples/hrtc.toml
holds python3-tactus 'usr/lib/python3/dist-packages/tactus\.cpython-3.*\.so'
dpkg-deb --field new/libtactus0_*.deb Depends | grep -q 'libddsc' \
    || fail "libtactus0 does not depend on what it is linked to"

# The same content as an older version.
for package in new/*.deb; do
    rm -rf unpacked
    dpkg-deb --raw-extract "$package" unpacked
    sed -i -E "s/^(Version:|Depends:.*\\(=) ${version//./\\.}/\\1 0.1.0/" unpacked/DEBIAN/control
    quietly old.log dpkg-deb --root-owner-group --build unpacked old
done
rm -rf unpacked

# --- a bare Debian -------------------------------------------------------------------------------

needed=$(for package in new/*.deb; do dpkg-deb --field "$package" Depends; done \
    | tr ',' '\n' | awk 'NF > 0 { print $1 }' | grep -v tactus | sort -u | paste -sd,)
readonly root=$folder/root
trap 'rm -rf --one-file-system "$root"' EXIT
printf '%s\n' "${sources[@]}" \
    | quietly mmdebstrap.log mmdebstrap --variant=minbase --include="$needed" \
        "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root" -
mkdir -p "$root/packages"
cp -r new old "$root/packages"
cp "$here/in_a_bare_debian.sh" "$root/packages"
install -m 755 "$here/systemctl.sh" "$root/packages/systemctl"

# Separate mounts and processes; the kernel's settings are this machine's and stay unchanged.
# shellcheck disable=SC2016 # It is the inner shell that knows $1.
unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$1/proc"
    mount --bind "$1/proc/sys" "$1/proc/sys"
    mount -o remount,bind,ro "$1/proc/sys"
    mount -t sysfs -o ro sysfs "$1/sys"
    mount --rbind /dev "$1/dev"
    mount -t tmpfs tmpfs "$1/run"
    exec chroot "$1" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/ LC_ALL=C.UTF-8 \
        DEBIAN_FRONTEND=noninteractive bash /packages/in_a_bare_debian.sh "$2" "$3"' \
    bash "$root" "$version" "$(($$ % 231))"

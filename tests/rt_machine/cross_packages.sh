#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# cross_packages.sh ARCHITECTURE PACKAGES FOLDER: makes the Debian packages that rt_machine.sh needs
# for another ARCHITECTURE (arm64) in FOLDER, from this machine's in PACKAGES. Their programs are
# compiled by Debian's cross compiler with that architecture's libraries, unpacked in
# FOLDER/sysroot, none of them run; the rest of a package is unchanged. So are the dependencies:
# Debian's libraries have the same names and versions there.
# Exit codes: 0 done, 2 failed, 3 usage, 77 something is missing here.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source=$(cd "$here/../.." && pwd)
readonly here source
# shellcheck source=common.sh
source "$here/common.sh"
# shellcheck source=../packages/apt_sources.sh
source "$here/../packages/apt_sources.sh"
[[ $# == 3 ]] || { echo 'Usage: cross_packages.sh ARCHITECTURE PACKAGES FOLDER' >&2; exit 3; }
readonly architecture=$1
case "$architecture" in
    arm64) readonly processor=aarch64 triplet=aarch64-linux-gnu ;;
    *) fail "packages for $architecture can't be made, only for arm64" ;;
esac
packages=$(cd "$2" 2>/dev/null && pwd) || fail "no folder $2"
mkdir -p "$3" 2>/dev/null || fail "$3 can't be written"
folder=$(cd "$3" && pwd)
readonly packages folder
need_tools mmdebstrap "$triplet-g++" "$triplet-strip" dpkg-deb ninja
need_space "$folder" 2
cd "$folder"
readonly libraries=$folder/sysroot/usr/lib/$triplet

mapfile -t sources < <(apt_sources)
((${#sources[@]} > 0)) || skip "this machine has no apt sources of Debian's"
wanted=$(sed -e 's/#.*//' "$source/cmake/packages.txt" | grep -oE '^[^ ]+-dev' | paste -sd,)
if [[ "$(cat made_of 2>/dev/null)" != "$wanted" ]]; then
    rm -rf sysroot made_of
    printf '%s\n' "${sources[@]}" >sources
    await mmdebstrap --variant=extract --architectures="$architecture" --include="$wanted" \
        bookworm sysroot sources >mmdebstrap.log 2>&1 || fail "mmdebstrap failed, see \
$folder/mmdebstrap.log: $(grep -m 1 '^E: ' mmdebstrap.log || tail -n 1 mmdebstrap.log)"
    # libccd names the mathematics library by path; the compiler's is used.
    sed -i "s|/usr/lib/$triplet/libm.so|m|" "$libraries/ccd/ccd-targets-none.cmake"
    echo "$wanted" >made_of
fi
cat >toolchain.cmake <<TOOLCHAIN
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR $processor)
set(CMAKE_C_COMPILER $triplet-gcc)
set(CMAKE_CXX_COMPILER $triplet-g++)
set(CMAKE_LIBRARY_ARCHITECTURE $triplet)
set(CMAKE_FIND_ROOT_PATH $folder/sysroot)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_C_STANDARD_INCLUDE_DIRECTORIES $folder/sysroot/usr/include/$triplet)
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES $folder/sysroot/usr/include/$triplet)
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-Wl,-rpath-link,$libraries:$folder/sysroot/lib/$triplet")
TOOLCHAIN
export PKG_CONFIG_SYSROOT_DIR=$folder/sysroot
export PKG_CONFIG_LIBDIR=$libraries/pkgconfig:$folder/sysroot/usr/share/pkgconfig
build() {
    await cmake -S "$source" --preset deb -B build \
        -DCMAKE_TOOLCHAIN_FILE="$folder/toolchain.cmake" \
        && await ninja -C build hrtc spm_build spm_inspect spm_publish spm_view tactus \
            tactus-keys
}
build >build.log 2>&1 || fail "the build for $architecture failed, see $folder/build.log: $(grep \
    -m 1 -iE 'error' build.log || tail -n 1 build.log)"

rm -f ./*.deb
for package in tactus-host tactus-controller; do
    rm -rf installed package
    DESTDIR=$folder/installed cmake --install build --component "$package" >/dev/null
    dpkg-deb -R "$packages/${package}"_*.deb package
    while IFS= read -r -d '' program; do
        if [[ "$(head -c 4 "package/$program")" == $'\x7fELF' ]]; then
            "$triplet-strip" -o "package/$program" "installed/$program"
        fi
    done < <(cd package && find . -type f -perm -u+x ! -path './DEBIAN/*' -print0)
    sed -i "s/^Architecture: .*/Architecture: $architecture/" package/DEBIAN/control
    (cd package && find . -type f ! -path './DEBIAN/*' -printf '%P\0' | LC_ALL=C sort -z \
        | xargs -0 md5sum >DEBIAN/md5sums)
    dpkg-deb --root-owner-group -b package . >/dev/null
done
cp "$packages"/tactus-doc_*.deb .
rm -rf installed package
ls "$folder"/*.deb

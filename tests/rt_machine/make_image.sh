#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_image.sh FOLDER ARCHITECTURE PACKAGE.deb...: makes a Debian 12 for that architecture with the
# RT kernel and these packages, as FOLDER/image (an initramfs) and FOLDER/kernel, unless they
# already have the same packages. Neither exists before it is complete. An initramfs is used since a
# disk takes the host's time: without one two runs are equal to the bit.
# Exit codes: 0 done, 2 failed, 77 something is missing here.
set -euo pipefail
readonly folder=$1 architecture=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
# shellcheck source=common.sh
source "$here/common.sh"
# shellcheck source=../packages/apt_sources.sh
source "$here/../packages/apt_sources.sh"

# Further packages of the machine: to inspect it, change its network, and drive its device.
readonly more=systemd-sysv,udev,kmod,dbus,iproute2,procps,rt-tests,python3-minimal,e2fsprogs
# Drivers that stay: of its network, and of the disk whose power is cut.
readonly modules='sch_netem veth virtio_pci virtio_blk ext4 crypto-crc32c'

need_tools mmdebstrap bsdtar mke2fs
if ! mkdir -p "$folder" 2>/dev/null || [[ ! -w "$folder" ]]; then
    fail "$folder can't be written"
fi
made_of=$(cat "$here/make_image.sh" "$@" | sha256sum)
if [[ -s "$folder/image" && "$(cat "$folder/made_of" 2>/dev/null)" == "$made_of" ]]; then
    exit 0
fi
[[ ! -e "$folder/root.tar" ]] || echo "the image was half made; making it anew"
rm -f "$folder"/{image,kernel,made_of,root.tar}
need_space "$folder" 3
((EUID == 0)) || unshare --user --map-auto --map-root-user true 2>/dev/null \
    || skip 'neither root nor user namespaces with uidmap: mmdebstrap makes no system here'
if [[ "$architecture" != "$(dpkg --print-architecture)" ]]; then
    need_tools arch-test
    arch-test "$architecture" >/dev/null || skip "programs for $architecture don't run here; as \
root: mount -t binfmt_misc none /proc/sys/fs/binfmt_misc; update-binfmts --import qemu-aarch64"
fi
mapfile -t sources < <(apt_sources)
((${#sources[@]} > 0)) || skip "this machine has no apt sources of Debian's"
trap 'end_child; rm -f "$folder"/{root.tar,image.partial}' EXIT

# strip ROOT: removes everything unneeded, and files that would differ between boots.
cat >"$folder/strip.sh" <<STRIP
set -eu
root=\$1
for kernel in "\$root"/lib/modules/*; do
    for module in $modules; do
        chroot "\$root" modprobe --set-version "\${kernel##*/}" --show-depends "\$module"
    done | sed -n "s|^insmod \([^ ]*\).*|\$root\1|p" >"\$root/packages/kept"
    find "\$kernel" -name '*.ko' | grep -vxFf "\$root/packages/kept" | xargs rm
    chroot "\$root" depmod "\${kernel##*/}"
done
rm -rf "\$root"/boot/initrd* "\$root"/usr/share/locale "\$root"/var/cache/apt/* \\
    "\$root"/var/lib/apt/lists/* "\$root"/usr/lib/udev/hwdb.bin "\$root"/usr/lib/*/gconv \\
    "\$root"/packages
# Models are built here, since building one takes the machine longer than most scenarios.
mkdir "\$root/usr/share/tactus_models"
for faces in 2000 20000 200000; do
    chroot "\$root" spm_build --shape bumpy-sphere --faces "\$faces" \\
        -o "/usr/share/tactus_models/bumpy-\$faces.spm"
done
chroot "\$root" spm_build --shape torus --faces 1000 --fit-diag 0.02 \\
    -o /usr/share/tactus_models/ring.spm
find "\$root"/usr/share/doc -mindepth 1 -maxdepth 1 ! -name 'tactus*' -exec rm -rf {} +
# The machine looks already booted once: only enabled services run.
echo 0123456789abcdef0123456789abcdef >"\$root/etc/machine-id"
echo controller >"\$root/etc/hostname"
for getty in serial-getty@ttyS0 serial-getty@ttyAMA0 getty@tty1; do
    ln -sf /dev/null "\$root/etc/systemd/system/\$getty.service"
done
ln -sf /sbin/init "\$root/init"
STRIP

# docs/deploy.md: steps 1 and 2 are executed here.
debs=$(printf '%q ' "$@")
printf '%s\n' "${sources[@]}" >"$folder/sources"
readonly install='apt-get -q install --yes --no-install-recommends'
await mmdebstrap --variant=minbase --architectures="$architecture" --include="$more" \
    --customize-hook="INITRD=No chroot \"\$1\" $install linux-image-rt-$architecture" \
    --customize-hook="mkdir \"\$1/packages\"" --customize-hook="copy-in $debs /packages" \
    --customize-hook="chroot \"\$1\" sh -c '$install /packages/*.deb'" \
    --customize-hook="sh $(printf %q "$folder/strip.sh") \"\$1\"" \
    bookworm "$folder/root.tar" "$folder/sources" >"$folder/mmdebstrap.log" 2>&1 \
    || fail "mmdebstrap failed, see $folder/mmdebstrap.log: $(grep -m 1 '^E: ' \
        "$folder/mmdebstrap.log" || tail -n 1 "$folder/mmdebstrap.log")"
bsdtar -xOf "$folder/root.tar" './boot/vmlinuz-*' >"$folder/kernel"
bsdtar -cf "$folder/image.partial" --format=newc --exclude './boot/*' --exclude './dev/*' \
    "@$folder/root.tar" || fail "bsdtar makes no image of $folder/root.tar"
mv "$folder/image.partial" "$folder/image"
echo "$made_of" >"$folder/made_of"

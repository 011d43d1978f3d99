# What the scripts of this folder share: a Debian system in a folder, made by debootstrap, and commands run inside it.
# Sourced. Needs root (debootstrap, chroot and a private mount namespace) and the package debootstrap; packages come from
# DEBIAN_MIRROR, by default the Debian mirror of this machine's own apt sources. $target names the make target.

fail() { echo "make $target: $*" >&2; exit 2; }
[ "$(id -u)" = 0 ] || fail "needs root: debootstrap and chroot do; run it as root, e.g. with sudo"
for tool in debootstrap unshare chroot tar; do
  command -v "$tool" >/dev/null || fail "$tool is not on PATH; on Debian: apt-get install debootstrap util-linux"
done

# The first Debian archive (a URI that ends in /debian) of one-line or deb822 apt sources.
own_mirror() {
  cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
    sed -nE 's/^(URIs:|deb( +\[[^]]*\])?) +([^ ]+).*/\3/p' | grep -E '/debian/?$' | head -n 1 || true
}
mirror="${DEBIAN_MIRROR:-$(own_mirror)}"
[ -n "$mirror" ] || fail "no Debian mirror in this machine's apt sources; set DEBIAN_MIRROR to one"

# Run a shell command in a system's folder, with the variables in the array `settings` and no others of this machine;
# mounts live in a namespace of their own and end with it.
settings=()
inside() {
  local root=$1; shift
  unshare --mount --pid --fork --kill-child -- bash -c '
    root=$1; shift
    mount -t proc proc "$root/proc"; mount --rbind /sys "$root/sys"; mount --rbind /dev "$root/dev"
    exec chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
      DEBIAN_FRONTEND=noninteractive "$@"
  ' inside "$root" ${http_proxy:+"http_proxy=$http_proxy"} "${settings[@]}" bash -c "$*"
}

# A bare Debian in a folder, and commands in it. Sourced by tools/in_bare_root.sh and tests/first_hour; needs root rights and debootstrap.
# Mirror, ways to it and trusted certificates are those of this machine. bare_release: another release of the same mirror.

bare_release=${bare_release:-bookworm}  # Debian 12
bare_certificates=etc/ssl/certs/ca-certificates.crt

# bare_root_problem: why there can be none here; nothing where there can.
bare_root_problem() {
  [[ $(id -u) == 0 ]] || { echo "must run as root: debootstrap and chroot"; return; }
  local tool
  for tool in debootstrap unshare; do command -v "$tool" >/dev/null || { echo "$tool is missing"; return; }; done
  [[ -n $(bare_root_mirror) ]] || echo "apt of this machine knows no mirror of Debian"
}

bare_root_mirror() {
  # shellcheck disable=SC2016  # apt fills the fields in
  apt-get indextargets --format '$(ORIGIN) $(RELEASE) $(COMPONENT) $(SITE)' 'Created-By: Packages' |
    awk -v own="$(. /etc/os-release && echo "$VERSION_CODENAME")" '$1 == "Debian" && $2 == own && $3 == "main" {print $4; exit}'
}

# make_bare_root ROOT PACKAGE,..: the smallest Debian and these packages, in a folder that is empty or does not exist.
make_bare_root() {
  local root=$1 log
  log=$(mktemp)
  debootstrap --variant=minbase --include="$2" "$bare_release" "$root" "$(bare_root_mirror)" >"$log" 2>&1 || { tail -n 20 "$log" >&2; rm "$log"; return 1; }
  rm "$log"
  apt-config dump --no-empty | grep -E '^Acquire::(http|https|Check-|Retries|Force)' >"$root/etc/apt/apt.conf.d/99mirror" || true
  cp -L /etc/resolv.conf /etc/hosts "$root/etc/"
  [[ ! -f /$bare_certificates ]] || cp -L "/$bare_certificates" "$root/$bare_certificates"
}

# in_root ROOT FOLDER COMMAND: a shell command in the root, in this folder of it, with /proc, /dev and processes of its own that end with it.
in_root() {
  # shellcheck disable=SC2016  # the inner shell fills them in
  unshare --mount --pid --fork --kill-child bash -c '
    set -e
    mount --make-rprivate /
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    exec chroot "$0" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive NODE_EXTRA_CA_CERTS="/$1" bash -c "cd $2 && $3"' \
    "$1" "$bare_certificates" "$2" "$3"
}

# cached_bare_root ROOT PACKAGE,.. ARCHIVE: the same, kept in an archive for the next time.
cached_bare_root() {
  if [[ ! -f $3 ]]; then
    make_bare_root "$1" "$2" || return 1
    mkdir -p "$(dirname "$3")"
    tar -C "$1" -cf "$3.part" . && mv "$3.part" "$3"
  else
    mkdir -p "$1" && tar -C "$1" -xf "$3"
  fi
  chmod 755 "$1"
}

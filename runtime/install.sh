# Sourced by runtime/sherd and tests/run: makes sure that the packages in packages.txt are there.
# With all of them present neither apt nor sudo is touched. SHERD_NO_INSTALL=1 only prints the command.

# sherd_packages FILE [PART]: the packages above the first [part], and those of PART.
sherd_packages() {
  sed -e 's/#.*//' "$1" | awk -v part="[${2:-}]" '
    /^\[/ { other = $0 != part; next }
    NF && !other'
}

sherd_missing_packages() {
  local package
  for package in $(sherd_packages "$@"); do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

# apt-get that waits for another apt or dpkg to finish, ten minutes at most.
sherd_apt_get() {
  local tries=0 log
  log=$(mktemp)
  while ! $SHERD_SUDO env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 "$@" >"$log" 2>&1; do
    if grep -q 'Could not get lock' "$log" && [ $((tries += 1)) -le 200 ]; then
      [ "$tries" = 1 ] && echo "sherd: waiting for another package manager to finish" >&2
      sleep 3
      continue
    fi
    tail -n 20 "$log" >&2
    rm -f "$log"
    return 1
  done
  rm -f "$log"
}

# sherd_install_packages FILE [PART]
sherd_install_packages() {
  local missing
  missing=$(sherd_missing_packages "$@" | tr '\n' ' ')
  [ -z "$missing" ] && return 0
  SHERD_SUDO=
  [ "$(id -u)" = 0 ] || SHERD_SUDO=sudo
  if [ "${SHERD_NO_INSTALL:-}" = 1 ]; then
    echo "sherd: packages are missing; install them with:" >&2
    echo "  ${SHERD_SUDO:+sudo }apt-get install --no-install-recommends $missing" >&2
    return 1
  fi
  if [ -n "$SHERD_SUDO" ] && ! command -v sudo >/dev/null; then
    echo "sherd: packages are missing and there is no sudo; as root, run:" >&2
    echo "  apt-get install --no-install-recommends $missing" >&2
    return 1
  fi
  echo "sherd: installing $missing" >&2
  sherd_apt_get update && sherd_apt_get install -y --no-install-recommends $missing || {
    echo "sherd: the packages could not be installed" >&2
    return 1
  }
}

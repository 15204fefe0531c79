#!/usr/bin/env bash
# Unpacks the models of Debian's libcgal-demo into a folder. They are third-party data: use and
# cite them, never commit them.
set -euo pipefail
target=$1
mkdir -p "$target"
target=$(cd "$target" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
cd "$work"
apt-get download -qq libcgal-demo >/dev/null 2>&1 || {
  if [ "$(id -u)" -eq 0 ]; then apt-get update -qq; else sudo apt-get update -qq; fi
  apt-get download -qq libcgal-demo >/dev/null 2>&1
}
dpkg-deb --fsys-tarfile libcgal-demo_*.deb |
  tar -xO ./usr/share/doc/libcgal-dev/data.tar.gz |
  tar -xz -C "$work" data/meshes
mv data/meshes/* "$target"

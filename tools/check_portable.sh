#!/usr/bin/env bash
# Whether the library's sources are understood by clang with its own standard library, and by g++ for
# Windows. Only their syntax is checked: nothing is linked or run. With file names, only those; with
# --windows first, only for Windows.
#
# Left out for Windows are the parts that need packages of their own there: pictures (EGL), and the
# union of boxes (GMP); and io/atomic_file, which replaces files in POSIX's way alone yet.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
windows_only=0
if [ "${1:-}" = --windows ]; then
  windows_only=1
  shift
fi
work=build/portable
jobs=${JOBS:-$(nproc)}
rm -rf "$work"
mkdir -p "$work/include"
# Not /usr/include itself, which has the headers of another C library.
for name in tbb oneapi hwy boost CGAL fast_float fmt nlohmann zlib.h zconf.h gmp.h gmpxx.h mpfr.h; do
  for folder in /usr/include /usr/include/"$(uname -m)"-linux-gnu; do
    [ -e "$folder/$name" ] && ln -sfn "$folder/$name" "$work/include/$name"
  done
done
# What nearly all of them include, read once.
cat >"$work/common.h" <<'CODE'
#include "core/parallel.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <filesystem>
#include <map>
#include <string>
CODE
sources() {
  if [ $# -gt 0 ]; then
    printf '%s\n' "$@"
  else
    git ls-files 'src/*.cpp' | grep -v '^src/render/'
  fi
}
flags=(-std=c++20 -Iinclude -Isrc -isystem /usr/include/eigen3 -isystem "$work/include"
  -DEIGEN_DONT_VECTORIZE -Wall -Wextra -Werror=return-type)
failed=0

check() { # check NAME COMPILER... : files from stdin, one process each
  local name=$1
  shift
  xargs -P "$jobs" -I{} sh -c "$* -fsyntax-only {} || { echo '{}: $name cannot compile it' >&2; exit 1; }" || failed=1
}

if [ $windows_only = 0 ]; then
  libcxx=(clang++ -stdlib=libc++ "${flags[@]}")
  "${libcxx[@]}" -x c++-header "$work/common.h" -o "$work/common.pch"
  sources "$@" | check "clang with libc++" "${libcxx[@]}" -include-pch "$work/common.pch"
fi

mingw=(x86_64-w64-mingw32-g++-posix "${flags[@]}")
mkdir "$work/mingw"
cp "$work/common.h" "$work/mingw/common.h"
"${mingw[@]}" -x c++-header "$work/mingw/common.h" -o "$work/mingw/common.h.gch"
sources "$@" | grep -vE '/(unite|atomic_file)\.cpp$' | check "g++ for Windows" "${mingw[@]}" -include "$work/mingw/common.h"
exit "$failed"

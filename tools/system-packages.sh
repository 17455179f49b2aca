#!/usr/bin/env bash
# Sees to the system packages that Tubeloom draws with: installs them when root with apt, otherwise
# says which command does. `system-packages.sh test` sees to what the tests need besides, and
# `system-packages.sh bench` to what is measured beside Tubeloom.
set -euo pipefail

# Not by a pipe into `grep -q`: that ends while ldconfig still writes, which counts as a failure.
libraries=$(PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null || true)
has_library() { [[ $libraries == *"$1"* ]]; }
has_package() { [ -n "$(apt-cache policy "$1" 2>/dev/null | sed -n 's/ *Candidate: \([^(].*\)/\1/p')" ]; }

lacks=()
case "${1:-}" in
  "")
    has_library libOSMesa.so || has_library libEGL_mesa || lacks+=(mesa)
    # pyrender imports pyglet, which loads these even where nothing is shown on a screen.
    has_library libGL.so.1 || lacks+=(gl)
    has_library libXrender.so.1 || lacks+=(xrender)
    # Final pictures do not come without libatomic, and are four times as quick with LLVM.
    has_library libatomic.so.1 || lacks+=(atomic)
    [[ $libraries =~ libLLVM(-|\.so\.)(1[7-9]|2[0-9]) ]] || lacks+=(llvm)
    ;;
  test)
    has_library libOSMesa.so || lacks+=(mesa)
    has_library libEGL.so.1 && has_library libEGL_mesa || lacks+=(egl)
    command -v chromium >/dev/null || lacks+=(chromium)
    ls /usr/lib/postgresql/*/bin/postgres >/dev/null 2>&1 || lacks+=(postgres)
    ;;
  bench)
    command -v neato >/dev/null && command -v sfdp >/dev/null || lacks+=(graphviz)
    command -v wrk >/dev/null || lacks+=(wrk)
    ;;
  *)
    echo "usage: system-packages.sh [test|bench]" >&2
    exit 2
    ;;
esac
[ ${#lacks[@]} -eq 0 ] && exit 0

apt=no
if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
  apt=yes
  apt-get update -qq
fi

packages=()
for part in "${lacks[@]}"; do
  case $part in
    # Mesa 25.1 and later have no OSMesa; EGL draws there.
    mesa) if [ $apt = no ] || has_package libosmesa6; then packages+=(libosmesa6); else packages+=(libegl1 libegl-mesa0 libgl1-mesa-dri); fi ;;
    gl) packages+=(libgl1) ;;
    xrender) packages+=(libxrender1) ;;
    llvm)
      for version in 21 20 19 18 17; do
        if [ $apt = no ] || has_package libllvm$version; then
          [ $apt = no ] && version=19
          packages+=(libllvm$version)
          break
        fi
      done
      ;;
    atomic) packages+=(libatomic1) ;;
    egl) packages+=(libegl1 libegl-mesa0 libgl1-mesa-dri) ;;
    chromium) packages+=(chromium) ;;
    postgres) packages+=(postgresql) ;;
    graphviz) packages+=(graphviz) ;;
    wrk) packages+=(wrk) ;;
  esac
done

if [ $apt = yes ]; then
  [ ${#packages[@]} -eq 0 ] && exit 0
  DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${packages[@]}"
else
  echo "This machine lacks system packages; PNG pictures (or some tests or benchmarks) need them. Please run:" >&2
  echo "  sudo apt-get install ${packages[*]}" >&2
fi

#!/usr/bin/env bash
# Installs sherd into a directory of its own, builds the node pack beside this file against it as a third party would, and
# runs both.
#   run.sh BUILD        BUILD is the build directory of sherd
set -eu
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$build/sdk_example
unset LD_LIBRARY_PATH SHERD_NODE_PATH SHERD_ASSETS

fail() { echo "FAILED: $*" >&2; exit 1; }
# expect TEXT COMMAND…: the command succeeds and prints TEXT.
expect() {
  local text=$1 output
  shift
  output=$("$@" 2>&1) || fail "$* ends with $?: $output"
  case $output in *"$text"*) ;; *) fail "$* doesn't print '$text' but: $output" ;; esac
}

rm -rf "$work"
mkdir -p "$work/source"
cmake --install "$build" --prefix "$work/first" >"$work/install.log"
# The tree may be moved: nothing in it holds the place where it was installed.
mv "$work/first" "$work/prefix"
program=$work/prefix/bin/sherd

cp "$here"/{CMakeLists.txt,volume_node.cpp,volume.json,box.obj} "$work/source"
cmake -S "$work/source" -B "$work/pack" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF >"$work/configure.log" 2>&1 ||
  fail "$(cat "$work/configure.log")"
grep -q "CMake Warning" "$work/configure.log" && fail "$(cat "$work/configure.log")"
cmake --build "$work/pack" >"$work/build.log" 2>&1 || fail "$(cat "$work/build.log")"

# The installed program finds its own libraries, nodes, assets and graphs.
expect "Simulate@1" "$program" nodes
expect "no errors" "$program" check "$work/prefix/share/sherd/graphs/first_fracture.json"
libraries=$(ldd "$program" "$work/prefix"/lib/*.so "$work/pack/volume_nodes.so")
case $libraries in *"not found"*) fail "$libraries" ;; esac
case $libraries in *"$build/lib/"*) fail "the installed files use those of the build: $libraries" ;; esac

# And the node from outside.
export SHERD_NODE_PATH=$work/pack
expect "Volume@1" "$program" nodes
expect "kg/m³" "$program" nodes Volume
expect '"Volume@1"' "$program" nodes --schema
expect "1.000000 m³" "$program" run "$work/source/volume.json" --to volume

# Every installed header can be included alone.
include=$work/prefix/include/sherd
for header in $(cd "$include" && find . -name '*.h'); do
  printf '#include "%s"\n' "${header#./}"
done >"$work/source/all_headers.cpp"
[ "$(wc -l <"$work/source/all_headers.cpp")" -ge 15 ] || fail "few headers: $(cat "$work/source/all_headers.cpp")"
cat >>"$work/source/CMakeLists.txt" <<'END'
file(STRINGS all_headers.cpp includes)
foreach(include IN LISTS includes)
  string(MD5 name "${include}")
  file(WRITE ${CMAKE_BINARY_DIR}/${name}.cpp "${include}\n")
  list(APPEND alone ${CMAKE_BINARY_DIR}/${name}.cpp)
endforeach()
add_library(alone OBJECT ${alone})
target_link_libraries(alone PRIVATE sherd::types)
END
cmake --build "$work/pack" --target alone >"$work/headers.log" 2>&1 || fail "$(cat "$work/headers.log")"
echo "installed, built and ran"

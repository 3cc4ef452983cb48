#!/usr/bin/env bash
# Sets up what the tests need and runs all of them, or with --fast the quick ones. The one command for people and
# machines alike.
#
# Tests draw with Mesa's lavapipe, a Vulkan driver that needs no graphics card, so that results are the same everywhere.
# To test another driver: VK_DRIVER_FILES=/path/to/its_icd.json tests/run.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
    cat <<'EOF'
usage: tests/run.sh [--fast]

Without an option: format, lints (also of the command without its window), all tests, documentation.

--fast: format, and the tests that are quick (under a minute once they are built). It leaves out
  - lints (cargo clippy), the build without the window, and the documentation;
  - most tests that draw with the graphics adapter, and those that hold techniques against ray casting;
  - drawings, hours on façades, years, tiles, and studies that were stopped;
  - the readers of model files, terrain, reference systems, and the names of components;
  - rules, judging by them, and how high may be built;
  - choices of technique, messages, the folders of a study, and the library's interface;
  - all tests of the window, and nearly all of the command as a process of its own.
The list QUICK in this file has the modules whose tests it runs.
Run everything before you hand a change in.
EOF
}

# The modules of the quick tests. A word here that names no test is an error.
QUICK=(
    architecture:: circles:: clock:: documents:: doors:: export::contour:: export::raster:: export::report:: far::
    geometry:: mistakes:: model:: probe:: references:: shaders:: site:: sun:: typed:: volumes::
)

fast=false
for argument in "$@"; do
    case $argument in
        --fast) fast=true ;;
        --help | -h) usage; exit ;;
        *) usage >&2; printf '\ntests/run.sh: no option %s\n' "$argument" >&2; exit 2 ;;
    esac
done

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'tests/run.sh: %s\n' "$*" >&2; exit 1; }

# The first lavapipe driver that is installed, if any.
lavapipe() {
    local file
    for file in /usr/share/vulkan/icd.d/lvp_icd*.json /usr/local/share/vulkan/icd.d/lvp_icd*.json \
        /etc/vulkan/icd.d/lvp_icd*.json; do
        if [ -r "$file" ]; then
            printf '%s\n' "$file"
            return
        fi
    done
}

# Installs Debian packages; the first word says what is missing.
install() {
    local missing=$1
    shift
    command -v apt-get >/dev/null ||
        fail "no $missing: install it (Debian's packages: $*)"
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || fail "no $missing: as root, apt-get install $*"
        as_root=(sudo)
    fi
    say "installing $*"
    "${as_root[@]}" apt-get update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
}

CARGO=${CARGO:-cargo}
if ! command -v "$CARGO" >/dev/null; then
    CARGO=$HOME/.cargo/bin/cargo
    [ -x "$CARGO" ] || fail "cargo was not found: install Rust from https://rustup.rs, or set CARGO to its path"
    PATH=$HOME/.cargo/bin:$PATH
fi

# Elsewhere the system's own adapter draws.
if [ "$(uname -s)" = Linux ]; then
    if [ -z "${VK_DRIVER_FILES:-}" ]; then
        [ -n "$(lavapipe)" ] || install "software Vulkan driver (Fedora: mesa-vulkan-drivers, Arch: vulkan-swrast)" mesa-vulkan-drivers
        VK_DRIVER_FILES=$(lavapipe)
        [ -n "$VK_DRIVER_FILES" ] || fail "mesa-vulkan-drivers is installed but holds no lavapipe; set VK_DRIVER_FILES"
    fi
    export VK_DRIVER_FILES
    export VK_ICD_FILENAMES=$VK_DRIVER_FILES # the same for Vulkan loaders before 1.3.207
    say "Vulkan driver: $VK_DRIVER_FILES"

    # The window is driven before an X server without a screen, by its pointer and keys.
    if ! $fast; then
        for program in Xvfb xdotool xwd; do
            command -v "$program" >/dev/null || {
                install "$program" xvfb xdotool x11-apps libxkbcommon-x11-0 libxcursor1 libxi6 libxrandr2 libx11-xcb1
                break
            }
        done
    fi
fi

say "format"
"$CARGO" fmt --check
if $fast; then
    say "quick tests"
    known=$("$CARGO" test --test all -- --list)
    for word in "${QUICK[@]}"; do
        grep -q "^$word" <<<"$known" || fail "no test is in $word: mend the list QUICK in this file"
    done
    "$CARGO" test --test all -- "${QUICK[@]}"
    say "the quick tests are well; tests/run.sh runs all of them"
    exit
fi
say "lints"
"$CARGO" clippy --all-targets -- -D warnings
# as users build it, where nothing is for tests alone: with its window, and the command without
"$CARGO" clippy -- -D warnings
"$CARGO" clippy --no-default-features -- -D warnings
# tools and examples are compiled by the lints, and need not be linked; src has no tests of its own
say "tests"
"$CARGO" test --test all
"$CARGO" test --doc
say "documentation"
RUSTDOCFLAGS="${RUSTDOCFLAGS:-} -D warnings" "$CARGO" doc --no-deps
say "all is well"

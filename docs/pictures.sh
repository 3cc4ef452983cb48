#!/usr/bin/env bash
# Draws the pictures of the documentation anew with the command itself.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cargo build --release
mkdir -p docs/pictures
gnomon=${CARGO_TARGET_DIR:-target}/release/gnomon
drawn=$(mktemp -d)
trap 'rm -r "$drawn"' EXIT

# Site, cell in metres (so that a picture stays below 1.5 MB), and the instant of its perspective.
while read -r site cell at; do
    "$gnomon" profile "sites/$site" --cell "$cell" --write png --out "$drawn/$site"
    mv "$drawn/$site/profile.png" "docs/pictures/$site-profile.png"
    "$gnomon" shadow "sites/$site" --view camera --at "$at" --out "sites/$site/picture.png"
done <<'SITES'
headquarters 0.5 2026-09-18T15:00
tower        0.6 2026-09-18T14:00
industry     0.3 2026-09-18T15:00
SITES

ls -l docs/pictures/*.png sites/*/picture.png

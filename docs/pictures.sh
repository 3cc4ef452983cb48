#!/usr/bin/env bash
# Draws the pictures of the documentation again: drawings by the command itself (GNOMON=…, or built here), shrunk for the
# screen with ImageMagick to half the size of the sheet and 256 colours; comparison sheets and the window's
# pictures by two examples.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

shrinker=$(command -v magick || command -v convert) || { echo "docs/pictures.sh: install ImageMagick" >&2; exit 1; }
if [ -z "${GNOMON:-}" ]; then
    cargo build --release
    GNOMON=${CARGO_TARGET_DIR:-target}/release/gnomon
fi
drawn=$(mktemp -d)
trap 'rm -r "$drawn"' EXIT

# From the sheet to a picture of the documentation.
shrink() {
    "$shrinker" "$1" -strip -resize 50% -dither None -colors 256 "PNG8:$2"
}

# PICTURE SITE AT OPTIONS…: one instant, seen by the site's camera.
camera() {
    "$GNOMON" shadow "sites/$2" --view camera --at "$3" --out "$drawn/sheet.png" "${@:4}"
    shrink "$drawn/sheet.png" "$1"
}

# PICTURE SITE: the hours of the site's study.
profile() {
    "$GNOMON" profile "sites/$2" --write png --out "$drawn/profile"
    shrink "$drawn/profile/profile.png" "$1"
}

# PICTURE SITE: a year of shadow on the ground, from sunrise to sunset.
year() {
    "$GNOMON" profile "sites/$2" --from-date 2026-01-01 --to-date 2026-12-31 --from sunrise --to sunset --step 30min \
        --receivers ground --engine cpu --write png --out "$drawn/profile"
    shrink "$drawn/profile/profile.png" "$1"
}

# PICTURE SITE: the outlines of the shadows at the site's study.
outlines() {
    "$GNOMON" profile "sites/$2" --write json --draw outlines --out "$drawn/profile"
    shrink "$drawn/profile/outlines.png" "$1"
}

# PICTURE SITE: the hours of sun on the site's surfaces.
surfaces() {
    "$GNOMON" profile "sites/$2" --receivers surfaces --write png --out "$drawn/profile"
    shrink "$drawn/profile/surfaces.png" "$1"
}

# PICTURE SITE FIRST LAST: when the site's probes lie in the sun, from the first date to the last.
probes() {
    "$GNOMON" probe "sites/$2" --from-date "$3" --to-date "$4" --out "$drawn/sheet.png" --quiet > /dev/null
    shrink "$drawn/sheet.png" "$1"
}

mkdir -p docs/pictures
# Figures 5, 6 and 7 of "Geometry of Real Time Shadows", as docs/techniques.md shows them.
camera sites/industry/picture.png industry 2026-09-18T15:00
camera docs/pictures/industry-volumes.png industry 2026-09-18T15:00 --show volumes
profile docs/pictures/industry-profile.png industry

camera sites/tower/picture.png tower 2026-09-18T14:00
camera docs/pictures/tower-volumes.png tower 2026-09-18T14:00 --show volumes,silhouette
profile docs/pictures/tower-profile.png tower
outlines docs/pictures/tower-outlines.png tower

camera sites/headquarters/picture.png headquarters 2026-09-18T15:00
camera docs/pictures/headquarters-parts.png headquarters/facade-and-concrete.toml 2026-09-18T15:00 --show components
camera docs/pictures/headquarters-components.png headquarters 2026-09-18T15:00 --show components
profile docs/pictures/headquarters-profile.png headquarters
year docs/pictures/headquarters-year.png headquarters
surfaces docs/pictures/headquarters-surfaces.png headquarters
probes docs/pictures/headquarters-probes.png headquarters 2026-01-01 2026-12-31

# A house as IFC, its neighbours as footprints, and a terrain.
camera sites/hillside/picture.png hillside 2026-12-21T12:00
profile docs/pictures/hillside-profile.png hillside

# The comparison sheets after Brabec and Seidel and after Chan's thesis. The milliseconds in some of their
# captions are measured as they are drawn.
cargo run --release --example draw-figures

# The window's pictures, at their own size.
cargo run --release --example draw-window
for picture in docs/pictures/window-*.png; do
    "$shrinker" "$picture" -strip -dither None -colors 256 "PNG8:$drawn/window.png"
    mv "$drawn/window.png" "$picture"
done

ls -l docs/pictures/*.png sites/*/picture.png

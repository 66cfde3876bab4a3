#!/bin/sh
# Makes the PNG sizes of dspace.svg in icons/. Needs rsvg-convert (Debian: librsvg2-bin).
set -e
cd "$(dirname "$0")"
for size in 16 24 32 48 64 128 256 512; do
  rsvg-convert -w $size -h $size dspace.svg -o icons/dspace-$size.png
done

#!/usr/bin/env bash
# Opens the page of `hertzian paper` in headless Chromium and checks that every picture is there and not empty:
#
#     cli/look.sh FOLDER [COUNT]
#
# FOLDER holds index.html; COUNT is the number of pictures there must be (default: as many as there are SVG files). Needs chromium.
set -euo pipefail

folder=$(realpath "$1")
count=${2:-$(find "$folder" -maxdepth 1 -name '*.svg' | wc -l)}
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [[ -z $browser ]]; then
    echo 'no chromium: install the package chromium' >&2
    exit 2
fi

# A copy of the page that says in its title what became of its pictures.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$folder/index.html" "$work/page.html"
cat >> "$work/page.html" <<'SCRIPT'
<script>
addEventListener('load', async () => {
    const faults = [];
    const images = [...document.images];
    for (const image of images) {
        await image.decode().catch(() => {});
        if (!image.naturalWidth) { faults.push(image.alt.slice(0, 40) + ': not shown'); continue; }
        // A picture is empty if it has a single colour.
        const canvas = Object.assign(document.createElement('canvas'), { width: 90, height: 60 });
        const context = canvas.getContext('2d');
        context.drawImage(image, 0, 0, 90, 60);
        const pixels = new Uint32Array(context.getImageData(0, 0, 90, 60).data.buffer);
        if (new Set(pixels).size < 3) faults.push(image.alt.slice(0, 40) + ': empty');
    }
    document.title = 'pictures ' + images.length + '; faults ' + faults.length + ' ' + faults.join(', ');
});
</script>
SCRIPT
title=$(timeout 120 "$browser" --headless --no-sandbox --disable-gpu --virtual-time-budget=60000 \
    --user-data-dir="$work/profile" --dump-dom "file://$work/page.html" 2> "$work/log" |
    grep -o '<title>[^<]*</title>' | head -1) || true
echo "${title:-no title: $(tail -3 "$work/log")}"
[[ $title == "<title>pictures $count; faults 0 </title>" ]]

#!/usr/bin/env bash
# Runs cairn on a sequence and shows what came out. Without an argument it runs on a synthetic desk,
# which it renders once, with what networks would say of it: so planes and objects are seen without
# any network.
# Usage: scripts/demo.sh PROGRAM [SEQUENCE]
set -euo pipefail

program=$1
sequence=${2:-}
scene=build/demo/desk
landmarks=() truth=()
if [ -z "$sequence" ]; then
  sequence=$scene
  landmarks=(--landmarks full --planes recorded --objects recorded)
  truth=(--world "$scene/world.json")
  # Rendered once, and again when the scene or this script has changed.
  if [ ! -e "$scene/.complete" ] ||
    [ -n "$(find src/synthetic "$0" -newer "$scene/.complete")" ]; then
    rm -rf "$scene"
    "$program" synth "$scene" --scene desk --truth poses --perception simulated --seed 0
    touch "$scene/.complete"
  fi
fi

sequence=${sequence%/}
out=runs/demo-$(basename "$sequence")
# Lockstep: everyone sees the same figures.
"$program" run "$sequence" "${landmarks[@]}" --pace lockstep --video --out "$out" --force
echo
if grep -Eq '"groundtruth": *"' "$out/summary.json"; then
  "$program" evaluate "$out" "${truth[@]}"
else
  echo "The sequence brings no ground truth, so nothing is evaluated."
fi
echo
echo "Look into $out: plots/ (path and map from above), map.ply (opens in MeshLab,"
echo "CloudCompare or Blender), video.mp4 and stills of it in strip.jpg (points, and planes and"
echo "objects where there are any), and the figures in summary.json."

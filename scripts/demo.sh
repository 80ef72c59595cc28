#!/usr/bin/env bash
# Runs cairn on a sequence and shows what came out. Without an argument it runs on a synthetic desk,
# which it renders once. Usage: scripts/demo.sh PROGRAM [SEQUENCE]
set -euo pipefail

program=$1
sequence=${2:-}
scene=build/demo/desk
if [ -z "$sequence" ]; then
  sequence=$scene
  # Rendered once, and again when the scene has changed.
  if [ ! -e "$scene/.complete" ] || [ -n "$(find src/synthetic -newer "$scene/.complete")" ]; then
    rm -rf "$scene"
    "$program" synth "$scene" --scene desk --truth poses --seed 0
    touch "$scene/.complete"
  fi
fi

sequence=${sequence%/}
out=runs/demo-$(basename "$sequence")
# Lockstep: everyone sees the same figures.
"$program" run "$sequence" --pace lockstep --video --out "$out" --force
echo
if grep -Eq '"groundtruth": *"' "$out/summary.json"; then
  "$program" evaluate "$out"
else
  echo "The sequence brings no ground truth, so nothing is evaluated."
fi
echo
echo "Look into $out: plots/ (path and map from above), map.ply (opens in MeshLab,"
echo "CloudCompare or Blender), the annotated video, and the figures in summary.json."

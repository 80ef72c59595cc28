#!/usr/bin/env python3
"""Makes another sequence out of one in TUM layout: reversed, thinned out, cut, mirrored, blacked
out, or with a turn on the spot in its middle. Ground truth follows where it can.

    scripts/vary_sequence.py SEQUENCE OUT reverse|every2|every3|mirror|first-half|second-half|
                                          blackout|turn

Needs python3-opencv and python3-yaml.
"""
import math
import pathlib
import sys

import cv2
import numpy as np
import yaml

BLACK_FRAMES = 15
TURN_FRAMES = 60   # there and back again
TURN_DEG = 12


def rows(path):
    return [line.split() for line in path.read_text().splitlines()
            if line.strip() and not line.startswith("#")]


def turned(picture, camera, angle_deg):
    """What a camera sees that turns about its own vertical axis: a homography, no parallax."""
    k = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]])
    a = math.radians(angle_deg)
    r = np.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])
    return cv2.warpPerspective(picture, k @ r @ np.linalg.inv(k), picture.shape[1::-1])


def mirrored_pose(values):
    """x -> -x in the world and in the camera: a mirrored world seen by a mirrored camera."""
    t, x, y, z, qx, qy, qz, qw = map(float, values)
    return [values[0]] + [repr(v) for v in (-x, y, z, qx, -qy, -qz, qw)]


def vary(source, out, kind):
    calibration = yaml.safe_load((source / "calibration.yaml").read_text())
    camera = calibration["color"]
    frames = [(float(t), name) for t, name in rows(source / "rgb.txt")]
    truths = [p for p in source.glob("groundtruth*.txt")]
    truth = {p.name: rows(p) for p in truths}
    middle = len(frames) // 2
    pictures = {}  # number of the frame: a picture that is not the source's
    later = 0      # seconds by which what comes after the middle comes later
    if kind == "reverse":
        last = frames[0][0] + frames[-1][0]
        frames = [(last - t, name) for t, name in reversed(frames)]
        truth = {n: [[repr(last - float(r[0]))] + r[1:] for r in reversed(p)]
                 for n, p in truth.items()}
    elif kind.startswith("every"):
        frames = frames[::int(kind[5:])]
    elif kind == "first-half":
        frames = frames[:middle]
    elif kind == "second-half":
        frames = frames[middle:]
    elif kind == "mirror":
        for i, (_, name) in enumerate(frames):
            pictures[i] = cv2.flip(cv2.imread(str(source / name)), 1)
        camera["cx"] = camera["width"] - 1 - camera["cx"]
        if "distortion" in camera:
            camera["distortion"][3] = -camera["distortion"][3]  # p2
        truth = {n: [mirrored_pose(r) for r in p] for n, p in truth.items()}
    elif kind == "blackout":
        black = np.zeros_like(cv2.imread(str(source / frames[0][1])))
        pictures = {i: black for i in range(middle, middle + BLACK_FRAMES)}
    elif kind == "turn":
        still = cv2.imread(str(source / frames[middle][1]))
        step = frames[middle + 1][0] - frames[middle][0]
        inserted = []
        for i in range(TURN_FRAMES):
            angle = TURN_DEG * math.sin(2 * math.pi * (i + 1) / TURN_FRAMES)
            pictures[middle + 1 + i] = turned(still, camera, angle)
            inserted.append((frames[middle][0] + (i + 1) * step, "rgb/turn%03d.png" % i))
        later = TURN_FRAMES * step
        cut = frames[middle][0] + step / 2
        frames = (frames[:middle + 1] + inserted +
                  [(t + later, name) for t, name in frames[middle + 1:]])
        truth = {n: [[repr(float(r[0]) + (later if float(r[0]) > cut else 0))] + r[1:] for r in p]
                 for n, p in truth.items()}
    else:
        sys.exit(__doc__)

    (out / "rgb").mkdir(parents=True)
    with open(out / "rgb.txt", "w") as file:
        for i, (t, name) in enumerate(frames):
            target = "rgb/%06d%s" % (i, ".png" if i in pictures else pathlib.Path(name).suffix)
            if i in pictures:
                cv2.imwrite(str(out / target), pictures[i], [cv2.IMWRITE_PNG_COMPRESSION, 1])
            else:
                (out / target).symlink_to((source / name).resolve())
            file.write("%.6f %s\n" % (t, target))
    (out / "calibration.yaml").write_text(yaml.safe_dump(calibration))
    for name, poses in truth.items():
        (out / name).write_text("".join(" ".join(r) + "\n" for r in poses))


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    vary(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3])

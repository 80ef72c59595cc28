#!/usr/bin/env python3
"""Compares how corners behave in sequences in TUM layout: how many FAST finds (thresholds 20 and
7), and what share of 1000 ORB features is found again some frames later. Ratios are to the first.

    scripts/compare_orb_behaviour.py SEQUENCE [SEQUENCE...]

A synthetic world is a good stand-in for a camera where all ratios are within 1.5.
Needs python3-opencv.
"""
import argparse
import pathlib
import statistics

import cv2

SAMPLES = 25     # frames of each sequence, evenly spread
LATER = 10       # frames
MOST_BITS = 50   # by which matches may differ


def pictures(folder):
    lines = (folder / "rgb.txt").read_text().splitlines()
    return [folder / line.split()[1] for line in lines if line.strip() and line[0] != "#"]


def corners(picture, threshold):
    detector = cv2.FastFeatureDetector_create(threshold, nonmaxSuppression=True)
    return len(detector.detect(picture))


def survivors(orb, first, second):
    before, after = (orb.detectAndCompute(p, None)[1] for p in (first, second))
    if before is None or after is None:
        return 0.0
    matches = cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True).match(before, after)
    return sum(m.distance < MOST_BITS for m in matches) / len(before)


def measure(folder):
    paths = pictures(folder)
    last = len(paths) - 1 - LATER
    orb = cv2.ORB_create(1000)
    rows = []
    for i in range(SAMPLES):
        at = round(i * last / (SAMPLES - 1))
        first, second = (cv2.imread(str(paths[k]), cv2.IMREAD_GRAYSCALE)
                         for k in (at, at + LATER))
        rows.append((corners(first, 20), corners(first, 7), survivors(orb, first, second)))
    return [statistics.median(column) for column in zip(*rows)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("sequence", nargs="+", type=pathlib.Path)
    folders = parser.parse_args().sequence
    reference = None
    print(f"{'sequence':24}{'FAST 20':>16}{'FAST 7':>16}{'found again':>16}")
    for folder in folders:
        values = measure(folder)
        reference = reference or values
        cells = [f"{value:.{digits}f} ({value / max(base, 1e-9):.2f})"
                 for value, base, digits in zip(values, reference, (0, 0, 2))]
        print(f"{folder.name:24}" + "".join(f"{cell:>16}" for cell in cells))


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Fits the parameters of simulated perception (src/synthetic/perception_noise.h) to what networks
do on a real sequence of a static scene with poses and measured depth, without labels.

    scripts/fit_perception_noise.py [--data ../shared/data/redkitchen] [--models ../shared/models]
                                    [--cache FILE]

Prints a table of what was measured. docs/perception_noise.md says what each figure means, and which
parameters cannot be had this way. Needs python3-opencv, python3-numpy, python3-scipy; about five
minutes on one core, seconds where the networks' outputs are in the cache already."""
import argparse
import os

import cv2
import numpy as np

from perception_noise import depth_fit, detector_fit, interventions, network_outputs, shape_fit


def pose(values):
    x, y, z, qx, qy, qz, qw = values
    T = np.eye(4)
    T[:3, 3] = x, y, z
    T[:3, :3] = [[1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
                 [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
                 [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)]]
    return T


def show(title, table):
    print('\n' + title)
    for key, value in table.items():
        if isinstance(value, (list, tuple)):
            print('  %-36s' % key, ', '.join(
                '(%s)' % ' '.join('%.3g' % x for x in v) if isinstance(v[0], float) else str(v) for v in value))
        else:
            print('  %-36s' % key, '%.4g' % value)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--data', default='../shared/data/redkitchen')
    parser.add_argument('--models', default='../shared/models')
    parser.add_argument('--cache', help='keep the outputs of the networks here')
    options = parser.parse_args()
    cv2.setNumThreads(1)
    frames = network_outputs.outputs(options.data, options.models, options.cache)
    with open(os.path.join(options.models, 'coco.names')) as f:
        coco = [line.strip() for line in f]
    with open(os.path.join(options.models, 'mosaic_ade20k31.names')) as f:
        surfaces = [line.strip() for line in f]
    poses = [pose([float(v) for v in row[1:8]]) for row in network_outputs.listed(options.data, 'groundtruth.txt')]
    depth = [cv2.imread(os.path.join(options.data, row[1]), cv2.IMREAD_UNCHANGED) / 5000.0
             for row in network_outputs.listed(options.data, 'depth.txt')]

    scene = detector_fit.Scene(poses, depth)
    objects = detector_fit.find_objects(frames, scene, coco)
    print('%d frames, %d objects: %s' % (len(frames), len(objects), ', '.join(
        '%s %.2f m' % (o['family'], o['metres']) for o in objects)))
    tracks = {net: detector_fit.follow(frames, scene, coco, objects, net) for net in ('nanodet', 'yolox')}
    slopes = interventions.fit(options.data, options.models, options.cache)
    show('nanodet: smaller, hidden, cut', slopes)
    for net in tracks:
        show(net + ': scores', detector_fit.fit_scores(tracks[net], slopes))
        show(net + ': boxes, cut edges', detector_fit.fit_cut(tracks[net]))
        classes, duplicates = detector_fit.fit_classes(tracks[net], coco)
        show(net + ': classes', classes)
        show(net + ': duplicates', duplicates)
        show(net + ': false alarms', detector_fit.fit_false_alarms(frames, scene, coco, objects, net))
    show('boxes, difference of the two networks', detector_fit.fit_difference(tracks['nanodet'], tracks['yolox']))
    sfm = {row[0]: pose([float(v) for v in row[1:8]])
           for row in network_outputs.listed(options.data, 'groundtruth_sfm.txt')}
    colour = [sfm.get('%.6f' % frame['time']) for frame in frames]
    for net in tracks:
        show(net + ': boxes against ellipsoids', shape_fit.fit(objects, tracks[net], colour))
    for title, table in depth_fit.fit(frames, depth, surfaces):
        show(title, table)


if __name__ == '__main__':
    main()

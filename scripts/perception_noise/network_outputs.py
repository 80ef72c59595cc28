"""What the networks in ../shared/models say about the pictures of a sequence, kept in a cache.

Used by fit_perception_noise.py. Needs OpenCV with dnn and numpy (python3-opencv, python3-numpy).
How each network is fed and read: see README.md beside the networks."""
import os
import pickle

import cv2
import numpy as np

MEAN_RGB = np.array([123.675, 116.28, 103.53], np.float32)
STD_RGB = np.array([58.395, 57.12, 57.375], np.float32)
LOWEST_SCORE = 0.05  # of the boxes that are kept


def normalised(bgr, rgb):
    x = bgr.astype(np.float32)[:, :, ::-1 if rgb else 1]
    order = slice(None) if rgb else slice(None, None, -1)
    x = (x - MEAN_RGB[order]) / STD_RGB[order]
    return np.ascontiguousarray(x.transpose(2, 0, 1)[None], dtype=np.float32)


def cells(size, strides):
    """Column, row and stride of each prediction."""
    rows = []
    for s in strides:
        n = -(-size // s)
        y, x = np.mgrid[0:n, 0:n]
        rows.append(np.stack([x.ravel(), y.ravel(), np.full(n * n, s)], 1))
    return np.concatenate(rows).astype(np.float32)


def suppressed(boxes, scores, iou=0.5):
    """Best class of each box, non-maximum suppression by class; rows x0 y0 x1 y1 class score."""
    cls = scores.argmax(1)
    best = scores[np.arange(len(cls)), cls]
    rows = []
    for c in np.unique(cls[best > LOWEST_SCORE]):
        i = np.where((cls == c) & (best > LOWEST_SCORE))[0]
        xywh = np.concatenate([boxes[i, :2], boxes[i, 2:] - boxes[i, :2]], 1)
        keep = cv2.dnn.NMSBoxes(xywh.tolist(), best[i].tolist(), LOWEST_SCORE, iou)
        for k in np.array(keep).ravel():
            rows.append([*boxes[i[k]], c, best[i[k]]])
    return np.array(rows, np.float32).reshape(-1, 6)


def clipped(rows, width, height):
    rows[:, [0, 2]] = rows[:, [0, 2]].clip(-0.5, width - 0.5)
    rows[:, [1, 3]] = rows[:, [1, 3]].clip(-0.5, height - 0.5)
    return rows


class NanoDet:
    def __init__(self, folder):
        self.net = cv2.dnn.readNetFromONNX(os.path.join(folder, 'nanodet_plus_m_416.onnx'))
        self.cells = cells(416, (8, 16, 32, 64))

    def __call__(self, bgr):
        self.net.setInput(normalised(cv2.resize(bgr, (416, 416)), False))
        y = self.net.forward()[0]
        bins = y[:, 80:].reshape(-1, 4, 8)
        bins = np.exp(bins - bins.max(2, keepdims=True))
        distance = bins / bins.sum(2, keepdims=True) @ np.arange(8, dtype=np.float32)
        distance *= self.cells[:, 2:]
        centre = self.cells[:, :2] * self.cells[:, 2:]
        boxes = np.concatenate([centre - distance[:, :2], centre + distance[:, 2:]], 1)
        boxes *= np.tile([bgr.shape[1] / 416, bgr.shape[0] / 416], 2)
        return clipped(suppressed(boxes, y[:, :80]), bgr.shape[1], bgr.shape[0])


class YoloX:
    def __init__(self, folder):
        self.net = cv2.dnn.readNetFromONNX(os.path.join(folder, 'yolox_nano_416.onnx'))
        self.cells = cells(416, (8, 16, 32))

    def __call__(self, bgr):
        k = min(416 / bgr.shape[1], 416 / bgr.shape[0])
        w, h = int(bgr.shape[1] * k), int(bgr.shape[0] * k)
        canvas = np.full((416, 416, 3), 114, np.uint8)
        canvas[:h, :w] = cv2.resize(bgr, (w, h))
        self.net.setInput(normalised(canvas, True))
        y = self.net.forward()[0]
        centre = (y[:, :2] + self.cells[:, :2]) * self.cells[:, 2:]
        half = np.exp(y[:, 2:4]) * self.cells[:, 2:] / 2
        boxes = np.concatenate([centre - half, centre + half], 1) / k
        return clipped(suppressed(boxes, y[:, 4:5] * y[:, 5:]), bgr.shape[1], bgr.shape[0])


class Meter:
    def __init__(self, folder):
        self.net = cv2.dnn.readNetFromONNX(os.path.join(folder, 'meter_xxs_nyu_192x256.onnx'))

    def __call__(self, bgr):
        """Metres, 48 x 64."""
        self.net.setInput(normalised(cv2.resize(bgr, (256, 192), interpolation=cv2.INTER_AREA), True))
        return self.net.forward()[0, 0] / 100


class Mosaic:
    def __init__(self, folder):
        self.net = cv2.dnn.readNetFromONNX(os.path.join(folder, 'mosaic_ade20k31_512.onnx'))

    def __call__(self, bgr):
        """Class of each pixel of the picture."""
        self.net.setInput(cv2.dnn.blobFromImage(bgr, 1 / 127.5, (512, 512), (127.5,) * 3, True))
        logits = self.net.forward()[0]
        size = (bgr.shape[1], bgr.shape[0])
        return np.stack([cv2.resize(c, size) for c in logits]).argmax(0).astype(np.uint8)


def listed(folder, name):
    with open(os.path.join(folder, name)) as lines:
        return [line.split() for line in lines if line.strip() and line[0] != '#']


def outputs(sequence, models, cache):
    """A list, one entry a frame: time, nanodet, yolox (rows x0 y0 x1 y1 class score), depth (every
    second frame), labels and picture (pairs of neighbours, ten a second pair)."""
    if cache and os.path.exists(cache):
        with open(cache, 'rb') as f:
            return pickle.load(f)
    nanodet, yolox, meter, mosaic = NanoDet(models), YoloX(models), Meter(models), Mosaic(models)
    frames = []
    for i, (time, name) in enumerate(listed(sequence, 'rgb.txt')):
        bgr = cv2.imread(os.path.join(sequence, name))
        frame = {'time': float(time), 'nanodet': nanodet(bgr), 'yolox': yolox(bgr)}
        if i % 2 == 0:
            frame['depth'] = meter(bgr)
        if i % 25 in (0, 1):
            frame['labels'] = mosaic(bgr)
            frame['grey'] = cv2.cvtColor(bgr, cv2.COLOR_BGR2GRAY)
        frames.append(frame)
    if cache:
        with open(cache, 'wb') as f:
            pickle.dump(frames, f)
    return frames

#pragma once

#include <string>

#include "cairn/perception/detections.h"

namespace cairn {

/// A line of perception.jsonl, without the line's end: {"timestamp": s, "objects": [{"box":
/// [x0,y0,x1,y1], "class": "cup", "score": 0.91, "mask": RLE?, "thing": id?}], "planes": [{"plane":
/// [a,b,c,d], "label": "table", "score": 0.8, "sigma_angle": rad?, "sigma_depth": share?, "mask":
/// RLE?, "truth": id?}], "sigma_scale": s?, "depth": {"size": [rows, columns], "millimetres": [row
/// by row]}?}. RLE as COCO's (mask_rle.h). Boxes have three decimals, scores five; depth is made
/// coarse, 40 x 30.
std::string to_json_line(const DetectedFrame& frame);

/// Reads such a line. Throws Error(kInput) with a sentence that begins with `where` ("file, line
/// 3") if it is not in the format, or has numbers that are not finite, scores outside of 0 to 1,
/// boxes without area, planes without a normal, sigmas that are not positive. Keys that it does not
/// know are passed over.
DetectedFrame parse_json_line(const std::string& line, const std::string& where);

}  // namespace cairn

#include "cairn/synthetic/perception_noise.h"

namespace cairn {

PerceptionNoise PerceptionNoise::none() {
  PerceptionNoise noise;
  PerceptionNoise::Scores& scores = noise.scores;
  scores.threshold = 0;
  scores.at_usual_size = 1000;  // its logistic is 1
  scores.per_log_size = scores.per_hidden = scores.truncated = 0;
  scores.per_thing = scores.lasting = scores.seconds = scores.flicker = 0;
  noise.boxes = {.lasting = 0,
                 .seconds = 0,
                 .flicker = 0,
                 .floor_px = 0,
                 .tail_share = 0,
                 .tail_factor = 1,
                 .cut_factor = 1,
                 .per_score = 0,
                 .amodal_share = 0};
  noise.classes.wrong = 0;
  noise.duplicates.share = 0;
  noise.false_alarms.per_picture = 0;
  noise.depth = {.scale = 1,
                 .scale_spread = 0,
                 .scale_seconds = 0,
                 .sharp = 1,
                 .blur = 0,
                 .smear = 0,
                 .local = 0,
                 .local_length = 0.2,
                 .local_seconds = 0};
  noise.normals.angle_deg = 0;
  noise.masks.ragged = 0;
  noise.planes = {.angle_deg = 0,
                  .offset = 0,
                  .seconds = 0,
                  .missed = 0,
                  .min_share = 0,
                  .wrong_label = 0,
                  .label_seconds = 0};
  return noise;
}

}  // namespace cairn

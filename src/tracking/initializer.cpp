#include "cairn/tracking/initializer.h"

#include <algorithm>

namespace cairn {
namespace {

constexpr int kMaxDistance = 60;  // Hamming
constexpr double kRatio = 0.9;
constexpr int kMaxOctave = 2;  // coarse keypoints are too uncertain to start from

}  // namespace

Initializer::Initializer(const View& view, const InitializerOptions& options, std::uint64_t seed)
    : view_(view), options_(options), seed_(seed) {}

void Initializer::start(std::shared_ptr<const Frame> frame,
                        std::shared_ptr<const Picture> picture) {
  reference_ = std::move(frame);
  picture_ = std::move(picture);
  followed_.clear();
  for (const Keypoint& kp : reference_->features.keypoints) followed_.emplace_back(kp.x, kp.y);
}

// Matches each keypoint of the reference near to where it was seen last. Returns the number.
int Initializer::follow(const Frame& frame) {
  match_.assign(reference_->size(), -1);
  std::vector<int> owner(frame.size(), -1), owner_distance(frame.size(), 257);
  for (std::size_t i = 0; i < reference_->size(); ++i) {
    const int octave = reference_->octave(i);
    if (octave > kMaxOctave) continue;
    BestMatch best;
    frame.for_each_near(followed_[i], static_cast<float>(options_.search_radius), octave, octave,
                        [&](std::uint32_t j) {
                          best.offer(j, hamming(reference_->features.descriptors[i],
                                                frame.features.descriptors[j]));
                        });
    if (!best.accepted(kMaxDistance, kRatio) || best.distance >= owner_distance[best.index])
      continue;
    if (owner[best.index] >= 0) match_[owner[best.index]] = -1;
    owner[best.index] = static_cast<int>(i);
    owner_distance[best.index] = best.distance;
    match_[i] = static_cast<int>(best.index);
  }
  RotationHistogram rotation;
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (match_[i] < 0) continue;
    rotation.add(reference_->features.keypoints[i].angle,
                 frame.features.keypoints[match_[i]].angle);
  }
  rotation.choose();
  int count = 0;
  for (std::size_t i = 0; i < match_.size(); ++i) {
    if (match_[i] < 0) continue;
    if (!rotation.consistent(reference_->features.keypoints[i].angle,
                             frame.features.keypoints[match_[i]].angle)) {
      match_[i] = -1;
      continue;
    }
    followed_[i] = frame.pixel(match_[i]).cast<float>();
    ++count;
  }
  return count;
}

std::optional<InitialPair> Initializer::add(std::shared_ptr<const Frame> frame,
                                            std::shared_ptr<const Picture> picture) {
  if (static_cast<int>(frame->size()) < options_.min_matches) {
    refusal_ = "the picture shows only " + std::to_string(frame->size()) +
               " keypoints; it may be dark, blurred or without texture";
    reference_.reset();
    return std::nullopt;
  }
  if (!reference_ || frame->timestamp - reference_->timestamp > options_.max_wait) {
    start(std::move(frame), std::move(picture));
    return std::nullopt;
  }
  const int matches = follow(*frame);
  if (matches < options_.min_matches) {
    refusal_ =
        "only " + std::to_string(matches) + " keypoints were found again in the next pictures";
    start(std::move(frame), std::move(picture));
    return std::nullopt;
  }
  std::vector<Eigen::Vector2d> pixels1, pixels2;
  std::vector<std::uint32_t> keypoints1;
  for (std::uint32_t i = 0; i < match_.size(); ++i) {
    if (match_[i] < 0) continue;
    keypoints1.push_back(i);
    pixels1.push_back(reference_->pixel(i));
    pixels2.push_back(frame->pixel(match_[i]));
  }
  TwoViewOptions two_view;
  two_view.min_parallax_deg = options_.min_parallax_deg;
  two_view.min_points = options_.min_points;
  const TwoViewResult result = reconstruct_two_views(pixels1, pixels2, view_.pinhole(), two_view,
                                                     seed_ + 1000 * ++attempts_);
  if (!result.usable) {
    refusal_ = result.refusal;
    return std::nullopt;
  }
  InitialPair pair{reference_, frame, result.T_21, {}, picture_, std::move(picture)};
  for (std::size_t k = 0; k < keypoints1.size(); ++k) {
    if (!result.triangulated[k]) continue;
    pair.points.push_back(
        {keypoints1[k], static_cast<std::uint32_t>(match_[keypoints1[k]]), result.points[k]});
  }
  refusal_.clear();
  return pair;
}

}  // namespace cairn

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cairn/geometry/two_view.h"
#include "cairn/map/initial_pair.h"

namespace cairn {

struct InitializerOptions {
  int min_matches = 100;          ///< between the two pictures
  int min_points = 60;            ///< triangulated
  double min_parallax_deg = 0.9;  ///< median angle between the two rays to a point
  double search_radius = 100;     ///< pixels that a keypoint may move from frame to frame
  double max_wait = 2.0;          ///< seconds that a first picture waits for its partner
};

/// Finds the pair of frames that a monocular map starts from: a reference is kept, its keypoints
/// are followed from frame to frame, until two-view geometry explains their motion well.
class Initializer {
 public:
  Initializer(const View& view, const InitializerOptions& options, std::uint64_t seed);

  /// The pair, once there is one; until then `refusal()` says why not. `picture`: of the frame,
  /// kept for those who look at the pair.
  std::optional<InitialPair> add(std::shared_ptr<const Frame> frame,
                                 std::shared_ptr<const Picture> picture = {});
  const std::string& refusal() const { return refusal_; }
  void reset() {
    reference_.reset();
    picture_.reset();
  }

 private:
  void start(std::shared_ptr<const Frame> frame, std::shared_ptr<const Picture> picture);
  int follow(const Frame& frame);

  View view_;
  InitializerOptions options_;
  std::uint64_t seed_;
  std::uint64_t attempts_ = 0;
  std::shared_ptr<const Frame> reference_;
  std::shared_ptr<const Picture> picture_;  // of the reference
  std::vector<Eigen::Vector2f> followed_;   // where each reference keypoint was seen last
  std::vector<int> match_;                  // keypoint of the current frame, or -1
  std::string refusal_ = "no picture was seen";
};

}  // namespace cairn

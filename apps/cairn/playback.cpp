#include "playback.h"

#include "cairn/geometry/error.h"
#include "cairn/system/pace.h"
#include "interrupt.h"

namespace cairn::app {
namespace {

constexpr std::size_t kProblemsKept = 5;

}  // namespace

Playback play(FrameSource& source, Slam& slam, Pace pace, const FrameListener& listener) {
  Playback playback;
  // A live camera sets its own pace; waiting for the successor would only make its frames old.
  const bool paced = pace == Pace::kRealtime && !source.live();
  RealtimePacer pacer;
  SourceFrame frame, successor;
  bool more = source.next(frame);
  while (more && !interrupted()) {
    ++playback.frames;
    const bool has_successor = paced && source.next(successor);
    const auto next = has_successor && successor.problem.empty()
                          ? std::optional(successor.timestamp)
                          : std::nullopt;
    FrameResult result;
    if (!frame.problem.empty()) {
      ++playback.skipped;
      if (playback.problems.size() < kProblemsKept) {
        playback.problems.push_back(frame.problem);
      }
      slam.skip(frame.timestamp);
      result.record = slam.frames().back();
    } else if (paced && pacer.wait_for(frame.timestamp, next) == RealtimePacer::Verdict::kDrop) {
      ++playback.dropped;
      slam.drop(frame.timestamp);
      result.record = slam.frames().back();
      frame.image.release();
    } else {
      if (!frame.depth_problem.empty() && ++playback.without_depth == 1) {
        playback.depth_problem = frame.depth_problem;
      }
      result = slam.process(frame.image, frame.timestamp, frame.depth);
    }
    listener(frame.image, result);
    if (paced) {
      more = has_successor;
      std::swap(frame, successor);
    } else {
      more = source.next(frame);
    }
  }
  playback.interrupted = interrupted();
  return playback;
}

const Camera& camera_of(const Sequence& sequence, const std::string& what) {
  if (!sequence.camera) {
    throw Error(Error::Kind::kUsage,
                what +
                    ": nothing here says how the camera is calibrated; give --camera fx,fy,cx,cy "
                    "in pixels or --calibration FILE");
  }
  return *sequence.camera;
}

}  // namespace cairn::app

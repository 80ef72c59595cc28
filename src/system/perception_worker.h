#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "cairn/mapping/keyframe_perception.h"
#include "cairn/perception/plane_detector.h"

namespace cairn {

/// Looks at the pictures of keyframes: at once, within the call (lockstep), or on a thread of its
/// own (realtime), where a picture that comes while another still waits takes its place: no one
/// waits, and the newest is looked at. What was passed over is kept for `catch_up`. `look_now` and
/// those who ask for `planes_now` or `objects_now` wait.
class PerceptionWorker {
 public:
  /// `deliver` is called with each result, in realtime from the worker's thread, or from the
  /// caller's where the same frame has been looked at within a call already.
  PerceptionWorker(std::unique_ptr<PlaneDetector> detector, const Camera& camera, const View& view,
                   bool threaded, std::function<void(KeyframePerception)> deliver);
  ~PerceptionWorker();

  void look(std::shared_ptr<const Frame> frame, const PerceptionInput& input);
  /// Looks within the call; false, and nothing seen, while another picture is looked at. If `look`
  /// is asked for the same frame afterwards, this is what it delivers.
  bool look_now(std::shared_ptr<const Frame> frame, const PerceptionInput& input);
  /// The planes of a frame, found by `look_now`; one look serves all who ask.
  std::vector<SeenPlane> planes_now(std::shared_ptr<const Frame> frame,
                                    const PerceptionInput& input);
  /// Likewise its objects.
  std::vector<SeenObject> objects_now(std::shared_ptr<const Frame> frame,
                                      const PerceptionInput& input);
  /// What was found within the last call since it was last asked, with its masks.
  DetectedFrame take_found() { return std::exchange(found_, {}); }
  /// Waits for what is being looked at; only `catch_up` delivers afterwards.
  void stop();
  /// Once stopped: looks, within the call, at pictures that were passed over and whose frames are
  /// still wanted, in order of time. (Whenever they are 100 MB, every other one goes.)
  /// `go_on(done, all)` is asked before each; false leaves the rest.
  void catch_up(const std::function<bool(const Frame&)>& wanted,
                const std::function<bool(std::size_t, std::size_t)>& go_on);

 private:
  struct Task {
    std::shared_ptr<const Frame> frame;
    PerceptionInput input;
  };
  void loop();
  // With the mutex held.
  void pass_over(Task task);
  // With the detector's mutex held, once threaded; what it says goes to `detected`.
  KeyframePerception see(const Task& task, DetectedFrame& detected);

  std::unique_ptr<PlaneDetector> detector_;
  Camera camera_;
  View view_;
  std::function<void(KeyframePerception)> deliver_;
  std::mutex detector_mutex_;
  std::optional<KeyframePerception> seen_now_;  // of the calling thread
  DetectedFrame found_;                         // of the calling thread

  std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  std::optional<Task> waiting_;
  std::vector<Task> passed_over_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace cairn

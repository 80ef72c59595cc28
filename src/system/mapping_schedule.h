#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "cairn/mapping/mapper.h"
#include "cairn/system/options.h"
#include "cairn/tracking/relocalizer.h"

namespace cairn {

/// Runs the mapper: at once, within the call (lockstep), or on a thread of its own (realtime). The
/// tracker's side of it never waits in realtime. One code: the same steps in the same order.
class MappingSchedule {
 public:
  MappingSchedule(std::unique_ptr<Mapper> mapper, const Options& options);
  ~MappingSchedule();

  struct Sighting {
    std::vector<PointId> visible, found;
  };

  /// A new keyframe, with what was seen since the last one.
  void insert(KeyframeCandidate candidate, Sighting sighting);
  /// What perception says of a keyframe that was handed over before; once stopped within the call.
  void join(KeyframePerception perception);
  /// All is said of the newest keyframe. In lockstep the map is adjusted now, in realtime it is
  /// when there is time.
  void settle();
  /// Where is this lost frame? The answer comes by `take_relocalization`. `objects`: what it shows,
  /// for where points do not tell; empty if nobody has looked.
  void relocalize(std::shared_ptr<const Frame> frame, std::uint64_t seed,
                  std::vector<SeenObject> objects = {});
  struct Answer {
    std::shared_ptr<const Frame> frame;
    std::optional<Relocalization> found;
  };
  std::optional<Answer> take_relocalization();
  bool relocalizing() const;

  /// Keyframes that wait, and one more while the mapper is busy.
  int backlog() const;
  std::shared_ptr<const MapView> view() const;

  /// Waits until all is done; the mapper is then the caller's.
  Mapper& stop();

 private:
  struct Insertion {
    KeyframeCandidate candidate;
    Sighting sighting;
    double timestamp() const { return candidate.frame->timestamp; }
  };
  struct Question {
    std::shared_ptr<const Frame> frame;
    std::uint64_t seed;
    std::vector<SeenObject> objects;
  };

  void loop();
  void run_insertion(const Insertion& insertion);
  void run_question(const Question& question);
  void publish();

  std::unique_ptr<Mapper> mapper_;
  TrackingOptions tracking_;

  mutable std::mutex mutex_;  // guards what follows; held for moments only
  std::condition_variable wake_;
  std::deque<Insertion> insertions_;
  std::deque<KeyframePerception> perceptions_;
  std::optional<Question> question_;
  std::optional<Answer> answer_;
  std::shared_ptr<const MapView> view_;
  bool busy_ = false;
  bool stopping_ = false;
  std::atomic<bool> abort_{false};  // somebody waits: leave the local adjustment
  std::thread thread_;
};

}  // namespace cairn

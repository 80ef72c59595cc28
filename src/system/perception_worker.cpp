#include "cairn/system/perception_worker.h"

#include "cairn/map/stopwatch.h"

namespace cairn {

PerceptionWorker::PerceptionWorker(std::unique_ptr<PlaneDetector> detector, const Camera& camera,
                                   const View& view, bool threaded,
                                   std::function<void(KeyframePerception)> deliver)
    : detector_(std::move(detector)), camera_(camera), view_(view), deliver_(std::move(deliver)) {
  if (threaded) thread_ = std::thread([this] { loop(); });
}

PerceptionWorker::~PerceptionWorker() { stop(); }

void PerceptionWorker::look(std::shared_ptr<const Frame> frame, const PerceptionInput& input) {
  if (seen_now_ && seen_now_->frame == frame) {
    deliver_(*std::exchange(seen_now_, std::nullopt));
    return;
  }
  if (!thread_.joinable()) {
    deliver_(see({std::move(frame), input}, found_));
    return;
  }
  {
    // The caller may write its next picture into the same memory.
    Task task{std::move(frame), {input.bgr.clone(), input.depth.clone(), input.timestamp}};
    const std::lock_guard lock(mutex_);
    waiting_ = std::move(task);
  }
  wake_.notify_one();
}

std::vector<SeenPlane> PerceptionWorker::planes_now(std::shared_ptr<const Frame> frame,
                                                    const PerceptionInput& input) {
  if (!see_now(std::move(frame), input)) return {};
  return seen_now_->planes;
}

std::vector<SeenObject> PerceptionWorker::objects_now(std::shared_ptr<const Frame> frame,
                                                      const PerceptionInput& input) {
  if (!see_now(std::move(frame), input)) return {};
  return seen_now_->objects;
}

bool PerceptionWorker::see_now(std::shared_ptr<const Frame> frame, const PerceptionInput& input) {
  if (seen_now_ && seen_now_->frame == frame) return true;
  const std::unique_lock busy(detector_mutex_, std::try_to_lock);
  if (!busy) return false;
  seen_now_ = see({std::move(frame), input}, found_);
  return true;
}

void PerceptionWorker::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

KeyframePerception PerceptionWorker::see(const Task& task, DetectedFrame& detected) {
  const Stopwatch watch;
  detected = detector_->detect(task.input);
  KeyframePerception seen = summarize_perception(detected, task.frame, camera_, view_);
  seen.milliseconds = watch.milliseconds();
  return seen;
}

void PerceptionWorker::loop() {
  while (true) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stopping_ || waiting_.has_value(); });
      if (stopping_) return;
      task = *std::exchange(waiting_, std::nullopt);
    }
    KeyframePerception seen = [&] {
      const std::lock_guard busy(detector_mutex_);
      DetectedFrame detected;  // of a picture that is gone
      return see(task, detected);
    }();
    deliver_(std::move(seen));
  }
}

}  // namespace cairn

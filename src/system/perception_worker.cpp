#include "cairn/system/perception_worker.h"

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
  const std::unique_lock busy(detector_mutex_, std::try_to_lock);
  if (!busy) return {};
  seen_now_ = see({std::move(frame), input}, found_);
  return seen_now_->planes;
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

KeyframePerception PerceptionWorker::see(const Task& task, std::vector<DetectedPlane>& planes) {
  DetectedFrame detected = detector_->detect(task.input);
  KeyframePerception seen = summarize_perception(detected, task.frame, camera_, view_);
  planes = std::move(detected.planes);
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
      std::vector<DetectedPlane> planes;  // of a picture that is gone
      return see(task, planes);
    }();
    deliver_(std::move(seen));
  }
}

}  // namespace cairn

#include "cairn/system/perception_worker.h"

#include <utility>

namespace cairn {

PerceptionWorker::PerceptionWorker(std::unique_ptr<PlaneDetector> detector, const Camera& camera,
                                   const View& view, bool threaded,
                                   std::function<void(KeyframePerception)> deliver)
    : detector_(std::move(detector)), camera_(camera), view_(view), deliver_(std::move(deliver)) {
  if (threaded) thread_ = std::thread([this] { loop(); });
}

PerceptionWorker::~PerceptionWorker() { stop(); }

void PerceptionWorker::look(std::shared_ptr<const Frame> frame, const PerceptionInput& input) {
  if (!thread_.joinable()) {
    run({std::move(frame), input});
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

void PerceptionWorker::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void PerceptionWorker::run(const Task& task) {
  deliver_(summarize_perception(detector_->detect(task.input), task.frame, camera_, view_));
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
    run(task);
  }
}

}  // namespace cairn

#include "cairn/system/perception_worker.h"

#include <cstddef>

#include "cairn/map/stopwatch.h"

namespace cairn {
namespace {

constexpr std::size_t kMostPassedOver = 100'000'000;  // bytes of pictures

std::size_t bytes_of(const cv::Mat& picture) { return picture.total() * picture.elemSize(); }

}  // namespace

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
    if (waiting_) pass_over(std::move(*waiting_));
    waiting_ = std::move(task);
  }
  wake_.notify_one();
}

std::vector<SeenPlane> PerceptionWorker::planes_now(std::shared_ptr<const Frame> frame,
                                                    const PerceptionInput& input) {
  if (!look_now(std::move(frame), input)) return {};
  return seen_now_->planes;
}

std::vector<SeenObject> PerceptionWorker::objects_now(std::shared_ptr<const Frame> frame,
                                                      const PerceptionInput& input) {
  if (!look_now(std::move(frame), input)) return {};
  return seen_now_->objects;
}

bool PerceptionWorker::look_now(std::shared_ptr<const Frame> frame, const PerceptionInput& input) {
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
  if (waiting_) pass_over(*std::exchange(waiting_, std::nullopt));
}

void PerceptionWorker::pass_over(Task task) {
  const std::size_t each = bytes_of(task.input.bgr) + bytes_of(task.input.depth);
  passed_over_.push_back(std::move(task));
  if (passed_over_.size() * each <= kMostPassedOver) return;
  std::size_t index = 0;
  std::erase_if(passed_over_, [&](const Task&) { return index++ % 2 == 1; });
}

void PerceptionWorker::catch_up(const std::function<bool(const Frame&)>& wanted,
                                const std::function<bool(std::size_t, std::size_t)>& go_on) {
  std::vector<Task> tasks = std::exchange(passed_over_, {});
  std::erase_if(tasks, [&](const Task& task) { return !wanted(*task.frame); });
  for (std::size_t i = 0; i < tasks.size() && go_on(i, tasks.size()); ++i) {
    DetectedFrame detected;
    deliver_(see(std::exchange(tasks[i], {}), detected));
  }
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

#include "cairn/datasets/prefetching_source.h"

#include <utility>

namespace cairn {

PrefetchingSource::PrefetchingSource(std::unique_ptr<FrameSource> source)
    : source_(std::move(source)), size_(source_->size()), worker_([this] { work(); }) {}

PrefetchingSource::~PrefetchingSource() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

bool PrefetchingSource::next(SourceFrame& frame) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return slot_ != Slot::kEmpty; });
    if (slot_ == Slot::kEnd) {
      if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
      return false;
    }
    frame = std::move(ahead_);
    ahead_ = {};
    slot_ = Slot::kEmpty;
  }
  changed_.notify_all();
  return true;
}

void PrefetchingSource::work() {
  for (;;) {
    SourceFrame frame;
    bool more = false;
    std::exception_ptr failure;
    try {
      more = source_->next(frame);
    } catch (...) {
      failure = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stop_ || slot_ == Slot::kEmpty; });
    if (stop_) return;
    slot_ = more ? Slot::kFull : Slot::kEnd;
    ahead_ = std::move(frame);
    failure_ = failure;
    lock.unlock();
    changed_.notify_all();
    if (!more) return;
  }
}

}  // namespace cairn

#pragma once

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "cairn/datasets/frame_source.h"

namespace cairn {

/// Reads one frame ahead in a thread of its own, so that decoding does not delay tracking. Frames
/// and their order are those of the source within.
class PrefetchingSource : public FrameSource {
 public:
  explicit PrefetchingSource(std::unique_ptr<FrameSource> source);
  ~PrefetchingSource() override;

  /// An exception of the source within comes out here, in its place.
  bool next(SourceFrame& frame) override;
  std::optional<std::size_t> size() const override { return size_; }

 private:
  enum class Slot { kEmpty, kFull, kEnd };
  void work();

  std::unique_ptr<FrameSource> source_;
  std::optional<std::size_t> size_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Slot slot_ = Slot::kEmpty;
  SourceFrame ahead_;
  std::exception_ptr failure_;
  bool stop_ = false;
  std::thread worker_;
};

}  // namespace cairn

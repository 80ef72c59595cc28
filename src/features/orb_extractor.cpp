#include "cairn/features/orb_extractor.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "cairn/features/corner_distribution.h"
#include "cairn/features/fast_detector.h"
#include "cairn/features/gaussian_blur.h"
#include "cairn/features/image_pyramid.h"
#include "cairn/features/orb_descriptor.h"
#include "cairn/features/subpixel.h"

namespace cairn {
namespace {

constexpr int kMargin = kOrbPatchMargin;
constexpr int kBandRows = 64;       // of a level, detected and blurred by one task
constexpr int kKeypointGrain = 32;  // keypoints described by one task

/// A band of rows of one level. Its slot in the buffers is its own, so tasks need no locks and the
/// order of corners is that of the picture.
struct Band {
  int level = 0, first_row = 0, last_row = 0;
  std::vector<FastCorner> corners;
};

}  // namespace

struct OrbExtractor::Buffers {
  ImagePyramid pyramid;
  std::vector<cv::Mat> blurred;
  std::vector<Band> bands;
  std::size_t band_count = 0;
  struct Level {
    std::vector<FastCorner> corners, chosen;
    CornerDistribution distribution;
    int wanted = 0;
    std::size_t first = 0;  ///< of its keypoints among all
  };
  std::vector<Level> levels;
  struct Worker {
    FastDetector detector;
    GaussianBlur7 blur;
  };
  tbb::enumerable_thread_specific<Worker> workers;

  void prepare(const cv::Mat& grey, const OrbOptions& options);
  void process(Band& band, const OrbOptions& options);
  void detect(const OrbOptions& options);
  void choose(const OrbOptions& options);
  void describe(const OrbOptions& options, Features& features);
  void describe_one(int level, const FastCorner& corner, bool subpixel, Keypoint& keypoint,
                    Descriptor& descriptor) const;
};

void OrbExtractor::Buffers::prepare(const cv::Mat& grey, const OrbOptions& options) {
  pyramid.reset(grey, options.levels, options.scale);
  blurred.resize(options.levels);
  levels.resize(options.levels);
  band_count = 0;
  for (int level = 0; level < options.levels; ++level) {
    const cv::Mat& image = pyramid[level];
    if (std::min(image.cols, image.rows) <= 2 * kMargin) continue;
    blurred[level].create(image.size(), CV_8UC1);
    for (int row = 0; row < image.rows; row += kBandRows) {
      if (band_count == bands.size()) bands.emplace_back();
      Band& band = bands[band_count++];
      band.level = level;
      band.first_row = row;
      band.last_row = std::min(row + kBandRows, image.rows);
      band.corners.clear();
    }
  }
}

void OrbExtractor::Buffers::process(Band& band, const OrbOptions& options) {
  Worker& worker = workers.local();
  const cv::Mat& image = pyramid[band.level];
  const int first = std::max(band.first_row, kMargin);
  const int last = std::min(band.last_row, image.rows - kMargin);
  if (first < last) {
    worker.detector.detect(image, first, last, kMargin,
                           std::min(options.weak_threshold, options.threshold), band.corners);
  }
  worker.blur.blur(image, band.first_row, band.last_row, blurred[band.level]);
}

void OrbExtractor::Buffers::detect(const OrbOptions& options) {
  // Levels come one from the other, but a level's bands can start while the next one is made.
  tbb::task_group tasks;
  std::size_t next = 0;
  for (int level = 0; level < options.levels; ++level) {
    if (level > 0) pyramid.compute(level);
    for (; next < band_count && bands[next].level == level; ++next) {
      Band& band = bands[next];
      tasks.run([this, &band, &options] { process(band, options); });
    }
  }
  tasks.wait();
}

void OrbExtractor::Buffers::choose(const OrbOptions& options) {
  for (Level& level : levels) level.corners.clear();
  for (std::size_t i = 0; i < band_count; ++i) {
    auto& corners = levels[bands[i].level].corners;
    corners.insert(corners.end(), bands[i].corners.begin(), bands[i].corners.end());
  }
  // Level l gets a share in proportion to scale^-l. What a level cannot give, the finer ones may.
  double share = 0, shares = 0;
  for (int l = 0; l < options.levels; ++l) shares += std::pow(options.scale, -l);
  int left = options.count;
  for (int l = options.levels - 1; l >= 0; --l) {
    share = std::pow(options.scale, -l);
    const auto even = static_cast<int>(std::lround(left * share / shares));
    levels[l].wanted = std::min(even, static_cast<int>(levels[l].corners.size()));
    left -= levels[l].wanted;
    shares -= share;
  }
  tbb::parallel_for(0, options.levels, [&](int l) {
    const cv::Mat& image = pyramid[l];
    const CornerDistribution::Region region = {kMargin, kMargin, image.cols - kMargin,
                                               image.rows - kMargin};
    Level& level = levels[l];
    level.distribution.choose(level.corners, region, level.wanted, options.threshold, level.chosen);
  });
}

void OrbExtractor::Buffers::describe_one(int level, const FastCorner& corner, bool subpixel,
                                         Keypoint& keypoint, Descriptor& descriptor) const {
  const cv::Mat& image = pyramid[level];
  const std::uint8_t* const center = image.ptr(corner.y) + corner.x;
  const auto step = static_cast<std::ptrdiff_t>(image.step);
  const Orientation orientation = intensity_centroid(center, step);
  cv::Point2f point(corner.x, corner.y);
  if (subpixel) point += peak_offset(fast_contrast_3x3(center, step));
  const cv::Point2f base = pyramid.to_base(point, level);
  keypoint = {base.x, base.y, angle_of(orientation), static_cast<std::uint8_t>(corner.score),
              static_cast<std::int8_t>(level)};
  descriptor = cairn::describe(blurred[level].ptr(corner.y) + corner.x,
                               static_cast<std::ptrdiff_t>(blurred[level].step), orientation);
}

void OrbExtractor::Buffers::describe(const OrbOptions& options, Features& features) {
  std::size_t count = 0;
  for (Level& level : levels) {
    level.first = count;
    count += level.chosen.size();
  }
  features.keypoints.resize(count);
  features.descriptors.resize(count);
  const tbb::blocked_range<std::size_t> range(0, count, kKeypointGrain);
  tbb::parallel_for(range, [&](const tbb::blocked_range<std::size_t>& part) {
    std::size_t level = levels.size() - 1;
    while (levels[level].first > part.begin()) --level;
    for (std::size_t i = part.begin(); i < part.end(); ++i) {
      while (i - levels[level].first >= levels[level].chosen.size()) ++level;
      describe_one(static_cast<int>(level), levels[level].chosen[i - levels[level].first],
                   options.subpixel, features.keypoints[i], features.descriptors[i]);
    }
  });
}

OrbExtractor::OrbExtractor(const OrbOptions& options)
    : options_(options), buffers_(std::make_unique<Buffers>()) {}
OrbExtractor::~OrbExtractor() = default;

const ImagePyramid& OrbExtractor::pyramid() const { return buffers_->pyramid; }

void OrbExtractor::extract(const cv::Mat& grey, Features& features) {
  assert(grey.type() == CV_8UC1);
  buffers_->prepare(grey, options_);
  if (buffers_->band_count == 0) {
    features.keypoints.clear();
    features.descriptors.clear();
    return;
  }
  buffers_->detect(options_);
  buffers_->choose(options_);
  buffers_->describe(options_, features);
}

}  // namespace cairn

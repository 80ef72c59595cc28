// ORB extraction of cairn beside that of OpenCV on the same pictures, in turns, so that both see
// the same load of the machine. The counter `ratio` is cairn's median time over cv::ORB's on one
// thread. Pictures: CAIRN_DATA or shared/data beside the checkout, else random shapes.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cairn/features/matching.h"
#include "cairn/features/orb_extractor.h"
#include "cairn/features/retrieval.h"

namespace cairn {
namespace {

constexpr std::size_t kPictures = 40;

std::vector<cv::Mat> shapes() {
  std::vector<cv::Mat> pictures;
  cv::RNG rng(1);
  for (int i = 0; i < 5; ++i) {
    cv::Mat picture(480, 640, CV_8UC1, cv::Scalar(128));
    for (int shape = 0; shape < 600; ++shape) {
      const cv::Point corner(rng.uniform(0, 640), rng.uniform(0, 480));
      const cv::Size size(rng.uniform(4, 60), rng.uniform(4, 60));
      cv::rectangle(picture, cv::Rect(corner, size), cv::Scalar(rng.uniform(0, 255)), cv::FILLED);
    }
    pictures.push_back(picture);
  }
  return pictures;
}

std::vector<cv::Mat> load(const std::string& sequence) {
  const char* const given = std::getenv("CAIRN_DATA");
  const std::filesystem::path data = given != nullptr ? given : CAIRN_SOURCE_DIR "/../shared/data";
  const auto folder = data / sequence / "rgb";
  if (!std::filesystem::is_directory(folder)) return shapes();
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  std::vector<cv::Mat> pictures;
  for (std::size_t i = 0; i < kPictures; ++i) {
    pictures.push_back(cv::imread(files[i * files.size() / kPictures], cv::IMREAD_GRAYSCALE));
  }
  return pictures;
}

template <class Function>
double milliseconds(Function&& function) {
  const auto start = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

void extract_orb(benchmark::State& state, const std::string& sequence) {
  const auto pictures = load(sequence);
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(state.range(0)));
  cv::setNumThreads(1);
  OrbExtractor extractor({});
  Features features;
  const auto orb = cv::ORB::create(1000);
  std::vector<double> ours(pictures.size(), 1e9), theirs(pictures.size(), 1e9);
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % pictures.size();
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    theirs[k] =
        std::min(theirs[k], milliseconds([&] {
                   orb->detectAndCompute(pictures[k], cv::noArray(), keypoints, descriptors);
                 }));
    const double once = milliseconds([&] { extractor.extract(pictures[k], features); });
    ours[k] = std::min(ours[k], once);
    state.SetIterationTime(once / 1000);
  }
  state.counters["cairn_ms"] = median(ours);
  state.counters["opencv_ms"] = median(theirs);
  state.counters["ratio"] = median(ours) / median(theirs);
}

void match(benchmark::State& state) {
  const auto pictures = load("redkitchen");
  OrbExtractor extractor({});
  Features first, second;
  extractor.extract(pictures[0], first);
  extractor.extract(pictures[1], second);
  for (auto _ : state) benchmark::DoNotOptimize(match_mutual(first, second));
}

void query(benchmark::State& state) {
  const auto pictures = load("redkitchen");
  OrbExtractor extractor({});
  Features features;
  std::vector<Features> seen(500);
  std::vector<const Features*> known;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    extractor.extract(pictures[i % pictures.size()], seen[i]);
    known.push_back(&seen[i]);
  }
  for (auto _ : state) benchmark::DoNotOptimize(rank_by_appearance(seen.back(), known, 10));
}

BENCHMARK_CAPTURE(extract_orb, redkitchen, "redkitchen")
    ->Arg(1)
    ->Arg(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(800);
BENCHMARK_CAPTURE(extract_orb, tum_fr1_xyz, "tum_fr1_xyz")
    ->Arg(1)
    ->Arg(2)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->Iterations(800);
BENCHMARK(match)->Unit(benchmark::kMillisecond);
BENCHMARK(query)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace cairn

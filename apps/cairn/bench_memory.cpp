#include "bench_memory.h"

#include <malloc.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cairn/datasets/sequence.h"
#include "interrupt.h"
#include "playback.h"
#include "table_name.h"

namespace cairn::app {
namespace {

constexpr int kStillFrames = 600;
constexpr double kNoise = 3;  // grey levels: no two pictures of a camera are the same

double allocated_bytes() {
  const auto info = mallinfo2();
  return double(info.uordblks) + double(info.hblkhd);
}

struct Memory {
  std::string sequence;
  std::size_t keyframes = 0;       // at the end
  double start_bytes = 0;          // held when the map had just been initialised
  double end_bytes = 0;            // held at the end
  double still_bytes_a_frame = 0;  // while the last picture is shown over and over

  double bytes_a_keyframe() const {
    return keyframes > 2 ? (end_bytes - start_bytes) / double(keyframes - 2) : 0;
  }
};

// Runs until `enough` and says what the system holds by then: what is freed when it goes.
template <class Enough, class AtEnd>
double held_bytes(const std::string& data, std::uint64_t seed, Enough&& enough, AtEnd&& at_end) {
  Sequence sequence = open_sequence(data);
  Options options;
  options.pace = Pace::kLockstep;
  options.seed = seed;
  auto slam = std::make_unique<Slam>(camera_of(sequence, data), options);
  SourceFrame frame, last;
  while (!interrupted() && !enough(*slam) && sequence.frames->next(frame)) {
    if (!frame.problem.empty()) continue;
    slam->process(frame.image, frame.timestamp);
    std::swap(last, frame);
  }
  sequence.frames.reset();  // so that nothing else comes and goes
  at_end(*slam, last);
  const double before = allocated_bytes();
  slam.reset();
  return before - allocated_bytes();
}

Memory measure(const std::string& data, std::uint64_t seed) {
  Memory memory;
  memory.sequence = data;
  const auto initialised = [](const Slam& slam) { return slam.snapshot() != nullptr; };
  memory.start_bytes = held_bytes(data, seed, initialised, [](Slam&, const SourceFrame&) {});
  const auto keep_on = [](const Slam&) { return false; };
  memory.end_bytes = held_bytes(data, seed, keep_on, [&](Slam& slam, const SourceFrame&) {
    if (const auto view = slam.snapshot()) memory.keyframes = view->map_keyframes;
  });
  held_bytes(data, seed, keep_on, [&](Slam& slam, const SourceFrame& last) {
    // A first second of standing still is still news; growth is counted after it.
    cv::RNG random(seed);
    cv::Mat noise, picture;
    const auto stand = [&](int from, int to) {
      for (int i = from; i < to && !interrupted() && !last.image.empty(); ++i) {
        noise.create(last.image.size(), CV_16SC(last.image.channels()));
        random.fill(noise, cv::RNG::NORMAL, 0, kNoise);
        cv::add(last.image, noise, picture, cv::noArray(), CV_8U);
        slam.process(picture, last.timestamp + i / 30.0);
      }
    };
    stand(1, 60);
    const double before = allocated_bytes();
    stand(60, 60 + kStillFrames);
    memory.still_bytes_a_frame = (allocated_bytes() - before) / kStillFrames;
  });
  return memory;
}

}  // namespace

int bench_memory(const std::vector<std::string>& data, int seeds, bool json) {
  nlohmann::json rows = nlohmann::json::array();
  if (!json) {
    std::printf("memory that the system holds; standing still: the last picture over and over\n\n");
    std::printf("%-24s %5s %10s %12s %12s %14s %20s\n", "sequence", "seed", "keyframes",
                "start, MB", "end, MB", "kB a keyframe", "still, kB a frame");
  }
  for (const std::string& sequence : data) {
    for (int seed = 0; seed < seeds && !interrupted(); ++seed) {
      const Memory m = measure(sequence, std::uint64_t(seed));
      rows.push_back({{"sequence", m.sequence},
                      {"seed", seed},
                      {"keyframes", m.keyframes},
                      {"start_bytes", m.start_bytes},
                      {"end_bytes", m.end_bytes},
                      {"bytes_a_keyframe", m.bytes_a_keyframe()},
                      {"still_bytes_a_frame", m.still_bytes_a_frame}});
      if (json) continue;
      std::printf("%-24s %5d %10zu %12.2f %12.2f %14.1f %20.3f\n", table_name(m.sequence).c_str(),
                  seed, m.keyframes, m.start_bytes / 1e6, m.end_bytes / 1e6,
                  m.bytes_a_keyframe() / 1e3, m.still_bytes_a_frame / 1e3);
      std::fflush(stdout);
    }
  }
  if (json) {
    std::printf("%s\n", nlohmann::json{{"subject", "memory"}, {"rows", rows}}.dump(2).c_str());
  }
  return interrupted() ? kInterrupted : kDone;
}

}  // namespace cairn::app

#include "cairn/system/pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace cairn {
namespace {

class FakeClock : public Clock {
 public:
  double now() const override { return time; }
  void sleep_until(double until) override {
    EXPECT_GE(until, time);
    time = until;
  }
  double time = 100;
};

using Verdict = RealtimePacer::Verdict;

// Plays `count` frames at 10 Hz where each processed frame takes `work` seconds; returns verdicts.
std::vector<Verdict> play(FakeClock& clock, int count, double work) {
  RealtimePacer pacer(clock);
  std::vector<Verdict> verdicts;
  for (int i = 0; i < count; ++i) {
    const auto next = i + 1 < count ? std::optional(5 + 0.1 * (i + 1)) : std::nullopt;
    verdicts.push_back(pacer.wait_for(5 + 0.1 * i, next));
    if (verdicts.back() == Verdict::kProcess) clock.time += work;
  }
  return verdicts;
}

TEST(RealtimePacer, WaitsUntilAFrameIsDue) {
  FakeClock clock;
  for (const Verdict verdict : play(clock, 11, 0.01)) EXPECT_EQ(verdict, Verdict::kProcess);
  EXPECT_NEAR(clock.time, 101.01, 1e-9);
}

TEST(RealtimePacer, AFrameLateByLessThanAPeriodIsProcessed) {
  FakeClock clock;
  // The first frame takes 1.9 periods: the second is late by 0.9.
  RealtimePacer pacer(clock);
  EXPECT_EQ(pacer.wait_for(0.0, 0.1), Verdict::kProcess);
  clock.time += 0.19;
  EXPECT_EQ(pacer.wait_for(0.1, 0.2), Verdict::kProcess);
}

TEST(RealtimePacer, DropsWhatIsLateToKeepUp) {
  FakeClock clock;
  const auto verdicts = play(clock, 100, 0.2);  // half as fast as needed
  const auto dropped = std::count(verdicts.begin(), verdicts.end(), Verdict::kDrop);
  EXPECT_GE(dropped, 45);
  EXPECT_LE(dropped, 52);
  EXPECT_EQ(verdicts.front(), Verdict::kProcess);
  EXPECT_EQ(verdicts.back(), Verdict::kProcess);  // nothing comes after it
  EXPECT_LT(clock.time, 100 + 9.9 + 0.6);         // it ends when the recording ends
}

TEST(RealtimePacer, KeepsALateFrameThatHasNoSuccessorYet) {
  FakeClock clock;
  RealtimePacer pacer(clock);
  pacer.wait_for(0.0, 0.1);
  clock.time += 5;
  EXPECT_EQ(pacer.wait_for(0.1, std::nullopt), Verdict::kProcess);
  EXPECT_EQ(pacer.wait_for(0.2, 9.0), Verdict::kProcess);  // the successor is not due
  EXPECT_EQ(pacer.wait_for(0.3, 0.4), Verdict::kDrop);
}

TEST(RealtimePacer, DoesNotWaitThroughAHoleInTheRecording) {
  FakeClock clock;
  RealtimePacer pacer(clock);
  pacer.wait_for(0.0, 0.1);
  EXPECT_EQ(pacer.wait_for(3600.0, 3600.1), Verdict::kProcess);
  EXPECT_LE(clock.time, 103);
  EXPECT_EQ(pacer.wait_for(3600.1, 3600.2), Verdict::kProcess);
  EXPECT_LE(clock.time, 103);
}

}  // namespace
}  // namespace cairn

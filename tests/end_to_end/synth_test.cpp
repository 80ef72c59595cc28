#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

// Small pictures: what counts here are files.
constexpr const char* kSmall = " --width 160 --height 120 --samples 1 --no-progress";

class Synth : public testing::Test {
 protected:
  Ran synth(const std::string& arguments, const std::string& wrapper = "") {
    return run_cairn("synth " + out() + kSmall + " " + arguments, wrapper);
  }
  std::string out() const { return folder_ / "sequence"; }
  bool has(const std::string& name) const { return fs::exists(out() + "/" + name); }
  std::vector<nlohmann::json> lines(const std::string& name) const {
    std::vector<nlohmann::json> result;
    std::ifstream file(out() + "/" + name);
    for (std::string line; std::getline(file, line);) result.push_back(nlohmann::json::parse(line));
    return result;
  }
  void expect_nothing_that_looks_complete() const {
    for (const char* name : {"rgb.txt", "world.json", "truth.jsonl", "groundtruth.txt"}) {
      EXPECT_FALSE(has(name)) << name;
    }
  }
  TemporaryFolder folder_;
};

TEST_F(Synth, WritesPicturesWithTheirWholeTruth) {
  const Ran ran = synth("--scene desk --frames 2 --seed 1");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  for (const char* name : {"rgb.txt", "groundtruth.txt", "calibration.yaml", "world.json"}) {
    EXPECT_TRUE(has(name)) << name;
  }
  for (const char* folder : {"rgb", "depth", "normals", "labels", "instances"}) {
    const fs::directory_iterator files(out() + "/" + folder);
    EXPECT_EQ(std::distance(begin(files), end(files)), 2) << folder;
  }
  const auto truth = lines("truth.jsonl"), detected = lines("perception.jsonl");
  ASSERT_EQ(truth.size(), 2U);
  ASSERT_EQ(detected.size(), 2U);
  EXPECT_EQ(truth[1]["timestamp"], detected[1]["timestamp"]);
  EXPECT_FALSE(detected[0]["objects"].empty());
  const auto table = lines("world.json").at(0)["objects"][0];
  EXPECT_EQ(table["visible_frames"], 2);
  EXPECT_GT(table["visible_span_deg"], 0) << "seen from two places";
  EXPECT_LT(table["visible_span_deg"], 5);
}

TEST_F(Synth, ExactPerceptionIsTheTruth) {
  const Ran ran = synth("--scene desk --frames 1 --perception exact");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  std::map<int, nlohmann::json> seen;
  const auto truth_lines = lines("truth.jsonl");
  for (const auto& object : truth_lines.at(0)["objects"]) seen[object["id"]] = object;
  const auto detected = lines("perception.jsonl").at(0)["objects"];
  ASSERT_FALSE(detected.empty());
  for (const auto& object : detected) {
    const auto& truth = seen.at(object["thing"]);
    EXPECT_EQ(object["class"], truth["class"]);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(double(object["box"][i]), double(truth["box"][i]), 1e-2);
    }
  }
}

TEST_F(Synth, PerceptionNeedsNoPicturesOfTheTruth) {
  ASSERT_EQ(synth("--scene desk --frames 2 --seed 1").exit_code, 0);
  const auto beside_truth = lines("perception.jsonl");
  fs::remove_all(out());
  ASSERT_EQ(synth("--scene desk --frames 2 --seed 1 --truth poses").exit_code, 0);
  EXPECT_FALSE(has("perception.jsonl"));
  fs::remove_all(out());
  const Ran ran = synth("--scene desk --frames 2 --seed 1 --truth poses --perception simulated");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_EQ(lines("perception.jsonl"), beside_truth);
  EXPECT_FALSE(has("truth.jsonl"));
  EXPECT_FALSE(has("depth"));
}

TEST_F(Synth, RefusesWhatItCannotDoInOneSentence) {
  EXPECT_EQ(synth("--frames 0").exit_code, 2);
  const Ran attic = synth("--scene attic");
  EXPECT_EQ(attic.exit_code, 2);
  EXPECT_THAT(attic.output, HasSubstr("attic"));
  EXPECT_FALSE(fs::exists(out())) << "nothing is written for an order that cannot be carried out";
}

TEST_F(Synth, OnAFullDiskLeavesNothingThatLooksComplete) {
  // Files end at 2 blocks of 512 bytes.
  const Ran ran = synth("--frames 3", "sh -c 'trap \"\" XFSZ; ulimit -f 2; exec \"$@\"' --");
  EXPECT_EQ(ran.exit_code, 4) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("disk full"));
  expect_nothing_that_looks_complete();
}

TEST_F(Synth, InterruptedLeavesNothingThatLooksComplete) {
  const Ran ran = synth("--frames 100000", "timeout --signal=INT --preserve-status 12");
  EXPECT_EQ(ran.exit_code, 130) << ran.output;
  expect_nothing_that_looks_complete();
}

}  // namespace
}  // namespace cairn

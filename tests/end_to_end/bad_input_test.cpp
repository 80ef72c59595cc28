// What goes wrong with files: each case ends in one clear sentence and the right exit code. A bad
// frame in the middle costs that frame alone.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "program.h"
#include "quick_scene/quick_sequence.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr int kFrames = 12;
constexpr int kBad = 6;  // the frame that is spoilt, well after the map's beginning

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// What the program said about an error or a skipped frame.
std::vector<std::string> complaints(const Ran& ran) {
  std::vector<std::string> found;
  for (const std::string& line : lines_of(ran.output)) {
    if (line.starts_with("cairn: ") && line.find("no networks") == std::string::npos)
      found.push_back(line);
  }
  return found;
}

MATCHER_P2(EndsWithOneSentence, exit_code, part, "") {
  *result_listener << "code " << arg.exit_code << ":\n" << arg.output;
  const auto said = complaints(arg);
  return arg.exit_code == exit_code && said.size() == 1 && said[0].find(part) != std::string::npos;
}

class BadInput : public testing::Test {
 protected:
  struct Line {
    std::string timestamp, file;
  };

  void SetUp() override {
    write_quick_sequence(sequence(), kFrames);
    std::ifstream stream(sequence() + "/rgb.txt");
    for (std::string text; std::getline(stream, text);) {
      if (text.starts_with('#')) continue;
      const std::size_t space = text.find(' ');
      list_.push_back({text.substr(0, space), text.substr(space + 1)});
    }
    ASSERT_THAT(list_, SizeIs(kFrames));
  }

  std::string sequence() const { return folder_ / "sequence"; }
  std::string out() const { return folder_ / "out"; }
  std::string picture(int frame) const { return sequence() + "/" + list_[frame].file; }

  void write_list() const {
    std::ofstream stream(sequence() + "/rgb.txt");
    for (const Line& line : list_) stream << line.timestamp << ' ' << line.file << '\n';
  }
  Ran run(const std::string& arguments = "--pace lockstep", const std::string& wrapper = "") const {
    return run_cairn("run " + sequence() + " --out " + out() + " " + arguments, wrapper);
  }
  std::vector<std::string> names_in_out() const {
    std::vector<std::string> names;
    if (!fs::exists(out())) return names;
    for (const auto& entry : fs::recursive_directory_iterator(out()))
      names.push_back(entry.path().filename().string());
    return names;
  }

  // The run makes its map of the other frames, says once what was wrong, and counts it.
  void expect_one_skipped(const std::string& why) const {
    EXPECT_THAT(run(), EndsWithOneSentence(0, why));
    std::ifstream stream(out() + "/summary.json");
    const auto summary = nlohmann::json::parse(stream);
    EXPECT_EQ(summary["frames"], kFrames);
    EXPECT_EQ(summary["states"]["skipped"], 1);
    EXPECT_GT(summary["tracked"], kFrames / 2);
    EXPECT_THAT(summary["problems"].get<std::vector<std::string>>(), ElementsAre(HasSubstr(why)));
  }

  TemporaryFolder folder_;
  std::vector<Line> list_;
};

TEST_F(BadInput, AMissingPictureIsSkipped) {
  list_[kBad].file = "rgb/gone.png";
  write_list();
  expect_one_skipped(sequence() + "/rgb/gone.png: the file is missing");
}

TEST_F(BadInput, ATruncatedJpegIsSkipped) {
  list_[kBad].file = "rgb/cut.jpg";
  write_list();
  cv::imwrite(picture(kBad), cv::imread(picture(kBad - 1)));
  fs::resize_file(picture(kBad), fs::file_size(picture(kBad)) / 2);
  expect_one_skipped("cut.jpg: the picture is cut off");
}

TEST_F(BadInput, APictureOfAnotherSizeIsSkipped) {
  cv::Mat smaller;
  cv::resize(cv::imread(picture(kBad)), smaller, {320, 240});
  cv::imwrite(picture(kBad), smaller);
  expect_one_skipped("the picture is 320x240, but the first one is 640x480");
}

TEST_F(BadInput, ATimestampThatRepeatsIsSkipped) {
  list_[kBad].timestamp = list_[kBad - 1].timestamp;
  write_list();
  expect_one_skipped("repeats that of the frame before");
}

TEST_F(BadInput, ATimestampThatGoesBackIsSkipped) {
  list_[kBad].timestamp = "3.25";
  write_list();
  expect_one_skipped("its timestamp 3.250000 s goes back behind");
}

TEST_F(BadInput, ATimestampFarAheadIsSkippedAndTheFramesBehindItAreNot) {
  list_[kBad].timestamp = "999999";
  write_list();
  expect_one_skipped("its timestamp 999999.000000 s is ahead of those that follow it");
}

TEST_F(BadInput, ATimestampThatIsNoNumberIsSkipped) {
  list_[kBad].timestamp = "nan";
  write_list();
  expect_one_skipped("rgb.txt, line " + std::to_string(kBad + 1) + ": \"nan\" is not a timestamp");
}

TEST_F(BadInput, AllTimestampsBadMakeNoMapAndNoCrash) {
  for (Line& line : list_) line.timestamp = "nan";
  write_list();
  EXPECT_THAT(run(), EndsWithOneSentence(3, "not one of the 12 pictures can be read"));
}

TEST_F(BadInput, ACalibrationFileWithANegativeFocalLengthIsRefused) {
  const std::string file = folder_ / "lens.yaml";
  std::ofstream(file) << "{fx: -525, fy: 525, cx: 320, cy: 240, width: 640, height: 480}\n";
  EXPECT_THAT(run("--calibration " + file),
              EndsWithOneSentence(2, file + ": calibration: the focal length must be positive"));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(BadInput, AConfigurationWithAnUnknownKeyIsRefused) {
  const std::string file = folder_ / "settings.yaml";
  std::ofstream(file) << "features:\n  cuont: 800\n";
  const Ran ran = run("--config " + file);
  EXPECT_THAT(ran, EndsWithOneSentence(2, "nearest is features.count"));
  EXPECT_THAT(ran.output, HasSubstr(file));
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(BadInput, AFullDiskIsReportedAndLeavesNothingThatLooksComplete) {
  // A disk of two pages that only this run sees: room for two short files, not for the map.
  const std::string script = folder_ / "on_small_disk.sh";
  std::ofstream(script) << "mkdir -p " << out() << " && mount -t tmpfs -o size=8k none " << out()
                        << " || exit 77\n\"$@\"\ncode=$?\nls -A " << out() << "\nexit $code\n";
  const Ran ran = run("--pace lockstep", "unshare --map-root-user --mount sh " + script);
  if (ran.exit_code == 77 || ran.output.find("unshare:") != std::string::npos) {
    GTEST_SKIP() << "no small disk can be mounted here: " << ran.output;
  }
  EXPECT_THAT(ran, EndsWithOneSentence(4, "No space left on device"));
  EXPECT_THAT(ran.output, HasSubstr("free some space"));
  const auto left = lines_of(ran.output);
  EXPECT_THAT(left, Not(Contains("summary.json"))) << "written last: the mark of a whole run";
  EXPECT_THAT(left, Not(Contains("map.ply")));
  EXPECT_THAT(left, Each(Not(HasSubstr(".tmp-"))));
}

// Stands for a full disk wherever none can be mounted: files end at 8 blocks of 512 bytes.
TEST_F(BadInput, AFileThatMayNotGrowIsReported) {
  const Ran ran = run("--pace lockstep", "trap '' XFSZ; ulimit -f 8;");
  EXPECT_THAT(ran, EndsWithOneSentence(4, "the file cannot be written (File too large)"));
  EXPECT_THAT(names_in_out(), Not(Contains(AnyOf("map.ply", "summary.json", HasSubstr(".tmp-")))));
}

TEST_F(BadInput, AKilledRunLeavesNoFileThatLooksComplete) {
  // Frames so far apart that the end comes between two of them.
  for (int i = 0; i < kFrames; ++i) list_[i].timestamp = std::to_string(1.5 * i);
  write_list();
  const Ran ran = run("--pace realtime --video", "timeout --signal=KILL 1");
  EXPECT_EQ(ran.exit_code, 137) << ran.output;
  EXPECT_THAT(names_in_out(), Each(HasSubstr(".tmp-")));
}

// Killed while it writes, whenever that is: a file with its final name is a whole one.
TEST_F(BadInput, ARunKilledAtAnyMomentLeavesWholeFilesOnly) {
  for (int i = 1; i <= 8; ++i) {
    fs::remove_all(out());
    fs::create_directory(out());
    run("--pace lockstep", "timeout --signal=KILL " + std::to_string(0.15 * i));
    for (const auto& entry : fs::recursive_directory_iterator(out())) {
      if (!entry.is_regular_file()) continue;
      const fs::path& file = entry.path();
      std::ifstream stream(file, std::ios::binary);
      const std::string content{std::istreambuf_iterator<char>(stream), {}};
      if (file.extension() == ".png") {
        EXPECT_FALSE(cv::imread(file.string()).empty()) << file;
      } else if (file.extension() == ".json") {
        EXPECT_TRUE(nlohmann::json::accept(content)) << file;
      } else if (file.extension() == ".txt" || file.extension() == ".csv") {
        EXPECT_THAT(content, AnyOf("", EndsWith("\n"))) << file;
      }
    }
  }
}

}  // namespace
}  // namespace cairn

// cairn evaluate --world, as a person calls it.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"

namespace cairn {
namespace {

using testing::HasSubstr;

// A world with a cup on a table, its true poses, and a run that mapped the cup at half the scale.
class WorldEvaluation : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "run");
    std::ofstream truth(folder_ / "groundtruth.txt"), estimate(folder_ / "run/trajectory.txt");
    for (int i = 0; i < 30; ++i) {
      const double t = 0.1 * i, x = std::cos(t), y = std::sin(t), z = 0.2 * t;
      truth << t << ' ' << x << ' ' << y << ' ' << z << " 0 0 0 1\n";
      estimate << t << ' ' << x / 2 << ' ' << y / 2 << ' ' << z / 2 << " 0 0 0 1\n";
    }
    std::ofstream(folder_ / "world.json") << R"({"format": "cairn world", "version": 1,
      "planes": [{"id": 0, "label": "table", "normal": [0, 0, 1], "d": -0.7,
                  "outline": [[-1, -1, 0.7], [1, -1, 0.7], [1, 1, 0.7], [-1, 1, 0.7]]}],
      "objects": [{"id": 0, "class": "cup", "center": [0, 0, 0.75], "rotation": [0, 0, 0, 1],
                   "semi_axes": [0.05, 0.05, 0.06], "symmetry": "any_turn", "axis": [0, 0, 1],
                   "visible_frames": 30}]})";
    std::ofstream(folder_ / "run/objects.json") << R"({"objects": [{"id": 4, "class": "cup",
      "score": 0.9, "center": [0.01, 0, 0.375], "rotation": [0, 0, 0, 1],
      "semi_axes": [0.025, 0.025, 0.03]}]})";
  }

  // Without --groundtruth: the poses beside the world are taken.
  Ran evaluate(const std::string& options) const {
    return run_cairn("evaluate " + (folder_ / "run") + " --world " + (folder_ / "world.json") +
                     " " + options);
  }

  TemporaryFolder folder_;
};

TEST_F(WorldEvaluation, PrintsWhatScriptsRead) {
  const Ran ran = evaluate("--json");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  const nlohmann::json json = nlohmann::json::parse(ran.output);
  EXPECT_NEAR(json.at("scale").get<double>(), 2, 1e-4);
  EXPECT_EQ(json.at("objects").at("found"), 1);
  EXPECT_EQ(json.at("objects").at("false"), 0);
  EXPECT_NEAR(json.at("objects").at("centre_error").get<double>(), 0.02, 1e-4);
  EXPECT_TRUE(json.at("planes").is_null());
}

TEST_F(WorldEvaluation, UsesTheAlignmentOfTheTrajectory) {
  const Ran ran = evaluate("--json --align none");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_EQ(nlohmann::json::parse(ran.output).at("objects").at("missed"), 1);
}

TEST_F(WorldEvaluation, JudgesOnlyTheFramesThatAnotherRunHasToo) {
  {
    std::ofstream other(folder_ / "other.txt");
    for (int i = 10; i < 22; ++i) other << 0.1 * i << " 0 0 0 0 0 0 1\n";
  }
  const Ran ran = evaluate("--json --common " + (folder_ / "other.txt"));
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  const nlohmann::json json = nlohmann::json::parse(ran.output);
  EXPECT_EQ(json.at("pairs"), 12);
  EXPECT_NEAR(json.at("scale").get<double>(), 2, 1e-4);
}

TEST_F(WorldEvaluation, AUnitThatNobodyCallsAMetreIsNotWrong) {
  const auto scale_error = [&](const std::string& how) {
    std::ofstream(folder_ / "run/summary.json") << R"({"scale": {"how": ")" << how << R"("}})";
    return nlohmann::json::parse(evaluate("--json").output).at("scale_error");
  };
  EXPECT_NEAR(scale_error("predicted depth").get<double>(), 1, 1e-4);
  EXPECT_TRUE(scale_error("none").is_null());
}

TEST_F(WorldEvaluation, PrintsATableForPeople) {
  const Ran ran = evaluate("");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_THAT(ran.output, HasSubstr("ATE RMSE"));
  EXPECT_THAT(ran.output, HasSubstr("1 found of 1"));
  EXPECT_THAT(ran.output, HasSubstr("planes.json is not there"));
}

TEST_F(WorldEvaluation, SaysWhatIsWrongInOneSentence) {
  const auto fails = [&](const std::string& arguments, int exit_code, const std::string& why) {
    const Ran ran = run_cairn("evaluate " + arguments);
    EXPECT_EQ(ran.exit_code, exit_code) << ran.output;
    EXPECT_THAT(ran.output, HasSubstr(why));
  };
  const std::string run = folder_ / "run", world = folder_ / "world.json";
  const std::string truth = " --groundtruth " + (folder_ / "groundtruth.txt");
  fails(run + truth + " --world " + (folder_ / "none.json"), 3, "none.json: cannot be read");
  fails(run + " --world " + world + " --plane-angle 0", 2, "--plane-angle");
  fails(run + truth + " --common " + (folder_ / "none.txt"), 3, "none.txt");
  std::ofstream(folder_ / "other.txt") << "1000 0 0 0 0 0 0 1\n";
  fails(run + truth + " --common " + (folder_ / "other.txt"), 3, "no frame in common");
  fails(run + "/trajectory.txt" + truth + " --world " + world, 2, "--world judges");
  std::ofstream(folder_ / "run/planes.json") << R"({"planes": [{"id": 1, "label": "wall"}]})";
  fails(run + " --world " + world, 3, "planes[0]: \"normal\" is missing");
}

}  // namespace
}  // namespace cairn

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"

namespace cairn {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string content(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// A desk with what networks would say of it, and with measured depth. Rendered once for all tests
// of a process, as that is most of their time: those that take files away come last.
class LandmarksRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const Ran ran =
        run_cairn("synth " + sequence() +
                  " --scene desk --sensor rgbd --frames 60 --samples 1 --no-blur --no-progress");
    ASSERT_EQ(ran.exit_code, 0) << ran.output;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  // Of this test alone.
  static std::string path(const std::string& file) {
    return *folder_ / (testing::UnitTest::GetInstance()->current_test_info()->name() + file);
  }
  static Ran run(const std::string& out, const std::string& arguments) {
    return run_cairn("run " + sequence() + " --pace lockstep --no-progress --out " + path(out) +
                     " " + arguments);
  }
  static nlohmann::json json(const std::string& file) {
    return nlohmann::json::parse(content(path(file)));
  }
  static std::string sequence() { return *folder_ / "desk"; }
  static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(LandmarksRun, PutsTheTableIntoTheMapAndTheMapIntoMetres) {
  const Ran ran = run("a", "--landmarks ppm --planes recorded --threads 1");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("planes"));
  const nlohmann::json planes = json("a/planes.json").at("planes");
  ASSERT_FALSE(planes.empty());
  for (const nlohmann::json& plane : planes) {
    EXPECT_GE(plane.at("outline").size(), 3U);
    EXPECT_GE(plane.at("points").get<int>(), 6);
  }
  const nlohmann::json scale = json("a/summary.json").at("scale");
  EXPECT_EQ(scale.at("how"), "predicted depth");
  EXPECT_GT(scale.at("sigma").get<double>(), 0.01);
  // Two seconds have one or two independent pictures: twice the sigma of their scale.
  const Ran evaluated =
      run_cairn("evaluate " + path("a") + " --json --world " + sequence() + "/world.json");
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.output;
  const nlohmann::json report = nlohmann::json::parse(evaluated.output);
  EXPECT_NEAR(report.at("scale").get<double>(), 1, 0.35);
  EXPECT_LT(report.at("ate").at("rmse").get<double>(), 0.01);
  EXPECT_GE(report.at("planes").at("correct").get<int>(), 1);

  ASSERT_EQ(run("given", "--landmarks points --scale 2.5").exit_code, 0);
  const nlohmann::json given = json("given/summary.json").at("scale");
  EXPECT_EQ(given.at("how"), "given");
  EXPECT_EQ(given.at("value"), 2.5);
  EXPECT_TRUE(given.at("sigma").is_null());

  ASSERT_EQ(run("b", "--landmarks ppm --planes recorded --threads 2").exit_code, 0);
  for (const char* file : {"trajectory.txt", "planes.json", "map.ply"}) {
    EXPECT_EQ(content(path("a/") + file), content(path("b/") + file)) << file;
  }
}

TEST_F(LandmarksRun, PutsTheThingsOfADeskIntoTheMap) {
  const Ran ran = run("a", "--landmarks po --objects recorded");
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output, HasSubstr("  objects "));
  EXPECT_FALSE(std::filesystem::exists(path("a/planes.json")));
  const nlohmann::json objects = json("a/objects.json").at("objects");
  ASSERT_FALSE(objects.empty());
  for (const nlohmann::json& object : objects) {
    EXPECT_GE(object.at("keyframes").size(), 2U);
    EXPECT_TRUE(object.at("support").is_null()) << "there are no planes";
  }
  EXPECT_EQ(json("a/summary.json").at("objects"), objects.size());
  EXPECT_THAT(content(path("a/map.ply")),
              HasSubstr("element face " + std::to_string(192 * objects.size()) + "\n"));
  const Ran evaluated =
      run_cairn("evaluate " + path("a") + " --json --world " + sequence() + "/world.json");
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.output;
  const nlohmann::json report = nlohmann::json::parse(evaluated.output);
  EXPECT_LT(report.at("ate").at("rmse").get<double>(), 0.01);
  ASSERT_GE(report.at("objects").at("found").get<int>(), 1);
  EXPECT_LT(report.at("objects").at("centre_error").get<double>(), 0.1);
}

TEST_F(LandmarksRun, SetsOfLandmarksAreComparedInATable) {
  const Ran ran = run_cairn("bench landmarks --json --data " + sequence());
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  const nlohmann::json rows = nlohmann::json::parse(ran.output).at("rows");
  ASSERT_EQ(rows.size(), 5U);
  for (const nlohmann::json& row : rows) {
    EXPECT_EQ(row.at("ate").size(), 1U);
    EXPECT_EQ(row.at("ate").at(0), row.at("ate_median"));
    EXPECT_LT(row.at("ate_median").get<double>(), 0.01);
    EXPECT_GT(row.at("coverage").get<double>(), 0.9);
    EXPECT_GT(row.at("over_points").get<double>(), 0.1);
    if (row.at("set") == "points") {
      EXPECT_EQ(row.at("over_points"), 1);
    }
    // Whether a few things of a desk give a scale of their own is another matter.
    if (row.at("set") == "po") continue;
    EXPECT_EQ(row.at("scale_error").is_null(), row.at("set") == "points");
  }
  EXPECT_EQ(run_cairn("bench tracking --groundtruth " + sequence()).exit_code, 2);
}

TEST_F(LandmarksRun, TakesItsMetresAndItsPlanesFromMeasuredDepth) {
  const std::string record = " --record-perception " + path("seen.jsonl");
  const Ran ran = run("a", "--landmarks pp --planes rgbd" + record);
  ASSERT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output, Not(HasSubstr("no measured depth")));
  EXPECT_EQ(json("a/summary.json").at("scale").at("how"), "measured depth");
  EXPECT_THAT(content(path("seen.jsonl")), HasSubstr("\"plane\""));
  const Ran evaluated = run_cairn("evaluate " + path("a") + " --json --world " + sequence() +
                                  "/world.json --depth " + sequence());
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.output;
  const nlohmann::json report = nlohmann::json::parse(evaluated.output);
  const nlohmann::json& measured = report.at("measured_planes");
  EXPECT_GE(measured.at("measured").get<int>(), 1);
  EXPECT_LT(measured.at("angle_deg").get<double>(), 2);
  EXPECT_LT(measured.at("offset").get<double>(), 0.02);
  EXPECT_NEAR(report.at("scale").get<double>(), 1, 0.02);
  EXPECT_LT(report.at("ate").at("rmse").get<double>(), 0.01);
  EXPECT_GE(report.at("planes").at("correct").get<int>(), 1);
  EXPECT_LT(report.at("planes").at("angle_deg").get<double>(), 2);

  std::filesystem::remove(sequence() + "/depth/1000.000000.png");
  EXPECT_THAT(run("b", "--planes rgbd").output, HasSubstr("1 frames have no measured depth"));
  std::filesystem::remove(sequence() + "/depth.txt");
  const Ran missing = run("c", "--planes rgbd");
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.output, HasSubstr("depth.txt"));
}

TEST_F(LandmarksRun, SaysWhatIsMissing) {
  std::filesystem::remove(sequence() + "/perception.jsonl");
  EXPECT_THAT(run("a", "--landmarks pp --planes recorded").output, HasSubstr("perception.jsonl"));
  EXPECT_EQ(run("b", "--landmarks pp --planes network --models /no/such/folder").exit_code, 3);
  EXPECT_EQ(run("c", "--landmarks points --planes recorded").exit_code, 2);
  EXPECT_EQ(run("d", "--landmarks pp --planes none").exit_code, 2);
}

}  // namespace
}  // namespace cairn

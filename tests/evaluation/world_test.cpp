#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cairn/evaluation/world_report.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using testing::HasSubstr;

// A unit square in the plane z = height, its middle at (x, y).
std::vector<Vector3d> square(double x, double y, double height, double half = 0.5) {
  return {{x - half, y - half, height},
          {x + half, y - half, height},
          {x + half, y + half, height},
          {x - half, y + half, height}};
}

nlohmann::json json_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::json corners(const Vector3d& centre, const Vector3d& half) {
  nlohmann::json points = nlohmann::json::array();
  for (int i = 0; i < 8; ++i) {
    const Vector3d side(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    points.push_back(json_of(centre + half.cwiseProduct(side)));
  }
  return points;
}

nlohmann::json world_json() {
  nlohmann::json outline = nlohmann::json::array();
  for (const Vector3d& corner : square(0, 0, 0.7)) outline.push_back(json_of(corner));
  return {
      {"format", "cairn world"},
      {"version", 1},
      {"scene", "desk"},
      {"seed", 0},
      {"planes",
       {{{"id", 0}, {"label", "table"}, {"normal", {0, 0, 1}}, {"d", -0.7}, {"outline", outline}}}},
      {"objects",
       {{{"id", 0},
         {"class", "book"},
         {"center", {0, 0.1, 0.75}},
         {"rotation", {0, 0, 0, 1}},
         {"semi_axes", {0.1, 0.2, 0.05}},
         {"symmetry", "half_turn"},
         {"axis", {0, 0, 1}},
         {"visible_frames", 12},
         {"surface_points", corners({0, 0.1, 0.75}, {0.06, 0.12, 0.03})},
         {"supported_by", 0}}}},
      {"parallel", nlohmann::json::array()},
      {"perpendicular", nlohmann::json::array()}};
}

// The front of a house, from x to x + 12, `deep` behind others.
nlohmann::json front(int id, double x, double deep, int visible_frames) {
  nlohmann::json outline = nlohmann::json::array();
  for (const auto& [along, z] : {std::pair{0, 0}, {12, 0}, {12, 9}, {0, 9}}) {
    outline.push_back(json_of({x + along, deep, double(z)}));
  }
  return {{"id", id},  {"label", "building"}, {"normal", {0, -1, 0}},
          {"d", deep}, {"outline", outline},  {"visible_frames", visible_frames}};
}

// A folder that is there as long as the test.
class WorldFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("cairn_world_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  // What evaluate_world complains about.
  std::string complaint() const {
    try {
      evaluate_world(folder_ / "world.json", folder_, {});
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), Error::Kind::kInput);
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

// The run's world is another one: half as large, turned and moved. The alignment takes it back.
TEST_F(WorldFiles, JoinTheFrontsOfARowOfHouses) {
  nlohmann::json world = world_json();
  // One after the other, in any order; one is set back, and one is on the other side of a road.
  world["planes"] = {front(3, 0, 0, 5), front(1, 24, 0, 20), front(2, 12, 0, 7),
                     front(4, 36, 0.1, 9), front(5, 50, 0, 8)};
  const WorldTruth truth = read_world(write("world.json", world.dump()));
  ASSERT_EQ(truth.planes.size(), 3u);
  const auto row = std::find_if(truth.planes.begin(), truth.planes.end(),
                                [](const TruePlane& plane) { return plane.parts.size() == 3; });
  ASSERT_NE(row, truth.planes.end());
  EXPECT_EQ(row->id, 1);
  EXPECT_EQ(row->visible_frames, 20) << "of the front that is seen most";
}

TEST_F(WorldFiles, AreComparedAfterTheAlignmentOfTheTrajectory) {
  const TrajectoryAlignment alignment = {SE3(so3_exp({0.3, -0.5, 1.1}), {1, 2, 3}), 2.0};
  const SE3 back = alignment.T.inverse();
  const auto to_run = [&](const Vector3d& x) { return Vector3d(back * x / alignment.scale); };
  const Eigen::Quaterniond q = back.rotation();
  const Vector3d normal = q * Vector3d(0, 0, 1);
  nlohmann::json outline = nlohmann::json::array();
  for (const Vector3d& corner : square(0.1, 0, 0.7, 0.3))
    outline.push_back(json_of(to_run(corner)));
  const nlohmann::json objects = {{"objects",
                                   {{{"id", 7},
                                     {"class", "book"},
                                     {"score", 0.9},
                                     {"center", json_of(to_run({0, 0.1, 0.78}))},
                                     {"rotation", {q.x(), q.y(), q.z(), q.w()}},
                                     {"semi_axes", {0.05, 0.1, 0.025}}}}}};
  const nlohmann::json planes = {{"planes",
                                  {{{"id", 3},
                                    {"label", "table"},
                                    {"normal", json_of(normal)},
                                    {"d", -normal.dot(to_run({0, 0, 0.7}))},
                                    {"outline", outline}}}}};
  write("objects.json", objects.dump());
  write("planes.json", planes.dump());
  const WorldReport report =
      evaluate_world(write("world.json", world_json().dump()), folder_, alignment);
  ASSERT_TRUE(report.objects && report.planes);
  EXPECT_EQ(report.objects->found, 1u);
  EXPECT_NEAR(*report.objects->centre_error, 0.03, 1e-9);
  EXPECT_NEAR(*report.objects->rotation_deg, 0, 1e-6);
  EXPECT_NEAR(*report.objects->axis_error, 0, 1e-9);
  EXPECT_EQ(report.planes->correct, 1u);
  EXPECT_NEAR(*report.planes->offset, 0, 1e-9);
  EXPECT_TRUE(report.notes.empty());

  const nlohmann::json json = to_json(report);
  for (const char* key : {"found", "missed", "duplicated", "false", "wrong_class", "centre_error",
                          "iou", "outline_iou", "axis_error", "rotation_deg"}) {
    EXPECT_TRUE(json.at("objects").at(key).is_number()) << key;
  }
  for (const char* key : {"precision", "recall", "angle_deg", "offset"}) {
    EXPECT_TRUE(json.at("planes").at(key).is_number()) << key;
  }
  EXPECT_THAT(to_table(report), HasSubstr("1 found of 1"));
}

TEST_F(WorldFiles, MayLackWhatTheRunDidNotWrite) {
  const fs::path world = write("world.json", world_json().dump());
  WorldReport report = evaluate_world(world, folder_, {});
  EXPECT_FALSE(report.objects || report.planes);
  EXPECT_EQ(report.notes.size(), 2u);
  EXPECT_TRUE(to_json(report).at("planes").is_null());
  EXPECT_THAT(to_table(report), HasSubstr("planes.json is not there"));
  write("objects.json", R"({"objects": []})");
  report = evaluate_world(world, folder_, {});
  ASSERT_TRUE(report.objects);
  EXPECT_EQ(report.objects->missed, 1u);
  EXPECT_TRUE(to_json(report).at("objects").at("iou").is_null());
}

TEST_F(WorldFiles, ThatAreBadAreNamedWithTheReason) {
  EXPECT_THAT(complaint(), HasSubstr("world.json: cannot be read"));
  write("world.json", "{");
  EXPECT_THAT(complaint(), HasSubstr("is no JSON object"));
  write("world.json", R"({"format": "cairn world", "version": NaN})");
  EXPECT_THAT(complaint(), HasSubstr("is no JSON object"));
  const auto with = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json world = world_json();
    world[nlohmann::json::json_pointer(pointer)] = value;
    write("world.json", world.dump());
    return complaint();
  };
  const nlohmann::json null;
  EXPECT_THAT(with("/format", "other"), HasSubstr("cairn synth"));
  EXPECT_THAT(with("/version", 2), HasSubstr("only version 1"));
  EXPECT_THAT(with("/objects", null), HasSubstr("world.json: \"objects\" is missing"));
  EXPECT_THAT(with("/objects", 3), HasSubstr("objects: is no list"));
  EXPECT_THAT(with("/objects/0/center", {1, 2}), HasSubstr("objects[0].center: 2 numbers"));
  EXPECT_THAT(with("/objects/0/center/2", NAN),
              HasSubstr("objects[0].center[2]: null is not a finite"));
  EXPECT_THAT(with("/objects/0/class", 5), HasSubstr("objects[0].class: 5 is no text"));
  EXPECT_THAT(with("/objects/0/semi_axes", {0.1, 0, 0.1}), HasSubstr("positive lengths"));
  EXPECT_THAT(with("/objects/0/rotation", {0, 0, 0, 0}), HasSubstr("unit quaternion"));
  EXPECT_THAT(with("/objects/0/symmetry", "most"), HasSubstr("any_turn"));
  EXPECT_THAT(with("/objects/0/visible_frames", 1.5), HasSubstr("no integer"));
  EXPECT_THAT(with("/objects/0/visible_span_deg", "wide"), HasSubstr("visible_span_deg"));
  EXPECT_THAT(with("/planes/0/normal", {0, 0, 2}), HasSubstr("planes[0].normal"));
  EXPECT_THAT(with("/planes/0/outline", {{0, 0, 0}}), HasSubstr("three corners"));
  write("world.json", world_json().dump());
  EXPECT_EQ(complaint(), "");
  write("planes.json", "[1, 2]");
  EXPECT_THAT(complaint(), HasSubstr("planes.json: is no JSON object"));
  write("planes.json", R"({"planes": [{"id": 1}]})");
  EXPECT_THAT(complaint(), HasSubstr("planes.json: planes[0]: \"label\" is missing"));
  write("objects.json", R"({"objects": [{"id": "one"}]})");
  EXPECT_THAT(complaint(),
              HasSubstr("objects.json: objects[0].id: \"one\" is not a finite number"));
}

}  // namespace
}  // namespace cairn

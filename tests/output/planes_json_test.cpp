#include "cairn/output/planes_json.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cairn/evaluation/found_landmarks.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

MappedPlane table() {
  MappedPlane plane;
  plane.id = 7;
  plane.label = "dining \"table\", Tisch für 4";
  plane.normal = Eigen::Vector3d(0.36, -0.48, 0.8);
  plane.d = -1.0 / 3;
  const Eigen::Vector3d foot = -plane.d * plane.normal;
  plane.outline = {foot, foot + Eigen::Vector3d(0.8, 0.6, 0), foot + Eigen::Vector3d(0, 5, 3)};
  plane.sigma_angle = std::numbers::pi / 90;
  plane.points = 120;
  plane.sightings = 9;
  plane.seen = {0.5, 1403636579.763555527};
  plane.parallel = {3};
  plane.perpendicular = {1, 2};
  plane.coplanar = {4};
  return plane;
}

TEST(PlanesJson, IsReadBackAsItWasWritten) {
  TempFolder folder;
  std::vector<MappedPlane> planes = {table(), table()};
  planes[1].id = 8;
  planes[1].normal = -Eigen::Vector3d::UnitY();
  write_planes(folder / "planes.json", planes);
  const std::vector<FoundPlane> found = read_found_planes(folder / "planes.json");
  ASSERT_EQ(found.size(), planes.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].id, planes[i].id);
    EXPECT_EQ(found[i].label, planes[i].label);
    EXPECT_LT((found[i].normal - planes[i].normal).norm(), 1e-12);
    EXPECT_EQ(found[i].d, planes[i].d);
    ASSERT_EQ(found[i].outline.size(), planes[i].outline.size());
    for (std::size_t k = 0; k < found[i].outline.size(); ++k) {
      EXPECT_EQ((found[i].outline[k] - planes[i].outline[k]).norm(), 0);
    }
  }
}

TEST(PlanesJson, SaysHowSureAPlaneIsAndWhatItIsBoundTo) {
  TempFolder folder;
  const std::vector<MappedPlane> planes = {table()};
  write_planes(folder / "planes.json", planes);
  std::ifstream file(folder / "planes.json");
  const nlohmann::json json = nlohmann::json::parse(file).at("planes").at(0);
  EXPECT_NEAR(json.at("sigma_angle_deg").get<double>(), 2, 1e-12);
  EXPECT_EQ(json.at("points").get<int>(), 120);
  EXPECT_EQ(json.at("sightings").get<int>(), 9);
  EXPECT_EQ(json.at("keyframes").get<std::vector<double>>(), planes[0].seen);
  EXPECT_EQ(json.at("parallel").get<std::vector<int>>(), planes[0].parallel);
  EXPECT_EQ(json.at("perpendicular").get<std::vector<int>>(), planes[0].perpendicular);
  EXPECT_EQ(json.at("coplanar").get<std::vector<int>>(), planes[0].coplanar);
}

TEST(PlanesJson, OfAMapWithoutPlanesIsAnEmptyList) {
  TempFolder folder;
  write_planes(folder / "planes.json", {});
  EXPECT_TRUE(read_found_planes(folder / "planes.json").empty());
}

TEST(PlanesJson, NamesTheFileThatCannotBeWritten) {
  TempFolder folder;
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { write_planes(folder / "no/planes.json", {}); }),
              ::testing::HasSubstr("no/planes.json"));
}

}  // namespace
}  // namespace cairn

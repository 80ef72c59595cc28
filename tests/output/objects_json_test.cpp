#include "cairn/output/objects_json.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "cairn/evaluation/found_landmarks.h"
#include "cairn/output/ellipsoid_mesh.h"
#include "cairn/output/ellipsoid_outline.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using Eigen::Vector3d;

MappedObject cup() {
  MappedObject object;
  object.id = 5;
  object.class_name = "cup \"of tea\", Tasse";
  object.score = 0.7;
  object.ellipsoid = {SE3(so3_exp({0.3, -2, 0.8}), {1.0 / 3, -0.2, 2}), {0.04, 1.0 / 30, 0.06}};
  object.in_reference = {SE3(so3_exp({0, 1, 0}), {0.1, 0.2, 1.5}), object.ellipsoid.semi_axes};
  object.reference_time = 1403636579.763555527;
  object.covariance << 4e-4, 1e-5, 0, 1e-5, 1e-4, 2e-5, 0, 2e-5, 9e-4;
  object.points = 31;
  object.sightings = 12;
  object.seen = {0.5, 1403636579.763555527};
  object.plane = 2;
  return object;
}

nlohmann::json written(const std::vector<MappedObject>& objects) {
  TempFolder folder;
  write_objects(folder / "objects.json", objects);
  std::ifstream file(folder / "objects.json");
  return nlohmann::json::parse(file).at("objects");
}

TEST(ObjectsJson, IsReadBackAsItWasWritten) {
  TempFolder folder;
  std::vector<MappedObject> objects = {cup(), cup()};
  objects[1].id = 6;
  objects[1].ellipsoid = {};
  write_objects(folder / "objects.json", objects);
  const std::vector<FoundObject> found = read_found_objects(folder / "objects.json");
  ASSERT_EQ(found.size(), objects.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Ellipsoid &is = found[i].ellipsoid, &was = objects[i].ellipsoid;
    EXPECT_EQ(found[i].id, objects[i].id);
    EXPECT_EQ(found[i].class_name, objects[i].class_name);
    EXPECT_EQ(found[i].score, objects[i].score);
    EXPECT_EQ((is.centre() - was.centre()).norm(), 0);
    EXPECT_EQ((is.semi_axes - was.semi_axes).norm(), 0);
    EXPECT_LT((is.T.matrix3() - was.T.matrix3()).norm(), 1e-12);
  }
}

TEST(ObjectsJson, SaysHowSureAnObjectIsWhoSawItAndWhatItStandsOn) {
  std::vector<MappedObject> objects = {cup(), cup()};
  objects[1].plane = -1;
  const nlohmann::json json = written(objects);
  const nlohmann::json& first = json.at(0);
  EXPECT_EQ(first.at("covariance").at(1).get<std::vector<double>>(),
            (std::vector<double>{1e-5, 1e-4, 2e-5}));
  EXPECT_EQ(first.at("points").get<int>(), 31);
  EXPECT_EQ(first.at("sightings").get<int>(), 12);
  EXPECT_EQ(first.at("keyframes").get<std::vector<double>>(), objects[0].seen);
  EXPECT_EQ(first.at("support").get<int>(), 2);
  EXPECT_TRUE(json.at(1).at("support").is_null());
}

TEST(ObjectsJson, GivesTheObjectInItsReferenceKeyframeToo) {
  const nlohmann::json reference = written({cup()}).at(0).at("reference");
  EXPECT_EQ(reference.at("time").get<double>(), cup().reference_time);
  EXPECT_EQ(reference.at("center").get<std::vector<double>>(),
            (std::vector<double>{0.1, 0.2, 1.5}));
  EXPECT_NEAR(reference.at("rotation").at(1).get<double>(), std::sin(0.5), 1e-12);
  EXPECT_NEAR(reference.at("rotation").at(3).get<double>(), std::cos(0.5), 1e-12);
  EXPECT_EQ(reference.at("semi_axes").at(2).get<double>(), 0.06);
}

TEST(ObjectsJson, OfAMapWithoutObjectsIsAnEmptyList) {
  TempFolder folder;
  write_objects(folder / "objects.json", {});
  EXPECT_TRUE(read_found_objects(folder / "objects.json").empty());
}

TEST(ObjectsJson, NamesTheFileThatCannotBeWritten) {
  TempFolder folder;
  EXPECT_THAT(
      error_of(Error::Kind::kOutput, [&] { write_objects(folder / "no/objects.json", {}); }),
      ::testing::HasSubstr("no/objects.json"));
}

TEST(EllipsoidMesh, IsClosedLooksOutwardAndLiesOnTheEllipsoid) {
  const Ellipsoid ellipsoid = cup().ellipsoid;
  const TriangleMesh mesh = ellipsoid_mesh(ellipsoid);
  EXPECT_EQ(mesh.triangles.size(), 192U);
  for (const Vector3d& x : mesh.vertices) {
    const Vector3d u = (ellipsoid.T.inverse() * x).cwiseQuotient(ellipsoid.semi_axes);
    EXPECT_NEAR(u.norm(), 1, 1e-9);
  }
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int i) {
      return Vector3d(mesh.vertices.at(std::size_t(t[i])) - ellipsoid.centre());
    };
    const double sixfold = corner(0).cross(corner(1)).dot(corner(2));
    EXPECT_GT(sixfold, 0);
    volume += sixfold / 6;
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, times] : edges) {
    EXPECT_EQ(times, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  EXPECT_GT(volume, 0.85 * ellipsoid.volume());
  EXPECT_LT(volume, ellipsoid.volume());
}

TEST(EllipsoidShadow, IsTheEdgeOfWhatTheEllipsoidCovers) {
  const Ellipsoid ellipsoid{SE3(so3_exp({0.4, 0.2, -1}), {1, 2, 3}), {0.5, 0.2, 0.1}};
  const auto shadow = ellipsoid_shadow(ellipsoid, Vector3d::UnitX(), Vector3d::UnitZ());
  ASSERT_GT(shadow.size(), 12U);
  EXPECT_EQ(shadow.front(), shadow.back());
  // The shadow reaches as far as the ellipsoid does, in each direction of the plane.
  const Eigen::Matrix3d A = ellipsoid.T.matrix3() * ellipsoid.semi_axes.asDiagonal();
  for (const double turn : {0.0, 0.7, 1.9, 4.4}) {
    const Vector3d direction(std::cos(turn), 0, std::sin(turn));
    double farthest = -1e9;
    for (const Eigen::Vector2d& p : shadow) {
      farthest = std::max(farthest, direction.x() * p.x() + direction.z() * p.y());
    }
    const double reach = (A.transpose() * direction).norm();
    EXPECT_NEAR(farthest, direction.dot(ellipsoid.centre()) + reach, 0.01 * reach);
  }
}

}  // namespace
}  // namespace cairn

#include "cairn/synthetic/model.h"

#include <gmock/gmock.h>

#include <cstring>
#include <functional>
#include <map>
#include <numbers>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

constexpr int kSeeds = 3;

Eigen::AlignedBox3f bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Mesh::Vertex& v : mesh.vertices) box.extend(v.position);
  return box;
}

// Calls `check` with some models of each class.
void for_every_model(const std::function<void(std::string_view class_name, const Model&)>& check) {
  for (const std::string_view class_name : model_classes()) {
    for (int seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(std::string(class_name) + ", seed " + std::to_string(seed));
      check(class_name, make_model(class_name, std::uint64_t(seed)));
    }
  }
}

TEST(EveryModel, StandsOnTheGroundInTheMiddle) {
  for_every_model([](std::string_view, const Model& model) {
    const Eigen::AlignedBox3f box = bounds(model.mesh);
    EXPECT_NEAR(box.min().z(), 0, 1e-6);
    EXPECT_NEAR(box.center().x(), 0, 2e-6);
    EXPECT_NEAR(box.center().y(), 0, 2e-6);
  });
}

TEST(EveryModel, IsMadeOfFiniteNumbersAndUnitNormals) {
  for_every_model([](std::string_view class_name, const Model& model) {
    EXPECT_EQ(model.class_name, class_name);
    for (const Mesh::Vertex& v : model.mesh.vertices) {
      ASSERT_TRUE(v.position.allFinite() && v.uv.allFinite());
      ASSERT_NEAR(v.normal.norm(), 1, 1e-4);
    }
    for (const Mesh::Triangle& t : model.mesh.triangles) {
      ASSERT_LT(std::max({t.a, t.b, t.c}), model.mesh.vertices.size());
      ASSERT_LT(t.material, model.mesh.materials.size());
    }
  });
}

TEST(EveryModel, TurnsItsNormalsToTheSideThatItsTrianglesFace) {
  for_every_model([](std::string_view, const Model& model) {
    const Mesh& mesh = model.mesh;
    for (const Mesh::Triangle& t : mesh.triangles) {
      const Mesh::Vertex &a = mesh.vertices[t.a], &b = mesh.vertices[t.b], &c = mesh.vertices[t.c];
      const Eigen::Vector3f face =
          (b.position - a.position).cross(c.position - a.position).normalized();
      for (const Mesh::Vertex* v : {&a, &b, &c})
        ASSERT_GT(face.dot(v->normal), 0) << "at " << v->position.transpose();
    }
  });
}

// For each edge of the surface, how often it is run along in one direction less in the other.
TEST(EveryModel, IsClosed) {
  using Point = std::array<float, 3>;
  for_every_model([](std::string_view, const Model& model) {
    const Mesh& mesh = model.mesh;
    std::map<std::pair<Point, Point>, int> edges;
    const auto point = [&](std::uint32_t i) {
      // Parts that were moved into place are the same to a rounding error only.
      const Eigen::Vector3f p = (mesh.vertices[i].position * 5e4f).array().round();
      return Point{p.x() + 0.0f, p.y() + 0.0f, p.z() + 0.0f};
    };
    for (const Mesh::Triangle& t : mesh.triangles) {
      const Point corners[] = {point(t.a), point(t.b), point(t.c)};
      for (int i = 0; i < 3; ++i) {
        const Point &from = corners[i], &to = corners[(i + 1) % 3];
        if (from < to) ++edges[{from, to}];
        if (to < from) --edges[{to, from}];
      }
    }
    int open = 0;
    for (const auto& [edge, surplus] : edges) open += surplus != 0;
    // Points of different places may round to one.
    EXPECT_LE(open, 0.01 * double(edges.size()));
  });
}

TEST(EveryModel, EnclosesAVolume) {
  for_every_model([](std::string_view, const Model& model) {
    const Mesh& mesh = model.mesh;
    double volume = 0;
    for (const Mesh::Triangle& t : mesh.triangles)
      volume += double(mesh.vertices[t.a]
                           .position.cross(mesh.vertices[t.b].position)
                           .dot(mesh.vertices[t.c].position)) /
                6;
    EXPECT_GT(volume, 0);
  });
}

bool same_bytes(const Model& a, const Model& b) {
  if (a.mesh.vertices.size() != b.mesh.vertices.size() ||
      a.mesh.triangles.size() != b.mesh.triangles.size() ||
      a.mesh.materials.size() != b.mesh.materials.size())
    return false;
  for (std::size_t i = 0; i < a.mesh.vertices.size(); ++i)
    if (a.mesh.vertices[i].position != b.mesh.vertices[i].position ||
        a.mesh.vertices[i].normal != b.mesh.vertices[i].normal ||
        a.mesh.vertices[i].uv != b.mesh.vertices[i].uv)
      return false;
  if (std::memcmp(a.mesh.triangles.data(), b.mesh.triangles.data(),
                  a.mesh.triangles.size() * sizeof(Mesh::Triangle)) != 0)
    return false;
  for (std::size_t i = 0; i < a.mesh.materials.size(); ++i) {
    const Material &m = a.mesh.materials[i], &n = b.mesh.materials[i];
    if (m.colour != n.colour || m.emission != n.emission || m.gloss != n.gloss ||
        bool(m.texture) != bool(n.texture))
      return false;
    if (m.texture && (m.texture->picture.size() != n.texture->picture.size() ||
                      cv::norm(m.texture->picture, n.texture->picture, cv::NORM_INF) != 0))
      return false;
  }
  return true;
}

TEST(EveryModel, FollowsFromTheSeed) {
  for (const std::string_view class_name : model_classes()) {
    SCOPED_TRACE(class_name);
    const Model model = make_model(class_name, 7);
    EXPECT_TRUE(same_bytes(model, make_model(class_name, 7)));
    EXPECT_FALSE(same_bytes(model, make_model(class_name, 8)));
  }
}

// How far any vertex of the turned model is from the nearest one of the model, by its size.
float unlikeness(const Mesh& mesh, float angle) {
  const Eigen::AngleAxisf turn(angle, Eigen::Vector3f::UnitZ());
  const float size = bounds(mesh).sizes().maxCoeff();
  float worst = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 1 + mesh.vertices.size() / 100) {
    const Eigen::Vector3f moved = turn * mesh.vertices[i].position;
    float nearest = size;
    for (const Mesh::Vertex& v : mesh.vertices)
      nearest = std::min(nearest, (v.position - moved).norm());
    worst = std::max(worst, nearest / size);
  }
  return worst;
}

TEST(EveryModel, HasTheShapeOfItselfTurnedAsItsSymmetrySays) {
  for_every_model([](std::string_view, const Model& model) {
    constexpr float kHalf = std::numbers::pi_v<float>;
    switch (model.symmetry) {
      case Symmetry::kNone:
        return;
      case Symmetry::kHalfTurn:
        EXPECT_LT(unlikeness(model.mesh, kHalf), 0.08f);
        return;
      case Symmetry::kQuarterTurn:
        EXPECT_LT(unlikeness(model.mesh, kHalf / 2), 0.08f);
        return;
      case Symmetry::kAnyTurn:
        for (const float angle : {0.3f, 1.0f, 2.2f})
          EXPECT_LT(unlikeness(model.mesh, angle), 0.12f);
    }
  });
}

struct Sizes {
  float low[3], high[3];  // metres along x, y, z
};

// What real things measure.
const std::map<std::string_view, Sizes> kRealSizes{
    {"cup", {{0.07f, 0.09f, 0.075f}, {0.10f, 0.15f, 0.115f}}},
    {"bottle", {{0.055f, 0.055f, 0.19f}, {0.09f, 0.09f, 0.33f}}},
    {"bowl", {{0.12f, 0.12f, 0.025f}, {0.27f, 0.27f, 0.11f}}},
    {"vase", {{0.06f, 0.06f, 0.15f}, {0.26f, 0.26f, 0.37f}}},
    {"wine glass", {{0.055f, 0.055f, 0.15f}, {0.1f, 0.1f, 0.24f}}},
    {"book", {{0.16f, 0.1f, 0.01f}, {0.31f, 0.26f, 0.055f}}},
    {"keyboard", {{0.1f, 0.33f, 0.009f}, {0.17f, 0.48f, 0.05f}}},
    {"mouse", {{0.09f, 0.045f, 0.022f}, {0.13f, 0.085f, 0.05f}}},
    {"tv", {{0.1f, 0.45f, 0.33f}, {0.3f, 1.2f, 0.85f}}},
    {"laptop", {{0.19f, 0.28f, 0.17f}, {0.45f, 0.39f, 0.3f}}},
    {"cell phone", {{0.13f, 0.06f, 0.006f}, {0.17f, 0.085f, 0.012f}}},
    {"chair", {{0.4f, 0.38f, 0.78f}, {0.8f, 0.8f, 1.35f}}},
    {"dining table", {{0.68f, 0.88f, 0.7f}, {1.35f, 2.1f, 0.78f}}},
    {"couch", {{0.8f, 1.45f, 0.7f}, {1.05f, 2.4f, 1.0f}}},
    {"bed", {{1.9f, 0.9f, 0.7f}, {2.3f, 2.0f, 1.2f}}},
    {"bench", {{0.35f, 1.2f, 0.4f}, {0.75f, 2.0f, 0.95f}}},
    {"shelf", {{0.25f, 0.55f, 1.2f}, {0.4f, 1.25f, 2.2f}}},
    {"cabinet", {{0.38f, 0.55f, 0.65f}, {0.7f, 1.7f, 1.15f}}},
    {"clock", {{0.015f, 0.09f, 0.09f}, {0.2f, 0.4f, 0.4f}}},
    {"suitcase", {{0.14f, 0.29f, 0.5f}, {0.36f, 0.56f, 1.25f}}},
    {"backpack", {{0.15f, 0.22f, 0.4f}, {0.42f, 0.45f, 0.62f}}},
    {"sports ball", {{0.19f, 0.19f, 0.19f}, {0.25f, 0.25f, 0.25f}}},
    {"refrigerator", {{0.6f, 0.5f, 1.4f}, {0.85f, 0.75f, 2.0f}}},
    {"microwave", {{0.3f, 0.42f, 0.24f}, {0.47f, 0.55f, 0.32f}}},
    {"apple", {{0.06f, 0.06f, 0.05f}, {0.1f, 0.1f, 0.11f}}},
    {"orange", {{0.06f, 0.06f, 0.055f}, {0.1f, 0.1f, 0.09f}}},
    {"banana", {{0.03f, 0.13f, 0.025f}, {0.12f, 0.24f, 0.06f}}},
    {"remote", {{0.13f, 0.035f, 0.012f}, {0.22f, 0.055f, 0.03f}}},
    {"potted plant", {{0.15f, 0.15f, 0.2f}, {1.8f, 1.8f, 1.5f}}},
    {"tree", {{1.5f, 1.5f, 3.5f}, {8.0f, 8.0f, 10.0f}}},
    {"door", {{0.08f, 0.85f, 1.95f}, {0.25f, 1.2f, 2.25f}}},
    {"window", {{0.06f, 0.85f, 0.95f}, {0.3f, 2.3f, 1.75f}}},
    {"poster", {{0.002f, 0.25f, 0.38f}, {0.04f, 0.9f, 1.1f}}},
    {"lamp", {{0.15f, 0.15f, 0.3f}, {0.5f, 0.5f, 0.65f}}},
    {"floor lamp", {{0.3f, 0.3f, 1.3f}, {0.6f, 0.6f, 1.8f}}},
    {"car", {{3.6f, 1.6f, 1.35f}, {5.2f, 2.35f, 2.15f}}},
    {"truck", {{5.3f, 1.9f, 2.2f}, {8.3f, 2.9f, 3.7f}}},
    {"bus", {{9.0f, 2.3f, 2.8f}, {12.6f, 3.0f, 3.4f}}},
    {"traffic light", {{0.15f, 0.15f, 2.5f}, {0.9f, 0.7f, 4.3f}}},
    {"stop sign", {{0.03f, 0.6f, 2.0f}, {0.3f, 1.0f, 3.3f}}},
    {"fire hydrant", {{0.2f, 0.2f, 0.6f}, {0.6f, 0.65f, 0.85f}}},
};

TEST(EveryModel, HasTheSizeOfARealOne) {
  for_every_model([](std::string_view class_name, const Model& model) {
    const auto sizes = kRealSizes.find(class_name);
    ASSERT_NE(sizes, kRealSizes.end()) << "say what it measures";
    const Eigen::Vector3f size = bounds(model.mesh).sizes();
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(size[axis], sizes->second.low[axis]) << "axis " << axis;
      EXPECT_LE(size[axis], sizes->second.high[axis]) << "axis " << axis;
    }
  });
}

TEST(Model, OfADiningTableHasAHorizontalTop) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Mesh mesh = make_model("dining table", seed).mesh;
    const float top = bounds(mesh).max().z();
    Eigen::AlignedBox2f plate;
    for (const Mesh::Vertex& v : mesh.vertices)
      if (v.position.z() > top - 1e-6f) plate.extend(v.position.head<2>());
    EXPECT_GT(plate.volume(), 0.9 * bounds(mesh).sizes().head<2>().prod() - 0.15);
    EXPECT_GT(plate.volume(), 0.5);
  }
}

TEST(Model, OfAnUnknownClassIsAUsageError) {
  try {
    make_model("unicorn", 0);
    FAIL() << "a unicorn was made";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::kUsage);
    EXPECT_THAT(error.what(), testing::HasSubstr("unicorn"));
  }
}

}  // namespace
}  // namespace cairn

#include "cairn/datasets/groundtruth.h"

#include <gmock/gmock.h>

#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::HasSubstr;

TEST(ReadGroundtruth, SortsByTimeAndKeepsTheFirstOfRepeatedTimes) {
  TempFolder folder;
  const auto file = folder.write("g.txt",
                                 "# t x y z\n2 5 0 0 0 0 0 1\n1,4,0,0,0,0,0.7071068,0.7071068\n"
                                 "2 6 0 0 0 0 0 1\n");
  const Trajectory poses = read_groundtruth(file);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].timestamp, 1);
  EXPECT_EQ(poses[1].T_wc.translation().x(), 5);
  EXPECT_NEAR((poses[0].T_wc.rotation() * Eigen::Vector3d::UnitX()).y(), 1, 1e-6);
}

TEST(ReadGroundtruth, NamesTheLineThatIsBroken) {
  TempFolder folder;
  const auto error = [&](const std::string& text) {
    const auto file = folder.write("g.txt", text);
    return error_of(Error::Kind::kInput, [&] { read_groundtruth(file); });
  };
  EXPECT_THAT(error("1 0 0 0 0 0 0 1\n2 0 0 nan 0 0 0 1\n"), HasSubstr("g.txt, line 2: \"nan\""));
  EXPECT_THAT(error("#\n\n1 0 0 0\n"), HasSubstr("line 3: 4 values"));
  EXPECT_THAT(error("1 0 0 0 0 0 0 0\n"), HasSubstr("unit length"));
  EXPECT_THAT(error("# nothing\n"), HasSubstr("no poses"));
  EXPECT_THAT(error("1 0 0 1 0 1 0 2 0 0 1 3\n"), HasSubstr("times.txt"));
  EXPECT_THAT(error_of(Error::Kind::kInput, [&] { read_groundtruth(folder / "gone.txt"); }),
              HasSubstr("cannot be opened"));
  EXPECT_THAT(error_of(Error::Kind::kInput, [&] { read_groundtruth(folder.path()); }),
              HasSubstr("is a folder"));
}

}  // namespace
}  // namespace cairn

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "cairn/output/atomic_file.h"
#include "cairn/output/frames_csv.h"
#include "cairn/output/map_ply.h"
#include "cairn/output/summary.h"
#include "cairn/output/trajectory_file.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::HasSubstr;

std::string content(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t files_in(const std::filesystem::path& folder) {
  return std::size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(WriteFile, ReplacesTheFileAndLeavesNothingElse) {
  TempFolder folder;
  folder.write("a.txt", "an old and longer text");
  write_file(folder / "a.txt", "new");
  EXPECT_EQ(content(folder / "a.txt"), "new");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(WriteFile, NamesTheFileThatCannotBeWritten) {
  TempFolder folder;
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { write_file(folder / "no/a.txt", "x"); }),
              HasSubstr("no/a.txt: the file cannot be written"));
  std::filesystem::create_directories(folder / "taken/inside");
  error_of(Error::Kind::kOutput, [&] { write_file(folder / "taken", "x"); });
  EXPECT_EQ(files_in(folder.path()), 1u);  // nothing half written is left
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { write_file("/proc/cairn.txt", "x"); }),
              HasSubstr("/proc/cairn.txt"));
}

TEST(WriteFile, SaysThatTheDiskIsFullAndKeepsTheOldFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  TempFolder folder;
  folder.write("a.txt", "old");
  // What is beside the final name leads to a full device.
  std::filesystem::create_symlink("/dev/full",
                                  folder / ("a.txt.tmp-" + std::to_string(::getpid())));
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { write_file(folder / "a.txt", "new"); }),
              HasSubstr("free some space"));
  EXPECT_EQ(content(folder / "a.txt"), "old");
  EXPECT_EQ(files_in(folder.path()), 1u);
}

TEST(MakeOutputFolder, RefusesWhereAFileIs) {
  TempFolder folder;
  make_output_folder(folder / "a/b");
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
  folder.write("file", "x");
  EXPECT_THAT(error_of(Error::Kind::kOutput, [&] { make_output_folder(folder / "file"); }),
              HasSubstr("cannot be made"));
}

TEST(PendingFile, IsRemovedUnlessCommitted) {
  TempFolder folder;
  {
    PendingFile given_up(folder / "a.avi");
    EXPECT_EQ(given_up.path().extension(), ".avi");
    std::ofstream(given_up.path()) << "x";
  }
  EXPECT_EQ(files_in(folder.path()), 0u);
  PendingFile kept(folder / "a.avi");
  EXPECT_THROW(kept.commit(), Error);
  std::ofstream(kept.path()) << "x";
  kept.commit();
  EXPECT_EQ(content(folder / "a.avi"), "x");
}

TEST(WriteTrajectory, KeepsEveryDigitAndSixDecimalsOfTime) {
  TempFolder folder;
  const SE3 T(so3_exp({0.1, 3.0, -0.7}), {1.0 / 3, -0.0, 1e-7});
  write_trajectory(folder / "t.txt", {{1305031102.175304, T}, {2e9, T}, {0.5, T}});
  std::istringstream lines(content(folder / "t.txt"));
  std::string stamp;
  double x, y, z, qx, qy, qz, qw;
  ASSERT_TRUE(lines >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw);
  EXPECT_EQ(stamp, "1305031102.175304");
  EXPECT_EQ(x, 1.0 / 3);
  EXPECT_FALSE(std::signbit(y));
  EXPECT_EQ(z, 1e-7);
  EXPECT_GE(qw, 0);
  EXPECT_NEAR(Eigen::Quaterniond(qw, qx, qy, qz).angularDistance(T.rotation()), 0, 1e-12);
  EXPECT_THAT(content(folder / "t.txt"), HasSubstr("\n2000000000.000000 "));
  EXPECT_THAT(content(folder / "t.txt"), HasSubstr("\n0.500000 "));
}

TEST(FramesCsv, IsReadBack) {
  TempFolder folder;
  std::vector<FrameRecord> frames(2);
  frames[0].timestamp = 1403636579.7635556;
  frames[1] = {1403636579.9, FrameState::kTracked, 200, 150, true, 1.5, 2.25, 3, 6.75};
  write_frames_csv(folder / "frames.csv", frames);
  const auto times = read_frame_times(folder / "frames.csv");
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0], frames[0].timestamp);
  EXPECT_THAT(content(folder / "frames.csv"),
              HasSubstr("1403636579.900000,tracked,200,150,1,1.500,2.250,3.000,6.750\n"));
  const auto error = [&](const std::filesystem::path& file) {
    return error_of(Error::Kind::kInput, [&] { read_frame_times(file); });
  };
  EXPECT_THAT(error(folder / "gone.csv"), HasSubstr("gone.csv"));
  EXPECT_THAT(error(folder.write("a.csv", "x,y\n")), HasSubstr("first column"));
  EXPECT_THAT(error(folder.write("b.csv", "timestamp,y\n1,2\nnan,3\n")), HasSubstr("line 3"));
}

TEST(PlyModel, WritesWhatItsHeaderPromises) {
  TempFolder folder;
  PlyModel model;
  model.add_point({1, 2, 3}, {10, 20, 30});
  model.add_path({{0, SE3()}, {1, SE3(Eigen::Quaterniond::Identity(), {1, 0, 0})}}, {255, 0, 0},
                 0.25);
  EXPECT_EQ(model.vertex_count(), 6u);
  model.write(folder / "map.ply");
  std::string bytes = content(folder / "map.ply");
  EXPECT_THAT(bytes, HasSubstr("element vertex 6\n"));
  EXPECT_THAT(bytes, testing::Not(HasSubstr("element face")));
  const std::size_t data = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size() - data, 6u * 15);
  float first[3];
  std::memcpy(first, &bytes[data], sizeof first);
  EXPECT_EQ(first[2], 3);
  EXPECT_EQ(bytes[data + 12], 10);
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Eigen::Vector3i> triangles = {{0, 1, 2}, {0, 2, 3}};
  model.add_polygon(corners, {0, 0, 0});
  model.add_mesh(corners, triangles, {0, 0, 0});
  model.add_camera(SE3(), 0.1, {0, 0, 0});
  model.write(folder / "map.ply");
  bytes = content(folder / "map.ply");
  EXPECT_THAT(bytes, HasSubstr("element face 4\n"));
  EXPECT_EQ(bytes.size() - bytes.find("end_header\n") - 11,
            model.vertex_count() * 15 + 4 * (1 + 3) * 4);
}

std::vector<FrameRecord> hundred_frames() {
  std::vector<FrameRecord> frames(100);
  for (int i = 0; i < 100; ++i) {
    frames[std::size_t(i)].state = i < 80 ? FrameState::kTracked : FrameState::kLost;
    frames[std::size_t(i)].total_ms = i + 1;
  }
  frames.push_back({});
  frames.back().state = FrameState::kDropped;
  frames.back().total_ms = 1e6;
  return frames;
}

TEST(StageTimes, AreMedianAndNearestRankOfTheFramesThatWereProcessed) {
  const auto times = stage_times(hundred_frames());
  ASSERT_EQ(times.size(), 1u);
  EXPECT_DOUBLE_EQ(times.at("total").median_ms, 50.5);
  EXPECT_DOUBLE_EQ(times.at("total").p95_ms, 95);
}

TEST(Summary, HoldsWhatTheRunDid) {
  TempFolder folder;
  RunSummary summary;
  summary.version = "1.2.3";
  summary.command = "cairn run \xff";  // a file name that is no UTF-8
  summary.seed = 18446744073709551615u;
  summary.options = {{"features.count", 1000}};
  summary.frames = hundred_frames();
  summary.gaps = {{1.5, 2.0}, {3.0, std::nullopt}};
  summary.refusals = {{"too little parallax", 3}};
  summary.object_refusals = {{"too small a span", 4}};
  summary.objects = 3;
  summary.scale = {"object sizes", 1.5, 0.1, {{"object sizes", 1.5, 0.1, 3}}};
  summary.keyframes = 12;
  summary.keyframe_times.perception = {300, 100, 200};
  write_summary(folder / "summary.json", summary);
  const auto json = nlohmann::json::parse(content(folder / "summary.json"));
  EXPECT_EQ(json.at("frames"), 101);
  EXPECT_EQ(json.at("tracked"), 80);
  EXPECT_EQ(json.at("seed"), 18446744073709551615u);
  EXPECT_NEAR(json.at("coverage"), 80.0 / 101, 1e-12);
  EXPECT_EQ(json.at("losses").at(0).at("recovered"), 2.0);
  EXPECT_TRUE(json.at("losses").at(1).at("recovered").is_null());
  EXPECT_EQ(json.at("stages").at("total").at("p95_ms"), 95);
  EXPECT_EQ(json.at("keyframe_stages").at("perception").at("median_ms"), 200);
  EXPECT_FALSE(json.at("keyframe_stages").contains("objects")) << "no keyframe has any";
  EXPECT_EQ(json.at("refusals").at("too little parallax"), 3);
  EXPECT_EQ(json.at("states").at("dropped"), 1);
  EXPECT_GT(json.at("peak_memory_mib"), 1);
  EXPECT_EQ(json.at("objects"), 3);
  EXPECT_EQ(json.at("object_refusals").at("too small a span"), 4);
  EXPECT_EQ(json.at("scale").at("how"), "object sizes");
  const auto& part = json.at("scale").at("parts").at(0);
  EXPECT_EQ(part.at("how"), "object sizes");
  EXPECT_EQ(part.at("value"), 1.5);
  EXPECT_EQ(part.at("sigma"), 0.1);
  EXPECT_EQ(part.at("count"), 3);
  EXPECT_EQ(to_json(RunSummary()).at("scale").at("how"), "none");
}

}  // namespace
}  // namespace cairn

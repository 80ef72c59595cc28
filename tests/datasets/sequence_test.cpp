#include "cairn/datasets/sequence.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "cairn/datasets/groundtruth.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kCalibration =
    "color:\n  width: 64\n  height: 48\n  fps: 10\n  fx: 50\n  fy: 51\n  cx: 31\n  cy: 23\n"
    "  distortion: [0.1, 0.2, 0.3, 0.4, 0.5]\n";

std::vector<SourceFrame> all_frames(Sequence& sequence) {
  std::vector<SourceFrame> frames;
  for (SourceFrame frame; sequence.frames->next(frame);) frames.push_back(frame);
  return frames;
}

// Five pictures, 0.1 s apart, from 100 s on.
void write_tum(const TempFolder& folder) {
  std::string list = "# timestamp filename\n";
  for (int i = 0; i < 5; ++i) {
    const std::string name = "rgb/" + std::to_string(i) + ".png";
    write_picture(folder / name, i);
    list += std::to_string(100 + 0.1 * i) + " " + name + "\n";
  }
  folder.write("rgb.txt", list);
  folder.write("groundtruth.txt", "100 1 2 3 0 0 0 1\n100.1 1 2 4 0 0 0 1\n");
  folder.write("calibration.yaml", kCalibration);
}

TEST(OpenSequence, RecognisesTumAndReadsItsFramesInOrder) {
  TempFolder folder;
  write_tum(folder);
  folder.write("groundtruth_sfm.txt", "100 1 2 3 0 0 0 1\n");
  Sequence sequence = open_sequence(folder.path().string());
  EXPECT_EQ(sequence.layout, "tum");
  EXPECT_EQ(sequence.name, folder.path().filename().string());
  EXPECT_NEAR(sequence.fps, 10, 1e-3);
  ASSERT_TRUE(sequence.camera.has_value());
  EXPECT_EQ(sequence.camera->pinhole().fy, 51);
  EXPECT_EQ(sequence.camera->distortion()[4], 0.5);
  EXPECT_EQ(*sequence.groundtruth, folder / "groundtruth.txt");
  ASSERT_EQ(sequence.more_groundtruth.size(), 1u);
  EXPECT_EQ(sequence.frames->size(), 5u);
  EXPECT_FALSE(sequence.frames->live());
  const auto frames = all_frames(sequence);
  ASSERT_EQ(frames.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_THAT(frames[i].problem, IsEmpty());
    EXPECT_NEAR(frames[i].timestamp, 100 + 0.1 * i, 1e-9);
    EXPECT_EQ(cv::norm(frames[i].image, test_picture(i), cv::NORM_INF), 0);
  }
}

TEST(OpenSequence, HandsOutGreyPicturesOnRequest) {
  TempFolder folder;
  write_tum(folder);
  OpenOptions options;
  options.colour = false;
  Sequence sequence = open_sequence(folder.path().string(), options);
  SourceFrame frame;
  ASSERT_TRUE(sequence.frames->next(frame));
  EXPECT_EQ(frame.image.type(), CV_8UC1);
}

TEST(OpenSequence, MarksBrokenFramesAndGoesOn) {
  TempFolder folder;
  write_tum(folder);
  const auto cut = write_picture(folder / "rgb/cut.jpg", 7);
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) * 2 / 3);
  write_picture(folder / "rgb/large.png", 7, {80, 60});
  folder.write("rgb/empty.png", "");
  folder.write("rgb.txt",
               "1 rgb/0.png\n2 rgb/gone.png\n3 rgb/cut.jpg\n4 rgb/large.png\n5 rgb/empty.png\n"
               "nan rgb/1.png\nsix rgb/1.png\n7\n8 rgb/1.png\n8 rgb/2.png\n2.5 rgb/3.png\n"
               "9 rgb/4.png\n");
  Sequence sequence = open_sequence(folder.path().string());
  const auto frames = all_frames(sequence);
  ASSERT_EQ(frames.size(), 12u);
  const std::vector<std::string> problems = {"",
                                             "gone.png: the file is missing",
                                             "cut off",
                                             "80x60",
                                             "empty",
                                             "rgb.txt, line 6",
                                             "rgb.txt, line 7",
                                             "no file name",
                                             "",
                                             "repeats",
                                             "goes back",
                                             ""};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (problems[i].empty()) {
      EXPECT_THAT(frames[i].problem, IsEmpty()) << i;
      EXPECT_FALSE(frames[i].image.empty()) << i;
    } else {
      EXPECT_THAT(frames[i].problem, HasSubstr(problems[i])) << i;
      EXPECT_TRUE(frames[i].image.empty()) << i;
    }
    EXPECT_TRUE(std::isfinite(frames[i].timestamp)) << i;
  }
}

TEST(OpenSequence, LosesOneFrameOnlyToATimeThatIsFarAhead) {
  TempFolder folder;
  write_tum(folder);
  folder.write("rgb.txt",
               "1 rgb/0.png\n9e9 rgb/1.png\nnan rgb/2.png\n2 rgb/2.png\n3 rgb/3.png\n0 rgb/4.png\n"
               "4 rgb/4.png\n");
  Sequence sequence = open_sequence(folder.path().string());
  std::vector<std::string> problems;
  for (const SourceFrame& frame : all_frames(sequence)) problems.push_back(frame.problem);
  EXPECT_THAT(problems, testing::ElementsAre("", HasSubstr("ahead of those"), HasSubstr("nan"), "",
                                             "", HasSubstr("goes back"), ""));
}

TEST(OpenSequence, KnowsThePublishedCameraOfTumDownloads) {
  TempFolder folder;
  write_picture(folder / "rgbd_dataset_freiburg3_x/rgb/0.png", 0, {640, 480});
  folder.write("rgbd_dataset_freiburg3_x/rgb.txt", "1 rgb/0.png\n");
  Sequence sequence = open_sequence((folder / "rgbd_dataset_freiburg3_x").string());
  ASSERT_TRUE(sequence.camera.has_value());
  EXPECT_EQ(sequence.camera->pinhole().fx, 535.4);
}

TEST(OpenSequence, ReadsEurocWithItsSensorFileAndTakesBodyPosesToTheCamera) {
  TempFolder folder;
  write_picture(folder / "mav0/cam0/data/1000000000.png", 0);
  write_picture(folder / "mav0/cam0/data/1050000000.png", 1);
  folder.write("mav0/cam0/data.csv",
               "#timestamp [ns],filename\r\n1000000000,1000000000.png\r\n1050000000,"
               "1050000000.png\r\n");
  folder.write("mav0/cam0/sensor.yaml",
               "# General\nsensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -1.0, "
               "0.0, 0.5,\n 1.0, 0.0, 0.0, 0.25,\n 0.0, 0.0, 1.0, 0.125,\n 0.0, 0.0, 0.0, 1.0]\n"
               "rate_hz: 20\nresolution: [64, 48]\ncamera_model: pinhole\n"
               "intrinsics: [45, 46, 32, 24]\ndistortion_model: equidistant\n"
               "distortion_coefficients: [-0.1, 0.01, 0.001, 0.0001]\n");
  folder.write("mav0/state_groundtruth_estimate0/data.csv",
               "#timestamp,x,y,z,qw,qx,qy,qz,vx\n1000000000,1,2,3,1,0,0,0,9\n");
  Sequence sequence = open_sequence(folder.path().string());
  EXPECT_EQ(sequence.layout, "euroc");
  EXPECT_EQ(sequence.camera->model(), Camera::Model::kKannalaBrandt);
  EXPECT_EQ(sequence.camera->distortion()[3], 0.0001);
  const auto frames = all_frames(sequence);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_NEAR(frames[1].timestamp, 1.05, 1e-9);
  const Trajectory truth = read_groundtruth(*sequence.groundtruth, "euroc");
  ASSERT_EQ(truth.size(), 1u);
  EXPECT_TRUE(truth[0].T_wc.translation().isApprox(Eigen::Vector3d(1.5, 2.25, 3.125)));
  EXPECT_TRUE(
      (truth[0].T_wc.rotation() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

void write_kitti(const TempFolder& folder) {
  for (int i = 0; i < 3; ++i) {
    write_picture(folder / ("sequences/05/image_0/00000" + std::to_string(i) + ".jpg"), i);
  }
  folder.write("sequences/05/times.txt", "0.0\n1.0e-01\n2.0e-01\n");
  folder.write("sequences/05/calib.txt", "P0: 70 0 32 0 0 71 24 0 0 0 1 0\nP1: 1 2\n");
  folder.write("poses/05.txt",
               "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 1 0 1 0 2 0 0 1 4\n"
               "1 0 0 1 0 1 0 2 0 0 1 5\n");
}

TEST(OpenSequence, ReadsKittiFromItsRootOrFromTheSequence) {
  TempFolder folder;
  write_kitti(folder);
  for (const std::string& where : {folder.path().string(), (folder / "sequences/05").string(),
                                   (folder / "sequences/05/").string()}) {
    Sequence sequence = open_sequence(where);
    EXPECT_EQ(sequence.layout, "kitti") << where;
    EXPECT_EQ(sequence.camera->pinhole().fy, 71);
    EXPECT_EQ(sequence.camera->width(), 64);
    EXPECT_EQ(all_frames(sequence).size(), 3u);
    ASSERT_TRUE(sequence.groundtruth.has_value()) << where;
    const Trajectory truth = read_groundtruth(*sequence.groundtruth);
    ASSERT_EQ(truth.size(), 3u);
    EXPECT_EQ(truth[2].timestamp, 0.2);
    EXPECT_EQ(truth[2].T_wc.translation(), Eigen::Vector3d(1, 2, 5));
  }
}

TEST(OpenSequence, SortsPicturesOfAFolderByNumberAndCountsTime) {
  TempFolder folder;
  for (const int i : {1, 2, 10}) write_picture(folder / ("view" + std::to_string(i) + ".png"), i);
  OpenOptions options;
  options.fps = 20;
  Sequence sequence = open_sequence(folder.path().string(), options);
  EXPECT_EQ(sequence.layout, "images");
  EXPECT_FALSE(sequence.camera.has_value());
  const auto frames = all_frames(sequence);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].name, "view10.png");
  EXPECT_NEAR(frames[2].timestamp, 0.1, 1e-12);
}

TEST(OpenSequence, TakesTimesFromTheNamesOfPictures) {
  const auto times = [](const std::vector<std::string>& names) {
    TempFolder folder;
    for (const auto& name : names) write_picture(folder / name, 1);
    OpenOptions options;
    options.fps = 10;
    Sequence sequence = open_sequence(folder.path().string(), options);
    std::vector<double> result;
    for (const auto& frame : all_frames(sequence)) result.push_back(frame.timestamp);
    return result;
  };
  EXPECT_THAT(times({"1.25.png", "1.5.png"}), testing::ElementsAre(1.25, 1.5));
  EXPECT_THAT(times({"000003.png", "000005.png"}),
              testing::ElementsAre(testing::DoubleEq(0.3), 0.5));
  EXPECT_THAT(times({"1403636579763555584.png"}),
              testing::ElementsAre(testing::DoubleNear(1403636579.763555, 1e-5)));
}

TEST(OpenSequence, TakesAPatternInPlaceOfAFolder) {
  TempFolder folder;
  for (int i = 0; i < 4; ++i) {
    write_picture(folder / ("left" + std::to_string(i) + ".png"), i);
    write_picture(folder / ("right" + std::to_string(i) + ".png"), i);
  }
  Sequence sequence = open_sequence((folder / "left*.png").string());
  EXPECT_EQ(sequence.layout, "images");
  EXPECT_EQ(all_frames(sequence).size(), 4u);
}

TEST(OpenSequence, UsesTheCameraOfTheCallerBeforeThatOfTheLayout) {
  TempFolder folder;
  write_tum(folder);
  OpenOptions options;
  options.intrinsics = "60,61,30,20";
  EXPECT_EQ(open_sequence(folder.path().string(), options).camera->pinhole().fx, 60);
  OpenOptions with_file;
  with_file.calibration = folder.write("other.yaml", "{fx: 70, fy: 71, cx: 30, cy: 20}");
  EXPECT_EQ(open_sequence(folder.path().string(), with_file).camera->pinhole().fx, 70);
}

TEST(OpenSequence, SaysWhatIsWrongWithInputThatIsNotThere) {
  TempFolder folder;
  const auto input_error = [&](const std::string& what, const OpenOptions& options = {}) {
    return error_of(Error::Kind::kInput, [&] { open_sequence(what, options); });
  };
  EXPECT_THAT(input_error((folder / "gone").string()), HasSubstr("no such folder"));
  EXPECT_THAT(input_error(folder.path().string()), HasSubstr("no pictures"));
  EXPECT_THAT(input_error((folder / "*.png").string()), HasSubstr("no file fits"));
  OpenOptions tum, camera;
  tum.layout = "tum";
  EXPECT_THAT(input_error(folder.path().string(), tum), HasSubstr("rgb.txt"));
  camera.layout = "camera";
  EXPECT_THAT(input_error((folder / "video9").string(), camera), HasSubstr("cannot be opened"));
  folder.write("rgb.txt", "1 a.png\n2 b.png\n");
  EXPECT_THAT(input_error(folder.path().string()), HasSubstr("not one of the 2 pictures"));
  folder.write("rgb.txt", "# nothing\n");
  EXPECT_THAT(input_error(folder.path().string()), HasSubstr("no picture is listed"));
  EXPECT_THAT(input_error(folder.write("film.mp4", "no film").string()),
              HasSubstr("cannot be opened"));
}

TEST(OpenSequence, RefusesOptionsThatCannotBe) {
  TempFolder folder;
  write_tum(folder);
  OpenOptions layout, negative, other_size;
  layout.layout = "tmu";
  const auto usage_error = [&](const OpenOptions& options) {
    return error_of(Error::Kind::kUsage, [&] { open_sequence(folder.path().string(), options); });
  };
  EXPECT_THAT(usage_error(layout), HasSubstr("use auto, tum"));
  negative.intrinsics = "-60,61,30,20";
  EXPECT_THAT(usage_error(negative), HasSubstr("focal length"));
  other_size.camera = Camera(Camera::Model::kRadialTangential, 640, 480, {500, 500, 320, 240});
  EXPECT_THAT(usage_error(other_size), HasSubstr("640x480"));
}

TEST(OpenSequence, ReadsTheRealSequences) {
  const char* const given = std::getenv("CAIRN_DATA");
  const std::filesystem::path data = given != nullptr ? given : CAIRN_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(data)) {
    GTEST_SKIP() << "no real sequences in " << data << "; set CAIRN_DATA to the data folder";
  }
  const std::map<std::string, std::size_t> counts = {
      {"redkitchen", 1000}, {"tum_fr1_xyz", 798}, {"kitti_00", 200}};
  for (const auto& [name, count] : counts) {
    Sequence sequence = open_sequence((data / name).string());
    EXPECT_EQ(sequence.frames->size(), count) << name;
    ASSERT_TRUE(sequence.camera && sequence.groundtruth) << name;
    EXPECT_GE(read_groundtruth(*sequence.groundtruth).size(), count) << name;
    SourceFrame frame;
    for (int i = 0; i < 5 && sequence.frames->next(frame); ++i) {
      EXPECT_THAT(frame.problem, IsEmpty());
    }
  }
}

}  // namespace
}  // namespace cairn

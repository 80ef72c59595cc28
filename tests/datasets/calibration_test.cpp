#include "cairn/datasets/calibration.h"

#include <gmock/gmock.h>

#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::HasSubstr;

class CalibrationFile : public testing::Test {
 protected:
  Calibration read(const std::string& text, std::optional<cv::Size> size = std::nullopt) {
    return read_calibration_file(folder_.write("calibration.yaml", text), size);
  }
  std::string usage_error(const std::string& text) {
    return error_of(Error::Kind::kUsage, [&] { read(text); });
  }
  TempFolder folder_;
};

TEST_F(CalibrationFile, OfCairnIsRead) {
  const Calibration c = read(
      "color:\n  model: pinhole\n  width: 640\n  height: 480\n  fps: 30\n  fx: 500\n  fy: 501\n"
      "  cx: 320\n  cy: 240\n  distortion: [1, 2, 3, 4, 5]\ndepth:\n  fx: 1\n");
  EXPECT_EQ(c.camera.pinhole().fx, 500);
  EXPECT_EQ(c.camera.distortion(), (std::array<double, 5>{1, 2, 3, 4, 5}));
  EXPECT_EQ(c.fps, 30);
}

TEST_F(CalibrationFile, WithFlatKeysIsRead) {
  const Calibration c =
      read("fx: 50\nfy: 51\ncx: 30\ncy: 20\nk1: 0.1\np2: 0.2\n", cv::Size(64, 48));
  EXPECT_EQ(c.camera.distortion(), (std::array<double, 5>{0.1, 0, 0, 0.2, 0}));
  EXPECT_EQ(c.camera.width(), 64);
}

TEST_F(CalibrationFile, WithPrefixedKeysAndAVersionLineIsRead) {
  const Calibration c = read(
      "%YAML:1.0\n---\nCamera.type: \"PinHole\"\nCamera.fx: 50\nCamera.fy: 51\nCamera.cx: 30\n"
      "Camera.cy: 20\nCamera.k1: 0.5\nCamera.width: 64\nCamera.height: 48\nCamera.fps: 20\n");
  EXPECT_EQ(c.camera.pinhole().cy, 20);
  EXPECT_EQ(c.camera.distortion()[0], 0.5);
}

TEST_F(CalibrationFile, OfRosIsRead) {
  const Calibration c = read(
      "image_width: 64\nimage_height: 48\ncamera_matrix: {rows: 3, cols: 3, data: [50, 0, 30, 0, "
      "51, 20, 0, 0, 1]}\ndistortion_model: plumb_bob\ndistortion_coefficients: {data: [1, 2, 3, "
      "4, 5]}\n");
  EXPECT_EQ(c.camera.pinhole().fy, 51);
  EXPECT_EQ(c.camera.distortion()[4], 5);
}

TEST_F(CalibrationFile, OfKalibrIsRead) {
  const Calibration c = read(
      "cam0:\n  camera_model: pinhole\n  intrinsics: [50, 51, 30, 20]\n  distortion_model: radtan\n"
      "  distortion_coeffs: [1, 2, 3, 4]\n  resolution: [64, 48]\n");
  EXPECT_EQ(c.camera.distortion(), (std::array<double, 5>{1, 2, 3, 4, 0}));
}

TEST_F(CalibrationFile, WithAWrongValueIsRefusedWithItsName) {
  const std::string size = "width: 64\nheight: 48\n";
  EXPECT_THAT(usage_error(size + "fx: -5\nfy: 5\ncx: 30\ncy: 20\n"),
              testing::AllOf(HasSubstr("focal length"), HasSubstr("calibration.yaml")));
  EXPECT_THAT(usage_error(size + "fx: .nan\nfy: 5\ncx: 30\ncy: 20\n"), HasSubstr("line 3: fx"));
  EXPECT_THAT(usage_error(size + "fx: 5\nfy: 5\ncx: 30\n"), HasSubstr("cy is missing"));
  EXPECT_THAT(usage_error("fx: 5\nfy: 5\ncx: 30\ncy: 20\n"), HasSubstr("width and height"));
  EXPECT_THAT(usage_error(size + "model: omni\nfx: 5\nfy: 5\ncx: 30\ncy: 20\n"),
              HasSubstr("model omni is not known"));
  EXPECT_THAT(usage_error(size + "fx: 5\nfy: 5\ncx: 30\ncy: 20\ndistortion: [1,2,3,4,5,6]\n"),
              HasSubstr("more than five"));
  EXPECT_THAT(usage_error(size + "intrinsics: [1, 2]\n"), HasSubstr("four numbers"));
}

TEST_F(CalibrationFile, ThatIsMissingOrNoYamlIsAnInputError) {
  const auto input_error = [](const std::filesystem::path& file) {
    return error_of(Error::Kind::kInput, [&] { read_calibration(file); });
  };
  EXPECT_THAT(input_error(folder_ / "gone.yaml"), HasSubstr("gone.yaml"));
  EXPECT_THAT(input_error(folder_.write("a.yaml", "fx: [1\nfy: }")), HasSubstr("not YAML"));
  EXPECT_THAT(input_error(folder_.write("b.yaml", "")), HasSubstr("no keys"));
}

TEST_F(CalibrationFile, OfKittiNeedsTheSizeOfThePicture) {
  const auto file = folder_.write("calib.txt", "P0: 70 0 32 0 0 71 24 0 0 0 1 0\n");
  EXPECT_EQ(read_calibration(file, cv::Size(64, 48)).pinhole().cx, 32);
  EXPECT_THAT(error_of(Error::Kind::kUsage, [&] { read_calibration(file); }), HasSubstr("size"));
  const auto cut = folder_.write("cut.txt", "P0: 70 0 32\n");
  EXPECT_THAT(error_of(Error::Kind::kInput, [&] { read_calibration(cut, cv::Size(64, 48)); }),
              HasSubstr("twelve numbers"));
}

TEST(ParseCamera, TakesFourEightOrNineValues) {
  EXPECT_EQ(parse_camera("50,51,30,20", 64, 48).pinhole().fy, 51);
  EXPECT_EQ(parse_camera("50, 51, 30, 20, 1, 2, 3, 4", 64, 48).distortion()[3], 4);
  EXPECT_EQ(parse_camera("50,51,30,20,1,2,3,4,5", 64, 48).distortion()[4], 5);
}

TEST(ParseCamera, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) {
    return error_of(Error::Kind::kUsage, [&] { parse_camera(text, 64, 48); });
  };
  EXPECT_THAT(error("50,51,30"), HasSubstr("3 values"));
  EXPECT_THAT(error("50,51,30,x"), HasSubstr("\"x\" is not a finite number"));
  EXPECT_THAT(error("50,51,,20"), HasSubstr("not a finite number"));
  EXPECT_THAT(error("50,nan,30,20"), HasSubstr("not a finite number"));
  EXPECT_THAT(error("50,51,300,20"), HasSubstr("principal point"));
}

}  // namespace
}  // namespace cairn

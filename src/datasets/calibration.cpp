#include "cairn/datasets/calibration.h"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <sstream>
#include <vector>

#include "cairn/datasets/text_lines.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

// One file being read; its name goes into every sentence.
class CalibrationReader {
 public:
  CalibrationReader(const std::filesystem::path& file, std::optional<cv::Size> size)
      : file_(file), size_(size) {}

  Calibration read() const;
  DepthCalibration read_depth() const;

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(Error::Kind::kUsage, file_.string() + ": " + why);
  }
  template <typename Read>
  auto reading(const Read& read) const {
    try {
      return read();
    } catch (const YAML::Exception& e) {
      refuse(std::string("a value has the wrong form (") + e.what() + ")");
    }
  }
  YAML::Node load() const;
  YAML::Node camera_node(const YAML::Node& root) const;
  YAML::Node find(const YAML::Node& node, const std::string& key) const;
  std::optional<double> number(const YAML::Node& node, const std::string& key) const;
  std::vector<double> numbers(const YAML::Node& node, const std::string& key) const;
  Pinhole intrinsics(const YAML::Node& node) const;
  Camera::Model model(const YAML::Node& node) const;
  std::array<double, 5> distortion(const YAML::Node& node, Camera::Model model) const;
  cv::Size size(const YAML::Node& node) const;
  Camera camera(const YAML::Node& node) const;
  SE3 rigid(const std::vector<double>& values, const std::string& key) const;
  DepthCalibration depth(const YAML::Node& root) const;

  std::filesystem::path file_;
  std::optional<cv::Size> size_;
};

YAML::Node CalibrationReader::load() const {
  std::ifstream stream(file_);
  if (!stream || std::filesystem::is_directory(file_)) {
    throw Error(Error::Kind::kInput, file_.string() +
                                         ": the calibration file cannot be opened; check that it "
                                         "is there and may be read");
  }
  std::stringstream text;
  for (std::string line; std::getline(stream, line);) {
    // OpenCV's FileStorage writes a version line that is not YAML.
    text << (line.starts_with("%YAML") ? "" : line) << '\n';
  }
  try {
    YAML::Node root = YAML::Load(text.str());
    if (root.IsMap()) return root;
  } catch (const YAML::Exception& e) {
    throw Error(Error::Kind::kInput, file_.string() + ", line " + std::to_string(e.mark.line + 1) +
                                         ": the calibration file is not YAML (" + e.msg +
                                         "); mend this line");
  }
  throw Error(Error::Kind::kInput, file_.string() +
                                       ": the calibration file holds no keys; give at least fx, "
                                       "fy, cx, cy, width and height");
}

YAML::Node CalibrationReader::camera_node(const YAML::Node& root) const {
  for (const char* key : {"color", "colour", "rgb", "cam0", "camera"}) {
    if (const YAML::Node node = root[key]; node && node.IsMap()) return node;
  }
  return root;
}

YAML::Node CalibrationReader::find(const YAML::Node& node, const std::string& key) const {
  for (const char* prefix : {"", "Camera.", "Camera1."}) {
    const YAML::Node found = node[prefix + key];
    if (found && !found.IsNull()) return found;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

std::optional<double> CalibrationReader::number(const YAML::Node& node,
                                                const std::string& key) const {
  const YAML::Node found = find(node, key);
  if (!found) return std::nullopt;
  const auto value =
      found.IsScalar() ? parse_number(found.as<std::string>()) : std::optional<double>();
  if (!value) {
    refuse("line " + std::to_string(found.Mark().line + 1) + ": " + key +
           " must be a finite number");
  }
  return value;
}

std::vector<double> CalibrationReader::numbers(const YAML::Node& node,
                                               const std::string& key) const {
  YAML::Node found = find(node, key);
  if (found && found.IsMap()) found.reset(found["data"]);
  std::vector<double> values;
  if (!found) return values;
  if (!found.IsSequence()) refuse(key + " must be a list of numbers, such as [1.0, 2.0]");
  for (const YAML::Node& entry : found) {
    const auto value =
        entry.IsScalar() ? parse_number(entry.as<std::string>()) : std::optional<double>();
    if (!value) refuse(key + " must hold finite numbers only");
    values.push_back(*value);
  }
  return values;
}

Pinhole CalibrationReader::intrinsics(const YAML::Node& node) const {
  if (const auto list = numbers(node, "intrinsics"); !list.empty()) {
    if (list.size() != 4) refuse("intrinsics must be the four numbers [fx, fy, cx, cy]");
    return {list[0], list[1], list[2], list[3]};
  }
  if (const auto K = numbers(node, "camera_matrix"); !K.empty()) {
    if (K.size() != 9) refuse("camera_matrix must have nine numbers, row by row");
    return {K[0], K[4], K[2], K[5]};
  }
  std::array<double, 4> values{};
  constexpr std::array<const char*, 4> kKeys = {"fx", "fy", "cx", "cy"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = number(node, kKeys[i]);
    if (!value) {
      refuse(std::string(kKeys[i]) + " is missing; give fx, fy, cx and cy in pixels (or " +
             "intrinsics: [fx, fy, cx, cy])");
    }
    values[i] = *value;
  }
  return {values[0], values[1], values[2], values[3]};
}

Camera::Model CalibrationReader::model(const YAML::Node& node) const {
  bool fisheye = false;
  for (const char* key : {"model", "camera_model", "distortion_model", "type"}) {
    const YAML::Node found = find(node, key);
    if (!found || !found.IsScalar()) continue;
    const auto name = found.as<std::string>();
    const auto is_one_of = [&](std::initializer_list<const char*> names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (is_one_of({"equidistant", "fisheye", "kannala_brandt", "KannalaBrandt8"})) {
      fisheye = true;
    } else if (!is_one_of({"pinhole", "PinHole", "Pinhole", "radtan", "radial-tangential", "brown",
                           "plumb_bob", "none", "mono", "perspective"})) {
      refuse(std::string(key) + " " + name +
             " is not known; use pinhole (radial-tangential) or fisheye (equidistant)");
    }
  }
  return fisheye ? Camera::Model::kKannalaBrandt : Camera::Model::kRadialTangential;
}

std::array<double, 5> CalibrationReader::distortion(const YAML::Node& node,
                                                    Camera::Model model) const {
  std::array<double, 5> values{};
  for (const char* key : {"distortion", "distortion_coefficients", "distortion_coeffs"}) {
    const auto list = numbers(node, key);
    if (list.empty()) continue;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i < values.size()) values[i] = list[i];
      if (i >= values.size() && list[i] != 0) {
        refuse(std::string(key) + " has more than five coefficients that are not zero; calibrate " +
               "with k1, k2, p1, p2, k3 (or k1 to k4 for a fisheye)");
      }
    }
    return values;
  }
  constexpr std::array<const char*, 5> kBrown = {"k1", "k2", "p1", "p2", "k3"};
  constexpr std::array<const char*, 4> kFisheye = {"k1", "k2", "k3", "k4"};
  if (model == Camera::Model::kKannalaBrandt) {
    for (std::size_t i = 0; i < 4; ++i) values[i] = number(node, kFisheye[i]).value_or(0);
  } else {
    for (std::size_t i = 0; i < 5; ++i) values[i] = number(node, kBrown[i]).value_or(0);
  }
  return values;
}

cv::Size pixels(double width, double height) {
  return {int(std::clamp(width, 0.0, 1e6)), int(std::clamp(height, 0.0, 1e6))};
}

cv::Size CalibrationReader::size(const YAML::Node& node) const {
  if (const auto list = numbers(node, "resolution"); list.size() == 2) {
    return pixels(list[0], list[1]);
  }
  auto width = number(node, "width"), height = number(node, "height");
  if (!width) width = number(node, "image_width");
  if (!height) height = number(node, "image_height");
  if (width && height) return pixels(*width, *height);
  if (size_) return *size_;
  refuse("width and height are missing; give the size of the picture in pixels");
}

Camera CalibrationReader::camera(const YAML::Node& node) const {
  const Camera::Model kind = model(node);
  const Pinhole pinhole = intrinsics(node);
  const cv::Size picture = size(node);
  const std::array<double, 5> lens = distortion(node, kind);
  try {
    return Camera(kind, picture.width, picture.height, pinhole, lens);
  } catch (const Error& e) {  // the camera does not know of the file
    throw Error(e.kind(), file_.string() + ": " + e.what());
  }
}

// A 4x4 matrix, row by row.
SE3 CalibrationReader::rigid(const std::vector<double>& values, const std::string& key) const {
  if (values.size() != 16) refuse(key + " must have sixteen numbers, a 4x4 matrix row by row");
  const Eigen::Matrix4d T = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>(values.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  if (!(R * R.transpose()).isIdentity(1e-3) || !(R.determinant() > 0)) {
    refuse(key + " must begin with a rotation; check its rows");
  }
  return SE3(R, T.topRightCorner<3, 1>());
}

DepthCalibration CalibrationReader::depth(const YAML::Node& root) const {
  DepthCalibration result;
  const YAML::Node node = root["depth"];
  if (!node || !node.IsMap()) return result;
  if (const auto scale = number(node, "scale")) result.scale = *scale;
  if (!(result.scale > 0)) refuse("scale of depth must be positive: steps a metre, such as 5000");
  if (find(node, "fx") || find(node, "intrinsics") || find(node, "camera_matrix")) {
    result.camera = camera(node);
  }
  if (const auto T = numbers(node, "T_color_depth"); !T.empty()) {
    result.T_color_depth = rigid(T, "T_color_depth");
  }
  return result;
}

Calibration CalibrationReader::read() const {
  return reading([this] {
    const YAML::Node node = camera_node(load());
    Calibration result;
    result.camera = camera(node);
    for (const char* key : {"fps", "rate_hz"}) {
      if (const auto fps = number(node, key); fps && *fps > 0) result.fps = *fps;
    }
    if (const auto T = numbers(node, "T_BS"); T.size() == 16) result.T_bs = rigid(T, "T_BS");
    return result;
  });
}

DepthCalibration CalibrationReader::read_depth() const {
  return reading([this] { return depth(load()); });
}

// KITTI's rows begin with "P0:".
bool is_kitti_calibration(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string word;
  return stream >> word && word == "P0:";
}

}  // namespace

Camera read_kitti_calibration(const std::filesystem::path& file, const std::string& row,
                              const cv::Size& size) {
  for (const TextLine& line : read_text_lines(file, "the calibration file")) {
    if (line.fields[0] != row + ":") continue;
    std::vector<double> P;
    for (std::size_t i = 1; i < line.fields.size(); ++i) {
      if (const auto value = parse_number(line.fields[i])) P.push_back(*value);
    }
    if (P.size() != 12 || line.fields.size() != 13) {
      throw Error(Error::Kind::kInput, at_line(file, line.number) + ": " + row +
                                           " must be followed by twelve numbers, a 3x4 matrix");
    }
    return Camera(Camera::Model::kRadialTangential, size.width, size.height,
                  {P[0], P[5], P[2], P[6]});
  }
  throw Error(Error::Kind::kInput,
              file.string() + ": the row " + row +
                  ": is missing; take the calib.txt of the KITTI odometry set");
}

Calibration read_calibration_file(const std::filesystem::path& file, std::optional<cv::Size> size) {
  if (!is_kitti_calibration(file)) return CalibrationReader(file, size).read();
  if (!size) {
    throw Error(Error::Kind::kUsage, file.string() +
                                         ": KITTI calibrations do not say the size of the picture; "
                                         "give width and height");
  }
  return {read_kitti_calibration(file, "P0", *size), std::nullopt, std::nullopt};
}

DepthCalibration read_depth_calibration(const std::filesystem::path& file,
                                        std::optional<cv::Size> size) {
  if (is_kitti_calibration(file)) return {};
  return CalibrationReader(file, size).read_depth();
}

Camera read_calibration(const std::filesystem::path& file, std::optional<cv::Size> size) {
  return read_calibration_file(file, size).camera;
}

Camera parse_camera(const std::string& values, int width, int height) {
  const auto refuse = [&](const std::string& why) {
    throw Error(Error::Kind::kUsage, "--camera " + values + ": " + why +
                                         "; give fx,fy,cx,cy[,k1,k2,p1,p2[,k3]] in pixels");
  };
  std::vector<double> numbers;
  std::stringstream stream(values);
  for (std::string field; std::getline(stream, field, ',');) {
    const std::size_t begin = std::min(field.find_first_not_of(' '), field.size());
    field = field.substr(begin, field.find_last_not_of(' ') + 1 - begin);
    const auto value = parse_number(field);
    if (!value) refuse("\"" + field + "\" is not a finite number");
    numbers.push_back(*value);
  }
  if (numbers.size() != 4 && numbers.size() != 8 && numbers.size() != 9) {
    refuse(std::to_string(numbers.size()) + " values instead of 4, 8 or 9");
  }
  std::array<double, 5> distortion{};
  std::copy(numbers.begin() + 4, numbers.end(), distortion.begin());
  try {
    return Camera(Camera::Model::kRadialTangential, width, height,
                  {numbers[0], numbers[1], numbers[2], numbers[3]}, distortion);
  } catch (const Error& e) {
    throw Error(e.kind(), "--camera " + values + ": " + e.what());
  }
}

}  // namespace cairn

#include "cairn/datasets/groundtruth.h"

#include <algorithm>

#include "cairn/datasets/calibration.h"
#include "cairn/datasets/text_lines.h"
#include "cairn/geometry/error.h"

namespace cairn {
namespace {

constexpr const char* kWhat = "the trajectory file";

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(Error::Kind::kInput, sentence);
}

// `count` finite numbers from field `first` on.
std::vector<double> row_numbers(const std::filesystem::path& file, const TextLine& line,
                                std::size_t first, std::size_t count, const char* form) {
  if (line.fields.size() < first + count) {
    refuse(file.string() + ", line " + std::to_string(line.number) + ": " +
           std::to_string(line.fields.size()) + " values, but a row is \"" + form + "\"");
  }
  std::vector<double> values;
  for (std::size_t i = first; i < first + count; ++i) {
    const auto value = parse_number(line.fields[i]);
    if (!value) {
      refuse(file.string() + ", line " + std::to_string(line.number) + ": \"" + line.fields[i] +
             "\" is not a finite number; mend or remove this line");
    }
    values.push_back(*value);
  }
  return values;
}

SE3 checked_pose(const std::filesystem::path& file, const TextLine& line,
                 const Eigen::Quaterniond& q, const Eigen::Vector3d& t) {
  // Printed with few digits, a unit quaternion is off by a little; a zero one is no rotation.
  if (!(q.norm() > 0.5 && q.norm() < 2)) {
    refuse(file.string() + ", line " + std::to_string(line.number) +
           ": the quaternion is not of unit length; mend or remove this line");
  }
  return SE3(q, t);
}

Trajectory read_tum(const std::filesystem::path& file, const std::vector<TextLine>& lines) {
  Trajectory poses;
  for (const TextLine& line : lines) {
    const auto v = row_numbers(file, line, 0, 8, "timestamp tx ty tz qx qy qz qw");
    poses.push_back({v[0], checked_pose(file, line, Eigen::Quaterniond(v[7], v[4], v[5], v[6]),
                                        {v[1], v[2], v[3]})});
  }
  return poses;
}

std::filesystem::path kitti_times(const std::filesystem::path& file) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  const auto beside = folder / "times.txt";
  const auto sequence = folder.parent_path() / "sequences" / file.stem() / "times.txt";
  if (std::filesystem::exists(beside)) return beside;
  if (std::filesystem::exists(sequence)) return sequence;
  refuse(file.string() + ": KITTI poses have no timestamps, and neither " + beside.string() +
         " nor " + sequence.string() + " is there; put times.txt beside the poses");
}

Trajectory read_kitti(const std::filesystem::path& file, const std::vector<TextLine>& lines) {
  const auto times_file = kitti_times(file);
  const auto times = read_text_lines(times_file, "the list of timestamps");
  if (times.size() < lines.size()) {
    refuse(times_file.string() + ": " + std::to_string(times.size()) + " timestamps for the " +
           std::to_string(lines.size()) + " poses of " + file.string() +
           "; take both from the same sequence");
  }
  Trajectory poses;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto v = row_numbers(file, lines[i], 0, 12, "the 12 numbers of a 3x4 matrix");
    const auto t = row_numbers(times_file, times[i], 0, 1, "a timestamp in seconds");
    const Eigen::Matrix<double, 3, 4> M = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>(v.data());
    const Eigen::Matrix3d R = M.leftCols<3>();
    if (!((R * R.transpose()).isIdentity(1e-2) && R.determinant() > 0)) {
      refuse(file.string() + ", line " + std::to_string(lines[i].number) +
             ": the left 3x3 part is no rotation; mend or remove this line");
    }
    poses.push_back({t[0], SE3(R, M.col(3))});
  }
  return poses;
}

// Body to camera: the ground truth of EuRoC is that of its IMU.
SE3 camera_in_body(const std::filesystem::path& file) {
  const auto sensor =
      std::filesystem::absolute(file).parent_path().parent_path() / "cam0" / "sensor.yaml";
  if (!std::filesystem::exists(sensor)) return {};
  return read_calibration_file(sensor).T_bs.value_or(SE3());
}

Trajectory read_euroc(const std::filesystem::path& file, const std::vector<TextLine>& lines) {
  const SE3 T_bs = camera_in_body(file);
  Trajectory poses;
  for (const TextLine& line : lines) {
    constexpr const char* kForm = "timestamp [ns], x, y, z, qw, qx, qy, qz, ...";
    const auto stamp = parse_integer(line.fields[0]);
    if (!stamp) {
      refuse(file.string() + ", line " + std::to_string(line.number) + ": \"" + line.fields[0] +
             "\" is not a timestamp in whole nanoseconds; mend or remove this line");
    }
    const auto v = row_numbers(file, line, 1, 7, kForm);
    const SE3 T_wb =
        checked_pose(file, line, Eigen::Quaterniond(v[3], v[4], v[5], v[6]), {v[0], v[1], v[2]});
    poses.push_back({double(*stamp) * 1e-9, T_wb * T_bs});
  }
  return poses;
}

}  // namespace

Trajectory read_groundtruth(const std::filesystem::path& file, const std::string& layout) {
  const auto lines = read_text_lines(file, kWhat);
  if (lines.empty()) refuse(file.string() + ": the trajectory file holds no poses");
  Trajectory poses;
  if (layout == "euroc" || (layout == "auto" && file.extension() == ".csv")) {
    poses = read_euroc(file, lines);
  } else if (layout == "kitti" || (layout == "auto" && lines[0].fields.size() == 12)) {
    poses = read_kitti(file, lines);
  } else {
    poses = read_tum(file, lines);
  }
  std::stable_sort(poses.begin(), poses.end(), [](const StampedPose& a, const StampedPose& b) {
    return a.timestamp < b.timestamp;
  });
  const auto repeated = [](const StampedPose& a, const StampedPose& b) {
    return a.timestamp == b.timestamp;
  };
  poses.erase(std::unique(poses.begin(), poses.end(), repeated), poses.end());
  return poses;
}

}  // namespace cairn

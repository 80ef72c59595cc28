#include "sequence_folder.h"

#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cairn/geometry/error.h"
#include "cairn/output/atomic_file.h"
#include "cairn/synthetic/truth_json.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

constexpr double kFirstTimestamp = 1000;  // as a clock would give it, not zero
constexpr double kDepthScale = 5000;      // steps a metre, as in TUM's depth pictures

template <typename... Values>
std::string text(const char* format, Values... values) {
  char buffer[1024];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

void write_picture(const fs::path& path, const cv::Mat& picture) {
  std::vector<uchar> bytes;
  // The quickest compression: the pictures are noisy and hardly compress anyway.
  cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  file.close();
  if (!file) {
    throw Error(Error::Kind::kOutput,
                path.string() + ": this picture cannot be written; is the disk full?");
  }
}

cv::Mat depth_picture(const cv::Mat& metres) {
  cv::Mat steps;
  metres.convertTo(steps, CV_16U, kDepthScale);
  // What is too far away to be said is not measured.
  steps.setTo(0, metres > 65535 / kDepthScale);
  return steps;
}

cv::Mat normal_picture(const cv::Mat& normals) {
  cv::Mat bytes, bgr;
  normals.convertTo(bytes, CV_8UC3, 127.5, 127.5);
  cv::cvtColor(bytes, bgr, cv::COLOR_RGB2BGR);  // x in red
  return bgr;
}

}  // namespace

SequenceFolder::SequenceFolder(fs::path folder, SynthSensor sensor, const Camera& camera,
                               double fps, double baseline)
    : folder_(std::move(folder)),
      sensor_(sensor),
      camera_(camera),
      fps_(fps),
      baseline_(baseline),
      list_("# timestamp filename\n"),
      depth_list_("# timestamp filename (16 bit, 5000 a metre, 0: nothing)\n"),
      poses_("# timestamp tx ty tz qx qy qz qw (camera to world)\n") {
  const bool stereo = sensor == SynthSensor::kStereo;
  pictures_ = stereo ? folder_ / "sequences" / "00" : folder_;
  for (const char* list :
       {"rgb.txt", "depth.txt", "groundtruth.txt", "calibration.yaml", "world.json", "truth.jsonl",
        "perception.jsonl", "sequences/00/times.txt", "sequences/00/calib.txt", "poses/00.txt"}) {
    fs::remove(folder_ / list);
  }
  make_output_folder(pictures_ / (stereo ? "image_0" : "rgb"));
  if (stereo) make_output_folder(pictures_ / "image_1");
  if (stereo) make_output_folder(folder_ / "poses");
  if (sensor == SynthSensor::kRgbd) make_output_folder(folder_ / "depth");
}

double SequenceFolder::timestamp(int frame) const {
  return (sensor_ == SynthSensor::kStereo ? 0 : kFirstTimestamp) + frame / fps_;
}

std::string SequenceFolder::frame_name(int frame) const {
  return sensor_ == SynthSensor::kStereo ? text("%06d.png", frame)
                                         : text("%.6f.png", timestamp(frame));
}

void SequenceFolder::add(const SE3& T_wc, const cv::Mat& picture, const cv::Mat& right,
                         const cv::Mat& depth) {
  const std::string name = frame_name(frames_), time = text("%.6f", timestamp(frames_));
  if (sensor_ == SynthSensor::kStereo) {
    for (const auto& [folder, eye] : {std::pair("image_0", picture), std::pair("image_1", right)}) {
      cv::Mat grey;
      cv::cvtColor(eye, grey, cv::COLOR_BGR2GRAY);
      write_picture(pictures_ / folder / name, grey);
    }
  } else {
    write_picture(pictures_ / "rgb" / name, picture);
  }
  if (sensor_ == SynthSensor::kRgbd) {
    write_picture(folder_ / "depth" / name, depth_picture(depth));
    depth_list_ += time + " depth/" + name + "\n";
  }
  list_ += time + " rgb/" + name + "\n";
  times_ += text("%.6e\n", timestamp(frames_));
  const auto& t = T_wc.translation();
  const auto& q = T_wc.rotation();
  poses_ += text("%s %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", time.c_str(), t.x(), t.y(), t.z(),
                 q.x(), q.y(), q.z(), q.w());
  if (frames_ == 0) first_ = T_wc;
  const Eigen::Matrix4d T = (first_.inverse() * T_wc).matrix();
  for (int i = 0; i < 12; ++i) {
    kitti_poses_ += text(i < 11 ? "%.9e " : "%.9e\n", T(i / 4, i % 4));
  }
  ++frames_;
}

void SequenceFolder::add_truth(const FrameTruth& truth, const Scene& scene) {
  if (!with_truth_) {
    for (const char* name : {"depth", "normals", "labels", "instances"}) {
      make_output_folder(folder_ / name);
    }
    with_truth_ = true;
  }
  const int last = frames_ - 1;
  const std::string name = frame_name(last);
  truth_ += frame_json(timestamp(last), truth, scene) + "\n";
  if (sensor_ != SynthSensor::kRgbd) {
    write_picture(folder_ / "depth" / name, depth_picture(truth.depth));
  }
  write_picture(folder_ / "normals" / name, normal_picture(truth.normals));
  write_picture(folder_ / "labels" / name, truth.labels);
  write_picture(folder_ / "instances" / name, truth.instances);
}

void SequenceFolder::finish_tum() {
  const Pinhole& p = camera_.pinhole();
  const auto& d = camera_.distortion();
  write_file(folder_ / "calibration.yaml",
             text("color:\n  model: pinhole\n  width: %d\n  height: %d\n  fps: %g\n  fx: %.6f\n"
                  "  fy: %.6f\n  cx: %.6f\n  cy: %.6f\n"
                  "  distortion: [%g, %g, %g, %g, %g]   # k1 k2 p1 p2 k3\n",
                  camera_.width(), camera_.height(), fps_, p.fx, p.fy, p.cx, p.cy, d[0], d[1], d[2],
                  d[3], d[4]));
  if (sensor_ == SynthSensor::kRgbd) write_file(folder_ / "depth.txt", depth_list_);
  write_file(folder_ / "rgb.txt", list_);
}

void SequenceFolder::finish_kitti() {
  const Pinhole& p = camera_.pinhole();
  std::string calibration;
  for (int i = 0; i < 4; ++i) {  // odd ones are on the right
    calibration += text("P%d: %.9e 0 %.9e %.9e 0 %.9e %.9e 0 0 0 1 0\n", i, p.fx, p.cx,
                        i % 2 == 0 ? 0.0 : -p.fx * baseline_, p.fy, p.cy);
  }
  write_file(pictures_ / "calib.txt", calibration);
  write_file(folder_ / "poses" / "00.txt", kitti_poses_);
  write_file(pictures_ / "times.txt", times_);
}

void SequenceFolder::finish(const std::string& world_json) {
  write_file(folder_ / "groundtruth.txt", poses_);
  if (with_truth_) write_file(folder_ / "truth.jsonl", truth_);
  if (!detections_.empty()) write_file(folder_ / "perception.jsonl", detections_);
  write_file(folder_ / "world.json", world_json);
  sensor_ == SynthSensor::kStereo ? finish_kitti() : finish_tum();
}

}  // namespace cairn::app

#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cairn/geometry/camera.h"
#include "cairn/perception/organized_cloud.h"

namespace cairn::testing {

/// A lens that bends lines by tens of pixels: what ignores it is seen.
inline const Camera kRoomCamera(Camera::Model::kRadialTangential, 640, 480,
                                {450, 450, 319.5, 239.5}, {-0.2, 0.05, 0.001, -0.001, 0});

/// An empty room seen from inside: exact depth and which plane is where.
struct RoomMaps {
  std::vector<Eigen::Vector4d> planes;  ///< camera frame, towards the camera
  cv::Mat_<float> depth;                ///< metres along the optical axis
  cv::Mat_<uchar> owner;                ///< index into `planes` plus one

  /// A room with walls at both sides and behind, a floor and a ceiling, times `scale`.
  explicit RoomMaps(const cv::Mat_<cv::Vec3f>& rays, double scale = 1)
      : depth(rays.size(), 0.f), owner(rays.size(), uchar(0)) {
    const Eigen::Matrix3d R = (Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitX()) *
                               Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()))
                                  .toRotationMatrix();
    for (const Eigen::Vector4d& world :
         {Eigen::Vector4d(0, 0, -1, 5), Eigen::Vector4d(1, 0, 0, 1.8), Eigen::Vector4d(-1, 0, 0, 2),
          Eigen::Vector4d(0, -1, 0, 1.3), Eigen::Vector4d(0, 1, 0, 1.2)}) {
      Eigen::Vector4d plane;
      plane << R * world.head<3>(), scale * world[3];
      planes.push_back(plane);
    }
    for (int v = 0; v < rays.rows; ++v) {
      for (int u = 0; u < rays.cols; ++u) {
        const Eigen::Vector3d ray(rays(v, u)[0], rays(v, u)[1], rays(v, u)[2]);
        double nearest = 0;  // of 1/z
        for (std::size_t i = 0; i < planes.size(); ++i) {
          const double w = -planes[i].head<3>().dot(ray) / planes[i][3];
          if (w > nearest) nearest = w, owner(v, u) = uchar(i + 1);
        }
        if (nearest > 0) depth(v, u) = float(1 / nearest);
      }
    }
  }
};

inline double angle_deg(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  return std::acos(std::min(1.0, a.head<3>().dot(b.head<3>()))) * 180 / M_PI;
}

/// The room's plane that this one is nearest to in angle.
inline std::size_t nearest_plane(const RoomMaps& room, const Eigen::Vector4d& plane) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < room.planes.size(); ++i) {
    if (angle_deg(room.planes[i], plane) < angle_deg(room.planes[best], plane)) best = i;
  }
  return best;
}

}  // namespace cairn::testing

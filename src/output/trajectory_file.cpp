#include "cairn/output/trajectory_file.h"

#include <cassert>

#include "cairn/output/atomic_file.h"
#include "cairn/output/number_text.h"

namespace cairn {

void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::string text;
  for (const auto& [timestamp, T_wc] : trajectory) {
    assert(T_wc.is_finite());
    Eigen::Vector4d q = T_wc.rotation().coeffs();  // x y z w
    if (q.w() < 0) q = -q;
    const Eigen::Vector3d& t = T_wc.translation();
    text += time_text(timestamp);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += ' ' + exact_text(value + 0.0);  // no negative zero
    }
    text += '\n';
  }
  write_file(file, text);
}

}  // namespace cairn

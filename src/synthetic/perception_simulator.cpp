#include "cairn/synthetic/perception_simulator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cairn/synthetic/dense_noise.h"

namespace cairn {
namespace {

const cv::Size kCoarseDepth(80, 60);
constexpr double kLeastSigma = 1e-3;

// First parts of keys: what a random number is for.
enum Purpose : std::uint64_t {
  kThing,
  kLasting,
  kFlicker,
  kEdge,
  kTail,
  kClass,
  kDuplicate,
  kAlarm,
  kMask,
  kPlane,
  kDense,
};

double logistic(double z) { return 1 / (1 + std::exp(-z)); }

double size_of(const Box2& box) { return std::sqrt((box.x1 - box.x0) * (box.y1 - box.y0)); }

Box2 clipped(const Box2& box, const cv::Size& size) {
  const double right = size.width - 0.5, bottom = size.height - 0.5;
  return {std::clamp(box.x0, -0.5, right), std::clamp(box.y0, -0.5, bottom),
          std::clamp(box.x1, -0.5, right), std::clamp(box.y1, -0.5, bottom)};
}

bool has_area(const Box2& box) { return box.x1 - box.x0 > 1 && box.y1 - box.y0 > 1; }

// One of `count`, by a number in [0, 1).
std::size_t chosen(double uniform, std::size_t count) {
  return std::min(count - 1, std::size_t(uniform * double(count)));
}

// The box with one edge (left, top, right, bottom) moved in until this share of it is left.
Box2 part_of(const Box2& box, std::size_t edge, double share) {
  const double width = share * (box.x1 - box.x0), height = share * (box.y1 - box.y0);
  Box2 part = box;
  if (edge == 0) part.x0 = box.x1 - width;
  if (edge == 1) part.y0 = box.y1 - height;
  if (edge == 2) part.x1 = box.x0 + width;
  if (edge == 3) part.y1 = box.y0 + height;
  return part;
}

// The part of a mask that lies in a box.
cv::Mat inside(const cv::Mat& mask, const Box2& box) {
  cv::Mat part(mask.size(), CV_8U, cv::Scalar(0));
  const cv::Point first(int(std::ceil(box.x0)), int(std::ceil(box.y0)));
  const cv::Point behind_last(int(std::floor(box.x1)) + 1, int(std::floor(box.y1)) + 1);
  const cv::Rect pixels = cv::Rect(first, behind_last) & cv::Rect({}, mask.size());
  mask(pixels).copyTo(part(pixels));
  return part;
}

cv::Mat mask_of(const cv::Mat& indices, int index) { return indices == index + 1; }

}  // namespace

struct PerceptionSimulator::Picture {
  const FrameTruth& truth;
  double time;
  bool masks;
  cv::Size size;

  std::int64_t tick() const { return HashedNoise::tick(time); }
};

PerceptionSimulator::PerceptionSimulator(const Scene& scene, const Camera& camera,
                                         const PerceptionNoise& noise, std::uint64_t seed)
    : camera_(camera), noise_(noise), source_(seed) {
  for (const WorldThing& thing : scene.things) classes_.push_back(thing.model.class_name);
  for (const WorldPlane& plane : scene.planes) plane_labels_.push_back(plane.label);
}

DetectedFrame PerceptionSimulator::detect(const FrameTruth& truth, double timestamp,
                                          bool masks) const {
  const Picture picture = {truth, timestamp, masks, truth.instances.size()};
  DetectedFrame frame;
  frame.timestamp = timestamp;
  for (const ObjectView& view : truth.objects) detect_object(picture, view, frame.objects);
  add_false_alarms(picture, frame.objects);
  std::stable_sort(
      frame.objects.begin(), frame.objects.end(),
      [](const DetectedObject& a, const DetectedObject& b) { return a.score > b.score; });
  for (const PlaneView& view : truth.visible_planes) detect_plane(picture, view, frame.planes);
  // The scale of depth and planes is one, and, as with a calibrated network, right on average.
  const HashedNoise dense = source_.of({kDense, 0});
  const double scale = std::exp(log_scale_error(noise_.depth, dense, timestamp));
  for (DetectedPlane& plane : frame.planes) plane.plane[3] *= scale;
  cv::Mat coarse;
  cv::resize(truth.depth, coarse, kCoarseDepth, 0, 0, cv::INTER_NEAREST);
  frame.depth = noisy_depth(coarse, noise_.depth, dense, timestamp) / noise_.depth.scale;
  frame.sigma_scale = noise_.depth.scale_spread;
  return frame;
}

cv::Mat PerceptionSimulator::depth(const FrameTruth& truth, double timestamp) const {
  return noisy_depth(truth.depth, noise_.depth, source_.of({kDense, 0}), timestamp);
}

cv::Mat PerceptionSimulator::normals(const FrameTruth& truth, double timestamp) const {
  return noisy_normals(truth.normals, noise_.normals, source_.of({kDense, 1}), timestamp);
}

void PerceptionSimulator::detect_object(const Picture& picture, const ObjectView& view,
                                        std::vector<DetectedObject>& found) const {
  const double z = confidence(picture, view, view.visible_box);
  const double score = logistic(z);
  if (score < noise_.scores.threshold) return;
  DetectedObject object;
  object.box = noisy_box(picture, view, z);
  if (!has_area(object.box)) return;
  object.class_name = noisy_class(picture, view.thing);
  object.score = score;
  object.thing = view.thing;
  if (picture.masks) {
    object.mask = ragged_mask(mask_of(picture.truth.instances, view.thing), noise_.masks,
                              source_.of({kMask, 0, std::uint64_t(view.thing)}), picture.time);
  }
  found.push_back(object);
  add_duplicate(picture, object, found);
}

double PerceptionSimulator::confidence(const Picture& picture, const ObjectView& view,
                                       const Box2& box) const {
  const PerceptionNoise::Scores& n = noise_.scores;
  // Pictures of any size are looked at through networks of one input size.
  const double pixels = size_of(box) * 640 / picture.size.width;
  const auto thing = std::uint64_t(view.thing);
  const auto known = n.usual_px.find(classes_[view.thing]);
  const double usual = known == n.usual_px.end() ? n.usual_px_else : known->second;
  return n.at_usual_size + n.per_log_size * std::min(0.0, std::log(std::max(1.0, pixels) / usual)) +
         n.per_hidden * (1 - view.visible) + (view.truncated ? n.truncated : 0) +
         n.per_thing * source_.of({kThing, thing}).normal() +
         n.lasting * source_.of({kLasting, thing}).correlated(picture.time, n.seconds) +
         n.flicker * source_.of({kFlicker, thing}).normal(picture.tick());
}

Box2 PerceptionSimulator::noisy_box(const Picture& picture, const ObjectView& view,
                                    double z) const {
  const PerceptionNoise::Boxes& n = noise_.boxes;
  const Box2& seen = view.visible_box;
  const Box2 whole = clipped(view.amodal_box, picture.size);
  const auto towards = [&](double from, double to) { return from + n.amodal_share * (to - from); };
  std::array<double, 4> edges = {towards(seen.x0, whole.x0), towards(seen.y0, whole.y0),
                                 towards(seen.x1, whole.x1), towards(seen.y1, whole.y1)};
  const std::array<double, 2> extent = {edges[2] - edges[0], edges[3] - edges[1]};
  const std::array<double, 4> border = {-0.5, -0.5, picture.size.width - 0.5,
                                        picture.size.height - 0.5};
  const double floor = n.floor_px * picture.size.width / 640;
  const double quality = std::exp(-n.per_score * (z - noise_.scores.at_usual_size));
  for (std::uint64_t i = 0; i < 4; ++i) {
    const auto thing = std::uint64_t(view.thing);
    const bool cut = std::abs(edges[i] - border[i]) < 1;
    const double tail =
        source_.of({kTail, thing, i}).uniform(picture.tick()) < n.tail_share ? n.tail_factor : 1;
    const double lasting = n.lasting * extent[i % 2] *
                           source_.of({kEdge, thing, i, 0}).correlated(picture.time, n.seconds);
    const double flicker = tail * std::hypot(n.flicker * extent[i % 2], floor) *
                           source_.of({kEdge, thing, i, 1}).normal(picture.tick());
    edges[i] += (cut ? n.cut_factor : 1) * quality * (lasting + flicker);
  }
  return clipped({edges[0], edges[1], edges[2], edges[3]}, picture.size);
}

const std::vector<std::string>* PerceptionSimulator::family_of(
    const std::string& class_name) const {
  for (const std::vector<std::string>& family : noise_.classes.families) {
    if (std::find(family.begin(), family.end(), class_name) != family.end()) return &family;
  }
  return nullptr;
}

std::string PerceptionSimulator::noisy_class(const Picture& picture, int thing) const {
  const PerceptionNoise::Classes& n = noise_.classes;
  const std::string& name = classes_[thing];
  const HashedNoise source = source_.of({kClass, std::uint64_t(thing)});
  const double luck = source.of({0}).correlated_uniform(picture.time, n.seconds);
  if (!(luck < n.wrong)) return name;
  const std::vector<std::string>* family = family_of(name);
  const bool within = family && luck < n.wrong * n.within_family;
  std::vector<std::string> others;
  for (const std::string& other : within ? *family : n.any) {
    if (other != name) others.push_back(other);
  }
  if (others.empty()) return name;
  const double which = source.of({1}).correlated_uniform(picture.time, n.seconds);
  return others[chosen(which, others.size())];
}

// Networks suppress boxes of one class that overlap by more than half; what passes is a part of the
// thing, or the same box as another class of the family.
void PerceptionSimulator::add_duplicate(const Picture& picture, const DetectedObject& object,
                                        std::vector<DetectedObject>& found) const {
  const PerceptionNoise::Duplicates& n = noise_.duplicates;
  const HashedNoise source = source_.of({kDuplicate, std::uint64_t(*object.thing)});
  if (!(source.of({0}).correlated_uniform(picture.time, n.seconds) < n.share)) return;
  DetectedObject second = object;
  second.score = n.score_factor * object.score;
  if (second.score < noise_.scores.threshold) return;
  const std::vector<std::string>* family = family_of(object.class_name);
  if (family && family->size() > 1 && source.of({1}).uniform() < 0.5) {
    const auto own = std::find(family->begin(), family->end(), object.class_name);
    second.class_name = own + 1 == family->end() ? family->front() : *(own + 1);
  }
  if (second.class_name == object.class_name) {
    second.box = part_of(object.box, chosen(source.of({2}).uniform(), 4),
                         0.35 + 0.1 * source.of({3}).uniform());
    if (!second.mask.empty()) second.mask = inside(second.mask, second.box);
  }
  found.push_back(second);
}

// Alarms are born at every tick and live for a while; those that live now are looked up. What is
// expected at one time is per_picture: births a tick times mean life in ticks. Births happen in
// slots, each of which has one alarm a tick at most.
void PerceptionSimulator::add_false_alarms(const Picture& picture,
                                           std::vector<DetectedObject>& found) const {
  const PerceptionNoise::FalseAlarms& n = noise_.false_alarms;
  if (!(n.per_picture > 0) || n.classes.empty()) return;
  const double survival = n.seconds > 0 ? std::exp(-HashedNoise::kTick / n.seconds) : 0;
  const double births = n.per_picture * (1 - survival);
  const auto slots = std::uint64_t(std::ceil(births / 0.1));
  const auto oldest = std::int64_t(survival > 0 ? std::log(1e-3) / std::log(survival) : 0);
  for (std::int64_t age = 0; age <= oldest; ++age) {
    for (std::uint64_t slot = 0; slot < slots; ++slot) {
      const HashedNoise alarm = source_.of({kAlarm, slot, std::uint64_t(picture.tick() - age)});
      if (!(alarm.uniform(0) < births / double(slots))) continue;
      if (alarm.uniform(1) < std::pow(survival, double(age)))
        add_false_alarm(alarm, picture, found);
    }
  }
}

void PerceptionSimulator::add_false_alarm(const HashedNoise& alarm, const Picture& picture,
                                          std::vector<DetectedObject>& found) const {
  const PerceptionNoise::FalseAlarms& n = noise_.false_alarms;
  const cv::Size& size = picture.size;
  const double side = n.size_px * size.width / 640 * std::exp(n.size_log_spread * alarm.normal(2));
  const double aspect = std::exp(0.4 * alarm.normal(3));  // of width to height, squared: a guess
  const double x = alarm.uniform(4) * size.width, y = alarm.uniform(5) * size.height;
  DetectedObject object;
  object.box = clipped(
      {x - side * aspect / 2, y - side / aspect / 2, x + side * aspect / 2, y + side / aspect / 2},
      size);
  if (!has_area(object.box)) return;
  object.class_name = n.classes[chosen(alarm.uniform(6), n.classes.size())];
  object.score =
      std::min(0.99, noise_.scores.threshold - n.score_above * std::log(1 - alarm.uniform(7)));
  found.push_back(object);
}

// The plane turns about the point where the ray through the middle of its pixels meets it, and that
// point moves along the ray.
Eigen::Vector4d PerceptionSimulator::noisy_plane(const PlaneView& view, const cv::Mat& mask,
                                                 double time) const {
  const PerceptionNoise::Planes& n = noise_.planes;
  const HashedNoise source = source_.of({kPlane, std::uint64_t(view.plane), 0});
  const auto lasting = [&](std::uint64_t what) {
    return source.of({what}).correlated(time, n.seconds);
  };
  if (n.angle_deg <= 0 && n.offset <= 0) return view.parameters;
  const Eigen::Vector3d normal = view.parameters.head<3>();
  const cv::Moments moments = cv::moments(mask, true);
  if (!(moments.m00 > 0)) return view.parameters;
  const Eigen::Vector3d ray =
      camera_.unproject({moments.m10 / moments.m00, moments.m01 / moments.m00});
  const double along = normal.dot(ray);
  if (!(std::abs(along) > 1e-6)) return view.parameters;
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const double sigma = n.angle_deg * M_PI / 180;
  const Eigen::Vector3d turned = so3_exp(sigma * (lasting(0) * u + lasting(1) * v)) * normal;
  const Eigen::Vector3d middle =
      -view.parameters[3] / along * std::exp(n.offset * lasting(2)) * ray;
  Eigen::Vector4d plane;
  plane << turned, -turned.dot(middle);
  return plane;
}

void PerceptionSimulator::detect_plane(const Picture& picture, const PlaneView& view,
                                       std::vector<DetectedPlane>& found) const {
  const PerceptionNoise::Planes& n = noise_.planes;
  const double share = view.pixels / double(picture.size.area());
  if (share < n.min_share) return;
  const HashedNoise source = source_.of({kPlane, std::uint64_t(view.plane), 1});
  // Half as large, twice as often missed.
  const double missed = std::min(1.0, n.missed * 0.1 / share);
  const double luck = source.of({0}).correlated_uniform(picture.time, n.seconds);
  if (luck < missed) return;
  DetectedPlane plane;
  plane.truth = view.plane;
  plane.label = plane_labels_[view.plane];
  if (source.of({1}).correlated_uniform(picture.time, n.label_seconds) < n.wrong_label) {
    plane.label =
        plane_labels_[chosen(source.of({2}).uniform(picture.tick()), plane_labels_.size())];
  }
  plane.score = missed > 0 ? 0.5 + 0.5 * (luck - missed) / (1 - missed) : 1;
  const cv::Mat mask = mask_of(picture.truth.planes, view.plane);
  plane.plane = noisy_plane(view, mask, picture.time);
  plane.sigma_angle = std::max(n.angle_deg * M_PI / 180, kLeastSigma);
  plane.sigma_depth = std::max(n.offset, kLeastSigma);
  if (picture.masks) {
    plane.mask = ragged_mask(mask, noise_.masks, source_.of({kMask, 1, std::uint64_t(view.plane)}),
                             picture.time);
  }
  found.push_back(plane);
}

}  // namespace cairn

#include "cairn/synthetic/perception_simulator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cairn/perception/recorded_perception.h"
#include "perception_picture.h"

namespace cairn {
namespace {

using testing::kPerceptionCamera;
using testing::PerceptionPicture;

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / double(values.size());
}

double deviation(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / double(values.size()));
}

double iou(const Box2& a, const Box2& b) {
  const double w = std::max(0.0, std::min(a.x1, b.x1) - std::max(a.x0, b.x0));
  const double h = std::max(0.0, std::min(a.y1, b.y1) - std::max(a.y0, b.y0));
  const auto area = [](const Box2& box) { return (box.x1 - box.x0) * (box.y1 - box.y0); };
  return w * h / (area(a) + area(b) - w * h);
}

// The i-th of times that are so far apart that nothing is correlated.
double apart(int i) { return 100.0 * i; }

TEST(HashedNoise, HasTheCorrelationThatIsAskedFor) {
  const HashedNoise source(3);
  std::vector<double> squares, products;
  for (int i = 0; i < 20'000; ++i) {
    const HashedNoise one = source.of({std::uint64_t(i)});
    const double a = one.correlated(50, 0.5), b = one.correlated(50.5, 0.5);
    squares.push_back(a * a);
    products.push_back(a * b);
  }
  EXPECT_NEAR(mean(squares), 1, 0.04);
  EXPECT_NEAR(mean(products), std::exp(-1), 0.03);
}

TEST(HashedNoise, IsUniformAndNormalAndOfItsKeyAlone) {
  const HashedNoise source(4);
  std::vector<double> uniform, normal;
  for (int i = 0; i < 20'000; ++i) {
    uniform.push_back(source.of({7}).uniform(i));
    normal.push_back(source.of({8}).normal(i));
  }
  EXPECT_NEAR(mean(uniform), 0.5, 0.01);
  EXPECT_NEAR(mean(normal), 0, 0.03);
  EXPECT_NEAR(deviation(normal), 1, 0.02);
  EXPECT_EQ(HashedNoise(4).of({1, 2}).normal(5), source.of({1, 2}).normal(5));
  EXPECT_NE(source.of({1, 2}).normal(5), source.of({2, 1}).normal(5));
  EXPECT_NE(HashedNoise(5).normal(), HashedNoise(4).normal());
}

TEST(PerceptionSimulator, GivesTheTruthWithoutNoise) {
  PerceptionPicture picture;
  picture.add("cup", {100, 100, 40, 50}).add("laptop", {300, 0, 200, 150}, 0.3);
  const auto simulator = picture.simulator(PerceptionNoise::none());
  for (const double time : {0.0, 1.7}) {
    const DetectedFrame frame = simulator.detect(picture.truth(), time);
    EXPECT_EQ(frame.timestamp, time);
    ASSERT_EQ(frame.objects.size(), 2u);
    for (int i = 0; i < 2; ++i) {
      const DetectedObject& object = frame.objects[i];
      const ObjectView& view = picture.truth().objects[i];
      EXPECT_EQ(object.score, 1);
      EXPECT_EQ(object.thing, i);
      EXPECT_EQ(object.class_name, i == 0 ? "cup" : "laptop");
      EXPECT_EQ(object.box.x0, view.visible_box.x0);
      EXPECT_EQ(object.box.y0, view.visible_box.y0);
      EXPECT_EQ(object.box.x1, view.visible_box.x1);
      EXPECT_EQ(object.box.y1, view.visible_box.y1);
      EXPECT_TRUE(same(object.mask, picture.truth().instances == i + 1));
    }
    ASSERT_EQ(frame.planes.size(), 1u);
    EXPECT_EQ(frame.planes[0].plane, Eigen::Vector4d(0, 0, -1, 2));
    EXPECT_EQ(frame.planes[0].label, "wall");
    EXPECT_EQ(frame.planes[0].score, 1);
    EXPECT_LT(cv::norm(simulator.depth(picture.truth(), time), picture.truth().depth, cv::NORM_INF),
              1e-5);
    EXPECT_TRUE(same(simulator.normals(picture.truth(), time), picture.truth().normals));
  }
}

TEST(PerceptionSimulator, SaysTheSameForOneSeedInAnyOrderOfPictures) {
  PerceptionPicture picture;
  for (int i = 0; i < 8; ++i) picture.add("cup", {20 + 70 * i, 100, 60, 60});
  const auto first = picture.simulator({}, 5), second = picture.simulator({}, 5);
  const auto other = picture.simulator({}, 6);
  std::vector<std::string> forward, backward, different;
  for (int i = 0; i < 10; ++i) {
    forward.push_back(to_json_line(first.detect(picture.truth(), i / 30.0)));
    backward.push_back(to_json_line(second.detect(picture.truth(), (9 - i) / 30.0)));
    different.push_back(to_json_line(other.detect(picture.truth(), i / 30.0)));
  }
  std::reverse(backward.begin(), backward.end());
  EXPECT_EQ(forward, backward);
  EXPECT_NE(forward, different);
  EXPECT_TRUE(same(first.depth(picture.truth(), 0.3), second.depth(picture.truth(), 0.3)));
  EXPECT_FALSE(same(first.depth(picture.truth(), 0.3), other.depth(picture.truth(), 0.3)));
}

TEST(PerceptionSimulator, MovesEdgesByTheSharesThatAreAskedFor) {
  PerceptionPicture picture;
  picture.add("cup", {200, 100, 200, 100});
  PerceptionNoise noise = PerceptionNoise::none();
  noise.boxes.lasting = 0.03;
  noise.boxes.seconds = 0.5;
  noise.boxes.flicker = 0.01;
  noise.boxes.floor_px = 1;
  const auto simulator = picture.simulator(noise);
  const Box2& truth = picture.truth().objects[0].visible_box;
  std::vector<double> left, bottom, later;
  for (int i = 0; i < 4000; ++i) {
    const Box2 box = simulator.detect(picture.truth(), apart(i), false).objects[0].box;
    const Box2 next = simulator.detect(picture.truth(), apart(i) + 0.5, false).objects[0].box;
    left.push_back(box.x0 - truth.x0);
    bottom.push_back(box.y1 - truth.y1);
    later.push_back((box.x0 - truth.x0) * (next.x0 - truth.x0));
  }
  EXPECT_NEAR(mean(left), 0, 0.4);
  EXPECT_NEAR(deviation(left), std::sqrt(6 * 6 + 2 * 2 + 1), 0.3);
  EXPECT_NEAR(deviation(bottom), std::sqrt(3 * 3 + 1 + 1), 0.15);
  EXPECT_NEAR(mean(later), 36 * std::exp(-1), 2.5);  // the flicker is another
}

TEST(PerceptionSimulator, GivesEdgesHeavyTails) {
  PerceptionPicture picture;
  picture.add("cup", {200, 100, 200, 200});
  PerceptionNoise noise = PerceptionNoise::none();
  noise.boxes.flicker = 0.005;
  noise.boxes.tail_share = 0.1;
  noise.boxes.tail_factor = 5;
  const auto simulator = picture.simulator(noise);
  int beyond = 0;
  for (int i = 0; i < 5000; ++i) {
    const Box2 box = simulator.detect(picture.truth(), apart(i), false).objects[0].box;
    beyond += std::abs(box.x0 - 199.5) > 3;  // three sigma; 0.55 of a tail of five
  }
  EXPECT_NEAR(beyond / 5000.0, 0.9 * 0.0027 + 0.1 * 0.5485, 0.012);
}

TEST(PerceptionSimulator, KeepsBoxesInThePictureAndCutEdgesNearItsBorder) {
  PerceptionPicture picture;
  picture.add("chair", {500, 300, 140, 180});
  PerceptionNoise noise = PerceptionNoise::none();
  noise.boxes.flicker = 0.05;
  const auto simulator = picture.simulator(noise);
  int at_border = 0;
  for (int i = 0; i < 2000; ++i) {
    const Box2 box = simulator.detect(picture.truth(), apart(i), false).objects[0].box;
    ASSERT_LE(box.x1, 639.5);
    ASSERT_LE(box.y1, 479.5);
    at_border += box.x1 == 639.5;
  }
  EXPECT_NEAR(at_border / 2000.0, 0.5, 0.05);
}

TEST(PerceptionSimulator, MissesThingsThatAreSmallOrHiddenMoreOften) {
  PerceptionPicture picture;
  picture.add("cup", {0, 10, 100, 100})
      .add("cup", {150, 0, 50, 50})
      .add("cup", {300, 0, 100, 100}, 0.5)
      .add("cup", {420, 100, 200, 200});
  PerceptionNoise noise = PerceptionNoise::none();
  noise.scores.threshold = 0.5;
  noise.scores.at_usual_size = 0.5;
  noise.scores.per_log_size = 1;
  noise.scores.per_hidden = -2;
  noise.scores.lasting = 0.8;
  noise.scores.seconds = 1;
  noise.scores.flicker = 0.6;
  noise.scores.usual_px = {{"cup", 100}};
  const auto simulator = picture.simulator(noise);
  std::array<int, 4> seen{};
  for (int i = 0; i < 4000; ++i) {
    for (const DetectedObject& object :
         simulator.detect(picture.truth(), apart(i), false).objects) {
      ++seen[*object.thing];
    }
  }
  // z is normal with variance 1: it is above 0 with the probability of its mean.
  const auto share = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  EXPECT_NEAR(seen[0] / 4000.0, share(0.5), 0.025);
  EXPECT_NEAR(seen[1] / 4000.0, share(0.5 - std::log(2)), 0.025);
  EXPECT_NEAR(seen[2] / 4000.0, share(0.5 - 1), 0.025);
  EXPECT_NEAR(seen[3] / 4000.0, share(0.5), 0.025);  // larger than usual is no surer
}

TEST(PerceptionSimulator, MissesWhatItJustMissed) {
  PerceptionPicture picture;
  for (int i = 0; i < 6; ++i) picture.add("cup", {100 * i + 10, 100, 80, 80});
  PerceptionNoise noise = PerceptionNoise::none();
  noise.scores.threshold = 0.5;
  noise.scores.at_usual_size = 0.8;
  noise.scores.lasting = 1;
  noise.scores.seconds = 1;
  const auto simulator = picture.simulator(noise);
  int missed = 0, again = 0, looks = 0;
  for (int i = 0; i < 500; ++i) {
    std::array<std::set<int>, 2> seen;
    for (int k = 0; k < 2; ++k) {
      for (const auto& object :
           simulator.detect(picture.truth(), apart(i) + k / 30.0, false).objects) {
        seen[k].insert(*object.thing);
      }
    }
    for (int thing = 0; thing < 6; ++thing, ++looks) {
      missed += !seen[0].count(thing);
      again += !seen[0].count(thing) && !seen[1].count(thing);
    }
  }
  EXPECT_NEAR(missed / double(looks), 0.212, 0.03);  // of a normal number below −0.8
  EXPECT_GT(again / double(missed), 0.75);           // correlation 0.967
}

TEST(PerceptionSimulator, GivesBetterBoxesHigherScores) {
  PerceptionPicture picture;
  picture.add("cup", {200, 100, 100, 100});
  const auto simulator = picture.simulator({});
  std::vector<std::pair<double, double>> pairs;
  for (int i = 0; i < 3000; ++i) {
    for (const DetectedObject& object :
         simulator.detect(picture.truth(), apart(i), false).objects) {
      if (object.thing != 0) continue;
      pairs.push_back({object.score, iou(object.box, picture.truth().objects[0].visible_box)});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<double> poor, good;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    (i < pairs.size() / 3 ? poor : good).push_back(pairs[i].second);
  }
  EXPECT_GT(mean(good), mean(poor) + 0.01);
  EXPECT_GT(mean(poor), 0.7);
}

TEST(PerceptionSimulator, TakesThingsForOthersMostlyOfTheirFamily) {
  PerceptionPicture picture;
  picture.add("cup", {200, 100, 100, 100}).add("keyboard", {400, 100, 100, 100});
  PerceptionNoise noise = PerceptionNoise::none();
  noise.classes.wrong = 0.2;
  noise.classes.within_family = 0.75;
  noise.classes.seconds = 0.2;
  const auto simulator = picture.simulator(noise);
  int wrong = 0, family = 0, keyboard = 0;
  for (int i = 0; i < 4000; ++i) {
    for (const DetectedObject& object :
         simulator.detect(picture.truth(), apart(i), false).objects) {
      if (*object.thing == 1) {
        keyboard += object.class_name != "keyboard";
      } else if (object.class_name != "cup") {
        ++wrong;
        family += object.class_name == "bowl" || object.class_name == "vase" ||
                  object.class_name == "wine glass";
      }
    }
  }
  EXPECT_NEAR(wrong / 4000.0, 0.2, 0.025);
  EXPECT_NEAR(family / double(wrong), 0.75, 0.05);
  EXPECT_NEAR(keyboard / 4000.0, 0.2, 0.025);
}

TEST(PerceptionSimulator, RaisesFalseAlarmsThatStayForAWhile) {
  const PerceptionPicture picture;
  PerceptionNoise noise = PerceptionNoise::none();
  noise.scores.threshold = 0.3;
  noise.false_alarms.per_picture = 0.6;
  noise.false_alarms.seconds = 0.2;
  const auto simulator = picture.simulator(noise);
  int alarms = 0, stayed = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto now = simulator.detect(picture.truth(), apart(i)).objects;
    const auto next = simulator.detect(picture.truth(), apart(i) + 0.2).objects;
    for (const DetectedObject& alarm : now) {
      EXPECT_FALSE(alarm.thing.has_value());
      EXPECT_GE(alarm.score, 0.3);
      EXPECT_LT(alarm.score, 1);
      EXPECT_THAT(noise.false_alarms.classes, ::testing::Contains(alarm.class_name));
      ++alarms;
      stayed += std::any_of(next.begin(), next.end(),
                            [&](const auto& other) { return other.box.x0 == alarm.box.x0; });
    }
  }
  EXPECT_NEAR(alarms / 3000.0, 0.6, 0.05);
  EXPECT_NEAR(stayed / double(alarms), std::exp(-1), 0.05);
}

TEST(PerceptionSimulator, SeesSomeThingsTwiceButNotTwiceTheSame) {
  PerceptionPicture picture;
  for (int i = 0; i < 12; ++i) {
    picture.add(i % 2 ? "cup" : "keyboard", {50 * i + 5, 20 * i, 40, 60});
  }
  PerceptionNoise noise = PerceptionNoise::none();
  noise.duplicates.share = 0.1;
  const auto simulator = picture.simulator(noise);
  int duplicates = 0;
  for (int i = 0; i < 500; ++i) {
    const auto objects = simulator.detect(picture.truth(), apart(i)).objects;
    std::vector<const DetectedObject*> first(12, nullptr);
    for (const DetectedObject& object : objects) {
      const DetectedObject*& before = first[*object.thing];
      if (!before) {
        before = &object;
        continue;
      }
      ++duplicates;
      EXPECT_LT(object.score, before->score);
      if (object.class_name != before->class_name) continue;
      EXPECT_LT(iou(object.box, before->box), 0.5);  // else it had been suppressed
      EXPECT_LT(cv::countNonZero(object.mask), 0.5 * cv::countNonZero(before->mask));
    }
  }
  EXPECT_NEAR(duplicates / 6000.0, 0.1, 0.015);
}

TEST(PerceptionSimulator, TiltsAndShiftsPlanesAtTheirMiddle) {
  PerceptionPicture picture;  // the wall is seen in the left half only
  picture.truth().planes(cv::Rect(320, 0, 320, 480)) = 0;
  picture.truth().visible_planes[0].pixels = 320 * 480;
  PerceptionNoise noise = PerceptionNoise::none();
  noise.planes.angle_deg = 5;
  noise.planes.offset = 0.1;
  noise.planes.missed = 0.5;
  const auto simulator = picture.simulator(noise);
  const Eigen::Vector3d middle = kPerceptionCamera.unproject({159.5, 239.5});
  std::vector<double> angles, offsets;
  for (int i = 0; i < 4000; ++i) {
    const auto planes = simulator.detect(picture.truth(), apart(i), false).planes;
    if (planes.empty()) continue;
    const Eigen::Vector3d n = planes[0].plane.head<3>();
    EXPECT_NEAR(n.norm(), 1, 1e-12);
    angles.push_back(std::acos(std::min(1.0, -n.z())) * 180 / M_PI);
    // Along the ray through the middle, over where it truly is.
    offsets.push_back(std::log(planes[0].plane[3] / n.dot(middle) * middle.z() / -2));
  }
  EXPECT_NEAR(angles.size() / 4000.0, 1 - 0.5 * 0.1 / 0.5, 0.02);
  EXPECT_NEAR(deviation(angles), 5 * std::sqrt(2.0), 0.2);
  EXPECT_NEAR(deviation(offsets), 0.1, 0.005);
}

}  // namespace
}  // namespace cairn

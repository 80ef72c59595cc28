#include "cairn/map/slot_map.h"

#include <gtest/gtest.h>

#include <map>

#include "geometry/scene.h"

namespace cairn {
namespace {

using Numbers = SlotMap<int, PointId>;

TEST(SlotMap, AnElementIsFoundUnderItsIdUntilItIsErased) {
  Numbers numbers;
  EXPECT_TRUE(numbers.empty());
  const PointId a = numbers.insert(7), b = numbers.insert(8);
  EXPECT_EQ(numbers[a], 7);
  EXPECT_EQ(numbers[b], 8);
  numbers.erase(a);
  EXPECT_FALSE(numbers.contains(a));
  EXPECT_EQ(numbers.find(a), nullptr);
  EXPECT_EQ(numbers[b], 8);
  EXPECT_EQ(numbers.size(), 1u);
}

TEST(SlotMap, AnInvalidIdNamesNothing) {
  Numbers numbers;
  numbers.insert(1);
  EXPECT_FALSE(PointId().valid());
  EXPECT_FALSE(numbers.contains(PointId()));
}

TEST(SlotMap, ASlotIsUsedAgainButItsOldIdStaysDead) {
  Numbers numbers;
  const PointId old = numbers.insert(1);
  numbers.erase(old);
  const PointId fresh = numbers.insert(2);
  EXPECT_EQ(fresh.slot, old.slot);
  EXPECT_NE(fresh, old);
  EXPECT_FALSE(numbers.contains(old));
  EXPECT_EQ(numbers[fresh], 2);
}

TEST(SlotMap, ReferencesOutliveTheInsertionOfOthers) {
  Numbers numbers;
  const PointId first = numbers.insert(5);
  const int* address = &numbers[first];
  for (int i = 0; i < 10000; ++i) numbers.insert(i);
  EXPECT_EQ(address, &numbers[first]);
}

TEST(SlotMap, ElementsMayBeErasedWhileTheyAreVisited) {
  Numbers numbers;
  for (int i = 0; i < 10; ++i) numbers.insert(i);
  numbers.for_each([&](PointId id, int value) {
    if (value % 2 == 0) numbers.erase(id);
  });
  int sum = 0;
  numbers.for_each([&](PointId, int value) { sum += value; });
  EXPECT_EQ(sum, 1 + 3 + 5 + 7 + 9);
}

TEST(SlotMap, AgreesWithAnOrdinaryMapUnderRandomUse) {
  testing::Random random(4);
  Numbers numbers;
  std::map<PointId, int> expected;
  std::size_t most = 0;
  for (int step = 0; step < 5000; ++step) {
    if (expected.empty() || random.uniform(0, 1) < 0.5) {
      const PointId id = numbers.insert(step);
      ASSERT_TRUE(expected.emplace(id, step).second) << "an id was given twice";
      ASSERT_LT(id.slot, most + 1) << "memory follows the elements alive";
    } else {
      auto it = std::next(expected.begin(), random.below(static_cast<int>(expected.size())));
      numbers.erase(it->first);
      expected.erase(it);
    }
    most = std::max(most, expected.size());
  }
  std::map<PointId, int> found;
  std::uint32_t last_slot = 0;
  numbers.for_each([&](PointId id, int value) {
    EXPECT_GE(id.slot, last_slot);
    last_slot = id.slot;
    found[id] = value;
  });
  EXPECT_EQ(found, expected);
  EXPECT_EQ(numbers.size(), expected.size());
}

}  // namespace
}  // namespace cairn

#include "cairn/system/option_table.h"

#include <gmock/gmock.h>

#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

using testing::HasSubstr;

// The sentence of the error that setting this raises.
std::string refusal(const std::string& assignment) {
  Options options;
  try {
    OptionTable(options).set(assignment);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::kUsage);
    return error.what();
  }
  return "accepted";
}

class File {
 public:
  explicit File(const std::string& content)
      : path_(testing::TempDir() + "option_table_" + std::to_string(getpid()) + ".yaml") {
    std::ofstream(path_) << content;
  }
  ~File() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

TEST(OptionTable, SetsWhatTheKeyPointsAt) {
  Options options;
  OptionTable table(options);
  table.set("features.count=1500");
  table.set("features.scale = 1.25");
  table.set("pace=lockstep");
  table.set("seed=18446744073709551615");
  EXPECT_EQ(options.features.count, 1500);
  EXPECT_EQ(options.features.scale, 1.25);
  EXPECT_EQ(options.pace, Pace::kLockstep);
  EXPECT_EQ(options.seed, 18446744073709551615u);
}

TEST(OptionTable, NamesTheNearestKey) {
  EXPECT_THAT(refusal("features.cuont=5"), HasSubstr("nearest is features.count"));
  EXPECT_THAT(refusal("count=5"), HasSubstr("nearest is features.count"));
  EXPECT_THAT(refusal("sed=5"), HasSubstr("nearest is seed"));
}

TEST(OptionTable, NamesTheRange) {
  EXPECT_THAT(refusal("features.count=-5"), HasSubstr("0 to 20000 keypoints"));
  EXPECT_THAT(refusal("features.count=99999999999"), HasSubstr("0 to 20000 keypoints"));
  EXPECT_THAT(refusal("features.scale=nan"), HasSubstr("out of range"));
  EXPECT_THAT(refusal("pace=slow"), HasSubstr("realtime or lockstep"));
}

TEST(OptionTable, SaysWhatTypeItTakes) {
  EXPECT_THAT(refusal("features.count=many"), HasSubstr("takes a whole number"));
  EXPECT_THAT(refusal("features.count=1000.5"), HasSubstr("takes a whole number"));
  EXPECT_THAT(refusal("features.count="), HasSubstr("takes a whole number"));
  EXPECT_THAT(refusal("features.scale=1,2"), HasSubstr("takes a number"));
  EXPECT_THAT(refusal("seed=-1"), HasSubstr("not negative"));
  EXPECT_THAT(refusal("features.count"), HasSubstr("key=value"));
}

TEST(OptionTable, PrintsWhatItTakesBack) {
  Options options;
  OptionTable table(options);
  table.set("features.count=777");
  table.set("features.scale=1.3000000000000003");
  table.set("pace=lockstep");
  table.set("seed=42");
  const std::string printed = table.print_yaml();
  EXPECT_THAT(printed, HasSubstr("(default 0)"));

  const File file(printed);
  Options loaded;
  OptionTable loaded_table(loaded);
  loaded_table.load_yaml(file.path());
  EXPECT_EQ(loaded_table.print_yaml(), printed);
  EXPECT_EQ(loaded.features.scale, options.features.scale);
  for (const auto& key : table.keys())
    EXPECT_THAT(printed, HasSubstr(key.substr(key.rfind('.') + 1)));
}

TEST(OptionTable, DefaultsAreWithinTheirRanges) {
  Options options;
  OptionTable table(options);
  for (const auto& key : table.keys()) EXPECT_NO_THROW(table.set(key, table.get(key))) << key;
}

TEST(OptionTable, ReadsNestedAndDottedKeys) {
  const File file("features.count: 800\nfeatures:\n  levels: 4\n");
  Options options;
  OptionTable(options).load_yaml(file.path());
  EXPECT_EQ(options.features.count, 800);
  EXPECT_EQ(options.features.levels, 4);
}

TEST(OptionTable, RefusesFilesWithASentenceThatNamesThem) {
  for (const char* content :
       {"features: [1, 2]\n", "- a\n", "a: b: c\n", "features: {cout: 3}\n"}) {
    const File file(content);
    Options options;
    try {
      OptionTable(options).load_yaml(file.path());
      ADD_FAILURE() << "accepted " << content;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::kUsage);
      EXPECT_THAT(error.what(), HasSubstr(file.path()));
    }
  }
  Options options;
  EXPECT_THROW(OptionTable(options).load_yaml("/nowhere/at/all.yaml"), Error);
}

}  // namespace
}  // namespace cairn

#include <gmock/gmock.h>

#include <fstream>

#include "program.h"
#include "quick_scene/quick_sequence.h"

namespace cairn {
namespace {

using testing::AllOf;
using testing::Field;
using testing::HasSubstr;
using testing::Matcher;

// The exit code, and one sentence on a line that begins with the program's name.
Matcher<Ran> fails(int exit_code, const std::string& part) {
  return AllOf(Field("exit_code", &Ran::exit_code, exit_code),
               Field("output", &Ran::output, AllOf(HasSubstr("cairn: "), HasSubstr(part))));
}

class CommandLine : public testing::Test {
 protected:
  // A sequence that can be opened; far too short for a map.
  std::string small_sequence() {
    std::string folder = folder_ / "small";
    if (std::filesystem::exists(folder)) return folder;
    write_quick_sequence(folder, 3);
    return folder;
  }
  Ran run_small(const std::string& arguments) {
    return run_cairn("run " + small_sequence() + " --out " + (folder_ / "out") + " " + arguments);
  }
  TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(run_cairn("--help").exit_code, 0);
  EXPECT_EQ(run_cairn("--version").exit_code, 0);
  for (const char* command : {"run", "evaluate", "synth", "bench", "config"}) {
    const Ran help = run_cairn(std::string(command) + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.output, HasSubstr("Usage: cairn " + std::string(command)));
  }
}

TEST_F(CommandLine, WrongOptions) {
  EXPECT_THAT(run_cairn(""), fails(2, "subcommand"));
  EXPECT_THAT(run_cairn("fly"), fails(2, "cairn --help"));
  EXPECT_THAT(run_cairn("run"), fails(2, "sequence is required"));
  EXPECT_THAT(run_cairn("run x --fast"), fails(2, "--fast"));
  EXPECT_THAT(run_cairn("run x --layout floppy"), fails(2, "--layout"));
  EXPECT_THAT(run_cairn("run x --pace slow"), fails(2, "realtime or lockstep"));
  EXPECT_THAT(run_cairn("run x --threads -1"), fails(2, "threads"));
  EXPECT_THAT(run_cairn("run x --seed many"), fails(2, "whole number"));
  EXPECT_THAT(run_cairn("run x --scale 0"), fails(2, "give a true length over the same length"));
  for (const char* wrong : {"=-1", "=-0.0", " nan", " inf", " 1e300", " 2,5", " far"}) {
    EXPECT_THAT(run_cairn(std::string("run x --scale") + wrong), fails(2, "scale")) << wrong;
  }
}

TEST_F(CommandLine, WhatIsNotThereYetIsRefusedByName) {
  EXPECT_THAT(run_cairn("run x --sensor stereo"), fails(2, "--sensor mono"));
  EXPECT_THAT(run_cairn("run x --sensor rgbd"), fails(2, "--sensor mono"));
}

TEST_F(CommandLine, SourcesAreOfLandmarksThatTheMapHas) {
  EXPECT_THAT(run_cairn("run x --objects yolo"), fails(2, "give --landmarks full"));
  EXPECT_THAT(run_cairn("run x --landmarks points --objects yolo"),
              fails(2, "give --landmarks po"));
  EXPECT_THAT(run_cairn("run x --landmarks po --planes rgbd"), fails(2, "give --landmarks full"));
  EXPECT_THAT(run_cairn("run x --landmarks full --objects none"), fails(2, "give --landmarks ppm"));
  EXPECT_THAT(run_cairn("run x --landmarks full --planes none"), fails(2, "give --landmarks po"));
  EXPECT_THAT(run_small("--landmarks po --objects yolo"), fails(2, "\"yolo\""));
  EXPECT_THAT(run_small("--landmarks po --models /no/such/folder"), fails(3, "/no/such/folder"));
  EXPECT_THAT(run_small("--landmarks po --objects recorded"), fails(3, "perception.jsonl"));
}

TEST_F(CommandLine, WrongConfiguration) {
  EXPECT_THAT(run_cairn("config --set features.cuont=800"), fails(2, "nearest is features.count"));
  EXPECT_THAT(run_cairn("run x --set features.cuont=800"), fails(2, "nearest is features.count"));
  EXPECT_THAT(run_cairn("run x --set features.count=30000"), fails(2, "0 to 20000"));
  EXPECT_THAT(run_cairn("run x --set features.count=few"), fails(2, "whole number"));
  EXPECT_THAT(run_cairn("run x --config /no/such.yaml"), fails(3, "/no/such.yaml"));
  std::ofstream(folder_ / "bad.yaml") << "features: {levels: 99}\n";
  EXPECT_THAT(run_cairn("run x --config " + (folder_ / "bad.yaml")), fails(2, "1 to 16"));
}

TEST_F(CommandLine, ConfigPrintsWhatItTakesBack) {
  const Ran printed = run_cairn("config --set features.count=1234");
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_THAT(printed.output, HasSubstr("count: 1234"));
  std::ofstream(folder_ / "back.yaml") << printed.output;
  EXPECT_EQ(run_cairn("config --config " + (folder_ / "back.yaml")).output, printed.output);
}

TEST_F(CommandLine, InputThatCannotBeRead) {
  EXPECT_THAT(run_cairn("run " + (folder_ / "missing")), fails(3, "missing"));
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_THAT(run_cairn("run " + (folder_ / "empty")), fails(3, "empty"));
  EXPECT_THAT(run_cairn("evaluate " + (folder_ / "missing")), fails(3, "missing"));
}

TEST_F(CommandLine, NothingIsLeftBehindByARunThatCannotStart) {
  run_cairn("run " + (folder_ / "missing") + " --out " + (folder_ / "out"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(CommandLine, CalibrationThatCannotBe) {
  EXPECT_THAT(run_small("--camera=-525,525,320,240"), fails(2, "focal length must be positive"));
  EXPECT_THAT(run_small("--camera 525,525"), fails(2, "--camera"));
  EXPECT_THAT(run_small("--camera 525,nan,320,240"), fails(2, "camera"));
  EXPECT_THAT(run_small("--calibration /no/such.yaml"), fails(3, "/no/such.yaml"));
  EXPECT_THAT(run_small("--groundtruth /no/such.txt"), fails(3, "/no/such.txt"));
}

TEST_F(CommandLine, NoCalibrationAtAllSaysHowToGiveOne) {
  const std::string sequence = small_sequence();
  std::filesystem::remove(sequence + "/calibration.yaml");
  EXPECT_THAT(run_cairn("run " + sequence + " --out " + (folder_ / "out")),
              fails(2, "--camera fx,fy,cx,cy"));
}

TEST_F(CommandLine, OutputThatIsInTheWay) {
  std::filesystem::create_directory(folder_ / "out");
  std::ofstream(folder_ / "out/precious.txt") << "mine\n";
  EXPECT_THAT(run_small(""), fails(2, "--force"));
  EXPECT_EQ(run_small("--force").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/precious.txt"));
}

TEST_F(CommandLine, OutputThatCannotBeWritten) {
  const std::string sequence = small_sequence();
  EXPECT_THAT(run_cairn("run " + sequence + " --out /dev/null/out"), fails(4, "/dev/null/out"));
  std::ofstream(folder_ / "file") << "a file\n";
  EXPECT_THAT(run_cairn("run " + sequence + " --out " + (folder_ / "file")), fails(4, "file"));
  EXPECT_THAT(run_cairn("synth /proc/cairn-synth"), fails(4, "/proc/cairn-synth"));
}

TEST_F(CommandLine, NoMapButAllRecordsWhereNothingHasParallaxEnough) {
  EXPECT_THAT(run_small("--pace lockstep --set initialization.min_parallax_deg=30"),
              fails(1, "no map could be initialised"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/frames.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/summary.json"));
}

TEST_F(CommandLine, AnInterruptedRunWritesWhatItHas) {
  const std::string sequence = small_sequence();
  // Frames so far apart that the interrupt comes between two of them, and so late that a busy
  // machine has started the program.
  std::ofstream list(sequence + "/rgb.txt");
  double time = 0;
  for (const auto& entry : std::filesystem::directory_iterator(sequence + "/rgb")) {
    list << time << " rgb/" << entry.path().filename().string() << "\n";
    time += 4;
  }
  list.close();
  const Ran ran = run_cairn("run " + sequence + " --pace realtime --out " + (folder_ / "out"),
                            "timeout --preserve-status --signal=INT 3");
  EXPECT_EQ(ran.exit_code, 130) << ran.output;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/summary.json"));
}

TEST_F(CommandLine, ABrokenPictureIsSkippedAndReported) {
  const std::string sequence = small_sequence();
  auto picture = std::filesystem::directory_iterator(sequence + "/rgb")->path();
  std::filesystem::resize_file(picture, 1000);
  const Ran ran = run_cairn("run " + sequence + " --pace lockstep --out " + (folder_ / "out"));
  EXPECT_THAT(ran, fails(1, "skipped"));
  EXPECT_THAT(ran.output, HasSubstr(picture.filename().string()));
}

}  // namespace
}  // namespace cairn

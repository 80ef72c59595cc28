#include "cairn/system/scratch_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "datasets/temp_folder.h"

namespace cairn {
namespace {

std::vector<std::byte> some_bytes(std::size_t count, int first) {
  std::vector<std::byte> bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>((first + i) & 0xff);
  return bytes;
}

std::optional<std::vector<std::byte>> read(const ScratchFile& file,
                                           const ScratchFile::Extent& extent) {
  std::vector<std::byte> bytes(extent.bytes);
  if (!file.read(extent, bytes)) return std::nullopt;
  return bytes;
}

std::size_t files_in(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// The folder for temporary files of this test.
class ScratchFileTest : public ::testing::Test {
 protected:
  ScratchFileTest() {
    if (const char* value = std::getenv("TMPDIR")) before_ = value;
    ::setenv("TMPDIR", folder.path().c_str(), 1);
  }
  ~ScratchFileTest() override {
    if (before_) {
      ::setenv("TMPDIR", before_->c_str(), 1);
    } else {
      ::unsetenv("TMPDIR");
    }
  }

  TempFolder folder;

 private:
  std::optional<std::string> before_;
};

TEST_F(ScratchFileTest, GivesBackWhatItWasGiven) {
  ScratchFile file;
  const auto a = some_bytes(5000, 1), b = some_bytes(0, 0), c = some_bytes(77, 9);
  const auto at_a = file.append(a), at_b = file.append(b), at_c = file.append(c);
  EXPECT_EQ(read(file, at_c), c);
  EXPECT_EQ(read(file, at_a), a);
  EXPECT_EQ(read(file, at_b), b);
}

TEST_F(ScratchFileTest, LeavesNoNameBehind) {
  ScratchFile file;
  file.append(some_bytes(100, 0));
  EXPECT_EQ(files_in(folder.path()), 0u);
}

TEST_F(ScratchFileTest, KeepsWhatItHoldsWhenItIsMoved) {
  ScratchFile file;
  const auto bytes = some_bytes(300, 3);
  const auto extent = file.append(bytes);
  ScratchFile moved(std::move(file));
  EXPECT_EQ(read(moved, extent), bytes);
  const auto more = moved.append(bytes);
  file = std::move(moved);
  EXPECT_EQ(read(file, more), bytes);
}

TEST_F(ScratchFileTest, KeepsNothingWhereThereIsNoFolder) {
  std::filesystem::remove_all(folder.path());
  ScratchFile file;
  EXPECT_EQ(file.append(some_bytes(100, 0)).bytes, 0u);
  EXPECT_EQ(file.append(some_bytes(100, 0)).bytes, 0u) << "and does not ask again";
}

TEST_F(ScratchFileTest, KeepsWhatItHasWhenTheDiskIsFull) {
  ScratchFile file;
  const auto bytes = some_bytes(1000, 5);
  const auto extent = file.append(bytes);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto signal = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{1500, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  const auto too_much = file.append(bytes);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, signal);
  EXPECT_EQ(too_much.bytes, 0u);
  EXPECT_EQ(read(file, extent), bytes);
}

}  // namespace
}  // namespace cairn

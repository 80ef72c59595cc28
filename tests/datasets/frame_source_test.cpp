#include <gmock/gmock.h>

#include <opencv2/videoio.hpp>

#include "cairn/datasets/capture_source.h"
#include "cairn/datasets/picture_file.h"
#include "cairn/datasets/prefetching_source.h"
#include "cairn/datasets/sequence.h"
#include "datasets/temp_folder.h"

namespace cairn {
namespace {

using testing::HasSubstr;

std::filesystem::path write_video(const TempFolder& folder, int frames) {
  const auto file = folder / "film.avi";
  cv::VideoWriter writer(file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {64, 48});
  for (int i = 0; i < frames; ++i) writer.write(test_picture(i));
  return file;
}

TEST(CaptureSource, ReadsAVideoWithItsTimes) {
  TempFolder folder;
  Sequence sequence = open_sequence(write_video(folder, 10).string());
  EXPECT_EQ(sequence.layout, "video");
  EXPECT_EQ(sequence.name, "film");
  EXPECT_EQ(sequence.size, cv::Size(64, 48));
  EXPECT_EQ(sequence.frames->size(), 10u);
  int count = 0;
  for (SourceFrame frame; sequence.frames->next(frame); ++count) {
    EXPECT_THAT(frame.problem, testing::IsEmpty());
    EXPECT_NEAR(frame.timestamp, count / 25.0, 1e-6);
    EXPECT_LT(cv::norm(frame.image, test_picture(count), cv::NORM_L1) / frame.image.total(), 20);
  }
  EXPECT_EQ(count, 10);
}

TEST(CaptureSource, SaysWhereACutVideoBreaksOff) {
  TempFolder folder;
  const auto file = write_video(folder, 100);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(std::streamoff(std::filesystem::file_size(file) / 2))
      .write(std::string(std::filesystem::file_size(file) / 2, '\0').data(),
             std::streamsize(std::filesystem::file_size(file) / 2));
  Sequence sequence = open_sequence(file.string());
  std::string last_problem;
  for (SourceFrame frame; sequence.frames->next(frame);) last_problem = frame.problem;
  if (sequence.frames->size()) {
    EXPECT_THAT(last_problem, HasSubstr("breaks off"));
  }
}

TEST(CaptureSource, StampsLiveFramesWithTheClock) {
  TempFolder folder;
  OpenOptions options;
  options.layout = "camera";
  Sequence sequence = open_sequence("camera:" + write_video(folder, 5).string(), options);
  EXPECT_EQ(sequence.layout, "camera");
  EXPECT_TRUE(sequence.frames->live());
  EXPECT_FALSE(sequence.frames->size().has_value());
  const double now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  double last = 0;
  int count = 0;
  for (SourceFrame frame; sequence.frames->next(frame); ++count) {
    EXPECT_THAT(frame.problem, testing::IsEmpty());
    EXPECT_GT(frame.timestamp, last);
    EXPECT_NEAR(frame.timestamp, now, 60);
    last = frame.timestamp;
  }
  EXPECT_EQ(count, 5);
}

// Counts, and fails where it is told to.
class CountingSource : public FrameSource {
 public:
  CountingSource(int end, int failure) : end_(end), failure_(failure) {}
  bool next(SourceFrame& frame) override {
    if (count_ == failure_) throw Error(Error::Kind::kInput, "the disk is gone");
    frame.timestamp = count_;
    return count_++ < end_;
  }
  std::optional<std::size_t> size() const override { return end_; }

 private:
  int end_, failure_, count_ = 0;
};

TEST(PrefetchingSource, KeepsTheOrderAndEndsOnce) {
  PrefetchingSource source(std::make_unique<CountingSource>(100, -1));
  SourceFrame frame;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(source.next(frame));
    EXPECT_EQ(frame.timestamp, i);
  }
  EXPECT_FALSE(source.next(frame));
  EXPECT_FALSE(source.next(frame));
}

TEST(PrefetchingSource, PassesAFailureOnInItsPlace) {
  PrefetchingSource source(std::make_unique<CountingSource>(100, 2));
  SourceFrame frame;
  EXPECT_TRUE(source.next(frame));
  EXPECT_TRUE(source.next(frame));
  EXPECT_THROW(source.next(frame), Error);
  EXPECT_FALSE(source.next(frame));
}

TEST(PrefetchingSource, CanBeLeftInTheMiddle) {
  PrefetchingSource source(std::make_unique<CountingSource>(100, -1));
  SourceFrame frame;
  EXPECT_TRUE(source.next(frame));
}

TEST(PictureFile, IsFoundCutWhereverTheCutIs) {
  for (const char* ending : {".jpg", ".png"}) {
    std::vector<unsigned char> bytes;
    cv::imencode(ending, test_picture(3), bytes);
    EXPECT_TRUE(is_complete_picture(bytes)) << ending;
    for (std::size_t size = 4; size + 1 < bytes.size(); size += 37) {
      EXPECT_FALSE(is_complete_picture({bytes.data(), size})) << ending << " of " << size;
    }
    bytes.insert(bytes.end(), 10, 7);  // a trailer
    EXPECT_TRUE(is_complete_picture(bytes)) << ending;
  }
}

TEST(PictureFile, ThatIsNoPictureHasAProblem) {
  TempFolder folder;
  std::string problem;
  EXPECT_TRUE(read_picture(folder.write("a.png", "some text"), true, problem).empty());
  EXPECT_THAT(problem, HasSubstr("a.png: this is not a picture"));
  EXPECT_TRUE(read_picture(folder.path(), true, problem).empty());
  EXPECT_THAT(problem, testing::Not(testing::IsEmpty()));
}

}  // namespace
}  // namespace cairn

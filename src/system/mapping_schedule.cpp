#include "cairn/system/mapping_schedule.h"

namespace cairn {
namespace {

constexpr int kCandidates = 8;  // keyframes that a relocalisation looks at
// Keyframes that may come before the map is adjusted again: a camera in trouble asks for one with
// every frame, and would go on from poses that nothing has adjusted.
constexpr int kMostUnadjusted = 3;

}  // namespace

MappingSchedule::MappingSchedule(std::unique_ptr<Mapper> mapper, const Options& options)
    : mapper_(std::move(mapper)), tracking_(options.tracking), view_(mapper_->view()) {
  if (options.pace == Pace::kRealtime) thread_ = std::thread([this] { loop(); });
}

MappingSchedule::~MappingSchedule() { stop(); }

void MappingSchedule::insert(KeyframeCandidate candidate, Sighting sighting) {
  Insertion insertion{std::move(candidate), std::move(sighting)};
  if (!thread_.joinable()) {
    run_insertion(insertion);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    insertions_.push_back(std::move(insertion));
    abort_ = true;
  }
  wake_.notify_one();
}

void MappingSchedule::join(KeyframePerception perception) {
  if (!thread_.joinable()) {  // lockstep, or the thread has ended
    mapper_->join(perception);
    publish();
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    perceptions_.push_back(std::move(perception));
  }
  wake_.notify_one();
}

void MappingSchedule::settle() {
  if (thread_.joinable()) return;
  mapper_->adjust(nullptr);
  publish();
}

void MappingSchedule::relocalize(std::shared_ptr<const Frame> frame, std::uint64_t seed,
                                 std::vector<SeenObject> objects) {
  Question question{std::move(frame), seed, std::move(objects)};
  if (!thread_.joinable()) {
    run_question(question);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    question_ = std::move(question);
    abort_ = true;
  }
  wake_.notify_one();
}

std::optional<MappingSchedule::Answer> MappingSchedule::take_relocalization() {
  const std::lock_guard lock(mutex_);
  return std::exchange(answer_, std::nullopt);
}

bool MappingSchedule::relocalizing() const {
  const std::lock_guard lock(mutex_);
  return question_.has_value();
}

int MappingSchedule::backlog() const {
  const std::lock_guard lock(mutex_);
  return int(insertions_.size()) + int(busy_);
}

std::shared_ptr<const MapView> MappingSchedule::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

Mapper& MappingSchedule::stop() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  return *mapper_;
}

void MappingSchedule::publish() {
  const std::lock_guard lock(mutex_);
  view_ = mapper_->view();
}

void MappingSchedule::run_insertion(const Insertion& insertion) {
  mapper_->count_visible(insertion.sighting.visible, insertion.sighting.found);
  mapper_->insert(insertion.candidate);
  publish();
}

void MappingSchedule::run_question(const Question& question) {
  const Map& map = mapper_->map();
  const std::vector<KeyframeId> candidates =
      mapper_->similar_keyframes(question.frame->features, kCandidates);
  Answer answer{question.frame,
                cairn::relocalize(*question.frame, map, candidates, tracking_, question.seed)};
  if (!answer.found && !question.objects.empty()) {
    answer.found =
        relocalize_with_objects(*question.frame, map, question.objects, tracking_, question.seed);
  }
  if (answer.found) {
    mapper_->look_around(answer.found->view->reference);
    publish();
  }
  const std::lock_guard lock(mutex_);
  answer_ = std::move(answer);
  question_.reset();
}

void MappingSchedule::loop() {
  bool adjustment_due = false;
  int unadjusted = 0;  // keyframes since an adjustment was not left early
  while (true) {
    const bool overdue = unadjusted >= kMostUnadjusted;
    std::optional<Insertion> insertion;
    std::optional<Question> question;
    std::optional<KeyframePerception> perception;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] {
        return stopping_ || adjustment_due || question_.has_value() || !insertions_.empty() ||
               !perceptions_.empty();
      });
      if (stopping_ && insertions_.empty() && perceptions_.empty() && !adjustment_due) return;
      busy_ = true;
      abort_ = false;
      // Those of keyframes that still wait come after them, and so do questions: an insertion takes
      // the view with it.
      const bool seen_earlier =
          !perceptions_.empty() && (insertions_.empty() || perceptions_.front().frame->timestamp <
                                                               insertions_.front().timestamp());
      if (!insertions_.empty() && !overdue && !(seen_earlier && unadjusted == 0)) {
        insertion = std::move(insertions_.front());
        insertions_.pop_front();
      } else if (question_ && insertions_.empty() && !stopping_) {
        question = *question_;
      } else if (seen_earlier && !overdue) {
        perception = std::move(perceptions_.front());
        perceptions_.pop_front();
      }
    }
    if (insertion) {
      run_insertion(*insertion);
      adjustment_due = true;
      ++unadjusted;
    } else if (question) {
      run_question(*question);
    } else if (perception) {
      mapper_->join(*perception);
      publish();
    } else if (adjustment_due) {
      const StopAsked somebody_waits = [this] { return abort_.load(); };
      mapper_->adjust(overdue ? StopAsked() : somebody_waits);
      publish();
      adjustment_due = false;
      if (overdue || !abort_) unadjusted = 0;
    }
    const std::lock_guard lock(mutex_);
    busy_ = false;
  }
}

}  // namespace cairn

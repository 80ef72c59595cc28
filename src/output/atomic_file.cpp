#include "cairn/output/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "cairn/geometry/error.h"

namespace cairn {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, int error) {
  const char* advice = "check the path and its permissions, or choose another --out";
  if (error == ENOSPC || error == EDQUOT) advice = "free some space, or choose another --out";
  throw Error(Error::Kind::kOutput, file.string() + ": the file cannot be written (" +
                                        std::strerror(error) + "); " + advice);
}

// The descriptor is closed and the file removed however the writing ends.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& name) : name_(name) {
    descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }

  bool write(std::string_view content) {
    while (!content.empty()) {
      const ssize_t written = ::write(descriptor_, content.data(), content.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      content.remove_prefix(std::size_t(written));
    }
    return true;
  }

  // Delayed writing reports a full disk only on syncing or closing.
  bool close() {
    const bool synced = ::fsync(descriptor_) == 0 || errno == EINVAL || errno == EROFS;
    const int error = errno;
    const bool closed = ::close(std::exchange(descriptor_, -1)) == 0;
    if (!synced) errno = error;
    return synced && closed;
  }

  bool rename_to(const std::filesystem::path& file) {
    renamed_ = ::rename(name_.c_str(), file.c_str()) == 0;
    return renamed_;
  }

 private:
  std::filesystem::path name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view content) {
  TemporaryFile temporary(file.string() + ".tmp-" + std::to_string(::getpid()));
  if (!temporary.is_open() || !temporary.write(content) || !temporary.close() ||
      !temporary.rename_to(file)) {
    refuse(file, errno);
  }
}

PendingFile::PendingFile(std::filesystem::path final_name) : final_(std::move(final_name)) {
  pending_ = final_.parent_path() / (final_.stem().string() + ".tmp-" + std::to_string(::getpid()) +
                                     final_.extension().string());
}

PendingFile::~PendingFile() {
  std::error_code code;
  std::filesystem::remove(pending_, code);
}

void PendingFile::commit() {
  std::error_code code;
  const auto size = std::filesystem::file_size(pending_, code);
  if (code) refuse(final_, code.value());
  if (size == 0) refuse(final_, ENOSPC);
  std::filesystem::rename(pending_, final_, code);
  if (code) refuse(final_, code.value());
}

void make_output_folder(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code || !std::filesystem::is_directory(folder)) {
    throw Error(Error::Kind::kOutput, folder.string() + ": the folder cannot be made (" +
                                          std::strerror(code ? code.value() : ENOTDIR) +
                                          "); check the path, or choose another --out");
  }
  if (::access(folder.c_str(), W_OK) != 0) refuse(folder, errno);
}

}  // namespace cairn

#include "cairn/system/scratch_file.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

namespace cairn {

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      usable_(other.usable_),
      size_(other.size_) {}

ScratchFile& ScratchFile::operator=(ScratchFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(usable_, other.usable_);
  std::swap(size_, other.size_);
  return *this;
}

ScratchFile::Extent ScratchFile::append(std::span<const std::byte> bytes) {
  if (usable_ && descriptor_ < 0) open();
  if (!usable_) return {};
  const Extent extent{size_, bytes.size()};
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      give_up(std::strerror(errno));
      return {};
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
  return extent;
}

bool ScratchFile::read(const Extent& extent, std::span<std::byte> into) const {
  auto offset = static_cast<off_t>(extent.offset);
  while (!into.empty()) {
    const ssize_t got = ::pread(descriptor_, into.data(), into.size(), offset);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    into = into.subspan(static_cast<std::size_t>(got));
    offset += got;
  }
  return true;
}

void ScratchFile::open() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) return give_up(error.message());
  std::string name = (folder / "cairn-XXXXXX").string();
  descriptor_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) return give_up(std::strerror(errno));
  ::unlink(name.c_str());  // the file lives as long as it is open
}

// What was written before stays readable.
void ScratchFile::give_up(const std::string& reason) {
  spdlog::warn("no temporary file can be written ({}): poses of frames will be less exact", reason);
  usable_ = false;
}

}  // namespace cairn

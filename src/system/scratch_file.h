#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace cairn {

/// What is too much to be held in memory and not needed before the end: bytes in a file without a
/// name, in the system's folder for temporary files, which is gone when the process is. Where it
/// cannot be written, nothing is kept, and that is said once.
class ScratchFile {
 public:
  struct Extent {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
  };

  ScratchFile() = default;
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&& other) noexcept;

  /// Where it was written; empty where it could not be.
  Extent append(std::span<const std::byte> bytes);
  /// Fills `into`, which has the size of the extent; false where that fails. Safe from many
  /// threads.
  bool read(const Extent& extent, std::span<std::byte> into) const;

 private:
  void open();
  void give_up(const std::string& reason);

  int descriptor_ = -1;
  bool usable_ = true;
  std::uint64_t size_ = 0;
};

}  // namespace cairn

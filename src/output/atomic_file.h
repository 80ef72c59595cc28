#pragma once

// The output room: what a person or a script finds after a run. Trajectories, tables, the map, the
// summary, plots, annotated pictures. It knows plain data; it must not know who computed it.

#include <filesystem>
#include <string_view>

namespace cairn {

/// Writes `content` beside `file` and renames it when it is safely there, so that nothing half
/// written looks complete. Throws Error(kOutput) that names the file; then nothing is left behind.
void write_file(const std::filesystem::path& file, std::string_view content);

/// For writers that want a file name of their own: they write to `path()`, then `commit()` gives it
/// its final name. Without that the file is removed.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path final_name);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Beside the final name, with the same ending.
  const std::filesystem::path& path() const { return pending_; }
  /// Throws Error(kOutput) if nothing was written or it cannot be renamed.
  void commit();

 private:
  std::filesystem::path final_, pending_;
};

/// Makes `folder` where it is missing. Throws Error(kOutput) if that fails or it cannot be written.
void make_output_folder(const std::filesystem::path& folder);

}  // namespace cairn

#pragma once

#include <filesystem>
#include <string>

namespace cairn::app {

/// Makes the folder that results go to and tries that it can be written, before hours of work
/// depend on it. An empty `wanted` means runs/<name>-<date>-<time>. Throws Error: kUsage if the
/// folder has something in it and `force` is not set, kOutput if it cannot be written.
std::filesystem::path prepare_output_folder(const std::string& wanted, const std::string& name,
                                            bool force);

}  // namespace cairn::app

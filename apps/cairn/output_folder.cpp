#include "output_folder.h"

#include <ctime>
#include <fstream>

#include "cairn/geometry/error.h"

namespace cairn::app {
namespace {

namespace fs = std::filesystem;

// What an earlier run may have left; a run that fails must not seem to have succeeded.
constexpr const char* kResults[] = {"trajectory.txt", "trajectory_live.txt", "keyframes.txt",
                                    "frames.csv",     "planes.json",         "objects.json",
                                    "map.ply",        "summary.json"};

fs::path default_folder(const std::string& name) {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "-%Y%m%d-%H%M%S", std::localtime(&now));
  const fs::path folder = fs::path("runs") / (name + text);
  fs::path free = folder;
  for (int i = 2; fs::exists(free); ++i) free = folder.string() + "-" + std::to_string(i);
  return free;
}

}  // namespace

fs::path prepare_output_folder(const std::string& wanted, const std::string& name, bool force) {
  fs::path folder = wanted.empty() ? default_folder(name) : fs::path(wanted);
  std::error_code error;
  if (fs::is_directory(folder, error) && !fs::is_empty(folder, error) && !error && !force) {
    throw Error(Error::Kind::kUsage,
                folder.string() +
                    ": there is something in this folder already; give another one, or --force to "
                    "replace the results in it");
  }
  auto refuse = [&](const std::string& why) {
    throw Error(Error::Kind::kOutput, folder.string() + ": this folder cannot be written (" + why +
                                          "); give another one");
  };
  fs::create_directories(folder, error);
  if (error) refuse(error.message());
  const fs::path probe = folder / ".cairn-probe";
  {
    std::ofstream file(probe);
    if (!(file << "cairn\n" << std::flush)) refuse("no file can be made in it");
  }
  fs::remove(probe, error);
  for (const char* result : kResults) fs::remove(folder / result, error);
  return folder;
}

}  // namespace cairn::app

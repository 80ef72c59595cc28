#pragma once

#include <stdexcept>
#include <string>

namespace cairn {

/// What went wrong at the boundary (files, options, cameras), for a person: one sentence that names
/// the file or option, what is wrong and what to do. `apps/` turns the kind into the exit code.
class Error : public std::runtime_error {
 public:
  enum class Kind {
    kUsage = 2,   ///< wrong option, configuration or calibration value
    kInput = 3,   ///< input that cannot be read
    kOutput = 4,  ///< output that cannot be written
  };

  Error(Kind kind, const std::string& sentence) : std::runtime_error(sentence), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace cairn

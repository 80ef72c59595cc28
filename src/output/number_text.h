#pragma once

#include <string>

namespace cairn {

/// The shortest text that reads back as the same number.
std::string exact_text(double value);

/// The same for a time in seconds, without an exponent and with six decimals at least.
std::string time_text(double seconds);

/// With so many decimals.
std::string fixed_text(double value, int decimals);

}  // namespace cairn

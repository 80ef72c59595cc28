#pragma once

#include <string>
#include <vector>

#include "commands.h"

namespace cairn::app {

/// What a map costs: kilobytes a keyframe from the initialisation to the end of each sequence, and
/// what a camera costs that stands still. Prints a table, or one JSON object; returns the exit
/// code.
int bench_memory(const std::vector<std::string>& data, int seeds, bool json);

}  // namespace cairn::app

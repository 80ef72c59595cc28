#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace cairn::app {

/// What a sub-command does once its options are parsed; returns the exit code.
using Action = std::function<int()>;

enum ExitCode { kDone = 0, kNoMap = 1, kInterrupted = 130 };  // 2, 3, 4: see Error::Kind

/// Each adds its sub-command and its options to the program, and says what to do when it is chosen.
/// `command`: as typed, for the records.
Action add_run(CLI::App& program, const std::string& command);
Action add_evaluate(CLI::App& program);
Action add_synth(CLI::App& program);
Action add_bench(CLI::App& program);
Action add_config(CLI::App& program);

}  // namespace cairn::app

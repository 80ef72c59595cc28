#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "cairn/geometry/error.h"
#include "commands.h"

namespace {

using namespace cairn::app;

constexpr int kWrongUsage = int(cairn::Error::Kind::kUsage);
constexpr int kCannotRead = int(cairn::Error::Kind::kInput);

int complain(const std::string& sentence, int exit_code) {
  std::fprintf(stderr, "cairn: %s\n", sentence.c_str());
  return exit_code;
}

std::string on_one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  return text;
}

std::map<std::string, Action> add_commands(CLI::App& program, int argc, char** argv) {
  std::string typed;
  for (int i = 0; i < argc; ++i) typed.append(i > 0 ? " " : "").append(argv[i]);
  program.set_version_flag("--version", "cairn " CAIRN_VERSION);
  program.require_subcommand(1);
  std::map<std::string, Action> actions;
  actions["run"] = add_run(program, typed);
  actions["evaluate"] = add_evaluate(program);
  actions["synth"] = add_synth(program);
  actions["bench"] = add_bench(program);
  actions["config"] = add_config(program);
  return actions;
}

int run_program(int argc, char** argv) {
  // Standard output belongs to results.
  spdlog::set_default_logger(spdlog::stderr_color_mt("cairn"));
  spdlog::set_level(spdlog::level::warn);
  spdlog::cfg::load_env_levels();  // SPDLOG_LEVEL=debug says what happens inside

  CLI::App program("Turns the pictures of one moving camera into a trajectory and a map.", "cairn");
  const auto actions = add_commands(program, argc, argv);
  try {
    program.parse(argc, argv);
    return actions.at(program.get_subcommands().front()->get_name())();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help, --version
    const auto chosen = program.get_subcommands();
    const std::string help = chosen.empty() ? "cairn" : "cairn " + chosen.front()->get_name();
    return complain(on_one_line(error.what()) + "; `" + help + " --help` shows what there is",
                    kWrongUsage);
  } catch (const cairn::Error& error) {
    return complain(error.what(), int(error.kind()));
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("cairn: there is not enough memory; give smaller pictures or a shorter sequence\n",
               stderr);
    return kCannotRead;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cairn: this should not happen, please report it: %s\n", error.what());
    return kWrongUsage;
  }
}

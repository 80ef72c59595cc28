#include <cstdio>

#include "cairn/system/option_table.h"
#include "commands.h"

namespace cairn::app {

Action add_config(CLI::App& program) {
  struct Arguments {
    std::string config;
    std::vector<std::string> settings;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "config", "Prints every configuration key as YAML that `cairn run --config` takes back");
  command->add_option("--config", arguments->config, "start from this file")->type_name("FILE");
  command->add_option("--set", arguments->settings, "and this setting")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  return [arguments] {
    Options options;
    OptionTable table(options);
    if (!arguments->config.empty()) table.load_yaml(arguments->config);
    for (const auto& setting : arguments->settings) table.set(setting);
    std::printf("# cairn %s: key, value, range and unit, meaning. Take it back with --config.\n%s",
                CAIRN_VERSION, table.print_yaml().c_str());
    return int(kDone);
  };
}

}  // namespace cairn::app

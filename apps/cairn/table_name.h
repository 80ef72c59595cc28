#pragma once

#include <string>

namespace cairn::app {

constexpr std::size_t kTableName = 24;  // letters

/// The name of a sequence as it fits into a table: of a long path the end.
inline std::string table_name(const std::string& name) {
  return name.size() <= kTableName ? name : "..." + name.substr(name.size() - (kTableName - 3));
}

}  // namespace cairn::app

#include "server/config/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "server/config/words.h"

namespace axisgate::server {

void read_access(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                 AccessConfig& access) {
  ConfigTable table(source, "access", file, errors);
  access.local = table.choice<Role>("local", kRoles).value_or(access.local);
  access.certificates = table.choice<Role>("certificates", kRoles).value_or(access.certificates);
  if (const auto commands = table.texts("admin_commands")) {
    const std::vector<std::string> all = AccessConfig().admin_commands;
    for (const std::string& command : *commands) {
      if (std::ranges::find(all, command) != all.end()) continue;
      table.error("admin_commands",
                  fmt::format("\"{}\" is not one of them; use some of \"{}\"", command, fmt::join(all, "\", \"")));
    }
    access.admin_commands = *commands;
  }
  if (const toml::table* roles = table.table("roles")) {
    ConfigTable named(*roles, "access.roles", file, errors);
    for (const auto& [caller, node] : *roles) {
      const auto role = named.choice<Role>(caller.str(), kRoles);
      if (role) access.roles[std::string(caller.str())] = *role;
      if (!caller.str().starts_with("unix ") && !caller.str().starts_with("cert ")) {
        named.error(caller.str(),
                    "is neither \"unix LOGIN\", as whom callers on the Unix socket are known, nor \"cert NAME\", after "
                    "the common name of a client certificate; tokens have the role that they were made with");
      }
    }
  }
  table.refuse_unknown();
}

}  // namespace axisgate::server

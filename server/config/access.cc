#include "server/config/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "server/config/words.h"

namespace axisgate::server {
namespace {

AdminKey sent_by(stage::AdminCommand::Request request) {
  switch (request) {
    case stage::AdminCommand::Request::none:
      break;
    case stage::AdminCommand::Request::clear_errors:
      return AdminKey::clear_errors;
    case stage::AdminCommand::Request::reset:
      return AdminKey::reset_device;
  }
  return AdminKey::none;
}

std::vector<AdminCommand> chosen(ConfigTable& table, const std::vector<std::string>& names,
                                 const std::vector<AdminCommand>& all) {
  std::vector<AdminCommand> commands;
  for (const std::string& name : names) {
    const auto known = std::ranges::find(all, name, &AdminCommand::name);
    if (known != all.end()) {
      commands.push_back(*known);
      continue;
    }
    std::string every;
    for (const AdminCommand& one : all) every += fmt::format("{}\"{}\"", every.empty() ? "" : ", ", one.name);
    table.error("admin_commands", fmt::format("\"{}\" is not one of them; use some of {}", name, every));
  }
  return commands;
}

}  // namespace

std::vector<AdminCommand> admin_commands(DeviceKinds kinds) {
  std::vector<AdminCommand> all;
  for (const stage::Kind* kind : kinds.stages) {
    for (const auto& command : kind->admin_commands()) {
      all.push_back({std::string(command.name), sent_by(command.request)});
    }
  }
  all.push_back({"take-over", AdminKey::take_over});
  return all;
}

void read_access(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                 AccessConfig& access) {
  ConfigTable table(source, "access", file, errors);
  access.local = table.choice<Role>("local", kRoles).value_or(access.local);
  access.certificates = table.choice<Role>("certificates", kRoles).value_or(access.certificates);
  if (const auto commands = table.texts("admin_commands")) {
    access.admin_commands = chosen(table, *commands, access.admin_commands);
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

#include "device/rml1/kind.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "device/config/config_file.h"
#include "device/core/explain.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/machine/profile_files.h"
#include "device/rml1/model.h"
#include "device/rml1/simulator/options.h"

namespace axisgate::rml1 {
namespace {

constexpr std::string_view kProfileRule = "the name of a profile, \"mdx-20\", or the absolute path of a file";

// Returns an empty path, and adds an error, if there is none.
std::string profile_path(ConfigTable& table, const std::string& name) {
  if (name.starts_with('/')) return name;
  if (name.find('/') != std::string::npos || name.ends_with(".toml")) {
    table.error("profile", fmt::format("\"{}\" is not an absolute path; use {}", name, kProfileRule));
    return {};
  }
  const auto file = profile_file(name);
  if (file) return file->string();
  table.error("profile", explain(file.error()));
  return {};
}

std::optional<Profile> read_profile(ConfigTable& table, const std::string& name, std::string& content,
                                    std::vector<ConfigError>& errors) {
  const std::string path = profile_path(table, name);
  if (path.empty()) return std::nullopt;
  const auto text = read_config_file(path);
  if (!text) {
    table.error("profile", fmt::format("{} {}; use {}", path, text.error(), kProfileRule));
    return std::nullopt;
  }
  content = *text;
  auto profile = parse_profile(content, path);
  if (profile) return *std::move(profile);
  errors.insert(errors.end(), profile.error().begin(), profile.error().end());
  return std::nullopt;
}

class Rml1 final : public jobs::Kind {
 public:
  std::string_view name() const override { return "rml1"; }

  std::shared_ptr<const jobs::Model> read_model(ConfigTable& table, std::vector<ConfigError>& errors) const override {
    const std::optional<std::string> name = table.text("profile");
    if (!name && !table.has("profile")) table.missing("profile", kProfileRule);
    std::string text;
    std::optional<Profile> profile;
    if (name) profile = read_profile(table, *name, text, errors);
    if (!profile) return nullptr;
    return std::make_shared<const MillModel>(*name, std::move(text), *std::move(profile), known_machines());
  }

  Result<void> check_option(std::string_view name, std::string_view value) const override {
    return simulator::Options().set(name, value);
  }
};

}  // namespace

const jobs::Kind& kind() {
  static const Rml1 kind;
  return kind;
}

}  // namespace axisgate::rml1

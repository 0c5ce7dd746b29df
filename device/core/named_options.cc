#include "device/core/named_options.h"

#include <algorithm>

namespace axisgate {
namespace {

template <class List, class Text>
std::string listed(const List& list, Text text) {
  std::string all;
  for (const auto& one : list) all += (all.empty() ? "" : ", ") + std::string(text(one));
  return all;
}

}  // namespace

NamedOptions::NamedOptions(std::span<const OptionName> names, std::string_view device)
    : names_(names), device_(device) {
  for (const OptionName& option : names_) chosen_.push_back(option.values.front());
}

Result<void> NamedOptions::set(std::string_view name, std::string_view value) {
  const auto option = std::find_if(names_.begin(), names_.end(), [&](const OptionName& o) { return o.name == name; });
  const std::string device(device_);
  const std::string named(name);
  if (option == names_.end()) {
    return fail(Reason::invalid_request, "The " + device + " has no option '" + named + "'.",
                "Name one of: " + listed(names_, [](const OptionName& o) { return o.name; }) + ".");
  }
  const auto chosen = std::find(option->values.begin(), option->values.end(), value);
  if (chosen == option->values.end()) {
    return fail(Reason::invalid_request,
                "The option '" + named + "' of the " + device + " cannot be '" + std::string(value) + "'.",
                "Give one of: " + listed(option->values, [](std::string_view v) { return v; }) + ".");
  }
  chosen_[static_cast<std::size_t>(option - names_.begin())] = *chosen;
  return {};
}

std::string_view NamedOptions::get(std::string_view name) const {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i].name == name) return chosen_[i];
  }
  return {};
}

std::string NamedOptions::describe() const {
  std::string text;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    text += (i == 0 ? "" : " ") + std::string(names_[i].name) + "=" + std::string(chosen_[i]);
  }
  return text;
}

}  // namespace axisgate

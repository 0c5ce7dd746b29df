// One TOML table, read strictly: each key is requested with its type and range, and a key that the code never requests
// is an error. An error names the file, the line, the key, the mistake and the allowed values. Include this header in
// few files: toml++ is slow to compile.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/config/config_error.h"

namespace axisgate {

class ConfigTable {
 public:
  template <class T>
  using Choices = std::span<const std::pair<std::string_view, T>>;

  // `path` is the table's name in errors, "" for the file's root. The table and the error list must outlive this
  // object.
  ConfigTable(const toml::table& table, std::string path, std::string_view file, std::vector<ConfigError>& errors)
      : table_(table), path_(std::move(path)), file_(file), errors_(errors) {}

  bool has(std::string_view key) const { return table_.contains(key); }

  std::optional<std::string> text(std::string_view key) { return typed<std::string>(key, "a text in quotes"); }

  std::optional<bool> flag(std::string_view key) { return typed<bool>(key, "true or false"); }

  std::optional<std::int64_t> integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) {
    const std::string allowed = "a whole number from " + std::to_string(minimum) + " to " + std::to_string(maximum);
    const std::optional<std::int64_t> value = typed<std::int64_t>(key, allowed);
    if (value && (*value < minimum || *value > maximum)) {
      error(key, std::to_string(*value) + " is out of range; use " + allowed);
      return std::nullopt;
    }
    return value;
  }

  std::optional<double> number(std::string_view key, double minimum, double maximum, std::string_view allowed) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !(*value >= minimum && *value <= maximum)) {
      error(key, shown(*node) + " will not do; use " + std::string(allowed));
      return std::nullopt;
    }
    return value;
  }

  template <class T>
  std::optional<T> choice(std::string_view key, Choices<T> choices) {
    std::string allowed;
    for (const auto& [word, value] : choices) allowed += (allowed.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    const std::optional<std::string> word = typed<std::string>(key, "one of " + allowed);
    if (!word) return std::nullopt;
    for (const auto& [known, value] : choices) {
      if (known == *word) return value;
    }
    error(key, "\"" + *word + "\" is not known; use one of " + allowed);
    return std::nullopt;
  }

  const toml::table* table(std::string_view key) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) wrong_type(key, *node, "a table, { NAME = \"VALUE\" }");
    return node == nullptr ? nullptr : node->as_table();
  }

  // Checks the type of the key's value without reporting an error.
  bool holds_text(std::string_view key) const { return table_.get(key) != nullptr && table_.get(key)->is_string(); }
  bool holds_table(std::string_view key) const { return table_.get(key) != nullptr && table_.get(key)->is_table(); }

  std::optional<std::vector<std::string>> texts(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const toml::array* array = node->as_array();
    std::vector<std::string> found;
    for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
      if (const auto text = array->get(i)->value_exact<std::string>()) found.push_back(*text);
    }
    if (array != nullptr && found.size() == array->size()) return found;
    wrong_type(key, *node, "a list of texts, [\"A\", \"B\"]");
    return std::nullopt;
  }

  // Accepts the key without reading it.
  void allow(std::string_view key) { asked_.emplace_back(key); }

  // Returns the tables of [[key]].
  std::vector<const toml::table*> tables(std::string_view key) {
    std::vector<const toml::table*> found;
    const toml::node* node = find(key);
    if (node == nullptr) return found;
    if (!node->is_array_of_tables()) {
      wrong_type(key, *node, "[[" + qualified(key) + "]]");
      return found;
    }
    for (const toml::node& element : *node->as_array()) found.push_back(element.as_table());
    return found;
  }

  void missing(std::string_view key, std::string_view allowed) {
    errors_.push_back({file_, line(table_), qualified(key), "is missing; use " + std::string(allowed)});
  }

  // Reports an error at the key's line, or at the table's line if the key is absent.
  void error(std::string_view key, std::string message) {
    const toml::node* node = table_.get(key);
    errors_.push_back({file_, line(node != nullptr ? *node : table_), qualified(key), std::move(message)});
  }

  void refuse_unknown() {
    std::string allowed;
    for (const std::string& key : asked_) allowed += (allowed.empty() ? "" : ", ") + key;
    for (const auto& [key, node] : table_) {
      if (std::find(asked_.begin(), asked_.end(), key.str()) != asked_.end()) continue;
      errors_.push_back({file_, line(node), qualified(key.str()), "is not a key here; use " + allowed});
    }
  }

 private:
  static std::uint32_t line(const toml::node& node) { return node.source().begin.line; }

  std::string qualified(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  }

  static std::string shown(const toml::node& node) {
    if (node.is_string()) return "the text \"" + node.as_string()->get() + "\"";
    if (node.is_integer()) return std::to_string(node.as_integer()->get());
    if (node.is_floating_point()) return "the number " + std::to_string(node.as_floating_point()->get());
    if (node.is_boolean()) return node.as_boolean()->get() ? "true" : "false";
    if (node.is_table()) return "a table";
    return node.is_array() ? "a list" : "a date or time";
  }

  void wrong_type(std::string_view key, const toml::node& node, std::string_view allowed) {
    error(key, shown(node) + " will not do; use " + std::string(allowed));
  }

  const toml::node* find(std::string_view key) {
    asked_.emplace_back(key);
    return table_.get(key);
  }

  template <class T>
  std::optional<T> typed(std::string_view key, std::string_view allowed) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<T> value = node->value_exact<T>();
    if (!value) wrong_type(key, *node, allowed);
    return value;
  }

  const toml::table& table_;
  std::string path_;
  std::string file_;
  std::vector<ConfigError>& errors_;
  std::vector<std::string> asked_;
};

}  // namespace axisgate

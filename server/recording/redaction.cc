#include "server/recording/redaction.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "device/stage/own_questions.h"

namespace axisgate::server {
namespace {

constexpr std::string_view kById = "/dev/serial/by-id/";

// Returns the identification before a caller's name, such as "unix ". Empty if there is none.
std::string_view way_of(std::string_view caller) {
  for (const std::string_view way : {"unix ", "cert ", "tcp ", "token "}) {
    if (caller.starts_with(way)) return way;
  }
  return {};
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool whole_number(std::string_view text, std::size_t at, std::size_t size) {
  const bool before = at > 0 && is_digit(text[at - 1]);
  return !before && (at + size == text.size() || !is_digit(text[at + size]));
}

void replace_all(std::string& text, std::string_view secret, std::string_view stand_in, bool number) {
  for (std::size_t at = text.find(secret); at != std::string::npos; at = text.find(secret, at)) {
    const bool part = number && !whole_number(text, at, secret.size());
    if (!part) text.replace(at, secret.size(), stand_in);
    at += part ? secret.size() : stand_in.size();
  }
}

// Returns the end of the text that is quoted from `begin` on (device/core/escape.h): its closing quote, or the end of
// `text`.
std::size_t end_of_quoted(std::string_view text, std::size_t begin) {
  while (begin < text.size() && text[begin] != '"') begin += text[begin] == '\\' ? 2 : 1;
  return std::min(begin, text.size());
}

// Text that the controller sent, joined across lines, with the position of each character in the recording.
struct Received {
  explicit Received(std::string_view lines) {
    constexpr std::string_view kPiece = " < \"";
    for (std::size_t at = lines.find(kPiece); at != std::string_view::npos; at = lines.find(kPiece, at)) {
      at += kPiece.size();
      for (const std::size_t end = end_of_quoted(lines, at); at < end; ++at) {
        text += lines[at];
        places.push_back(at);
      }
    }
  }

  std::string text;
  std::vector<std::size_t> places;
};

// The stand-in of a number has the length of the number.
void replace_number(std::string& lines, const Received& received, std::string_view number, std::string_view stand_in) {
  for (std::size_t at = received.text.find(number); at != std::string::npos; at = received.text.find(number, at + 1)) {
    if (!whole_number(received.text, at, number.size())) continue;
    for (std::size_t i = 0; i < number.size(); ++i) lines[received.places[at + i]] = stand_in[i];
  }
}

}  // namespace

std::string Redactor::hide(Kind kind, const std::string& secret) {
  const bool shown = kind == Kind::path && secret.starts_with("/dev/") && !secret.starts_with(kById);
  if (secret.empty() || shown) return secret;
  if (kind == Kind::user) {
    const auto [entry, added] = users_.try_emplace(secret);
    if (added) entry->second = stand_in(kind, secret);
    return entry->second;
  }
  const auto known = std::ranges::find(secrets_, secret, &Secret::text);
  if (known != secrets_.end()) return known->stand_in;
  const std::string replacement = stand_in(kind, secret);
  const auto place = std::ranges::find_if(secrets_, [&](const Secret& s) { return s.text.size() < secret.size(); });
  secrets_.insert(place, {secret, replacement, kind == Kind::serial_number});
  return replacement;
}

std::string Redactor::stand_in(Kind kind, const std::string& secret) {
  const int count = ++counts_[static_cast<std::size_t>(kind)];
  switch (kind) {
    case Kind::serial_number:  // still digits of the same number, so that the recording can be replayed
      return fmt::format("{:0{}}", count, secret.size());
    case Kind::user:
      return fmt::format("user-{}", count);
    case Kind::host:
      return fmt::format("host-{}", count);
    case Kind::path:
      break;
  }
  return fmt::format("{}path-{}", secret.starts_with(kById) ? kById : "/", count);
}

std::string Redactor::redact(std::string_view text) {
  const Received received(text);
  learn_serial_numbers(received.text, "SHRC-203,");  // SIGMAKOKI,SHRC-203,12345678,V1.00: manual 1) *IDN?
  learn_serial_numbers(text, "SHRC-203 ");           // as shown to people
  std::string clean(text);
  for (const Secret& secret : secrets_) {
    if (secret.number) replace_number(clean, received, secret.text, secret.stand_in);
  }
  for (const Secret& secret : secrets_) replace_all(clean, secret.text, secret.stand_in, secret.number);
  hide_callers(clean);
  return clean;
}

Config Redactor::redact(Config config) {
  config.socket = hide(Kind::path, config.socket);
  if (config.network) {
    for (std::string* path : {&config.network->certificate, &config.network->key, &config.network->client_ca}) {
      *path = hide(Kind::path, *path);
    }
    const std::string& host = config.network->listen.host;
    if (host != "0.0.0.0" && host != "::") config.network->listen.host = hide(Kind::host, host);
  }
  const auto hidden = [this](const std::string& caller) {
    const std::string way(way_of(caller));
    return way + hide(Kind::user, caller.substr(way.size()));
  };
  for (const auto& [who, role] : std::exchange(config.access.roles, {})) config.access.roles[hidden(who)] = role;
  const auto hide_stage = [&](StageConfig& stage) {
    stage.profile.serial_number = hide(Kind::serial_number, stage.profile.serial_number);
    for (stage::AxisProfile& axis : stage.profile.axes) {
      for (stage::LimitOverride& limits : axis.overrides) {
        if (!role_named(limits.whose)) limits.whose = hidden(limits.whose);
      }
    }
  };
  const auto hide_mill = [&](MillConfig& mill) {
    if (mill.profile_name.starts_with('/')) mill.profile_name = hide(Kind::path, mill.profile_name);
    for (std::string& caller : mill.station) {
      if (caller != kAnybodyOnUnix) caller = hidden(caller);
    }
  };
  for (DeviceConfig& device : config.devices) {
    device.record = hide(Kind::path, device.record);
    if (auto* serial = std::get_if<SerialSettings>(&device.connection)) serial->path = hide(Kind::path, serial->path);
    if (auto* printer = std::get_if<PrinterSettings>(&device.connection)) {
      printer->path = hide(Kind::path, printer->path);
    }
    if (auto* tcp = std::get_if<TcpSettings>(&device.connection)) tcp->host = hide(Kind::host, tcp->host);
    if (auto* stage = std::get_if<StageConfig>(&device.family)) hide_stage(*stage);
    if (auto* mill = std::get_if<MillConfig>(&device.family)) hide_mill(*mill);
  }
  return config;
}

std::string Redactor::summary() const {
  constexpr std::array<std::string_view, 4> kNames = {"serial number", "user", "host", "path"};
  std::string text;
  for (std::size_t kind = 0; kind < counts_.size(); ++kind) {
    text +=
        fmt::format("{}{} {}{}", text.empty() ? "" : ", ", counts_[kind], kNames[kind], counts_[kind] == 1 ? "" : "s");
  }
  return text;
}

// Also learns the number from an incomplete answer.
void Redactor::learn_serial_numbers(std::string_view text, std::string_view before) {
  constexpr std::size_t kDigitsMin = 4;
  for (std::size_t at = text.find(before); at != std::string_view::npos; at = text.find(before, at)) {
    at += before.size();
    const std::string_view number = text.substr(at, text.find_first_not_of("0123456789", at) - at);
    if (number.size() >= kDigitsMin) hide(Kind::serial_number, std::string(number));
  }
}

// Hides the name in an exchange such as 12.345678 #17 poll "unix alice" > "Q:S\r\n". The identification stays.
void Redactor::hide_callers(std::string& lines) {
  for (std::size_t line = 0; line < lines.size(); line = std::min(lines.find('\n', line), lines.size() - 1) + 1) {
    std::size_t caller = std::min(lines.find('"', line), lines.size()) + 1;
    if (!is_digit(lines[line]) || caller >= std::min(lines.find('\n', line), lines.size())) continue;
    const std::string_view before(lines.data() + line, caller - 1 - line);
    if (before.ends_with("> ") || before.ends_with("< ") || before.ends_with("unexpected ")) continue;
    const std::size_t end = end_of_quoted(lines, caller);
    caller += way_of(std::string_view(lines).substr(caller)).size();
    const std::string name = lines.substr(caller, end - caller);
    if (name != stage::kGateway) lines.replace(caller, name.size(), hide(Kind::user, name));
  }
}

}  // namespace axisgate::server

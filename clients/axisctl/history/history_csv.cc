#include "clients/axisctl/history/history_csv.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

std::string csv_quoted(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

std::string kind_text(v1::HistoryKind kind) {
  const std::string& name = v1::HistoryKind_Name(kind);
  return name.empty() ? std::to_string(kind) : name.substr(std::string_view("HISTORY_KIND_").size());
}

}  // namespace

std::string csv_row(const v1::HistoryEntry& entry) {
  return fmt::format("{},{},{},{},{},{},{}", entry.number(), google::protobuf::util::TimeUtil::ToString(entry.time()),
                     kind_text(entry.kind()), csv_quoted(last_part(entry.device())), csv_quoted(entry.caller().name()),
                     last_part(entry.motion()), csv_quoted(entry.details()));
}

}  // namespace axisgate::axisctl

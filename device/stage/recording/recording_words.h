// The words of a recording's text, for its writer and its reader.
#pragma once

#include <array>
#include <string_view>

#include "device/stage/recording/recording.h"

namespace axisgate::stage {

inline constexpr std::string_view kFirstLine = "# axisgate recording 1";
inline constexpr std::string_view kKind = "shrc203";
inline constexpr std::string_view kKindKey = "kind", kDeviceKey = "device", kSerialNumberKey = "serial-number",
                                  kBaudKey = "baud", kReplyLimitKey = "reply-limit", kStartedKey = "started",
                                  kAxesKey = "axes", kMayCompleteKey = "may-complete";
inline constexpr std::string_view kNoAxes = "none";
inline constexpr std::string_view kWaited = "waited", kCompletes = "completes", kClosed = "closed";

inline constexpr std::array kItemKinds = {RecordedItem::Kind::written, RecordedItem::Kind::received,
                                          RecordedItem::Kind::ended, RecordedItem::Kind::completion,
                                          RecordedItem::Kind::unexpected};

inline std::string_view word(RecordedItem::Kind kind) {
  constexpr std::array<std::string_view, kItemKinds.size()> kWords = {">", "<", "=", "completion", "unexpected"};
  return kWords[static_cast<std::size_t>(kind)];
}

// Kinds that have a time: all but notes. No word in this order is a prefix of a later one.
inline constexpr std::array kRemarkKinds = {RecordedRemark::Kind::connecting, RecordedRemark::Kind::up,
                                            RecordedRemark::Kind::down,       RecordedRemark::Kind::barrier_passed,
                                            RecordedRemark::Kind::barrier,    RecordedRemark::Kind::same_controller,
                                            RecordedRemark::Kind::ready,      RecordedRemark::Kind::busy};

inline std::string_view word(RecordedRemark::Kind kind) {
  switch (kind) {
    case RecordedRemark::Kind::connecting:
      return "link connecting";
    case RecordedRemark::Kind::up:
      return "link up";
    case RecordedRemark::Kind::down:
      return "link down";
    case RecordedRemark::Kind::barrier:
      return "barrier";
    case RecordedRemark::Kind::barrier_passed:
      return "barrier passed";
    case RecordedRemark::Kind::same_controller:
      return "same controller";
    case RecordedRemark::Kind::ready:
      return "ready";
    case RecordedRemark::Kind::busy:
      return "busy";
    case RecordedRemark::Kind::note:
      break;
  }
  return "";
}

inline bool names_axes(RecordedRemark::Kind kind) {
  return kind == RecordedRemark::Kind::up || kind == RecordedRemark::Kind::ready || kind == RecordedRemark::Kind::busy;
}

inline bool says_why(RecordedRemark::Kind kind) {
  return kind == RecordedRemark::Kind::down || kind == RecordedRemark::Kind::barrier;
}

}  // namespace axisgate::stage

// Output of axisctl, and the texts for values and events.
#pragma once

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/message.h>
#include <google/protobuf/timestamp.pb.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/event.pb.h"
#include "clients/axisctl/failure.h"
#include "device/core/quantity.h"

namespace axisgate::axisctl {

// Prints a line on the standard output and flushes it at once, for readers at a pipe.
void print_line(std::string_view text);

// Prints a message likewise, as one JSON object with the field names of proto/axisgate/v1.
void print_json(const google::protobuf::Message& message);

// Prints "axisctl: REASON: message (hint)" on the standard error, as one line.
void print_failure(const Failure& failure);

// Prints "axisctl: message" on the standard error: information for people during the run.
void print_note(std::string_view message);

// Replaces control characters by spaces. Names and messages may quote a device or a caller; their bytes must not
// control the terminal or break the line.
std::string on_one_line(std::string_view text);

// Returns "axis x", or "axis 1" for an axis without a name. A position is never printed after a bare number: "1 2500
// um" could be read as 12500 um.
std::string axis_label(const v1::Axis& axis);

Unit core_unit(v1::Unit unit);

// Returns "2.5 mm" or "370 deg (10 deg in the turn)"; in pulses if the resolution is unknown; "unknown" if the position
// is unknown.
std::string position_text(const v1::Axis& axis);
std::string position_text(const v1::Axis& axis, std::int64_t pulses);

// Returns "axis x at 2.5 mm".
std::string place_text(const v1::Axis& axis, std::int64_t pulses);

// Returns "50000 pulse/s", or "?" if unknown.
std::string speed_text(const v1::Speed& speed);

// Returns "OUT1 OUT3" for pins 1 and 3 and "OUT"; "none" if no pin is on.
std::string pins_text(const v1::Pins& pins, std::string_view name);

// Returns "unix anna, unix bert".
std::string names_text(const google::protobuf::RepeatedPtrField<v1::Caller>& callers);

// Return mode and command format as the controller writes them, a number that this version does not know as this
// number, and an empty text for the unspecified value.
std::string mode_text(v1::Mode mode);
std::string format_text(v1::CommandFormat format);

std::int64_t milliseconds(const google::protobuf::Duration& duration);

// Returns "every 500 drive pulses of axis 2".
std::string trigger_text(const v1::Trigger& trigger);

// Returns "axis x ran from -0.1 mm to 1.1 mm; 101 trigger pulses expected in the range, 121 in all; 121 computed from
// the observed displacement".
std::string scan_text(const v1::Axis& axis, const v1::Scan& scan);

// Returns "axis x: 2.5 mm, axis y: 0 mm" for the controllable axes.
std::string positions_text(const v1::Device& device);

// Returns the event as one line: "segment 3 sent: OK_D", "axis 1 completed", "motion 5 (move) RUNNING" ...
std::string describe(const v1::Event& event);

// Returns "return-to-origin" for MOTION_KIND_RETURN_TO_ORIGIN.
std::string kind_name(v1::MotionKind kind);

// Returns the value without the prefix of its enum: "RUNNING" for MOTION_STATE_RUNNING.
std::string state_name(v1::MotionState state);
std::string link_name(v1::LinkState state);

// Returns the local time: "2026-11-21 16:00:00+01:00".
std::string time_text(const google::protobuf::Timestamp& time);
std::string utc_offset(const std::tm& local);  // "+01:00"

// Returns "1.5 s", "3 min 20 s", "2 h 5 min" or "3 d 4 h"; "0 s" if the clock was set back in between.
std::string duration_text(const google::protobuf::Timestamp& from, const google::protobuf::Timestamp& to);
std::string duration_text(const google::protobuf::Duration& duration);

// Returns "5" for "devices/stage/motions/5".
std::string_view last_part(std::string_view resource);

}  // namespace axisgate::axisctl

// Everything that axisctl writes.
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

// A line on the standard output, flushed at once: a reader at a pipe sees it when it happens.
void print_line(std::string_view text);

// The same, one JSON object with the field names of proto/axisgate/v1.
void print_json(const google::protobuf::Message& message);

// "axisctl: REASON: message (hint)" on the standard error, one line.
void print_failure(const Failure& failure);

// "axisctl: message" on the standard error: something that a person wants to know meanwhile.
void print_note(std::string_view message);

// Names and messages may quote a device or a caller: no byte of it steers a terminal or breaks the line.
std::string on_one_line(std::string_view text);

// "axis x", or "axis 1" of an axis without a name. A position is never printed after a bare number: a person reads
// "1 2500 um" as 12500 um.
std::string axis_label(const v1::Axis& axis);

Unit core_unit(v1::Unit unit);

// "2.5 mm", "370 deg (10 deg in the turn)"; in pulses where the scale is not known; "unknown" where the position is
// not.
std::string position_text(const v1::Axis& axis);
std::string position_text(const v1::Axis& axis, std::int64_t pulses);

// "axis x at 2.5 mm".
std::string place_text(const v1::Axis& axis, std::int64_t pulses);

// "50000 pulse/s"; "?" where it is not known.
std::string speed_text(const v1::Speed& speed);

// "OUT1 OUT3" of 5 and "OUT", as the controller numbers its six outputs and inputs; "none" of 0.
std::string pins_text(int bits, std::string_view name);

// "every 500 drive pulses of axis 2".
std::string trigger_text(const v1::Trigger& trigger);

// "axis x ran from -0.1 mm to 1.1 mm; 101 trigger pulses expected in the range, 121 in all; 121 computed from the
// observed displacement".
std::string scan_text(const v1::Axis& axis, const v1::Scan& scan);

// "axis x: 2.5 mm, axis y: 0 mm", the controllable axes.
std::string positions_text(const v1::Device& device);

// "segment 3 sent: OK_D", "axis 1 completed", "motion 5 (move) RUNNING" ...
std::string describe(const v1::Event& event);

// "return-to-origin".
std::string kind_name(v1::MotionKind kind);

// "RUNNING" of MOTION_STATE_RUNNING: an enum value without the name of its enum.
std::string state_name(v1::MotionState state);
std::string link_name(v1::LinkState state);

// "2026-11-21 16:00:00", the local time.
std::string time_text(const google::protobuf::Timestamp& time);
std::string utc_offset(const std::tm& local);  // "+01:00"

// "1.5 s", "3 min 20 s", "2 h 5 min", "3 d 4 h". Of a clock that was set back in between: "0 s".
std::string duration_text(const google::protobuf::Timestamp& from, const google::protobuf::Timestamp& to);
std::string duration_text(const google::protobuf::Duration& duration);

// "5" of "devices/stage/motions/5".
std::string_view last_part(std::string_view resource);

}  // namespace axisgate::axisctl

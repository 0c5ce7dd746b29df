// Words of the configuration for values that are a choice.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "device/link/serial_port.h"
#include "device/stage/profile.h"
#include "server/access/roles.h"
#include "server/config/config.h"

namespace axisgate::server {

inline constexpr std::array<std::pair<std::string_view, Parity>, 3> kParities = {
    {{"none", Parity::none}, {"even", Parity::even}, {"odd", Parity::odd}}};
inline constexpr std::array<std::pair<std::string_view, FlowControl>, 4> kFlowControls = {
    {{"rtscts", FlowControl::rts_cts},
     {"xonxoff", FlowControl::xon_xoff},
     {"dtr_dsr", FlowControl::dtr_dsr},
     {"none", FlowControl::none}}};
// Values of `unavailable`: whether motions and changes are allowed if the disk refuses the journal.
inline constexpr std::array<std::pair<std::string_view, bool>, 2> kUnavailable = {{{"refuse", false}, {"act", true}}};
inline constexpr std::array<std::pair<std::string_view, bool>, 2> kStageKinds = {{{"linear", false}, {"rotary", true}}};
inline constexpr std::array<std::pair<std::string_view, Role>, 4> kRoles = {
    {{"nobody", Role::nobody}, {"observer", Role::observer}, {"operator", Role::operator_}, {"admin", Role::admin}}};
inline constexpr std::array<std::pair<std::string_view, stage::AtExit>, 2> kAtExit = {
    {{"stop", stage::AtExit::stop}, {"finish", stage::AtExit::finish}}};
inline constexpr std::array<std::pair<std::string_view, stage::AtLeaseEnd>, 2> kAtLeaseEnd = {
    {{"restored", stage::AtLeaseEnd::restored}, {"kept", stage::AtLeaseEnd::kept}}};
inline constexpr std::array<std::pair<std::string_view, jobs::Streaming>, 2> kStreamings = {
    {{"paced", jobs::Streaming::paced}, {"full", jobs::Streaming::full}}};
// Word for `slack` instead of a number.
inline constexpr std::string_view kMeasured = "measured";
inline constexpr std::array<std::pair<std::string_view, jobs::AtLoss>, 2> kMillAtLoss = {
    {{"abort", jobs::AtLoss::abort}, {"leave", jobs::AtLoss::leave}}};
inline constexpr std::array<std::pair<std::string_view, MillConfig::AtExit>, 2> kMillAtExit = {
    {{"abort", MillConfig::AtExit::abort}, {"finish", MillConfig::AtExit::finish}}};

}  // namespace axisgate::server

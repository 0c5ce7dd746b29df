// Typed calls and verbs for each command that has them, typed by hand.
#include "tests/conformance/commands_page.h"

namespace axisgate::shrc203::conformance {
namespace {

constexpr std::string_view kTold = "DeviceService.GetDevice";
constexpr std::string_view kAsked = "SettingService.GetSettings";
constexpr std::string_view kToldAndAsked = "DeviceService.GetDevice, SettingService.GetSettings";
constexpr std::string_view kChanged = "SettingService.ChangeSettings";
constexpr std::string_view kCoordinates = "SettingService.SetCoordinates";
constexpr std::string_view kMoved = "StageService.Move";
constexpr std::string_view kSaved = "PositionService.SavePosition";
constexpr std::string_view kForgotten = "PositionService.DeletePosition";
constexpr std::string_view kGone = "PositionService.MoveToPosition";
constexpr std::string_view kMovedOrRun = "StageService.Move, StageService.RunPath";
constexpr std::string_view kRun = "StageService.RunPath";
constexpr std::string_view kChangedOrScanned = "SettingService.ChangeSettings, StageService.Scan";

constexpr TypedCall kTypedCalls[] = {
    // Questions.
    {"*IDN?", kTold, "status"},
    {"!:", kTold, "status"},
    {"!:S", kTold, "status"},
    {"Q:", kTold, "status, position"},
    {"Q:S", kTold, "status, position"},
    {"SRQ:", kTold, "status"},
    {"SRQ:S", kTold, "status"},
    {"?:V", kTold, "status"},
    {"?:R", kAsked, "settings"},
    {"?:P", kTold, "--json status"},
    {"?:S", kAsked, "settings"},
    {"?:AN", kAsked, "settings"},
    {"?:D", kToldAndAsked, "status, speed"},
    {"?:DS", kToldAndAsked, "status, speed"},
    {"?:DF", kToldAndAsked, "status, speed"},
    {"?:DR", kToldAndAsked, "status, speed"},
    {"?:B", kAsked, "speed --origin-return"},
    {"?:O", kToldAndAsked, "status, outputs"},
    {"?:W", kAsked, "settings"},
    {"?:N", kTold, "status"},
    {"?:C", kToldAndAsked, "status, settings"},
    {"?:F", kAsked, "settings"},
    {"?:SLEEP", kAsked, "settings"},
    {"?:BO", kAsked, "settings"},
    {"?:MODE", kToldAndAsked, "status, settings"},
    {"?:FMT", kToldAndAsked, "status, settings"},
    {"?:BEEP", kAsked, "settings"},
    {"?:T", kToldAndAsked, "status, settings"},
    {"?:SN", kTold, "status"},
    {"?:AXIS", kTold, "status"},
    {"I:", kAsked, "inputs"},
    // Settings.
    {"PSET:", kCoordinates, "preset"},
    {"RESET:", "SettingService.ResetDevice", "reset"},
    {"SLEEP:", kChanged, "sleep, wake"},
    {"BO:", kChanged, "display"},
    {"MODE:", kChanged, "mode"},
    {"FMT:", kChanged, "dialect"},
    {"F:", kChanged, "loop"},
    {"C:", kChanged, "motor"},
    {"BEC:", "DeviceService.ClearErrors", "clear"},
    {"BEEP:", kChanged, "beep"},
    {"S:", kChanged, "divisions"},
    {"W:", kChanged, "settle"},
    {"R:", kCoordinates, "zero"},
    {"RC:", kCoordinates, "unzero"},
    {"D:", kChanged, "speed"},
    {"DS:", kChanged, "speed"},
    {"DF:", kChanged, "speed"},
    {"DR:", kChanged, "speed"},
    {"B:", kChanged, "speed --origin-return"},
    {"O:", kChanged, "outputs"},
    {"T:T", kChanged, "trigger every"},
    {"T:P", kChangedOrScanned, "trigger every, scan"},
    {"T:S", kChangedOrScanned, "trigger off, scan"},
    {"T:M", "SettingService.FireTrigger", "trigger fire"},
    {"T:E", kChangedOrScanned, "trigger every, scan --scale"},
    // Motion.
    {"H:", "StageService.Home", "home"},
    {"HRT:", "StageService.Home", "home"},
    {"Z:", "StageService.ReturnToOrigin", "home --logical"},
    {"ZRT:", "StageService.ReturnToOrigin", "home --logical"},
    {"L:", "StageService.Stop", "stop"},
    {"L:E", "StageService.EmergencyStop", "estop"},
    {"M:", kMoved, "move"},
    {"MP:", kMovedOrRun, "move, path"},
    {"A:", kMoved, "move"},
    {"AP:", kMovedOrRun, "move, path"},
    {"K:", kRun, "line, path"},
    {"KP:", kRun, "line, path"},
    {"E:0", kRun, "arc, path"},
    {"E:1", kRun, "arc, path"},
    {"E:2", kRun, "arc, path"},
    {"E:3", kRun, "arc, path"},
    {"E:4", kRun, "arc, path"},
    {"E:5", kRun, "arc, path"},
    {"EP:0", kRun, "arc, path"},
    {"EP:1", kRun, "arc, path"},
    {"EP:2", kRun, "arc, path"},
    {"EP:3", kRun, "arc, path"},
    {"EP:4", kRun, "arc, path"},
    {"EP:5", kRun, "arc, path"},
    {"WT:", kRun, "path"},
    {"WI:", kRun, "path"},
    {"G:", "StageService.Move, StageService.RunPath, StageService.Scan, StageService.Jog", "move, path, scan, jog"},
    {"J:", "StageService.Jog", "jog"},
    {"JD:", "StageService.Jog", "jog"},
    // Saved positions.
    {"PIT:DEL", kForgotten, "forget"},
    {"PIT:SET", kSaved, "save"},
    {"PIT:GET", kSaved, "save"},
    {"PIT:G", kGone, "go"},
    {"PIT:GRT", kGone, "go"},
    {"PAV:DEL", kForgotten, "forget"},
    {"PAV:SET", kSaved, "save --coordinates"},
    {"PAV:GET", kSaved, "save --coordinates"},
    {"PAV:G", kGone, "go"},
    {"PAV:GRT", kGone, "go"},
};

}  // namespace

std::span<const TypedCall> typed_calls() { return kTypedCalls; }

}  // namespace axisgate::shrc203::conformance

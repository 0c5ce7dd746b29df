#include "clients/axisctl/help_topics.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::axisctl {
namespace {

constexpr HelpTopic kTopics[] = {
    {"devices", "", "axisctl devices"},
    {"status", "A ? stands where nobody knows.", "axisctl status\naxisctl --json status"},
    {"position", "", "axisctl position"},
    {"commands", "", "axisctl commands M:"},
    {"home", "", "axisctl home 1,2"},
    {"move",
     R"(An amount is a position, with --relative a way. `axisctl help units` says how to write it. With --approach each axis
comes to its target by that way in the end, always from the same side, so that the play of its screw does not count.)",
     R"(axisctl move 1=+1mm 2=-200um --relative --speed 2mm/s
axisctl move 1=0.5mm --wait 60
axisctl move 1=0.4mm 2=0 --approach 10um)"},
    {"path", "`axisctl help paths` says how a segment is written.",
     R"(printf '1=1mm 2=-500um speed=2mm/s\n1=-1mm 2=500um\n' | axisctl path -
printf '1=0.1mm 2=0\naround 1=0 2=50um ccw 180deg\n1=-0.1mm 2=0 rest=0.5s\n' | axisctl path - --speed 1mm/s)"},
    {"line", "A path of one straight line; `axisctl help paths` says how it is written.",
     "axisctl line 1=0.1mm 2=-50um --speed 1mm/s"},
    {"arc", "A path of one arc; `axisctl help paths` says how it is written.",
     R"(axisctl arc around 1=0 2=50um ccw 90deg --speed 1mm/s
axisctl arc through 1=20um 2=30um to 1=50um 2=20um --speed 1mm/s)"},
    {"scan",
     R"(The controller compares no positions: pulses come every so many pulses from the arming of the trigger on. The way before
FROM is a whole number of intervals, so that one of them falls on FROM (not with --scale). `axisctl help scans` says more.)",
     "axisctl scan 1 0mm 0.5mm --every 1000\naxisctl scan 1 0.5mm 0.25mm --every 500 --speed 100um/s"},
    {"paths",
     R"(A path is one segment a line, every segment with the same axes; # begins a comment. Amounts are ways from where the
segment begins, with --absolute positions. A segment is a straight line, a piece of a circle around a center, cw or ccw, by
an angle or whole turns, or one through a point to an end. The lower axis points to the right, the other one up. In a helix
axis 3 rises meanwhile, by so much in one turn or in all of less than one turn: a way, with --absolute, too.

  1=1mm 2=-500um speed=2mm/s
  around 1=0 2=1mm ccw 90deg
  around 1=0 2=1mm cw 2turns rise 3=0.1mm
  through 1=1mm 2=1mm to 1=2mm 2=0

Any of them may have speed=2mm/s, the speed along it; rest=0.5s, for which the axes stand before it; and inputs=5, until the
inputs show which they stand before it (5: IN1 and IN3 on, the others off; only where the configuration has
wait_for_inputs).)",
     R"(printf 'around 1=0 2=50um cw 1turn\nthrough 1=20um 2=30um to 1=50um 2=20um rest=0.1s\n' | axisctl path - --speed 1mm/s
printf 'around 1=0 2=50um cw 2turns rise 3=10um\n' | axisctl path - --speed 1mm/s)"},
    {"scans",
     R"(One axis runs from FROM to TO at constant speed, and the trigger output gives a pulse every so many drive pulses, or with
--scale pulses of its scale. The controller compares no positions: pulses come every so many pulses from the arming of the
trigger on, also while the axis speeds up and slows down. So it sets out before FROM, by a whole number of intervals: one
pulse falls on FROM, the next ones on multiples of the interval behind it; with --scale they count from where it sets out.
When it stands the trigger is again what it
was. Faster than 56000 pulses/s, where pulses may be missing, is refused. There is one trigger, so a scan needs the right to
all axes. Told at its end: where the axis ran, how many pulses were due in the range and in all, and how many the way that
it was seen to go comes to; the controller itself does not tell how many it gave.)",
     R"(axisctl scan 2 0mm 0.1mm --every 500 --speed 200um/s
axisctl --json scan 2 0.1mm 0mm --every 500)"},
    {"jog", "", "axisctl jog 1=- --speed 200um/s --seconds 1"},
    {"save",
     R"(All axes belong to it. The place stays where it is, wherever 0 is counted from, and a restart of the controller
empties it. With --coordinates it is what the coordinates say by then, and outlives a restart. The controller keeps
twenty of each, by number: the lowest that no name has is taken, whatever a program of your own keeps there.)",
     "axisctl save sample\naxisctl save park --coordinates\naxisctl positions"},
    {"positions", "", "axisctl positions"},
    {"go", "All axes together. Nothing moves where the controller holds another position by now, or none.",
     "axisctl go sample\naxisctl go park --wait 60"},
    {"forget", "", "axisctl forget sample"},
    {"stop", "", "axisctl stop"},
    {"rearm", "", "axisctl rearm"},
    {"estop", "", "axisctl estop"},
    {"clear", "After an emergency stop the motors may be off.", "axisctl clear\naxisctl motor 1,2,3 on"},
    {"exec", "", "axisctl exec 'M:1+P1000' 'G:1'"},
    {"watch", "", "axisctl watch --from 1   # until Ctrl-C"},
    {"whoami", "", "axisctl whoami"},
    {"lease", "`axisctl help leases` explains them.",
     R"(axisctl lease run --axes 1 --wait 60 --purpose 'scan of sample 12' -- axisctl move 1=0mm
axisctl lease list)"},
    {"token", "", "axisctl token create night-scan --days 30\naxisctl token list\naxisctl token revoke night-scan"},
    {"sim",
     "For a device that the daemon simulates: as if somebody stood before it. `axisctl sim help` lists what he can do.",
     "axisctl sim help\naxisctl sim inputs 5\naxisctl sim limit 1 cw off\naxisctl sim position"},
    {"record", "", "axisctl record --seconds 1 --output stage.recording"},
    {"replay", "", "axisctl replay stage.recording"},
    {"support", "", "axisctl support --output report.txt"},
    {"mill",
     R"(Jobs in RML-1 are read, played on a model of the machine and judged; nothing is sent, and no daemon is needed. The
profile tells what the machine is like: the name of one in deploy/mills, or a copy of it that you have changed. --origin
tells where the work origin lies: X and Y from the home corner, Z how far Z0 is below the top of its travel. Without it
only sizes are judged. With --stock a cut beside or below the workpiece is warned of. `mill check` exits 1 when the job
has an error. `mill preview` draws it from above, from the front and from the side.)",
     R"(printf '^IN;!PZ-50,200;PU100,100;PD200,100;PU;H;\n' | axisctl mill check - --profile mdx-20
printf 'PU0,0;PD100,0;PU;\n' | axisctl mill check - --profile srm-20 --origin 10,10,30 --stock 5,5,2
printf '^IN;PU0,0;PD100,0,100,100;PU;H;\n' | axisctl --json mill check - --profile srm-20
printf '^IN;PU100,100;Z200,100,-50,100,200,-50;PU;\n' | axisctl mill preview - --profile mdx-40 -o job.svg)"},
    {"units",
     R"(Amounts are decimals with a unit: pulse, nm, um, mm, deg. A bare number is in the axis's own unit, which the
configuration names. A speed is an amount a second; the /s may be left out. Nothing is ever rounded: what is not a whole
number of pulses is refused, with the nearest amounts that are.)",
     R"(axisctl move 1=0.5mm
axisctl move 1=500um --speed 1mm/s
axisctl move 1=-100pulse --relative)"},
    {"leases",
     R"(While somebody has a lease, nobody else moves or sets anything on its axes; anybody may stop them. `lease run` acquires
one, runs a command, and gives it back; all that the command starts shares it. --wait waits for axes that another holds.
Speeds, outputs and the trigger that were set under a lease are what they were before once it has ended; what was set
without a lease stays. To hand the axes over to one who waits: axisctl lease hand-over 'unix bert'.)",
     R"(axisctl lease run --axes 1 --wait 60 -- sh -c 'axisctl move 1=1mm && axisctl move 1=0mm'
axisctl lease run -- sh -c 'axisctl outputs on 1 && axisctl move 1=0.1mm'
axisctl lease list)"},
    {"settings",
     R"(Everything that is set, one item a line. Verbs that change some of it: speed, motor, loop, divisions, settle, sleep,
wake, display, beep, mode, dialect, outputs, trigger; zero, unzero and preset set coordinates; reset restarts the
controller. What is set stays until somebody sets it again or the controller restarts; speeds, outputs and the trigger end
with the lease under which they were set.)",
     "axisctl settings\naxisctl --json settings"},
    {"speed",
     R"(From MINIMUM an axis speeds up to MAXIMUM within the time of --acceleration; what is left out stays. Without options:
what is set. With --origin-return: those of the mechanical origin return.)",
     R"(axisctl speed 1,2
axisctl speed 1 --minimum 10um --maximum 1mm --acceleration 50
axisctl speed 1,2 --maximum 0.5mm/s --origin-return)"},
    {"motor", "Without current an axis may be moved by hand, and its place is not certain.",
     "axisctl motor 3 off\naxisctl motor 3 on"},
    {"loop", "Whether the scale holds an axis in place.", "axisctl loop 1 closed\naxisctl loop 1,2 open"},
    {"divisions", "A pulse is another way afterwards, so all positions are.",
     "axisctl divisions 3 100\naxisctl divisions 3 200"},
    {"settle", "How long a motion that has ended is still busy: 0 to 255 s in steps of 0.1 s.",
     "axisctl settle 0.1\naxisctl settle 0"},
    {"sleep", "Nothing moves until `axisctl wake`.", "axisctl sleep"},
    {"wake", "The stage goes back to its place: axes may move.", "axisctl wake"},
    {"display", "", "axisctl display off\naxisctl display on"},
    {"beep", "", "axisctl beep off\naxisctl beep on"},
    {"mode", "Off HOST the controller does not answer the daemon until the mode is put right at its front panel.",
     "axisctl mode HOST"},
    {"dialect",
     "The daemon speaks SHOT_FC; in HIT the device is down until the dialect is put right at its front panel.",
     "axisctl dialect SHOT_FC"},
    {"outputs", "Those that are not named stay as they are. Without arguments: which are on.",
     "axisctl outputs on 1 3\naxisctl outputs off 3\naxisctl outputs\naxisctl outputs none"},
    {"inputs", "Which are on.", "axisctl inputs"},
    {"trigger", "`axisctl help triggers` explains it.",
     "axisctl trigger every 0.2s\naxisctl trigger off\naxisctl trigger fire"},
    {"triggers",
     R"(The controller has one trigger output. It gives a pulse every so many drive pulses of an axis (2 to 30000), in either
direction; with --scale, of its scale in one direction, never twice at one place; or, without an axis, every so often
(0.01s to 100s). `trigger fire` gives one now. Under a lease it ends with the lease.)",
     R"(axisctl trigger every 1000 --axis 1
axisctl trigger every 500 --axis 2 --scale +
axisctl lease run -- sh -c 'axisctl trigger every 1000 --axis 1 && axisctl move 1=0.2mm'
axisctl trigger off)"},
    {"preset",
     "Nothing moves: the place where the axis stands is called so. Travel limits count from the origin that `home` "
     "finds.",
     "axisctl preset 1=0.5mm 2=-20um"},
    {"zero", "Nothing moves: the place where the axis stands is called 0.", "axisctl zero 1"},
    {"unzero", "Takes `zero` back.", "axisctl unzero 1"},
    {"reset",
     R"(What is set goes back to what the memory switches say, and coordinates to 0: home the axes again. Leases end.)",
     "axisctl reset"},
    {"",
     R"(Amounts have a unit: pulse, nm, um, mm, deg; without one they are in the axis's own. AXIS is a number or the
axis's configured name. `axisctl help VERB` has examples of each verb; other topics are units, paths, scans,
leases, settings, triggers.)",
     R"(axisctl home
axisctl move 1=+1mm 2=-200um --relative
axisctl jog 1=+ --speed 200um/s   # until Ctrl-C
axisctl exec 'M:1+P1000' 'G:1'
axisctl --json watch --from 1   # until Ctrl-C
axisctl lease run --wait 60 --purpose 'scan of sample 12' -- axisctl move 1=0mm)"},
};

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

std::string help_text(std::string_view topic) {
  const auto found = std::ranges::find(kTopics, topic, &HelpTopic::name);
  if (found == std::end(kTopics)) return "";
  std::string text(found->text);
  if (!text.empty()) text += "\n\n";
  text += found->examples.find('\n') == std::string_view::npos ? "Example:" : "Examples:";
  std::string_view rest = found->examples;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    text += fmt::format("\n  {}", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return text;
}

}  // namespace axisgate::axisctl

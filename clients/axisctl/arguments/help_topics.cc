#include "clients/axisctl/arguments/help_topics.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::axisctl {
namespace {

constexpr HelpTopic kTopics[] = {
    {"",
     R"(Amounts have a unit: pulse, nm, um, mm, deg. Without a unit they are in the unit of the axis, which `axisctl position`
shows. AXIS is a number or the name of an axis in the configuration. `axisctl help COMMAND` has examples of each
command. Other topics are units, paths, scans, leases, settings, triggers.

Ctrl-C stops a jog. Every other motion continues: `axisctl stop` stops it.)",
     R"(axisctl home
axisctl move 1=0.5mm 2=0
axisctl move 1=+1mm 2=-200um --relative
axisctl jog 1=+ --speed 200um/s   # until Ctrl-C
axisctl exec 'M:1+P1000' 'G:1'
axisctl --json watch --from 1   # all events from number 1 on, until Ctrl-C
axisctl lease run --wait 60 --purpose 'scan of sample 12' -- axisctl move 1=0mm)"},
    {"units",
     R"(Amounts are decimals with a unit: pulse, nm, um, mm, deg. A bare number is in the unit of the axis, which the
configuration names. A speed is an amount per second; the /s may be left out. Nothing is rounded: an amount that is not a
whole number of pulses is refused, and the message names the nearest ones.)",
     R"(axisctl move 1=0.5mm
axisctl move 1=500um --speed 1mm/s
axisctl move 1=-100pulse --relative)"},
    {"paths",
     R"(A path has one segment per line, and all segments have the same axes; # begins a comment. Amounts are distances from the
beginning of the segment, with --absolute positions. A segment is a straight line or an arc. An arc goes around a
center, cw (clockwise) or ccw, by an angle or by whole turns; or it goes through a point to an end. The lower axis
points to the right, the other one up. In a helix axis 3 also rises. The rise is that of one turn, or of the whole arc
if it is less than one turn. It is always a distance.

  1=1mm 2=-500um speed=2mm/s                # a straight line
  around 1=0 2=1mm ccw 90deg                # an arc: center, direction, angle
  around 1=0 2=1mm cw 2turns rise 3=0.1mm   # a helix
  through 1=1mm 2=1mm to 1=2mm 2=0          # an arc: a point on it, its end

Each segment can have options. speed=2mm/s is the speed along the segment. Without it --speed counts. Without both, a
line of several axes runs at the minimum speed of its lower axis, which may be very slow. rest=0.5s: before the segment
the axes stop, and wait for this time. inputs=5: before the segment the axes stop, and wait until the inputs show this
number (5: IN1 and IN3 on, the others off). inputs= needs wait_for_inputs in the configuration.)",
     R"(printf 'around 1=0 2=50um cw 1turn\nthrough 1=20um 2=30um to 1=50um 2=20um rest=0.1s\n' | axisctl path - --speed 1mm/s
printf 'around 1=0 2=50um cw 2turns rise 3=10um\n' | axisctl path - --speed 1mm/s)"},
    {"scans",
     R"(One axis runs from FROM to TO at constant speed. The trigger output gives a pulse at equal intervals of drive pulses, or
with --scale of scale pulses: those of the encoder. `axisctl exec '?:P1'` shows the length of one drive pulse of axis 1
in nm.

The controller counts pulses from the moment when the trigger is armed. It does not compare positions. The axis starts
before FROM, because it must speed up. This run-up is a whole number of intervals, so one pulse falls on FROM, and the
others on multiples of the interval after it. The trigger also gives pulses during the run-up, and after TO while the
axis slows down. With --scale the pulses count from the start of the run-up. When the axis is stationary, the trigger is
set back to its previous state.

A speed above 56000 pulses/s is refused, because pulses may be missing. There is one trigger, so a scan needs the right
to all axes. At its end a scan shows where the axis ran, and how many pulses were expected in the range and in all. It
also shows the number computed from the observed displacement; the controller does not report how many it gave.)",
     R"(axisctl scan 2 0mm 0.1mm --every 500 --speed 200um/s
axisctl --json scan 2 0.1mm 0mm --every 500)"},
    {"leases",
     R"(A lease is the exclusive right to move axes and to change their settings. Everybody may read, and everybody may stop.
`lease run` acquires a lease, runs a command, and releases the lease when the command has ended. The lease belongs to
this command and to all that it starts. Other terminals are outside it, even those of the same user. `lease list` shows
all leases. --wait waits for axes under another lease. Speeds, outputs and the trigger that were set under a lease are
set back when it has ended. What was set without a lease stays. To hand the axes over to somebody who waits, type inside
the lease: axisctl lease hand-over 'unix bert'.)",
     R"(axisctl lease run --axes 1 --wait 60 -- sh -c 'axisctl move 1=1mm && axisctl move 1=0mm'
axisctl lease run -- sh -c 'axisctl outputs on 1 && axisctl move 1=0.1mm'
axisctl lease list)"},
    {"triggers",
     R"(The controller has one trigger output. `trigger every` gives a pulse every 2 to 30000 drive pulses of an axis, in either
direction. With --scale it counts the scale pulses of the axis in one direction, and never gives two pulses at the same
position. Without an axis it gives a pulse at equal times, 0.01s to 100s. `trigger fire` gives one pulse now. A trigger
that was set under a lease ends with the lease.)",
     R"(axisctl trigger every 1000 --axis 1
axisctl trigger every 500 --axis 2 --scale +
axisctl lease run -- sh -c 'axisctl trigger every 1000 --axis 1 && axisctl move 1=0.2mm'
axisctl trigger off)"},
};

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

std::string topic_text(std::string_view topic) {
  const auto found = std::ranges::find(kTopics, topic, &HelpTopic::name);
  return found == std::end(kTopics) ? "" : help_text(found->text, found->examples);
}

std::string help_text(std::string_view text, std::string_view examples) {
  std::string all(text);
  if (examples.empty()) return all;
  if (!all.empty()) all += "\n\n";
  all += examples.find('\n') == std::string_view::npos ? "Example:" : "Examples:";
  while (!examples.empty()) {
    const std::size_t end = std::min(examples.find('\n'), examples.size());
    all += fmt::format("\n  {}", examples.substr(0, end));
    examples.remove_prefix(std::min(end + 1, examples.size()));
  }
  return all;
}

}  // namespace axisgate::axisctl

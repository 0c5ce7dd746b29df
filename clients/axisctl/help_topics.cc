#include "clients/axisctl/help_topics.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::axisctl {
namespace {

constexpr HelpTopic kTopics[] = {
    {"devices", "", "axisctl devices"},
    {"status", "In the output, `?` means that the value is not known, e.g. because it was not read yet.",
     "axisctl status\naxisctl --json status"},
    {"position", "", "axisctl position"},
    {"commands", "", "axisctl commands M:"},
    {"home",
     R"(Each axis runs to its origin sensor. Its coordinate becomes 0 there, and the travel limits count from there. Ctrl-C ends
axisctl, not the motion: `axisctl stop` stops it.)",
     "axisctl home 1 2"},
    {"move",
     R"(Amounts are absolute positions. With --relative they are distances from the present positions. A + sign alone does not
make a move relative. `axisctl help units` explains amounts.

All axes start together, each at its own speed: two axes do not follow a straight line. `axisctl line` does. With
--approach each axis makes the last part of its move in the same direction every time, so backlash has no effect. Ctrl-C
ends axisctl, not the motion: `axisctl stop` stops it.)",
     R"(axisctl move 1=+1mm 2=-200um --relative --speed 2mm/s
axisctl move 1=0.5mm --wait 60
axisctl move 1=0.4mm 2=0 --approach 10um)"},
    {"path",
     "FILE has one segment per line: a straight line or an arc. `axisctl help paths` explains segments. Ctrl-C\n"
     "ends axisctl, not the motion: `axisctl stop` stops it.",
     R"(printf '1=1mm 2=-500um speed=2mm/s\n1=-1mm 2=500um\n' | axisctl path -
printf '1=0.1mm 2=0\naround 1=0 2=50um ccw 180deg\n1=-0.1mm 2=0 rest=0.5s\n' | axisctl path - --speed 1mm/s)"},
    {"line", "A path of one straight line. `axisctl help paths` explains it.",
     "axisctl line 1=0.1mm 2=-50um --speed 1mm/s"},
    {"arc", "A path of one arc. `axisctl help paths` explains it.",
     R"(axisctl arc around 1=0 2=50um ccw 90deg --speed 1mm/s
axisctl arc through 1=20um 2=30um to 1=50um 2=20um --speed 1mm/s)"},
    {"scan",
     R"(PULSES is the distance between two trigger pulses, 2 to 30000 drive pulses of the axis. `axisctl exec '?:P1'` shows the
length of one drive pulse of axis 1 in nm. The trigger also gives pulses before FROM and after TO, while the axis speeds
up and slows down. One pulse falls on FROM (not with --scale). `axisctl help scans` explains more.)",
     "axisctl scan 1 0mm 0.5mm --every 1000\naxisctl scan 1 0.5mm 0.25mm --every 500 --speed 100um/s"},
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
    {"jog", "Ctrl-C stops the axes. So does the daemon when axisctl is killed or cut off.",
     "axisctl jog 1=- --speed 200um/s --seconds 1"},
    {"save",
     R"(A position has the coordinates of all axes. It is a place: it stays the same place when coordinates are set again. A
restart of the controller clears it. With --coordinates the coordinates are saved instead, and kept over a restart. The
controller stores twenty of each kind by number. A new name takes the lowest number without a name. What another program
has stored there is overwritten.)",
     "axisctl save sample\naxisctl save park --coordinates\naxisctl positions"},
    {"positions", "", "axisctl positions"},
    {"go", "Moves all axes together. Nothing moves if the controller now holds another position, or none.",
     "axisctl go sample\naxisctl go park --wait 60"},
    {"forget", "", "axisctl forget sample"},
    {"stop",
     R"(Anybody may stop all axes, also those that others move. After a stop by somebody else, motions are refused until their
caller types `axisctl rearm`. With `estop` the axes do not slow down first, and nothing moves until `axisctl clear`.
If nobody could see the axes obey, the exit code is 1 and the stop stays open: the daemon repeats it as soon as the
controller answers, also after a restart, and refuses motion of these axes until then. `axisctl status` shows it.)",
     "axisctl stop"},
    {"rearm",
     R"(A stop by somebody else sets a latch: your motions on these axes are refused until you rearm. This moves nothing, and
the stopped motion does not continue. Type it in any terminal: it also ends the latches of your leases.
After an emergency stop by somebody else, type `axisctl rearm` first, then `axisctl clear`.)",
     "axisctl rearm"},
    {"estop", "Not a safety function: keep the wired emergency stop within reach.", "axisctl estop"},
    {"withdraw",
     R"(An open stop refuses motion of its axes until the gateway has seen them stationary. If its controller will never answer
again, an administrator can abandon the stop. The history records who did it.)",
     "axisctl withdraw 12"},
    {"clear",
     R"(Needs the role admin, unless `admin_commands` in the configuration leaves out BEC:. After an emergency stop the motors
may be off. Only `clear` without axes ends an emergency stop, once that stop is confirmed. `rearm` ends the latch of a
stop by somebody else.)",
     "axisctl clear\naxisctl motor 1,2,3 on"},
    {"exec", "Each LINE is a command of the manual. `axisctl commands` lists them.", "axisctl exec 'M:1+P1000' 'G:1'"},
    {"watch", "", "axisctl watch --from 1   # all events from number 1 on, until Ctrl-C"},
    {"history",
     R"(The daemon keeps it in its state directory, also over restarts. --night sums up who moved what, who stopped what, when a
link was lost, and when the daemon started. The conditions of the other options must all be fulfilled. Details are those
of --json; in --text capital and small letters differ. --motion also shows the lines that were sent, with their answers,
and how to get the recording around them while the daemon has it. `others_seen_by` in the configuration may let you read
only your own entries; a note says so.)",
     R"(axisctl history --night
axisctl history --hours 12 --axis 1 --outcome failed
axisctl history --who 'unix anna' --limit 20
axisctl history --text LIMIT_DETECTED
axisctl history --motion 1
axisctl history --hours 12 --limit 100000 --csv
axisctl history --follow   # until Ctrl-C)"},
    {"motions", "The daemon has the motions since its start; `axisctl history` also shows older ones.",
     "axisctl motions\naxisctl --json motions --all"},
    {"cancel",
     "Needs no lease. After a cancel by somebody else, motions are refused until their caller types `axisctl rearm`.",
     "axisctl cancel 1"},
    {"audit",
     R"(The entries of the journal form a chain of hashes. `audit verify` names the first that was changed, removed or added,
or says what else of the file is damaged.
Who can write the file could compute all hashes again. So note the head that it prints, and check it later.

For administrators: `audit erase 'unix anna' --yes` puts "erased N" in the place of a name, in every entry and in the
bytes of the file. The chain of hashes is unchanged. The name may also be in the log of the daemon, in recordings, in
requests that the daemon remembers for a day, and in other files: docs/sharing.md lists them.)",
     "axisctl audit verify"},
    {"whoami", "", "axisctl whoami"},
    {"lease", "`axisctl help leases` explains them.",
     R"(axisctl lease run --axes 1 --wait 60 --purpose 'scan of sample 12' -- axisctl move 1=0mm
axisctl lease list)"},
    {"token", "", "axisctl token create night-scan --days 30\naxisctl token list\naxisctl token revoke night-scan"},
    {"sim", "For a simulated device: what a person can do at the controller. `axisctl sim help` lists the commands.",
     "axisctl sim help\naxisctl sim inputs 5\naxisctl sim limit 1 cw off\naxisctl sim position"},
    {"record", "", "axisctl record --seconds 1 --output stage.recording"},
    {"replay", "", "axisctl replay stage.recording"},
    {"support", "", "axisctl support --output report.txt"},
    {"mill",
     R"(`mill check` reads a job in RML-1, plays it on a model of the machine and checks it. Nothing is sent, and no daemon is
needed. The profile describes the machine: the name of one in deploy/mills, or your own changed copy. --origin is the
work origin: X and Y from the home corner, and how far Z0 is below the top of the travel. Without it only sizes are
checked. With --stock there is a warning for a cut beside or below the workpiece. With --tool, the diameter of the tool,
the report says how much is removed. `mill check` exits 1 when the job has an error. `mill preview` draws the job from
above, from the front and from the side, and reports the same errors and warnings. Cuts are drawn as wide as --tool, and
a relief is shaded. Several files are the parts of a job, in two tints. With --from it draws what remains from a line on.
After an abort `mill queue` says between which places of the file what was executed ends: --from 8:1-13:1 draws what
begins there as perhaps done.

The other commands call the daemon; with several mills --device names one. `mill send` puts a job into the queue, unless
the check finds an error, or a warning that is not named with --accept, such as deep-pass. A person at the mill sets up
material, tool and origin, and says so with `mill confirm`. Then `mill start` starts the job. Several files make one job:
after each the tool is raised and the spindle off, and somebody puts in the next tool, sets Z0, and confirms that.

A mill never replies: what it has executed is a range, computed from its profile. `mill pause` and `mill abort` send no
more of the job, but what the mill has received may run on, and after a pause the cutter keeps turning in the cut. An
abort also sends what discards the mill's buffer, raises the tool and stops the spindle. Whether the mill has done so is
not known: look at it. FED means that all of a job was sent, and that the slowest mill has executed it by now. After you
have seen the workpiece, `mill done` takes the job out of the queue. Ctrl-C does not end a job: `mill abort` does.

A job takes as long as it is sent: with "full" streaming as long as the mill needs, from full speed throughout to a stop at
each point; "paced" much longer, and then less runs on after an abort. Both are said before the start. `mill queue` shows
when each job that waits begins at the earliest: a range, too. People who confirm add their time.
`mill first` moves a job to the front. An administrator may move each; you may move your own before other jobs of yours.
A job that is confirmed or was begun is never overtaken.

A caller may have a quarter of the queue, and in its last quarter one job; callers without a name count as one. A job that
nobody confirms within 14 days, or `confirm_days` of the configuration, ends EXPIRED. `mill cancel` takes a job out of the
queue, yours or, for an administrator, any. `mill clear 'unix anna'` takes out all of a caller's jobs that wait, for
administrators. A job that runs or was begun stays.

After `mill pause --raise` the tool goes up after the last sent byte, the spindle stops, and the job is PAUSED. It continues
when it is confirmed and started again. A job is PAUSED_UNKNOWN after a broken line or a killed daemon: look at the
workpiece, and name the line with which it continues: `mill resume JOB --from LINE`. Without --from the answer says where
what was executed ends. The tool then goes up, above the place, and down. `mill send --rest-of JOB --from LINE` does the
same with a job that was aborted, as a job of its own, and `mill again JOB` queues all of an ended job once more. With
--continues a finishing is checked on the workpiece of a roughing that is DONE.

While no job runs, `mill jog` moves the tool by a short step, `mill origin` sets Z0, `mill spindle` starts or stops the
spindle, and `mill raise` raises the tool. The position of the tool is not known, so nothing checks where a step leads.
After each of them a confirmation is void.)",
     R"(printf '^IN;!PZ-50,200;PU100,100;PD200,100;PU;H;\n' | axisctl mill check - --profile mdx-20
printf 'PU0,0;PD100,0;PU;\n' | axisctl mill check - --profile srm-20 --origin 10,10,30 --stock 5,5,2 --tool 1
printf '^IN;PU0,0;PD100,0,100,100;PU;H;\n' | axisctl --json mill check - --profile srm-20
printf '^IN;PU100,100;Z200,100,-50,100,200,-50;PU;\n' | axisctl mill preview - --profile mdx-40 -o job.svg
printf '^IN;PU100,100;\nPD200,100;PU;\n' | axisctl mill preview - --profile mdx-40 --from 2 -o rest.svg
axisctl mill raise
axisctl mill abort
printf '^IN;!PZ-50,200;PU100,100;PD200,100;PU;H;\n' | axisctl mill send - --title frame
axisctl mill queue
axisctl mill first 1
axisctl mill confirm --yes
axisctl mill start)"},
    {"units",
     R"(Amounts are decimals with a unit: pulse, nm, um, mm, deg. A bare number is in the unit of the axis, which the
configuration names. A speed is an amount per second; the /s may be left out. Nothing is rounded: an amount that is not a
whole number of pulses is refused, and the message names the nearest ones.)",
     R"(axisctl move 1=0.5mm
axisctl move 1=500um --speed 1mm/s
axisctl move 1=-100pulse --relative)"},
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
    {"settings",
     R"(Shows all settings, one per line. These commands change settings: speed, motor, loop, divisions, settle, sleep, wake,
display, beep, mode, dialect, outputs, trigger. zero, unzero and preset set coordinates. reset restarts the controller.
A setting stays until it is set again, or until the controller restarts. Speeds, outputs and the trigger end with the
lease under which they were set.)",
     "axisctl settings\naxisctl --json settings"},
    {"speed",
     R"(An axis speeds up from MINIMUM to MAXIMUM within the time of --acceleration. An option that is left out stays as it is.
Without options the present speeds are shown. With --origin-return they are those of the mechanical origin return.)",
     R"(axisctl speed 1,2
axisctl speed 1 --minimum 10um --maximum 1mm --acceleration 50
axisctl speed 1,2 --maximum 0.5mm/s --origin-return)"},
    {"motor", "Without current an axis can be moved by hand, and its position is uncertain.",
     "axisctl motor 3 off\naxisctl motor 3 on"},
    {"loop", "In closed loop the controller holds an axis at its position by its scale, an encoder.",
     "axisctl loop 1 closed\naxisctl loop 1,2 open"},
    {"divisions", "They change the resolution, and so the meaning of all coordinates in pulses.",
     "axisctl divisions 3 100\naxisctl divisions 3 200"},
    {"settle", "The wait between the end of positioning and READY: 0 to 255 s in steps of 0.1 s.",
     "axisctl settle 0.1\naxisctl settle 0"},
    {"sleep", "Nothing moves until `axisctl wake`.", "axisctl sleep"},
    {"wake", "CAUTION: axes move. The stage moves back to its position before the sleep.", "axisctl wake"},
    {"display", "", "axisctl display off\naxisctl display on"},
    {"beep", "", "axisctl beep off\naxisctl beep on"},
    {"mode", "In a non-host mode the daemon cannot reach the controller until HOST is chosen at the front panel.",
     "axisctl mode HOST"},
    {"dialect", "The daemon uses SHOT_FC. In HIT the device is down until SHOT_FC is chosen at the front panel.",
     "axisctl dialect SHOT_FC"},
    {"outputs", "Outputs that are not named stay as they are. Without arguments it shows which are on.",
     "axisctl outputs on 1 3\naxisctl outputs off 3\naxisctl outputs\naxisctl outputs none"},
    {"inputs", "Shows which inputs are on.", "axisctl inputs"},
    {"trigger", "`axisctl help triggers` explains it.",
     "axisctl trigger every 0.2s\naxisctl trigger off\naxisctl trigger fire"},
    {"triggers",
     R"(The controller has one trigger output. `trigger every` gives a pulse every 2 to 30000 drive pulses of an axis, in either
direction. With --scale it counts the scale pulses of the axis in one direction, and never gives two pulses at the same
position. Without an axis it gives a pulse at equal times, 0.01s to 100s. `trigger fire` gives one pulse now. A trigger
that was set under a lease ends with the lease.)",
     R"(axisctl trigger every 1000 --axis 1
axisctl trigger every 500 --axis 2 --scale +
axisctl lease run -- sh -c 'axisctl trigger every 1000 --axis 1 && axisctl move 1=0.2mm'
axisctl trigger off)"},
    {"preset",
     "Nothing moves: the present position gets this coordinate. Travel limits are relative to the origin of "
     "`home`.",
     "axisctl preset 1=0.5mm 2=-20um"},
    {"zero", "Nothing moves: the present position gets the coordinate 0.", "axisctl zero 1"},
    {"unzero", "Undoes `zero`.", "axisctl unzero 1"},
    {"reset",
     R"(Settings return to the values of the memory switches, and coordinates become 0: home the axes again. Leases end.)",
     "axisctl reset"},
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
};

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

std::string help_text(std::string_view topic) {
  const auto found = std::ranges::find(kTopics, topic, &HelpTopic::name);
  return found == std::end(kTopics) ? "" : text_of(found->text, found->examples);
}

std::string text_of(std::string_view text, std::string_view examples) {
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

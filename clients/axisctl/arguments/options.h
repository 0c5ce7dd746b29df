// Options and arguments of one run of axisctl.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "clients/cpp/src/target.h"

namespace axisgate::axisctl {

struct Verb;

// Options of the verbs that check jobs for mills. Comments begin with the verb that uses the option.
struct MillOptions {
  std::string file;                   // check: file of the job; "-" is the standard input
  std::vector<std::string> files;     // preview: file of each part, likewise
  std::string profile;                // name of a shipped profile, or a file
  std::optional<std::string> origin;  // "10,10,5", mm, or the name of a configured origin
  std::optional<std::string> stock;   // "80,50,10", mm
  std::vector<double> tools_mm;       // diameters: one for all files, or one for each; none: unknown
  std::string made_for;               // check: name of a profile; empty: inferred from the job
  std::string output;                 // preview: file of the picture
  std::optional<std::string> from;    // preview: "8:1-13:1", see job_range()
};

// Options of the verbs that call a mill. Comments begin with the verb that uses the option.
struct JobOptions {
  std::string title;                       // send; empty: last part of the file's path
  std::string origin;                      // send: name of a configured origin; empty: origin set at the panel
  std::vector<std::string> files;          // send: "-" is the standard input
  std::vector<std::string> tools;          // send: configured tools, one for each file; none: first tool, for one file
  std::optional<std::string> stock;        // send: "80,50,10", mm
  std::string made_for;                    // send: name of a profile; empty: inferred from the job
  std::string streaming;                   // send: "paced" or "full"; empty: the mill's setting
  std::vector<std::string> accepted;       // send: names of accepted warnings
  std::optional<std::uint64_t> continues;  // send: number of the job whose workpiece is continued
  std::optional<std::uint64_t> rest_of;    // send: number of the job whose rest is sent
  std::optional<std::uint64_t> number;     // number of the job; none: first job that waits
  bool start = false;                      // confirm: also start the job
  std::vector<std::string> distances;      // jog: "x=5", mm
  std::string speed;                       // jog; empty: the mill's
  std::optional<std::int64_t> z;           // origin: machine coordinate, in steps
  std::string spindle;                     // spindle: "on" or "off"
  bool raise = false;                      // pause: also raise the tool and stop the spindle
  std::optional<std::string> from;         // resume, send: line, or line and column: "12", "12:40"
};

// All options. Comments begin with the verbs that use the option.
struct Options {
  client::Target target;
  std::string device;  // "devices/stage"; empty: the only device
  bool json = false;
  std::string request_id;      // request id of mutations; empty: a new id for each
  const Verb* verb = nullptr;  // the verb that was requested

  std::vector<std::string> axes;    // home, stop, clear, settings of axes: numbers or names of axes
  std::vector<std::string> places;  // move, preset: "1=+5mm"; jog: "1=+"
  std::vector<std::string> lines;   // exec; lease run, sim: command and its words; line, arc: words of the segment
  std::string file;                 // path, replay; "-" is the standard input
  std::string output;               // record, support: file; empty: default of the verb
  std::string command;              // commands: the only command to show
  std::string speed;                // motions; empty: speed of the axis, for jog its minimum speed
  int acceleration_ms = 0;          // motions, speed; 0: setting of the axis
  std::string approach;             // move; empty: no approach
  std::string from, to;             // scan
  int every = 0;                    // scan: pulses
  bool by_scale = false;            // scan: `every` counts pulses of the scale
  std::string minimum, maximum;     // speed; empty: unchanged
  bool origin_return = false;       // speed: the speeds of the origin return
  std::string value;                // motor, loop, settle, display, beep, mode, dialect, outputs: new value
  int divisions = 0;                // divisions
  std::vector<int> outputs;         // outputs: numbers of the outputs to switch
  std::string interval;             // trigger every
  std::string axis, scale;  // scan, history; trigger every: axis whose pulses count; direction of its scale, "+" or "-"
  bool relative = false;    // move
  bool absolute = false;    // path, line, arc
  bool logical = false;     // home
  bool no_wait = false;     // motions
  bool no_follow = false;   // record
  bool only_new = false;    // record
  std::optional<int> seconds;                  // record, jog
  std::optional<std::uint64_t> from_revision;  // watch
  std::optional<int> wait_s;                   // motions, lease run: longest wait for another holder's lease
  bool take_over = false;                      // lease run
  bool follow = false;                         // lease list, history, mill start
  std::string at_loss = "stop";                // lease run
  std::string purpose;                         // lease run
  std::string holder;                          // lease hand-over: the new holder
  std::string name;                            // token create, token revoke, save, go, forget; cancel: motion
  bool yes = false;                            // audit erase, mill confirm
  bool coordinates = false;                    // save
  bool keep = false;                           // save: do not replace a saved position
  std::string role = "operator";               // token create
  int days = 90;                               // token create: days until the token expires
  std::string who;                             // history, audit erase, mill clear: caller
  std::optional<std::uint64_t> motion;         // history: number of the only motion to show
  std::uint64_t open_stop = 0;                 // withdraw: number of the open stop
  std::optional<int> hours;                    // history: only the last hours
  std::string outcome, text;                   // history: outcome of the motions to show; text in the details
  int limit = 100;                             // history: maximum number of entries
  bool night = false;                          // history: show a summary
  bool csv = false;                            // history
  bool all = false;                            // motions: also show older motions
  std::string head;                            // audit verify: head that was noted before
  MillOptions mill;
  JobOptions job;
};

// Returns the options, with a verb. Returns an exit code if axisctl must exit at once: help was shown, or an error in
// the usage was printed.
std::variant<Options, int> parse_options(int argument_count, char** arguments);

}  // namespace axisgate::axisctl

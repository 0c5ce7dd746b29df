// What was typed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace axisgate::axisctl {

enum class Verb {
  devices,
  status,
  position,
  home,
  move,
  path,
  line,
  arc,
  scan,
  jog,
  stop,
  estop,
  withdraw,
  clear,
  exec,
  watch,
  commands,
  record,
  replay,
  sim,
  support,
  lease_run,
  lease_list,
  lease_hand_over,
  rearm,
  who_am_i,
  token_create,
  token_list,
  token_revoke,
  settings,
  speed,
  motor,
  loop,
  divisions,
  settle,
  sleep,
  wake,
  display,
  beep,
  mode,
  dialect,
  reset,
  zero,
  unzero,
  preset,
  outputs,
  inputs,
  trigger_every,
  trigger_off,
  trigger_fire,
  save,
  positions,
  go,
  forget,
  history,
  motions,
  cancel,
  audit_verify,
  audit_erase,
  mill_check,
  mill_preview,
  mill_send,
  mill_queue,
  mill_confirm,
  mill_start,
  mill_watch,
  mill_pause,
  mill_resume,
  mill_abort,
  mill_cancel,
  mill_clear,
  mill_first,
  mill_done,
  mill_jog,
  mill_origin,
  mill_spindle,
  mill_raise,
  mill_again
};

// The way to the daemon.
struct Target {
  std::string address;  // "unix:/run/axisgate/axisgate.sock", "127.0.0.1:50203"
  bool tls = false;
  std::string ca;           // a PEM file: who may have signed the daemon's certificate; empty: whom this machine trusts
  std::string certificate;  // a PEM file, to be known by; empty: a token
  std::string key;
};

// Of the verbs that judge jobs for mills.
struct MillOptions {
  std::string file;                   // check: the job; "-" is the standard input
  std::vector<std::string> files;     // preview: the same, of each part
  std::string profile;                // a shipped one's name, or a file
  std::optional<std::string> origin;  // "10,10,5", mm, or the name of a configured one
  std::optional<std::string> stock;   // the same
  std::vector<double> tools_mm;       // diameters: one of all files, or one for each; none: not known
  std::string made_for;               // check: a profile's name; empty: it is judged by the job
  std::string output;                 // preview: the picture
  std::optional<std::string> from;    // preview: "8:1-13:1", as job_range()
};

// Of the verbs that call a mill.
struct JobOptions {
  std::string title;                       // send; empty: the last part of the file's name
  std::string origin;                      // send: a configured one; empty: as it is set at the panel
  std::vector<std::string> files;          // send: "-" is the standard input
  std::vector<std::string> tools;          // send: configured ones, one for each file; none: the first, of one file
  std::optional<std::string> stock;        // send: "80,50,10", mm
  std::string made_for;                    // send: a profile's name; empty: it is judged by the job
  std::string streaming;                   // send: "paced", "full"; empty: as the mill has it
  std::vector<std::string> accepted;       // send: names of warnings
  std::optional<std::uint64_t> continues;  // send: the number of the job whose workpiece it continues
  std::optional<std::uint64_t> rest_of;    // send: the number of the job whose rest is sent
  std::optional<std::uint64_t> number;     // of the job; none: the first that waits
  bool start = false;                      // confirm: start it, too
  std::vector<std::string> distances;      // jog: "x=5", mm
  std::optional<double> mm_per_s;          // jog
  std::optional<std::int64_t> z;           // origin: a machine coordinate, in steps
  std::string spindle;                     // "on", "off"
  bool raise = false;                      // pause: the tool, and stop the spindle
  std::optional<std::string> from;         // resume, send: "12", "12:40"; a line, and a column
};

struct Options {
  Target target;
  std::string device;  // "devices/stage"; empty: the only one
  bool json = false;
  std::string request_id;  // of what is changed; empty: a new one
  Verb verb = Verb::devices;

  std::vector<std::string> axes;    // home, stop, clear, settings of axes: numbers or names
  std::vector<std::string> places;  // move, preset: "1=+5mm"; jog: "1=+"
  std::vector<std::string> lines;   // exec; lease run, sim: the command and its words; line, arc: the segment's
  std::string file;                 // path, replay; "-" is the standard input
  std::string output;               // record, support: a file; empty: as the verb does by itself
  std::string command;              // commands: one row only
  std::string speed;                // motions; empty: as the axis is set, jog: its lowest
  int acceleration_ms = 0;          // motions, speed; 0: as the axis is set
  std::string approach;             // move; empty: straight there
  std::string from, to;             // scan
  int every = 0;                    // scan: pulses
  bool by_scale = false;            // scan: of the scale
  std::string minimum, maximum;     // speed; empty: as the axis is set
  bool origin_return = false;       // speed: those of the origin return
  std::string value;                // motor, loop, settle, display, beep, mode, dialect, outputs: the new one
  int divisions = 0;                // divisions
  std::vector<int> outputs;         // outputs: those to be switched
  std::string interval;             // trigger every
  std::string axis, scale;     // scan, history; trigger every: whose pulses, and the scale's in direction "+" or "-"
  bool relative = false;       // move
  bool absolute = false;       // path, line, arc
  bool logical = false;        // home
  bool no_wait = false;        // motions
  bool no_follow = false;      // record
  bool only_new = false;       // record
  std::optional<int> seconds;  // record, jog
  std::optional<std::uint64_t> from_revision;  // watch
  std::optional<int> wait_s;                   // motions, lease run: for a lease that another holds
  bool take_over = false;                      // lease run
  bool follow = false;                         // lease list, history, mill start
  std::string at_loss = "stop";                // lease run
  std::string purpose;                         // lease run
  std::string holder;                          // lease hand-over: to whom
  std::string name;                            // token create, token revoke, save, go, forget; cancel: a motion
  bool yes = false;                            // audit erase, mill confirm
  bool coordinates = false;                    // save
  bool keep = false;                           // save: what has the name
  std::string role = "operator";               // token create
  int days = 90;                               // token create: until it expires
  std::string who;                             // history, audit erase, mill clear: whose
  std::optional<std::uint64_t> motion;         // history: of this motion only
  std::uint64_t open_stop = 0;                 // withdraw: its number
  std::optional<int> hours;                    // history: of the last hours only
  std::string outcome, text;                   // history: of motions that ended so; with this in the details
  int limit = 100;                             // history: lines at most
  bool night = false;                          // history: a summary
  bool csv = false;                            // history
  bool all = false;                            // motions: also older ones
  std::string head;                            // audit verify: that was noted before
  MillOptions mill;
  JobOptions job;
};

// The options, or the exit code with which to leave at once: help was shown, or the usage was wrong and that was said.
std::variant<Options, int> parse_options(int argument_count, char** arguments);

}  // namespace axisgate::axisctl

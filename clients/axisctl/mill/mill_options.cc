// Options of the verbs of `axisctl mill`.
#include <CLI/CLI.hpp>

#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {
namespace {

void add_checks(CLI::App& mill, Options& options) {
  CLI::App* check = add_verb(mill, options, OldVerb::mill_check, "check",
                             "show what a job would do, its errors, and risks to the workpiece; needs no daemon");
  CLI::App* preview =
      add_verb(mill, options, OldVerb::mill_preview, "preview", "draw what a job would do; needs no daemon");
  check->add_option("FILE", options.mill.file, "the job; - reads the standard input")->required()->type_name("");
  preview->add_option("FILE", options.mill.files, "the job; - reads the standard input; several files are its parts")
      ->required()
      ->type_name("");
  for (CLI::App* verb : {check, preview}) {
    verb->add_option("--profile", options.mill.profile, "the machine: a name, e.g. mdx-20, or the file of a profile")
        ->type_name("PROFILE");
    verb->add_option(
            "--origin", options.mill.origin,
            "the work origin in mm: X and Y from the home corner, and how far Z0 is below the top; or the name "
            "of one that the daemon has configured")
        ->type_name("X,Y,Z|NAME");
    verb->add_option("--stock", options.mill.stock, "the workpiece in mm, from the work origin, and its thickness")
        ->type_name("X,Y,Z");
  }
  check->add_option("--tool", options.mill.tools_mm, "the diameter of the tool in mm: says how much is removed")
      ->expected(1)
      ->type_name("MM");
  preview
      ->add_option("--tool", options.mill.tools_mm,
                   "the diameter of the tool in mm: cuts are drawn as wide; of several files one for each, e.g. 0.4,1")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("MM");
  check
      ->add_option("--made-for", options.mill.made_for,
                   "the profile that the job was made for: warns where it is another one (default: judged by the job)")
      ->type_name("NAME");
  preview
      ->add_option("--from", options.mill.from,
                   "draw what remains from a line, or line and column, on; what comes before is pale. Of a range, what "
                   "begins in it is perhaps done")
      ->type_name("LINE[:COLUMN][-LINE[:COLUMN]]");
  preview->add_option("-o,--output", options.mill.output, "an .svg file")->required()->type_name("FILE");
}

// Adds a verb without a help text: the texts for `watch` and `cancel` describe the stage commands of these names.
CLI::App* add_job_verb(CLI::App& mill, Options& options, OldVerb verb, const char* name, const char* description) {
  CLI::App* added = add_verb(mill, options, verb, name, description);
  added->footer("");
  return added;
}

void add_send(CLI::App& mill, Options& options) {
  JobOptions& job = options.job;
  CLI::App* send = add_job_verb(mill, options, OldVerb::mill_send, "send", "check a job and send it into the queue");
  send->add_option("FILE", job.files,
                   "the job; - reads the standard input; of several files the tool is changed between")
      ->type_name("");
  send->add_option("--tool", job.tools,
                   "a tool of the configuration (default: its first); of several files one for each, e.g. T1,T3")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME");
  send->add_option("--origin", job.origin,
                   "a work origin of the configuration (default: as it is set at the mill's panel)")
      ->type_name("NAME");
  send->add_option(
          "--streaming", job.streaming,
          "paced, or full: as fast as the mill takes it, so more runs on after an abort (default: as configured)")
      ->check(CLI::IsMember({"paced", "full"}))
      ->type_name("HOW");
  send->add_option("--stock", job.stock, "the workpiece in mm, from the work origin, and its thickness")
      ->type_name("X,Y,Z");
  send->add_option(
          "--made-for,--profile", job.made_for,
          "the profile that the job was made for: warns where the mill has another (default: judged by the job)")
      ->type_name("NAME");
  send->add_option("--title", job.title, "what the queue shows (default: the name of the file)")->type_name("TEXT");
  send->add_option("--accept", job.accepted,
                   "warnings of the check that do not keep the job from the queue, e.g. deep-pass,outside-stock")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME");
  send->add_option("--continues", job.continues,
                   "a job that is DONE, whose workpiece this one continues: the check knows what it has removed")
      ->type_name("JOB");
  CLI::Option* rest = send->add_option(
      "--rest-of", job.rest_of, "instead of a file: what is left of a job that was aborted, as a job of its own");
  rest->type_name("JOB");
  send->add_option("--from", job.from, "the line of that job's file, or line and column, with which its rest begins")
      ->needs(rest)
      ->type_name("LINE[:COLUMN]");
  CLI::App* again =
      add_job_verb(mill, options, OldVerb::mill_again, "again", "queue a job that has ended once more, as a new job");
  again->add_option("JOB", job.number, "its number")->required()->type_name("");
  again
      ->add_option("--accept", job.accepted,
                   "warnings that the check finds now, beside those that were accepted for it")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME");
}

CLI::Option* add_number(CLI::App& verb, Options& options, const char* description) {
  return verb.add_option("JOB", options.job.number, description)->type_name("");
}

void add_starts(CLI::App& mill, Options& options) {
  CLI::App* confirm =
      add_job_verb(mill, options, OldVerb::mill_confirm, "confirm", "at the mill: say that all is set up for a job");
  add_number(*confirm, options, "its number (default: the first that waits)");
  confirm->add_flag("--yes", options.yes, "all is set up: do not ask");
  CLI::Option* starts = confirm->add_flag("--start", options.job.start, "start the job, too");
  confirm->add_flag("--follow", options.follow, "show the job until it has ended")->needs(starts);
  CLI::App* start = add_job_verb(mill, options, OldVerb::mill_start, "start", "start a job that is confirmed");
  add_number(*start, options, "its number (default: the first that waits)");
  start->add_flag("--follow", options.follow, "show the job until it has ended");
}

void add_pauses(CLI::App& mill, Options& options) {
  CLI::App* pause =
      add_job_verb(mill, options, OldVerb::mill_pause, "pause", "send no more of the job; what was sent runs on");
  pause->add_flag("--raise", options.job.raise, "raise the tool after the last sent byte, and stop the spindle");
  CLI::App* resume = add_job_verb(mill, options, OldVerb::mill_resume, "resume",
                                  "send the rest of the job that is paused; with JOB, choose where that one continues");
  CLI::Option* job = add_number(*resume, options, "the number of a job that is PAUSED or PAUSED_UNKNOWN");
  resume
      ->add_option("--from", options.job.from,
                   "the line of its file, or line and column, with whose first command it continues")
      ->needs(job)
      ->type_name("LINE[:COLUMN]");
}

void add_hand_verbs(CLI::App& mill, Options& options) {
  JobOptions& job = options.job;
  CLI::App* jog = add_job_verb(mill, options, OldVerb::mill_jog, "jog",
                               "move the tool by a short step, unchecked; the spindle stops before it");
  jog->add_option("AXIS=MM", job.distances, "by how much each axis moves, e.g. x=5 z=-0.5; Z upward")
      ->required()
      ->type_name("");
  jog->add_option("--speed", job.mm_per_s, "in mm/s (default: the mill's)")->type_name("MM/S");
  CLI::App* origin =
      add_job_verb(mill, options, OldVerb::mill_origin, "origin", "set Z0; X and Y are set at the mill's panel");
  CLI::Option* name = origin->add_option(
      "NAME", job.origin, "an origin of the configuration that has a height (default: where the tool is)");
  name->type_name("");
  origin->add_option("--z", job.z, "a machine coordinate, in steps")->type_name("STEPS")->excludes(name);
  CLI::App* spindle = add_job_verb(mill, options, OldVerb::mill_spindle, "spindle", "start or stop the spindle");
  spindle->add_option("on|off", job.spindle, "whether it turns")
      ->required()
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("");
  add_job_verb(mill, options, OldVerb::mill_raise, "raise", "stop the spindle, and raise the tool to the top");
}

}  // namespace

void add_mill_verbs(CLI::App& app, Options& options) {
  CLI::App* mill = app.add_subcommand("mill", "jobs for Roland milling machines (RML-1): check, send, start, abort");
  mill->require_subcommand(1);
  mill->fallthrough();
  mill->footer(help_text("mill"));
  add_checks(*mill, options);
  add_send(*mill, options);
  add_job_verb(*mill, options, OldVerb::mill_queue, "queue", "show the mill, its queue, and the job that runs");
  add_starts(*mill, options);
  add_job_verb(*mill, options, OldVerb::mill_watch, "watch", "show the job that runs until it has ended");
  add_pauses(*mill, options);
  add_job_verb(*mill, options, OldVerb::mill_abort, "abort", "end the job that runs; look at the mill afterwards");
  add_number(*add_job_verb(*mill, options, OldVerb::mill_cancel, "cancel", "take a job out of the queue"), options,
             "its number")
      ->required();
  add_job_verb(*mill, options, OldVerb::mill_clear, "clear",
               "for administrators: take a caller's waiting jobs out of the queue")
      ->add_option("WHO", options.who, "their owner as `mill queue` shows it, e.g. 'unix anna'")
      ->required()
      ->type_name("");
  add_number(*add_job_verb(*mill, options, OldVerb::mill_first, "first", "move a job to the front of the queue"),
             options, "its number")
      ->required();
  add_number(*add_job_verb(*mill, options, OldVerb::mill_done, "done", "say that the workpiece of a job was seen"),
             options, "its number (default: the one that is FED)");
  add_hand_verbs(*mill, options);
}

}  // namespace axisgate::axisctl

// What is typed behind `axisctl mill`.
#include <CLI/CLI.hpp>

#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {

void add_mill_verbs(CLI::App& app, Options& options) {
  CLI::App* mill =
      app.add_subcommand("mill", "check and preview RML-1 jobs for Roland milling machines; needs no daemon");
  mill->require_subcommand(1);
  mill->fallthrough();
  mill->footer(help_text("mill"));
  CLI::App* check = add_verb(*mill, options, Verb::mill_check, "check",
                             "show what a job would do, its errors, and risks to the workpiece");
  CLI::App* preview = add_verb(*mill, options, Verb::mill_preview, "preview", "draw what a job would do");
  for (CLI::App* verb : {check, preview}) {
    verb->add_option("FILE", options.mill.file, "the job; - reads the standard input")->required()->type_name("");
    verb->add_option("--profile", options.mill.profile, "the machine: a name, e.g. mdx-20, or the file of a profile")
        ->required()
        ->type_name("PROFILE");
    verb->add_option("--origin", options.mill.origin,
                     "the work origin in mm: X and Y from the home corner, and how far Z0 is below the top")
        ->type_name("X,Y,Z");
    verb->add_option("--stock", options.mill.stock, "the workpiece in mm, from the work origin, and its thickness")
        ->type_name("X,Y,Z");
    verb->add_option("--tool", options.mill.tool_mm, "the diameter of the tool in mm: says how much is removed")
        ->type_name("MM");
  }
  preview->add_option("-o,--output", options.mill.output, "an .svg or a .png file")->required()->type_name("FILE");
}

}  // namespace axisgate::axisctl

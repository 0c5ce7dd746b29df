// mill check, preview: show what a job would do. They need no daemon, except to look up a named origin.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <boost/algorithm/string/case_conv.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/lengths.h"
#include "clients/axisctl/mill/configured_origin.h"
#include "clients/axisctl/mill/job_places.h"
#include "clients/axisctl/mill/mill_profiles.h"
#include "clients/axisctl/mill/mill_report.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "device/rml1/machine/profile_files.h"
#include "device/rml1/picture/picture.h"
#include "server/config/name.h"

namespace axisgate::axisctl {
namespace {

using namespace rml1;

constexpr std::size_t kPiece = 1 << 16;
constexpr double kThinnest = 0.1, kThickest = 100;  // range of a tool's diameter, mm

// Returns the name of the profile's machine. Empty if no profile is named: the check then infers the machine from the
// job.
std::string made_for(const std::string& profile) { return profile.empty() ? "" : mill_profile(profile).name; }

// Returns the origin of --origin: coordinates such as "10,10,5", or the name of a configured origin such as "vice".
jobs::Origin origin_of(const Options& options) {
  const std::string& text = *options.mill.origin;
  if (server::is_name(text)) return configured_origin(options, text);
  const jobs::Point p = lengths(text, "--origin");
  return {p.x, p.y, p.z};
}

CheckOptions check_options(const Options& all, const Profile& profile) {
  const MillOptions& asked = all.mill;
  CheckOptions options;
  options.others = rml1::known_machines();
  options.made_for = made_for(asked.made_for);
  if (asked.origin) {
    const jobs::Origin p = origin_of(all);
    if (p.z < 0 || p.z > profile.z_mm) {
      throw usage(fmt::format("--origin has Z0 {} mm below the top", p.z),
                  fmt::format("Z travels {} mm on the {}: use 0 to {}", profile.z_mm, profile.name, profile.z_mm));
    }
    if (p.x < 0 || p.y < 0 || p.x > profile.x_mm || p.y > profile.y_mm) {
      print_note(
          fmt::format("--origin is outside the work area of the {}, which is {} mm in X and {} mm in Y: the tool "
                      "begins at its edge",
                      profile.name, profile.x_mm, profile.y_mm));
    }
    options.origin = p;
  }
  if (asked.stock) options.stock = stock_of(*asked.stock);
  for (const double mm : asked.tools_mm) {
    if (mm >= kThinnest && mm <= kThickest) continue;
    throw usage(fmt::format("--tool is {} mm", mm),
                fmt::format("use the tool's diameter in mm, {} to {}", kThinnest, kThickest));
  }
  if (!asked.tools_mm.empty()) options.tool_mm = asked.tools_mm.front();
  return options;
}

// Returns "traces.rml, outline.rml".
std::string title_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) names.push_back(std::filesystem::path(file).filename().string());
  return fmt::format("{}", fmt::join(names, ", "));
}

void check_parts(const MillOptions& asked) {
  if (asked.tools_mm.size() > 1 && asked.tools_mm.size() != asked.files.size()) {
    throw usage(fmt::format("--tool has {} diameters for {} file{}", asked.tools_mm.size(), asked.files.size(),
                            asked.files.size() == 1 ? "" : "s"),
                "name one for all files, or one for each");
  }
  if (asked.from && asked.files.size() > 1) {
    throw usage("--from names a line of one file", "draw what remains of each file by itself");
  }
}

// Feeds the file to the check. Throws Failure if it cannot be read.
void read_job(const std::string& name, Check& check) {
  const auto close = [](std::FILE* file) { return file == stdin ? 0 : std::fclose(file); };
  errno = 0;
  const std::unique_ptr<std::FILE, decltype(close)> file(name == "-" ? stdin : std::fopen(name.c_str(), "rb"), close);
  const auto cannot = [&name] {
    return usage(fmt::format("{} cannot be read: {}", name, std::strerror(errno)), "name the file of a job");
  };
  if (!file) throw cannot();
  std::vector<char> bytes(kPiece);
  while (const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), file.get())) {
    check.feed({bytes.data(), count});
  }
  if (std::ferror(file.get()) != 0) throw cannot();
  check.finish();
}

bool write_text(const std::string& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  return !out.fail();
}

int mill_check(const Options& options) {
  const Profile profile = mill_profile(options.mill.profile);
  const CheckOptions asked = check_options(options, profile);
  Check check(profile, asked);
  read_job(options.mill.file, check);
  if (options.json) {
    print_json(check, profile);
  } else {
    print_diagnostics(options.mill.file, check.diagnostics());
    if (!check.is_other_file()) print_summary(check, profile, asked.origin.has_value());
  }
  return check.diagnostics().count(Severity::error) == 0 ? kDone : kFailed;
}

int mill_preview(const Options& options) {
  const std::string& output = options.mill.output;
  const std::string ending = boost::algorithm::to_lower_copy(std::filesystem::path(output).extension().string());
  if (ending != ".svg") throw usage(output + " is not an SVG picture", "name a file that ends in .svg");
  const MillOptions& asked = options.mill;
  check_parts(asked);
  const Profile profile = mill_profile(asked.profile);
  CheckOptions how = check_options(options, profile);
  Strokes strokes(asked.from ? job_range(*asked.from) : jobs::PlaceRange());
  std::vector<std::unique_ptr<Check>> checks;
  std::vector<const Check*> parts;
  for (std::size_t part = 0; part < asked.files.size(); ++part) {
    if (asked.tools_mm.size() > 1) how.tool_mm = asked.tools_mm[part];
    if (part > 0) strokes.begin_part();
    auto check = std::make_unique<Check>(profile, how, &strokes);
    // Heights of the workpiece are carried over only between parts with the same tool.
    if (part > 0 && how.tool_mm == checks.back()->tool_mm()) check->continues(*checks.back());
    read_job(asked.files[part], *check);
    print_diagnostics(asked.files[part], check->diagnostics());
    if (check->is_other_file() || check->summary().commands == 0) return kFailed;
    parts.push_back(check.get());
    checks.push_back(std::move(check));
  }
  const Picture picture =
      make_picture(title_of(asked.files), parts, profile, how.stock, how.origin.has_value(), strokes);
  errno = 0;
  if (!write_text(output, to_svg(picture))) {
    throw usage(fmt::format("{} cannot be written: {}", output, std::strerror(errno)),
                "name a file in a folder that you can write to");
  }
  return kDone;
}

void add_workpiece(CLI::App& verb, MillOptions& mill) {
  verb.add_option("--profile", mill.profile, "the machine: a name, e.g. mdx-20, or the file of a profile")
      ->type_name("PROFILE");
  verb.add_option("--origin", mill.origin,
                  "the work origin in mm: X and Y from the home corner, and how far Z0 is below the top; or the name "
                  "of one that the daemon has configured")
      ->type_name("X,Y,Z|NAME");
  verb.add_option("--stock", mill.stock, "the workpiece in mm, from the work origin, and its thickness")
      ->type_name("X,Y,Z");
}

void mill_check_options(CLI::App& verb, Options& options) {
  MillOptions& mill = options.mill;
  verb.add_option("FILE", mill.file, "the job; - reads the standard input")->required()->type_name("");
  add_workpiece(verb, mill);
  verb.add_option("--tool", mill.tools_mm, "the diameter of the tool in mm: says how much is removed")
      ->expected(1)
      ->type_name("MM");
  verb.add_option("--made-for", mill.made_for,
                  "the profile that the job was made for: warns where it is another one (default: judged by the job)")
      ->type_name("NAME");
}

void mill_preview_options(CLI::App& verb, Options& options) {
  MillOptions& mill = options.mill;
  verb.add_option("FILE", mill.files, "the job; - reads the standard input; several files are its parts")
      ->required()
      ->type_name("");
  add_workpiece(verb, mill);
  verb.add_option("--tool", mill.tools_mm,
                  "the diameter of the tool in mm: cuts are drawn as wide; of several files one for each, e.g. 0.4,1")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("MM");
  verb.add_option("--from", mill.from,
                  "draw what remains from a line, or line and column, on; what comes before is pale. Of a range, what "
                  "begins in it is perhaps done")
      ->type_name("LINE[:COLUMN][-LINE[:COLUMN]]");
  verb.add_option("-o,--output", mill.output, "an .svg file")->required()->type_name("FILE");
}

constexpr Verb kMillVerbs[] = {
    {.words = "mill",
     .heading = Heading::mills,
     .description = "jobs for Roland milling machines (RML-1): check, send, start, abort",
     .help =
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
     .examples = R"(printf '^IN;!PZ-50,200;PU100,100;PD200,100;PU;H;\n' | axisctl mill check - --profile mdx-20
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
    {.words = "mill check",
     .description = "show what a job would do, its errors, and risks to the workpiece; needs no daemon",
     .add_options = mill_check_options,
     .run_without_daemon = mill_check},
    {.words = "mill preview",
     .description = "draw what a job would do; needs no daemon",
     .add_options = mill_preview_options,
     .run_without_daemon = mill_preview},
};

}  // namespace

std::span<const Verb> mill_verbs() { return kMillVerbs; }

}  // namespace axisgate::axisctl

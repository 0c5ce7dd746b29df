#include "clients/axisctl/mill/mill_verbs.h"

#include <fmt/format.h>

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

}  // namespace

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

}  // namespace axisgate::axisctl

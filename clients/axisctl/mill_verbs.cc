#include "clients/axisctl/mill_verbs.h"

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

#include "clients/axisctl/configured_origin.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/job_places.h"
#include "clients/axisctl/lengths.h"
#include "clients/axisctl/mill_profiles.h"
#include "clients/axisctl/mill_report.h"
#include "clients/axisctl/print.h"
#include "device/rml1/picture.h"
#include "device/rml1/profile_files.h"
#include "server/config/name.h"

namespace axisgate::axisctl {
namespace {

using namespace rml1;

constexpr std::size_t kPiece = 1 << 16;
constexpr double kThinnest = 0.1, kThickest = 100;  // tools, mm

// Returns the name of the machine that has the profile. Empty: it is judged by the job.
std::string made_for(const std::string& profile) { return profile.empty() ? "" : mill_profile(profile).name; }

// "10,10,5" is a place; "vice" is the name of one.
Origin origin_of(const Options& options) {
  const std::string& text = *options.mill.origin;
  if (server::is_name(text)) return configured_origin(options, text);
  const Point p = lengths(text, "--origin");
  return {p.x, p.y, p.z};
}

CheckOptions check_options(const Options& all, const Profile& profile) {
  const MillOptions& asked = all.mill;
  CheckOptions options;
  options.others = rml1::known_machines();
  options.made_for = made_for(asked.made_for);
  if (asked.origin) {
    const Origin p = origin_of(all);
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
  if (asked.tool_mm && !(*asked.tool_mm >= kThinnest && *asked.tool_mm <= kThickest)) {
    throw usage(fmt::format("--tool is {} mm", *asked.tool_mm),
                fmt::format("use the tool's diameter in mm, {} to {}", kThinnest, kThickest));
  }
  options.tool_mm = asked.tool_mm;
  return options;
}

// Throws Failure when it cannot be read.
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
  const bool svg = ending == ".svg";
  if (!svg && ending != ".png") throw usage(output + " is not a picture", "name a file that ends in .svg or .png");
  const Profile profile = mill_profile(options.mill.profile);
  const CheckOptions asked = check_options(options, profile);
  Strokes strokes(options.mill.from ? job_range(*options.mill.from) : PlaceRange());
  Check check(profile, asked, &strokes);
  read_job(options.mill.file, check);
  print_diagnostics(options.mill.file, check.diagnostics());
  if (check.is_other_file() || check.summary().commands == 0) return kFailed;
  const std::string title = std::filesystem::path(options.mill.file).filename().string();
  const Picture picture = make_picture(title, check, profile, asked.stock, asked.origin.has_value(), strokes);
  errno = 0;
  const bool written = svg ? write_text(output, to_svg(picture)) : write_png(picture, output);
  if (!written) {
    throw usage(fmt::format("{} cannot be written: {}", output, std::strerror(errno)),
                "name a file in a folder that you can write to");
  }
  return kDone;
}

}  // namespace axisgate::axisctl

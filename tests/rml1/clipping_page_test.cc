// Test and writer of device/rml1/CLIPPING.md and its picture: the first geometry of each case A to Q, as the machine
// drives it. AXISGATE_WRITE_CLIPPING=1 in the environment writes them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/paths/paths.h"
#include "tests/rml1/clipping_cases.h"

namespace axisgate::rml1 {
namespace {

constexpr std::string_view kHowToWrite =
    "AXISGATE_WRITE_CLIPPING=1 build/bin/rml1_tests --gtest_filter='ClippingPage.*'";
const std::filesystem::path kFolder = paths::in_project("device/rml1");
constexpr double kCell = 220, kScale = 0.09, kColumns = 4;

// A point as seen from the front, slightly from above and from the right.
struct Seen {
  double x, y;
};
Seen seen(const jobs::Point& p) { return {(p.x + p.y * 0.45) * kScale, -(p.z + p.y * 0.35) * kScale}; }

std::string line(const jobs::Point& from, const jobs::Point& to, std::string_view kind) {
  const Seen a = seen(from), b = seen(to);
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind, a.x, a.y,
                     b.x, b.y);
}

std::string box_lines(const Box& box) {
  std::string lines;
  const jobs::Point& a = box.lowest;
  const jobs::Point& b = box.highest;
  const auto edge = [&](jobs::Point from, jobs::Point to) { lines += line(from, to, "box"); };
  for (const double z : {a.z, b.z}) {
    edge({a.x, a.y, z}, {b.x, a.y, z});
    edge({b.x, a.y, z}, {b.x, b.y, z});
    edge({b.x, b.y, z}, {a.x, b.y, z});
    edge({a.x, b.y, z}, {a.x, a.y, z});
  }
  for (const double x : {a.x, b.x}) {
    for (const double y : {a.y, b.y}) edge({x, y, a.z}, {x, y, b.z});
  }
  return lines;
}

std::string cell(const Paragraph& one, std::size_t index) {
  const ClippingCase played = play_case(one);
  const std::string name = one.all("case").at(0);
  const double column = static_cast<double>(index % static_cast<std::size_t>(kColumns));
  const double row = static_cast<double>(index / static_cast<std::size_t>(kColumns));
  std::string svg = fmt::format("<g transform=\"translate({:.0f} {:.0f})\">\n<text x=\"-20\" y=\"-95\">{}</text>\n",
                                40 + column * kCell, 120 + row * kCell, name);
  svg += box_lines(played.whole.box);
  for (std::size_t at = 0; at + 1 < played.commanded.size(); ++at) {
    svg += line(played.commanded[at], played.commanded[at + 1], "asked");
  }
  for (std::size_t at = played.begin; at < played.whole.moves.size(); ++at) {
    svg += line(played.whole.moves[at].from, played.whole.moves[at].to, "driven");
  }
  return svg + "</g>\n";
}

std::vector<Paragraph> first_of_each() {
  std::vector<Paragraph> found;
  std::string kinds;
  for (const Paragraph& one : paragraphs("clipping/cases.txt")) {
    const std::string name = one.all("case").at(0);
    const std::string kind = name.substr(0, name.find(' ')) + ";";
    if (kinds.find(kind) != std::string::npos) continue;
    kinds += kind;
    found.push_back(one);
  }
  return found;
}

std::string picture(const std::vector<Paragraph>& cases) {
  const double rows = std::ceil(static_cast<double>(cases.size()) / kColumns);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "<style>.box{{stroke:#bbb}}.asked{{stroke:#c04000;stroke-dasharray:4 3}}.driven{{stroke:#0060c0;stroke-width:2}}"
      "text{{font:13px sans-serif;fill:#222}}.page{{fill:#fff}}</style>\n"
      "<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n",
      kColumns * kCell, rows * kCell + 20);
  for (std::size_t index = 0; index < cases.size(); ++index) svg += cell(cases[index], index);
  return svg + "</svg>\n";
}

std::string page(const std::vector<Paragraph>& cases) {
  std::string text = R"(# RML-1: clipping, case by case

One geometry of each case A to Q of guideline 5-1; `tests/rml1/clipping/cases.txt` has them all, worked out by hand. Dashed
red is commanded, blue is driven; the box is the work area, seen from the front, above and the right. Made by a test, which
draws what the machine drives; that it is what is in the table, `Clipping` tests. Do not edit it.

![The cases A to Q](clipping.svg)

| case | commanded from the beginning on | driven |
|---|---|---|
)";
  for (const Paragraph& one : cases) {
    std::string jobs, moves;
    bool begun = false;
    for (const auto& [mark, words] : one.lines) {
      begun = begun || mark == "begin";
      if (mark == "job" && begun) jobs += words;
      if (mark == "move") moves += (moves.empty() ? "" : ", then ") + words;
    }
    text += fmt::format("| {} | `{}` | {} |\n", one.all("case").at(0), jobs, moves.empty() ? "nothing" : moves);
  }
  return text;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ClippingPage, ShowsWhatIsDriven) {
  const char* write = std::getenv("AXISGATE_WRITE_CLIPPING");
  const bool writes = write != nullptr && std::string_view(write) == "1";
  const std::vector<Paragraph> cases = first_of_each();
  for (const auto& [name, wanted] :
       {std::pair{"CLIPPING.md", page(cases)}, std::pair{"clipping.svg", picture(cases)}}) {
    if (writes) std::ofstream(kFolder / name, std::ios::binary) << wanted;
    EXPECT_TRUE(content(kFolder / name) == wanted) << name << " is old; write it anew: " << kHowToWrite;
  }
}

}  // namespace
}  // namespace axisgate::rml1

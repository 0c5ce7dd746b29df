// Tests that a job has the same effects however its bytes are divided.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/rml1/paragraphs.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

using Cuts = std::vector<std::size_t>;

Cuts every_byte(const std::string& job) {
  Cuts cuts(job.size());
  std::iota(cuts.begin(), cuts.end(), 0);
  return cuts;
}

Cuts random_cuts(const std::string& job, std::mt19937& random) {
  Cuts cuts(random() % 20);
  for (std::size_t& cut : cuts) cut = random() % (job.size() + 1);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

std::string line(const Diagnostic& one) {
  return fmt::format("{} {} {}:{}:{} [{}] {}", one.number, name(one.severity), one.place.offset, one.place.line,
                     one.place.column, one.section, one.text);
}

std::string line(const Move& move) {
  return fmt::format("{} {} to {} {} {} {} speed {} {} {} at {} of {}", move.from.x, move.from.y, move.to.x, move.to.y,
                     move.from.z, move.to.z, move.speed, move.lowered, move.turning, move.place.offset, move.end);
}

template <class All>
void add_lines(const All& all, std::vector<std::string>& lines) {
  for (const auto& one : all) lines.push_back(line(one));
}

std::vector<std::string> played(const std::string& job, const Cuts& cuts) {
  const Played found = play(job, test_profile(), kMidway, {}, cuts);
  std::vector<std::string> lines = found.commands;
  lines.insert(lines.end(), found.waits.begin(), found.waits.end());
  add_lines(found.diagnostics, lines);
  add_lines(found.moves, lines);
  lines.push_back(text(found.final) + " in " + text(found.box.highest));
  return lines;
}

std::string reach(const jobs::Reach& reach) { return fmt::format("{} {} {}", reach.any, reach.lowest, reach.highest); }

std::vector<std::string> judged(const std::string& job, const Cuts& cuts) {
  Profile profile = test_profile();
  profile.baud = 9600;
  Check check(profile, {kMidway, jobs::Stock{10, 10, 5}, {{"other", 0.025, 60.5}}});
  std::size_t begin = 0;
  for (const std::size_t cut : cuts) {
    check.feed(std::string_view(job).substr(begin, cut - begin));
    begin = cut;
  }
  check.feed(std::string_view(job).substr(begin));
  check.finish();
  std::vector<std::string> lines;
  add_lines(check.diagnostics().kept(), lines);
  const Summary& sum = check.summary();
  lines.push_back(fmt::format("omitted {}, {} commands, {} spin ups, {} {} s, {} {} mm",
                              check.diagnostics().omitted_count(), sum.commands, sum.spin_ups, sum.seconds_low,
                              sum.seconds_high, sum.distance_mm, sum.cutting_mm));
  lines.push_back(text(sum.final) + ", " + reach(sum.bounds.x) + ", " + reach(sum.bounds.y) + ", " +
                  reach(sum.bounds.z));
  return lines;
}

// Expects the same effects with cuts at one byte, at every byte, and at random places.
void expect_same(const std::string& job, std::mt19937& random) {
  std::vector<Cuts> all = {every_byte(job), random_cuts(job, random), random_cuts(job, random)};
  if (job.size() <= 300) {
    for (std::size_t cut = 1; cut < job.size(); ++cut) all.push_back({cut});
  }
  const std::vector<std::string> machine = played(job, {}), check = judged(job, {});
  for (const Cuts& cuts : all) {
    ASSERT_EQ(played(job, cuts), machine) << job << " at " << testing::PrintToString(cuts);
    ASSERT_EQ(judged(job, cuts), check) << job << " at " << testing::PrintToString(cuts);
  }
}

TEST(Split, OfEveryExample) {
  std::mt19937 random(6);
  for (const Paragraph& example : paragraphs("examples")) {
    SCOPED_TRACE(example.where);
    expect_same(unescaped(example.all("<").at(0)), random);
  }
}

TEST(Split, OfEveryClippingCase) {
  std::mt19937 random(6);
  for (const Paragraph& one : paragraphs("clipping/cases.txt")) {
    SCOPED_TRACE(one.where);
    std::string job;
    for (const std::string& part : one.all("job")) job += part;
    expect_same(job, random);
  }
}

// Returns names, numbers and bytes of every kind, so that many are errors.
std::string generated(unsigned seed) {
  static const std::vector<std::string> kPieces = {
      "PA",  "PR",  "PU", "PD", "P",   "D",   "I",    "M",     "R",      "H",      "Z",    "IN",  "DF",  "VS",   "V",
      "F",   "W",   "@",  "^",  "!ZZ", "!ZE", "!ZM",  "!ZO",   "!PZ",    "!MC",    "!RC",  "!DW", "!VZ", "!",    "!Z",
      "!NR", "^PU", "X",  "Y",  "A",   "Q",   "\x1B", "\x1B.", "\x1B.K", "\x1B.M", "\x81", ":",   "$",   "\r\n", "\n",
      "\t",  " ",   ";",  ";",  ";",   ",",   ",",    ",",     ",",      "+",      "-",    "-",   "."};
  std::mt19937 random(seed);
  std::string job = "IN;";
  while (job.size() < 3000) {
    job += random() % 2 == 0 ? kPieces[random() % kPieces.size()] : std::to_string(random() % 20000) + ",";
  }
  return job;
}

// Returns a job like that of a CAM program, long enough for the planner to look ahead.
std::string milled(unsigned seed) {
  std::mt19937 random(seed);
  std::string job = "IN;!MC1;V10;F5;!PZ-200,300;PU0,0;PD;";
  for (int index = 0; index < 300; ++index) {
    const auto x = random() % 2000, y = random() % 2000, z = random() % 800;
    job += index % 3 == 0 ? fmt::format("PD{},{}\r\n", x, y) : fmt::format("Z {} {} -{};", x, y, z);
  }
  return job + "PU;!MC0;H;";
}

TEST(Split, OfLongJobs) {
  std::mt19937 random(6);
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    for (const std::string& job : {generated(seed), milled(seed)}) {
      for (int again = 0; again < 5; ++again) expect_same(job, random);
    }
  }
}

TEST(Split, OfGCode) {
  std::mt19937 random(6);
  for (const char* job : {"%\nO1\n", "G0 X1\n", "N 10 G21\n", " \r\nG 0 X1", "GX;PD;", "N;1", "O", "G",
                          "; a\nT1 M6\nG0", "F4;V2\nM3.5\nPU1,1"}) {
    expect_same(job, random);
  }
}

}  // namespace
}  // namespace axisgate::rml1

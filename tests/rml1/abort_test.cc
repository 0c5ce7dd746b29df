// Aborts at random moments of random jobs: nothing more of the job is written, the bytes that still run keep within the
// stated bound, and the tool ends up with the spindle off. For comparison, each moment is repeated with a sender that
// only stops writing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/rml1/sending/commands.h"
#include "tests/rml1/abort_bench.h"
#include "tests/rml1/measured_by.h"
#include "tests/rml1/random_mill_job.h"
#include "tests/rml1/short_vectors.h"
#include "tests/rml1/trace.h"
#include "tests/simulation/random.h"

namespace axisgate::rml1::abort_test {
namespace {

using simulation::Random;
using simulator::Flow;
using std::chrono::milliseconds;

constexpr int kAborts = 200, kAbortsAJob = 20;
constexpr std::size_t kBuffer = 512;  // bytes; small, so that a short job fills it
constexpr double kTop = 5000;         // steps above Z0

constexpr std::array kStreamings = {"paced", "full"};
constexpr std::array kFlows = {"none", "xon", "rts"};

struct Combination {
  jobs::Streaming streaming;
  Flow flow;
  double slower_percent;
  const char* escape_k;
  std::uint64_t first_seed;
  bool slack_as_measured = false;
};

std::string text(const Combination& of) {
  return fmt::format("{} | {} | {} %{} | {}", kStreamings.at(static_cast<std::size_t>(of.streaming)),
                     kFlows.at(static_cast<std::size_t>(of.flow)), of.slower_percent,
                     of.slack_as_measured ? ", measured" : "", of.escape_k);
}

// Returns the measured slack of a mill that is slower than the high end of its profile, or the default slack if it is
// not measured.
double slack_of(const Combination& of) {
  if (!of.slack_as_measured) return jobs::SendSettings{}.slack;
  simulator::MillSetup mill = simulator::with_options({{"acceleration", "worst"}});
  mill.buffer_bytes = kBuffer;
  mill.flow = Flow::rts;
  mill.slower_percent = of.slower_percent;
  const auto pace = measured_by(uniform_vectors(1500), mill, {.buffer = kBuffer, .converter = 0}, {.shows_cts = true});
  return with_pace({.slack_as_measured = true}, pace).slack;
}

void PrintTo(const Combination& of, std::ostream* out) { *out << text(of); }

// Moment at which VIEW is pressed.
enum class View { never, before, after, before_and_released };

// Random choices for one abort.
struct Moment {
  Duration at{};  // since the start of the job
  View view = View::never;
  Duration view_before{}, view_after{},
      held{};                           // from VIEW to the abort, from the abort to VIEW; time until VIEW is released
  std::size_t converter = 0, late = 0;  // bytes
  std::vector<std::pair<std::string_view, std::string_view>> options;
};

bool held_before(const Moment& moment) {
  return moment.view == View::before || moment.view == View::before_and_released;
}

Duration drawn(Random& random, Duration most) { return Duration(random.between(0, most.count())); }

Moment drawn_moment(Random& random, Duration job) {
  Moment moment;
  moment.at = drawn(random, job);
  if (random.chance(0.6)) moment.view = random.pick<View>({View::before, View::after, View::before_and_released});
  moment.view_before = std::min(moment.at, drawn(random, std::chrono::seconds(5)));
  moment.view_after = drawn(random, std::chrono::seconds(2));
  moment.held = milliseconds(1) + drawn(random, std::chrono::seconds(10));
  moment.converter = random.pick<std::size_t>({0, 16, 128});
  moment.late = random.pick<std::size_t>({0, 16});
  moment.options = {{"acceleration", random.pick<std::string_view>({"none", "best", "worst"})},
                    {"dwell_per", random.pick<std::string_view>({"command", "point"})},
                    {"view_takes_effect", random.pick<std::string_view>({"after-move", "at-once"})},
                    {"pause_position", random.pick<std::string_view>({"top", "stays"})}};
  return moment;
}

struct Job {
  explicit Job(std::string with_words, const Profile& profile)
      : text(std::move(with_words)), timeline(text, profile, kMidway) {}

  std::string text;
  Timeline timeline;
};

Job random_job(std::uint64_t seed, const Profile& profile) {
  const std::string body = random_mill_job(seed, 1100);
  const Timeline alone(body, profile, kMidway);
  return Job(prologue() + body + epilogue(profile, alone.turns_at_end()), profile);
}

AbortBench bench_of(const Job& job, const Combination& of, const Moment& moment, double slack) {
  simulator::MillSetup mill =
      simulator::with_options({{"escape_k", of.escape_k}}, simulator::with_options(moment.options));
  mill.buffer_bytes = kBuffer;
  mill.flow = of.flow;
  mill.slower_percent = of.slower_percent;
  return AbortBench(job.text, job.timeline, mill,
                    {.streaming = of.streaming, .slack = slack, .buffer = kBuffer, .converter = moment.converter},
                    {.shows_cts = of.flow == Flow::rts, .converter = moment.converter, .late = moment.late});
}

// Runs up to the moment of the abort, with VIEW pressed and released as drawn.
void run_to(AbortBench& bench, const Moment& moment) {
  if (held_before(moment)) {
    bench.run_for(moment.at - moment.view_before);
    bench.press_view();
    if (moment.view == View::before) return bench.run_for(moment.view_before);
    const Duration held = std::min(moment.held, moment.view_before);
    bench.run_for(held);
    bench.press_view();
    return bench.run_for(moment.view_before - held);
  }
  bench.run_for(moment.at);
}

void run_to_the_end(AbortBench& bench, const Moment& moment) {
  if (moment.view == View::after) {
    bench.run_for(moment.view_after);
    bench.press_view();
  }
  if (moment.view == View::after || moment.view == View::before) {
    bench.run_for(moment.held);
    bench.press_view();
  }
  bench.finish();
}

// Results of one combination.
struct Tally {
  int aborts = 0;
  std::size_t ran_on = 0, ran_on_held = 0, bound = 0, bound_held = 0;  // maximum, bytes
  int left_down = 0, left_turning = 0;                                 // by a sender that only stops writing
  std::size_t ran_on_unaborted = 0;                                    // maximum by a sender that only stops
};

class Aborts : public testing::TestWithParam<Combination> {
 protected:
  // Returns false if the job had already ended.
  bool abort(const Job& job, const Moment& moment) {
    AbortBench bench = bench_of(job, GetParam(), moment, slack_);
    run_to(bench, moment);
    if (is_end(bench.sender().state())) return false;
    const std::string before = bench.written();
    bench.abort();
    run_to_the_end(bench, moment);
    expect_only_words(bench, before.size());
    expect_within_bound(bench, moment);
    // A panel that stops the mill becomes visible only once the line is stopped.
    if (!held_before(moment)) {
      EXPECT_LE(bench.certain_at_end(), std::max(bench.executed_at_end(), prologue().size()));
    }
    expect_tool_up_and_spindle_off(bench, moment);
    return true;
  }

  void expect_only_words(AbortBench& bench, std::size_t before) {
    const std::string words = bench.written().substr(before);
    EXPECT_EQ(bench.sender().state(), jobs::SenderState::aborted);
    EXPECT_TRUE(words == abort_commands(profile_, false) || words == abort_commands(profile_, true)) << words;
  }

  void expect_within_bound(AbortBench& bench, const Moment& moment) {
    const bool was_held = held_before(moment);
    const jobs::RunOn bound = bench.sender().run_on();
    std::size_t& most = was_held ? tally_.ran_on_held : tally_.ran_on;
    most = std::max(most, bench.ran_on());
    tally_.bound = std::max(tally_.bound, bound.at_most);
    tally_.bound_held = std::max(tally_.bound_held, bound.if_held);
    EXPECT_LE(bench.ran_on(), was_held ? bound.if_held : bound.at_most);
  }

  static void expect_tool_up_and_spindle_off(AbortBench& bench, const Moment& moment) {
    if (bench.abort_lost()) return expect_had_no_room(moment);
    EXPECT_EQ(bench.state().tool.z, kTop);
    EXPECT_EQ(bench.state().rpm, 0);
    if (moment.view == View::never) {
      EXPECT_FALSE(bench.raise_started_spindle());
    }
  }

  // See AbortLimit in abort_guard_test.cc.
  static void expect_had_no_room(const Moment& moment) {
    EXPECT_EQ(GetParam().flow, Flow::none);
    EXPECT_STREQ(GetParam().escape_k, "in-band");
    EXPECT_TRUE(held_before(moment));
  }

  void only_stop_writing(const Job& job, const Moment& moment) {
    AbortBench bench = bench_of(job, GetParam(), moment, slack_);
    run_to(bench, moment);
    bench.stop_writing();
    run_to_the_end(bench, moment);
    tally_.ran_on_unaborted = std::max(tally_.ran_on_unaborted, bench.ran_on());
    if (bench.state().tool.z < 0) ++tally_.left_down;
    if (bench.state().rpm > 0) ++tally_.left_turning;
  }

  // Returns the first seed. AXISGATE_SEED repeats a failure from the seed that it printed.
  std::uint64_t first_seed() const {
    const char* only = std::getenv("AXISGATE_SEED");
    return only != nullptr ? std::strtoull(only, nullptr, 10) : GetParam().first_seed;
  }

  // Prints one row. Its columns are explained in device/rml1/sending/README.md.
  void print() const {
    std::cout << fmt::format("| {} | {} | {} of {} | {} of {} | {} | {} | {} |\n", text(GetParam()), tally_.aborts,
                             tally_.ran_on, tally_.bound, tally_.ran_on_held, tally_.bound_held,
                             tally_.ran_on_unaborted, tally_.left_down, tally_.left_turning);
  }

  Duration longest(const Job& job) const {
    const double slack = GetParam().streaming == jobs::Streaming::paced ? slack_ : 1;
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(job.timeline.slowest_s() * slack));
  }

  const Profile profile_ = test_profile();
  const double slack_ = slack_of(GetParam());
  Tally tally_;
};

TEST_P(Aborts, NothingIsWrittenTheBoundIsTrueAndTheToolIsUp) {
  if (GetParam().slack_as_measured) {
    EXPECT_LT(slack_, 1.45);
    EXPECT_GT(slack_, 1 + GetParam().slower_percent / 100);
  }
  for (std::uint64_t seed = first_seed(); tally_.aborts < kAborts && !HasFailure(); ++seed) {
    const Job job = random_job(seed, profile_);
    Random random(seed);
    for (int i = 0; i < kAbortsAJob && tally_.aborts < kAborts && !HasFailure(); ++i) {
      SCOPED_TRACE(fmt::format("AXISGATE_SEED={}, moment {}: {}", seed, i, text(GetParam())));
      const Moment moment = drawn_moment(random, longest(job));
      if (!abort(job, moment)) continue;
      ++tally_.aborts;
      only_stop_writing(job, moment);
    }
  }
  print();
}

std::vector<Combination> combinations() {
  std::vector<Combination> all;
  for (const jobs::Streaming streaming : {jobs::Streaming::paced, jobs::Streaming::full}) {
    for (const Flow flow : {Flow::none, Flow::xon, Flow::rts}) {
      if (streaming == jobs::Streaming::full && flow == Flow::none) continue;
      for (const double slower : {0.0, 30.0, 50.0}) {
        for (const char* escape_k : {"toggle", "one-shot", "in-band"})
          all.push_back({streaming, flow, slower, escape_k, 1000 * all.size()});
      }
    }
  }
  return all;
}

// Returns mills with measured slack, which is less than the default slack.
std::vector<Combination> measured_combinations() {
  std::vector<Combination> all;
  for (const Flow flow : {Flow::none, Flow::xon, Flow::rts}) {
    for (const char* escape_k : {"toggle", "in-band"})
      all.push_back({jobs::Streaming::paced, flow, 20, escape_k, 1000 * (100 + all.size()), true});
  }
  return all;
}

std::string test_name(const testing::TestParamInfo<Combination>& one) {
  std::string name;
  for (const char c : text(one.param)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Mills, Aborts, testing::ValuesIn(combinations()), test_name);
INSTANTIATE_TEST_SUITE_P(Measured, Aborts, testing::ValuesIn(measured_combinations()), test_name);

}  // namespace
}  // namespace axisgate::rml1::abort_test
